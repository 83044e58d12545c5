//! The grids of an accuracy study.

use super::error::AccuracyError;

/// Most grids compared; each has twice the points a side of the one before.
const GRIDS: u32 = 4;
/// Fewest points along a side of a compared grid.
pub const LEAST_POINTS: usize = 16;
/// Doubles each side of more than one point.
pub(super) fn twice(points: [usize; 2]) -> [usize; 2] {
    points.map(|side| if side == 1 { 1 } else { 2 * side })
}

/// The compared grids, the coarsest first: the scene's own grid, halved while every side is even
/// and long enough.
pub(super) fn halved_grids(own: [usize; 2]) -> Result<Vec<[usize; 2]>, AccuracyError> {
    let is_coarse =
        |points: [usize; 2]| points.iter().any(|side| *side > 1 && *side < LEAST_POINTS);
    if is_coarse(own) || own == [1, 1] {
        return Err(AccuracyError::TooCoarse {
            points: own,
            least: LEAST_POINTS,
        });
    }
    let mut grids = vec![own];
    for _ in 1..GRIDS {
        let finer = grids[grids.len() - 1];
        let half = finer.map(|side| if side == 1 { 1 } else { side / 2 });
        if is_coarse(half) || finer.iter().any(|side| *side > 1 && side % 2 == 1) {
            break;
        }
        grids.push(half);
    }
    grids.reverse();
    Ok(grids)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_are_halves_down_to_the_fewest_points() {
        let grids = |own| halved_grids(own).expect("points enough");
        assert_eq!(
            grids([128, 128]),
            [[16, 16], [32, 32], [64, 64], [128, 128]]
        );
        assert_eq!(grids([512, 256])[0], [64, 32]);
        assert_eq!(grids([100, 100]), [[25, 25], [50, 50], [100, 100]]);
        assert_eq!(grids([64, 1]), [[16, 1], [32, 1], [64, 1]]);
        assert_eq!(grids([27, 27]), [[27, 27]]);
        assert!(halved_grids([8, 64]).is_err() && halved_grids([1, 1]).is_err());
        assert_eq!(twice([64, 1]), [128, 1]);
    }
}
