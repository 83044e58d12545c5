//! Flows that are known: closed forms, and a dense solution.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use tabor::backend::ranks::ThreadRanks;
use tabor::backend::{Shape, Share};
use tabor::flow::{Film, Flow};
use tabor::grid::{Boundary, Grid};
use tabor::scene::Axis;

const TOLERANCE: f64 = 1e-10;
const MOST: usize = 500;

fn flow(gap: &[f64], grid: Grid, boundary: Boundary, axis: Axis) -> Flow {
    let film = Film {
        grid,
        boundary,
        axis,
    };
    let flow = film.flow(gap.to_vec(), TOLERANCE, MOST);
    assert!(flow.converged, "{flow:?}");
    flow
}

fn field(grid: Grid, gap: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    let points = (0..grid.len()).map(|i| gap(i % grid.nx, i / grid.nx));
    points.collect()
}

/// Numbers of [0, 1), always the same (Knuth's MMIX).
fn random(mut state: u64) -> impl FnMut() -> f64 {
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found / expected - 1.0).abs() <= tolerance,
        "{found} {expected}"
    );
}

/// Between plates the flow is u^3 times width over length.
#[test]
fn plates() {
    let grid = Grid::new([20, 15], [4e-6, 1e-6]);
    let gap = vec![2e-9; grid.len()];
    for boundary in Boundary::ALL {
        for (axis, aspect) in [(Axis::X, 0.25), (Axis::Y, 4.0)] {
            let found = flow(&gap, grid, *boundary, axis);
            // Powers end the iteration at 1e-10.
            close(found.permeance, 8e-27 * aspect, 1e-9);
            close(found.critical_gap, 2e-9, 1e-15);
        }
    }
}

/// A wave across the flow: what lies side by side adds up, d^3 + 3 d a^2/2. A wave along it: the reciprocals do,
/// (d^2 + a^2/2)/(d^2 - a^2)^(5/2). The sums over 32 points of a wave are exact but for (a/d)^32.
#[test]
fn waves() {
    let (d, a) = (1.0f64, 0.4f64);
    let grid = Grid::new([32, 16], [1.0, 1.0]);
    let wave = |i: usize| d + a * (2.0 * std::f64::consts::PI * i as f64 / 32.0).cos();
    let gap = field(grid, |ix, _| wave(ix));
    let across = flow(&gap, grid, Boundary::Periodic, Axis::Y);
    close(across.permeance, d.powi(3) + 1.5 * d * a * a, 1e-9);
    close(across.critical_gap, d + a, 1e-12);
    let along = flow(&gap, grid, Boundary::Periodic, Axis::X);
    let reciprocal = (d * d + 0.5 * a * a) / (d * d - a * a).powf(2.5);
    close(along.permeance, 1.0 / reciprocal, 1e-9);
    close(along.critical_gap, d - a, 1e-12);
}

/// The squares of a chessboard conduct as the geometric mean of both colours (Dykhne 1971). The pressure is
/// singular at the corners, so the error falls slowly with the points: 3 % at 32 a square, 8 times the conductance.
#[test]
fn a_chessboard() {
    let errors = [16, 32, 64].map(|square: usize| {
        let grid = Grid::new([2 * square; 2], [1.0; 2]);
        let gap = field(grid, |ix, iy| {
            if (ix / square + iy / square).is_multiple_of(2) {
                1.0
            } else {
                2.0
            }
        });
        let found = flow(&gap, grid, Boundary::Periodic, Axis::X);
        println!("{square}: {} in {}", found.permeance, found.iterations);
        (found.permeance / 8f64.sqrt() - 1.0).abs()
    });
    println!("{errors:?}");
    assert!(errors[2] < 0.02 && errors[1] < 0.03);
    assert!(errors[2] < errors[1] && errors[1] < errors[0]);
}

/// A wall across one axis does not stop the flow along the other.
#[test]
fn walls() {
    let grid = Grid::new([12, 10], [1.0, 1.0]);
    let wall = field(grid, |ix, _| if ix == 5 { -1e-12 } else { 1.0 });
    for boundary in Boundary::ALL {
        let closed = flow(&wall, grid, *boundary, Axis::X);
        assert_eq!((closed.critical_gap, closed.permeance), (0.0, 0.0));
        let open = flow(&wall, grid, *boundary, Axis::Y);
        close(open.permeance, 11.0 / 12.0, 1e-9);
    }
    // A hole in the wall is the critical constriction.
    let hole = field(grid, |ix, iy| match (ix, iy) {
        (5, 3) => 0.125,
        (5, _) => 0.0,
        _ => 1.0,
    });
    for boundary in Boundary::ALL {
        let found = flow(&hole, grid, *boundary, Axis::X);
        assert_eq!(found.critical_gap, 0.125);
        assert!(found.permeance > 0.0);
    }
    // Points that touch at a corner alone do not pass anything on.
    let diagonal = field(grid, |ix, iy| if ix == iy { 1.0 } else { 0.0 });
    assert_eq!(
        flow(&diagonal, grid, Boundary::Periodic, Axis::X).critical_gap,
        0.0
    );
    // Nothing at all is open.
    let none = vec![0.0; grid.len()];
    assert_eq!(flow(&none, grid, Boundary::Free, Axis::X).permeance, 0.0);
}

/// A channel one pixel wide that winds through the cell: its faces lie one after the other. A free cell has half a
/// pixel more at each end in place of the link into the next cell.
#[test]
fn a_winding_channel() {
    let grid = Grid::new([9, 9], [9.0, 9.0]);
    // Along row 1, up column 4, along row 6, and up again to row 1 of the next cell: through 8, down to 1.
    let is_open = |ix: usize, iy: usize| {
        matches!((ix, iy), (0..=4, 1) | (4, 1..=6) | (4..=8, 6) | (8, 1..=6))
    };
    let gap = field(grid, |ix, iy| if is_open(ix, iy) { 0.5 } else { 0.0 });
    let length = gap.iter().filter(|gap| **gap > 0.0).count() as f64;
    let found = flow(&gap, grid, Boundary::Periodic, Axis::X);
    close(found.permeance, 0.125 / length, 1e-9);
    // The outlet is at the whole of column 8: the flow ends where the channel first gets there.
    let found = flow(&gap, grid, Boundary::Free, Axis::X);
    close(found.permeance, 0.125 / 14.0, 0.02);
    // It never gets from one cell to the next along y.
    assert_eq!(
        flow(&gap, grid, Boundary::Periodic, Axis::Y).critical_gap,
        0.0
    );
}

/// A cell of one point, or one point wide.
#[test]
fn single_points() {
    let grid = Grid::new([1, 1], [1.0, 2.0]);
    for boundary in Boundary::ALL {
        close(flow(&[0.5], grid, *boundary, Axis::X).permeance, 0.25, 1e-9);
    }
    let line = Grid::new([1, 3], [1.0, 3.0]);
    let found = flow(&[1.0, 0.0, 1.0], line, Boundary::Periodic, Axis::X);
    close(found.permeance, 2.0, 1e-9);
    assert_eq!(
        flow(&[1.0, 0.0, 1.0], line, Boundary::Periodic, Axis::Y).permeance,
        0.0
    );
    let two = Grid::new([2, 1], [2.0, 1.0]);
    let found = flow(&[1.0, 2.0], two, Boundary::Periodic, Axis::X);
    close(found.permeance, 1.0 / (1.0 + 0.125), 1e-9);
}

/// The same equations as a dense matrix, one point of it held where there is no inlet.
fn dense(gap: &[f64], grid: Grid, boundary: Boundary) -> f64 {
    let (nx, ny) = (grid.nx, grid.ny);
    let n = grid.len();
    let mut matrix = DMatrix::<f64>::zeros(n, n);
    let mut source = DVector::<f64>::zeros(n);
    let mut faces: Vec<(usize, usize, f64, f64)> = Vec::new();
    for i in 0..n {
        let (ix, iy) = (i % nx, i / nx);
        for (jx, jy, is_x) in [(ix + 1, iy, true), (ix, iy + 1, false)] {
            let leaves = jx == nx || jy == ny;
            if leaves && boundary == Boundary::Free {
                continue;
            }
            let j = (jy % ny) * nx + jx % nx;
            if gap[i] <= 0.0 || gap[j] <= 0.0 {
                continue;
            }
            let aspect = if is_x {
                grid.dy() / grid.dx()
            } else {
                grid.dx() / grid.dy()
            };
            let g = 2.0 / (gap[i].powi(-3) + gap[j].powi(-3)) * aspect;
            faces.push((i, j, g, if jx == nx { 1.0 } else { 0.0 }));
        }
        if boundary == Boundary::Free && gap[i] > 0.0 {
            let g = 2.0 * gap[i].powi(3) * grid.dy() / grid.dx();
            if ix == 0 {
                matrix[(i, i)] += g;
                source[i] += g;
            }
            if ix + 1 == nx {
                matrix[(i, i)] += g;
            }
        }
    }
    for (i, j, g, fall) in &faces {
        matrix[(*i, *i)] += g;
        matrix[(*j, *j)] += g;
        matrix[(*i, *j)] -= g;
        matrix[(*j, *i)] -= g;
        source[*i] -= g * fall;
        source[*j] += g * fall;
    }
    // Each part of the gap that hangs in the air is held weakly: no flow goes through what holds it.
    for i in 0..n {
        matrix[(i, i)] += 1e-13;
    }
    let p = matrix.lu().solve(&source).expect("a regular matrix");
    match boundary {
        Boundary::Free => (0..ny)
            .map(|iy| iy * nx)
            .filter(|i| gap[*i] > 0.0)
            .map(|i| 2.0 * gap[i].powi(3) * grid.dy() / grid.dx() * (1.0 - p[i]))
            .sum(),
        Boundary::Periodic => faces
            .iter()
            .map(|(i, j, g, fall)| g * f64::powi(p[*i] - p[*j] + fall, 2))
            .sum(),
    }
}

/// Random gaps from 0.05 to 1, of which a third is closed: more unknowns than are solved directly.
#[test]
fn as_a_dense_solution() {
    let grid = Grid::new([30, 20], [1.0, 2.0]);
    let mut passing = 0;
    for seed in 0..6 {
        let mut random = random(seed);
        let gap = field_of(grid, || {
            let closed = random() < 0.3;
            let gap = 0.05 + 0.95 * random();
            if closed { 0.0 } else { gap }
        });
        for boundary in Boundary::ALL {
            let found = flow(&gap, grid, *boundary, Axis::X);
            let expected = dense(&gap, grid, *boundary);
            println!("{seed} {boundary:?}: {found:?} {expected}");
            if found.critical_gap > 0.0 {
                passing += 1;
                // Some hundred points held by 1e-13 each, over a permeance above 1e-4.
                close(found.permeance, expected, 1e-6);
            } else {
                assert!(expected < 1e-8, "{expected}");
            }
        }
    }
    assert!(passing >= 6, "{passing}");
}

fn field_of(grid: Grid, mut gap: impl FnMut() -> f64) -> Vec<f64> {
    (0..grid.len()).map(|_| gap()).collect()
}

/// Points of a square lattice that are opened at random let through from 0.5927 of them on. On 256 x 256 points that
/// is sharp to 256^(-3/4) = 0.016.
#[test]
fn the_threshold_of_random_points() {
    let grid = Grid::new([256, 256], [1.0, 1.0]);
    for seed in 0..4 {
        for boundary in Boundary::ALL {
            for (share, passes) in [(0.55, false), (0.635, true)] {
                let mut random = random(seed);
                let gap = field_of(grid, || if random() < share { 1.0 } else { 0.0 });
                let found = flow(&gap, grid, *boundary, Axis::X);
                assert_eq!(
                    found.critical_gap > 0.0,
                    passes,
                    "{seed} {boundary:?} {share}"
                );
                assert_eq!(found.permeance > 0.0, passes);
            }
        }
    }
}

/// Gaps over six decades, conductances over eighteen: the critical constriction sets the flow, and the iterations do not
/// grow without bounds.
#[test]
fn decades_of_gaps() {
    let grid = Grid::new([128, 128], [1.0, 1.0]);
    let mut random = random(7);
    let gap = field_of(grid, || 10f64.powf(-6.0 * random()));
    let found = flow(&gap, grid, Boundary::Periodic, Axis::X);
    println!("{found:?}");
    // The conductance of the critical constriction, times a factor of order 1 (Ambegaokar, Halperin & Langer 1971).
    let ratio = found.permeance / found.critical_gap.powi(3);
    assert!((0.03..30.0).contains(&ratio), "{ratio}");
    assert!(found.iterations < 60, "{}", found.iterations);
}

/// The same equations solved with 200 digits, on gaps over 4.5 decades. In doubles the pressure of a repeating cell
/// hardly differs within its wide places, where almost all of the first guess's power is lost.
#[test]
fn as_an_exact_solution() {
    let grid = Grid::new([8, 9], [0.8e-6, 0.9e-6]);
    // One over the plastic number: places that no two points share.
    let place = |i: usize| (0.7548776662466927 * (i + 1) as f64).fract();
    let gap: Vec<f64> = (0..grid.len())
        .map(|i| 10f64.powf(-6.0 - 4.5 * place(i)))
        .collect();
    for (axis, boundary, expected) in [
        (Axis::X, Boundary::Periodic, 7.559_072_817_367_812e-29),
        (Axis::X, Boundary::Free, 6.620_028_286_611_363e-29),
        (Axis::Y, Boundary::Periodic, 5.330_665_480_602_539e-23),
        (Axis::Y, Boundary::Free, 2.878_347_797_053_666e-22),
    ] {
        // Powers end the iteration at 1e-10.
        close(flow(&gap, grid, boundary, axis).permeance, expected, 1e-9);
    }
}

/// Gaps with closed places and hardly any that are alike, for grids of every shape.
fn any_gap(grid: Grid, seed: u64, closed: f64, decades: f64) -> Vec<f64> {
    let mut random = random(seed);
    field_of(grid, || {
        let is_closed = random() < closed;
        let gap = 10f64.powf(-decades * random());
        if is_closed { 0.0 } else { gap }
    })
}

/// Both boundaries, both axes.
fn films(grid: Grid) -> impl Iterator<Item = Film> {
    Boundary::ALL.iter().flat_map(move |&boundary| {
        [Axis::X, Axis::Y].map(|axis| Film {
            grid,
            boundary,
            axis,
        })
    })
}

/// The flow on so many ranks, on each of them.
fn on_ranks(gap: &[f64], film: Film, ranks: usize) -> Vec<Flow> {
    let shape = Shape::whole(film.grid.nx, film.grid.ny);
    std::thread::scope(|scope| {
        let ranks: Vec<_> = ThreadRanks::new(ranks)
            .into_iter()
            .map(|rank| {
                scope.spawn(move || {
                    let share = Share::on_ranks(shape, Some(Arc::new(rank)));
                    let rows = share.rows();
                    let own = gap[rows.start * film.grid.nx..rows.end * film.grid.nx].to_vec();
                    film.flow_on(&share, own, TOLERANCE, MOST, &mut |_, _| true)
                        .expect("all ranks")
                })
            })
            .collect();
        let ended = ranks.into_iter().map(|rank| rank.join().expect("no panic"));
        ended.collect()
    })
}

/// Slabs of different heights, more ranks than blocks of rows, a single row or column, both axes and boundaries, flows
/// and none: every rank finds the same bits as one process.
#[test]
fn ranks_find_the_same_bits() {
    let mut flowing = 0;
    for (points, counts) in [
        ([24, 70], &[2, 3, 5][..]),
        ([33, 41], &[2, 4, 7]),
        ([16, 16], &[2, 5]),
        ([20, 8], &[3]),
        ([40, 1], &[2]),
        ([1, 40], &[3]),
        ([2, 9], &[2]),
    ] {
        let grid = Grid::new(points, [1.0, 1.5]);
        for (seed, closed, decades) in [(1, 0.0, 3.0), (2, 0.3, 1.0), (3, 0.38, 4.0)] {
            let gap = any_gap(grid, seed, closed, decades);
            for film in films(grid) {
                let alone = flow(&gap, grid, film.boundary, film.axis);
                flowing += usize::from(alone.permeance > 0.0);
                for count in counts {
                    for found in on_ranks(&gap, film, *count) {
                        assert_eq!(found, alone, "{points:?} {film:?} {count}");
                    }
                }
            }
        }
    }
    assert!(flowing > 30, "{flowing}");
}

/// Large enough that graphs are worked on by several threads and that coarse ones still lie on several ranks.
#[test]
fn threads_find_the_same_bits() {
    let grid = Grid::new([320, 600], [1.0, 1.0]);
    let gap = any_gap(grid, 5, 0.1, 2.0);
    let film = Film {
        grid,
        boundary: Boundary::Periodic,
        axis: Axis::Y,
    };
    let found = [1, 2, 5].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = pool.build().expect("threads");
        pool.install(|| flow(&gap, grid, film.boundary, film.axis))
    });
    println!("{:?}", found[0]);
    assert!(found[0].permeance > 0.0);
    assert_eq!(found[1], found[0]);
    assert_eq!(found[2], found[0]);
    assert_eq!(on_ranks(&gap, film, 3), [found[0]; 3]);
}

/// The definition: the widest of all gaps such that points of at least this gap reach from one cell into the next,
/// or from inlet to outlet, found by trying one after another.
fn critical_gap(gap: &[f64], film: Film) -> f64 {
    let (nx, ny) = (film.grid.nx as i64, film.grid.ny as i64);
    let repeats = film.boundary == Boundary::Periodic;
    let mut gaps: Vec<f64> = gap.iter().copied().filter(|gap| *gap > 0.0).collect();
    gaps.sort_by(f64::total_cmp);
    let percolates = |least: f64| {
        // Of each point the cell in which it was first reached, from one point at a time.
        (0..gap.len()).any(|begin| {
            let along = |point: usize| match film.axis {
                Axis::Y => (point as i64 / nx, ny),
                _ => (point as i64 % nx, nx),
            };
            if gap[begin] < least || !repeats && along(begin).0 != 0 {
                return false;
            }
            let mut reached = vec![None; gap.len()];
            reached[begin] = Some(0);
            let mut waiting = vec![begin];
            while let Some(point) = waiting.pop() {
                let (place, count) = along(point);
                if !repeats && place + 1 == count {
                    return true;
                }
                let cell = reached[point].expect("it was reached");
                let (x, y) = (point as i64 % nx, point as i64 / nx);
                for (dx, dy) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
                    let (tx, ty) = (x + dx, y + dy);
                    let crossed = match film.axis {
                        Axis::Y => ty.div_euclid(ny),
                        _ => tx.div_euclid(nx),
                    };
                    let leaves = tx.div_euclid(nx) != 0 || ty.div_euclid(ny) != 0;
                    let to = (ty.rem_euclid(ny) * nx + tx.rem_euclid(nx)) as usize;
                    if gap[to] < least || leaves && !repeats {
                        continue;
                    }
                    match reached[to] {
                        None => {
                            reached[to] = Some(cell + crossed);
                            waiting.push(to);
                        }
                        Some(known) if known != cell + crossed => return true,
                        Some(_) => {}
                    }
                }
            }
            false
        })
    };
    let closed = gaps.partition_point(|gap| percolates(*gap));
    closed.checked_sub(1).map_or(0.0, |at| gaps[at])
}

/// On grids of more rows than are opened together, of one process and of several.
#[test]
fn the_critical_gap_is_the_widest_that_percolates() {
    let mut open = 0;
    for (points, seeds) in [
        ([6, 67], 4),
        ([12, 9], 6),
        ([9, 1], 3),
        ([1, 9], 3),
        ([3, 33], 6),
    ] {
        let grid = Grid::new(points, [1.0, 1.0]);
        for seed in 0..seeds {
            let closed = [0.05, 0.3][seed as usize % 2];
            let gap = any_gap(grid, seed, closed, 2.0);
            for film in films(grid) {
                let unit = gap.iter().copied().fold(0.0, f64::max);
                // Over the largest gap and back.
                let expected = critical_gap(&gap, film) / unit * unit;
                let found = flow(&gap, grid, film.boundary, film.axis).critical_gap;
                assert_eq!(found, expected, "{film:?}");
                assert!(
                    on_ranks(&gap, film, 2)
                        .iter()
                        .all(|f| f.critical_gap == found)
                );
                open += usize::from(found > 0.0);
            }
        }
    }
    assert!(open > 30, "{open}");
}

/// Light points between heavy ones, at each of many decades: channels through walls, which are joined neither by strips
/// nor through what hardly conducts. The iterations stay few.
#[test]
fn walls_and_channels() {
    let grid = Grid::new([96, 96], [1.0, 1.0]);
    for decades in [1.0, 3.0, 6.0] {
        let mut random = random(3);
        let channel = |i: usize| i % 12 == 5;
        let gap: Vec<f64> = (0..grid.len())
            .map(|i| {
                let (ix, iy) = (i % 96, i / 96);
                let is_channel = channel(ix) || channel(iy);
                let wall = 10f64.powf(-decades * random());
                if is_channel { 1.0 } else { 0.1 * wall }
            })
            .collect();
        for boundary in Boundary::ALL {
            for axis in [Axis::X, Axis::Y] {
                let found = flow(&gap, grid, *boundary, axis);
                println!("{decades} {boundary:?} {axis:?}: {found:?}");
                assert!(found.iterations < 40, "{found:?}");
            }
        }
    }
}
