//! The governing equation, point by point: one definition for the solver, the evaluation and the kernels.
//!
//! The unknown is the gap g over the rigid heights h. With p = K*(g + h) the elastic pressure of the
//! half-space (a convolution), pbar the mean pressure and sigma(g) the attraction of the law, every
//! point of an equilibrium has
//!
//! ```text
//! y            = (p + pbar) + sigma
//! g >= 0,  y >= 0,  g y = 0                  with a wall; y is its reaction
//! y = 0                                      for Lennard-Jones, which repels by itself
//! net pressure = max(y, 0) - sigma           closed (g = 0, with a wall)
//!              = -sigma                      open, and everywhere for Lennard-Jones
//! ```
//!
//! A hardness bounds the net pressure from above; where the solid is indented it is the hardness.

use crate::real::Real;

/// What holds a point at its gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Support {
    /// The law alone: the gap is open, or the law repels by itself.
    Law,
    /// The law and a wall, which only pushes: the gap is closed.
    Wall,
    /// A wall whose attraction is no part of the problem that was solved.
    WallAlone,
    /// A solid that is indented at its hardness, which holds any pressure beyond.
    Indented,
}

/// y, from the elastic pressure with the mean pressure, and the attraction.
#[inline(always)]
pub fn imbalance<T: Real>(elastic: T, traction: T) -> T {
    elastic + traction
}

/// Net pressure of a solved point, positive in compression, from the elastic pressure with the mean
/// pressure, the attraction at its gap, and the hardness of a solid that has one.
#[inline]
pub fn net_pressure(support: Support, elastic: f64, traction: f64, hardness: Option<f64>) -> f64 {
    let net = match support {
        // 0 - x, for the negative of zero prints as -0.
        Support::Law => 0.0 - traction,
        Support::Wall => imbalance(elastic, traction).max(0.0) - traction,
        Support::WallAlone => elastic.max(0.0),
        Support::Indented => f64::INFINITY,
    };
    hardness.map_or(net, |hardness| net.min(hardness))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn net_pressure_of_each_support() {
        let net = |support| net_pressure(support, 0.75, 0.25, None);
        assert_eq!(net(Support::Law), -0.25);
        assert_eq!(net(Support::Wall), 0.75);
        assert_eq!(net(Support::WallAlone), 0.75);
        // A wall does not pull: what is left is the attraction.
        assert_eq!(net_pressure(Support::Wall, -0.5, 0.25, None), -0.25);
        assert_eq!(net_pressure(Support::WallAlone, -0.5, 0.25, None), 0.0);
        // The hardness bounds it, and is it where the solid is indented.
        assert_eq!(net_pressure(Support::Wall, 2.0, 0.25, Some(1.5)), 1.5);
        assert_eq!(net_pressure(Support::Indented, 0.5, 0.25, Some(1.5)), 1.5);
    }
}
