//! Rough and wavy walls without adhesion: from one pixel to far beyond full contact.

use std::f64::consts::PI;

use super::case::{Case, Contact, Law};
use super::paths::Path;
use super::run::Run;
use super::truth::{self, Fields};

/// A self-affine surface of rms slope 1 on a cell of side 1, cut off at so many pixels a wave.
pub fn rough(points: usize, pixels: f64) -> String {
    format!(
        "[[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_slope = 1.0\nlongest = 1.0\n\
         rolloff = 0.25\nshortest = {:e}\nseed = 3\n",
        pixels / points as f64
    )
}

const WAVE: &str = "[[surface]]\nkind = \"wavy\"\namplitude = 0.01\nwavelength = [1.0, \"inf\"]\n";
/// Pressure that flattens the wave: pi E* amplitude over wavelength (Westergaard 1939).
const FLATTENS: f64 = PI * 0.01;

fn contact_between(low: f64, high: f64) -> impl Fn(&Run, &Path) {
    move |run, _| {
        let found = run.rows.last().expect("a row").contact;
        assert!(
            (low..=high).contains(&found),
            "contact of {found}, not {low} to {high}"
        );
    }
}

fn separated(run: &Run, _: &Path) {
    for row in &run.rows {
        assert_eq!((row.state.as_str(), row.force), ("separated", 0.0));
    }
}

pub fn cases() -> Vec<Case> {
    let cell = |points| Contact::cell(points, Law::Wall);
    let wall = |name: &str, pressure: f64| {
        Case::new(name, cell(64), rough(64, 4.0)).under("pressure", [pressure])
    };
    let mut cases = vec![
        wall("rough, pressure 1e-3 E*h'", 1e-3),
        wall("rough, pressure 1e-9 E*h'", 1e-9)
            .so_that(contact_between(1.0 / 4096.0, 2.0 / 4096.0)),
        wall("rough, 95 % contact", 0.87).so_that(contact_between(0.94, 0.96)),
        wall("rough, 99.9 % contact", 1.43).so_that(contact_between(0.998, 0.9999)),
        wall("rough, full contact", 3.0).so_that(flattened),
        wall("rough, a hundred times full contact", 300.0).so_that(flattened),
        wall("rough, no load", 0.0).so_that(separated),
        wall("rough, tension on a wall", -1.0).so_that(separated),
        wall("rough, mean gap above the peak", 0.0)
            .under("mean-gap", [1.0])
            .so_that(separated),
        wall("rough, mean gap of 1e-7", 0.0)
            .under("mean-gap", [1e-7])
            .so_that(contact_between(0.99, 1.0)),
        wall("rough, mean gap of 0", 0.0)
            .under("mean-gap", [0.0])
            .so_that(contact_between(1.0, 1.0)),
        wall("rough, cut off at Nyquist", 0.1).surfaced(rough(64, 2.0)),
        wall("rough, cut off at the corner", 0.1).surfaced(rough(64, 2f64.sqrt())),
        wall("rough, back and forth", 0.1)
            .under("pressure", [0.01, 3.0, 0.01, 30.0, 0.01])
            .so_that(|run, path| {
                // Without adhesion the path leaves no trace.
                let contact: Vec<f64> = run.rows.iter().map(|row| row.contact).collect();
                let share = 2.0 / 4096.0_f64;
                let allowed = if path.is_single() { share } else { 0.0 };
                for other in [2, 4] {
                    assert!(
                        (contact[other] - contact[0]).abs() <= allowed,
                        "{contact:?}"
                    );
                }
            }),
    ];
    for (name, share) in [
        ("wave, 95 % contact", (PI * 0.475).sin().powi(2)),
        ("wave, 99.9 % of the flattening pressure", 0.999),
        ("wave, the flattening pressure", 1.0),
        ("wave, a thousand times that", 1e3),
    ] {
        let case = Case::new(
            name,
            Contact {
                points: [64, 4],
                size: [1.0, 0.0625],
                ..cell(64)
            },
            WAVE,
        );
        cases.push(
            case.under("pressure", [share * FLATTENS])
                .so_that(move |run, _| {
                    // Half the contact's width over the wave is asin(sqrt(p/p*))/pi; each edge lies somewhere
                    // within a pixel.
                    let expected = 2.0 * share.min(1.0).sqrt().asin() / PI;
                    let found = run.rows[0].contact;
                    assert!(
                        (found - expected).abs() <= 2.0 / 64.0,
                        "{found}, not {expected}"
                    );
                }),
        );
    }
    cases.push(one_pixel());
    cases
}

/// Pressed flat the pressure is the load and the surface's own waves, K*h, nothing else.
fn flattened(run: &Run, path: &Path) {
    let row = &run.rows[0];
    assert_eq!(row.contact, 1.0);
    let contact = Contact::cell(64, Law::Wall);
    let heights = run.field(1, "heights").expect("heights");
    let fields = Fields::at_step(run, 1).expect("fields");
    let waves = truth::elastic_pressure(&contact, &heights);
    let off = truth::norm(
        fields
            .pressure
            .iter()
            .zip(&waves)
            .map(|(p, k)| p - k - row.mean_pressure),
    );
    let size = truth::norm(fields.pressure.iter().copied());
    // Rounding of the heights in the stiffest wave, and of the pressures.
    let [stiffest, _] = truth::stiffest_and_softest(&contact);
    let allowed = 4.0 * path.epsilon * (stiffest * truth::norm(heights) + size);
    assert!(off <= allowed, "off by {off:e} of {size:e}");
}

/// A sphere that touches in the one pixel at its apex: it carries the whole load.
fn one_pixel() -> Case {
    let load = 1e-7;
    let surface = "[[surface]]\nkind = \"sphere\"\nradius = 1.0\ncentre = [0.5, 0.5]\n";
    Case::new(
        "sphere, one pixel in contact",
        Contact::cell(32, Law::Wall),
        surface,
    )
    .under("force", [load])
    .so_that(move |run, path| {
        let fields = Fields::at_step(run, 1).expect("fields");
        let apex = 16 * 32 + 16;
        let touching = (0..1024)
            .filter(|i| fields.gap[*i] == 0.0)
            .collect::<Vec<_>>();
        assert_eq!(touching, [apex]);
        let carried = load * 1024.0;
        let off = (fields.pressure[apex] - carried).abs();
        // The pressure is K*u: the rounding of u, a quarter at most, in the stiffest wave.
        let [stiffest, _] = truth::stiffest_and_softest(&Contact::cell(32, Law::Wall));
        let allowed = path.tolerance * carried + path.epsilon * stiffest * 0.25;
        assert!(
            off <= allowed,
            "{off:e} of {carried:e}, {allowed:e} allowed"
        );
    })
}
