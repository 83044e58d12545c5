//! A liquid bridge pulls like the Maugis-Dugdale sphere that it is equivalent to.

use std::f64::consts::PI;

use tabor::theory::capillary::Meniscus;
use tabor::theory::maugis_dugdale::MaugisDugdale;
use tabor::theory::tabor_map::{Sphere, maugis_parameter};

use crate::bench::{setup, solve_table};
use crate::shared::trials::tests;

const RADIUS: f64 = 1e-6;

fn scene(modulus: f64, humidity: f64, size: f64, path: &[f64]) -> String {
    format!(
        r#"
        [grid]
        points = 128
        size = {size:e}
        boundary = "free"
        [solid]
        contact_modulus = {modulus:e}
        [[surface]]
        kind = "sphere"
        radius = {RADIUS:e}
        [capillary]
        humidity = {humidity}
        surface_tension = 0.0728
        molar_volume = 1.8e-5
        contact_angle = 20
        [loading]
        control = "approach"
        path = {path:?}
        [solver]
        tolerance = 1e-7
        "#
    )
}

/// Pull-off of a hard and of a soft sphere at half humidity against Maugis' curve. The path is
/// walked in steps of a fortieth of the meniscus' height, over which the force near its least
/// changes by less than a part in a thousand; the pixels' error is that of the sphere tests, 5e-3.
fn pull_off_at_half_humidity() {
    let meniscus =
        Meniscus::new(0.0728, 1.8e-5, 298.15, 0.5, 20f64.to_radians()).expect("a meniscus");
    let unit = 2.0 * PI * meniscus.work_of_adhesion() * RADIUS;
    // From the DMT side, where 4 pi R gamma cos(theta) holds, towards JKR's three quarters.
    for (modulus, size) in [(70e9, 2.0e-7), (5e9, 2.4e-7)] {
        let sphere = Sphere::new(RADIUS, modulus, meniscus.work_of_adhesion()).expect("a sphere");
        let lambda = maugis_parameter(&sphere, meniscus.peak_tension()).expect("a parameter");
        let pull_off = MaugisDugdale::new(lambda).and_then(|theory| theory.pull_off());
        // Maugis' unit of force is pi w R.
        let expected = -0.5 * unit * pull_off.expect("a pull-off").force;
        let step = meniscus.range() / 40.0;
        let path: Vec<f64> = (0..80).map(|i| step * (20.0 - f64::from(i))).collect();
        let solved = solve_table(&scene(modulus, 0.5, size, &path));
        let found = solved.rows().map(|row| -row.force).fold(0.0, f64::max);
        println!(
            "{modulus:e}: {:.4} {:.4} of 2 pi w R",
            found / unit,
            expected / unit
        );
        assert!(
            (found - expected).abs() < 5e-3 * unit,
            "{modulus:e}: {found} {expected}"
        );
    }
}

/// Air too dry for a liquid surface: no attraction, and the scene says so.
fn dry_air_bridges_nothing() {
    let solved = solve_table(&scene(70e9, 0.1, 2e-7, &[1e-10, 0.0, -1e-10]));
    assert!(
        solved
            .rows()
            .all(|row| row.force >= 0.0 && row.adhesive_energy == 0.0)
    );
    assert!(
        solved
            .setup
            .warnings
            .iter()
            .any(|warning| warning.contains("no liquid bridges"))
    );
}

/// A scene's liquid is water at the temperature that the scene gives.
fn water_has_its_values_at_the_temperature() {
    let water = |more: &str| {
        let text = scene(5e9, 0.5, 2.4e-7, &[-3e-9])
            .replace("surface_tension = 0.0728", "")
            .replace("molar_volume = 1.8e-5", more);
        let liquid = setup(&text).scene.capillary.expect("a liquid");
        (liquid.surface_tension, liquid.molar_volume)
    };
    assert_eq!(water(""), (0.07199, 1.8069e-5));
    assert_eq!(water("temperature = 298.15"), water(""));
    // IAPWS: 58.91 mN/m, and 18.0153 g/mol over 958.35 kg/m^3 at 100 degrees Celsius, next to the rounding of the values at 25.
    let (tension, volume) = water("temperature = 373.15");
    assert!((tension / 0.05891 - 1.0).abs() < 5e-4, "{tension}");
    assert!((volume / 1.87982e-5 - 1.0).abs() < 5e-4, "{volume}");
    // What the scene gives stays.
    let (tension, volume) = water("temperature = 373.15\nsurface_tension = 0.06");
    assert_eq!(tension, 0.06);
    assert!((volume / 1.87982e-5 - 1.0).abs() < 5e-4, "{volume}");
}

/// A meniscus lower than a molecule, and one that fills the whole cell, are warned of.
fn implausible_menisci_are_warned_of() {
    let warnings = |from: &str, to: &str, boundary: &str| {
        let text = scene(5e9, 0.5, 2.4e-7, &[-3e-9])
            .replace(from, to)
            .replace("\"free\"", boundary);
        setup(&text).warnings.join("\n")
    };
    let plain = warnings("", "", "\"free\"");
    let flat = warnings("contact_angle = 20", "contact_angle = 89.5", "\"free\"");
    let damp = warnings("humidity = 0.5", "humidity = 0.99", "\"periodic\"");
    assert!(
        !plain.contains("molecule") && !plain.contains("fills"),
        "{plain}"
    );
    assert!(flat.contains("less than a molecule"), "{flat}");
    assert!(damp.contains("fills the gap of the whole cell"), "{damp}");
}

tests![
    pull_off_at_half_humidity,
    dry_air_bridges_nothing,
    water_has_its_values_at_the_temperature,
    implausible_menisci_are_warned_of,
];
