//! The pictures of a run that a page shows.

use std::path::PathBuf;

/// Most pictures on a page.
const MOST_PICTURES: usize = 24;

/// A picture of a run: step, field and file.
pub(in crate::output) type Pictured = (usize, &'static str, PathBuf);

/// The pictures that a page shows, in their order: all fields of so many steps, evenly spread, that there are at most
/// `MOST_PICTURES`.
pub(super) fn chosen(pictures: &[Pictured]) -> Vec<&Pictured> {
    let mut steps: Vec<usize> = pictures.iter().map(|(step, ..)| *step).collect();
    steps.dedup();
    let fields = pictures.len().div_ceil(steps.len().max(1));
    let places = spread(steps.len(), (MOST_PICTURES / fields.max(1)).max(2));
    let shown: Vec<usize> = places.into_iter().map(|place| steps[place]).collect();
    pictures
        .iter()
        .filter(|(step, ..)| shown.contains(step))
        .collect()
}

/// At most `most` of `count` indices, evenly spread, including both ends.
fn spread(count: usize, most: usize) -> Vec<usize> {
    if count <= most {
        return (0..count).collect();
    }
    (0..most).map(|k| k * (count - 1) / (most - 1)).collect()
}

/// Width and height of a PNG, from its header.
pub(super) fn png_size(png: &[u8]) -> Option<[u32; 2]> {
    let number = |at: usize| -> Option<u32> {
        Some(u32::from_be_bytes(png.get(at..at + 4)?.try_into().ok()?))
    };
    Some([number(16)?, number(20)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_spread_with_both_ends() {
        assert_eq!(spread(3, 24), [0, 1, 2]);
        let chosen = spread(1000, 24);
        assert_eq!(chosen.len(), 24);
        assert_eq!((chosen[0], chosen[23]), (0, 999));
        assert!(chosen.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!(spread(25, 24).len(), 24);
    }

    /// Four fields of 23 steps: all four of the first step, the last and four between.
    #[test]
    fn each_step_that_is_shown_has_all_its_pictures() {
        let names = ["pressure", "gap", "displacement", "heights"];
        let step = |step: usize| names.map(|name| (step, name, PathBuf::new()));
        let all: Vec<Pictured> = (1..=23).flat_map(step).collect();
        let shown: Vec<(usize, &str)> = chosen(&all).iter().map(|p| (p.0, p.1)).collect();
        assert_eq!(shown.len(), MOST_PICTURES);
        for pictures in shown.chunks(4) {
            assert!(pictures.iter().all(|picture| picture.0 == pictures[0].0));
            assert_eq!(
                pictures.iter().map(|picture| picture.1).collect::<Vec<_>>(),
                names
            );
        }
        assert_eq!((shown[0].0, shown[MOST_PICTURES - 1].0), (1, 23));
    }
}
