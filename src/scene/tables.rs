//! Tables of effects that contain numbers only: one declaration gives type, keys, reader and summary.
//!
//! An entry has the table's name, its type, and for each key its dimension and an example. Every such key is
//! required, and its value is above 0. A word in brackets, read by its type, need not be given.

use serde_json::{Value, json};

use super::allowed::Allowed;
use super::conductance::Conduction;
use super::keys::{Key, Section};
use super::leakage::Axis;
use super::reader::Reader;
use crate::units::Dimension;

/// Declares the tables: their types, keys and reader, and how a summary shows them.
macro_rules! tables {
    ($(
        $(#[$doc:meta])*
        $table:ident: $Table:ident {
            $( $(#[$key_doc:meta])* $key:ident: $dimension:ident = $example:literal, )+
            $( [$(#[$word_doc:meta])* $word:ident: $Word:ident = $word_example:literal] )?
        }
    )+) => {
        $(
            $(#[$doc])*
            #[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
            pub struct $Table {
                $( $(#[$key_doc])* pub $key: f64, )+
                $(
                    $(#[$word_doc])*
                    pub $word: $Word,
                )?
            }

            impl $Table {
                const SECTION: &'static Section = &Section::new(
                    concat!("[", stringify!($table), "]"),
                    &[
                        $( (stringify!($key), concat!("\"", $example, "\"")), )+
                        $( (stringify!($word), concat!("\"", $word_example, "\"")), )?
                    ],
                );

                /// Reads the table: `Some(None)` if the scene has none, `None` after a mistake.
                fn read(scene: &Reader) -> Option<Option<Self>> {
                    if !scene.has(stringify!($table)) {
                        return Some(None);
                    }
                    let table = scene.table(stringify!($table), Self::SECTION)?;
                    let keys = &[$( stringify!($key) ),+];
                    table.require(keys);
                    // Each key is read before the table is given up, so that all mistakes are noted.
                    $( let $key = table.quantity(
                        stringify!($key), Dimension::$dimension, Allowed::POSITIVE,
                    ); )+
                    $( let $word = $Word::read(&table, keys); )?
                    Some(Some($Table { $( $key: $key?, )+ $( $word: $word?, )? }))
                }
            }
        )+

        /// Tables of effects that hold numbers alone; one that the scene does not name is `None`.
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct EffectTables {
            $( $(#[$doc])* pub $table: Option<$Table>, )+
        }

        /// The names of the tables as keys of a scene.
        pub(super) const NAMES: &[Key] = &[$(
            (stringify!($table), concat!("[", stringify!($table), "]")),
        )+];

        /// The keys of each table.
        pub(super) const SECTIONS: &[&Section] = &[$( $Table::SECTION ),+];

        impl EffectTables {
            /// Reads every table before any is given up.
            pub(super) fn read(scene: &Reader) -> Option<EffectTables> {
                $( let $table = $Table::read(scene); )+
                Some(EffectTables { $( $table: $table? ),+ })
            }

            /// The tables that are there, with their names.
            pub(super) fn resolved(&self) -> Vec<(&'static str, Value)> {
                let tables = [$(
                    (stringify!($table), self.$table.map(|table| json!(table))),
                )+];
                tables
                    .into_iter()
                    .filter_map(|(name, table)| Some((name, table?)))
                    .collect()
            }

            /// The SI unit of a key of one of the tables; `None` for other keys.
            pub fn unit(key: &str) -> Option<&'static str> {
                $( $(
                    if key == stringify!($key) {
                        return Some(Dimension::$dimension.unit());
                    }
                )+ )+
                None
            }
        }
    };
}

tables! {
    /// `[friction]`: a shear strength of the contact area.
    friction: FrictionScene {
        /// Shear strength of the area in contact, Pa.
        shear_strength: Pressure = "10 MPa",
    }
    /// `[conductance]`: conductivities for heat or for a current.
    conductance: ConductanceScene {
        /// Conductivity of the solid, W/(m K) or S/m.
        conductivity: Conductivity = "400 W/(m K)",
        /// Conductivity of the counter-face, W/(m K) or S/m.
        counter_conductivity: Conductivity = "1.4 W/(m K)",
        [
            /// Whether heat is conducted or a current; units say it too.
            kind: Conduction = "electrical"
        ]
    }
    /// `[wear]`.
    wear: WearScene {
        /// Volume worn off per load and length of sliding, m^3/(N m).
        specific_wear_rate: SpecificWear = "1e-6 mm^3/(N m)",
    }
    /// `[leakage]`: a fluid between the surfaces.
    leakage: LeakageScene {
        /// Viscosity of the fluid, Pa s.
        viscosity: Viscosity = "1 mPa s",
        [
            /// Where it flows to.
            axis: Axis = "y"
        ]
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::scene::Scene;

    fn scene(table: &str) -> String {
        format!(
            "[grid]\npoints = 8\nsize = 1e-6\n[solid]\ncontact_modulus = 1e9\n[[surface]]\nkind = \"flat\"\n\
             [loading]\ncontrol = \"pressure\"\npath = [1e3]\n{table}\n"
        )
    }

    /// A word that the scene leaves out is resolved, as other defaults are: a resumed run named a word of before as missing.
    #[test]
    fn words_that_are_left_out_are_resolved() {
        let text = scene(
            "[conductance]\nconductivity = 1\ncounter_conductivity = 1\n[leakage]\nviscosity = 1",
        );
        let found = Scene::parse(&text, "s.toml", Path::new("."), &[]).expect("a scene");
        let resolved = found.resolved_json();
        assert_eq!(resolved["conductance"]["kind"], "thermal");
        assert_eq!(resolved["leakage"]["axis"], "x");
    }

    /// A unit that is wrong says nothing of what is conducted.
    #[test]
    fn a_wrong_unit_is_one_mistake() {
        let text =
            scene("[conductance]\nconductivity = \"60 W/m\"\ncounter_conductivity = \"1e7 S/m\"");
        let errors = Scene::parse(&text, "s.toml", Path::new("."), &[]).expect_err("a unit");
        assert_eq!(errors.0.len(), 1, "{errors}");
        assert_eq!(errors.0[0].key, "conductance.conductivity");
    }
}
