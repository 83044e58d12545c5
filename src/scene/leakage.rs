//! `[leakage]`: where a fluid flows to through the gap.

use super::reader::Reader;
use super::words::words;

words! {
    /// A direction of the grid.
    #[derive(Default)]
    Axis {
        /// Along x.
        #[default]
        X = "x",
        /// Along y.
        Y = "y",
    }
}

impl Axis {
    /// Reads `axis`.
    pub(super) fn read(table: &Reader, _keys: &[&str]) -> Option<Axis> {
        let named = table.optional("axis", |key| table.word(key))?;
        Some(named.unwrap_or_default())
    }
}
