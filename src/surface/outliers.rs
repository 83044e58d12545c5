//! Points of a measured map that stand out of their neighbours.

use crate::backend::Share;

/// Standard deviation of a normal distribution over its median absolute deviation.
const NORMAL: f64 = 1.4826;

/// Makes points missing that stand out of their neighbours' median by more than `times` the standard deviation
/// of such differences, estimated from their median, or where that is 0 from that of the others. Points that are missing already
/// have no say. Returns how many; none where a process has ended.
pub(super) fn drop_outliers(values: &mut [f64], share: &Share, times: f64) -> Outliers {
    let columns = share.surface()[0];
    let Ok([before, after]) = share.surface_rows_beside(values) else {
        return Outliers::default();
    };
    // The held rows between those beside them, which an edge of the map lacks.
    let around_here = [&before[..], values, &after[..]].concat();
    let differences: Vec<Option<f64>> = (before.len()..before.len() + values.len())
        .map(|index| difference(&around_here, columns, index))
        .collect();
    drop(around_here);
    let known = differences.iter().flatten();
    let mut sizes: Vec<f64> = known.map(|one| one.abs()).collect();
    let mut deviation = NORMAL * median_of_all(&mut sizes, share);
    let are_few_different = deviation == 0.0;
    if are_few_different {
        // Terraces and heights of few levels: most points equal their neighbours.
        sizes.retain(|size| *size > 0.0);
        deviation = NORMAL * median_of_all(&mut sizes, share);
    }
    drop(sizes);
    if deviation == 0.0 {
        return Outliers::default();
    }
    let (mut here, mut alone) = (0, 0);
    for (value, difference) in values.iter_mut().zip(&differences) {
        match difference {
            Some(difference) if difference.abs() > times * deviation => {
                *value = f64::NAN;
                here += 1;
            }
            None if value.is_finite() => alone += 1,
            _ => {}
        }
    }
    let [count, alone] = share.counts([here, alone]);
    Outliers {
        count,
        alone,
        are_few_different,
        deviation,
    }
}

/// What stands out of a map.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Outliers {
    /// Points that stood out.
    pub(super) count: usize,
    /// Points without a known neighbour, which cannot be judged.
    pub(super) alone: usize,
    /// Whether most points equal the median of their neighbours, so that the standard deviation is that of the others.
    pub(super) are_few_different: bool,
    /// The standard deviation, in the unit of the numbers.
    pub(super) deviation: f64,
}

/// Neighbours of a point, by rows and columns from it, half of them: the others lie opposite.
const AROUND: [[isize; 2]; 4] = [[0, 1], [1, 0], [1, 1], [1, -1]];
/// The same on a line.
const ALONG: [[isize; 2]; 2] = [[0, 1], [0, 2]];

/// The difference of a point from the median of its eight neighbours, or on a line of four; `None` of a missing point and of one
/// without neighbours.
///
/// At an edge or beside missing points these lie to one side, where a tilt makes their median another. The difference there is that from the neighbours on
/// both sides along the edge, or at a corner from the plane through three of them, if it is less.
fn difference(values: &[f64], columns: usize, index: usize) -> Option<f64> {
    let rows = values.len() / columns;
    let (row, column) = (index / columns, index % columns);
    let at = |[down, right]: [isize; 2]| -> Option<f64> {
        let row = row.checked_add_signed(down).filter(|row| *row < rows)?;
        let column = column.checked_add_signed(right);
        let column = column.filter(|column| *column < columns)?;
        Some(values[row * columns + column]).filter(|value| value.is_finite())
    };
    let half: &[[isize; 2]] = if rows == 1 { &ALONG } else { &AROUND };
    let (mut near, mut facing) = (Vec::with_capacity(8), Vec::with_capacity(8));
    for &[down, right] in half {
        let pair = [at([down, right]), at([-down, -right])];
        near.extend(pair.into_iter().flatten());
        if let [Some(one), Some(other)] = pair {
            facing.extend([one, other]);
        }
    }
    let here = at([0, 0])?;
    if near.is_empty() {
        return None;
    }
    let from_all = here - median_between(&mut near);
    if near.len() == 2 * half.len() {
        return Some(from_all);
    }
    let inward = |place: usize| if place == 0 { 1 } else { -1 };
    let (down, right) = (inward(row), inward(column));
    let plane = || match rows {
        1 => Some(2.0 * at([0, right])? - at([0, 2 * right])?),
        _ => Some(at([down, 0])? + at([0, right])? - at([down, right])?),
    };
    let level = match facing.is_empty() {
        false => Some(median_between(&mut facing)),
        true => plane(),
    };
    let from_level = level.map_or(from_all, |level| here - level);
    Some(match from_level.abs() < from_all.abs() {
        true => from_level,
        false => from_all,
    })
}

/// Median of a few numbers, of an even count the mean of the middle two; 0 of nothing. Reorders them.
fn median_between(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    match values.len() {
        0 => 0.0,
        count => 0.5 * (values[(count - 1) / 2] + values[count / 2]),
    }
}

/// Median of sizes, of which each process has some.
fn median_of_all(sizes: &mut [f64], share: &Share) -> f64 {
    if share.is_whole() {
        return median(sizes);
    }
    let [all] = share.counts([sizes.len()]);
    if all == 0 {
        return 0.0;
    }
    let below = all / 2;
    // The bits of numbers without a sign are in their order: the last number that has no more than that many below it.
    let (mut least, mut greatest) = (0, f64::INFINITY.to_bits());
    while least < greatest {
        let middle = greatest - (greatest - least) / 2;
        let bits = sizes.iter().map(|size| size.to_bits());
        let [count] = share.counts([bits.filter(|bits| *bits < middle).count()]);
        if count <= below {
            least = middle;
        } else {
            greatest = middle - 1;
        }
    }
    f64::from_bits(least)
}

/// Median; 0 of nothing. Reorders the values.
fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::super::fill;
    use super::*;
    use crate::backend::Shape;

    fn all(rows: usize, columns: usize) -> Share {
        Share::whole(Shape::whole(columns, rows))
    }

    /// Drops what stands out and fills it.
    fn remove_outliers(values: &mut [f64], share: &Share, times: f64) -> Outliers {
        let found = drop_outliers(values, share, times);
        let filled = fill::interpolate(values, share, false).unwrap();
        assert_eq!(filled, found.count);
        found
    }

    #[test]
    fn a_spike_goes_and_roughness_stays() {
        let rough: Vec<f64> = (0..400).map(|i| ((i * 37) % 11) as f64).collect();
        let mut values = rough.clone();
        values[210] = 500.0;
        values[399] = -300.0;
        let found = remove_outliers(&mut values, &all(20, 20), 8.0);
        assert_eq!((found.count, found.are_few_different), (2, false));
        for (index, (value, before)) in values.iter().zip(&rough).enumerate() {
            if index == 210 || index == 399 {
                assert!((0.0..=10.0).contains(value), "{index}: {value}");
            } else {
                assert_eq!(value, before);
            }
        }
        let mut flat = vec![1.0; 9];
        flat[4] = 2.0;
        let found = remove_outliers(&mut flat, &all(3, 3), 5.0);
        assert_eq!((found.count, found.are_few_different), (0, true));
        // Terraces of 6 and 2 points: the difference at most edges is half a step.
        let terraces = |at: usize| f64::from(u8::from((at / 64 + at % 64) % 8 >= 6));
        let mut values: Vec<f64> = (0..64 * 64).map(terraces).collect();
        values[20 * 64 + 20] = 500.0;
        let found = remove_outliers(&mut values, &all(64, 64), 6.0);
        assert_eq!(
            (found.count, found.are_few_different, found.deviation),
            (1, true, 0.5 * NORMAL)
        );
        for (at, value) in values.iter().enumerate() {
            match at == 20 * 64 + 20 {
                true => assert!((0.0..=1.0).contains(value), "{value}"),
                false => assert_eq!(*value, terraces(at)),
            }
        }
        let mut level = vec![1.0; 9];
        let found = remove_outliers(&mut level, &all(3, 3), 5.0);
        assert_eq!(found, Outliers::default());
    }

    /// Tilts and waves do not stand out, neither at edges nor at corners; spikes do, upwards as downwards, also on a line, and no
    /// neighbour with them.
    #[test]
    fn edges_of_tilted_maps_stay() {
        let noise = |at: usize| ((at * 37) % 11) as f64;
        for (rows, columns) in [(40, 40), (1, 400)] {
            let wave = |at: usize| 300.0 * (at as f64 % columns as f64 / 16.0).sin();
            let tilted = |at: usize| noise(at) + wave(at) + 60.0 * (at / columns) as f64;
            let healthy: Vec<f64> = (0..rows * columns).map(tilted).collect();
            for sign in [1.0, -1.0] {
                let mut values: Vec<f64> = healthy.iter().map(|height| sign * height).collect();
                let middle = rows * columns / 2;
                let spikes = [middle + 7, middle + 25];
                for at in spikes {
                    values[at] += 3e3;
                }
                let before = values.clone();
                let found = remove_outliers(&mut values, &all(rows, columns), 12.0);
                assert_eq!(found.count, spikes.len(), "{rows} rows, {sign}");
                for (at, (value, before)) in values.iter().zip(&before).enumerate() {
                    assert_eq!(value != before, spikes.contains(&at), "{rows} rows, {at}");
                }
            }
        }
    }

    /// A spike amid a hole has no neighbour to be compared with, and is counted.
    #[test]
    fn points_alone_are_counted() {
        let in_hole = |at: usize| (10..21).contains(&(at / 40)) && (10..21).contains(&(at % 40));
        let spike = 15 * 40 + 15;
        let height = |at: usize| match in_hole(at) && at != spike {
            true => f64::NAN,
            false => ((at * 37) % 11) as f64,
        };
        let mut values: Vec<f64> = (0..1600).map(height).collect();
        values[spike] = 3e3;
        let found = drop_outliers(&mut values, &all(40, 40), 12.0);
        assert_eq!((found.count, found.alone), (0, 1));
        assert_eq!(values[spike], 3e3);
    }

    /// A spike beside a hole goes with it and leaves nothing in it; a hole makes none of what is beside it.
    #[test]
    fn spikes_beside_holes_are_not_spread() {
        let tilted = |at: usize| ((at * 37) % 11) as f64 + 60.0 * (at / 40) as f64;
        let mut values: Vec<f64> = (0..1600).map(tilted).collect();
        let hole = |at: usize| (10..14).contains(&(at / 40)) && (10..16).contains(&(at % 40));
        for (at, value) in values.iter_mut().enumerate() {
            if hole(at) {
                *value = f64::NAN;
            }
        }
        let spike = 9 * 40 + 12;
        values[spike] += 3e3;
        let share = all(40, 40);
        assert_eq!(drop_outliers(&mut values, &share, 12.0).count, 1);
        assert!(values[spike].is_nan());
        assert_eq!(fill::interpolate(&mut values, &share, false).unwrap(), 25);
        for (at, value) in values.iter().enumerate() {
            let of_tilt = 60.0 * (at / 40) as f64;
            assert!((-30.0..=41.0).contains(&(value - of_tilt)), "{at}: {value}");
        }
    }
}
