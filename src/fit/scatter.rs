//! How the residuals of a fit scatter: their variance, and the correlation of neighbours.

use nalgebra::DVector;

use super::segments::Segment;

/// Fewest points in contact whose residuals are looked at alone.
const LEAST_IN_CONTACT: usize = 10;
/// Standard deviations of a variance of normal residuals by which that of the points in contact exceeds that of all before it counts.
const LARGER_VARIANCE: f64 = 3.0;

/// Residuals of the points in contact: those whose force depends on the modulus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct InContact {
    /// How many there are.
    pub(super) points: usize,
    /// Correlation of neighbours.
    pub(super) autocorrelation: f64,
    /// Mean square.
    pub(super) mean_square: f64,
}

/// How the residuals of a fit scatter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scatter {
    /// Correlation of neighbours, of all points.
    pub(super) autocorrelation: f64,
    /// Of the points in contact; `None` with fewer than [`LEAST_IN_CONTACT`].
    pub(super) in_contact: Option<InContact>,
    /// Variance, corrected for the correlation.
    pub(super) variance: f64,
}

impl Scatter {
    /// Of residuals with so many `free` numbers.
    ///
    /// The modulus has the errors of the points in contact alone; free points, however many there are, tell nothing of these.
    /// So the variance is the larger of those of all points and of the points in contact.
    pub(super) fn new(
        residuals: &DVector<f64>,
        free: usize,
        segments: &[Segment],
        in_contact: &[bool],
    ) -> Self {
        let all = vec![true; residuals.len()];
        let whole = InContact::new(residuals, segments, &all);
        let alone = InContact::new(residuals, segments, in_contact);
        let alone = (alone.points >= LEAST_IN_CONTACT).then_some(alone);
        let mut variance = whole.plain_variance(free) * whole.repeated();
        if let Some(alone) = alone {
            // Chance makes one of two equal variances the larger, which is no reason to take it.
            let chance = LARGER_VARIANCE * (2.0 / alone.points as f64).sqrt();
            let own = alone.plain_variance(free);
            let plain = if own > (1.0 + chance) * whole.plain_variance(free) {
                own
            } else {
                whole.plain_variance(free)
            };
            variance = variance.max(plain * alone.repeated());
        }
        Scatter {
            autocorrelation: whole.autocorrelation,
            in_contact: alone,
            variance,
        }
    }
}

impl InContact {
    /// Correlation of each residual with the next one of the same segment, and the mean square, of the chosen points.
    fn new(residuals: &DVector<f64>, segments: &[Segment], chosen: &[bool]) -> Self {
        let is_chosen = |i: usize| chosen.get(i) == Some(&true);
        let at = || (0..residuals.len()).filter(|i| is_chosen(*i));
        let square: f64 = at().map(|i| residuals[i].powi(2)).sum();
        let products: f64 = segments
            .iter()
            .flat_map(|segment| segment.points.clone().skip(1))
            .filter(|i| is_chosen(*i) && is_chosen(i - 1))
            .map(|i| residuals[i] * residuals[i - 1])
            .sum();
        let points = at().count();
        InContact {
            points,
            autocorrelation: if square > 0.0 {
                (products / square).clamp(-0.99, 0.99)
            } else {
                0.0
            },
            mean_square: square / points.max(1) as f64,
        }
    }

    /// Variance without a correction.
    fn plain_variance(&self, free: usize) -> f64 {
        let degrees = self.points.saturating_sub(free).max(1);
        self.mean_square * self.points as f64 / degrees as f64
    }

    /// Correlated residuals count for fewer: n (1 - r)/(1 + r) of them are independent.
    fn repeated(&self) -> f64 {
        let (points, r) = (self.points as f64, self.autocorrelation);
        if r > 2.0 / points.sqrt() {
            ((1.0 + r) / (1.0 - r)).min(0.1 * points).max(1.0)
        } else {
            1.0
        }
    }
}
