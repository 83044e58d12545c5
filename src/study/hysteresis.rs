//! The energy that a loop of approach or mean gap loses.

use super::jumps::{Piece, Prescribed};
use super::row::StepRow;

/// A path is closed if its ends agree to this share of its span.
const CLOSED: f64 = 1e-9;

/// Energy dissipated over a loop, J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hysteresis {
    /// The area of the loop, with straight lines between its steps, less what the surfaces store more at its end than at its start.
    pub energy: f64,
    /// How far from it the area may be that the force encloses between the steps.
    pub uncertainty: f64,
}

impl Hysteresis {
    /// Of the rows of a path of prescribed positions, those of the far end of a spring included; `None` where it does not return to
    /// its start.
    ///
    /// What a step between two states of one branch loses by its straight line is an error, since a branch conserves energy.
    /// In a step that jumps the line is right for a jump at its middle, and half its change of force times its change of position
    /// too much or too little for one at either end.
    pub(super) fn of_loop(
        prescribed: Prescribed,
        path: &[f64],
        rows: &[StepRow],
        jumped: impl Fn(&StepRow) -> bool,
    ) -> Option<Hysteresis> {
        let has_position = |row: &StepRow| row.place(prescribed.control).is_some();
        // The work is that of the approach under a mean gap, too: it presses the layer below the gap together.
        let places: Option<Vec<f64>> = rows.iter().map(|row| row.approach).collect();
        let places = places.filter(|_| rows.iter().all(has_position))?;
        // The values of the path: through a spring the surfaces themselves return but to the tolerance.
        let [first, .., last] = *path.get(..rows.len())? else {
            return None;
        };
        let span = span(&path[..rows.len()]);
        let is_open = (last - first).abs() > CLOSED * span || span == 0.0;
        if rows.len() < 3 || is_open || !rows.iter().all(|row| row.converged) {
            return None;
        }
        let area: f64 = rows
            .windows(2)
            .zip(places.windows(2))
            .map(|(row, place)| 0.5 * (row[0].force + row[1].force) * (place[1] - place[0]))
            .sum();
        // They need not come back to their state: to another branch, a plastic one, or one that still relaxes.
        let stored = |row: &StepRow| row.elastic_energy + row.adhesive_energy;
        let energy = area - (stored(rows.last()?) - stored(rows.first()?));
        let uncertainty = rows
            .windows(2)
            .filter_map(|rows| {
                let piece = Piece::between(prescribed, &rows[0], &rows[1])?;
                Some(match jumped(&rows[1]) {
                    true => 0.5 * piece.doubt,
                    false => piece.lost.abs(),
                })
            })
            .sum();
        Some(Hysteresis {
            energy,
            uncertainty,
        })
    }
}

/// How far the places of a path lie apart.
pub(super) fn span(places: &[f64]) -> f64 {
    let most = places.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = places.iter().copied().fold(f64::INFINITY, f64::min);
    most - least
}
