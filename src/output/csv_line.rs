//! Lines of CSV.

/// A line of a CSV table, with its end; cells are quoted where they must be.
///
/// Tables grow line by line, and each is on the disk before the next is computed, so lines are made one by one.
pub(crate) fn csv_line<C: AsRef<[u8]>>(cells: impl IntoIterator<Item = C>) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let written = writer.write_record(cells);
    debug_assert!(written.is_ok(), "memory takes every line");
    let bytes = writer.into_inner().unwrap_or_default();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// A number in scientific notation, to the last bit; empty where there is none.
pub(crate) fn csv_number(value: Option<f64>) -> String {
    value.map(|value| format!("{value:e}")).unwrap_or_default()
}
