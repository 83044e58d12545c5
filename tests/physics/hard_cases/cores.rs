//! Long steps into the core of the Lennard-Jones law, and laws whose attraction is near the rounding.

use super::case::{Case, Contact, Law};

fn surface(longest_flat: f64, shortest: f64, seed: u64) -> String {
    format!(
        "[[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_height = 0.01\nlongest = 1.0\n\
         rolloff = {longest_flat}\nshortest = {shortest}\nseed = {seed}\n"
    )
}

/// Steps of 3 to 20 ranges: taken rigidly they end far inside the core, where single precision has no
/// digits and the law soon has none either.
fn pressed() -> Vec<Case> {
    let law = |points: usize, range: f64, chi: f64| Law::LennardJones {
        work: chi * range * range * points as f64,
        range,
    };
    vec![
        Case::new(
            "rough, Lennard-Jones, gap held in long steps",
            Contact::cell(32, law(32, 4e-3, 0.05)),
            surface(0.5, 0.125, 1),
        )
        .under("mean-gap", [0.03, 0.01, 0.03]),
        Case::new(
            "rough, Lennard-Jones, approach held in long steps",
            Contact::cell(32, law(32, 1e-3, 0.05)),
            surface(0.5, 0.125, 5),
        )
        .under("approach", [-1e-3, 0.02, -1e-3]),
    ]
}

/// Pressed and let go to no load, held by less than single precision tells from nothing.
fn let_go() -> Vec<Case> {
    vec![
        Case::new(
            "rough, Lennard-Jones, let go",
            Contact::cell(
                16,
                Law::LennardJones {
                    work: 4.8e-8,
                    range: 1e-3,
                },
            ),
            surface(0.5, 0.125, 1),
        )
        .under("pressure", [3e-3, 0.0]),
        Case::new(
            "white noise, exponential, let go",
            Contact::cell(
                16,
                Law::Exponential {
                    work: 4.8e-10,
                    range: 1e-4,
                },
            ),
            surface(0.25025, 0.25, 1),
        )
        .under("pressure", [3e-3, 0.0]),
    ]
}

pub fn cases() -> Vec<Case> {
    pressed().into_iter().chain(let_go()).collect()
}
