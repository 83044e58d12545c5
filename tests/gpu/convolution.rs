//! One convolution through the backend's trait, against the CPU in double precision.

use tabor::backend::cpu;
use tabor::backend::gpu::{GpuError, Number, OWN_FACTORS};
use tabor::backend::{Backend, BackendError, Factors, Response, Shape};
use tabor::elastic::HalfSpace;
use tabor::grid::Grid;
use tabor::kernel::displacement::{LOAD_DISPLACEMENT, LOAD_FIELD, STORE_FIELD};
use tabor::kernel::{Gate, Params, Scalars, Status, scalar};
use tabor::law::Law;

use crate::shared::device::{backend, device, device_with_double, relative_difference};
use crate::shared::random::Random;
use crate::shared::trials::{ignore, is_long, tests};

/// Relative L2 error of a single-precision convolution: some ten roundings of 6e-8 in the root
/// mean square (two transforms of at most twelve stages, and the inputs' own rounding).
const BOUND: f64 = 5e-7;
/// The same in double precision, twice: the processor it is compared with rounds as well.
const BOUND_IN_DOUBLE: f64 = 2.0 * BOUND * f64::EPSILON / f32::EPSILON as f64;

/// Every radix each way, lines of one and of a few values, and as long ones as pass through workgroup memory at once.
const SIZES: [[usize; 2]; 8] = [
    [96, 128],
    [120, 84],
    [2, 2],
    [8, 2],
    [2, 8],
    [14, 250],
    [1024, 6],
    [6, 4096],
];
/// Others, and long lines, which pass through workgroup memory in two and in four rounds.
const MORE_SIZES: [[usize; 2]; 5] = [[64, 64], [84, 120], [256, 256], [16384, 2], [2, 8192]];

fn params() -> Params {
    Params {
        law: Law::HardWall,
        stiffness_max: 1.0,
        pressure_floor: 1.0,
        tolerance: 1e-4,
        heights_norm: 1.0,
        prescribed_mean_gap: false,
        may_detach: false,
        points: 1.0,
        smooth_stiffness: 1.0,
        level_compliance: 0.8,
        own_compliance: 0.6,
        neighbour_compliance: 0.05,
        softening: 0.7,
        hardness: f64::INFINITY,
        epsilon: f64::EPSILON,
    }
}

/// Those in double precision, whose shaders are slow to compile in software: every radix each way, and
/// the ways of passing values between threads.
const SIZES_IN_DOUBLE: [[usize; 2]; 3] = [[120, 84], [2048, 2], [6, 4096]];
/// As with those in single precision.
const MORE_SIZES_IN_DOUBLE: [[usize; 2]; 3] = [[28, 250], [8192, 2], [2, 8192]];

/// What one convolution gives: of one field with the stiffness, with its energy, and of a sum of two with
/// another response; of both with a table where there is none.
pub fn convolve(
    backend: &mut dyn Backend,
    [nx, ny]: [usize; 2],
    response: Option<Response>,
    fields: &[Vec<f64>; 2],
) -> Result<(Vec<f64>, Vec<f64>, Scalars), BackendError> {
    let level_shape = Shape::whole(nx, ny);
    let level = backend.level("fine", level_shape);
    let field = backend.field(level, "field");
    let heights = backend.field(level, "heights");
    let result = backend.field(level, "result");
    let sum = backend.field(level, "sum");
    // Lengths that differ find transpositions.
    let half_space = HalfSpace::new(Grid::new([nx, ny], [1.0, 1.3]), 1.0 / nx as f64);
    let table: Vec<f64> = (0..level_shape.spectrum_len())
        .map(|index| 1.0 + 0.3 * (index % (ny / 2 + 1)) as f64 / ny as f64)
        .collect();
    let [factors, others] = match response {
        None => [Factors::Table(&table); 2],
        Some(response) => {
            [Response::Stiffness, response].map(|r| Factors::HalfSpace(half_space, r))
        }
    };
    let spectrum = backend.spectrum(level, "factors", factors);
    let other = backend.spectrum(level, "others", others);
    backend.set_params(&params());
    backend.set_zero_mode(spectrum, 0.75);
    backend.set_zero_mode(other, 0.5);
    backend.write(field, &fields[0]);
    backend.write(heights, &fields[1]);
    // Whatever is not written shows.
    backend.write(result, &vec![f64::NAN; nx * ny]);
    backend.write(sum, &vec![f64::NAN; nx * ny]);
    backend.run(&LOAD_FIELD, level, &[field]);
    backend.multiply(spectrum, true, Gate::Always);
    backend.run(&STORE_FIELD, level, &[result]);
    backend.run(&LOAD_DISPLACEMENT, level, &[field, heights]);
    backend.multiply(other, false, Gate::Always);
    backend.run(&STORE_FIELD, level, &[sum]);
    let scalars = backend.scalars()?;
    assert_eq!(backend.transforms(), 4.0, "{nx} x {ny}");
    Ok((
        backend.read(result)?.into(),
        backend.read(sum)?.into(),
        scalars,
    ))
}

fn convolution_agrees_with_the_processor() {
    agrees_with_the_processor(&SIZES, Number::Single);
}

fn convolution_in_double_precision_agrees_with_the_processor() {
    agrees_with_the_processor(&SIZES_IN_DOUBLE, Number::Double);
}

fn convolution_of_more_sizes_agrees_with_the_processor() {
    if !is_long() {
        ignore("a software driver takes a minute to compile these; set TABOR_LONG=1");
    }
    agrees_with_the_processor(&MORE_SIZES, Number::Single);
    agrees_with_the_processor(&MORE_SIZES_IN_DOUBLE, Number::Double);
}

fn agrees_with_the_processor(sizes: &[[usize; 2]], number: Number) {
    let (device, bound) = match number {
        Number::Single => (device(), BOUND),
        Number::Double => (device_with_double(), BOUND_IN_DOUBLE),
    };
    let both = [Response::Stiffness, Response::Compliance];
    let computed = both.into_iter().cycle().map(Some);
    let responses = std::iter::once(None).chain(computed);
    for (&size, response) in sizes.iter().zip(responses) {
        let mut numbers = Random(size[0] as u64 * 4096 + size[1] as u64);
        let count = size[0] * size[1];
        let fields = [(); 2].map(|()| match number {
            Number::Single => numbers.singles(count),
            Number::Double => numbers.doubles(count),
        });
        let mut cpu = cpu::double(None);
        let (result, sum, scalars) =
            convolve(&mut *cpu, size, response, &fields).expect("the CPU computes");
        let mut gpu = backend(device).keeping(number);
        let mut again = backend(device).keeping(number);
        let ours =
            convolve(&mut gpu, size, response, &fields).unwrap_or_else(|e| panic!("{size:?}: {e}"));
        let errors = [
            relative_difference(&ours.0, &result),
            relative_difference(&ours.1, &sum),
            (ours.2.curvature / scalars.curvature - 1.0).abs(),
        ];
        println!("{size:?}, {response:?}: {errors:?}");
        // Written so that a NaN fails.
        assert!(errors.iter().all(|&e| e < bound), "{size:?}: {errors:?}");
        let twice = convolve(&mut again, size, response, &fields).expect("it did before");
        assert!(
            ours.0 == twice.0 && ours.1 == twice.1,
            "{size:?}: bits differ"
        );
        assert_eq!(ours.2.curvature, twice.2.curvature, "{size:?}");
    }
}

fn a_shut_gate_leaves_everything_as_it_was() {
    let device = device();
    let mut backend = backend(device);
    let level = backend.level("fine", Shape::whole(16, 16));
    let field = backend.field(level, "field");
    let spectrum = backend.spectrum(level, "stiffness", Factors::Table(&[2.0; 81]));
    let mut scalars = Scalars::start(0.0, false);
    scalars.status = Status::Converged;
    scalars.curvature = 7.0;
    backend.set_params(&params());
    backend.set_scalars(&scalars);
    let values = Random(1).singles(256);
    backend.write(field, &values);
    backend.run(&LOAD_FIELD, level, &[field]);
    backend.multiply(spectrum, true, Gate::Running);
    backend.multiply(spectrum, true, Gate::Fresh);
    backend.multiply(spectrum, true, Gate::Accepted);
    backend.multiply(spectrum, true, Gate::Searching);
    let seen = backend.scalars().expect("nothing has failed");
    assert_eq!(format!("{seen:?}"), format!("{scalars:?}"));
    assert_eq!(backend.transforms(), 0.5);
    assert_eq!(*backend.read(field).expect("nothing has failed"), *values);
}

fn what_cannot_be_done_is_an_error_where_the_host_waits() {
    let device = device();
    let text = |error: BackendError| error.to_string();
    for size in [[22, 16], [16, 26], [15, 16], [16, 9]] {
        let mut backend = backend(device);
        let level = backend.level("fine", Shape::whole(size[0], size[1]));
        let field = backend.field(level, "field");
        backend.write(field, &[0.0; 4]);
        backend.run(&LOAD_FIELD, level, &[field]);
        let error = text(backend.scalars().expect_err("a size without a transform"));
        assert!(error.contains("no prime factor above 7"), "{error}");
        assert_eq!(text(backend.read(field).expect_err("the same")), error);
    }
    let mut backend = backend(device);
    let level = backend.level("fine", Shape::whole(16, 16));
    let field = backend.field(level, "field");
    backend.run(&LOAD_DISPLACEMENT, level, &[field]);
    let error = backend.scalars().expect_err("a field too few");
    assert!(
        matches!(
            error,
            BackendError::Fields {
                expected: 2,
                given: 1,
                ..
            }
        ),
        "{error}"
    );
}

fn a_kernel_without_a_shader_is_an_error_where_the_host_waits() {
    let device = device();
    let mut backend = backend(device);
    backend.level("fine", Shape::whole(16, 16));
    static ODD: scalar::ScalarKernel = scalar::ScalarKernel {
        name: "unheard_of",
        run: |_, _| {},
    };
    backend.scalar(&ODD);
    let error = backend.scalars().expect_err("no such shader");
    assert_eq!(
        error.to_string(),
        BackendError::from(GpuError::NoShader("unheard_of")).to_string()
    );
}

/// Each kernel's dispatches and bytes as counted by hand, a time for each, and the same bits as untimed.
/// A convolution with a half-space moves six fields: nothing else grows with the grid, but lines' roots.
fn kernels_are_timed_on_the_device() {
    let device = device();
    let [nx, ny] = [96, 64];
    let run = |backend: &mut dyn Backend| {
        let level = backend.level("fine", Shape::whole(nx, ny));
        let [from, to] = [(); 2].map(|()| backend.field(level, "field"));
        let half_space = HalfSpace::new(Grid::new([nx, ny], [1.0, 1.3]), 0.1);
        let factors = Factors::HalfSpace(half_space, Response::Stiffness);
        let stiffness = backend.spectrum(level, "stiffness", factors);
        backend.write(from, &Random(4).singles(nx * ny));
        backend.set_params(&params());
        for _ in 0..3 {
            backend.run(&LOAD_FIELD, level, &[from]);
            backend.multiply(stiffness, false, Gate::Always);
        }
        backend.run(&STORE_FIELD, level, &[to]);
        backend.read(to).unwrap_or_else(|error| panic!("{error}"))
    };
    let (mut timed, watch) = backend(device).timed();
    let Some(watch) = watch else {
        ignore("the adapter has no timestamps");
    };
    let clock = std::time::Instant::now();
    let values = run(&mut timed);
    let took = clock.elapsed().as_secs_f64();
    assert_eq!(values, run(&mut backend(device)));
    let timings = watch.take();
    let field = (4 * nx * ny) as u64;
    // What stands for a table: the zero wavevector's factor, two steps and a scale.
    let few = 4 * OWN_FACTORS as u64;
    // Two numbers of four bytes for each root of unity. A stage turns all values but those of its first leg, and the first
    // stage none, forward and back: 96 = 8 * 4 * 3, 64 = 4 * 4 * 4.
    let roots = |length: usize| match length {
        96 => 8 * (2 * 96 - 8 - 3),
        _ => 8 * (2 * 64 - 4 - 4),
    };
    for (name, dispatches, bytes) in [
        ("load_field", 3, 2 * field + roots(nx)),
        ("multiply", 3, 2 * field + few + roots(ny)),
        ("store_field", 1, 2 * field + roots(nx)),
    ] {
        let found = timings.kernels.iter().find(|kernel| kernel.name == name);
        let found = found.unwrap_or_else(|| panic!("{name} in {timings:?}"));
        assert_eq!(found.dispatches, dispatches, "{name}");
        assert_eq!(found.bytes, dispatches * bytes, "{name}");
        assert!(found.seconds > 0.0, "{name}");
    }
    let total = timings.total();
    assert_eq!(total.dispatches, 7);
    // Per point, one operator application of a half-space moves exactly six numbers.
    let application: u64 = timings.kernels.iter().map(|k| k.bytes / k.dispatches).sum();
    assert_eq!(application - few - 2 * roots(nx) - roots(ny), 6 * field);
    assert!(total.seconds <= took, "{} of {took} s", total.seconds);
    // Taken is taken.
    assert!(watch.take().kernels.is_empty());
    let rate = device
        .copy_rate(field)
        .unwrap_or_else(|error| panic!("{error}"));
    // Between a tape and what no memory does.
    assert!(
        rate.is_some_and(|rate| rate > 1e6 && rate < 1e14),
        "{rate:?}"
    );
}

tests![
    convolution_agrees_with_the_processor,
    convolution_in_double_precision_agrees_with_the_processor,
    convolution_of_more_sizes_agrees_with_the_processor,
    a_shut_gate_leaves_everything_as_it_was,
    what_cannot_be_done_is_an_error_where_the_host_waits,
    a_kernel_without_a_shader_is_an_error_where_the_host_waits,
    kernels_are_timed_on_the_device,
];
