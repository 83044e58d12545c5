//! The Pareto front of cost and error.

/// Settings that no other setting beats in both cost and error, as indices, the cheapest first. NaN
/// costs and errors are never on the front.
pub fn pareto(points: &[(f64, Option<f64>)]) -> Vec<usize> {
    let mut known: Vec<(usize, f64, f64)> = points
        .iter()
        .enumerate()
        .filter_map(|(index, (cost, error))| Some((index, *cost, (*error)?)))
        .filter(|(_, cost, error)| cost.is_finite() && error.is_finite())
        .collect();
    known.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)));
    let mut least = f64::INFINITY;
    known.retain(|(_, _, error)| {
        let better = *error < least;
        least = least.min(*error);
        better
    });
    known.into_iter().map(|(index, ..)| index).collect()
}

/// The cheapest setting whose error plus the uncertainty of the reference is at most `level`.
pub fn cheapest(points: &[(f64, Option<f64>)], uncertainty: f64, level: f64) -> Option<usize> {
    let reaches = |error: f64| error + uncertainty <= level;
    let pareto = pareto(points);
    pareto
        .into_iter()
        .find(|index| points[*index].1.is_some_and(reaches))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_setting_beats_the_pareto_front() {
        let points = [
            (1.0, Some(0.5)),
            (2.0, Some(0.1)),
            (2.5, Some(0.2)), // dearer and worse
            (4.0, Some(0.1)), // dearer and no better
            (8.0, Some(0.01)),
            (0.5, None),
            (0.1, Some(f64::NAN)),
            (2.0, Some(0.3)),
        ];
        let pareto = pareto(&points);
        assert_eq!(pareto, [0, 1, 4]);
        for (index, (cost, error)) in points.iter().enumerate() {
            let Some(error) = error.filter(|error| !error.is_nan()) else {
                continue;
            };
            let beaten = points.iter().any(|(other, least)| {
                least.is_some_and(|least| {
                    (*other < *cost && least <= error) || (*other <= *cost && least < error)
                })
            });
            let same = index == 3;
            assert!(pareto.contains(&index) != beaten || same, "{index}");
        }
    }

    #[test]
    fn a_level_includes_the_uncertainty() {
        let points = [(1.0, Some(0.09)), (3.0, Some(0.004)), (2.0, Some(0.05))];
        assert_eq!(cheapest(&points, 0.0, 0.1), Some(0));
        assert_eq!(cheapest(&points, 0.02, 0.1), Some(2));
        assert_eq!(cheapest(&points, 0.0, 0.01), Some(1));
        assert_eq!(cheapest(&points, 0.01, 0.01), None);
        assert_eq!(cheapest(&[], 0.0, 0.1), None);
    }
}
