//! The functions by the names that Python calls them by.

use std::cell::RefCell;
use std::f64::consts::{FRAC_PI_2, PI};

use tabor::theory::bam::BearingArea;
use tabor::theory::cohesive_wave::{CohesiveWave, WaveState};
use tabor::theory::cone_punch::{Cone, punch_force};
use tabor::theory::gw::Summits;
use tabor::theory::maugis_dugdale::{MaugisDugdale, State};
use tabor::theory::pastewka_robbins::{Edge, stickiness_ratio};
use tabor::theory::persson::Persson;
use tabor::theory::persson_gap::{Adhesion, RoughContact};
use tabor::theory::tabor_map::{self, Regime};
use tabor::theory::{
    Spectrum, Sphere, TheoryError, bradley, derjaguin, dmt, fuller_tabor, gw_m, hertz, jkr, layer,
    love, westergaard,
};

use super::effects::positive;
use super::lennard_jones;
use super::{Evaluate, Words};

/// The functions of bodies and surfaces by name, with the number of their results.
pub const FUNCTIONS: &[(&str, usize, Evaluate)] = &[
    // Spheres without adhesion.
    ("hertz.contact_radius", 1, |_, x| {
        Ok(vec![hertz::contact_radius(&hard(x)?, x[2])?])
    }),
    ("hertz.contact_radius_at_approach", 1, |_, x| {
        Ok(vec![hertz::contact_radius_at_approach(&hard(x)?, x[2])?])
    }),
    ("hertz.approach", 1, |_, x| {
        Ok(vec![hertz::approach(&hard(x)?, contact_radius(x[2])?)])
    }),
    ("hertz.force", 1, |_, x| {
        Ok(vec![hertz::force(&hard(x)?, contact_radius(x[2])?)])
    }),
    ("hertz.stiffness", 1, |_, x| {
        Ok(vec![hertz::stiffness(&hard(x)?, contact_radius(x[2])?)])
    }),
    ("hertz.pressure", 1, |_, x| {
        Ok(vec![hertz::pressure(
            &hard(x)?,
            contact_radius(x[2])?,
            x[3],
        )])
    }),
    ("hertz.displacement", 1, |_, x| {
        Ok(vec![hertz::displacement(
            &hard(x)?,
            contact_radius(x[2])?,
            x[3],
        )])
    }),
    ("hertz.gap", 1, |_, x| {
        Ok(vec![hertz::gap(&hard(x)?, contact_radius(x[2])?, x[3])])
    }),
    ("cone.force", 1, |_, x| {
        Ok(vec![cone(x)?.force(contact_radius(x[2])?)])
    }),
    ("cone.approach", 1, |_, x| {
        Ok(vec![cone(x)?.approach(contact_radius(x[2])?)])
    }),
    ("cone.contact_radius", 1, |_, x| {
        Ok(vec![cone(x)?.contact_radius(x[2])?])
    }),
    ("cone.mean_pressure", 1, |_, x| {
        Ok(vec![cone(x)?.mean_pressure()])
    }),
    ("cone.pressure", 1, |_, x| {
        Ok(vec![cone(x)?.pressure(contact_radius(x[2])?, x[3])])
    }),
    ("flat_punch.force", 1, |_, x| {
        Ok(vec![punch_force(x[0], x[1], x[2])?])
    }),
    // Rigid adhesive spheres.
    ("bradley.force", 1, |words, x| {
        Ok(vec![bradley::force(
            &Sphere::new(x[0], 1.0, x[1])?,
            words.law,
            x[2],
            x[3],
        )?])
    }),
    ("derjaguin.force", 1, |_, x| {
        Ok(vec![derjaguin::force(&sphere(x)?, contact_radius(x[3])?)])
    }),
    ("dmt.force", 1, |words, x| {
        let sphere = sphere(x)?;
        let reduced = tabor_map::tabor_parameter(&sphere, x[3])?;
        let force = dmt::force(words.method, words.law, x[4] / x[3], reduced)?;
        Ok(vec![
            force * 2.0 * PI * sphere.work_of_adhesion() * sphere.radius(),
        ])
    }),
    ("dmt.pull_off", 2, |words, x| {
        let sphere = sphere(x)?;
        let reduced = tabor_map::tabor_parameter(&sphere, x[3])?;
        let (radius, force) = dmt::pull_off(words.method, words.law, reduced)?;
        let force = force * 2.0 * PI * sphere.work_of_adhesion() * sphere.radius();
        Ok(vec![force, radius * (sphere.radius() * x[3]).sqrt()])
    }),
    // Soft adhesive spheres.
    ("jkr.contact_radius", 1, |_, x| {
        Ok(vec![jkr::contact_radius(&sphere(x)?, x[3])?])
    }),
    ("jkr.contact_radius_at_approach", 1, |_, x| {
        Ok(vec![jkr::contact_radius_at_approach(&sphere(x)?, x[3])?])
    }),
    ("jkr.approach", 1, |_, x| {
        Ok(vec![jkr::approach(&sphere(x)?, contact_radius(x[3])?)])
    }),
    ("jkr.force", 1, |_, x| {
        Ok(vec![jkr::force(&sphere(x)?, contact_radius(x[3])?)])
    }),
    ("jkr.stiffness", 1, |_, x| {
        Ok(vec![jkr::stiffness(&sphere(x)?, contact_radius(x[3])?)])
    }),
    ("jkr.pressure", 1, |_, x| {
        Ok(vec![jkr::pressure(
            &sphere(x)?,
            contact_radius(x[3])?,
            x[4],
        )])
    }),
    ("jkr.gap", 1, |_, x| {
        Ok(vec![jkr::gap(&sphere(x)?, contact_radius(x[3])?, x[4])])
    }),
    ("jkr.pull_off_force", 1, |_, x| {
        Ok(vec![jkr::pull_off_force(&Sphere::new(x[0], 1.0, x[1])?)])
    }),
    ("jkr.from_measurement", 2, |_, x| {
        let sphere = jkr::from_measurement(x[0], x[1], x[2], x[3])?;
        Ok(vec![sphere.work_of_adhesion(), sphere.contact_modulus()])
    }),
    ("maugis_dugdale.at_force", 4, |_, x| {
        let (theory, scales) = maugis(x)?;
        let states = theory.states_at_force(x[4] / scales.force)?;
        stable(&states, &scales)
    }),
    ("maugis_dugdale.at_approach", 4, |_, x| {
        let (theory, scales) = maugis(x)?;
        let states = theory.states_at_approach(x[4] / scales.approach)?;
        stable(&states, &scales)
    }),
    ("maugis_dugdale.jump_in", 4, |_, x| {
        let (theory, scales) = maugis(x)?;
        stable(&[theory.jump_in()?], &scales)
    }),
    ("maugis_dugdale.pull_off", 4, |_, x| {
        let (theory, scales) = maugis(x)?;
        stable(&[theory.pull_off()?], &scales)
    }),
    ("maugis_dugdale.pressure", 1, |_, x| {
        let (theory, scales) = maugis(x)?;
        let state = theory.state(x[4] / scales.radius)?;
        let unit = scales.force / (scales.radius * scales.radius);
        Ok(vec![unit * theory.pressure(&state, x[5] / scales.radius)])
    }),
    // Numbers that tell which theory holds.
    ("tabor_parameter", 1, |_, x| {
        Ok(vec![tabor_map::tabor_parameter(&sphere(x)?, x[3])?])
    }),
    ("maugis_parameter", 1, |_, x| {
        Ok(vec![tabor_map::maugis_parameter(&sphere(x)?, x[3])?])
    }),
    ("regime", 1, |_, x| {
        Ok(vec![match tabor_map::regime(x[0])? {
            Regime::ForceDmt => 0.0,
            Regime::Jkr => 2.0,
            _ => 1.0,
        }])
    }),
    ("contact_modulus", 1, |_, x| {
        Ok(vec![tabor_map::contact_modulus(
            (x[0], x[1]),
            (x[2], x[3]),
        )?])
    }),
    ("work_of_adhesion", 1, |_, x| {
        Ok(vec![tabor_map::work_of_adhesion([x[0], x[1]], x[2])?])
    }),
    ("lennard_jones_sphere.at_approach", 4, |words, x| {
        lennard_jones::at_approach(&sphere(x)?, x[3], x[4], words.path)
    }),
    ("lennard_jones_sphere.pull_off", 4, |_, x| {
        lennard_jones::pull_off(&sphere(x)?, x[3])
    }),
    // Waves.
    ("westergaard.full_contact_pressure", 1, |_, x| {
        Ok(vec![westergaard::full_contact_pressure(x[0], x[1], x[2])?])
    }),
    ("westergaard.adhesion_parameter", 1, |_, x| {
        Ok(vec![westergaard::adhesion_parameter(
            x[0], x[1], x[2], x[3],
        )?])
    }),
    ("westergaard.half_width", 1, |_, x| {
        let whole = westergaard::full_contact_pressure(x[0], x[1], x[2])?;
        let found = told(westergaard::half_width(x[3] / whole), PARTIAL, x[3])?;
        Ok(vec![x[2] * found])
    }),
    ("westergaard.mean_pressure", 1, |_, x| {
        let whole = westergaard::full_contact_pressure(x[0], x[1], x[2])?;
        let found = told(westergaard::mean_pressure(x[3] / x[2]), WITHIN_WAVE, x[3])?;
        Ok(vec![whole * found])
    }),
    ("westergaard.adhesive_mean_pressure", 1, |_, x| {
        let whole = westergaard::full_contact_pressure(x[0], x[1], x[2])?;
        let adhesion = westergaard::adhesion_parameter(x[0], x[1], x[2], x[3])?;
        let found = westergaard::adhesive_mean_pressure(x[4] / x[2], adhesion);
        Ok(vec![whole * told(found, WITHIN_WAVE, x[4])?])
    }),
    ("westergaard.pull_off", 2, |_, x| {
        positive("work_of_adhesion", x[3])?;
        let whole = westergaard::full_contact_pressure(x[0], x[1], x[2])?;
        let adhesion = westergaard::adhesion_parameter(x[0], x[1], x[2], x[3])?;
        let extrema = westergaard::adhesive_extrema(adhesion)?;
        Ok(vec![
            whole * extrema.pull_off,
            whole * extrema.closing_pressure,
        ])
    }),
    ("westergaard.pressure", 1, |_, x| {
        let whole = westergaard::full_contact_pressure(x[0], x[1], x[2])?;
        let found = westergaard::pressure(x[3] / x[2], x[4] / x[2]);
        Ok(vec![whole * told(found, WITHIN_WAVE, x[3])?])
    }),
    ("westergaard.gap", 1, |_, x| {
        westergaard::full_contact_pressure(x[0], x[1], x[2])?;
        let found = westergaard::gap(x[3] / x[2], x[4] / x[2]);
        Ok(vec![x[1] * told(found, WITHIN_WAVE, x[3])?])
    }),
    ("westergaard.mean_gap", 1, |_, x| {
        let whole = westergaard::full_contact_pressure(x[0], x[1], x[2])?;
        let found = told(westergaard::mean_gap(x[3] / whole), PARTIAL, x[3])?;
        Ok(vec![x[1] * found])
    }),
    ("cohesive_wave.at_half_width", 3, |_, x| {
        let wave = Wave::new(x)?;
        if !(x[5] > 0.0 && x[5] < 0.5 * x[2]) {
            return Err(TheoryError::OutOfRange {
                name: "half_width",
                value: x[5],
                allowed: "between 0 and half the wavelength",
            });
        }
        Ok(wave.si(&wave.theory.state((PI * x[5] / x[2]).sin())?))
    }),
    ("cohesive_wave.pull_off", 3, |_, x| {
        let wave = Wave::new(x)?;
        Ok(wave.si(&wave.theory.pull_off()?))
    }),
    ("cohesive_wave.closing", 3, |_, x| {
        let wave = Wave::new(x)?;
        Ok(wave.si(&wave.theory.closing()?))
    }),
    // The elastic body.
    ("layer.bonded", 1, |_, x| {
        Ok(vec![layer::bonded(x[0], x[1])?])
    }),
    ("layer.sliding", 1, |_, x| Ok(vec![layer::sliding(x[0])?])),
    ("love.rectangle", 1, |_, x| {
        let sides = (x[4], x[5]);
        Ok(vec![strain(x)? * love::rectangle(x[2], x[3], sides)?])
    }),
    ("love.disc", 1, |_, x| {
        Ok(vec![strain(x)? * love::disc(x[2], x[3])?])
    }),
    // Rough surfaces by their summits.
    ("gw.adhesion_parameter", 1, |_, x| {
        Ok(vec![adhesive_summits(x)?.adhesion_parameter()?])
    }),
    ("gw.pressure", 1, |_, x| {
        Ok(vec![hard_summits(x)?.pressure(x[4])?])
    }),
    ("gw.contact_area_fraction", 1, |_, x| {
        Ok(vec![hard_summits(x)?.contact_area_fraction(x[4])])
    }),
    ("gw.contact_density", 1, |_, x| {
        Ok(vec![hard_summits(x)?.contact_density(x[4])])
    }),
    ("gw_m.pressure", 1, |_, x| {
        Ok(vec![gw_m::pressure(&adhesive_summits(x)?, x[5])?])
    }),
    ("gw_m.pull_off", 1, |_, x| {
        Ok(vec![gw_m::pull_off(&adhesive_summits(x)?)?])
    }),
    ("gw_m.separation", 1, |_, x| {
        Ok(vec![gw_m::separation(&adhesive_summits(x)?, x[5])?])
    }),
    ("fuller_tabor.pressure", 1, |words, x| {
        let summits = adhesive_summits(x)?;
        let theta = summits.adhesion_parameter()?;
        Ok(vec![
            tension(&summits) * fuller_tabor::reduced_pressure(theta, x[5], words.path)?,
        ])
    }),
    ("fuller_tabor.pull_off", 1, |_, x| {
        let summits = adhesive_summits(x)?;
        let (_, least) = fuller_tabor::reduced_pull_off(summits.adhesion_parameter()?)?;
        Ok(vec![1.5 * tension(&summits) * least])
    }),
    // Rough surfaces by their spectrum.
    ("spectrum.density", 1, |_, x| {
        Ok(vec![self_affine(x)?.density(x[5])])
    }),
    ("spectrum.statistics", 5, |_, x| {
        let spectrum = self_affine(x)?;
        Ok(vec![
            spectrum.rms_slope(),
            spectrum.rms_curvature(),
            spectrum.nayak_parameter(),
            spectrum.summit_density(),
            spectrum.typical_radius(),
        ])
    }),
    ("persson.contact_area_fraction", 1, |_, x| {
        with_persson(x[3], |theory| {
            let unit = positive("contact_modulus", x[1])? * positive("rms_slope", x[2])?;
            let found = theory.area_fraction(x[0] / unit);
            Ok(vec![told(found, COMPRESSIVE, x[0])?])
        })
    }),
    ("persson.mean_gap", 1, |_, x| {
        let spectrum = self_affine(x)?;
        with_persson(x[7], |theory| {
            let rough = RoughContact::new(theory.clone(), spectrum, x[5])?;
            Ok(vec![rough.mean_gap(x[6])?])
        })
    }),
    ("persson.attraction", 1, |words, x| {
        let (spectrum, adhesion) = (self_affine(x)?, attraction(words, x));
        with_persson(x[9], |theory| {
            let rough = RoughContact::new(theory.clone(), spectrum, x[5])?;
            Ok(vec![rough.attraction(&adhesion, x[8])?])
        })
    }),
    ("persson.repulsive_pressure", 1, |words, x| {
        let (spectrum, adhesion) = (self_affine(x)?, attraction(words, x));
        with_persson(x[9], |theory| {
            let rough = RoughContact::new(theory.clone(), spectrum, x[5])?;
            let turn = rough.turning_point(&adhesion)?;
            Ok(vec![rough.repulsive_pressure(&adhesion, &turn, x[8])?])
        })
    }),
    ("persson.pull_off", 2, |words, x| {
        let (spectrum, adhesion) = (self_affine(x)?, attraction(words, x));
        with_persson(x[8], |theory| {
            let found = RoughContact::new(theory.clone(), spectrum, x[5])?.pull_off(&adhesion)?;
            Ok(vec![found.tension, found.pressure])
        })
    }),
    ("bam.mean_pressure", 1, |_, x| {
        let (model, tension) = bearing_area(x)?;
        Ok(vec![tension * model.pressure(x[5] / x[0])])
    }),
    ("bam.mean_gap", 1, |_, x| {
        let (model, tension) = bearing_area(x)?;
        Ok(vec![x[0] * model.mean_gap(x[5] / tension)?])
    }),
    ("bam.attraction", 1, |_, x| {
        let (model, tension) = bearing_area(x)?;
        Ok(vec![tension * model.attraction(x[5] / x[0])])
    }),
    ("bam.pull_off", 2, |_, x| {
        let (model, tension) = bearing_area(x)?;
        let (gap, least) = model.pull_off()?;
        Ok(vec![tension * least, x[0] * gap])
    }),
    ("pastewka_robbins.stickiness_ratio", 1, |_, x| {
        let edge = Edge {
            rms_slope: x[0],
            rms_curvature: x[1],
            work_of_adhesion: x[2],
            contact_modulus: x[3],
            range: x[4],
            area_coefficient: x[5],
        };
        Ok(vec![stickiness_ratio(&edge)?])
    }),
];

/// A cohesive wave of (contact modulus, amplitude, wavelength, work of adhesion, range), and its units.
struct Wave {
    theory: CohesiveWave,
    pressure: f64,
    wavelength: f64,
}

impl Wave {
    fn new(x: &[f64]) -> Result<Self, TheoryError> {
        let adhesion = westergaard::adhesion_parameter(x[0], x[1], x[2], x[3])?;
        Ok(Wave {
            theory: CohesiveWave::new(adhesion, x[4] / x[1])?,
            pressure: westergaard::full_contact_pressure(x[0], x[1], x[2])?,
            wavelength: x[2],
        })
    }

    /// Mean pressure, half width of the contact, and that of the zone around it.
    fn si(&self, state: &WaveState) -> Vec<f64> {
        let width = |sine: f64| self.wavelength / PI * sine.asin();
        vec![
            self.pressure * state.mean_pressure,
            width(state.contact),
            width(state.zone),
        ]
    }
}

/// Pressure over modulus of (contact modulus, pressure).
fn strain(x: &[f64]) -> Result<f64, TheoryError> {
    Ok(x[1] / positive("contact_modulus", x[0])?)
}

/// An argument and what it may be, where a theory takes it in units of its own.
type Argument = (&'static str, &'static str);
/// The load of a wave in partial contact.
const PARTIAL: Argument = (
    "mean_pressure",
    "between 0 and the pressure of full contact",
);
/// The load of a hard contact.
const COMPRESSIVE: Argument = ("mean_pressure", "zero or more, and finite");
/// The contact of a wave.
const WITHIN_WAVE: Argument = ("half_width", "between 0 and half a wavelength");

/// The result of a theory that refuses a number in its own units by the argument that was given.
fn told<T>(
    result: Result<T, TheoryError>,
    (name, allowed): Argument,
    value: f64,
) -> Result<T, TheoryError> {
    result.map_err(|error| match error {
        TheoryError::OutOfRange { .. } => TheoryError::OutOfRange {
            name,
            value,
            allowed,
        },
        other => other,
    })
}

/// A contact radius; one below 0 is refused.
fn contact_radius(value: f64) -> Result<f64, TheoryError> {
    if value < 0.0 {
        return Err(TheoryError::OutOfRange {
            name: "contact_radius",
            value,
            allowed: "zero or more",
        });
    }
    Ok(value)
}

/// A sphere of (radius, contact modulus).
fn hard(x: &[f64]) -> Result<Sphere, TheoryError> {
    Sphere::new(x[0], x[1], 0.0)
}

/// A sphere of (radius, contact modulus, work of adhesion).
pub(super) fn sphere(x: &[f64]) -> Result<Sphere, TheoryError> {
    Sphere::new(x[0], x[1], x[2])
}

/// A cone of (half angle, contact modulus).
fn cone(x: &[f64]) -> Result<Cone, TheoryError> {
    Cone::new(FRAC_PI_2 - x[0], x[1])
}

/// Maugis' theory of (radius, contact modulus, work of adhesion, peak tension), and its units.
pub(super) fn maugis(x: &[f64]) -> Result<(MaugisDugdale, tabor_map::MaugisScales), TheoryError> {
    let sphere = sphere(x)?;
    let theory = MaugisDugdale::new(tabor_map::maugis_parameter(&sphere, x[3])?)?;
    Ok((theory, sphere.maugis_scales()?))
}

/// Force, approach, contact radius and cohesive radius of the last state, which is the stable one.
fn stable(states: &[State], scales: &tabor_map::MaugisScales) -> Result<Vec<f64>, TheoryError> {
    let state = states
        .last()
        .ok_or(TheoryError::NoSolution { what: "a contact" })?;
    Ok(vec![
        state.force * scales.force,
        state.approach * scales.approach,
        state.contact_radius * scales.radius,
        state.cohesive_radius * scales.radius,
    ])
}

/// Summits of (radius, contact modulus, density, rms height).
fn hard_summits(x: &[f64]) -> Result<Summits, TheoryError> {
    Summits::new(hard(x)?, x[2], x[3])
}

/// Summits of (radius, contact modulus, work of adhesion, density, rms height).
fn adhesive_summits(x: &[f64]) -> Result<Summits, TheoryError> {
    Summits::new(sphere(x)?, x[3], x[4])
}

/// `n pi w R` of summits, Pa.
fn tension(summits: &Summits) -> f64 {
    let summit = summits.summit();
    summits.density() * PI * summit.work_of_adhesion() * summit.radius()
}

/// The spectrum of (Hurst exponent, longest, roll-off and shortest wavelength, rms height).
fn self_affine(x: &[f64]) -> Result<Spectrum, TheoryError> {
    let wavenumbers = [x[1], x[2], x[3]].map(|wavelength| 2.0 * PI / wavelength);
    Spectrum::new(wavenumbers, x[0], x[4])
}

/// The attraction of (..., work of adhesion, range) behind spectrum and modulus.
fn attraction(words: &Words, x: &[f64]) -> Adhesion {
    Adhesion {
        law: words.law,
        work_of_adhesion: x[6],
        range: x[7],
    }
}

/// The bearing-area model of (rms height, roll-off wavelength, contact modulus, work of adhesion, range), and its
/// tension, Pa.
fn bearing_area(x: &[f64]) -> Result<(BearingArea, f64), TheoryError> {
    let names = [
        "rms_height",
        "rolloff",
        "contact_modulus",
        "work_of_adhesion",
        "range",
    ];
    for (name, value) in names.into_iter().zip(x) {
        positive(name, *value)?;
    }
    let tension = x[3] / x[4];
    let model = BearingArea::new(x[0] / x[4], 2.0 * PI / x[1] * x[0] * x[2] / tension)?;
    Ok((model, tension))
}

/// Persson's theory with a `gamma`; its tables are made once for equal ones in turn.
fn with_persson<R>(
    gamma: f64,
    use_it: impl FnOnce(&Persson) -> Result<R, TheoryError>,
) -> Result<R, TheoryError> {
    thread_local! {
        static LAST: RefCell<Option<Persson>> = const { RefCell::new(None) };
    }
    LAST.with_borrow_mut(|last| {
        let kept = last
            .take()
            .filter(|theory| theory.gamma().to_bits() == gamma.to_bits());
        let theory = match kept {
            Some(theory) => theory,
            None => Persson::new(gamma)?,
        };
        use_it(last.insert(theory))
    })
}
