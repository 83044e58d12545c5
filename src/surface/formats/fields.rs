//! The fields of a line of text: what separates them, what is a comment, and which number one holds.

use std::ops::Range;

/// Separator of the numbers in a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Separator {
    Semicolon,
    Comma,
    /// Single tabs, so that an empty field is a missing pixel.
    Tab,
    /// Any run of blanks and tabs.
    Blanks,
}

/// Where the content of a line is. Tabs stay: they may separate missing numbers.
pub(super) fn content(line: &str) -> Range<usize> {
    let blanks = [' ', '\r', '\u{c}'];
    let text = split_comment(line).0.trim_end_matches(blanks);
    text.len() - text.trim_start_matches(blanks).len()..text.len()
}

/// A line's content and its comment, which begins at the start of the line or behind a separator: within a word or as a word of
/// its own `#` also marks a missing number (`1.#QNAN`, `#N/A`).
pub(super) fn split_comment(line: &str) -> (&str, &str) {
    let separates = |c: char| c.is_whitespace() || matches!(c, ',' | ';');
    let begins = |(at, _): &(usize, &str)| {
        let (before, rest) = line.split_at(*at);
        (rest.starts_with(['#', '%']) || rest.starts_with("//"))
            && before.chars().next_back().is_none_or(separates)
            && !is_cell_error(rest)
            && !is_after_one(before, rest)
    };
    match line.match_indices(['#', '%', '/']).find(begins) {
        Some((start, _)) => line.split_at(start),
        None => (line, ""),
    }
}

/// Whether the `#` of `rest` is that of Windows' `1,#QNAN` with a decimal comma.
fn is_after_one(before: &str, rest: &str) -> bool {
    let word = before.rsplit([' ', '\t', ';']).next().unwrap_or_default();
    let end = rest.find([' ', '\t', ';', ',']).unwrap_or(rest.len());
    word.ends_with(',') && windows_number(&format!("{word}{}", &rest[..end])).is_some()
}

/// Whether a text begins with an error of a spreadsheet where a number is due. A comment goes on with words.
fn is_cell_error(text: &str) -> bool {
    let mut words = text
        .split([' ', '\t', ',', ';', '\r'])
        .filter(|word| !word.is_empty());
    let goes_on = |word: &str| {
        let is_comment = word.starts_with(['#', '%']) || word.starts_with("//");
        is_comment || number(word, Separator::Blanks).is_some()
    };
    words.next().is_some_and(is_error_word) && words.next().is_none_or(goes_on)
}

/// Whether a word is an error of a spreadsheet, in any language: `#N/A`, `#NV`, `#VALUE!`, `#DIV/0!`, `#NAME?`.
fn is_error_word(word: &str) -> bool {
    let Some(name) = word.strip_prefix('#') else {
        return false;
    };
    let mut letters = name.chars();
    if let (Some(one), Some('/'), Some(other), None) = (
        letters.next(),
        letters.next(),
        letters.next(),
        letters.next(),
    ) {
        return one.is_uppercase() && other.is_uppercase();
    }
    let is_capital = |c: char| c.is_uppercase() || c.is_ascii_digit() || c == '/';
    let inside = name.strip_suffix(['!', '?']);
    name == "NV" || inside.is_some_and(|name| !name.is_empty() && name.chars().all(is_capital))
}

/// NaN and infinities as the C library of Windows writes them.
const WINDOWS: [&str; 4] = ["QNAN", "SNAN", "IND", "INF"];

/// First letters of these where they are rounded to fewer digits, as digits are: `1.#J` for `1.#INF`.
const ROUNDED: [char; 5] = ['I', 'J', 'Q', 'R', 'S'];

/// The number in a word such as `1.#QNAN` or `-1.#IND00`: infinite for `1.#INF`, else NaN.
fn windows_number(word: &str) -> Option<f64> {
    let (sign, size) = match word.strip_prefix('-') {
        Some(size) => (-1.0, size),
        None => (1.0, word.strip_prefix('+').unwrap_or(word)),
    };
    let is_comma = size.starts_with("1,#");
    let name = size.strip_prefix(if is_comma { "1,#" } else { "1.#" })?;
    let name = name.trim_end_matches('0').to_ascii_uppercase();
    let is_rounded = !is_comma
        && name.len() < 4
        && name.starts_with(ROUNDED)
        && name.chars().all(|c| c.is_ascii_alphanumeric());
    let value = match name.as_str() {
        "INF" => sign * f64::INFINITY,
        _ => f64::NAN,
    };
    (is_rounded || WINDOWS.contains(&name.as_str())).then_some(value)
}

/// Whether a line consists of words, none of them a number, and not of signs alone, which some programs write for missing numbers
/// (`--`). Quotes may stand round a decimal comma.
pub(super) fn is_words(line: &str) -> bool {
    let mut words = line
        .split([' ', '\t', ',', ';'])
        .map(|word| word.trim_matches('"'))
        .filter(|word| !word.is_empty())
        .peekable();
    line.contains(char::is_alphabetic)
        && words.peek().is_some()
        && words.all(|word| number(word, Separator::Blanks).is_none())
}

/// What separates words in the lines of a file.
pub(super) struct Marks {
    semicolons: bool,
    commas: bool,
    tabs: bool,
    blanks: bool,
    /// Whether a line has several words.
    several: bool,
    /// Whether all commas are decimal marks.
    decimal_commas: bool,
    /// Whether a comma stands before a zero and more digits, as in a fraction, not a number of its own.
    fractions: bool,
}

impl Default for Marks {
    fn default() -> Self {
        Marks {
            semicolons: false,
            commas: false,
            tabs: false,
            blanks: false,
            several: false,
            decimal_commas: true,
            fractions: false,
        }
    }
}

impl Marks {
    pub(super) fn take(&mut self, line: &str) {
        if line.contains(TWO_WORDS) {
            // The blank in it separates no words.
            return self.take(&line.replace(TWO_WORDS, NOT_AVAILABLE));
        }
        let comma = line.contains(',');
        self.semicolons |= line.contains(';');
        self.commas |= comma;
        self.tabs |= line.contains('\t');
        self.blanks |= line.contains(' ');
        self.several |= line.split_whitespace().nth(1).is_some();
        self.decimal_commas &= !comma || line.split_whitespace().all(has_decimal_comma);
        self.fractions |= comma && line.split(',').skip(1).any(is_fraction);
    }

    /// The separator of the file: the first of semicolon, comma, tab, blanks that it uses.
    pub(super) fn separator(&self) -> Separator {
        if self.semicolons {
            Separator::Semicolon
        } else if self.commas && !(self.decimal_commas && (self.several || self.fractions)) {
            // A single `1,5` on each line is taken as two numbers, if no line has `1,05`.
            Separator::Comma
        } else if self.tabs && !self.blanks {
            Separator::Tab
        } else {
            Separator::Blanks
        }
    }
}

/// Whether a word has no comma, or exactly one, between digits, as a decimal mark.
fn has_decimal_comma(word: &str) -> bool {
    word.split_once(',').is_none_or(|(whole, fraction)| {
        whole.ends_with(|c: char| c.is_ascii_digit())
            && fraction.starts_with(|c: char| c.is_ascii_digit() || c == '#')
            && !fraction.contains([',', '.'])
            && !whole.contains('.')
    })
}

/// Whether the digits behind a comma begin with a zero that no whole number has: `05`.
fn is_fraction(digits: &str) -> bool {
    digits
        .strip_prefix('0')
        .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
}

/// What some programs write for one missing number in two words.
const TWO_WORDS: &str = "#N/A N/A";
const NOT_AVAILABLE: &str = "#N/A";

/// The fields of a line.
pub(super) fn fields(text: &str, separator: Separator) -> Box<dyn Iterator<Item = &str> + '_> {
    match separator {
        Separator::Semicolon => Box::new(text.split(';')),
        Separator::Comma => Box::new(text.split(',')),
        Separator::Tab => Box::new(text.split('\t')),
        Separator::Blanks => Box::new(without_second_words(text.split_ascii_whitespace())),
    }
}

/// The words of a line, where [`TWO_WORDS`] are one.
fn without_second_words<'a>(words: impl Iterator<Item = &'a str>) -> impl Iterator<Item = &'a str> {
    let mut is_second = false;
    words.filter(move |word| {
        let is_left_out = is_second && *word == &NOT_AVAILABLE[1..];
        is_second = *word == NOT_AVAILABLE;
        !is_left_out
    })
}

/// The number in a field; NaN if it is missing, `None` if it is not a number.
pub(super) fn number(field: &str, separator: Separator) -> Option<f64> {
    let field = field.trim();
    let field = field
        .strip_prefix('"')
        .and_then(|field| field.strip_suffix('"'))
        .unwrap_or(field)
        .trim();
    if let Ok(value) = field.parse() {
        return Some(value);
    }
    if field.is_empty()
        || ["na", "n/a", TWO_WORDS]
            .iter()
            .any(|mark| field.eq_ignore_ascii_case(mark))
        || is_error_word(field)
    {
        return Some(f64::NAN);
    }
    if let Some(value) = windows_number(field) {
        return Some(value);
    }
    // A decimal comma, where commas do not separate; Fortran's exponent mark; the minus sign of spreadsheets in Scandinavia.
    let mut other: String = field
        .chars()
        .map(|c| match c {
            'd' | 'D' => 'e',
            '\u{2212}' => '-',
            other => other,
        })
        .collect();
    if separator != Separator::Comma && !other.contains('.') {
        other = other.replacen(',', ".", 1);
    }
    other.parse().ok()
}
