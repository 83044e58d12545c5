//! Preparation of a measured map: crop, profile, outliers, edges.

use std::f64::consts::FRAC_PI_2;

use super::error::FileError;
use super::formats::UNEVEN;
use super::matrix::{Map, Matrix, PASSED, Size};
use crate::backend::{BackendError, Share};

/// A map is a line scan if its sides are this many times apart,
const LINE: usize = 1000;
/// or if it has two rows of at least so many points.
const LEAST_LINE: usize = 16;
/// A window falls to zero over one part in so many of each side.
const WINDOW: usize = 8;
/// Standard deviation of a normal distribution over its median absolute deviation.
const NORMAL: f64 = 1.4826;

/// Refuses a line scan, which is no map.
pub(super) fn expect_map([columns, rows]: [usize; 2]) -> Result<(), FileError> {
    let (short, long) = (rows.min(columns), rows.max(columns));
    if long >= LINE * short || (short <= 2 && long >= LEAST_LINE) {
        return Err(FileError::LineScan { columns, rows });
    }
    Ok(())
}

/// A line of heights, or two of places and heights, as one row along x; of more lines the first. The map is read some rows at a
/// time and to its end, so that a broken file is refused, and no more than two lines are held.
pub(super) fn to_profile(map: Map) -> Result<Matrix, FileError> {
    let (numbers, mut header) = map.split();
    let (rows, columns) = (header.rows, header.columns);
    let [lines, count] = [rows.min(columns), rows.max(columns)];
    // The side that the line lies along.
    let along = usize::from(rows > columns);
    let mut numbers = numbers.into_rows();
    let mut found = Vec::new();
    found.resize_with(lines.min(2), Vec::new);
    for line in &mut found {
        line.try_reserve_exact(count)
            .map_err(|_| FileError::Memory {
                bytes: (count * size_of::<f64>()) as u64,
            })?;
    }
    let at_once = (PASSED / columns).max(1);
    let mut values = Vec::new();
    for start in (0..rows).step_by(at_once) {
        values.resize(at_once.min(rows - start) * columns, 0.0);
        numbers.next(&mut values)?;
        for (row, numbers) in (start..).zip(values.chunks_exact(columns)) {
            if rows > columns {
                for (line, number) in found.iter_mut().zip(numbers) {
                    line.push(*number);
                }
            } else if let Some(line) = found.get_mut(row) {
                line.extend_from_slice(numbers);
            }
        }
    }
    let length = match lines {
        2 => length(&mut found, &header)?,
        _ => None,
    };
    if length.is_none() && lines > 1 {
        header.warnings.push(format!(
            "of {lines} lines the first is the profile; a profile has one line of heights, or two of places at equal distances and heights"
        ));
    }
    let heights = found.swap_remove(0);
    header.size = match (length, header.size) {
        (Some(length), _) => Some(match header.lateral_unit {
            Some(unit) => Size::Metres([length * unit; 2]),
            None => Size::LikeHeights([length; 2]),
        }),
        (None, Some(Size::Metres(sides))) => Some(Size::Metres([sides[along]; 2])),
        (None, Some(Size::LikeHeights(sides))) => Some(Size::LikeHeights([sides[along]; 2])),
        (None, None) => None,
    };
    (header.lateral_unit, header.places) = (None, None);
    (header.rows, header.columns) = (1, count);
    Ok(header.with(heights))
}

/// Length of a profile of two lines, if one is of places: its heights come first then, in the order of rising places. `None` for
/// two lines of heights.
///
/// # Errors
/// Places whose distances are not equal; places behind the heights, without heads that say so.
fn length(lines: &mut [Vec<f64>], header: &Matrix<()>) -> Result<Option<f64>, FileError> {
    let places = header.places.unwrap_or(0);
    let step = match step(&lines[places]) {
        Ok(step) => step,
        Err(_) if header.places.is_none() && step(&lines[1]).is_ok() => {
            return Err(FileError::PlacesBehindHeights);
        }
        Err(place) => {
            let are_places = header.places.is_some() || header.lateral_unit.is_some();
            return match are_places || is_monotonic(&lines[places]) {
                true => Err(FileError::UnevenPlaces {
                    place: place + 1,
                    value: lines[places][place],
                }),
                false => Ok(None),
            };
        }
    };
    lines.swap(0, 1 - places);
    if step < 0.0 {
        lines[0].reverse();
    }
    Ok(Some(step.abs() * lines[0].len() as f64))
}

/// Distance between places, negative if they fall; or the first whose distances to the others are not equal, from 0.
fn step(places: &[f64]) -> Result<f64, usize> {
    let (first, last) = (places[0], places[places.len() - 1]);
    let step = (last - first) / (places.len() as f64 - 1.0);
    // Rounding to few digits moves each place, however many steps lie before it; as of points on a grid.
    let is_even = |index: usize, place: f64| {
        step != 0.0 && (place - first - index as f64 * step).abs() <= UNEVEN * step.abs()
    };
    let mut numbered = places.iter().enumerate();
    let uneven = numbered.find(|(index, place)| !is_even(*index, **place));
    uneven.map_or(Ok(step), |(index, _)| Err(index))
}

/// Whether numbers rise all the way, or fall.
fn is_monotonic(numbers: &[f64]) -> bool {
    let falls = |pair: &[f64]| pair[0] > pair[1];
    let rises = |pair: &[f64]| pair[0] < pair[1];
    numbers.windows(2).all(falls) || numbers.windows(2).all(rises)
}

/// Refuses the part of so many points along x and y from `[x, y]` on that is not within a map of so many columns and rows.
pub(super) fn check_crop(crop: [usize; 4], [columns, rows]: [usize; 2]) -> Result<(), FileError> {
    let [x, y, nx, ny] = crop;
    let ends = [x.checked_add(nx), y.checked_add(ny)];
    if ends[0].is_some_and(|end| end <= columns) && ends[1].is_some_and(|end| end <= rows) {
        return Ok(());
    }
    Err(FileError::Crop {
        crop,
        columns,
        rows,
    })
}

/// Size of that part of a map of such a size.
pub(super) fn cropped_size(crop: [usize; 4], [columns, rows]: [usize; 2], size: Size) -> Size {
    let [_, _, nx, ny] = crop;
    let part = |[width, height]: [f64; 2]| {
        [
            width * nx as f64 / columns as f64,
            height * ny as f64 / rows as f64,
        ]
    };
    match size {
        Size::Metres(size) => Size::Metres(part(size)),
        Size::LikeHeights(size) => Size::LikeHeights(part(size)),
    }
}

/// Keeps the points from `[x, y]` on, so many along x and y.
pub(super) fn crop(matrix: &mut Matrix, crop: [usize; 4]) -> Result<(), FileError> {
    let (rows, columns) = (matrix.rows, matrix.columns);
    check_crop(crop, [columns, rows])?;
    let [x, y, nx, ny] = crop;
    matrix.values.truncate((y + ny) * columns);
    matrix.values.drain(..y * columns);
    matrix.values.shrink_to_fit();
    if nx != columns {
        let rows = matrix.values.chunks_exact(columns);
        matrix.values = rows.flat_map(|row| &row[x..x + nx]).copied().collect();
    }
    let size = matrix.size;
    matrix.size = size.map(|size| cropped_size(crop, [columns, rows], size));
    (matrix.rows, matrix.columns) = (ny, nx);
    Ok(())
}

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
    let mut here = 0;
    for (value, difference) in values.iter_mut().zip(&differences) {
        if difference.is_some_and(|difference| difference.abs() > times * deviation) {
            *value = f64::NAN;
            here += 1;
        }
    }
    let [count] = share.counts([here]);
    Outliers {
        count,
        are_few_different,
        deviation,
    }
}

/// What stands out of a map.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Outliers {
    /// Points that stood out.
    pub(super) count: usize,
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

/// Brings the heights of the held rows to the mean of all at the edges, over an eighth of each side.
pub(super) fn window(heights: &mut [f64], share: &Share) {
    let [columns, rows] = share.surface();
    let first = share.surface_rows().start;
    let mean = share.surface_sum_by(heights, |height| height) / (rows * columns) as f64;
    let weight = |at: usize, count: usize| {
        let wide = (count / WINDOW) as f64;
        let inside = at.min(count - 1 - at) as f64 + 0.5;
        if count == 1 || inside >= wide {
            1.0
        } else {
            (FRAC_PI_2 * inside / wide).sin().powi(2)
        }
    };
    for (index, height) in heights.iter_mut().enumerate() {
        let weight = weight(index % columns, columns) * weight(first + index / columns, rows);
        *height = mean + (*height - mean) * weight;
    }
}

/// Twice as many points along each side that has more than one.
pub(super) fn mirrored(points: [usize; 2]) -> [usize; 2] {
    points.map(|count| if count > 1 { 2 * count } else { 1 })
}

/// The map and its mirror images along both sides on [`mirrored`] points: the rows of these that this process holds, from its rows
/// of the map.
///
/// # Errors
/// A rank has ended.
pub(super) fn mirror(heights: &[f64], from: &Share, to: &Share) -> Result<Vec<f64>, BackendError> {
    let [columns, rows] = from.surface();
    let is_doubled = to.surface()[0] > columns;
    let back = |row: usize| row.min(2 * rows - 1 - row);
    let held = |rank: usize| from.surface_rows_of(rank);
    let wanted = |rank: usize| to.surface_rows_of(rank).map(back).collect();
    let mut found = Vec::with_capacity(to.surface_len());
    from.fetch_each(heights, columns, held, wanted, |_, line: &[f64]| {
        found.extend_from_slice(line);
        if is_doubled {
            found.extend(line.iter().rev());
        }
    })?;
    Ok(found)
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

    #[test]
    fn windowed_and_mirrored_maps_close() {
        let mut heights: Vec<f64> = (0..32 * 16).map(|i| (i % 32) as f64).collect();
        let mirror = |heights: &[f64], [columns, rows]: [usize; 2]| {
            let to = mirrored([columns, rows]);
            let found = mirror(heights, &all(rows, columns), &all(to[1], to[0]));
            (found.unwrap(), to)
        };
        let (mirrored, points) = mirror(&heights, [32, 16]);
        assert_eq!(points, [64, 32]);
        assert_eq!(&mirrored[..32], &heights[..32]);
        assert_eq!(
            (mirrored[63], mirrored[31], mirrored[32]),
            (0.0, 31.0, 31.0)
        );
        assert_eq!(mirrored[31 * 64..], mirrored[..64]);
        window(&mut heights, &all(16, 32));
        let mean = 15.5;
        // Half a point from the edge, of a taper of four points.
        let least = (FRAC_PI_2 * 0.5 / 4.0).sin().powi(2);
        let row = &heights[8 * 32..9 * 32];
        assert!((row[0] - (mean - 15.5 * least)).abs() < 1e-12, "{}", row[0]);
        assert_eq!(row[10], 10.0);
        assert_eq!(
            mirror(&[1.0, 2.0], [2, 1]),
            (vec![1.0, 2.0, 2.0, 1.0], [4, 1])
        );
    }

    /// Places are not taken for heights.
    #[test]
    fn places_without_equal_distances_are_refused() {
        let uneven = |values: Vec<f64>, places, lateral_unit| {
            let map = Matrix {
                places,
                lateral_unit,
                ..Matrix::new(values, [4, 2])
            };
            to_profile(map.into()).map(|found| found.values)
        };
        let rising = vec![0.0, 3.0, 0.5, 4.0, 9.0, 6.0, 10.0, 2.0];
        let rough = vec![0.0, 3.0, 0.5, 4.0, 0.4, 6.0, 1.5, 2.0];
        for (values, places, unit, place) in [
            (&rising, None, None, 2),
            (&rough, Some(0), None, 3),
            (&rough, None, Some(1e-6), 3),
            (&rough, Some(1), None, 2),
        ] {
            let error = uneven(values.clone(), places, unit).unwrap_err();
            let found = matches!(error, FileError::UnevenPlaces { place: at, .. } if at == place);
            assert!(found, "{error}");
        }
        let heights = uneven(rough.clone(), None, None).unwrap();
        assert_eq!(heights, [0.0, 0.5, 0.4, 1.5]);
        let behind: Vec<f64> = [5.0, 2.0, 4.0, 3.0]
            .iter()
            .zip(0..)
            .flat_map(|(height, place)| [*height, f64::from(place)])
            .collect();
        let error = uneven(behind, None, None).unwrap_err();
        assert!(matches!(error, FileError::PlacesBehindHeights), "{error}");
    }

    #[test]
    fn profiles_have_one_line_or_places_too() {
        let profile = |values: Vec<f64>, shape| to_profile(Matrix::new(values, shape).into());
        let lines = profile(vec![0.0, 3.0, 0.5, 4.0, 1.0, 6.0], [3, 2]).unwrap();
        assert_eq!(
            (lines.values.as_slice(), lines.rows, lines.columns),
            ([3.0, 4.0, 6.0].as_slice(), 1, 3)
        );
        assert_eq!(lines.size, Some(Size::LikeHeights([1.5; 2])));
        assert!(lines.warnings.is_empty());
        let rows = profile(vec![0.0, 0.5, 1.0, 3.0, 4.0, 6.0], [2, 3]).unwrap();
        assert_eq!(rows, lines);
        let falling = profile(vec![1.0, 6.0, 0.5, 4.0, 0.0, 3.0], [3, 2]).unwrap();
        assert_eq!(falling, lines);
        let heights = profile(vec![2.0, 3.0, 0.5, 4.0, 9.0, 6.0], [3, 2]).unwrap();
        assert_eq!(
            (heights.values[2], heights.size, heights.warnings.len()),
            (9.0, None, 1)
        );
        // Places of few digits: 1/3 is moved by 1 % of a step.
        let rounded = profile(vec![0.0, 0.33, 0.67, 1.0, 3.0, 4.0, 6.0, 5.0], [2, 4]).unwrap();
        assert_eq!(rounded.values, [3.0, 4.0, 6.0, 5.0]);
        let Some(Size::LikeHeights([length, _])) = rounded.size else {
            panic!("{:?}", rounded.size);
        };
        assert!((length - 4.0 / 3.0).abs() < 1e-12, "{length}");
        // Places in their own unit.
        let places = Matrix {
            unit: Some(1e-9),
            lateral_unit: Some(1e-3),
            ..Matrix::new(vec![0.0, 3.0, 0.5, 4.0, 1.0, 6.0], [3, 2])
        };
        let found = to_profile(places.into()).unwrap();
        assert_eq!(found.size, Some(Size::Metres([1.5 * 1e-3; 2])));
        // Heights before places.
        let behind = Matrix {
            unit: Some(1e-9),
            lateral_unit: Some(1e-3),
            places: Some(1),
            ..Matrix::new(vec![3.0, 0.0, 4.0, 0.5, 6.0, 1.0], [3, 2])
        };
        assert_eq!(to_profile(behind.into()).unwrap(), found);
        // The profile is as wide as long, and as long as the side along the line, whether its pixels are narrow or wide.
        for (size, shape, length) in [
            (
                Size::LikeHeights([6.0, 1.5]),
                [1, 4],
                Size::LikeHeights([6.0; 2]),
            ),
            (
                Size::LikeHeights([1.5, 6.0]),
                [4, 1],
                Size::LikeHeights([6.0; 2]),
            ),
            (Size::Metres([1.5, 6.0]), [1, 4], Size::Metres([1.5; 2])),
            (Size::Metres([6.0, 1.5]), [4, 1], Size::Metres([1.5; 2])),
        ] {
            let line = Matrix {
                size: Some(size),
                ..Matrix::new(vec![3.0, 4.0, 6.0, 5.0], shape)
            };
            let found = to_profile(line.into()).unwrap();
            assert_eq!(found.size, Some(length));
        }
        // More lines, and more rows than are read at once.
        let many = (0..3 * PASSED).map(|at| at as f64).collect();
        let first = profile(many, [PASSED, 3]).unwrap();
        assert!((0..PASSED).map(|row| 3.0 * row as f64).eq(first.values));
        assert_eq!(
            profile(vec![7.0], [1, 1]).unwrap(),
            Matrix::new(vec![7.0], [1, 1])
        );
    }
}
