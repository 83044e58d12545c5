//! Grids of every awkward size. A graphics processor takes even sizes without a prime factor above 7;
//! the others it refuses with the nearest that it takes.

use super::case::{Case, Contact, Law};
use super::flats::{FILE, NAME, noise};
use super::paths::Path;
use super::run::Run;

const SIZES: [[usize; 2]; 16] = [
    [1, 1],
    [1, 2],
    [2, 2],
    [1, 8],
    [1, 64],
    [64, 1],
    [3, 5],
    [127, 127],
    [125, 125],
    [121, 121],
    [100, 96],
    [113, 64],
    [512, 2],
    [2, 512],
    [1024, 4],
    [3, 343],
];

/// Height of the highest point.
const HEIGHT: f64 = 0.01;

fn noisy(points: [usize; 2], size: [f64; 2], law: Law, name: String) -> Case {
    let heights = noise(points[0] * points[1], 11)
        .into_iter()
        .map(|x| HEIGHT * x)
        .collect();
    let contact = Contact {
        points,
        size,
        ..Contact::cell(1, law)
    };
    let [dx, dy] = contact.pixel();
    // Some tenth of what flattens a pixel.
    let pressure = 0.1 * HEIGHT / (dx * dy).sqrt();
    let mut case = Case::new(name, contact, FILE)
        .with_file(NAME, heights)
        .under("pressure", [pressure, 0.1 * pressure]);
    case.refused = without_transform;
    case
}

/// What a graphics processor says of a size that it does not take.
fn without_transform(case: &Case, path: &Path) -> Option<Vec<String>> {
    let points = case.contact.points.into_iter();
    let refused = path.backend == "gpu" && !points.clone().all(transforms);
    refused.then(|| points.flat_map(nearest).collect())
}

/// Whether a graphics processor transforms so many points: even, without a prime factor above 7.
fn transforms(points: usize) -> bool {
    let mut rest = points;
    for prime in [2, 3, 5, 7] {
        while rest.is_multiple_of(prime) {
            rest /= prime;
        }
    }
    points.is_multiple_of(2) && rest == 1
}

/// The sizes that a refusal must name: those next to one that has no transform.
fn nearest(points: usize) -> Vec<String> {
    if transforms(points) {
        return vec![points.to_string()];
    }
    let below = (2..points).rev().find(|size| transforms(*size));
    let above = (points..).find(|size| transforms(*size));
    below
        .into_iter()
        .chain(above)
        .map(|size| size.to_string())
        .collect()
}

/// Squares of one pixel size, whatever the sides.
fn square_pixels([nx, ny]: [usize; 2]) -> [f64; 2] {
    let most = nx.max(ny) as f64;
    [nx as f64 / most, ny as f64 / most]
}

pub fn cases() -> Vec<Case> {
    let mut cases: Vec<Case> = SIZES
        .iter()
        .map(|&points| {
            let [nx, ny] = points;
            noisy(
                points,
                square_pixels(points),
                Law::Wall,
                format!("grid of {nx} x {ny}"),
            )
            .so_that(named)
        })
        .collect();
    let adhesive = Law::MaugisDugdale {
        work: 1e-6,
        range: 2e-3,
        taper: None,
    };
    for points in [[1, 64], [121, 63]] {
        let [nx, ny] = points;
        let name = format!("grid of {nx} x {ny}, Maugis-Dugdale");
        cases.push(noisy(points, square_pixels(points), adhesive, name));
    }
    cases.push(three_pixels());
    for aspect in [16.0, 1e3] {
        let name = format!("pixels {aspect} times as long as wide");
        cases.push(noisy([32, 32], [aspect, 1.0], Law::Wall, name));
    }
    cases
}

/// A row of three pixels that attraction closes. A rounding error of a gap is all that the solver leaves open, which is
/// within any tolerance; the point is in contact all the same, as the one that mirrors it, and bears its share.
fn three_pixels() -> Case {
    let contact = Contact {
        points: [3, 1],
        size: [324.5229212491913e-9, 108.17430708306376e-9],
        free: false,
        modulus: 2593061.6271071844,
        law: Law::MaugisDugdale {
            work: 1.7890326329788325e-6,
            range: 2.1547384844310755e-10,
            taper: None,
        },
    };
    let low = 1.0924191367163673e-9;
    let mut case = Case::new("three pixels, closed by attraction", contact, FILE)
        .with_file(NAME, vec![low, 1.638628705074551e-9, low])
        .under("pressure", [991.0745990286881, 297.3223797086064])
        .so_that(|run, _| assert!(run.rows.iter().all(|row| row.contact == 1.0)));
    case.refused = without_transform;
    case
}

/// What converged converged in a bounded number of iterations on every size.
fn named(run: &Run, _: &Path) {
    assert!(run.rows.iter().all(|row| row.state == "contact"));
}
