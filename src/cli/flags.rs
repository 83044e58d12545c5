//! The options of the command line in place of what the library says in words.

/// Phrases of the library, and the same with the option.
const OPTIONS: &[(&str, &str)] = &[
    ("file; name a folder", "file; name a folder with --out"),
    (
        "name an empty or new folder",
        "name an empty or new folder with --out",
    ),
    ("name another folder", "name another folder with --out"),
    ("name another output", "name another one with --out"),
    (
        "into another folder writes",
        "into another folder (--out) writes",
    ),
    (
        "without resuming to start afresh",
        "without --resume to start afresh",
    ),
    ("resuming starts at step", "--resume starts at step"),
    ("resuming continues after", "--resume continues after"),
    ("give a longer budget", "give a longer --budget"),
    ("do not fit the baseline if", "leave --baseline out if"),
    (
        "w is that alone; fit the baseline",
        "w is that alone; --baseline fits it",
    ),
    ("or do not fit the slope", "or leave --baseline-slope out"),
    (
        "choose one of these, or a number from 1",
        "choose one of these with --columns, or a number from 1",
    ),
    (
        "fit a relaxation time beside",
        "--relaxation fits a relaxation time beside",
    ),
    ("choose none", "leave --columns out"),
    (
        "needs the spring constant of the cantilever",
        "needs the spring constant of the cantilever (--spring)",
    ),
    ("give its sensitivity,", "give its --sensitivity,"),
    ("Device::cpu()", "--backend cpu"),
    (", from an override", ", from --set"),
    (
        "such as surface.0.hurst=0.4",
        "such as --set surface.0.hurst=0.4",
    ),
    ("override all of it with", "set all of it with --set"),
];

/// A message of the library for those who call the program.
pub(super) fn with_options(message: &str) -> String {
    OPTIONS
        .iter()
        .fold(message.to_owned(), |text, (words, option)| {
            text.replace(words, option)
        })
}

/// Keys of a height file in messages, and the options of `tabor surface`.
const FILE_OPTIONS: &[(&str, &str)] = &[
    ("write profile = true", "give --profile"),
    ("write fill = \"interpolate\"", "give --fill interpolate"),
    (
        "write black and white, the heights of its ends (black = 0, white = \"1 um\")",
        "give --black and --white, the heights of its ends (--black 0 --white \"1 um\")",
    ),
    (
        "black and white are for grey images",
        "--black and --white are for grey images",
    ),
    ("detrend = \"plane\"", "--detrend plane"),
    (
        "edges = \"window\" or \"mirror\"",
        "--edges window or --edges mirror",
    ),
    ("boundary = \"free\"", "--boundary free"),
    (", crop leaves", ", --crop leaves"),
    ("[grid] size", "--size"),
    ("leave size out", "leave --size out"),
];

/// Those of them that take a list, in a scene in brackets.
const LISTS: [&str; 2] = ["crop", "resample"];

/// A message about a height file for those who gave it to `tabor surface`.
pub(super) fn with_file_options(message: &str) -> String {
    let words = FILE_OPTIONS
        .iter()
        .fold(message.to_owned(), |text, (words, option)| {
            text.replace(words, option)
        });
    LISTS.iter().fold(words, |words, key| {
        let list = words.split_once(&format!("{key} = ["));
        let list = list.and_then(|(before, after)| Some((before, after.split_once(']')?)));
        match list {
            Some((before, (values, after))) => format!("{before}--{key} \"{values}\"{after}"),
            None => words,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_a_scene_are_told_as_options() {
        for (message, told) in [
            (
                "leave them out with crop = [1, 1, 5, 4]",
                "leave them out with --crop \"1, 1, 5, 4\"",
            ),
            (
                "or give the file resample = [nx, ny]",
                "or give the file --resample \"nx, ny\"",
            ),
            ("crop = [1 and no end", "crop = [1 and no end"),
        ] {
            assert_eq!(with_file_options(message), told);
        }
    }
}
