//! Height parameters of ISO 25178-2, the distribution of heights, and slope and curvature at each distance.

use crate::grid::Grid;
use crate::scene::Boundary;

/// Height parameters of ISO 25178-2 about the mean; Sq is the rms height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightParameters {
    /// Sa, mean distance from the mean, m.
    pub mean_deviation: f64,
    /// Sq, root mean square, m.
    pub rms_height: f64,
    /// Sz, from the lowest to the highest point, m.
    pub range: f64,
    /// Ssk, skewness; `None` of a flat map.
    pub skewness: Option<f64>,
    /// Sku, kurtosis, 3 for a normal distribution; `None` of a flat map.
    pub kurtosis: Option<f64>,
}

impl HeightParameters {
    /// Of heights, of which there is at least one.
    pub fn new(heights: &[f64]) -> Self {
        let count = heights.len() as f64;
        let mean = heights.iter().sum::<f64>() / count;
        let moment = |power: i32| {
            let sum: f64 = heights
                .iter()
                .map(|height| (height - mean).powi(power))
                .sum();
            sum / count
        };
        let (lowest, highest) = ends(heights);
        let rms_height = moment(2).sqrt();
        // Rounding of a constant map is not roughness.
        let is_rough = rms_height > 1e-12 * highest.abs().max(lowest.abs());
        HeightParameters {
            mean_deviation: heights
                .iter()
                .map(|height| (height - mean).abs())
                .sum::<f64>()
                / count,
            rms_height,
            range: highest - lowest,
            skewness: is_rough.then(|| moment(3) / rms_height.powi(3)),
            kurtosis: is_rough.then(|| moment(4) / rms_height.powi(4)),
        }
    }
}

fn ends(heights: &[f64]) -> (f64, f64) {
    let each = heights.iter().copied();
    (
        each.clone().fold(f64::INFINITY, f64::min),
        each.fold(f64::NEG_INFINITY, f64::max),
    )
}

/// Middle (m) and density (1/m) of equal classes of height; none of a flat map.
pub fn distribution(heights: &[f64], classes: usize) -> Vec<[f64; 2]> {
    let (lowest, highest) = ends(heights);
    let width = (highest - lowest) / classes as f64;
    if width.is_nan() || width <= 0.0 {
        return Vec::new();
    }
    let mut counts = vec![0_usize; classes];
    for height in heights {
        counts[(((height - lowest) / width) as usize).min(classes - 1)] += 1;
    }
    let whole = heights.len() as f64 * width;
    let middle = |class: usize| lowest + (class as f64 + 0.5) * width;
    let density = counts.iter().map(|count| *count as f64 / whole);
    density
        .enumerate()
        .map(|(class, density)| [middle(class), density])
        .collect()
}

/// Slope and curvature of profiles over a distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleDependence {
    /// The distance, m.
    pub distance: f64,
    /// Root mean square of the difference of heights over the distance.
    pub slope: f64,
    /// Root mean square of the second difference over its square, 1/m; `None` beyond half the map.
    pub curvature: Option<f64>,
}

/// Scale-dependent slope and curvature of profiles along x, at distances of 1, 2, 4 ... points up to half the map
/// (Sanner, Nöhring, Thimons, Jacobs & Pastewka 2022, doi:10.1016/j.apsadv.2021.100190).
pub fn scale_dependence(grid: &Grid, heights: &[f64], boundary: Boundary) -> Vec<ScaleDependence> {
    let nx = grid.nx;
    let rms = |offsets: &[(usize, f64)]| {
        let farthest = offsets.iter().map(|(offset, _)| *offset).max().unwrap_or(0);
        let places = match boundary {
            Boundary::Periodic => nx,
            Boundary::Free => nx.saturating_sub(farthest),
        };
        let square = |row: &[f64], at: usize| {
            let sum: f64 = offsets
                .iter()
                .map(|(offset, weight)| weight * row[(at + offset) % nx])
                .sum();
            sum * sum
        };
        let rows = heights.chunks_exact(nx);
        let sum: f64 = rows
            .map(|row| (0..places).map(|at| square(row, at)).sum::<f64>())
            .sum();
        (places > 0).then(|| (sum / (places * grid.ny) as f64).sqrt())
    };
    std::iter::successors(Some(1_usize), |points| Some(2 * points))
        .take_while(|points| 2 * points <= nx)
        .filter_map(|points| {
            let distance = points as f64 * grid.dx();
            Some(ScaleDependence {
                distance,
                slope: rms(&[(0, -1.0), (points, 1.0)])? / distance,
                curvature: rms(&[(0, 1.0), (points, -2.0), (2 * points, 1.0)])
                    .map(|second| second / (distance * distance)),
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;

    fn near(found: f64, expected: f64) {
        assert!(
            (found - expected).abs() < 1e-9 * expected.abs(),
            "{found} {expected}"
        );
    }

    /// A sine of amplitude 1: Sa = 2/pi, Sq = 1/sqrt 2, Sz = 2, Ssk = 0, Sku = 3/2.
    #[test]
    fn a_sine_has_the_parameters_of_a_sine() {
        let count = 4096;
        let wave: Vec<f64> = (0..count)
            .map(|i| (TAU * (f64::from(i) + 0.5) / f64::from(count)).sin())
            .collect();
        let found = HeightParameters::new(&wave);
        // The sum over points instead of an integral.
        assert!((found.mean_deviation - 2.0 / PI).abs() < 1e-6);
        near(found.rms_height, 0.5_f64.sqrt());
        assert!((found.range - 2.0).abs() < 1e-6 && found.skewness.unwrap().abs() < 1e-12);
        near(found.kurtosis.unwrap(), 1.5);
        assert_eq!(HeightParameters::new(&[2.0; 5]).skewness, None);
        // The arcsine law 1/(pi sqrt(1 - h^2)) in the middle; the whole is 1.
        let classes = distribution(&wave, 32);
        let whole: f64 = classes.iter().map(|[_, density]| density / 16.0).sum();
        assert!((whole - 1.0).abs() < 1e-9 && (classes[16][1] * PI - 1.0).abs() < 0.03);
        assert!(distribution(&[1.0; 4], 8).is_empty());
    }

    /// Of a sine over a distance d: slope 2 sin(q d/2)/(d sqrt 2), curvature 4 sin^2(q d/2)/(d^2 sqrt 2).
    #[test]
    fn a_sine_has_its_slope_at_each_distance() {
        let grid = Grid::new([64, 3], [1.0, 0.1]);
        let wave: Vec<f64> = (0..grid.len())
            .map(|i| (TAU * 3.0 * (i % 64) as f64 / 64.0).cos())
            .collect();
        let found = scale_dependence(&grid, &wave, Boundary::Periodic);
        assert_eq!(found.len(), 6);
        for at in found {
            let half = (PI * 3.0 * at.distance).sin();
            let slope = 2.0 * half.abs() / (at.distance * 2_f64.sqrt());
            assert!((at.slope - slope).abs() < 1e-9);
            let curvature = 4.0 * half * half / (at.distance.powi(2) * 2_f64.sqrt());
            assert!((at.curvature.unwrap() - curvature).abs() < 1e-9 * (1.0 + curvature));
        }
        // On a patch pairs do not wrap round: a ramp has its slope at every distance, and no curvature.
        let ramp: Vec<f64> = (0..grid.len()).map(|i| (i % 64) as f64 / 64.0).collect();
        for at in scale_dependence(&grid, &ramp, Boundary::Free) {
            near(at.slope, 1.0);
            assert!(at.curvature.is_none_or(|curvature| curvature < 1e-9));
        }
    }
}
