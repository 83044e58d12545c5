//! Flat plates, whose answer is known in closed form whatever the position, the grid and the law.
//!
//! Two flat plates at a gap g meet the same pressure -sigma(g) everywhere. So a held mean gap or approach has
//! that gap and -sigma there; a held pressure p between minus the strength of the law and infinity has the
//! stable gap at which sigma = -p, which a wall makes 0; a spring has the gap at which it pulls as hard as the
//! law. Only the last two can be unstable, and the last not if the spring is stiffer than the law is steep.
//!
//! The laws here are those of the literature, written again. Positions, pressures and energies are asked to
//! the rounding of a mean of up to 128 x 128 numbers added one by one, 2e-12, and where the law is steep to what
//! that makes of its traction.

use std::convert::Infallible;
use std::f64::consts::PI;
use std::fmt::Write;

use tabor::backend::Backend;
use tabor::backend::cpu;
use tabor::kernel::Scalars;
use tabor::scene::FieldName;
use tabor::solver::{MOST_ROUNDS, ROUNDS_PER_ITERATION, TRIALS_PER_ITERATION};
use tabor::study::{FinishedStep, Observer, State, StepRow, walk};

use crate::bench::{Maker, cpu, setup, solve_on};
use crate::shared::random::Random;
use crate::shared::trials::tests;

/// Error of a mean of 128 x 128 numbers added one by one in double precision, and as much again.
const ROUNDING: f64 = 4e-12;

/// Points each way: none of these is like the others in what its transform takes.
const SIZES: [[usize; 2]; 20] = [
    [1, 1],
    [2, 1],
    [1, 3],
    [1, 13],
    [5, 2],
    [7, 7],
    [8, 8],
    [11, 4],
    [16, 16],
    [17, 19],
    [23, 2],
    [24, 64],
    [31, 31],
    [32, 27],
    [48, 48],
    [61, 1],
    [64, 60],
    [97, 53],
    [127, 8],
    [128, 128],
];

#[derive(Clone, Copy, Debug, PartialEq)]
enum Law {
    Wall,
    Dugdale { taper: f64 },
    Exponential,
    LennardJones,
}

/// Plates on a half-space, SI.
#[derive(Clone, Copy, Debug)]
struct Plates {
    points: [usize; 2],
    pixel: f64,
    modulus: f64,
    law: Law,
    work: f64,
    range: f64,
    /// Lowest and highest factor of stripes on the tension, if there are any.
    stripes: Option<[f64; 2]>,
    free: bool,
    /// Largest pressure before the solid flows.
    hardness: Option<f64>,
}

impl Plates {
    /// Plates of a law with everything else drawn.
    fn draw(random: &mut Random, points: [usize; 2], law: Law) -> Plates {
        let range = random.between(1e-10, 1e-6);
        let modulus = random.between(1e5, 1e11);
        let pixel = random.between(1e-9, 1e-5);
        Plates {
            points,
            pixel,
            modulus,
            law: match law {
                // From a narrow end to the widest.
                Law::Dugdale { taper } if taper > 0.0 => Law::Dugdale {
                    taper: random.between(1e-3, 2.0) * range,
                },
                law => law,
            },
            // chi = w dx/(E* range^2) from far below to above what the grid resolves.
            work: random.between(1e-4, 3.0) * modulus * range * range / pixel,
            range,
            stripes: None,
            free: false,
            hardness: None,
        }
    }

    fn peak(&self) -> f64 {
        self.work / self.range
    }

    /// Attraction across a gap.
    fn traction(&self, gap: f64) -> f64 {
        match self.law {
            Law::Wall => 0.0,
            Law::Dugdale { taper } if taper > 0.0 => {
                self.peak() * ((self.range - gap) / taper + 0.5).clamp(0.0, 1.0)
            }
            Law::Dugdale { .. } if gap < self.range => self.peak(),
            Law::Dugdale { .. } => 0.0,
            Law::Exponential => self.peak() * (-gap / self.range).exp(),
            Law::LennardJones => {
                let near = self.range / (gap + self.range);
                8.0 / 3.0 * self.peak() * (near.powi(3) - near.powi(9))
            }
        }
    }

    /// How steep the law is at most from a gap on.
    fn steepest(&self, gap: f64) -> f64 {
        match self.law {
            Law::Wall => 0.0,
            Law::Dugdale { taper } if taper > 0.0 => self.peak() / taper,
            Law::Dugdale { .. } => 0.0,
            Law::Exponential => self.peak() / self.range,
            Law::LennardJones => {
                let near = self.range / (gap.min(0.0) + self.range);
                8.0 * self.peak() / self.range * 3.0 * near.powi(10)
            }
        }
    }

    /// Largest attraction.
    fn strength(&self) -> f64 {
        match self.law {
            Law::Wall => 0.0,
            Law::LennardJones => 16.0 / (9.0 * 3f64.sqrt()) * self.peak(),
            _ => self.peak(),
        }
    }

    fn area(&self) -> f64 {
        self.points[0] as f64 * self.points[1] as f64 * self.pixel * self.pixel
    }

    fn scene(&self, loading: &str, solver: &str) -> String {
        let [nx, ny] = self.points;
        let [width, height] = self.points.map(|n| n as f64 * self.pixel);
        let mut text = format!(
            "[grid]\npoints = [{nx}, {ny}]\nsize = [{width:e}, {height:e}]\n{}\
             [solid]\ncontact_modulus = {:e}\n{}[[surface]]\nkind = \"flat\"\n",
            if self.free {
                "boundary = \"free\"\n"
            } else {
                ""
            },
            self.modulus,
            self.hardness.map_or(String::new(), |hardness| format!(
                "hardness = {hardness:e}\n"
            )),
        );
        let (law, more) = match self.law {
            Law::Wall => ("", String::new()),
            Law::Dugdale { taper } => ("maugis-dugdale", format!("taper = {taper:e}\n")),
            Law::Exponential => ("exponential", String::new()),
            Law::LennardJones => ("lennard-jones", String::new()),
        };
        if self.law != Law::Wall {
            write!(
                text,
                "[adhesion]\nlaw = \"{law}\"\nwork_of_adhesion = {:e}\nrange = {:e}\n{more}",
                self.work, self.range
            )
            .expect("text takes all");
            if let Some([low, high]) = self.stripes {
                // Half of an even number of columns each.
                let period = 2.0 * self.pixel;
                writeln!(
                    text,
                    "map = {{ pattern = \"stripe\", period = {period:e}, low = {low}, high = {high} }}"
                )
                .expect("text takes all");
            }
        }
        text + "[loading]\n" + loading + "\n[solver]\n" + solver + "\n"
    }
}

fn path(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|value| format!("{value:e}")).collect();
    format!("path = [{}]", values.join(", "))
}

/// What a step of every kind keeps.
fn check_end(row: &StepRow, what: &str) {
    assert!(row.converged, "{what}: {row:?}");
    assert!(row.residual.is_finite(), "{what}: {row:?}");
}

fn check(found: f64, expected: f64, allowed: f64, what: &str) {
    let off = (found - expected).abs();
    assert!(
        off <= allowed,
        "{what}: {found:e}, not {expected:e}, {allowed:e} allowed"
    );
}

const LAWS: [Law; 5] = [
    Law::Wall,
    Law::Dugdale { taper: 0.0 },
    Law::Dugdale { taper: 1.0 },
    Law::Exponential,
    Law::LennardJones,
];

/// A path in and out of the range, to contact and from it.
fn gaps(random: &mut Random, plates: &Plates) -> Vec<f64> {
    let range = plates.range;
    let mut gaps = vec![0.9 * range, 1.2 * range];
    gaps.extend((0..4).map(|_| random.between(1e-3, 30.0) * range));
    if plates.law == Law::LennardJones {
        gaps.push(-0.1 * range);
    } else {
        gaps.push(0.0);
    }
    gaps.extend([0.3 * range, 2.5 * range, 0.9 * range, 40.0 * range]);
    gaps
}

/// Each gap of a path with the one before it.
fn steps(gaps: &[f64]) -> impl Iterator<Item = [f64; 2]> {
    let before = std::iter::once(&gaps[0]).chain(gaps);
    before.zip(gaps).map(|(before, gap)| [*before, *gap])
}

/// A step from `before` to `gap`: a gap comes from the one before by a shift, whose rounding is that of the larger.
fn check_held(plates: &Plates, row: &StepRow, [before, gap]: [f64; 2], rounding: f64, what: &str) {
    check_end(row, what);
    let span = gap.abs().max(before.abs());
    check(row.mean_gap.expect("a gap"), gap, rounding * span, what);
    check(
        row.approach.expect("an approach"),
        -gap,
        rounding * span,
        what,
    );
    // Beside a wall at gap 0 nothing says how hard the plates are pressed: as little as keeps them there.
    let expected = -plates.traction(gap);
    let allowed = rounding * (plates.steepest(gap) * (span + plates.range) + expected.abs());
    check(row.mean_pressure, expected, allowed, what);
    let touches = match plates.law {
        Law::LennardJones => gap < 0.0,
        _ => gap == 0.0,
    };
    let share = if touches { 1.0 } else { 0.0 };
    assert_eq!(row.contact_area_fraction, share, "{what}: {row:?}");
    // What is left of the elastic energy is made of roundings: of the gap, against the pressure, and of the
    // stiffest wave of both.
    let stiffest = 4.0 * plates.modulus / plates.pixel * rounding * span;
    let pressed = plates.strength().max(expected.abs()) + stiffest;
    check(
        row.elastic_energy,
        0.0,
        rounding * pressed * plates.area() * span,
        what,
    );
}

fn a_held_gap_is_kept_and_pulls_as_the_law_does() {
    let mut random = Random(1);
    for points in SIZES {
        for law in LAWS {
            for control in ["mean-gap", "approach"] {
                let plates = Plates::draw(&mut random, points, law);
                let gaps = gaps(&mut random, &plates);
                let asked: Vec<f64> = match control {
                    "approach" => gaps.iter().map(|gap| -gap).collect(),
                    _ => gaps.clone(),
                };
                let loading = format!("control = \"{control}\"\n{}", path(&asked));
                let solved = solve_on(&plates.scene(&loading, ""), &cpu);
                assert_eq!(solved.steps.len(), gaps.len(), "{plates:?} {control}");
                for (step, way) in solved.steps.iter().zip(steps(&gaps)) {
                    let what = format!("{plates:?} {control} {way:?}");
                    check_held(&plates, &step.row, way, ROUNDING, &what);
                }
            }
        }
    }
}

/// A solid that flows does not where nothing presses.
fn plates_that_could_flow_keep_a_held_gap() {
    let mut random = Random(7);
    for points in SIZES.into_iter().step_by(3) {
        for law in &LAWS[..4] {
            let mut plates = Plates::draw(&mut random, points, *law);
            plates.hardness = Some(0.1 * plates.modulus + 10.0 * plates.strength());
            let gaps: Vec<f64> = gaps(&mut random, &plates)
                .into_iter()
                .filter(|gap| *gap > 0.0)
                .collect();
            let asked: Vec<f64> = gaps.iter().map(|gap| -gap).collect();
            let loading = format!("control = \"approach\"\n{}", path(&asked));
            let solved = solve_on(&plates.scene(&loading, ""), &cpu);
            assert_eq!(solved.steps.len(), gaps.len(), "{plates:?}");
            for (step, way) in solved.steps.iter().zip(steps(&gaps)) {
                let what = format!("{plates:?} {way:?}");
                check_held(&plates, &step.row, way, ROUNDING, &what);
            }
        }
    }
}

/// The places at which they were lost: a checker's fields of 16 points on 128 x 128, out of the range in one
/// step, over laws from narrow to wide ends and solids from soft to stiff.
fn plates_with_a_checker_leave_the_range_together() {
    for (taper, modulus, side) in [
        (0.0, 1e8, 1e-6),
        (0.0, 1e9, 1e-7),
        (1e-9, 1e7, 1e-7),
        (1e-9, 1e9, 1e-7),
        (1e-9, 1e9, 1e-6),
        (1e-9, 1e10, 1e-6),
    ] {
        for control in ["mean-gap", "approach"] {
            let sign = if control == "approach" { -1.0 } else { 1.0 };
            let text = format!(
                "[grid]\npoints = 128\nsize = {side:e}\n[solid]\ncontact_modulus = {modulus:e}\n\
                 [[surface]]\nkind = \"flat\"\n[adhesion]\nlaw = \"maugis-dugdale\"\n\
                 work_of_adhesion = 0.05\nrange = 1e-8\ntaper = {taper:e}\n\
                 map = {{ pattern = \"checker\", period = {:e}, low = 0.5, high = 1.0 }}\n\
                 [loading]\ncontrol = \"{control}\"\npath = [{:e}, {:e}]\n",
                0.25 * side,
                sign * 9e-9,
                sign * 12e-9,
            );
            let solved = solve_on(&text, &cpu);
            assert_eq!(solved.steps.len(), 2, "{text}");
            let (first, second) = (&solved.steps[0].row, &solved.steps[1].row);
            for (row, gap) in [(first, 9e-9), (second, 12e-9)] {
                check_end(row, &text);
                check(row.mean_gap.expect("a gap"), gap, ROUNDING * gap, &text);
            }
            assert_eq!(second.state, State::Separated, "{text} {second:?}");
            assert_eq!(second.force, 0.0, "{text} {second:?}");
        }
    }
}

/// Counts how often a solve lets itself be looked at, and ends it beyond a number.
struct Looks {
    looks: usize,
    most: usize,
    residuals: Vec<(bool, f64)>,
}

impl Observer for Looks {
    type Error = Infallible;

    fn step(&mut self, step: FinishedStep) -> Result<(), Infallible> {
        self.residuals.push((step.row.converged, step.row.residual));
        Ok(())
    }

    fn iteration(&mut self, _: usize, _: &Scalars) -> bool {
        self.looks += 1;
        self.looks <= self.most
    }
}

/// Whatever the start, a solve ends within the rounds that its constants name. A spring whose far end is
/// drawn away from the plates starts with the whole force of it off balance and no pressure to measure that by.
fn a_solve_ends_within_its_rounds() {
    let mut random = Random(8);
    for law in LAWS {
        for (max_iterations, far) in [(1, 7.2), (1, 0.5), (2, -0.5), (3, 60.0), (40, 7.2)] {
            for points in [[16, 16], [7, 7]] {
                let plates = Plates::draw(&mut random, points, law);
                let stiffness = random.between(1e-3, 1e3) * plates.modulus / plates.range;
                let loading = format!(
                    "control = \"approach\"\nspring = {:e}\n{}",
                    stiffness * plates.area(),
                    path(&[
                        -far * plates.range,
                        -0.9 * plates.range,
                        -far * plates.range
                    ])
                );
                let ways: [(&str, Maker, usize); 2] = [
                    ("double", &cpu, ROUNDS_PER_ITERATION),
                    ("mixed", &mixed, TRIALS_PER_ITERATION * (1 + MOST_ROUNDS)),
                ];
                for (precision, backend, rounds) in ways {
                    let solver =
                        format!("precision = \"{precision}\"\nmax_iterations = {max_iterations}");
                    let text = plates.scene(&loading, &solver);
                    let mut looks = Looks {
                        looks: 0,
                        most: 3 * rounds * max_iterations,
                        residuals: Vec::new(),
                    };
                    let end = walk(&setup(&text), &|| backend(), &mut looks)
                        .unwrap_or_else(|error| panic!("{error}"));
                    assert!(!end.interrupted, "{} looks: {text}", looks.looks);
                    for (converged, residual) in looks.residuals {
                        assert!(!converged || residual.is_finite(), "{residual} {text}");
                    }
                }
            }
        }
    }
}

fn single() -> Box<dyn Backend + Send> {
    cpu::single(None)
}

fn mixed() -> Box<dyn Backend + Send> {
    cpu::mixed(None)
}

/// Single precision keeps a gap to its rounding; mixed precision has that of double.
fn other_precisions_keep_a_held_gap() {
    let mut random = Random(2);
    for (points, law) in [[1, 1], [7, 7], [24, 64], [31, 31]]
        .into_iter()
        .flat_map(|points| LAWS.map(|law| (points, law)))
    {
        let plates = Plates::draw(&mut random, points, law);
        let gaps = gaps(&mut random, &plates);
        let loading = format!("control = \"mean-gap\"\n{}", path(&gaps));
        // The rounding of one number is all that an equal gap has in single precision.
        let ways: [(&str, f64, Maker); 2] = [
            ("precision = \"mixed\"", ROUNDING, &mixed),
            ("precision = \"single\"\ntolerance = 1e-4", 4e-7, &single),
        ];
        for (precision, rounding, backend) in ways {
            let solved = solve_on(&plates.scene(&loading, precision), backend);
            assert_eq!(solved.steps.len(), gaps.len(), "{plates:?} {precision}");
            for (step, way) in solved.steps.iter().zip(steps(&gaps)) {
                let what = format!("{plates:?} {precision} {way:?}");
                check_held(&plates, &step.row, way, rounding, &what);
            }
        }
    }
}

/// With a map the plates are flat where nothing pulls. Where the law is a plateau the tension is the map's,
/// whatever the gap, and its mean is that of the map. In between the surface is lifted where the law pulls
/// most, and the energy cannot be above that of plates kept flat, from which the first step starts.
fn a_map_keeps_the_gap_and_pulls_by_its_mean() {
    let mut random = Random(3);
    for points in SIZES.into_iter().filter(|points| points[0] % 2 == 0) {
        for law in &LAWS[1..] {
            for control in ["mean-gap", "approach"] {
                let mut plates = Plates::draw(&mut random, points, *law);
                let [low, high] = [0.5 * random.share(), 1.0];
                let mean = 0.5 * (low + high);
                plates.stripes = Some([low, high]);
                // Stripes of one pixel meet K = pi E*/(2 dx): they lift less than a hundredth of the range.
                let stiff = 50.0 * plates.peak() * plates.pixel / plates.range;
                plates.modulus = stiff * random.between(1.0, 1e4);
                if let Law::Dugdale { taper } = &mut plates.law {
                    *taper = taper.min(0.1 * plates.range);
                }
                let range = plates.range;
                let gaps = [0.9, 1.2, 0.5, 3.0, 0.3, 1.1].map(|share| share * range);
                let signed = |gap: f64| if control == "approach" { -gap } else { gap };
                let loading = format!("control = \"{control}\"\n{}", path(&gaps.map(signed)));
                let solved = solve_on(&plates.scene(&loading, "tolerance = 1e-9"), &cpu);
                assert_eq!(solved.steps.len(), gaps.len(), "{plates:?} {control}");
                for (index, (step, &gap)) in solved.steps.iter().zip(&gaps).enumerate() {
                    let what = format!("{plates:?} {control} {gap:e}");
                    let row = &step.row;
                    check_end(row, &what);
                    check(row.mean_gap.expect("a gap"), gap, ROUNDING * gap, &what);
                    let dugdale = matches!(plates.law, Law::Dugdale { .. });
                    // At 0.9 and 1.2 ranges and farther from its end the law is a constant.
                    let near_end = dugdale && (gap / range - 1.0).abs() < 0.15;
                    if dugdale && !(near_end && gap > range) {
                        let expected = -mean * plates.traction(gap);
                        check(row.mean_pressure, expected, 1e-8 * plates.peak(), &what);
                    }
                    if dugdale && gap > 1.15 * range {
                        let field = solved.fields(index).field(FieldName::Gap, &[]);
                        assert!(
                            field.iter().all(|g| (g - gap).abs() <= ROUNDING * gap),
                            "{what}: {field:?}"
                        );
                        assert_eq!(row.state, State::Separated, "{what}");
                    }
                    // Lifting by u changes the traction by less than its slope times u, of both signs alike.
                    let lifted = plates.peak() * plates.pixel / plates.modulus;
                    let allowed = plates.steepest(gap) * lifted + 1e-8 * plates.peak();
                    let expected = -mean * plates.traction(gap);
                    check(row.mean_pressure, expected, allowed, &what);
                    if index == 0 {
                        let flat = flat_energy(&plates, gap) * mean * plates.area();
                        let energy = row.elastic_energy + row.adhesive_energy;
                        assert!(
                            energy <= flat + 1e-12 * flat.abs(),
                            "{what}: {energy:e} {flat:e}"
                        );
                    }
                }
            }
        }
    }
}

/// Energy per area of flat plates, by Simpson's rule over the traction from this gap to where it has
/// vanished; exact for a Dugdale law below its end.
fn flat_energy(plates: &Plates, gap: f64) -> f64 {
    if let Law::Dugdale { taper } = plates.law {
        assert!(gap < plates.range - 0.5 * taper);
        return -plates.peak() * (plates.range - gap);
    }
    // x/(1 - x) takes the tail in to the end.
    let pieces = 20_000;
    let integrand = |i: usize| {
        let x = i as f64 / f64::from(pieces);
        match i {
            20_000 => 0.0,
            _ => plates.traction(gap + plates.range * x / (1.0 - x)) / (1.0 - x).powi(2),
        }
    };
    let sum: f64 = (0..pieces as usize)
        .step_by(2)
        .map(|i| integrand(i) + 4.0 * integrand(i + 1) + integrand(i + 2))
        .sum();
    -plates.range * sum / (3.0 * f64::from(pieces))
}

/// Between minus the strength of the law and any pressure plates stand where the law rises with the gap: beside
/// a wall at no gap, for Lennard-Jones below the gap of the largest tension. Where it falls with the gap a
/// pressure cannot hold them, for a plate a little farther away is pulled less than the pressure pulls: they
/// jump into contact or leave each other. Beyond the strength nothing holds them.
fn a_held_pressure_has_the_stable_gap() {
    let mut random = Random(4);
    for points in SIZES {
        for law in LAWS {
            let plates = Plates::draw(&mut random, points, law);
            let strength = plates.strength();
            let scale = if law == Law::Wall {
                plates.modulus * 1e-3
            } else {
                strength
            };
            // 250 kPa beside 16 MPa of strength, then nothing, as where it was found.
            let mut asked = vec![
                1.6e-2 * scale,
                0.0,
                random.between(1e-3, 1e2) * scale,
                0.0,
                0.0,
            ];
            if law != Law::Wall {
                asked.extend([
                    -0.5 * scale,
                    0.0,
                    -0.99 * scale,
                    -1.01 * scale,
                    -0.5 * scale,
                ]);
            }
            asked.push(random.between(1e-2, 1e1) * scale);
            let loading = format!("control = \"pressure\"\n{}", path(&asked));
            let solved = solve_on(&plates.scene(&loading, "tolerance = 1e-9"), &cpu);
            assert_eq!(solved.steps.len(), asked.len(), "{plates:?}");
            let mut apart = false;
            for (step, &pressure) in solved.steps.iter().zip(&asked) {
                let row = &step.row;
                let what = format!("{plates:?} {pressure:e}: {row:?}");
                check_end(row, &what);
                // A wall alone only touches at zero load.
                let leaves = -pressure > strength || (law == Law::Wall && pressure == 0.0);
                // What has left is beyond reach of a tension that it could bear in contact. It begins anew,
                // from plates that touch.
                apart = leaves;
                if apart {
                    assert_eq!(row.state, State::Separated, "{what}");
                    assert_eq!((row.mean_gap, row.mean_pressure), (None, 0.0), "{what}");
                    continue;
                }
                let gap = row.mean_gap.unwrap_or_else(|| panic!("{what}"));
                assert_eq!(row.mean_pressure, pressure, "{what}");
                if law == Law::LennardJones {
                    assert!(gap <= (3f64.powf(1.0 / 6.0) - 1.0) * plates.range, "{what}");
                    let allowed =
                        2e-9 * pressure.abs() + ROUNDING * plates.steepest(gap) * plates.range;
                    check(-plates.traction(gap), pressure, allowed, &what);
                    if pressure == 0.0 {
                        check(gap, 0.0, ROUNDING * plates.range, &what);
                    }
                } else {
                    assert_eq!((gap, row.contact_area_fraction), (0.0, 1.0), "{what}");
                }
            }
            assert!(!apart, "the path ends pressed");
        }
    }
}

/// A spring stiffer than the law is steep has one gap for each place of its far end, at which it pulls as hard
/// as the law. Beside a wall it presses once it would pull the plates through each other.
fn a_stiff_spring_has_one_gap() {
    let mut random = Random(5);
    // A jump is looked for in every step: the largest grids, which a held gap and a held pressure are tried on, would take
    // most of the time.
    for points in SIZES.into_iter().filter(|[nx, ny]| nx * ny <= 1024) {
        for law in LAWS {
            let plates = Plates::draw(&mut random, points, law);
            // No wave may be softer than the law is steep, or even plates grow waves.
            let mut plates = plates;
            let longest = points[0].max(points[1]) as f64 * plates.pixel;
            let softest = PI * plates.modulus / longest;
            plates.work *= (0.3 * softest / plates.steepest(0.0)).min(1.0);
            let steep = match law {
                Law::Wall => plates.modulus / plates.range * 1e-3,
                // The step of a sharp law is no slope: the far end keeps away from where there are two gaps.
                Law::Dugdale { taper: 0.0 } => 20.0 * plates.peak() / plates.range,
                _ => 2.0 * plates.steepest(0.0),
            };
            let stiffness = steep * random.between(1.0, 100.0);
            let ends = [0.9, 1.2, 0.9, 3.0, 0.4, 2.0, 0.1, -0.05, 1.5, -7.2, 7.2]
                .map(|x| x * plates.range);
            let approach = ends.map(|end| -end);
            let spring = stiffness * plates.area();
            let loading = format!(
                "control = \"approach\"\nspring = {spring:e}\n{}",
                path(&approach)
            );
            let solved = solve_on(&plates.scene(&loading, "tolerance = 1e-9"), &cpu);
            assert_eq!(solved.steps.len(), ends.len(), "{plates:?}");
            for (step, &end) in solved.steps.iter().zip(&ends) {
                let row = &step.row;
                let what = format!("{plates:?} {end:e}: {row:?}");
                check_end(row, &what);
                let expected = sprung(&plates, stiffness, end);
                let force = stiffness * (expected - end);
                let scale =
                    force.abs() + plates.traction(expected).abs() + stiffness * expected.abs();
                check(
                    row.mean_gap.expect("a gap"),
                    expected,
                    1e-8 * scale / stiffness,
                    &what,
                );
                check(row.mean_pressure, force, 1e-8 * scale, &what);
            }
        }
    }
}

/// The gap at which a spring with this far end pulls as hard as the law, by halving: what pulls apart falls
/// from the far end down.
fn sprung(plates: &Plates, stiffness: f64, end: f64) -> f64 {
    let apart = |gap: f64| stiffness * (end - gap) - plates.traction(gap);
    let lowest = match plates.law {
        Law::LennardJones => -0.9 * plates.range,
        _ => 0.0,
    };
    if lowest == 0.0 && apart(0.0) <= 0.0 {
        return 0.0;
    }
    let (mut low, mut high) = (lowest, end.max(plates.range * 1e-3) + plates.range);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if apart(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Within the plateau of a Dugdale law a patch of a free half-space is pulled evenly, with the force of its
/// area, and beyond it not at all, where its gap is the one asked.
fn a_free_patch_is_pulled_by_its_area() {
    let mut random = Random(6);
    for points in [[1, 1], [3, 2], [7, 7], [24, 16], [31, 20], [32, 32]] {
        for taper in [0.0, 0.05] {
            let mut plates = Plates::draw(&mut random, points, Law::Dugdale { taper: 0.0 });
            plates.free = true;
            plates.law = Law::Dugdale {
                taper: taper * plates.range,
            };
            // Lifted by less than p sqrt(A)/E* 1.2, a fiftieth of the range.
            plates.modulus = 50.0 * plates.peak() * plates.area().sqrt() / plates.range;
            let gaps = [0.9, 1.2, 0.5, 3.0].map(|share| share * plates.range);
            let loading = format!("control = \"approach\"\n{}", path(&gaps.map(|gap| -gap)));
            let solved = solve_on(&plates.scene(&loading, "tolerance = 1e-9"), &cpu);
            for (step, &gap) in solved.steps.iter().zip(&gaps) {
                let row = &step.row;
                let what = format!("{plates:?} {gap:e}: {row:?}");
                check_end(row, &what);
                check(row.approach.expect("an approach"), -gap, 1e-8 * gap, &what);
                let force = -plates.traction(gap) * plates.area();
                check(
                    row.force,
                    force,
                    1e-8 * plates.peak() * plates.area(),
                    &what,
                );
                if gap > plates.range {
                    check(row.mean_gap.expect("a gap"), gap, 1e-8 * gap, &what);
                }
            }
            assert_eq!(solved.steps.len(), gaps.len(), "{plates:?}");
        }
    }
}

tests![
    a_held_gap_is_kept_and_pulls_as_the_law_does,
    plates_that_could_flow_keep_a_held_gap,
    plates_with_a_checker_leave_the_range_together,
    a_solve_ends_within_its_rounds,
    other_precisions_keep_a_held_gap,
    a_map_keeps_the_gap_and_pulls_by_its_mean,
    a_held_pressure_has_the_stable_gap,
    a_stiff_spring_has_one_gap,
    a_free_patch_is_pulled_by_its_area,
];
