//! Adhesive spheres from soft and long-ranged to sharp, held to just below pull-off and beyond.

use std::f64::consts::PI;

use tabor::theory::maugis_dugdale::MaugisDugdale;

use super::case::{Case, Contact, Law};
use super::paths::Path;
use super::run::Run;

pub const SPHERE: &str = "[[surface]]\nkind = \"sphere\"\nradius = 1.0\n";

/// Units in which every scale of Maugis is 1: radius, K = 4E*/3 and pi w.
pub const MODULUS: f64 = 0.75;
pub const WORK: f64 = 1.0 / PI;

/// lambda of a Maugis-Dugdale law of the same work and peak as a Lennard-Jones one of Tabor number 1.
const LAMBDA: f64 = 1.157_011_63;

/// Points a side.
const POINTS: usize = 48;

/// Share to which pull-off is asked: the taper's error on spheres of such grids (2.1 % at chi 0.16,
/// 1.9 % at 0.33, 1.2 % at 0.65), and half as much for the pixels of a short contact.
const ACCURACY: f64 = 0.03;

/// The window, and the law in it, of a sphere that no load above `force` presses.
pub fn window(points: usize, lambda: f64, force: f64) -> Contact {
    let theory = MaugisDugdale::new(lambda).expect("a number");
    let states = theory.states_at_force(force).expect("states");
    let radius = states
        .iter()
        .map(|state| state.cohesive_radius)
        .fold(0.0, f64::max);
    let law = Law::MaugisDugdale {
        work: WORK,
        range: 2.0 / (PI * lambda),
        taper: None,
    };
    Contact::window(points, 2.3 * radius, MODULUS, law)
}

/// Radius of the counted contact.
fn radius(run: &Run, step: usize, side: f64) -> f64 {
    (run.rows[step].contact / PI).sqrt() * side
}

fn resolved(tabor: f64) -> Case {
    let lambda = LAMBDA * tabor;
    let contact = window(POINTS, lambda, 0.0);
    let theory = MaugisDugdale::new(lambda).expect("a number");
    let pull_off = -theory.pull_off().expect("a fold").force;
    let zero = theory.states_at_force(0.0).expect("states");
    let zero = zero
        .iter()
        .map(|state| state.contact_radius)
        .fold(0.0, f64::max);
    let side = contact.size[0];
    let path = [0.0, -0.6, -(1.0 - ACCURACY), -(1.0 + ACCURACY), 0.0].map(|share| share * pull_off);
    Case::new(format!("sphere, Tabor number {tabor}"), contact, SPHERE)
        .under("force", path)
        .so_that(move |run, _| {
            assert_ne!(run.rows[2].state, "separated", "parted below {pull_off}");
            assert_eq!(run.rows[3].state, "separated", "held beyond {pull_off}");
            assert_eq!(run.rows[4].contact, run.rows[0].contact);
            // The edge lies somewhere within a pixel, on either side.
            let found = radius(run, 0, side);
            assert!(
                (found - zero).abs() < side / POINTS as f64,
                "{found}, not {zero}"
            );
        })
}

/// A cohesive zone that the grid does not hold: an equilibrium of the pixels, one of many since they
/// trap the edge of the contact, and a word about it.
fn unresolved(tabor: f64, taper: Option<f64>) -> Case {
    let lambda = LAMBDA * tabor;
    let mut contact = window(POINTS, lambda, 0.0);
    let range = 2.0 / (PI * lambda);
    contact.law = Law::MaugisDugdale {
        work: WORK,
        range,
        taper,
    };
    let theory = MaugisDugdale::new(lambda).expect("a number");
    let pull_off = -theory.pull_off().expect("a fold").force;
    // More than the law's peak on every pixel of the window.
    let beyond = 2.0 * WORK / range * contact.size[0].powi(2);
    let sharp = if taper.is_some() { ", no taper" } else { "" };
    Case::new(
        format!("sphere, Tabor number {tabor}{sharp}: zone below a pixel"),
        contact,
        SPHERE,
    )
    .under("force", [0.0, -0.6 * pull_off, -beyond, 0.0])
    .not_compared()
    .so_that(move |run, _| {
        assert_eq!(run.states(), ["contact", "contact", "separated", "contact"]);
        let said = [": a pixel is", "range = \"auto\""]
            .iter()
            .all(|word| run.messages.contains(word));
        assert!(said, "{}", run.messages);
    })
}

/// The shortest range that the grid resolves, near the limit of JKR.
fn shortest(tabor: f64) -> Case {
    let lambda = LAMBDA * tabor;
    let mut contact = window(POINTS, lambda, 0.0);
    let pixel = contact.pixel()[0];
    let range = (2.0 * WORK * pixel / MODULUS).sqrt();
    contact.law = Law::MaugisDugdale {
        work: WORK,
        range,
        taper: None,
    };
    // Above the 1.5 pi w R of JKR by 1.8 to 5.5 % on grids that resolve the contact as well or less.
    let path = [0.0, -0.6, -0.99, -1.06].map(|share| 1.5 * share);
    Case::new(
        format!("sphere, Tabor number {tabor}, range = \"auto\""),
        contact,
        SPHERE,
    )
    .under("force", path)
    .reworded(format!("range = {range:e}"), "range = \"auto\"")
    .so_that(|run, _| {
        assert_eq!(run.states(), ["contact", "contact", "contact", "separated"]);
    })
}

/// Lennard-Jones, in units of range, radius and work: the independent table's pull-off, less the
/// attraction outside the window.
fn lennard_jones(
    tabor: f64,
    points: usize,
    side: f64,
    pull_off: f64,
    at: f64,
    accuracy: f64,
) -> Case {
    let law = Law::LennardJones {
        work: 1.0,
        range: 1.0,
    };
    let contact = Contact::window(points, side, tabor.powf(-1.5), law);
    let half = 0.5 * side;
    let outside = 0.93 / (1.0 - at + 0.5 * half * half).powi(2);
    let within = 2.0 * PI * (pull_off - outside);
    let path = [0.0, -0.6, -(1.0 - accuracy), -(1.0 + accuracy), 0.0].map(|share| share * within);
    Case::new(
        format!("sphere, Lennard-Jones, Tabor number {tabor}"),
        contact,
        SPHERE,
    )
    .under("force", path)
    .so_that(move |run, _| {
        assert_ne!(run.rows[2].state, "separated", "parted below {within}");
        assert_eq!(run.rows[3].state, "separated", "held beyond {within}");
    })
}

/// A cohesive zone that the grid does not hold, of the law without a wall.
fn unresolved_core(tabor: f64) -> Case {
    let law = Law::LennardJones {
        work: 1.0,
        range: 1.0,
    };
    let side = 14.0_f64;
    let contact = Contact::window(64, side, tabor.powf(-1.5), law);
    // The law's peak is 1.03 w/range; pull-off of any sphere at least 1.5 pi w R.
    let beyond = 2.0 * side * side;
    let name = format!("sphere, Lennard-Jones, Tabor number {tabor}: zone below a pixel");
    Case::new(name, contact, SPHERE)
        .under("force", [0.0, -0.6 * 1.5 * PI, -beyond, 0.0])
        .not_compared()
        .so_that(|run, _| {
            assert_eq!(run.states(), ["contact", "contact", "separated", "contact"]);
            let said = [": a pixel is", "range = \"auto\""]
                .iter()
                .all(|word| run.messages.contains(word));
            assert!(said, "{}", run.messages);
        })
}

/// Nearly rigid: 2 pi w R for every law, from below.
fn exponential() -> Case {
    let law = Law::Exponential {
        work: 1.0,
        range: 1.0,
    };
    let contact = Contact::window(POINTS, 14.0, 0.05_f64.powf(-1.5), law);
    let path = [0.0, -0.6, -0.93, -1.02, 0.0].map(|share| 2.0 * PI * share);
    Case::new("sphere, exponential, Tabor number 0.05", contact, SPHERE)
        .under("force", path)
        .so_that(|run, _| {
            assert_ne!(run.rows[2].state, "separated");
            assert_eq!(run.rows[3].state, "separated");
        })
}

/// From the start under a tension that nothing carries, and far beyond it.
fn torn() -> Case {
    let contact = window(32, 1.0, 0.0);
    Case::new("sphere, torn from the start and again", contact, SPHERE)
        .under("force", [-1e6, -2.0, 0.0, -1e6, 0.0])
        .so_that(|run: &Run, _: &Path| {
            let expected = ["separated", "separated", "contact", "separated", "contact"];
            assert_eq!(run.states(), expected);
            assert_eq!(run.rows[2].contact, run.rows[4].contact);
        })
}

pub fn cases() -> Vec<Case> {
    let mut cases: Vec<Case> = [0.05, 0.2, 0.5, 1.0, 2.0].map(resolved).into();
    cases.extend([
        unresolved(5.0, None),
        unresolved(10.0, None),
        unresolved(2.0, Some(0.0)),
    ]);
    cases.extend([shortest(5.0), shortest(10.0)]);
    cases.push(lennard_jones(
        0.5,
        64,
        20.0,
        0.893_741_465_514,
        -0.447_016_584_582,
        0.03,
    ));
    cases.push(lennard_jones(
        2.0,
        64,
        14.0,
        0.791_797_651_507,
        -1.658_075_097_8,
        0.05,
    ));
    cases.extend([unresolved_core(5.0), unresolved_core(10.0)]);
    cases.extend([exponential(), torn()]);
    cases
}
