//! A path of arrays whose device fails.

use std::env;
use std::process::Command;

use tabor::Grid;
use tabor::{Contact, Control, Device, MaugisDugdale, Roughness, SelfAffine, Solution};

use crate::shared::device::device;
use crate::shared::trials::tests;

/// Where this binary's child finds the fault to try.
const FAULT: &str = "TABOR_TEST_GPU";

/// Loads up, down and into tension, and the warnings after them.
fn walked(device: Device) -> (Vec<Solution>, Vec<String>) {
    let grid = Grid::new([64, 64], [2e-6, 2e-6]);
    let surface = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsSlope(0.1),
        longest: 2e-6,
        rolloff: 1e-6,
        shortest: 0.25e-6,
        seed: 1,
    };
    let heights = surface.heights(grid).expect("waves that the grid holds");
    let contact = Contact::new(heights, grid.points(), grid.size())
        .contact_modulus(1e9)
        .law(MaugisDugdale::new(0.05, 4e-9))
        .device(device);
    let mut path = contact.path([20e6, 60e6, 5e6].map(Control::MeanPressure));
    let solutions = path.by_ref().collect::<Result<_, _>>();
    (
        solutions.expect("loads that can be solved"),
        path.warnings(),
    )
}

/// Whether the device is lost before the first load ends, amid the path, or late, the processor continues, and each
/// load has the contact that the processor alone finds.
///
/// The choice of a device reads the environment, which a test must not change: a process of its own has the fault.
fn where_the_device_is_lost_the_processor_continues() {
    device();
    if env::var_os(FAULT).is_some() {
        let (found, warnings) = walked(Device::auto());
        let continues = |warning: &String| warning.contains("the processor continues");
        assert!(warnings.iter().any(continues), "{warnings:?}");
        let (alone, _) = walked(Device::cpu());
        assert_eq!(found.len(), alone.len());
        for (found, alone) in found.iter().zip(&alone) {
            assert!(found.converged);
            assert_eq!(found.state, alone.state);
            assert_eq!(found.gap.len(), alone.gap.len());
            // Both to a residual of 1e-6; a pixel at the edge may differ.
            let pixel = 1.5 / found.gap.len() as f64;
            assert!((found.contact_area_fraction - alone.contact_area_fraction).abs() < pixel);
            let gaps = [found.mean_gap, alone.mean_gap].map(|gap| gap.expect("in contact"));
            assert!((gaps[0] / gaps[1] - 1.0).abs() < 1e-5, "{gaps:?}");
        }
        return;
    }
    for dispatches in [40, 400, 800] {
        let output = Command::new(env::current_exe().expect("this binary"))
            .args([
                "--exact",
                "path::where_the_device_is_lost_the_processor_continues",
            ])
            .env(FAULT, format!("software,lost={dispatches}"))
            .output()
            .expect("this binary runs");
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(
            said.contains("1 passed; 0 failed; 0 ignored"),
            "{dispatches}: {said}"
        );
    }
}

tests![where_the_device_is_lost_the_processor_continues];
