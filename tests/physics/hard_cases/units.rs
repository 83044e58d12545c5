//! Units that make intermediate numbers tiny or huge, heights far from their origin or from the range
//! of adhesion, and tolerances at the floor of the arithmetic.

use std::sync::OnceLock;

use super::case::{Case, Contact, Law};
use super::flats::{FILE, NAME};
use super::paths::{PATHS, Path};
use super::run::{self, Row, Run};
use super::spheres::SPHERE;
use super::walls;

/// A rough adhesive contact in units of `lateral`, `vertical` and `modulus`.
fn scaled(name: &str, [lateral, vertical, modulus]: [f64; 3], more: &str) -> Case {
    let law = Law::MaugisDugdale {
        work: 1e-4 * modulus * vertical * vertical / lateral,
        range: 4e-3 * vertical,
        taper: None,
    };
    let contact = Contact {
        size: [lateral; 2],
        modulus,
        ..Contact::cell(32, law)
    };
    let surface = format!(
        "[[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_height = {:e}\nlongest = {:e}\n\
         rolloff = {:e}\nshortest = {:e}\nseed = 5\n{more}",
        0.01 * vertical,
        lateral,
        0.5 * lateral,
        0.125 * lateral,
    );
    let pressure = modulus * vertical / lateral;
    Case::new(name, contact, surface)
        .under("pressure", [0.02, 0.1, 0.002].map(|share| share * pressure))
}

/// The rows in units of 1 on a path, which all others are compared with.
fn base(path: &Path) -> &'static [Row] {
    static ROWS: [OnceLock<Vec<Row>>; PATHS.len()] = [const { OnceLock::new() }; PATHS.len()];
    let place = PATHS.iter().position(|other| other.name == path.name);
    ROWS[place.expect("one of the paths")]
        .get_or_init(|| run::run(&scaled("in units of 1", [1.0; 3], ""), path).rows)
}

/// The same numbers in every unit: rounding moves them by what it moves an iteration, and single
/// precision by its tolerance.
fn same(run: &Run, path: &Path, [lateral, vertical, modulus]: [f64; 3], rounding: f64) {
    let base = base(path);
    let energy = modulus * vertical * vertical * lateral;
    for (ours, base) in run.rows.iter().zip(base) {
        let numbers = [
            (
                ours.mean_gap.expect("a gap") / vertical,
                base.mean_gap.expect("a gap"),
            ),
            (ours.elastic_energy / energy, base.elastic_energy),
        ];
        let allowed = (if path.is_single() {
            10.0 * path.tolerance
        } else {
            1e-9
        })
        .max(rounding);
        for (ours, base) in numbers {
            assert!((ours / base - 1.0).abs() <= allowed, "{ours:e} {base:e}");
        }
        assert!(
            (ours.contact - base.contact).abs() <= 1.0 / 1024.0,
            "{} {}",
            ours.contact,
            base.contact
        );
    }
}

fn units() -> Vec<Case> {
    let scales = [
        ("nanometres and terapascals", [1e-9, 1e-9, 1e12]),
        (
            "lengths of 1e-20 and 1e-25, modulus 1e30",
            [1e-20, 1e-25, 1e30],
        ),
        ("lengths of 1e12 and 1e9, modulus 1e-15", [1e12, 1e9, 1e-15]),
        ("heights a trillionth of the side", [1.0, 1e-12, 1.0]),
    ];
    let mut cases: Vec<Case> = scales
        .into_iter()
        .map(|(name, scale)| {
            scaled(&format!("units: {name}"), scale, "")
                .so_that(move |run, path| same(run, path, scale, 0.0))
        })
        .collect();
    // Beyond what a scene takes.
    let mut beyond = scaled("units: heights of 1e-60", [1.0, 1e-60, 1.0], "");
    beyond.refused = |_, _| Some(vec!["check the powers of ten".to_owned()]);
    cases.push(beyond);
    // The same number on every point: a million rms heights round as much more.
    let file = format!("{FILE}unit = \"m\"\n");
    let far = scaled("origin a million rms heights away", [1.0; 3], &file)
        .with_file(NAME, vec![1e4; 1024]);
    cases.push(far.so_that(|run, path| same(run, path, [1.0; 3], 1e6 * f64::EPSILON * 10.0)));
    cases
}

/// Heights a million times the range of adhesion.
fn tall(name: &str, law: fn(f64, f64) -> Law) -> Case {
    let range = 1e-6;
    // chi = w dx/(E* range^2) = 0.1.
    let work = 0.1 * range * range * 64.0;
    let surface = walls::rough(64, 8.0).replace("rms_slope = 1.0", "rms_height = 1.0");
    let contact = Contact::cell(64, law(work, range));
    Case::new(
        format!("heights a million times the range, {name}"),
        contact,
        surface,
    )
    .under("pressure", [1.0, 100.0, 0.01])
}

fn floors() -> Vec<Case> {
    let rough = || walls::rough(64, 4.0);
    let wall = Contact::cell(64, Law::Wall);
    let core = Contact::window(
        32,
        14.0,
        1.0,
        Law::LennardJones {
            work: 1.0,
            range: 1.0,
        },
    );
    let mut hurried = Case::new("rough, three iterations allowed", wall.clone(), rough());
    hurried.max_iterations = 3;
    let mut cases = vec![hurried.under("pressure", [0.05])];
    for tolerance in [1e-12, 1e-15] {
        cases.push(
            Case::new(
                format!("rough, tolerance {tolerance:e}"),
                wall.clone(),
                rough(),
            )
            .under("pressure", [0.05])
            .to(tolerance),
        );
        cases.push(
            Case::new(
                format!("sphere, Lennard-Jones, tolerance {tolerance:e}"),
                core.clone(),
                SPHERE,
            )
            .under("force", [0.0, 5.0])
            .to(tolerance),
        );
    }
    cases
}

pub fn cases() -> Vec<Case> {
    let mut cases = units();
    cases.push(tall("Maugis-Dugdale", |work, range| Law::MaugisDugdale {
        work,
        range,
        taper: None,
    }));
    cases.push(tall("exponential", |work, range| Law::Exponential {
        work,
        range,
    }));
    cases.push(tall("Lennard-Jones", |work, range| Law::LennardJones {
        work,
        range,
    }));
    // Adhesion so strong that it matters all the same: the zone is far below a pixel.
    cases.push(
        tall("strong adhesion", |_, range| Law::MaugisDugdale {
            work: 1.0,
            range,
            taper: None,
        })
        .not_compared(),
    );
    cases.extend(floors());
    cases
}
