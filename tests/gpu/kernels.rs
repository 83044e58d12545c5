//! Each kernel of the catalogue against its twin, in single and in double precision, and each scalar
//! kernel against its own, on seeded data.

use tabor::backend::cpu;
use tabor::backend::gpu::{AdapterChoice, Faults, GpuDevice, Number, Wide};
use tabor::backend::{Backend, Factors, Field, Level, Shape};
use tabor::kernel::declare::{DeviceValue, FromDevice, Kind, Word, members};
use tabor::kernel::descent::DESCENT;
use tabor::kernel::displacement::{LOAD_FIELD, STORE_FIELD};
use tabor::kernel::refinement::OUTER_RESIDUAL;
use tabor::kernel::trial::TRIAL;
use tabor::kernel::update::BALANCE;
use tabor::kernel::{Constraint, Form, Gate, Kernel, Params, Scalars, Status, Sum};
use tabor::law::{Exponential, Law, LennardJones, MaugisDugdale};

use crate::catalogue::{SCALAR_KERNELS, variants};
use crate::shared::device::{
    backend, device, device_with, device_with_double, device_without_double, double_backend,
};
use crate::shared::random::Random;
use crate::shared::trials::tests;

/// Fine and coarse points of the tests. Rows of 16 points are the cheapest to compile in software, four values a thread for
/// which a kernel is written out; their 40 pairs are two workgroups, the second half idle. `convolution.rs` transforms
/// other lengths.
pub const FINE: [usize; 2] = [16, 80];
const COARSE: [usize; 2] = [8, 40];
/// Points of the surface where there is a pad; no powers of two.
const SURFACE: [usize; 2] = [14, 70];
/// Halvings more of the level on which the share of free points is counted.
const SHARE_HALVINGS: usize = 1;
/// Difference at a point over the rounding error of the number, of values up to some units: the
/// transforms around a load or store part cost 4 of their root mean square, the law's steepest slope
/// (16) multiplies it.
const POINT_ROUNDINGS: f64 = 170.0;
/// Difference of a sum over its number of points, the same.
const SUM_ROUNDINGS: f64 = 17.0;
/// By how much a square of the 9-3 law's tension multiplies a rounding of the gap, in single precision: 2 * 9 |gap| / (gap +
/// range) where a step has taken the gap deepest here, to 0.1 from the end of the range of 0.5. A device may round the
/// product and the sum of a step once instead of twice.
const STEEPNESS: f64 = 72.0;

fn laws() -> [(&'static str, Law); 5] {
    let dugdale = |taper| {
        Law::MaugisDugdale(MaugisDugdale {
            peak_tension: 0.4,
            range: 0.2,
            taper,
        })
    };
    [
        ("hard wall", Law::HardWall),
        ("sharp Maugis-Dugdale", dugdale(0.0)),
        ("tapered Maugis-Dugdale", dugdale(0.1)),
        (
            "exponential",
            Law::Exponential(Exponential {
                work_of_adhesion: 0.1,
                range: 0.3,
            }),
        ),
        (
            "Lennard-Jones",
            Law::LennardJones(LennardJones {
                work_of_adhesion: 0.1,
                range: 0.5,
            }),
        ),
    ]
}

pub fn params(law: Law, prescribed_mean_gap: bool, number: Number) -> Params {
    Params {
        law,
        stiffness_max: 2.0,
        pressure_floor: 1e-3,
        tolerance: 1e-4,
        heights_norm: 3.0,
        prescribed_mean_gap,
        may_detach: !prescribed_mean_gap,
        points: 1.0,
        smooth_stiffness: 0.4,
        level_compliance: 0.8,
        own_compliance: 0.6,
        neighbour_compliance: 0.05,
        softening: 0.875,
        hardness: 0.3,
        epsilon: number.epsilon(),
    }
}

/// A state in which this gate is open and every factor counts.
fn open(gate: Gate) -> Scalars {
    Scalars {
        mean_pressure: 0.1,
        descent_factor: -1.0,
        beta: 0.3,
        mean_gap_shift: 0.05,
        trial_length: 0.7,
        mean_gap_correction: 0.1,
        step: 0.6,
        snap: 1e-3,
        accepted: true,
        searching: gate == Gate::Searching,
        status: Status::Running,
        ..Scalars::start(0.1, false)
    }
}

/// Kernels of the outer state.
const OUTER: [&str; 4] = [
    "outer_residual",
    "outer_pressure",
    "add_correction",
    "restore_outer_gap",
];

/// What is bound beside a kernel's fields, and their number.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub patterned: bool,
    pub based: bool,
    pub number: Number,
}

/// What a kernel leaves behind: its written fields, its lines and its sums.
pub struct Trace {
    pub fields: Vec<Vec<f64>>,
    pub sums: Vec<f64>,
}

/// Seeded values with all the digits that a field holds.
fn drawn_field(numbers: &mut Random, count: usize, number: Number) -> Vec<f64> {
    match number {
        Number::Single => numbers.singles(count),
        Number::Double => numbers.doubles(count),
    }
}

fn gap_like(values: Vec<f64>, law: &Law, flows: bool) -> Vec<f64> {
    let least = if law.has_wall() { 0.0 } else { -0.05 };
    let gap = |x: &f64| match flows {
        // Open, closed and below zero.
        true if x.abs() < 0.2 => 0.0,
        true => *x,
        false => x.max(least),
    };
    values.iter().map(gap).collect()
}

/// A state in which a wall's descent and trial pass lines on where all points are open.
fn passing() -> Scalars {
    Scalars {
        descent_factor: 1.0,
        ..Scalars::start(0.0, false)
    }
}

/// Runs a kernel on a fresh level with seeded fields; `poison` tells which of its written fields are
/// filled with NaN.
pub fn run(
    backend: &mut dyn Backend,
    kernel: &'static Kernel,
    params: &Params,
    shape: Shape,
    poison: &[bool],
    case: Case,
) -> Trace {
    let Case {
        patterned,
        based,
        number,
    } = case;
    // The whole field lies on the other level: coarse for a fine kernel, fine for a coarse one.
    let coarse_kernel = [
        "coarsen",
        "free_share",
        "weigh",
        "load_weighted",
        "store_weighted",
    ]
    .contains(&kernel.name);
    let [nx, ny] = if kernel.name == "free_share" {
        COARSE.map(|points| points >> SHARE_HALVINGS)
    } else {
        COARSE
    };
    let [own, other] = if coarse_kernel {
        [Shape::whole(nx, ny), shape]
    } else {
        [shape, Shape::whole(nx, ny)]
    };
    let mut numbers = Random(kernel.name.len() as u64 * 7919);
    let mut draw = |count: usize| drawn_field(&mut numbers, count, number);
    let level = backend.level("own", own);
    let second = backend.level("other", other);
    let make = |backend: &mut dyn Backend, level: Level, values: &[f64]| -> Field {
        let field = backend.field(level, "field");
        backend.write(field, values);
        field
    };
    let flows = kernel.constraint == Some(Constraint::HardnessLimit);
    let mut fields = Vec::new();
    for place in 0..kernel.written().end {
        let written = place >= kernel.reads.len();
        // Gaps are read first, or updated first.
        let values = if place == 0 || place == kernel.reads.len() {
            gap_like(draw(own.len()), &params.law, flows)
        } else {
            draw(own.len())
        };
        let values = match written && poison[place - kernel.reads.len()] {
            true => vec![f64::NAN; own.len()],
            false => values,
        };
        fields.push(make(backend, level, &values));
    }
    if kernel.around.is_some() {
        fields.push(make(backend, level, &draw(own.len())));
    }
    if kernel.whole {
        let values = gap_like(draw(other.len()), &Law::HardWall, false);
        fields.push(make(backend, second, &values));
    }
    let lines = make(backend, level, &draw(own.len()));
    let ones = backend.spectrum(
        level,
        "ones",
        Factors::Table(&vec![1.0; own.spectrum_len()]),
    );
    if patterned {
        let factors: Vec<f64> = draw(own.len()).iter().map(|x| x.abs() + 0.1).collect();
        let factors = make(backend, level, &factors);
        backend.set_law_factor(factors);
    }
    if based {
        let gaps = gap_like(draw(own.len()), &params.law, flows);
        let outer_gap = make(backend, level, &gaps);
        backend.set_outer_gap(Some(outer_gap));
    }
    backend.set_params(params);
    backend.set_scalars(&passing());
    let far = vec![1e3; own.len()];
    let [open_gap, blank, other_blank] =
        [&far[..], &draw(own.len()), &far].map(|values| make(backend, level, values));
    if kernel.form != Form::Sweep && kernel.form != Form::Load {
        backend.run(&LOAD_FIELD, level, &[lines]);
        backend.multiply(ones, false, Gate::Always);
    }
    if kernel.form.takes_retained() {
        // Everywhere open, the descent keeps the lines as they are.
        backend.run(&DESCENT[0], level, &[open_gap, blank, other_blank]);
    }
    backend.set_scalars(&open(kernel.gate));
    backend.run(kernel, level, &fields);
    let scalars = backend
        .scalars()
        .unwrap_or_else(|error| panic!("{}: {error}", kernel.name));
    if kernel.form.retains() {
        // Everywhere open, the trial loads what was kept.
        backend.set_scalars(&passing());
        backend.run(&TRIAL[0], level, &[open_gap, blank, other_blank]);
    }
    let gives = kernel.form.before_forward() || kernel.form.retains();
    if gives {
        backend.multiply(ones, false, Gate::Always);
        backend.run(&STORE_FIELD, level, &[lines]);
    }
    let written = fields[kernel.written()].to_vec();
    let mut read = |field| {
        let values = backend.read(field);
        values.unwrap_or_else(|error| panic!("{error}")).into()
    };
    let mut traces: Vec<Vec<f64>> = written.into_iter().map(&mut read).collect();
    if gives {
        traces.push(read(lines));
    }
    Trace {
        fields: traces,
        sums: kernel
            .sums
            .iter()
            .map(|&sum| scalars.sums.get(sum))
            .collect(),
    }
}

/// Whether there is no NaN; the least of nothing is infinite.
fn is_number(trace: &Trace) -> bool {
    trace
        .fields
        .iter()
        .flatten()
        .chain(&trace.sums)
        .all(|x| !x.is_nan())
}

/// Runs a kernel as its twin and on the device, and compares; `worst` keeps the largest differences at a
/// point and in a sum.
pub fn compare(
    kernel: &'static Kernel,
    params: &Params,
    shape: Shape,
    case: Case,
    cpu: &dyn Fn() -> Box<dyn Backend>,
    gpu: &dyn Fn() -> Box<dyn Backend>,
    worst: &mut [f64; 2],
) {
    // Fields that are only written are poisoned, so that what is left out shows.
    let poison: Vec<bool> = (0..kernel.writes.len())
        .map(|place| {
            let mut one = vec![false; kernel.writes.len()];
            one[place] = true;
            is_number(&run(&mut *cpu(), kernel, params, shape, &one, case))
        })
        .collect();
    let fresh = poison.iter().filter(|&&only_written| only_written).count();
    assert!(
        fresh == kernel.fresh && poison.is_sorted(),
        "{}: {poison:?}",
        kernel.name
    );
    let twin = run(&mut *cpu(), kernel, params, shape, &poison, case);
    let name = format!(
        "{}, {:?}, surface {:?}, {case:?}",
        kernel.name, params.law, shape.surface
    );
    assert!(is_number(&twin), "{name}");
    let ours = run(&mut *gpu(), kernel, params, shape, &poison, case);
    let epsilon = case.number.epsilon();
    let sum_roundings = match kernel.constraint {
        Some(Constraint::Smooth) => SUM_ROUNDINGS + 2.0 * STEEPNESS,
        _ => SUM_ROUNDINGS,
    };
    for (slot, (a, b)) in ours.sums.iter().zip(&twin.sums).enumerate() {
        // The least of nothing is infinite on both.
        let difference = if a == b { 0.0 } else { (a - b).abs() };
        let error = difference / (shape.len() as f64).max(b.abs());
        assert!(
            error < sum_roundings * epsilon,
            "{name}: sum {slot}: {a} against {b}"
        );
        worst[1] = worst[1].max(error);
    }
    for (slot, (ours, twin)) in ours.fields.iter().zip(&twin.fields).enumerate() {
        for (index, (a, b)) in ours.iter().zip(twin).enumerate() {
            let error = (a - b).abs() / b.abs().max(1.0);
            assert!(
                error < POINT_ROUNDINGS * epsilon,
                "{name}: output {slot} at {index}: {a} against {b}"
            );
            worst[0] = worst[0].max(error);
        }
    }
}

fn kernels_agree_with_their_twins() {
    let device = device();
    let padded = Shape {
        points: FINE,
        surface: SURFACE,
    };
    let mut worst = [0.0f64; 2];
    for kernel in variants() {
        for (_, law) in laws() {
            let smooth = kernel.constraint == Some(Constraint::Smooth);
            let hardness = kernel.constraint == Some(Constraint::HardnessLimit);
            let outer = OUTER.contains(&kernel.name);
            let constrained = !outer && kernel.constraint.is_some() && !smooth;
            let stores_residual = kernel.writes.contains(&"projected_residual");
            let fits = match law {
                // A constraint asks any law for its traction and its change: one of them in all kernels, and
                // another where both are asked.
                Law::Exponential(_) => {
                    let both = ["search", "update_state"].contains(&kernel.name);
                    both && constrained && !hardness && !stores_residual
                }
                // The outer state is kept in double precision, and asks for the traction alone.
                Law::LennardJones(_) if outer => smooth,
                Law::HardWall if outer => !smooth,
                Law::MaugisDugdale(dugdale) if hardness => dugdale.taper > 0.0,
                Law::LennardJones(_) => smooth,
                Law::HardWall => !smooth,
                _ => constrained,
            };
            if !fits {
                continue;
            }
            let fine = Shape::whole(FINE[0], FINE[1]);
            for (shape, prescribed_mean_gap, patterned, based) in [
                (fine, true, false, false),
                (padded, false, false, false),
                (padded, false, true, true),
                (fine, true, false, true),
            ] {
                // Each is a shader of its own, which software compiles slowly.
                let skipped = match kernel.whole || law == Law::HardWall {
                    true => patterned || (kernel.whole && shape == padded),
                    false => !patterned && (based || shape == padded),
                };
                // A solid with a hardness is never corrected.
                let corrects = smooth || constrained && !hardness;
                if skipped || (based && !corrects) {
                    continue;
                }
                let case = Case {
                    patterned,
                    based,
                    number: Number::Single,
                };
                compare(
                    kernel,
                    &params(law, prescribed_mean_gap, Number::Single),
                    shape,
                    case,
                    &|| cpu::single(None),
                    &|| Box::new(backend(device)),
                    &mut worst,
                );
            }
        }
    }
    println!(
        "largest differences: at a point {:e}, in a sum {:e} a point",
        worst[0], worst[1]
    );
}

/// The same in double precision, each kernel with as few laws as reach all that is written for them:
/// shaders in double are slow to compile in software. The exponential asks for exp, the core for powers.
fn kernels_in_double_precision_agree_with_their_twins() {
    let device = device_with_double();
    let number = Number::Double;
    let padded = Shape {
        points: FINE,
        surface: SURFACE,
    };
    let [hard, _, tapered, exponential, lennard_jones] = laws().map(|(_, law)| law);
    let mut worst = [0.0f64; 2];
    for kernel in variants() {
        let laws = match (kernel.name, kernel.constraint) {
            ("outer_residual", _) => vec![exponential, lennard_jones],
            (_, Some(Constraint::Smooth)) => vec![lennard_jones],
            (name, _) if OUTER.contains(&name) => vec![hard],
            // Traction and its change, and its slope and energy in a smooth law.
            ("residual" | "search", Some(Constraint::Unilateral)) => vec![exponential, tapered],
            (_, Some(Constraint::Unilateral)) => vec![exponential],
            (_, Some(Constraint::HardnessLimit)) => vec![tapered],
            (_, None) => vec![hard],
        };
        for law in laws {
            let case = Case {
                patterned: law != hard && !kernel.whole,
                based: false,
                number,
            };
            let shape = match kernel.whole {
                true => Shape::whole(FINE[0], FINE[1]),
                false => padded,
            };
            compare(
                kernel,
                &params(law, true, number),
                shape,
                case,
                &|| cpu::double(None),
                &|| Box::new(double_backend(device)),
                &mut worst,
            );
        }
    }
    println!(
        "largest differences: at a point {:e}, in a sum {:e} a point",
        worst[0], worst[1]
    );
}

/// exp(-x) and exp(-x) - 1 at these values as the device has them: the tension of an exponential law of
/// unit work and range, and its change from a base at zero gap.
fn device_exponentials(device: &GpuDevice, values: &[f64], less_one: bool) -> Vec<f64> {
    let mut backend = double_backend(device);
    let level = backend.level("fine", Shape::whole(64, 64));
    let mut make = |values: &[f64]| {
        let field = backend.field(level, "field");
        backend.write(field, values);
        field
    };
    let zeros = vec![0.0; values.len()];
    let [gap, pressure, outer_gap] = [values, &zeros, &zeros].map(&mut make);
    let result = make(&vec![f64::NAN; values.len()]);
    let law = Law::Exponential(Exponential {
        work_of_adhesion: 1.0,
        range: 1.0,
    });
    backend.set_outer_gap(less_one.then_some(outer_gap));
    backend.set_params(&params(law, false, Number::Double));
    backend.set_scalars(&Scalars::start(0.0, false));
    backend.run(&OUTER_RESIDUAL, level, &[gap, pressure, result]);
    backend
        .read(result)
        .unwrap_or_else(|error| panic!("{error}"))
        .into()
}

/// The device's own exp is not made for double precision, so it is put together from additions and
/// multiplications. Reduced to |r| <= ln(2)/2, the last addition rounds by half a unit in the last place,
/// the terms added and r itself by a quarter and an eighth of a unit of a result near 1, and twice that
/// of one below 1: below 2 units, and the host's own is good to 1. Less one, beyond 1/2 from zero, that is
/// multiplied by exp over exp less one, at most 2.6, and again by 2 where that loses a binary digit.
fn exponentials_in_double_precision_are_good_to_the_last_digits() {
    let device = device_with_double();
    let mut numbers = Random(3);
    // Gaps of some ranges, where laws are asked, and all that have a normal result.
    let mut values: Vec<f64> = (0..2048)
        .map(|_| 20.0 * (numbers.centred() + 0.5))
        .collect();
    values.extend((0..1024).map(|_| 1400.0 * numbers.centred()));
    values.extend((0..1024).map(|i| numbers.centred() * 2f64.powi(-(i % 60))));
    values[..8].copy_from_slice(&[0.0, -0.0, 0.5, -0.5, 698.0, -709.0, 1e-300, 0.346_573_590_3]);
    let ulps = |found: f64, exact: f64| {
        let unit = exact.abs().next_up() - exact.abs();
        match found == exact {
            true => 0.0,
            false => (found - exact).abs() / unit,
        }
    };
    let mut worst = [0.0f64; 2];
    let whole = device_exponentials(device, &values, false);
    let less_one = device_exponentials(device, &values, true);
    for (index, &value) in values.iter().enumerate() {
        let errors = [
            ulps(whole[index], (-value).exp()),
            ulps(less_one[index], (-value).exp_m1()),
        ];
        assert!(errors[0] <= 3.0 && errors[1] <= 12.0, "{value}: {errors:?}");
        worst = [worst[0].max(errors[0]), worst[1].max(errors[1])];
    }
    println!(
        "units in the last place: exp {}, less one {}",
        worst[0], worst[1]
    );
    // Beyond: none, and nothing that is no number.
    let far: Vec<f64> = [750.0, 1e5, 1e300, f64::INFINITY, -710.0, -1e5, f64::NAN]
        .into_iter()
        .cycle()
        .take(values.len())
        .collect();
    let found = device_exponentials(device, &far, false);
    assert!(found[..4].iter().all(|&tension| tension == 0.0));
    assert!(found[4..6].iter().all(|&tension| tension == f64::INFINITY));
    assert!(found[6].is_nan());
}

/// A field taken over between single and double precision on the device is what the host would make of
/// it, and nothing crosses the bus.
fn fields_are_copied_on_the_device() {
    let device = device_with_double();
    let shape = Shape::whole(48, 64);
    let values = Random(9).doubles(shape.len());
    let mut double = double_backend(device);
    let mut single = backend(device);
    let places: Vec<Field> = [&mut double, &mut single]
        .map(|backend| {
            let level = backend.level("fine", shape);
            backend.field(level, "field")
        })
        .to_vec();
    double.write(places[0], &values);
    let before = [double.traffic(), single.traffic()];
    single
        .copy_from(places[1], &mut double, places[0])
        .unwrap_or_else(|error| panic!("{error}"));
    // What is recorded after the loan does not reach the borrower.
    double.clear(places[0]);
    double
        .copy_from(places[0], &mut single, places[1])
        .unwrap_or_else(|error| panic!("{error}"));
    for (before, after) in before.iter().zip([double.traffic(), single.traffic()]) {
        assert_eq!(
            (before.fields_up, before.fields_down),
            (after.fields_up, after.fields_down)
        );
    }
    let rounded: Vec<f64> = values.iter().map(|&x| f64::from(x as f32)).collect();
    assert_eq!(
        *single.read(places[1]).expect("nothing has failed"),
        *rounded
    );
    assert_eq!(
        *double.read(places[0]).expect("nothing has failed"),
        *rounded
    );
}

/// Where a field takes more slabs in double than in single precision, iterations that are corrected lie as
/// what corrects them.
fn fields_in_slabs_are_copied_on_the_device() {
    device_with_double();
    let shape = Shape::whole(48, 64);
    let device = device_with(&AdapterChoice {
        faults: Faults {
            slab_bytes: Some(4 * shape.len() as u64),
            ..Faults::default()
        },
        ..AdapterChoice::default()
    });
    let mut single = backend(&device).corrected();
    let mut double = double_backend(&device);
    assert_eq!(device.slabs(shape), Ok(1));
    let values = Random(9).doubles(shape.len());
    let [here, there] = [&mut single, &mut double].map(|backend| {
        let level = backend.level("fine", shape);
        backend.field(level, "field")
    });
    double.write(there, &values);
    single
        .copy_from(here, &mut double, there)
        .unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(single.traffic().fields_up + double.traffic().fields_down, 0);
    let rounded: Vec<f64> = values.iter().map(|&x| f64::from(x as f32)).collect();
    assert_eq!(*single.read(here).expect("nothing has failed"), *rounded);
}

/// All numbers of the scalars, flags and status included.
fn numbers(scalars: &Scalars) -> Vec<(String, f64)> {
    let mut values = Vec::new();
    scalars.give(&mut |word| {
        values.push(match word {
            Word::Wide(value) => value,
            Word::Count(count) => f64::from(count),
        });
    });
    let names = members(Scalars::KIND).into_iter().flat_map(|(name, kind)| {
        let count = match kind {
            Kind::Wide(count) => count,
            _ => 1,
        };
        std::iter::repeat_n(name, count)
    });
    let all: Vec<_> = names.zip(values.iter().copied()).collect();
    assert_eq!(all.len(), values.len());
    all
}

/// A state drawn at random; some of its numbers are the special ones on which decisions turn.
/// `searches` where the kernel is part of a search.
fn drawn(random: &mut Random, searches: bool) -> Scalars {
    let mut number = |special: &[f64]| {
        let pick = ((random.centred() + 0.5) * 12.0) as usize;
        special
            .get(pick)
            .copied()
            .unwrap_or(f64::from(2.0 * random.centred() as f32))
    };
    let infinite = f64::INFINITY;
    let mut scalars = Scalars::start(number(&[]), false);
    for &sum in Sum::ALL {
        scalars
            .sums
            .set(sum, number(&[0.0, infinite, f64::NAN, 1e-9]));
    }
    // Sums of squares.
    for sum in [Sum::violation, Sum::pressures, Sum::gap_squares] {
        scalars.sums.set(sum, scalars.sums.get(sum).abs());
    }
    for value in [
        &mut scalars.beta,
        &mut scalars.mean_gap_shift,
        &mut scalars.trial_length,
        &mut scalars.mean_gap_correction,
        &mut scalars.slope,
        &mut scalars.curvature,
        &mut scalars.elastic_slope,
        &mut scalars.largest_step,
        &mut scalars.least_step,
        &mut scalars.residual_at_stall,
    ] {
        *value = number(&[0.0, 1e-6]);
    }
    scalars.residual = number(&[1e-5]).abs();
    scalars.step = number(&[1.0, 2.0]).abs();
    scalars.length = number(&[1.0]).abs();
    scalars.first_touch = number(&[infinite, 1.0]).abs().max(scalars.step);
    scalars.largest_move = number(&[0.0]).abs();
    scalars.low = [
        number(&[0.0]).abs(),
        -number(&[]).abs(),
        number(&[1.0]).abs(),
    ];
    scalars.last_end = number(&[-1.0, 1.0]).signum();
    for reach in &mut scalars.tried {
        *reach = number(&[1.0]).abs().min(scalars.first_touch);
    }
    scalars.high = [
        number(&[infinite, infinite]).abs() + 1.0,
        number(&[]),
        number(&[1.0]).abs(),
    ];
    let mut flag = |share: f64| random.centred() + 0.5 < share;
    scalars.repeat = flag(0.2);
    scalars.restart = flag(0.2);
    scalars.accepted = flag(0.8);
    scalars.cut = flag(0.5);
    scalars.searching = flag(if searches { 0.8 } else { 0.1 });
    scalars.careful = flag(0.2);
    scalars.status = if flag(0.1) {
        Status::Converged
    } else {
        Status::Running
    };
    let mut count = |most: f64| ((random.centred() + 0.5) * most) as u32;
    scalars.evaluations = [count(8.0), 39][(count(8.0) == 0) as usize];
    scalars.lost = [4, 24, count(5.0), 0, 0, 0][count(6.0) as usize];
    scalars.stalls = count(5.0);
    scalars.at_floor = [19, count(5.0)][count(2.0) as usize];
    // On both sides of where careful steps end.
    scalars.iterations = [1 + count(100.0), 1990 + count(20.0)][count(2.0) as usize];
    scalars
}

fn scalar_kernels_agree_with_their_twins() {
    let device = device();
    let bound = match device.wide() {
        Wide::Double => 1e-13,
        Wide::Single | Wide::Compensated => 1e-5,
    };
    let mut backend = backend(device);
    backend.level("fine", Shape::whole(4, 4));
    for &kernel in SCALAR_KERNELS {
        let mut random = Random(kernel.name.len() as u64);
        for round in 0..60 {
            let (_, law) = laws()[round % 5];
            let mut params = params(law, round % 2 == 0, Number::Single);
            if round % 3 == 0 {
                params.hardness = f64::INFINITY;
            }
            let mut twin = drawn(&mut random, kernel.name.starts_with("search"));
            backend.set_params(&params);
            backend.set_scalars(&twin);
            backend.scalar(kernel);
            let ours = backend.scalars().unwrap_or_else(|error| panic!("{error}"));
            let before = twin;
            (kernel.run)(&params, &mut twin);
            for ((name, a), (_, b)) in numbers(&ours).into_iter().zip(numbers(&twin)) {
                // Drawn sums may be infinite or NaN on both sides.
                let unknown = !a.is_finite() && !b.is_finite();
                let same = a == b || unknown || (a - b).abs() <= bound * b.abs().max(1.0);
                assert!(
                    same,
                    "{}, round {round}: {name} is {a}, twin {b}\n{before:?}\n{params:?}",
                    kernel.name
                );
            }
        }
    }
}

/// Every member of the params and the scalars has another value, and a shader finds each where the host has
/// put it, in every kind of number that sums are kept in.
fn every_member_is_where_a_shader_reads_it() {
    let single = device_without_double();
    for device in [device(), &single] {
        for law in [laws()[2].1, laws()[4].1] {
            let params = Params {
                law,
                stiffness_max: 2.125,
                pressure_floor: 3.125,
                tolerance: 4.125,
                heights_norm: 5.125,
                points: 6.125,
                smooth_stiffness: 7.125,
                level_compliance: 7.625,
                own_compliance: 5.25,
                neighbour_compliance: 0.375,
                softening: 0.875,
                hardness: 8.125,
                epsilon: 9.125,
                prescribed_mean_gap: true,
                may_detach: false,
            };
            let mut next = 10;
            let scalars = Scalars::take(&mut |kind| {
                next += 1;
                match kind {
                    Kind::Wide(_) => Word::Wide(f64::from(next) + 0.25),
                    // A status, flags, and counts; a status beyond the last one is none.
                    _ => Word::Count(next % 3),
                }
            });
            let mut expected = Vec::new();
            let mut add = |word| {
                expected.push(match word {
                    Word::Wide(value) => value,
                    Word::Count(count) => f64::from(count),
                });
            };
            params.give(&mut add);
            // What WGSL cannot write down, and a zero that no compiler knows.
            add(Word::Wide(f64::INFINITY));
            add(Word::Count(0));
            scalars.give(&mut add);
            let mut backend = backend(device);
            backend.set_params(&params);
            backend.set_scalars(&scalars);
            let found = backend
                .words_on_device()
                .unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(found.len(), expected.len());
            for (place, (found, expected)) in found.iter().zip(&expected).enumerate() {
                let same = found == expected || (found - expected).abs() <= 1e-6 * expected.abs();
                assert!(same, "word {place}: {found} on the device, {expected} here");
            }
        }
    }
}

/// Large numbers that cancel: plain sums in single precision keep nothing of what is left, which is
/// some 1e-6 of them; compensated ones keep it to single precision.
fn sums_without_double_precision_are_compensated() {
    let device = device_without_double();
    assert_eq!(device.wide(), Wide::Compensated);
    let shape = Shape::whole(96, 64);
    let mut numbers = Random(5);
    let large = numbers.singles(shape.len() / 2);
    // Each large number returns with the other sign, in the other order, a little changed.
    let values: Vec<f64> = large
        .iter()
        .map(|x| 4096.0 * x)
        .chain(
            large
                .iter()
                .rev()
                .map(|x| f64::from((1e-3 - 4096.0 * x) as f32)),
        )
        .collect();
    let mut backend = backend(&device);
    let level = backend.level("fine", shape);
    let gap = backend.field(level, "gap");
    let pressure = backend.field(level, "pressure");
    backend.write(gap, &values);
    backend.set_params(&params(Law::HardWall, true, Number::Single));
    backend.set_scalars(&open(Gate::Running));
    backend.run(&BALANCE[0], level, &[gap, pressure]);
    let sums = backend
        .scalars()
        .unwrap_or_else(|error| panic!("{error}"))
        .sums;
    let exact: f64 = values.iter().sum();
    let plain = values.iter().fold(0.0f32, |sum, &x| sum + x as f32);
    println!(
        "{exact}: compensated {}, plain {plain}",
        sums.pressure_weight
    );
    assert!(
        (sums.pressure_weight - exact).abs() <= 1e-6 * exact.abs(),
        "{} {exact}",
        sums.pressure_weight
    );
    assert!(
        (f64::from(plain) - exact).abs() > 1e-5 * exact.abs(),
        "the test has teeth"
    );
}

tests![
    kernels_agree_with_their_twins,
    kernels_in_double_precision_agree_with_their_twins,
    exponentials_in_double_precision_are_good_to_the_last_digits,
    fields_are_copied_on_the_device,
    fields_in_slabs_are_copied_on_the_device,
    scalar_kernels_agree_with_their_twins,
    every_member_is_where_a_shader_reads_it,
    sums_without_double_precision_are_compensated,
];
