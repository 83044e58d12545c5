//! The points about the highest one of a surface.

use crate::backend::Share;

/// Points that are looked at, more than a disc of five pixels has.
const KEPT: usize = 24;

/// How far the highest points of a surface lie below the highest of all, m: ascending, from 0, some tens at most. `heights` are the held
/// rows of the share; every rank has the same.
pub(crate) fn depths_of_highest(heights: &[f64], share: &Share) -> Vec<f64> {
    // The highest of this rank, ascending.
    let mut own: Vec<f64> = Vec::with_capacity(KEPT + 1);
    for &height in heights {
        if own.len() == KEPT && height <= own[0] {
            continue;
        }
        let place = own.partition_point(|kept| *kept < height);
        own.insert(place, height);
        if own.len() > KEPT {
            own.remove(0);
        }
    }
    let mut depths = Vec::with_capacity(KEPT);
    let mut top = f64::NAN;
    for _ in 0..KEPT {
        let next = own.last().copied().unwrap_or(f64::NEG_INFINITY);
        let highest = share.greatest(next);
        if highest == f64::NEG_INFINITY {
            break;
        }
        if next == highest {
            own.pop();
        }
        if depths.is_empty() {
            top = highest;
        }
        depths.push(top - highest);
    }
    depths
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::Shape;

    #[test]
    fn the_highest_points_are_kept_in_their_order() {
        let share = Share::whole(Shape::whole(10, 10));
        // Each number from 0 to 99 once: 37 and 100 have no common divisor.
        let heights: Vec<f64> = (0..100).map(|i| f64::from(i * 37 % 100)).collect();
        let expected: Vec<f64> = (0..KEPT as i32).map(f64::from).collect();
        assert_eq!(depths_of_highest(&heights, &share), expected);
    }

    #[test]
    fn few_points_are_all_there_are() {
        let share = Share::whole(Shape::whole(2, 2));
        let depths = depths_of_highest(&[1.0, 3.0, 3.0, -1.0], &share);
        assert_eq!(depths, [0.0, 0.0, 2.0, 4.0]);
    }
}
