//! Escapes text from files, scenes and calls for display, so that it cannot move the cursor, change
//! colours or reverse the writing direction.

use std::borrow::Cow;

/// `text` with its control characters escaped, as in `\u{1b}`; line ends stay.
///
/// Unicode's bidirectional controls, which can disguise a name, are escaped too.
pub fn visible(text: &str) -> Cow<'_, str> {
    if !text.chars().any(hides) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if hides(character) {
            shown.extend(character.escape_default())
        } else {
            shown.push(character)
        }
    }
    Cow::Owned(shown)
}

/// The same on one line, with line ends escaped.
pub fn visible_line(text: &str) -> String {
    visible(text).replace('\n', "\\n")
}

fn hides(character: char) -> bool {
    match character {
        '\n' => false,
        '\u{61c}' | '\u{200e}' | '\u{200f}' => true,
        '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => true,
        other => other.is_control(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_control_characters_are_escaped() {
        let plain = "rms height 707.1 pm, µ, 高さ, \"a\\b\"\nnext";
        assert!(matches!(visible(plain), Cow::Borrowed(same) if same == plain));
        assert_eq!(
            visible("a\u{1b}[31mb\r\u{7}\t\u{7f}\u{9b}2J\u{202e}c\0"),
            "a\\u{1b}[31mb\\r\\u{7}\\t\\u{7f}\\u{9b}2J\\u{202e}c\\u{0}"
        );
        assert_eq!(visible_line("a\nerror: b"), "a\\nerror: b");
    }
}
