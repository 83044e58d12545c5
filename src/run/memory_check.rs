//! Whether the memory of this machine holds a run or a surface, asked before any of it is taken.

use std::path::{Path, PathBuf};

use crate::backend::{BackendError, dry_run::Place, ranks::Ranks};
use crate::grid::Grid;
use crate::scene::{BackendName, Precision, Scene, SolverScene, SurfacePart};
use crate::study::{Cost, Memory};
use crate::surface::{MOST_POINTS, claimed_points};

/// Environment variable that sets the memory a run may take, in bytes.
const LIMIT: &str = "TABOR_MEMORY";
/// Address space that the allocator reserves for each thread, used or not (glibc on 64 bits).
const RESERVED: u64 = 64 << 20;
/// Address space beside fields in large pages, 2 MiB for each: of more than a solver holds at once.
const BESIDE_FIELDS: u64 = 64 << 20;

/// Bytes that every machine on which this program starts has: a run that needs no more does not ask the system, which
/// takes as long as a tenth of a solve on 128 x 128 points.
const ALWAYS_THERE: u64 = 32 << 20;

/// Bytes a point that reading a map takes: shades or numbers of the file, and the heights.
const READING: u64 = 24;

/// Single precision, as Rust asks for it.
const SINGLE_PRECISION: &str = "Precision::Single";

/// A run or a surface that the memory does not hold.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MemoryError {
    /// A run on a grid that is too large.
    #[error(
        "grid.points: {} x {} points need {} of memory and there are {}; {}",
        points[0], points[1], unlike(*needed, *available), unlike(*available, *needed), smaller(*largest, *single, *available)
    )]
    Grid {
        /// Points along x and y.
        points: [usize; 2],
        /// Bytes that it needs.
        needed: u64,
        /// Bytes that there are.
        available: u64,
        /// The largest grid of this shape that fits.
        largest: Option<[usize; 2]>,
        /// Bytes in single precision, where the scene leaves the choice.
        single: Option<u64>,
    },
    /// A run over several ranks on a grid that is too large.
    #[error(
        "grid.points: {} x {} points need {} of memory on each of {ranks} ranks, {here} of them on this machine, and there are {}; take fewer points, or fewer ranks a machine",
        points[0], points[1], unlike(*needed, *available), unlike(*available, *needed)
    )]
    Ranks {
        /// Points along x and y.
        points: [usize; 2],
        /// How many ranks there are.
        ranks: usize,
        /// How many of them are on this machine.
        here: usize,
        /// Bytes that each needs.
        needed: u64,
        /// Bytes that there are for all of this machine.
        available: u64,
    },
    /// A height file that is longer than the memory.
    #[error(
        "{}: {} of heights are more than the memory, {}; take a coarser map", path.display(), unlike(*length, *available), unlike(*available, *length)
    )]
    File {
        /// The file.
        path: PathBuf,
        /// Its length, bytes.
        length: u64,
        /// Bytes that there are.
        available: u64,
    },
    /// A height map of too many points.
    #[error(
        "{}: {} x {} points need {} of memory and there are {}; take a coarser map", path.display(), points[0], points[1], unlike(*needed, *available), unlike(*available, *needed)
    )]
    Map {
        /// The height file or the scene.
        path: PathBuf,
        /// Points along x and y.
        points: [usize; 2],
        /// Bytes that it needs.
        needed: u64,
        /// Bytes that there are.
        available: u64,
    },
    /// `TABOR_MEMORY` holds something else than a number of bytes.
    #[error(
        "{LIMIT}={text:?} is no number of bytes; write for example {LIMIT}=8000000000, or unset it"
    )]
    Limit {
        /// What it holds.
        text: String,
    },
    /// The cost could not be counted.
    #[error(transparent)]
    Cost(#[from] BackendError),
}

#[cfg(feature = "cli")]
impl MemoryError {
    /// The message for readers who ask for single precision in other words.
    pub(crate) fn in_words(&self, single_precision: &str) -> String {
        self.to_string().replace(SINGLE_PRECISION, single_precision)
    }
}

/// The ways out of a grid that the memory does not hold.
fn smaller(largest: Option<[usize; 2]>, single: Option<u64>, available: u64) -> String {
    let fewer = match largest {
        Some([nx, ny]) => format!("take at most {nx} x {ny} points"),
        None => "no grid of this shape fits".to_owned(),
    };
    match single {
        Some(needed) if needed <= available => {
            let needed = unlike(needed, available);
            format!("{fewer}, or {SINGLE_PRECISION} ({needed})")
        }
        _ => fewer,
    }
}

/// Bytes for people, with as many digits as tell them from another number of bytes.
fn unlike(bytes: u64, other: u64) -> String {
    /// Digits that tell single bytes apart.
    const MOST_DIGITS: usize = 10;
    let text =
        |bytes: u64, digits: usize| format!("{:.digits$} GiB", bytes as f64 / f64::from(1 << 30));
    let differs = |digits: &usize| text(bytes, *digits) != text(other, *digits);
    text(bytes, (2..=MOST_DIGITS).find(differs).unwrap_or(2))
}

/// Bytes that a run may take: what the machine has left, within the limits of its container and of its
/// process, or what `TABOR_MEMORY` says. `None` where the system does not tell.
pub(crate) fn available() -> Result<Option<u64>, MemoryError> {
    if let Ok(text) = std::env::var(LIMIT) {
        return match text.trim().parse() {
            Ok(bytes) => Ok(Some(bytes)),
            Err(_) => Err(MemoryError::Limit { text }),
        };
    }
    let mut system = sysinfo::System::new();
    system.refresh_memory();
    let left = system.available_memory();
    let limit = system
        .cgroup_limits()
        .map_or(u64::MAX, |limits| limits.total_memory);
    let left = left.min(limit);
    Ok((left > 0).then_some(address_space_left().map_or(left, |space| left.min(space))))
}

/// Bytes of address space that this process may still take where it is limited (Linux, `ulimit -v`): past
/// them every allocation fails and ends the process.
fn address_space_left() -> Option<u64> {
    let number = |file: &str, key: &str| -> Option<u64> {
        let text = std::fs::read_to_string(file).ok()?;
        let value = text.lines().find_map(|line| line.strip_prefix(key))?;
        // "unlimited" is no number.
        value.split_whitespace().next()?.parse().ok()
    };
    let limit = number("/proc/self/limits", "Max address space")?;
    let kibibytes = number("/proc/self/status", "VmSize:")?;
    let threads = std::thread::available_parallelism().map_or(1, |count| count.get() as u64);
    Some(limit.saturating_sub(kibibytes * 1024 + threads * RESERVED + BESIDE_FIELDS))
}

/// Refuses a run on `grid` that needs more memory than there is, with the largest grid that fits.
pub(crate) fn check_grid(scene: &Scene, grid: Grid) -> Result<(), MemoryError> {
    let need = |scene: &Scene| -> Result<u64, MemoryError> {
        let cost = Cost::for_scene(scene, grid, Place::for_scene(scene, &grid))?;
        Ok(Memory::new(scene, grid, &cost).machine)
    };
    let needed = need(scene)?;
    if needed <= ALWAYS_THERE && std::env::var_os(LIMIT).is_none() {
        return Ok(());
    }
    let Some(available) = available()? else {
        return Ok(());
    };
    if needed <= available {
        return Ok(());
    }
    Err(MemoryError::Grid {
        points: [grid.nx, grid.ny],
        needed,
        available,
        largest: Memory::largest_grid(scene, grid, available)?,
        single: match scene.solver {
            SolverScene {
                precision: Precision::Auto,
                backend: BackendName::Auto | BackendName::Cpu,
                ..
            } => {
                let mut single = scene.clone();
                single.solver.precision = Precision::Single;
                Some(need(&single)?)
            }
            _ => None,
        },
    })
}

/// Refuses a run on `grid` over several ranks, if those of this machine need more memory than there is.
pub(crate) fn check_on_ranks(
    scene: &Scene,
    grid: Grid,
    ranks: &dyn Ranks,
) -> Result<(), MemoryError> {
    let Some(available) = available()? else {
        return Ok(());
    };
    let cost = Cost::for_scene(scene, grid, Place::for_scene(scene, &grid))?;
    let needed = Memory::on_ranks(scene, grid, &cost, ranks.count()).machine;
    if needed.saturating_mul(ranks.here() as u64) <= available {
        return Ok(());
    }
    Err(MemoryError::Ranks {
        points: [grid.nx, grid.ny],
        ranks: ranks.count(),
        here: ranks.here(),
        needed,
        available,
    })
}

/// As [`check_grid`], for a grid that the scene gives itself; one that a height file carries is checked
/// once the file is read.
pub(crate) fn check_scene(scene: &Scene) -> Result<(), MemoryError> {
    check_scene_by(scene, 1, |grid| check_grid(scene, grid))
}

/// The same by one of these two checks, of so many ranks.
pub(super) fn check_scene_by(
    scene: &Scene,
    ranks: usize,
    check: impl Fn(Grid) -> Result<(), MemoryError>,
) -> Result<(), MemoryError> {
    check_files(scene, ranks)?;
    match (scene.grid.points, scene.grid.size) {
        // Counts past all grids are the surface's to refuse.
        (Some(points), Some(size)) if points[0].saturating_mul(points[1]) <= MOST_POINTS => {
            check(Grid::new(points, size))
        }
        _ => Ok(()),
    }
}

/// Refuses height files that are longer than the memory, and those whose header claims more points than
/// it holds: a small file may be a large image. What several ranks read by rows counts with their fields.
pub(crate) fn check_files(scene: &Scene, ranks: usize) -> Result<(), MemoryError> {
    let files = scene.surfaces.iter().filter_map(|part| match part {
        SurfacePart::File(file) if ranks < 2 => Some(&file.path),
        _ => None,
    });
    for path in files {
        check_file(path, |points| READING * count(points))?;
    }
    Ok(())
}

/// Refuses a height file that is longer than the memory, or whose header claims more points than it holds; `need`
/// says how many bytes so many points take.
pub(crate) fn check_file(path: &Path, need: impl Fn([usize; 2]) -> u64) -> Result<(), MemoryError> {
    // What cannot be asked for its length is the surface's to refuse.
    let length = std::fs::metadata(path).map_or(0, |metadata| metadata.len());
    let Some(available) = available()? else {
        return Ok(());
    };
    if length > available {
        return Err(MemoryError::File {
            path: path.to_path_buf(),
            length,
            available,
        });
    }
    match claimed_points(path) {
        Some(points) if points[0].saturating_mul(points[1]) <= MOST_POINTS => {
            check_map_of(path, points, need(points).saturating_add(length), available)
        }
        _ => Ok(()),
    }
}

/// Refuses a map of so many points that needs more bytes than there are.
pub(crate) fn check_map_of(
    path: &Path,
    points: [usize; 2],
    needed: u64,
    available: u64,
) -> Result<(), MemoryError> {
    if needed <= available {
        return Ok(());
    }
    Err(MemoryError::Map {
        path: path.to_path_buf(),
        points,
        needed,
        available,
    })
}

/// Number of points.
pub(crate) fn count(points: [usize; 2]) -> u64 {
    points[0] as u64 * points[1] as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run was told to need 0.02 GiB where there are 0.02 GiB.
    #[test]
    fn amounts_have_digits_that_differ() {
        assert_eq!(unlike(20_000_000, 1 << 30), "0.02 GiB");
        assert_eq!(unlike(20_000_000, 19_000_000), "0.019 GiB");
        assert_eq!(unlike(19_000_000, 20_000_000), "0.018 GiB");
        assert_eq!(unlike(20_000_001, 20_000_000), "0.018626452 GiB");
        assert_eq!(unlike(20_000_000, 20_000_000), "0.02 GiB");
    }
}
