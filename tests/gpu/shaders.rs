//! Every shader that the program writes, parsed and validated without an adapter.

use std::collections::HashSet;

use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use tabor::backend::Shape;
use tabor::backend::gpu::source::{
    self, Decision, FactorSource, LawSource, LevelPlan, Pass, Reduction, Results,
};
use tabor::backend::gpu::{Direction, Exchange, GroupLimits, Limits, Loops, Number, Wide};
use tabor::kernel::displacement::{LOAD_FIELD, STORE_FIELD};
use tabor::kernel::multilevel::COARSEN;
use tabor::kernel::{Gate, Sum};
use tabor::law::{Exponential, Law, LennardJones, MaugisDugdale};

use crate::catalogue::{SCALAR_KERNELS, variants};
use crate::shared::trials::tests;

const LIMITS: GroupLimits = GroupLimits {
    threads: 1024,
    memory: 32768,
};
const LAWS: [Law; 4] = [
    Law::HardWall,
    Law::MaugisDugdale(MaugisDugdale {
        peak_tension: 1.0,
        range: 1.0,
        taper: 0.0,
    }),
    Law::Exponential(Exponential {
        work_of_adhesion: 1.0,
        range: 1.0,
    }),
    Law::LennardJones(LennardJones {
        work_of_adhesion: 1.0,
        range: 1.0,
    }),
];

fn uniform(law: Law) -> LawSource {
    LawSource::uniform(law.shader())
}

/// Numbers of sums.
const WIDES: [Wide; 3] = [Wide::Single, Wide::Compensated, Wide::Double];
/// Numbers of fields and of sums that go together.
const NUMBERS: [(Number, Wide); 4] = [
    (Number::Single, Wide::Single),
    (Number::Single, Wide::Compensated),
    (Number::Single, Wide::Double),
    (Number::Double, Wide::Double),
];
const GATES: [Gate; 6] = [
    Gate::Always,
    Gate::Running,
    Gate::Fresh,
    Gate::Ahead,
    Gate::Accepted,
    Gate::Searching,
];

/// Parses and validates with only the capabilities in use: with all of them a feature that a
/// device lacks would go unseen.
fn validate(name: &str, text: &str, wide: Wide) -> (naga::Module, ModuleInfo) {
    let module = naga::front::wgsl::parse_str(text)
        .unwrap_or_else(|error| panic!("{name}: {}\n{text}", error.emit_to_string(text)));
    let capabilities = match wide {
        Wide::Single | Wide::Compensated => Capabilities::empty(),
        Wide::Double => Capabilities::FLOAT64,
    };
    let info = Validator::new(ValidationFlags::all(), capabilities)
        .validate(&module)
        .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(text)));
    (module, info)
}

/// Access and name of the fields that a shader binds, by binding.
fn fields(module: &naga::Module) -> Vec<(u32, bool)> {
    let mut found: Vec<_> = module
        .global_variables
        .iter()
        .filter_map(|(_, variable)| {
            let binding = variable.binding?;
            let naga::AddressSpace::Storage { access } = variable.space else {
                return None;
            };
            (binding.group == 1)
                .then(|| (binding.binding, access.contains(naga::StorageAccess::STORE)))
        })
        .collect();
    found.sort();
    found
}

fn plan(nx: usize, ny: usize, number: Number) -> LevelPlan {
    LevelPlan::new(Shape::whole(nx, ny), LIMITS, number).expect("a smooth size")
}

fn kernels_are_valid_and_bind_what_the_catalogue_declares() {
    let padded = Shape {
        points: [64, 48],
        surface: [30, 20],
    };
    // Most kernels know nothing of the law, and many not of the plan: a text is looked at once.
    let mut seen = HashSet::new();
    for kernel in variants() {
        // What coarsens reads the finer level.
        let whole = if kernel.name == "coarsen" {
            [192, 256]
        } else {
            [12, 16]
        };
        for law in LAWS {
            for (number, wide) in NUMBERS {
                let padded = LevelPlan::new(padded, LIMITS, number).expect("a smooth size");
                // What becomes of loops has no part in a law.
                let looped =
                    (law == Law::HardWall).then(|| plan(48, 64, number).with_loops(Loops::Kept));
                let plans = [plan(48, 64, number), padded].into_iter().chain(looped);
                for plan in plans {
                    let text = source::kernel(kernel, &plan, whole, uniform(law), wide)
                        .unwrap_or_else(|error| panic!("{error}"));
                    let double = wide == Wide::Double;
                    if seen.insert((kernel.name, text.clone(), double)) {
                        let (module, _) = validate(kernel.name, &text, wide);
                        let declared: Vec<_> = (0..kernel.fields() as u32)
                            .map(|binding| {
                                let place = binding as usize;
                                (binding, kernel.written().contains(&place))
                            })
                            .collect();
                        assert_eq!(fields(&module), declared, "{}", kernel.name);
                        assert_eq!(module.entry_points[0].name, kernel.name);
                    }
                    // The same on corrections of an outer state, which are in single precision.
                    if number == Number::Double {
                        continue;
                    }
                    let corrected = LawSource {
                        outer_gap: Some(kernel.fields()),
                        ..uniform(law)
                    };
                    let text = source::kernel(kernel, &plan, whole, corrected, wide)
                        .unwrap_or_else(|error| panic!("{error}"));
                    if seen.insert((kernel.name, text.clone(), double)) {
                        validate(kernel.name, &text, wide);
                    }
                }
            }
        }
    }
}

fn transforms_of_many_lengths_are_valid() {
    for [nx, ny] in [
        [2, 2],
        [256, 384],
        [640, 720],
        [1000, 84],
        [4096, 6],
        [16, 4096],
        [8192, 16384],
    ] {
        for (number, wide) in NUMBERS {
            // The longest line is half as long in double precision.
            let ny = match number {
                Number::Single => ny,
                Number::Double => ny.min(8192),
            };
            let plan = plan(nx, ny, number);
            for kernel in [&LOAD_FIELD, &STORE_FIELD] {
                let text = source::kernel(kernel, &plan, [0, 0], uniform(Law::HardWall), wide)
                    .unwrap_or_else(|error| panic!("{error}"));
                validate(&format!("{} {nx} x {ny}", kernel.name), &text, wide);
            }
            for (factors, energy) in [
                (FactorSource::Compliance, false),
                (FactorSource::Stiffness, true),
            ] {
                let text = source::multiply(&plan, factors, energy, Gate::Accepted, wide);
                validate(&format!("multiply {nx} x {ny}"), &text, wide);
            }
        }
    }
}

/// The least that a device offers takes longer lines in rounds.
fn rounds_are_valid() {
    let least = GroupLimits {
        threads: 256,
        memory: 16384,
    };
    for (number, wide) in NUMBERS {
        let shape = match number {
            Number::Single => Shape::whole(4096, 3000),
            Number::Double => Shape::whole(2048, 1500),
        };
        let plan = LevelPlan::new(shape, least, number).expect("lines that fit in rounds");
        assert_eq!(plan.rows.exchange, Exchange::Rounds(2));
        for kernel in [&LOAD_FIELD, &STORE_FIELD] {
            let text = source::kernel(kernel, &plan, [0, 0], uniform(Law::HardWall), wide)
                .unwrap_or_else(|error| panic!("{error}"));
            validate(kernel.name, &text, wide);
        }
        for factors in FactorSource::ALL {
            let text = source::multiply(&plan, factors, true, Gate::Accepted, wide);
            validate("multiply", &text, wide);
        }
    }
}

/// The largest grids: sixteen slabs, spectra in parts, lines in two passes; and elongated ones.
fn slabs_and_long_lines_are_valid() {
    let limits = Limits {
        group: LIMITS,
        binding: (1 << 31) - 1,
        slab: (1 << 31) - 1,
        bindings: 32,
        longest_line: usize::MAX,
    };
    for (number, wide) in NUMBERS {
        for ([nx, ny], slabs, long) in [
            ([32768, 32768], [4, 8], [true, true]),
            ([65536, 65536 / 2], [8, 16], [true, true]),
            ([118098, 96], [1, 1], [true, false]),
            ([96, 235298], [1, 1], [false, true]),
        ] {
            let shape = Shape::whole(nx, ny);
            let plan = LevelPlan::laid_out(shape, &limits, number).expect("within the limits");
            let expected = match number {
                Number::Single => slabs[0],
                Number::Double => slabs[1],
            };
            assert_eq!(plan.slabs, expected, "{nx} x {ny}");
            assert_eq!(
                [plan.rows_then.is_some(), plan.columns_then.is_some()],
                long
            );
            let name = format!("{nx} x {ny}");
            for kernel in [&LOAD_FIELD, &STORE_FIELD, &COARSEN] {
                let whole = source::Whole::new(&plan);
                for loops in [Loops::Unrolled, Loops::Kept] {
                    let plan = plan.clone().with_loops(loops);
                    let text = source::kernel(kernel, &plan, whole, uniform(Law::HardWall), wide)
                        .unwrap_or_else(|error| panic!("{error}"));
                    validate(&name, &text, wide);
                }
            }
            let gate = Gate::Running;
            for direction in [Direction::Forward, Direction::Inverse] {
                let text = source::rows_then(&plan, direction, gate, wide);
                assert_eq!(text.is_some(), long[0]);
                text.iter()
                    .for_each(|text| drop(validate(&name, text, wide)));
            }
            for pass in Pass::ALL {
                for factors in FactorSource::ALL {
                    // Nothing but the middle pass asks for them.
                    if pass != Pass::Middle && factors != FactorSource::Table {
                        continue;
                    }
                    let text = source::multiply_long(&plan, pass, factors, true, gate, wide);
                    assert_eq!(text.is_some(), long[1]);
                    text.iter()
                        .for_each(|text| drop(validate(&name, text, wide)));
                }
            }
            if !long[1] {
                let text = source::multiply(&plan, FactorSource::Table, true, gate, wide);
                validate(&name, &text, wide);
            }
        }
    }
}

fn the_check_of_sums_is_valid() {
    validate("check", &source::two_sums(), Wide::Compensated);
}

fn reductions_are_valid() {
    for wide in WIDES {
        for gate in GATES {
            for results in [
                Results::Curvature(4096),
                Results::Sums(&[Sum::slope, Sum::first_touch, Sum::cut]),
            ] {
                let reduction = Reduction {
                    results,
                    groups: 7,
                    first: 5,
                    gate,
                };
                for loops in [Loops::Unrolled, Loops::Kept] {
                    let text = source::decide(&[Decision::Sums(reduction); 2], wide, loops)
                        .unwrap_or_else(|error| panic!("{error}"));
                    validate("decide", &text, wide);
                }
            }
        }
    }
}

fn the_copy_of_members_is_valid() {
    for wide in WIDES {
        let (text, count) = source::copy_members(wide);
        assert!(count > 90, "{count} words");
        validate("copy_members", &text, wide);
    }
}

fn scalar_kernels_are_valid() {
    for wide in WIDES {
        for kernel in SCALAR_KERNELS {
            let text = source::decide(&[Decision::Scalar(kernel)], wide, Loops::Unrolled)
                .unwrap_or_else(|error| panic!("{error}"));
            validate(kernel.name, &text, wide);
        }
    }
}

tests![
    kernels_are_valid_and_bind_what_the_catalogue_declares,
    transforms_of_many_lengths_are_valid,
    rounds_are_valid,
    slabs_and_long_lines_are_valid,
    the_check_of_sums_is_valid,
    reductions_are_valid,
    scalar_kernels_are_valid,
    the_copy_of_members_is_valid,
];
