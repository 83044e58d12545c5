//! Choices of a scene: an enum whose values have a word each.

use crate::elastic::Base;
use crate::grid::Boundary;

/// A choice that a scene gives as a word.
pub(super) trait Word: Copy + 'static {
    /// Every value.
    const WORDS: &'static [Self];
    /// The word of a value.
    fn word(self) -> &'static str;
}

impl Word for Base {
    const WORDS: &'static [Self] = Base::ALL;
    fn word(self) -> &'static str {
        self.name()
    }
}

impl Word for Boundary {
    const WORDS: &'static [Self] = Boundary::ALL;
    fn word(self) -> &'static str {
        self.name()
    }
}

/// Declares an enum with the words of its values; `ALL` lists them, `name` tells the word of one.
macro_rules! words {
    (
        $(#[$meta:meta])*
        $Name:ident {
            $( $(#[$doc:meta])* $Value:ident = $word:literal, )+
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[non_exhaustive]
        pub enum $Name {
            $( $(#[$doc])* $Value, )+
        }

        impl $Name {
            /// Every value.
            pub const ALL: &[$Name] = &[$( $Name::$Value ),+];

            /// The word used in scenes.
            pub fn name(self) -> &'static str {
                match self {
                    $( $Name::$Value => $word, )+
                }
            }
        }

        impl serde::Serialize for $Name {
            fn serialize<S: serde::Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
                to.serialize_str(self.name())
            }
        }

        impl $crate::scene::words::Word for $Name {
            const WORDS: &'static [Self] = $Name::ALL;
            fn word(self) -> &'static str {
                self.name()
            }
        }
    };
}

pub(super) use words;
