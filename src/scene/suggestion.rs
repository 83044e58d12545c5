//! What a misspelled word may have been meant to be.

/// Letters by which a word may differ from the one that is suggested.
const LETTERS: usize = 2;
/// Letters of a word that are compared.
const LONGEST: usize = 64;
/// Letters from which on the beginning of a word stands for it.
const BEGINNING: usize = 3;

/// The candidate that begins with a word, if there is just one, else the nearest within two letters.
pub(crate) fn suggestion(
    word: &str,
    candidates: impl Iterator<Item = &'static str>,
) -> Option<&'static str> {
    let word: String = word.to_lowercase().chars().take(LONGEST).collect();
    let candidates: Vec<&'static str> = candidates.collect();
    if word.chars().count() >= BEGINNING {
        let mut begun = candidates.iter().filter(|known| known.starts_with(&word));
        if let (Some(only), None) = (begun.next(), begun.next()) {
            return Some(only);
        }
    }
    let letters = |candidate: &str| strsim::damerau_levenshtein(&word, candidate);
    let near = |(letters, candidate): &(usize, &str)| {
        *letters <= LETTERS && *letters < word.chars().count().min(candidate.len())
    };
    candidates
        .into_iter()
        .map(|candidate| (letters(candidate), candidate))
        .filter(near)
        .min_by_key(|(letters, _)| *letters)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_beginnings_and_slips_of_two_letters_have_a_suggestion() {
        let words = || ["periodic", "free", "contact_modulus", "to", "tolerance"].into_iter();
        for (word, expected) in [
            ("preiodic", Some("periodic")),
            ("Free", Some("free")),
            ("contact_modulous", Some("contact_modulus")),
            ("contactmodul", None),
            ("modulus", None),
            ("open", None),
            ("x", None),
            ("ot", Some("to")),
            ("tol", Some("tolerance")),
            ("contact", Some("contact_modulus")),
        ] {
            assert_eq!(suggestion(word, words()), expected, "{word}");
        }
        // Two letters make "leak" of "wear", but it begins "leakage". What begins several words counts for none of them.
        let words = || ["wear", "leakage", "dmt-t", "dmt-ff"].into_iter();
        assert_eq!(suggestion("leak", words()), Some("leakage"));
        assert_eq!(suggestion("dmt", words()), Some("dmt-t"));
    }
}
