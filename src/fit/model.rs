//! The models of an indenter that are fitted to a curve.

use std::cell::RefCell;
use std::f64::consts::PI;
use std::rc::Rc;

use super::indenter::{Indenter, adhesive_cone};
use super::maugis_curve::MaugisCurve;
use crate::theory::{TheoryError, jkr};

/// Least and greatest Maugis parameter: beyond, force curves agree with DMT and JKR to a
/// thousandth.
pub const LAMBDAS: (f64, f64) = (0.01, 20.0);

/// A model of a rigid indenter on a half-space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Model {
    /// No adhesion: [`crate::theory::hertz`]; of a cone Sneddon's, [`crate::theory::cone_punch`].
    Hertz,
    /// Hertz less `2 pi w R` in contact, no force out of contact: stiff and small. Maugis 1992.
    Dmt,
    /// Attraction without range: soft and large. [`crate::theory::jkr`]; of a cone that of Maugis & Barquins.
    Jkr,
    /// Attraction of any range. [`crate::theory::maugis_dugdale`].
    MaugisDugdale,
}

impl Model {
    /// All models, by the number of parameters.
    pub const ALL: [Model; 4] = [Model::Hertz, Model::Dmt, Model::Jkr, Model::MaugisDugdale];

    /// Its name in `fit.json`.
    pub fn name(self) -> &'static str {
        match self {
            Model::Hertz => "hertz",
            Model::Dmt => "dmt",
            Model::Jkr => "jkr",
            Model::MaugisDugdale => "maugis-dugdale",
        }
    }

    /// Its name in text.
    pub fn title(self) -> &'static str {
        match self {
            Model::Hertz => "Hertz",
            Model::Dmt => "DMT",
            Model::Jkr => "JKR",
            Model::MaugisDugdale => "Maugis-Dugdale",
        }
    }

    /// Whether it has adhesion.
    pub fn adheres(self) -> bool {
        self != Model::Hertz
    }
}

/// Parameters of a model, SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Parameters {
    /// E*, Pa.
    pub contact_modulus: f64,
    /// w, J/m^2; 0 for Hertz.
    pub work_of_adhesion: f64,
    /// Maugis' lambda; used by Maugis-Dugdale only.
    pub maugis_parameter: f64,
    /// Approach at which the undeformed surfaces first touch, m.
    pub approach_offset: f64,
    /// Baseline force at approach 0, N.
    pub force_offset: f64,
    /// Slope of the baseline force over approach, N/m; 0 where it is level.
    pub baseline_slope: f64,
}

impl Parameters {
    /// Force where nothing acts, at an approach (m, as measured), N.
    pub fn baseline(&self, approach: f64) -> f64 {
        self.force_offset + self.baseline_slope * approach
    }

    /// Tension of the cohesive zone of a Maugis-Dugdale sphere, Pa.
    pub(super) fn peak_tension(&self, radius: f64) -> f64 {
        let modulus = 4.0 * self.contact_modulus / 3.0;
        let cube = PI * self.work_of_adhesion * modulus * modulus / radius;
        0.5 * self.maugis_parameter * cube.cbrt()
    }
}

/// Force by approach of a model, in the units of the indenter.
#[derive(Clone, Debug)]
pub(super) enum ReducedForce {
    /// The power of the approach.
    Hertz,
    Dmt,
    /// JKR of a sphere.
    Jkr,
    /// JKR of a cone or a pyramid.
    Cone,
    MaugisDugdale(Rc<MaugisCurve>),
}

impl ReducedForce {
    /// Force at an approach.
    #[inline]
    pub(super) fn at(&self, approach: f64) -> Result<f64, TheoryError> {
        Ok(match self {
            ReducedForce::Hertz => approach.max(0.0).powf(1.5),
            ReducedForce::Dmt => approach.max(0.0).powf(1.5) - 2.0,
            ReducedForce::Cone => adhesive_cone::force(approach),
            ReducedForce::Jkr => {
                let least = jkr::reduced_approach(jkr::grip());
                let radius = jkr::reduced_radius_at_approach(approach.max(least))?;
                jkr::reduced_force(radius)
            }
            ReducedForce::MaugisDugdale(table) => table.force(approach),
        })
    }

    /// Force and its derivative at an approach.
    fn with_stiffness(&self, approach: f64) -> Result<(f64, f64), TheoryError> {
        let hertz = 1.5 * approach.max(0.0).sqrt();
        Ok(match self {
            ReducedForce::Hertz | ReducedForce::Dmt => (self.at(approach)?, hertz),
            ReducedForce::Jkr => {
                let least = jkr::reduced_approach(jkr::grip());
                let radius = jkr::reduced_radius_at_approach(approach.max(least))?;
                let stiffness = if approach > least {
                    jkr::reduced_stiffness(radius)
                } else {
                    0.0
                };
                (jkr::reduced_force(radius), stiffness)
            }
            ReducedForce::Cone | ReducedForce::MaugisDugdale(_) => {
                let force = self.at(approach)?;
                let step = DIFFERENCE * (1.0 + approach.abs());
                (force, (self.at(approach + step)? - force) / step)
            }
        })
    }
}

/// A model of an indenter, with its most recent tables.
#[derive(Clone, Debug)]
pub struct IndenterModel {
    /// The model.
    pub model: Model,
    /// The tip.
    pub indenter: Indenter,
    tables: RefCell<Vec<(f64, f64, Rc<MaugisCurve>)>>,
}

/// Relative step of the derivative of a force by the approach.
const DIFFERENCE: f64 = 1e-7;
/// Number of stored tables: the state, and two near it for a derivative.
const TABLES: usize = 4;

impl IndenterModel {
    /// A model of a sphere of a radius (m), or of another tip.
    pub fn new(model: Model, indenter: impl Into<Indenter>) -> Self {
        IndenterModel {
            model,
            indenter: indenter.into(),
            tables: RefCell::new(Vec::new()),
        }
    }

    /// Force of a tip that interacts with the flat, at each of `approaches` (m, as measured), N.
    ///
    /// Beyond the fold where a prescribed approach jumps off, the force at the fold is returned:
    /// the model has no state there, and the tip is free.
    pub fn forces(
        &self,
        parameters: &Parameters,
        approaches: &[f64],
    ) -> Result<Vec<f64>, TheoryError> {
        let baseline = |approach: f64| parameters.baseline(approach);
        let approach_offset = parameters.approach_offset;
        if self.model == Model::Hertz {
            let (stiffness, power) = self.hertz(parameters);
            let force =
                |approach: f64| stiffness * (approach - approach_offset).max(0.0).powf(power);
            let forces = approaches.iter().map(|at| baseline(*at) + force(*at));
            return Ok(forces.collect());
        }
        let (reduced, force_unit, approach_unit) = self.scaled(parameters, approaches)?;
        let force = |approach: f64| {
            let reduced = reduced.at((approach - approach_offset) / approach_unit)?;
            Ok(force_unit * reduced)
        };
        let forces = approaches.iter().map(|at| Ok(baseline(*at) + force(*at)?));
        forces.collect()
    }

    /// Force of the contact alone, N, and its stiffness, N/m, at an approach (m, as measured) as far as the deepest of `approaches`.
    pub(super) fn contact(
        &self,
        parameters: &Parameters,
        approaches: &[f64],
    ) -> Result<impl Fn(f64) -> Result<(f64, f64), TheoryError> + use<>, TheoryError> {
        let approach_offset = parameters.approach_offset;
        let bare = (self.model == Model::Hertz).then(|| self.hertz(parameters));
        let (reduced, force_unit, approach_unit) = if bare.is_some() {
            (ReducedForce::Hertz, 1.0, 1.0)
        } else {
            self.scaled(parameters, approaches)?
        };
        Ok(move |approach: f64| {
            let from_touch = approach - approach_offset;
            if let Some((stiffness, power)) = bare {
                let depth = from_touch.max(0.0);
                let rising = stiffness * depth.powf(power - 1.0);
                return Ok((rising * depth, power * rising));
            }
            let (force, stiffness) = reduced.with_stiffness(from_touch / approach_unit)?;
            Ok((force_unit * force, force_unit / approach_unit * stiffness))
        })
    }

    /// Force without adhesion over the power of the depth, and that power.
    fn hertz(&self, parameters: &Parameters) -> (f64, f64) {
        let stiffness = parameters.contact_modulus * self.indenter.stiffness();
        (stiffness, self.indenter.power())
    }

    /// Force by approach of an adhesive model in the units of the indenter, and those of force, N, and approach, m.
    fn scaled(
        &self,
        parameters: &Parameters,
        approaches: &[f64],
    ) -> Result<(ReducedForce, f64, f64), TheoryError> {
        let (force_unit, approach_unit) = self
            .indenter
            .units(parameters.contact_modulus, parameters.work_of_adhesion);
        let deepest = approaches.iter().fold(0.0_f64, |most, approach| {
            most.max((approach - parameters.approach_offset) / approach_unit)
        });
        let reduced = self.reduced(parameters.maugis_parameter, deepest)?;
        Ok((reduced, force_unit, approach_unit))
    }

    /// Force by approach in the units of the indenter, up to an approach. Without adhesion a cone is not reduced.
    pub(super) fn reduced(&self, lambda: f64, deepest: f64) -> Result<ReducedForce, TheoryError> {
        Ok(match self.model {
            Model::Hertz => ReducedForce::Hertz,
            Model::Dmt => ReducedForce::Dmt,
            Model::Jkr if self.is_sharp() => ReducedForce::Cone,
            Model::Jkr => ReducedForce::Jkr,
            Model::MaugisDugdale => ReducedForce::MaugisDugdale(self.table(lambda, deepest)?),
        })
    }

    /// Whether the tip is a cone or a pyramid.
    fn is_sharp(&self) -> bool {
        self.indenter.radius().is_none()
    }

    /// Approach and force of the greatest tension, in the units of the indenter.
    pub(super) fn pull_off(&self, lambda: f64) -> Result<(f64, f64), TheoryError> {
        Ok(match self.model {
            Model::Hertz | Model::Dmt => (0.0, -2.0),
            Model::Jkr if self.is_sharp() => adhesive_cone::PULL_OFF,
            Model::Jkr => (jkr::reduced_approach(jkr::pull_off()), jkr::PULL_OFF_FORCE),
            Model::MaugisDugdale => self.table(lambda, 0.0)?.pull_off,
        })
    }

    /// Approach of the fold where a prescribed approach jumps off, in the units of the indenter; `None` without one.
    pub(super) fn fold(&self, lambda: f64) -> Option<f64> {
        match self.model {
            Model::Hertz | Model::Dmt => None,
            Model::Jkr if self.is_sharp() => Some(adhesive_cone::GRIP),
            Model::Jkr => Some(jkr::reduced_approach(jkr::grip())),
            Model::MaugisDugdale => Some(self.table(lambda, 0.0).ok()?.fold()),
        }
    }

    /// Approach in contact at a force, beyond pull-off, in the units of the indenter.
    pub(super) fn approach_at(&self, lambda: f64, force: f64) -> Result<f64, TheoryError> {
        let (low, _) = self.pull_off(lambda)?;
        // The attraction is less than 2.2 in these units, for every model.
        let high = if self.is_sharp() {
            adhesive_cone::approach_beyond(force)
        } else {
            4.0 + (force.max(0.0) + 2.2).powf(2.0 / 3.0)
        };
        let reduced = self.reduced(lambda, high)?;
        let excess = |approach: f64| reduced.at(approach).map_or(f64::NAN, |at| at - force);
        crate::theory::roots::root("a contact at this force", excess, low, high, 1e-9)
    }

    fn table(&self, lambda: f64, deepest: f64) -> Result<Rc<MaugisCurve>, TheoryError> {
        let lambda = lambda.clamp(LAMBDAS.0, LAMBDAS.1);
        let mut tables = self.tables.borrow_mut();
        let known = tables
            .iter()
            .find(|(of, to, _)| *of == lambda && *to >= deepest && *to <= 16.0 * (deepest + 1.0));
        if let Some((_, _, table)) = known {
            return Ok(Rc::clone(table));
        }
        // With a margin, so that the table serves the next steps of a fit.
        let to = 2.0 * (deepest + 1.0);
        let table = Rc::new(MaugisCurve::new(lambda, to)?);
        tables.truncate(TABLES - 1);
        tables.insert(0, (lambda, to, Rc::clone(&table)));
        Ok(table)
    }
}
