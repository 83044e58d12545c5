//! Grids in several slabs against the same grids in one: operator, kernels of each kind, whole solves.
//!
//! Slabs are forced small here; a slab's workgroups are those of the whole grid, row by row, so that
//! what rows and columns compute agrees bit by bit. Sums over points are put together in another
//! order, so that they agree to the rounding of a double.

use tabor::backend::cpu;
use tabor::backend::gpu::{AdapterChoice, Faults, GpuDevice};
use tabor::backend::{Backend, Factors, Field, Level, Response, Shape};
use tabor::elastic::HalfSpace;
use tabor::grid::Grid;
use tabor::kernel::displacement::{LOAD_DISPLACEMENT, LOAD_FIELD, STORE_FIELD};
use tabor::kernel::{Constraint, Form, Gate, Kernel, Params, Reduce, Scalars, Status};
use tabor::kernel::{descent, measure, multilevel, trial, update};
use tabor::law::{Law, LennardJones, MaugisDugdale};
use tabor::scene::Boundary;
use tabor::solver::{ContactSolver, Hold, Load, Outcome, Problem, Start};

use crate::shared::device::{backend, device, device_with, relative_difference};
use crate::shared::random::Random;
use crate::shared::trials::{is_long, tests};

/// A device that holds so many bytes of a field in one buffer.
fn in_slabs(bytes: u64) -> GpuDevice {
    device_with(&AdapterChoice {
        faults: Faults {
            slab_bytes: Some(bytes),
            ..Faults::default()
        },
        ..AdapterChoice::default()
    })
}

/// A device whose workgroups hold lines of so many points, and slabs of so many bytes.
fn with_lines(points: usize, bytes: u64) -> GpuDevice {
    device_with(&AdapterChoice {
        faults: Faults {
            longest_line: Some(points),
            slab_bytes: Some(bytes),
            ..Faults::default()
        },
        ..AdapterChoice::default()
    })
}

fn params(law: Law) -> Params {
    Params {
        law,
        stiffness_max: 2.0,
        pressure_floor: 1e-3,
        tolerance: 1e-4,
        heights_norm: 3.0,
        prescribed_mean_gap: true,
        may_detach: false,
        points: 1.0,
        smooth_stiffness: 0.4,
        level_compliance: 0.8,
        own_compliance: 0.6,
        neighbour_compliance: 0.05,
        softening: 0.7,
        hardness: 0.3,
        epsilon: f64::from(f32::EPSILON),
    }
}

/// A convolution of seeded numbers with a half-space, or with a table, and its energy.
fn convolve(backend: &mut dyn Backend, [nx, ny]: [usize; 2], tabulated: bool) -> (Vec<f64>, f64) {
    let shape = Shape::whole(nx, ny);
    let level = backend.level("fine", shape);
    let field = backend.field(level, "field");
    let result = backend.field(level, "result");
    let mut numbers = Random(nx as u64 * 4096 + ny as u64);
    // Different at each wavevector, so that a factor out of place shows.
    let factors: Vec<f64> = numbers.singles(shape.spectrum_len());
    let factors: Vec<f64> = factors.iter().map(|x| x + 1.0).collect();
    let half_space = HalfSpace::new(Grid::new([nx, ny], [1.0, 1.3]), 1.0 / nx as f64);
    let factors = match tabulated {
        true => Factors::Table(&factors),
        false => Factors::HalfSpace(half_space, Response::Stiffness),
    };
    let spectrum = backend.spectrum(level, "factors", factors);
    backend.set_params(&params(Law::HardWall));
    backend.set_zero_mode(spectrum, 0.75);
    backend.write(field, &numbers.singles(nx * ny));
    backend.write(result, &vec![f64::NAN; nx * ny]);
    backend.run(&LOAD_FIELD, level, &[field]);
    backend.multiply(spectrum, true, Gate::Always);
    backend.run(&STORE_FIELD, level, &[result]);
    let energy = backend.scalars().expect("nothing fails").curvature;
    assert_eq!(backend.transforms(), 2.0, "{nx} x {ny}");
    (backend.read(result).expect("nothing fails").into(), energy)
}

/// Slabs of a power of two and of other sizes, spectra in parts, legs of butterflies that lie in one
/// slab and such that cross from one to the next.
fn a_convolution_in_slabs_is_the_same_to_the_last_bit() {
    let device = device();
    for (size, bytes, slabs, tabulated) in [
        ([64, 64], 4 << 10, 4, false),
        // 42 pairs: six slabs of seven. The table is in two parts.
        ([120, 84], 7 << 10, 6, true),
        ([16, 250], 4 << 10, 5, false),
    ] {
        let split = in_slabs(bytes);
        assert_eq!(
            split.slabs(Shape::whole(size[0], size[1])),
            Ok(slabs),
            "{size:?}"
        );
        let one = convolve(&mut backend(device), size, tabulated);
        let many = convolve(&mut backend(&split), size, tabulated);
        assert!(
            one.0 == many.0,
            "{size:?}: {}",
            relative_difference(&many.0, &one.0)
        );
        assert!(one.0.iter().any(|x| *x != 0.0));
        // Of some thousand terms in double precision.
        assert!((one.1 / many.1 - 1.0).abs() < 1e-12, "{size:?}");
    }
}

/// Relative L2 error of a single-precision convolution, as of one with short lines: some ten roundings of
/// 6e-8, and one product with a root more each way.
const BOUND: f64 = 5e-7;

/// Lines in two passes along x, along y, along both, of equal and of unequal shares, and in slabs.
fn a_convolution_of_long_lines_agrees_with_the_processor() {
    for (size, points, bytes, tabulated) in [
        ([64, 64], 16, 1 << 20, false),
        ([64, 12], 16, 1 << 20, false),
        // 12 * 10 and 18 * 14, in six slabs of 21 pairs; 2 * 7 * 7 as 14 * 7 and 2 * 5^3 as 10 * 25.
        ([120, 252], 30, 20 << 10, true),
        ([98, 250], 30, 1 << 20, false),
        ([2, 96], 16, 256, false),
    ] {
        let long = with_lines(points, bytes);
        let reference = convolve(&mut *cpu::double(None), size, tabulated);
        let ours = convolve(&mut backend(&long), size, tabulated);
        let error = relative_difference(&ours.0, &reference.0);
        println!(
            "{size:?}: {error:e}, energy {:e}",
            ours.1 / reference.1 - 1.0
        );
        assert!(error < BOUND, "{size:?}: {error}");
        assert!((ours.1 / reference.1 - 1.0).abs() < BOUND, "{size:?}");
        let again = convolve(&mut backend(&long), size, tabulated);
        assert!(
            ours.0 == again.0 && ours.1 == again.1,
            "{size:?}: bits differ"
        );
    }
}

/// Fine and coarse points, each of several slabs, in rows that compile fast.
const FINE: [usize; 2] = [16, 48];
const COARSE: [usize; 2] = [8, 24];
/// Three slabs or more of the fine level: 24 pairs of rows, 3 KiB.
const SLAB: u64 = 1 << 10;
/// Lines that are long here: 4 * 4 and 8 * 6 points.
const LINE: usize = 8;
/// Difference at a point where lines take two passes, against one.
const LINE_BOUND: f64 = 2e-5;
/// Two slabs of the coarse level, 768 bytes, and six of the fine one.
const COARSE_SLAB: u64 = 512;

/// What a kernel makes of seeded fields: all it writes, and its sums.
fn run(
    backend: &mut dyn Backend,
    kernel: &'static Kernel,
    law: Law,
    shape: Shape,
) -> (Vec<Vec<f64>>, Vec<f64>) {
    let coarse = Shape::whole(COARSE[0], COARSE[1]);
    let [own, other] = match kernel.name == "coarsen" {
        true => [coarse, shape],
        false => [shape, coarse],
    };
    let mut numbers = Random(kernel.name.len() as u64 * 7919);
    let level = backend.level("own", own);
    let second = backend.level("other", other);
    let make = |backend: &mut dyn Backend, level: Level, values: &[f64]| -> Field {
        let field = backend.field(level, "field");
        backend.write(field, values);
        field
    };
    // Gaps come first, read or updated.
    let gaps = |numbers: &mut Random| -> Vec<f64> {
        let closed = |x: &f64| x.max(0.0);
        numbers.singles(own.len()).iter().map(closed).collect()
    };
    let mut fields = Vec::new();
    for place in 0..kernel.written().end {
        let values = match place == 0 || place == kernel.reads.len() {
            true => gaps(&mut numbers),
            false => numbers.singles(own.len()),
        };
        fields.push(make(backend, level, &values));
    }
    if kernel.around.is_some() {
        fields.push(make(backend, level, &numbers.singles(own.len())));
    }
    if kernel.whole {
        let values = numbers.singles(other.len());
        fields.push(make(backend, second, &values));
    }
    let lines = make(backend, level, &numbers.singles(own.len()));
    let ones = backend.spectrum(
        level,
        "ones",
        Factors::Table(&vec![1.0; own.spectrum_len()]),
    );
    backend.set_params(&params(law));
    let passing = Scalars {
        descent_factor: 1.0,
        ..Scalars::start(0.0, false)
    };
    backend.set_scalars(&passing);
    // Where all points are open, descent and trial pass the lines on as they are.
    let far = vec![1e3; own.len()];
    let spare = [&far[..], &far, &far].map(|values| make(backend, level, values));
    if kernel.form != Form::Sweep && kernel.form != Form::Load {
        backend.run(&LOAD_FIELD, level, &[lines]);
        backend.multiply(ones, false, Gate::Always);
    }
    if kernel.form.takes_retained() {
        backend.run(&descent::DESCENT[0], level, &spare);
    }
    backend.set_scalars(&Scalars {
        mean_pressure: 0.1,
        descent_factor: -1.0,
        beta: 0.3,
        mean_gap_shift: 0.05,
        trial_length: 0.7,
        mean_gap_correction: 0.1,
        step: 0.6,
        snap: 1e-3,
        accepted: true,
        status: Status::Running,
        ..Scalars::start(0.1, false)
    });
    if kernel.form != Form::Sweep && kernel.form != Form::Load {
        backend.run(&LOAD_FIELD, level, &[lines]);
        backend.multiply(ones, false, Gate::Always);
    }
    let own_gap = fields[0];
    if kernel.form.takes_retained() {
        backend.run(&descent::DESCENT[0], level, &[own_gap; 3]);
    }
    backend.run(kernel, level, &fields);
    let scalars = backend
        .scalars()
        .unwrap_or_else(|error| panic!("{}: {error}", kernel.name));
    if kernel.form.retains() {
        backend.set_scalars(&passing);
        backend.run(&trial::TRIAL[0], level, &spare);
    }
    if kernel.form.before_forward() || kernel.form.retains() {
        backend.multiply(ones, false, Gate::Always);
        backend.run(&STORE_FIELD, level, &[lines]);
    }
    let mut traces = fields[kernel.written()].to_vec();
    traces.push(lines);
    let read = |field| {
        let values = backend.read(field);
        values.unwrap_or_else(|error| panic!("{error}")).into()
    };
    let written = traces.into_iter().map(read).collect();
    let sums = kernel.sums.iter().map(|&sum| scalars.sums.get(sum));
    (written, sums.collect())
}

/// One of each form, with a field of another level and without. Software compiles a shader slowly, and
/// whole solves run the others.
static KINDS: [&Kernel; 9] = [
    &LOAD_DISPLACEMENT,
    &multilevel::LEVEL_DESCENT[0],
    &multilevel::SOFTEN[0],
    &trial::SMOOTH_DIRECTION,
    &trial::TRIAL[0],
    &update::UPDATE_AND_STORE[0],
    &update::ADVANCE[0],
    &measure::RESIDUAL[0],
    &multilevel::COARSEN,
];

fn every_kind_of_kernel_in_slabs_writes_the_same() {
    let device = device();
    let (fine, coarse) = (in_slabs(SLAB), in_slabs(COARSE_SLAB));
    let long = with_lines(LINE, SLAB);
    let padded = Shape {
        points: FINE,
        surface: [14, 40],
    };
    let whole = Shape::whole(COARSE[0], COARSE[1]);
    assert!(fine.slabs(padded).expect("slabs") >= 3);
    assert!(coarse.slabs(whole).expect("slabs") >= 2);
    for kernel in KINDS {
        let law = match kernel.constraint == Some(Constraint::Smooth) {
            true => Law::LennardJones(LennardJones {
                work_of_adhesion: 0.1,
                range: 0.5,
            }),
            false => Law::HardWall,
        };
        // A pad crosses slabs; what is read as a whole has none.
        let shape = match kernel.whole {
            true => Shape::whole(FINE[0], FINE[1]),
            false => padded,
        };
        // The coarse level is cut too where a kernel reads it or lives there.
        let split = match kernel.whole {
            true => &coarse,
            false => &fine,
        };
        let one = run(&mut backend(device), kernel, law, shape);
        let many = run(&mut backend(split), kernel, law, shape);
        assert!(one.0 == many.0, "{}: other fields", kernel.name);
        for (slot, (a, b)) in one.1.iter().zip(&many.1).enumerate() {
            // Double precision adds terms of either sign, of some thousand in all.
            let bound = match kernel.sums[slot].reduce() {
                Reduce::Add => 1e-11 * (1.0 + a.abs()),
                Reduce::Min | Reduce::Max => 0.0,
            };
            assert!(
                a == b || (a - b).abs() <= bound,
                "{} {slot}: {a} {b}",
                kernel.name
            );
        }
        if kernel.form == Form::Sweep {
            continue;
        }
        let parted = run(&mut backend(&long), kernel, law, shape);
        for (one, parted) in one.0.iter().zip(&parted.0) {
            // Some roundings of the transforms, of numbers up to some units.
            let apart = |(a, b): (&f64, &f64)| (a - b).abs();
            let worst = one.iter().zip(parted).map(apart).fold(0.0, f64::max);
            assert!(worst < LINE_BOUND, "{}: {worst:e}", kernel.name);
        }
    }
}

/// Heights of a few waves over the unit square.
fn wavy(points: usize) -> (Grid, Vec<f64>) {
    let grid = Grid::new([points, points], [1.0, 1.0]);
    let heights = (0..points * points)
        .map(|index| {
            let at = |i: usize| std::f64::consts::TAU * (i as f64 + 0.5) / points as f64;
            let (x, y) = (at(index % points), at(index / points));
            0.02 * (x.cos() + y.sin() + 0.5 * (3.0 * x + 2.0 * y).cos() + 0.3 * (5.0 * y - x).sin())
        })
        .collect();
    (grid, heights)
}

fn solve(device: &GpuDevice, problem: &Problem, load: &Load) -> (Outcome, Vec<f64>, Vec<f64>) {
    let make = || -> Box<dyn Backend + Send> { Box::new(backend(device)) };
    let mut backend = make();
    let mut solver = ContactSolver::new(&mut *backend, problem);
    let outcome = solver
        .solve(load, &Start::Cold, 1e-4, 2000, false, &make, &mut |_| true)
        .unwrap_or_else(|error| panic!("{error}"));
    let gap = solver.gap().unwrap_or_else(|error| panic!("{error}"));
    let pressure = solver.elastic_pressure();
    (
        outcome,
        gap.into(),
        pressure.unwrap_or_else(|error| panic!("{error}")).into(),
    )
}

/// The laws under what holds them, the levels of the preconditioner and the pad of a free
/// boundary among them.
fn whole_solves_in_slabs_agree_with_those_in_one() {
    let device = device();
    // 32 x 32 numbers of four bytes in slabs of 1 KiB: four, with the pad too. Software compiles each slab of a shader.
    let split = in_slabs(1 << 10);
    // Lines of 32 points take two passes, those of the coarse grid one.
    let long = with_lines(8, 1 << 10);
    let dugdale = Law::MaugisDugdale(MaugisDugdale {
        peak_tension: 0.05,
        range: 5e-3,
        taper: 5e-3,
    });
    let jones = Law::LennardJones(LennardJones {
        work_of_adhesion: 2.5e-4,
        range: 5e-3,
    });
    for (name, law, boundary, held) in [
        (
            "wall under pressure",
            Law::HardWall,
            Boundary::Periodic,
            false,
        ),
        (
            "Lennard-Jones under pressure",
            jones,
            Boundary::Periodic,
            false,
        ),
        (
            "Maugis-Dugdale at a mean gap",
            dugdale,
            Boundary::Periodic,
            true,
        ),
        (
            "Maugis-Dugdale on a free boundary",
            dugdale,
            Boundary::Free,
            false,
        ),
    ] {
        // The others ask more of the slabs.
        if law == Law::HardWall && !is_long() {
            continue;
        }
        let (grid, heights) = wavy(match boundary {
            Boundary::Periodic => 32,
            Boundary::Free => 16,
        });
        let problem = Problem::new(grid, boundary, 1.0, &heights, 1.0, law);
        let softest = ContactSolver::pressure_compliance(&problem, 0.05);
        let hold = match held {
            true => Hold::Gap(0.04 / problem.scales.length),
            false => Hold::Pressure(0.02 / problem.scales.pressure),
        };
        let load = Load {
            hold,
            zero_stiffness: 0.0,
            zero_compliance: match boundary {
                Boundary::Periodic => softest,
                Boundary::Free => 1.0 / problem.stiffness.zero_mode(),
            },
        };
        assert!(split.slabs(problem.shape).expect("slabs") >= 4);
        let one = solve(device, &problem, &load);
        let many = solve(&split, &problem, &load);
        let apart = [
            relative_difference(&many.1, &one.1),
            relative_difference(&many.2, &one.2),
        ];
        println!("{name}: {:?} {apart:?}", one.0);
        assert_eq!(one.0.status, Status::Converged, "{name}");
        assert_eq!(many.0.status, Status::Converged, "{name}");
        assert_eq!(one.0.iterations, many.0.iterations, "{name}");
        // Step lengths that differ in the last bit of a double differ in none of a single, but for
        // those that round the other way: then fields differ by some roundings of 6e-8.
        assert!(apart.iter().all(|&apart| apart < 1e-5), "{name}: {apart:?}");
        // Long lines twice: where a search asks and where there is a pad; software compiles slowly.
        if held || law == Law::HardWall {
            continue;
        }
        // Other roundings in the transforms: another answer within the tolerance of 1e-4, to which
        // pressures, which weigh short waves, agree to ten times that.
        let parted = solve(&long, &problem, &load);
        let apart = [
            relative_difference(&parted.1, &one.1),
            relative_difference(&parted.2, &one.2),
        ];
        println!("{name}, long lines: {:?} {apart:?}", parted.0);
        assert_eq!(parted.0.status, Status::Converged, "{name}");
        assert!(apart.iter().all(|&apart| apart < 1e-3), "{name}: {apart:?}");
    }
}

tests![
    a_convolution_in_slabs_is_the_same_to_the_last_bit,
    a_convolution_of_long_lines_agrees_with_the_processor,
    every_kind_of_kernel_in_slabs_writes_the_same,
    whole_solves_in_slabs_agree_with_those_in_one,
];
