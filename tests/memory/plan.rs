//! What `tabor check` knows before any heights are made: it takes no field, whatever the grid, and
//! says what the heights would say.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use approx::assert_relative_eq;
use stats_alloc::Region;
use tabor::backend::long_field::{LongField, MAPPED};
use tabor::effect::Effect;
use tabor::scene::{Boundary, Scene, SurfacePart};
use tabor::study::{Cost, Memory, Plan, Setup};
use tabor::surface::{Source, Surface};

use crate::ALLOCATOR;
use crate::shared::trials::tests;

fn shipped() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes");
    let mut paths: Vec<PathBuf> = fs::read_dir(folder)
        .expect("the scenes are there")
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .collect();
    paths.sort();
    assert!(paths.len() >= 7);
    paths
}

fn read(path: &Path, points: Option<usize>) -> Scene {
    let set: Vec<(String, String)> = points
        .map(|points| ("grid.points".to_owned(), points.to_string()))
        .into_iter()
        .collect();
    Scene::read(path, &set).unwrap_or_else(|errors| panic!("{errors}"))
}

fn has_file(scene: &Scene) -> bool {
    scene
        .surfaces
        .iter()
        .any(|part| matches!(part, SurfacePart::File(_)))
}

/// All that a check does, and the bytes that it asked for in all, freed ones and those of fields in large pages included.
fn check(path: &Path, points: usize) -> (Plan, usize) {
    let mapped = MAPPED.load(Ordering::Relaxed);
    let region = Region::new(ALLOCATOR);
    let plan = Plan::for_scene(read(path, Some(points))).unwrap_or_else(|error| panic!("{error}"));
    let place = plan.place();
    let cost = plan.cost(place).expect("a plan");
    for effect in Effect::ALL {
        if effect.is_on(&plan.scene) {
            effect
                .cost(&plan.scene, &cost, plan.outline.grid)
                .expect("a plan");
        }
    }
    let available = 1 << 30;
    Memory::largest_grid(&plan.scene, plan.outline.grid, available).expect("a plan");
    let change = region.change();
    let bytes = change.bytes_allocated as isize + change.bytes_reallocated;
    let mapped = MAPPED.load(Ordering::Relaxed) - mapped;
    (plan, usize::try_from(bytes).unwrap_or(0) + mapped)
}

/// Everything in one test: the counter counts what other threads allocate too.
fn a_check_takes_no_field_and_says_what_the_heights_say() {
    // The counters count.
    let mapped = MAPPED.load(Ordering::Relaxed);
    let region = Region::new(ALLOCATOR);
    drop(std::hint::black_box(vec![1_u8; 1 << 20]));
    assert!(region.change().bytes_allocated >= 1 << 20);
    drop(std::hint::black_box(LongField::<u8>::zeros(4 << 20)));
    let mapped = MAPPED.load(Ordering::Relaxed) - mapped;
    assert_eq!(
        mapped,
        if cfg!(target_os = "linux") {
            4 << 20
        } else {
            0
        }
    );

    let mut checked = 0;
    for path in shipped() {
        let name = path.display();
        if has_file(&read(&path, None)) {
            continue;
        }
        // One field at this size has 2 GiB, one row of it 128 KiB.
        let (_, bytes) = check(&path, 16384);
        assert!(bytes < 16 << 20, "{name} asks for {bytes} bytes");
        checked += 1;
    }
    assert!(checked >= 6, "{checked}");

    for path in shipped() {
        let name = path.display();
        let few = read(&path, None);
        let scene = if has_file(&few) {
            few
        } else {
            read(&path, Some(192))
        };
        let plan = Plan::for_scene(scene.clone()).unwrap_or_else(|error| panic!("{name}: {error}"));
        let surface = Surface::build(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
        let setup = Setup::new(scene, surface);
        // The same cost, warnings and law with heights and without.
        let cost = plan.cost(plan.place()).expect("a plan");
        assert_eq!(cost, Cost::for_setup(&setup).expect("a plan"), "{name}");
        assert_eq!(plan.warnings, setup.warnings, "{name}");
        assert_eq!(plan.law, setup.law, "{name}");
        let (found, exact) = (plan.outline.moments, setup.statistics.moments);
        // Sums over the same modes in another order; an estimate leaves out what a shape's edges and
        // the sampling of its apex add, some per cent at 128 points.
        let margin = match plan.outline.source {
            Source::Heights | Source::Spectrum => 1e-9,
            Source::Estimate => 0.05,
        };
        assert_relative_eq!(
            found.rms_height(),
            exact.rms_height(),
            max_relative = margin
        );
        assert_relative_eq!(found.rms_slope(), exact.rms_slope(), max_relative = margin);
        // A shape that does not repeat is folded at the cell's edges, and the folds' curvature is that
        // of the pixels: the estimate leaves it out.
        let folded = plan.outline.source == Source::Estimate
            && plan.scene.grid.boundary == Boundary::Periodic;
        if !folded {
            let (found, exact) = (found.rms_curvature(), exact.rms_curvature());
            assert_relative_eq!(found, exact, max_relative = margin);
        }
    }
}

tests![a_check_takes_no_field_and_says_what_the_heights_say,];
