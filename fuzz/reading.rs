//! What is asked of any bytes, taken as a scene or as a height file: an answer, never a panic.
//!
//! The fuzz targets feed it, and a test of the main package feeds it their corpus again.

use std::fs;
use std::path::Path;

use tabor::scene::{Boundary, Detrend, Fill, GridScene, HeightFileScene, Scene, SurfacePart};
use tabor::study::{Plan, Setup};
use tabor::surface::Surface;

/// Points up to which heights are built for each of many inputs.
const FEW_POINTS: usize = 1 << 14;
/// Waves of a spectrum up to which they are built: beyond, summing them takes seconds by itself.
const FEW_WAVES: f64 = 200.0;
/// Longest message that a person reads.
const LONGEST_MESSAGE: usize = 2000;

/// Reads bytes as a scene whose paths begin in `folder`, plans its run, and builds it where it is small.
pub fn scene(bytes: &[u8], folder: &Path) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let scene = match Scene::parse(text, "scene.toml", folder, &[]) {
        Ok(scene) => scene,
        Err(errors) => {
            assert!(!errors.0.is_empty());
            let lines = text.split('\n').count();
            for mistake in &errors.0 {
                assert!(
                    (1..=lines).contains(&mistake.line.unwrap_or(1)),
                    "{mistake}"
                );
            }
            return;
        }
    };
    let Ok(plan) = Plan::for_scene(scene.clone()) else {
        return;
    };
    plan.memory(plan.place()).expect("a count");
    let grid = plan.outline.grid;
    let few_waves = plan.scene.surfaces.iter().all(|part| match part {
        SurfacePart::SelfAffine(rough) => grid.lx.max(grid.ly) / rough.shortest < FEW_WAVES,
        _ => true,
    });
    if grid.len() > FEW_POINTS || !few_waves {
        return;
    }
    match Surface::build(&scene) {
        Ok(surface) => drop(Setup::new(scene, surface)),
        // Heights past the range of numbers, and a pattern that no point falls on, are known once they
        // are there.
        Err(error) => {
            let said = error.to_string();
            let late = ["not finite", "map pattern: every factor is 0"];
            assert!(late.iter().any(|late| said.contains(late)), "{error}");
        }
    }
}

/// Extensions that a height file may come under.
const EXTENSIONS: [&str; 16] = [
    "npy", "png", "tif", "gsf", "gwy", "grd", "sdf", "sur", "al3d", "xyz", "txt", "csv", "asc",
    "tsv", "dat", "",
];

/// Reads bytes as a height file. The first says its extension, the second what is done with it, and
/// the rest is the file, written to a scratch file in `folder`.
pub fn heights(bytes: &[u8], folder: &Path) {
    let [extension, options, file @ ..] = bytes else {
        return;
    };
    let extension = EXTENSIONS[usize::from(*extension) % EXTENSIONS.len()];
    let path = folder.join(format!("heights-{}.{extension}", std::process::id()));
    fs::write(&path, file).expect("a scratch file");
    let bit = |place: u8| options >> place & 1 == 1;
    let ends = |height: f64| bit(3).then_some(height);
    let boundary = if bit(0) {
        Boundary::Free
    } else {
        Boundary::Periodic
    };
    let part = SurfacePart::File(HeightFileScene {
        preparation: tabor::scene::Preparation::default(),
        path: path.clone(),
        unit: if bit(6) { 1e-9 } else { 1.0 },
        scale: if bit(7) { -2.0 } else { 1.0 },
        black: ends(-1e-6),
        white: ends(1e-6),
        detrend: Detrend::ALL[usize::from(options >> 4 & 3)],
        fill: if bit(1) {
            Fill::Interpolate
        } else {
            Fill::None
        },
    });
    let grid = GridScene {
        points: None,
        size: bit(2).then_some([1e-5, 2e-5]),
        boundary,
    };
    match Surface::from_parts(&grid, std::slice::from_ref(&part)) {
        Ok(surface) => {
            assert_eq!(surface.heights.len(), surface.grid.len());
            assert!(surface.heights.iter().all(|height| height.is_finite()));
            if surface.grid.len() <= FEW_POINTS {
                surface.statistics(boundary);
            }
        }
        Err(error) => {
            let message = error.to_string();
            assert!(!message.contains('\n'), "{message}");
            assert!(
                message.len() < LONGEST_MESSAGE + path.as_os_str().len(),
                "{message}"
            );
        }
    }
    fs::remove_file(&path).expect("the scratch file");
}
