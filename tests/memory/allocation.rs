//! An iteration allocates nothing: all memory is taken when a problem is planned.

use std::path::Path;

use stats_alloc::Region;
use tabor::backend::cpu::{self, with_threads};
use tabor::kernel::Status;
use tabor::scene::Scene;
use tabor::solver::{ContactSolver, Start};
use tabor::study::{Setup, control::Controller};
use tabor::surface::Surface;

use crate::ALLOCATOR;
use crate::shared::trials::tests;

fn setup(boundary: &str, adhesion: &str, loading: &str) -> Setup {
    let text = format!(
        r#"
        [grid]
        points = 128
        size = 1.0
        boundary = "{boundary}"
        [solid]
        contact_modulus = 1.0
        [[surface]]
        kind = "self-affine"
        hurst = 0.8
        rms_height = 0.01
        longest = 1.0
        rolloff = 0.5
        shortest = 0.0625
        seed = 4
        {adhesion}
        [loading]
        {loading}
        "#
    );
    let scene = Scene::parse(&text, "test.toml", Path::new("."), &[])
        .unwrap_or_else(|errors| panic!("{errors}\n{text}"));
    let surface = Surface::build(&scene).unwrap_or_else(|error| panic!("{error}"));
    Setup::new(scene, surface)
}

/// Every law on both boundaries, under the controls that take different kernels. One test, so that
/// nothing else runs beside it: the count is that of the whole process, threads of the pool included.
fn twenty_iterations_allocate_nothing() {
    let adhesion =
        |law: &str| format!("[adhesion]\nlaw = \"{law}\"\nwork_of_adhesion = 8e-5\nrange = 3e-3");
    let laws = [
        ("hard wall", String::new()),
        ("tapered", adhesion("maugis-dugdale")),
        ("exponential", adhesion("exponential")),
        ("Lennard-Jones", adhesion("lennard-jones")),
    ];
    let controls = [
        ("periodic", "control = \"pressure\"\npath = [0.01]", 0.01),
        ("periodic", "control = \"mean-gap\"\npath = [0.01]", 0.01),
        ("free", "control = \"force\"\npath = [0.01]", 0.01),
        ("free", "control = \"approach\"\npath = [0.005]", 0.005),
    ];
    // One pool for all: threads that start or end allocate too.
    with_threads(Some(2), || {
        for (law, adhesion) in &laws {
            for (boundary, loading, value) in controls {
                let setup = setup(boundary, adhesion, loading);
                let found = iterate(&setup, value);
                assert_eq!(
                    found, [0; 3],
                    "{law}, {boundary}, {loading}: allocations, reallocations, frees"
                );
            }
        }
    })
    .expect("threads");
}

/// Counts over twenty iterations, the first ones aside: the least of three such counts, since a
/// thread of the pool or of the test's own runner may still be starting during the first.
fn iterate(setup: &Setup, value: f64) -> [usize; 3] {
    let controller = Controller::new(setup, &setup.problem);
    let mut backend = cpu::double(None);
    let mut solver = ContactSolver::new(&mut *backend, &setup.problem);
    let load = controller.load(value);
    let start = Start::Gap(controller.undeformed_gap(value, None).into());
    // The counter counts: reading a field makes a vector.
    let region = Region::new(ALLOCATOR);
    drop(solver.gap());
    assert!(region.change().allocations > 0);
    (0..3)
        .map(|_| {
            // A tolerance of 0 is never met, so that all iterations do their full work.
            solver.begin(&load, &start, 0.0, false).expect("cpu");
            for _ in 0..3 {
                solver.iterate().expect("cpu");
            }
            let region = Region::new(ALLOCATOR);
            let mut status = Status::Running;
            for _ in 0..20 {
                status = solver.iterate().expect("cpu").status;
            }
            let change = region.change();
            assert_eq!(status, Status::Running);
            [
                change.allocations,
                change.reallocations,
                change.deallocations,
            ]
        })
        .min_by_key(|counts| counts.iter().sum::<usize>())
        .expect("three counts")
}

tests![twenty_iterations_allocate_nothing,];
