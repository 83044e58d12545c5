//! Deformable sphere with a Lennard-Jones 9-3 law: the self-consistent solution of Muller,
//! Yushchenko & Derjaguin 1980, Greenwood 1997 and Feng 2001, without a hard wall.
//!
//! Lennard-Jones units (see [`super::tabor_map`]): gaps and approach in the range, radii in `sqrt(R
//! range)`, pressure in w/range, force in `2 pi w R`. The gap is measured from zero traction, so it
//! is negative under pressure; at approach 0 the undeformed apex is at gap 0. The only parameter is
//! Tabor's.

use super::block_solve;
use super::error::{TheoryError, between, finite};
use super::laws::Law;
use super::ring::Rings;
use super::roots::root;
use nalgebra::{DMatrix, DVector};

const LAW: Law = Law::LennardJones;
const MAX_NEWTON: usize = 25;

/// The discretised sphere. Building it costs about as much as solving for a state.
#[derive(Clone, Debug)]
pub struct LennardJonesSphere {
    tabor_parameter: f64,
    rings: Rings,
    /// Gap in ranges over pressure in w/range.
    compliance: DMatrix<f64>,
    /// Gap of the undeformed shape, `x^2/2`.
    shape: DVector<f64>,
}

/// An equilibrium.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct State {
    /// Approach of the undeformed apex.
    pub approach: f64,
    /// Force, positive in compression.
    pub force: f64,
    /// Gap at [`LennardJonesSphere::radii`].
    pub gap: DVector<f64>,
}

/// The prescribed quantity: `approach_share * approach + force_share * force`.
#[derive(Clone, Copy)]
pub(crate) struct Constraint {
    pub(crate) approach_share: f64,
    pub(crate) force_share: f64,
    pub(crate) sum: f64,
}

/// A solved equilibrium with its derivatives along the curve.
pub(crate) struct Solved {
    pub(crate) state: State,
    /// Derivative of the gaps with the approach.
    pub(crate) gap_rate: DVector<f64>,
    /// Derivative of the force with the approach.
    pub(crate) force_rate: f64,
    /// Newton iterations.
    pub(crate) rounds: usize,
}

impl Solved {
    /// Unit tangent of the curve in (approach/unit, force), on the side of `forward`.
    pub(crate) fn tangent(&self, unit: f64, forward: (f64, f64)) -> (f64, f64) {
        let length = unit.recip().hypot(self.force_rate);
        let tangent = (1.0 / (unit * length), self.force_rate / length);
        if tangent.0 * forward.0 + tangent.1 * forward.1 < 0.0 {
            (-tangent.0, -tangent.1)
        } else {
            tangent
        }
    }
}

impl LennardJonesSphere {
    /// A sphere of a Tabor parameter between 0.01 and 5, for states up to the approach `deepest` (0
    /// to 20 ranges).
    ///
    /// The contact edge sharpens with the Tabor parameter: a curve takes a fraction of a second at
    /// 1, about ten seconds at 3, minutes at 5.
    pub fn new(tabor_parameter: f64, deepest: f64) -> Result<Self, TheoryError> {
        let mu = between!(tabor_parameter in 0.01..=5.0, "between 0.01 and 5")?;
        between!(deepest in 0.0..=20.0, "between 0 and 20")?;
        // The contact edge is as wide as the cohesive length, 0.75 mu^(-3/2), or as the law.
        let width = (0.45 * mu.powf(-1.5)).min(0.35);
        // No contact is wider than that of JKR at the deepest approach; the attraction extends
        // further.
        let widest = (deepest + 3.5 * mu).sqrt() + (1.8 / mu.sqrt()).min(1.5);
        Ok(Self::with_panels(mu, width, widest))
    }

    /// On panels of this width, up to `fine` contact radii.
    #[doc(hidden)]
    pub fn with_panels(tabor_parameter: f64, width: f64, fine: f64) -> Self {
        // The attraction beyond x adds (16/3)/x^4 to the force: 2e-11 at 700.
        let rings = Rings::new(width, fine, 700.0);
        // E* is 1 in the rings; w/range over E* range/sqrt(R range) is mu^(3/2).
        let compliance = rings.compliance() * tabor_parameter.powf(1.5);
        let shape =
            DVector::from_iterator(rings.radii.len(), rings.radii.iter().map(|x| 0.5 * x * x));
        LennardJonesSphere {
            tabor_parameter,
            rings,
            compliance,
            shape,
        }
    }

    /// The Tabor parameter.
    pub fn tabor_parameter(&self) -> f64 {
        self.tabor_parameter
    }

    /// Radii at which a state's gaps are given.
    pub fn radii(&self) -> &[f64] {
        &self.rings.radii
    }

    /// Gap of a state at radius `x`.
    pub fn gap(&self, state: &State, x: f64) -> f64 {
        self.rings.interpolate(state.gap.as_slice(), x.abs())
    }

    /// Net pressure of a state at radius `x`; negative attracts.
    pub fn pressure(&self, state: &State, x: f64) -> f64 {
        -LAW.traction(self.gap(state, x))
    }

    /// Radius at which the gap is `gap`, which must exceed the gap on the axis. For 0 this is the
    /// radius of zero traction, for [`Law::peak_gap`] that of the greatest tension.
    pub fn radius_of_gap(&self, state: &State, gap: f64) -> Result<f64, TheoryError> {
        let excess = |x: f64| self.gap(state, x) - gap;
        root("a radius of this gap", excess, 0.0, 500.0, 1e-13)
    }

    /// Ranges of approach that count as much as a force of 1 in the arc length.
    pub(crate) fn force_unit(&self) -> f64 {
        1.0 + self.tabor_parameter
    }

    /// An approach before the jump-in of any sphere of this range of Tabor parameters.
    pub(crate) fn far(&self) -> f64 {
        -(4.0 + 2.0 * self.tabor_parameter)
    }

    pub(crate) fn rigid_start(&self, approach: f64) -> Result<Solved, TheoryError> {
        let gap = self.shape.add_scalar(-approach);
        let force = self.force(&gap);
        let state = State {
            approach,
            force,
            gap,
        };
        self.at_approach_near(state, approach)
    }

    fn at_approach_near(&self, guess: State, approach: f64) -> Result<Solved, TheoryError> {
        let held = Constraint {
            approach_share: 1.0,
            force_share: 0.0,
            sum: approach,
        };
        self.solve(guess, held)
    }

    /// The state at `approach` that loading reaches first.
    pub fn at_approach(&self, approach: f64) -> Result<State, TheoryError> {
        finite("approach", approach)?;
        if approach <= self.far() {
            return self.rigid_start(approach).map(|solved| solved.state);
        }
        let states =
            self.curve(|states| states.last().is_some_and(|last| last.approach >= approach))?;
        let crosses = |pair: &&[State]| pair[0].approach < approach && approach <= pair[1].approach;
        let first = states.windows(2).find(crosses);
        self.between(first.unwrap_or(&states[..1]), approach)
    }

    /// The state at `approach` between two neighbours on the curve.
    pub fn between(&self, neighbours: &[State], approach: f64) -> Result<State, TheoryError> {
        let [before, after] = neighbours else {
            return Err(TheoryError::NoSolution {
                what: "a state between neighbours",
            });
        };
        let share = (approach - before.approach) / (after.approach - before.approach);
        let guess = State {
            approach,
            force: before.force + share * (after.force - before.force),
            gap: &before.gap + (&after.gap - &before.gap) * share,
        };
        self.at_approach_near(guess, approach)
            .map(|solved| solved.state)
    }

    fn force(&self, gap: &DVector<f64>) -> f64 {
        self.rings
            .radii
            .iter()
            .zip(&self.rings.weights)
            .zip(gap.iter())
            .map(|((x, weight), u)| -weight * x * LAW.traction(*u))
            .sum()
    }

    /// Newton's method for the gaps and the approach.
    pub(crate) fn solve(&self, guess: State, held: Constraint) -> Result<Solved, TheoryError> {
        let State {
            mut approach,
            mut gap,
            ..
        } = guess;
        let points = gap.len();
        let failed = TheoryError::NotConverged {
            what: "the gap of a Lennard-Jones sphere",
        };
        for round in 1..=MAX_NEWTON {
            let pressure = gap.map(|u| -LAW.traction(u));
            let residual = &gap - &self.shape - &self.compliance * pressure;
            let mut sides = DMatrix::zeros(points, 2);
            sides.set_column(0, &(-residual.add_scalar(approach)));
            sides.column_mut(1).fill(-1.0);
            let mut jacobian = self.compliance.clone();
            for (mut column, u) in jacobian.column_iter_mut().zip(gap.iter()) {
                column *= LAW.slope(*u);
            }
            for i in 0..points {
                jacobian[(i, i)] += 1.0;
            }
            let steps = block_solve::solve(jacobian, sides).ok_or(failed.clone())?;
            // Change of the force with the two parts of the step.
            let changes = [0, 1].map(|column| -> f64 {
                (0..points)
                    .map(|i| {
                        let weight = self.rings.weights[i] * self.rings.radii[i];
                        -weight * LAW.slope(gap[i]) * steps[(i, column)]
                    })
                    .sum()
            });
            let force = self.force(&gap);
            let miss =
                held.sum - held.approach_share * approach - held.force_share * (force + changes[0]);
            let approach_step = miss / (held.approach_share + held.force_share * changes[1]);
            let step = steps.column(0) + steps.column(1) * approach_step;
            // The law has a pole at gap -1: move at most half way towards it.
            let mut share = 1.0_f64;
            for (u, change) in gap.iter().zip(step.iter()) {
                if *change < 0.0 {
                    share = share.min(0.5 * (1.0 + u) / -change);
                }
            }
            gap += &step * share;
            approach += share * approach_step;
            let relative = gap.zip_map(&step, |u, change| change / (2.0 + u));
            let size = relative.amax().max(approach_step.abs());
            if !size.is_finite() {
                return Err(failed);
            }
            // The error is now of the order of the square.
            if share == 1.0 && size < 1e-6 {
                let force = self.force(&gap);
                return Ok(Solved {
                    state: State {
                        approach,
                        force,
                        gap,
                    },
                    gap_rate: steps.column(1).into_owned(),
                    force_rate: changes[1],
                    rounds: round,
                });
            }
        }
        Err(failed)
    }
}
