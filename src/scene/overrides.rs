//! `--set KEY=VALUE`: changes to the tree of a scene before it is read.

use super::document::{Entry, Location, Node, Table, Value, parse_set};
use super::mistake::SceneError;
use super::reader::{Log, shown_key};

/// Tables that every scene has, written or not. The others are effects, which a single key does not
/// switch on.
const ALWAYS: &[&str] = &["grid", "solid", "loading", "solver", "output"];

/// Applies the overrides in order and notes those whose key does not exist.
pub(super) fn apply(root: &mut Table, overrides: &[(String, String)], log: &Log) {
    for (key, text) in overrides {
        let done = parse_set(text).and_then(|node| set(root, key, node));
        if let Err(error) = done {
            log.add(Location::Set, &shown_key(key), error);
        }
    }
}

fn refuse(reason: String) -> SceneError {
    SceneError::Override { reason }
}

fn set(root: &mut Table, key: &str, node: Node) -> Result<(), SceneError> {
    let names: Vec<&str> = key.split('.').map(str::trim).collect();
    let Some((last, tables)) = names.split_last().filter(|_| !names.contains(&"")) else {
        return Err(refuse(
            "not a key; write it with dots between the names, such as surface.0.hurst=0.4".into(),
        ));
    };
    if let Some(first) = tables.first()
        && ALWAYS.contains(first)
        && root.get(first).is_none()
    {
        root.entries.push(Entry {
            name: (*first).into(),
            place: Location::Set,
            node: Node {
                value: Value::Table(Table::default()),
                place: Location::Set,
            },
        });
    }
    let Some((first, deeper)) = tables.split_first() else {
        root.set(last, node);
        return Ok(());
    };
    let mut at = match root.get_mut(first) {
        Some(entry) => &mut entry.node,
        None => return Err(absent_table(first)),
    };
    let mut walked = (*first).to_string();
    for name in deeper {
        at = step(at, name, &walked)?;
        walked = format!("{walked}.{name}");
    }
    match &mut at.value {
        Value::Table(table) => table.set(last, node),
        _ => *step(at, last, &walked)? = node,
    }
    Ok(())
}

fn absent_table(name: &str) -> SceneError {
    if name == "surface" {
        refuse("the scene has no [[surface]]; add one to the file first".into())
    } else {
        refuse(format!(
            "the scene has no [{name}]; add the table to the file first, or override all of it with '{name}={{ ... }}'"
        ))
    }
}

/// The value one level down; `walked` is the key up to here.
fn step<'a>(node: &'a mut Node, name: &str, walked: &str) -> Result<&'a mut Node, SceneError> {
    match &mut node.value {
        Value::Table(table) => match table.get_mut(name) {
            Some(entry) => Ok(&mut entry.node),
            None => Err(refuse(format!(
                "{walked} has no table {name} in this scene"
            ))),
        },
        Value::List(list) => {
            let count = list.len();
            let index = name.parse::<usize>().map_err(|_| {
                refuse(format!(
                    "{walked} is a list, so a number from 0 must follow it, as in {walked}.0, and not {name}"
                ))
            })?;
            list.get_mut(index).ok_or_else(|| {
                refuse(match count {
                    0 => format!("there is no {walked}.{name}: {walked} is empty"),
                    1 => format!("there is no {walked}.{name}: {walked} has one entry, {walked}.0"),
                    _ => format!(
                        "there is no {walked}.{name}: {walked} has {count} entries, numbered 0 to {}",
                        count - 1
                    ),
                })
            })
        }
        _ => Err(refuse(format!(
            "{walked} is a single value, so {name} cannot follow it"
        ))),
    }
}
