//! `[output]`: which pictures and fields are written, at which steps.

use super::document::Value;
use super::keys;
use super::mistake::SceneError;
use super::reader::Reader;
use super::{FieldName, OutputScene, StepChoice};

impl Default for OutputScene {
    fn default() -> Self {
        OutputScene {
            images: vec![FieldName::Pressure],
            fields: Vec::new(),
            steps: StepChoice::Last,
        }
    }
}

/// Reads `[output]`; checks step numbers against `path_length` if it is known.
pub(super) fn read(scene: &Reader, path_length: Option<usize>) -> Option<OutputScene> {
    let default = OutputScene::default();
    if !scene.has("output") {
        return Some(default);
    }
    let output = scene.table("output", &keys::OUTPUT)?;
    let images = output.or("images", default.images, |key| fields(&output, key));
    let fields = output.or("fields", default.fields, |key| fields(&output, key));
    let steps = steps(&output, path_length, default.steps);
    Some(OutputScene {
        images: images?,
        fields: fields?,
        steps: steps?,
    })
}

fn fields(output: &Reader, key: &str) -> Option<Vec<FieldName>> {
    let list = output.list(key, "a list of names")?;
    let read: Vec<Option<FieldName>> = list
        .iter()
        .map(|(name, node)| output.choice_in(node, key, name, FieldName::ALL, FieldName::name))
        .collect();
    for (index, field) in read.iter().enumerate() {
        if let Some(field) = field
            && read[..index].contains(&Some(*field))
        {
            output.conflict(
                key,
                format!("names \"{}\" twice; once is enough", field.name()),
            );
        }
    }
    read.into_iter().collect()
}

fn steps(output: &Reader, path_length: Option<usize>, default: StepChoice) -> Option<StepChoice> {
    const WORDS: &[&str] = &["last", "all"];
    let Some(node) = output.node("steps") else {
        return Some(default);
    };
    match &node.value {
        Value::Text(text) if text == "last" => Some(StepChoice::Last),
        Value::Text(text) if text == "all" => Some(StepChoice::All),
        Value::Text(_) => {
            output.choice("steps", WORDS, |word| word);
            None
        }
        Value::List(_) => {
            let list = output.list("steps", "a list")?;
            let read: Vec<Option<usize>> = list
                .iter()
                .map(|(name, node)| {
                    let step = output.whole_number_in(node, "steps", name, 1, i64::MAX)?;
                    let step = usize::try_from(step).ok()?;
                    match path_length {
                        Some(length) if step > length => {
                            let error = SceneError::OutOfRange {
                                found: step.to_string(),
                                allowed: format!("a step of the path, 1 to {length}"),
                            };
                            output.report_at(node.place, name, error);
                            None
                        }
                        _ => Some(step),
                    }
                })
                .collect();
            Some(StepChoice::List(read.into_iter().collect::<Option<_>>()?))
        }
        _ => {
            let error = SceneError::WrongType {
                found: node.described(),
                expected: "\"last\", \"all\" or a list of step numbers".into(),
                example: "steps = [1, 5]".into(),
            };
            output.report("steps", error);
            None
        }
    }
}
