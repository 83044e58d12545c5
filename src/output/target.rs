//! Where a command may write: what would be lost there is refused before anything is written.

use std::fs;
use std::path::Path;

use super::error::OutputError;

/// Refuses a file at `path` that does not begin with `head`, the first line of a table of tabor, and a folder of it that
/// is a file.
pub fn expect_table(path: &Path, head: &str) -> Result<(), OutputError> {
    if path.parent().is_some_and(Path::is_file) {
        let reason = "its folder is a file; name a folder";
        return Err(OutputError::refused(path, reason));
    }
    if fs::read(path).is_ok_and(|old| !old.starts_with(head.as_bytes())) {
        let reason =
            "would be overwritten, and is not an earlier table of this kind; name another output";
        return Err(OutputError::refused(path, reason));
    }
    Ok(())
}

/// Refuses each of `outputs`, files or folders, that is one of `inputs` or holds one, by whatever names and links.
///
/// What is not there yet is neither.
#[cfg(feature = "cli")]
pub fn expect_apart<'a>(
    outputs: impl IntoIterator<Item = impl AsRef<Path>>,
    inputs: impl IntoIterator<Item = &'a Path>,
) -> Result<(), OutputError> {
    let place = |path: &Path| fs::canonicalize(path).ok();
    let inputs: Vec<_> = inputs
        .into_iter()
        .filter_map(|input| Some((input, place(input)?)))
        .collect();
    for output in outputs {
        let output = output.as_ref();
        let Some(target) = place(output) else {
            continue;
        };
        if let Some((input, at)) = inputs.iter().find(|(_, at)| at.starts_with(&target)) {
            let reason = if *at == target {
                "is read here, and would be overwritten; name another output".to_owned()
            } else {
                let input = input.display();
                format!(
                    "holds {input}, which is read here and might be overwritten; name another output"
                )
            };
            return Err(OutputError::refused(output, reason));
        }
    }
    Ok(())
}

#[cfg(all(test, feature = "cli"))]
mod tests {
    use super::*;

    #[test]
    fn no_output_is_an_input_or_holds_one() {
        let place = tempfile::tempdir().unwrap();
        let at = |name: &str| place.path().join(name);
        fs::create_dir(at("in")).unwrap();
        fs::write(at("in/curve.csv"), "mine").unwrap();
        let read = at("in/curve.csv");
        let refused = |output: &str| {
            let tried = expect_apart([at("in/curve.svg"), at(output)], [read.as_path()]);
            tried.map_err(|error| error.to_string()).err()
        };
        for output in ["in/curve.csv", "in/../in/./curve.csv"] {
            let message = refused(output).unwrap();
            assert!(message.contains("is read here"), "{message}");
        }
        let message = refused("in").unwrap();
        assert!(message.contains("holds"), "{message}");
        for output in ["in/curve", "in/curve.csv.png", "curve.csv"] {
            assert_eq!(refused(output), None, "{output}");
        }
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(&read, at("link.csv")).unwrap();
            std::os::unix::fs::symlink(at("in"), at("same")).unwrap();
            assert!(refused("link.csv").is_some());
            assert!(refused("same/curve.csv").is_some());
        }
    }
}
