//! States of a model at several lambdas, and what they tell of the uncertainties.

use super::deviations::Uncertainties;
use super::estimate::ModelFit;
use super::model::Parameters;

/// Rise of the sum of squares, in variances of the noise, up to which a state contributes to the
/// uncertainty: three standard deviations.
pub(super) const MOST_RISE: f64 = 9.0;
/// Standard deviation of ln lambda from which a parabola around the minimum is meaningless, and the
/// profile over lambda is used.
const FLAT_PROFILE: f64 = 0.5;

/// The best numbers at one lambda, with standard deviations at that lambda.
#[derive(Clone, Copy, Debug)]
pub(super) struct ProfilePoint {
    pub parameters: Parameters,
    pub uncertainties: Uncertainties,
    /// Sum of squares of the residuals, N^2.
    pub sum_of_squares: f64,
}

impl ProfilePoint {
    /// Standard deviation of a number at `value` implied by this state: a state whose sum of
    /// squares is larger by `rise` variances implies a distance of `sqrt(rise)` deviations, as for
    /// a parabola. `None` if the state is ruled out.
    pub(super) fn deviation(
        &self,
        value: f64,
        number: impl Fn(&Parameters, &Uncertainties) -> (f64, Option<f64>),
        rise: f64,
    ) -> Option<f64> {
        let (other, own) = number(&self.parameters, &self.uncertainties);
        (rise <= MOST_RISE)
            .then(|| ((other - value) / rise.max(1.0).sqrt()).hypot(own.unwrap_or(0.0)))
    }
}

/// Takes the uncertainties from the profile over lambda if lambda is so uncertain that a parabola
/// around the minimum is meaningless.
pub(super) fn widen(fit: &mut ModelFit) {
    let parameters = fit.parameters;
    let known = fit.uncertainties.maugis_parameter;
    let parabola = known.is_some_and(|known| known < FLAT_PROFILE * parameters.maugis_parameter);
    type Pick = fn(&mut Uncertainties) -> &mut Option<f64>;
    type Value = fn(&Parameters) -> f64;
    let numbers: [(Pick, Value); 4] = [
        (|u| &mut u.work_of_adhesion, |p| p.work_of_adhesion),
        (|u| &mut u.contact_modulus, |p| p.contact_modulus),
        (|u| &mut u.maugis_parameter, |p| p.maugis_parameter),
        (|u| &mut u.approach_offset, |p| p.approach_offset),
    ];
    for (pick, value) in numbers {
        let spread = fit.profile.iter().filter_map(|point| {
            let rise = (point.sum_of_squares - fit.sum_of_squares) / fit.variance;
            let own = |p: &Parameters, u: &Uncertainties| (value(p), *pick(&mut u.clone()));
            point.deviation(value(&parameters), own, rise)
        });
        let Some(spread) = spread.reduce(f64::max) else {
            continue;
        };
        let deviation = pick(&mut fit.uncertainties);
        // A number that does not affect the curve (a fixed offset, a lambda at its limit) is left
        // as it is.
        *deviation = deviation.map(|known| if parabola { known.max(spread) } else { spread });
    }
}
