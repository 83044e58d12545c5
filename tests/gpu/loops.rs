//! Shaders as graphics processors get them, with loops of known length written out: software drivers get them as loops, so that
//! without a graphics processor nothing but these tests runs them.

use tabor::backend::cpu;
use tabor::backend::gpu::{AdapterChoice, Faults, GpuDevice, Number};
use tabor::backend::{Response, Shape};
use tabor::kernel::{Constraint, Form, Kernel};
use tabor::law::Law;

use crate::catalogue::variants;
use crate::convolution::convolve;
use crate::kernels::{Case, FINE, Trace, compare, params, run};
use crate::shared::device::{backend, device, device_with};
use crate::shared::random::Random;
use crate::shared::trials::{is_long, tests};

/// A device whose shaders are written out, whatever its driver.
fn unrolled() -> GpuDevice {
    device_with(&AdapterChoice {
        faults: Faults {
            unrolled: true,
            ..Faults::default()
        },
        ..AdapterChoice::default()
    })
}

/// A kernel of each form, with sums where one has them: all that is written out otherwise is the same.
fn representatives() -> Vec<&'static Kernel> {
    let forms = [
        Form::Sweep,
        Form::Load,
        Form::Store,
        Form::RetainRows,
        Form::Retain,
        Form::ReadRetained,
        Form::FromRetained,
        Form::InverseThenForward,
    ];
    let of_a_wall = |kernel: &&Kernel| {
        matches!(kernel.constraint, None | Some(Constraint::Unilateral)) && !kernel.whole
    };
    let most_sums = |form| {
        let alike = variants().filter(|kernel| kernel.form == form);
        alike
            .filter(of_a_wall)
            .max_by_key(|kernel| kernel.sums.len())
    };
    forms.into_iter().filter_map(most_sums).collect()
}

fn kernels_written_out_agree_with_their_twins_and_with_loops() {
    let (unrolled, looped) = (unrolled(), device());
    let shape = Shape::whole(FINE[0], FINE[1]);
    let params = params(Law::HardWall, true, Number::Single);
    let case = Case {
        patterned: false,
        based: false,
        number: Number::Single,
    };
    let kernels = representatives();
    assert!(kernels.len() > 5, "only {} forms", kernels.len());
    for kernel in kernels {
        let mut worst = [0.0; 2];
        compare(
            kernel,
            &params,
            shape,
            case,
            &|| cpu::single(None),
            &|| Box::new(backend(&unrolled)),
            &mut worst,
        );
        let poison = vec![false; kernel.writes.len()];
        let [out, loops]: [Trace; 2] = [&unrolled, looped]
            .map(|device| run(&mut backend(device), kernel, &params, shape, &poison, case));
        assert!(out.fields == loops.fields, "{}: bits differ", kernel.name);
        assert_eq!(out.sums, loops.sums, "{}", kernel.name);
    }
}

/// Radices and threads for which some threads are idle; lines whose values are spread over the banks of workgroup memory; and, with
/// `TABOR_LONG=1`, such a line in rounds, which software compiles for ten seconds.
fn a_convolution_written_out_is_that_with_loops() {
    let unrolled = unrolled();
    let rounds = is_long().then_some([8192, 4]);
    for size in [[128, 84]].into_iter().chain(rounds) {
        let fields = [1, 2].map(|seed| Random(seed).singles(size[0] * size[1]));
        let [out, loops] = [&unrolled, device()].map(|device| {
            convolve(
                &mut backend(device),
                size,
                Some(Response::Stiffness),
                &fields,
            )
            .unwrap_or_else(|error| panic!("{error}"))
        });
        assert!(out.0 == loops.0 && out.1 == loops.1, "bits differ");
        assert_eq!(out.2.curvature, loops.2.curvature);
    }
}

tests![
    kernels_written_out_agree_with_their_twins_and_with_loops,
    a_convolution_written_out_is_that_with_loops,
];
