//! A line scan as a profile.

use super::file_error::FileError;
use super::formats::UNEVEN;
use super::matrix::{Map, Matrix, PASSED, Size};

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

#[cfg(test)]
mod tests {
    use super::*;

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
