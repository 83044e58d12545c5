//! What a misspelled word may have been meant to be.

/// Letters by which a word may differ from the one that is suggested.
const LETTERS: usize = 2;
/// Letters of a word that are compared.
const LONGEST: usize = 64;

/// The candidate within two letters of a word, if there is one: of several the nearest.
pub(crate) fn suggestion(
    word: &str,
    candidates: impl Iterator<Item = &'static str>,
) -> Option<&'static str> {
    let word: String = word.to_lowercase().chars().take(LONGEST).collect();
    let letters = |candidate: &str| strsim::damerau_levenshtein(&word, candidate);
    let near = |(letters, candidate): &(usize, &str)| {
        *letters <= LETTERS && *letters < word.chars().count().min(candidate.len())
    };
    candidates
        .map(|candidate| (letters(candidate), candidate))
        .filter(near)
        .min_by_key(|(letters, _)| *letters)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_slips_of_two_letters_have_a_suggestion() {
        let words = || ["periodic", "free", "contact_modulus", "to"].into_iter();
        for (word, expected) in [
            ("preiodic", Some("periodic")),
            ("Free", Some("free")),
            ("contact_modulous", Some("contact_modulus")),
            ("contactmodul", None),
            ("modulus", None),
            ("open", None),
            ("x", None),
            ("ot", Some("to")),
        ] {
            assert_eq!(suggestion(word, words()), expected, "{word}");
        }
    }
}
