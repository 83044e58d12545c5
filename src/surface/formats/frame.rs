//! Places around a matrix of heights: a first row and a first column of evenly spaced numbers.

/// Fewest rows and columns of a matrix that is looked at.
const FEWEST: usize = 4;
/// How much a step may differ from the first one, over it: places are written with few digits.
const UNEVEN: f64 = 0.01;

/// What the edges of a matrix look like, as its numbers are read.
#[derive(Default)]
pub(super) struct Frame {
    first_row: Steps,
    second_row: Steps,
    first_column: Steps,
}

/// Steps from number to number.
#[derive(Default)]
struct Steps {
    last: Option<f64>,
    first: Option<f64>,
    count: usize,
    uneven: bool,
}

impl Frame {
    /// Looks at a number; rows and columns count from 1.
    pub fn take(&mut self, row: usize, column: usize, value: f64) {
        match (row, column) {
            // The corner belongs to neither.
            (1, 1) => {}
            (1, _) => self.first_row.take(value),
            (2, 2..) => self.second_row.take(value),
            (_, 1) => self.first_column.take(value),
            _ => {}
        }
    }

    /// A warning where the edges of so many rows and columns look like places, and the row behind them does not.
    pub fn warning(&self, rows: usize, columns: usize) -> Option<String> {
        let is_framed = self.first_row.are_even()
            && self.first_column.are_even()
            && !self.second_row.are_even();
        (is_framed && rows.min(columns) >= FEWEST).then(|| {
            format!(
                "its first row and its first column are evenly spaced, as places are: if they are no heights, leave them out with crop = [1, 1, {}, {}]",
                columns - 1,
                rows - 1
            )
        })
    }
}

impl Steps {
    fn take(&mut self, value: f64) {
        if let Some(last) = self.last.replace(value) {
            let step = value - last;
            let first = *self.first.get_or_insert(step);
            self.count += 1;
            // A step that is not a number is uneven too.
            let is_even = (step - first).abs() <= UNEVEN * first.abs();
            self.uneven |= !is_even || first == 0.0;
        }
    }

    fn are_even(&self) -> bool {
        self.count >= FEWEST - 2 && !self.uneven
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn warning(
        rows: usize,
        columns: usize,
        value_at: impl Fn(usize, usize) -> f64,
    ) -> Option<String> {
        let mut frame = Frame::default();
        for row in 1..=rows {
            for column in 1..=columns {
                frame.take(row, column, value_at(row, column));
            }
        }
        frame.warning(rows, columns)
    }

    #[test]
    fn places_are_told_from_heights() {
        let wave =
            |row: usize, column: usize| (1.7 * row as f64).sin() + (2.3 * column as f64).cos();
        let third = |at: usize| ((at as f64 - 1.0) / 3.0 * 1e3).round() / 1e3;
        let framed = |corner: f64| {
            move |row: usize, column: usize| match (row, column) {
                (1, 1) => corner,
                (1, at) | (at, 1) => third(at),
                _ => wave(row, column),
            }
        };
        for corner in [0.0, f64::NAN, 7.0] {
            let found = warning(5, 6, framed(corner)).expect("a frame");
            assert!(found.ends_with("crop = [1, 1, 5, 4]"), "{found}");
        }
        assert_eq!(warning(5, 6, wave), None);
        // A plane, and an edge that is level.
        assert_eq!(warning(5, 6, |row, column| (2 * row + column) as f64), None);
        let level = |row, column| {
            if row == 1 || column == 1 {
                0.0
            } else {
                wave(row, column)
            }
        };
        assert_eq!(warning(5, 6, level), None);
        // Places along one side alone are heights that rise.
        let ramp = |row, column| {
            if row == 1 {
                third(column)
            } else {
                wave(row, column)
            }
        };
        assert_eq!(warning(5, 6, ramp), None);
        assert_eq!(warning(3, 3, framed(0.0)), None);
    }
}
