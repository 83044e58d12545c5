//! A sphere with Lennard-Jones adhesion on a free boundary, against the tables.
//!
//! Units of the tables: range, radius and work of adhesion 1, so that radii are in sqrt(R eps),
//! forces in w R and E* = mu^(-3/2). The approach counts from an undeformed gap of 0, the distance
//! of zero force, as the tables' A does.

use std::f64::consts::PI;

use tabor::law::{Cohesion, LennardJones};
use tabor::study::State;
use tabor::theory::lennard_jones_sphere::LennardJonesSphere;

use crate::bench::{Solved, solve_table};
use crate::shared::trials::tests;
use crate::tables::{parameters, slope, table, thinned};

/// Side of the window in sqrt(R eps), at least.
const SIDE: f64 = 20.0;
/// Points a side, at least: the grid of the figures behind `accuracy`.
const POINTS: usize = 256;
const MOST_POINTS: usize = 1024;
/// Pixels across the cohesive length `(pi/4) E* w/sigma_max^2` at mu = 3 on that grid.
const ZONE_PIXELS: f64 = 1.8;
/// Share of its approach to which a jump's place is asked, besides one step.
const FOLD_ERROR: f64 = 0.02;

/// Error allowed for a force, in 2 pi w R.
///
/// Measured apart from this code on 256 points over 20 sqrt(R eps), from pull-off up: 7e-4, 2e-4
/// and 1.6e-3 at mu 0.2, 1 and 3. Up to mu = 1 pixels against the radius of the contact make it,
/// beyond that pixels against the cohesive length; this line stands twice above both.
fn accuracy(mu: f64) -> f64 {
    1.5e-3_f64.max(1.1e-3 * mu.min(3.0))
}

/// A sphere of one table.
struct Sphere {
    mu: f64,
    side: f64,
    points: usize,
}

impl Sphere {
    /// A grid that resolves the cohesive length; `None` if that takes too many points.
    fn resolved(mu: f64, largest_radius: f64, name: &str) -> Option<Sphere> {
        let side = SIDE.max(4.0 * largest_radius);
        let zone = 0.7455 * mu.powf(-1.5);
        let pixel = (zone / ZONE_PIXELS).min(side / POINTS as f64);
        let points = ((side / pixel).ceil() as usize).next_multiple_of(32);
        if points > MOST_POINTS {
            println!("skipped: {name} needs {points} points a side");
            assert!(mu > 3.0, "mu <= 3 may not be skipped");
            return None;
        }
        Some(Sphere { mu, side, points })
    }

    fn solve(&self, control: &str, path: &[f64]) -> Solved {
        solve_table(&format!(
            r#"
            [grid]
            points = {}
            size = {:e}
            boundary = "free"
            [solid]
            contact_modulus = {:e}
            [[surface]]
            kind = "sphere"
            radius = 1.0
            [adhesion]
            law = "lennard-jones"
            work_of_adhesion = 1.0
            range = 1.0
            [loading]
            control = "{control}"
            path = {path:?}
            "#,
            self.points,
            self.side,
            self.mu.powf(-1.5),
        ))
    }

    /// Attraction outside the square window in 2 pi w R: the undeformed gap's far traction.
    fn outside(&self, approach: f64) -> f64 {
        let half = 0.5 * self.side;
        -0.93 / (1.0 - approach + 0.5 * half * half).powi(2)
    }

    /// Force of a step in 2 pi w R with the attraction outside.
    fn force(&self, force: f64, approach: f64) -> f64 {
        force / (2.0 * PI) + self.outside(approach)
    }
}

/// Force at tabulated approaches: inwards up to the fold at which the surfaces snap, outwards down
/// to the one at which they part; the whole curve where there is none.
fn curves() {
    let special = table("lj_special_points.csv");
    for (mu, name) in parameters("lj_curve_mu") {
        let curve = table(&name);
        let row =
            (special.find("mu", mu)).unwrap_or_else(|| panic!("no special points for {name}"));
        let (inwards, outwards) = (
            special.number(row, "jump_in_A"),
            special.number(row, "jump_off_A"),
        );
        let stable: Vec<usize> = (0..curve.len())
            .filter(|&i| curve.number(i, "stable_disp") == 1.0)
            .collect();
        let place = |i: &usize| curve.number(*i, "A");
        let ways: Vec<Vec<usize>> = if inwards.is_nan() {
            vec![stable.into_iter().rev().collect()]
        } else {
            // The branch before the snap ends where the table's marks first break off.
            let end = (0..curve.len()).find(|&i| curve.number(i, "stable_disp") != 1.0);
            let (far, near): (Vec<usize>, Vec<usize>) =
                stable.into_iter().partition(|&i| Some(i) < end);
            let far = far
                .into_iter()
                .filter(|i| place(i) < inwards - FOLD_ERROR * inwards.abs());
            let near = near
                .into_iter()
                .filter(|i| place(i) > outwards + FOLD_ERROR * outwards.abs());
            vec![far.collect(), near.rev().collect()]
        };
        let radius = (0..curve.len())
            .map(|i| curve.number(i, "r_pk"))
            .fold(0.0, f64::max);
        let Some(sphere) = Sphere::resolved(mu, radius, &name) else {
            continue;
        };
        for way in ways {
            let rows = thinned(way, 14);
            let path: Vec<f64> = rows.iter().map(place).collect();
            let solved = sphere.solve("approach", &path);
            let mut worst: f64 = 0.0;
            for (step, &i) in solved.rows().zip(&rows) {
                let (at, expected) = (curve.number(i, "A"), curve.number(i, "F_over_2piwR"));
                assert!((step.approach.expect("held") - at).abs() < 1e-9);
                let error = (sphere.force(step.force, at) - expected).abs();
                // Near a fold and under compression the error of the approach counts too.
                let allowed = accuracy(mu) * slope(&curve, i, "F_over_2piwR", "A").max(1.0);
                assert!(
                    error < allowed,
                    "{name} at {at}: off by {error:.2e}, {allowed:.2e} allowed"
                );
                worst = worst.max(error);
            }
            println!(
                "{name}: {} points, {} rows from {} to {}: within {worst:.1e}",
                sphere.points,
                rows.len(),
                path[0],
                path[path.len() - 1],
            );
        }
    }
}

/// Under a held force the sphere stays in contact a little below the tabulated pull-off and parts
/// a little beyond it.
fn pull_off() {
    let special = table("lj_special_points.csv");
    for row in 0..special.len() {
        let mu = special.number(row, "mu");
        let name = format!("pull-off at mu {mu}");
        let Some(sphere) = Sphere::resolved(mu, special.number(row, "pull_r_pk"), &name) else {
            continue;
        };
        let at = special.number(row, "pull_A");
        // What is held is the force on the window.
        let expected = special.number(row, "pull_F_over_2piwR") + sphere.outside(at);
        let accuracy = accuracy(mu);
        let path = [
            0.0,
            -0.6 * expected,
            -0.9 * expected,
            -(expected - accuracy),
            -(expected + accuracy),
        ]
        .map(|force| 2.0 * PI * force);
        let solved = sphere.solve("force", &path);
        let states: Vec<State> = solved.rows().map(|row| row.state).collect();
        assert_ne!(
            states[3],
            State::Separated,
            "{name}: parted below {expected}"
        );
        assert_eq!(
            states[4],
            State::Separated,
            "{name}: held beyond {expected}"
        );
        assert_eq!(solved.end.jump_off_steps, [5], "{name}");
    }
}

/// Where a held approach jumps: at the folds, to one step and the share by which pixels move them.
/// Without folds it does not, and both ways are one curve.
fn jumps() {
    let special = table("lj_special_points.csv");
    for row in 0..special.len() {
        let mu = special.number(row, "mu");
        let name = format!("jumps at mu {mu}");
        let Some(sphere) = Sphere::resolved(mu, special.number(row, "pull_r_pk"), &name) else {
            continue;
        };
        let (inwards, outwards) = (
            special.number(row, "jump_in_A"),
            special.number(row, "jump_off_A"),
        );
        if inwards.is_nan() {
            no_jump(&sphere);
            continue;
        }
        let step = 0.02;
        for (fold, sign) in [(inwards, 1.0), (outwards, -1.0)] {
            let steps = (4.0 + FOLD_ERROR * fold.abs() / step).ceil();
            let count = 2 * steps as usize;
            let near = |i: usize| fold + sign * step * (i as f64 + 0.5 - steps);
            // From far apart, or from a contact that is well beyond the fold.
            let mut path = if sign > 0.0 {
                vec![fold - 1.0]
            } else {
                vec![0.5, 0.5 * fold, fold + 0.5]
            };
            let before = path.len();
            path.extend((0..count).map(near));
            let solved = sphere.solve("approach", &path);
            let found = if sign > 0.0 {
                &solved.end.jump_in_steps
            } else {
                &solved.end.jump_off_steps
            };
            let [jumped] = found[..] else {
                panic!("{name}: {found:?} instead of one jump at {fold}");
            };
            let at = path[jumped - 1];
            println!(
                "{name}: jump at {at:.3} ({fold:.3}), {:.4} to {:.4}",
                sphere.force(solved.steps[jumped - 2].row.force, at),
                sphere.force(solved.steps[jumped - 1].row.force, at),
            );
            assert!(jumped > before, "{name}: jump before the fold at {fold}");
            assert!(
                (at - fold).abs() <= step + FOLD_ERROR * fold.abs(),
                "{name}: {at} for {fold}"
            );
            assert_eq!(
                solved.end.jump_in_steps.len() + solved.end.jump_off_steps.len(),
                1,
                "{name}"
            );
        }
    }
}

fn no_jump(sphere: &Sphere) {
    // From beyond the steepest part of the curve, near A = -1, to beyond pull-off.
    let mut path: Vec<f64> = (0..=16).map(|i| -1.5 + 0.1 * f64::from(i)).collect();
    let count = path.len();
    path.extend_from_within(..count - 1);
    path[count..].reverse();
    let solved = sphere.solve("approach", &path);
    let forces: Vec<f64> = solved.rows().map(|row| row.force / (2.0 * PI)).collect();
    for i in 0..count {
        let difference = (forces[i] - forces[forces.len() - 1 - i]).abs();
        // One solution found twice, each to a residual of 1e-6.
        assert!(
            difference < 1e-4,
            "mu {}: the ways differ by {difference:.1e} at {}",
            sphere.mu,
            path[i]
        );
    }
    assert!(solved.end.jump_in_steps.is_empty() && solved.end.jump_off_steps.is_empty());
}

/// A wave of length 1 and amplitude 0.01 under Lennard-Jones, pressed from 4 ranges to -0.1 and let go.
struct Wave {
    /// Stiffness of the solid to a wave of this length, pi E*, over the steepest fall of the traction with the gap.
    kappa: f64,
    range: f64,
}

impl Wave {
    const WORK: f64 = 1e-4;

    /// Over w/range^2 the traction falls by 8/3 (3 r^4 - 9 r^10), r = range/(gap + range), at most where r^6 = 2/15.
    fn steepest(&self) -> f64 {
        let near = (2.0_f64 / 15.0).powf(1.0 / 6.0);
        let slope = 8.0 / 3.0 * (3.0 * near.powi(4) - 9.0 * near.powi(10));
        slope * Self::WORK / self.range.powi(2)
    }

    fn walk(&self, steps: usize) -> Solved {
        let modulus = self.kappa * self.steepest() / PI;
        let (range, work) = (self.range, Self::WORK);
        let (far, near) = (4.0 * range, -0.1 * range);
        solve_table(&format!(
            "[grid]\npoints = [64, 1]\nsize = [1.0, 1.0]\n[solid]\ncontact_modulus = {modulus:e}\n[[surface]]\nkind = \"wavy\"\namplitude = 0.01\nwavelength = [1.0, \"inf\"]\n[adhesion]\nlaw = \"lennard-jones\"\nwork_of_adhesion = {work}\nrange = {range}\n[loading]\ncontrol = \"mean-gap\"\nstart = {far}\n[[loading.ramp]]\nto = {near}\nsteps = {steps}\n[[loading.ramp]]\nto = {far}\nsteps = {steps}\n"
        ))
    }
}

/// How far apart the two ways of a path there and back are at most, over the greatest force.
fn ways_apart(solved: &Solved) -> f64 {
    let forces: Vec<f64> = solved.rows().map(|row| row.force).collect();
    let most = forces
        .iter()
        .fold(0.0_f64, |most, force| most.max(force.abs()));
    let apart = forces.iter().zip(forces.iter().rev());
    apart.fold(0.0_f64, |most, (there, back)| {
        most.max((there - back).abs())
    }) / most
}

/// From kappa 1 on the energy of a wave at a held mean gap is convex, for no wave on the cell is softer than the
/// longest and no point's attraction falls more steeply: one state for each gap, both ways on one curve. (Down to 0.5
/// they still are, for not all points are where it is steepest.) That curve has a hump, so that a step over it starts
/// and ends at like forces, and yet nothing jumps, however coarse the path. Far below the two ways are apart, and
/// each has its jump.
fn a_wave_jumps_where_its_ways_are_apart() {
    for range in [0.01, 0.02] {
        for kappa in [0.5, 0.7, 1.0, 1.25, 2.0, 5.0, 10.0, 20.0] {
            for steps in [8, 12, 25, 50, 100] {
                let solved = Wave { kappa, range }.walk(steps);
                // Both ways are one curve to what a residual of 1e-6 leaves open of it.
                let apart = ways_apart(&solved);
                let jumps = [&solved.end.jump_in_steps, &solved.end.jump_off_steps];
                let name = format!("kappa {kappa}, range {range}, {steps} steps");
                assert!(apart < 1e-4, "{name}: ways {apart:.1e} apart");
                let none = jumps.iter().all(|steps| steps.is_empty());
                assert!(none, "{name}: {jumps:?}");
                // The hump: the pull grows and falls on the way in.
                let ends = [solved.rows().next(), solved.rows().nth(steps)];
                let [far, near] = ends.map(|row| row.expect("a row").force);
                let least = solved.rows().map(|row| row.force).fold(0.0, f64::min);
                assert!(least < 1.1 * far.min(near).min(0.0), "{name}: no hump");
            }
        }
        for kappa in [0.1, 0.2, 0.35] {
            let solved = Wave { kappa, range }.walk(200);
            let apart = ways_apart(&solved);
            let jumps = [&solved.end.jump_in_steps, &solved.end.jump_off_steps];
            println!("kappa {kappa}, range {range}: ways {apart:.1e} apart, jumps {jumps:?}");
            assert!(apart > 1e-2, "kappa {kappa}, range {range}: {apart:e}");
            let listed = jumps.iter().all(|steps| !steps.is_empty());
            assert!(listed, "kappa {kappa}, range {range}: {jumps:?}");
        }
    }
}

/// At Tabor number 1 the folds are 0.11 ranges apart and little is lost between them: one jump each way, in
/// the step that passes the fold of the radial solution or in the next.
fn jumps_between_close_folds() {
    let sphere = Sphere::resolved(1.0, 0.0, "close folds").expect("a small mu");
    let radial = LennardJonesSphere::new(sphere.mu, 0.0).expect("a sphere");
    let curve = radial
        .curve(|states| states.last().is_some_and(|last| last.force > 0.0))
        .expect("a curve");
    // Along the curve the approach turns at each fold.
    let folds: Vec<f64> = curve
        .windows(3)
        .map(|three| [0, 1, 2].map(|i| three[i].approach))
        .filter(|at| (at[1] - at[0]) * (at[2] - at[1]) < 0.0)
        .map(|at| at[1])
        .collect();
    assert_eq!(folds.len(), 2, "{folds:?}");
    let outwards = folds.iter().copied().fold(f64::INFINITY, f64::min);
    let inwards = folds.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let step = 0.02;
    let mut path = vec![-3.0, -2.0];
    path.extend((0..14).map(|i| inwards - 7.5 * step + step * f64::from(i)));
    path.extend([-1.2, -1.0, -1.2, -1.4]);
    path.extend((0..14).map(|i| outwards + 7.5 * step - step * f64::from(i)));
    path.extend([-2.0, -3.0]);
    let solved = sphere.solve("approach", &path);
    let found: Vec<f64> = [&solved.end.jump_in_steps, &solved.end.jump_off_steps]
        .map(|steps| match steps[..] {
            [step] => path[step - 1],
            _ => panic!("{steps:?} instead of one jump"),
        })
        .to_vec();
    println!(
        "in at {:.3} ({inwards:.4}), off at {:.3} ({outwards:.4})",
        found[0], found[1]
    );
    assert!((found[0] - inwards).abs() <= step, "{found:?} {inwards}");
    assert!((found[1] - outwards).abs() <= step, "{found:?} {outwards}");
}

/// Between two folds that are only 0.025 ranges apart a held approach has two states, one for each
/// way there; the radial solution names both.
fn two_states_between_shallow_folds() {
    let sphere = Sphere::resolved(0.8, 0.0, "shallow folds").expect("a small mu");
    let radial = LennardJonesSphere::new(sphere.mu, 0.0).expect("a sphere");
    let curve = radial
        .curve(|states| states.last().is_some_and(|last| last.force > 0.0))
        .expect("a curve");
    let at = -1.392;
    let crosses = |pair: &&[tabor::theory::lennard_jones_sphere::State]| {
        pair[0].approach < at && at <= pair[1].approach
    };
    let force = |pair: Option<&[tabor::theory::lennard_jones_sphere::State]>| {
        let pair = pair.expect("the approach lies between the folds");
        radial.between(pair, at).expect("a state").force
    };
    let together = force(curve.windows(2).find(crosses));
    let apart = force(curve.windows(2).rfind(crosses));
    let solved = sphere.solve("approach", &[-2.5, -1.5, -1.43, at, -1.0, -1.3, at]);
    let forces: Vec<f64> = solved
        .rows()
        .map(|row| sphere.force(row.force, at))
        .collect();
    println!(
        "at {at}: {} of {together}, {} of {apart}",
        forces[3], forces[6]
    );
    // The force rises by some 3 a range on either branch, this near to the folds.
    let allowed = 3.0 * accuracy(sphere.mu);
    assert!(together - apart > 20.0 * allowed, "{together} {apart}");
    assert!(
        (forces[3] - together).abs() < allowed,
        "{forces:?} {together}"
    );
    assert!((forces[6] - apart).abs() < allowed, "{forces:?} {apart}");
}

/// The stiffer the solid, the nearer a rigid sphere: the force is 2 pi R times the energy per area
/// at the least gap. At mu = 0.1 the tabulated pull-off is 1.6 % below it, and the difference falls
/// faster than mu: less than 8e-4 at 0.005. The sum over pixels of a smooth traction adds nothing.
fn bradley() {
    let sphere = Sphere::resolved(0.005, 0.0, "bradley").expect("a small mu");
    let law = LennardJones {
        work_of_adhesion: 1.0,
        range: 1.0,
    };
    let path = [-3.0, -2.0, -1.0, -0.5, -0.2, -0.1, -0.05];
    let solved = sphere.solve("approach", &path);
    for (row, at) in solved.rows().zip(path) {
        let (force, rigid) = (sphere.force(row.force, at), law.energy(-at));
        assert!(
            (force - rigid).abs() < 8e-4,
            "at {at}: {force}, rigid {rigid}"
        );
    }
    let held = 2.0 * PI * (1.0 + sphere.outside(0.0));
    let solved = sphere.solve(
        "force",
        &[0.0, -0.9 * held, -(1.0 - 8e-4) * held, -(1.0 + 8e-4) * held],
    );
    let states: Vec<State> = solved.rows().map(|row| row.state).collect();
    assert_ne!(states[2], State::Separated);
    assert_eq!(states[3], State::Separated);
    assert_eq!(solved.end.jump_off_steps, [4]);
}

tests![
    curves,
    pull_off,
    jumps,
    a_wave_jumps_where_its_ways_are_apart,
    jumps_between_close_folds,
    two_states_between_shallow_folds,
    bradley,
];
