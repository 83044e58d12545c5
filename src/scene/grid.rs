//! `[grid]`: points, size and boundary.

use super::allowed::Allowed;
use super::document::{Table, Value};
use super::keys;
use super::reader::Reader;
use super::{Boundary, GridScene};
use crate::units::Dimension;

/// Most points along one axis.
const MOST_POINTS: i64 = 1 << 18;

/// Reads `[grid]`. Points and size may be left out if a height file can provide them.
pub(super) fn read(scene: &Reader, surface_from_file: bool) -> Option<GridScene> {
    if !scene.has("grid") {
        if surface_from_file {
            return Some(GridScene::from_file());
        }
        scene.require_as("grid", "[grid] with points = 1024 and size = \"25 um\"");
        return None;
    }
    let grid = scene.table("grid", &keys::GRID)?;
    if !surface_from_file {
        grid.require(&["points", "size"]);
    }
    let points = grid.one_or_two("points", |node, name| {
        grid.whole_number_in(node, "points", name, 1, MOST_POINTS)
            .and_then(|number| usize::try_from(number).ok())
    });
    let size = grid.one_or_two("size", |node, name| {
        grid.quantity_in(node, "size", name, Dimension::Length, Allowed::POSITIVE)
    });
    let boundary = grid.word_or("boundary", Boundary::Periodic)?;
    // An absent value is allowed here, a wrong one is not.
    if points.is_none() && grid.has("points") || size.is_none() && grid.has("size") {
        return None;
    }
    Some(GridScene {
        points,
        size,
        boundary,
    })
}

/// Whether any `[[surface]]` is read from a file.
pub(super) fn has_height_file(scene: &Table) -> bool {
    let Some(Value::List(parts)) = scene.get("surface").map(|entry| &entry.node.value) else {
        return false;
    };
    parts.iter().any(|part| match &part.value {
        Value::Table(table) => table
            .get("kind")
            .is_some_and(|kind| kind.node.is_text("file")),
        _ => false,
    })
}
