//! The cohesive laws as they are given in Rust, each with what it cannot do without.

use super::{AdhesionMap, AdhesionScene, LawName, Range, RateScene, Treatment};

/// Constant tension up to a range, with a wall behind it: the law of Maugis and Dugdale.
///
/// ```
/// use tabor::{MaugisDugdale, Range};
///
/// let law = MaugisDugdale::new(0.05, 20e-9); // 50 mJ/m^2 over 20 nm, so 2.5 MPa
/// let shortest = MaugisDugdale::new(0.05, Range::Auto); // the shortest range that the grid resolves
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaugisDugdale {
    work_of_adhesion: f64,
    range: Range,
    taper: Option<f64>,
}

impl MaugisDugdale {
    /// The law of a work of adhesion (J/m^2) and a range (m), which is the work over the tension.
    pub fn new(work_of_adhesion: f64, range: impl Into<Range>) -> Self {
        MaugisDugdale {
            work_of_adhesion,
            range: range.into(),
            taper: None,
        }
    }

    /// The law of a work of adhesion (J/m^2) and a tension (Pa).
    pub fn from_peak_tension(work_of_adhesion: f64, peak_tension: f64) -> Self {
        MaugisDugdale::new(work_of_adhesion, work_of_adhesion / peak_tension)
    }

    /// Sets the width over which the tension falls to 0 about the range, m, at most twice the range; 0 is a
    /// sharp fall. By default it is what keeps the pixels from trapping the contact edge.
    pub fn taper(self, taper: f64) -> Self {
        MaugisDugdale {
            taper: Some(taper),
            ..self
        }
    }
}

/// Laws of a work of adhesion and a range alone.
macro_rules! laws {
    ($( $(#[$doc:meta])* $Name:ident($(#[$range_doc:meta])*); )+) => {
        $(
            $(#[$doc])*
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct $Name {
                work_of_adhesion: f64,
                range: Range,
            }

            impl $Name {
                $(#[$range_doc])*
                pub fn new(work_of_adhesion: f64, range: impl Into<Range>) -> Self {
                    let range = range.into();
                    $Name { work_of_adhesion, range }
                }

                /// The law of a work of adhesion (J/m^2) and its greatest tension (Pa).
                pub fn from_peak_tension(work_of_adhesion: f64, peak_tension: f64) -> Self {
                    let range = work_of_adhesion * LawName::$Name.shape() / peak_tension;
                    $Name::new(work_of_adhesion, range)
                }
            }

            impl From<$Name> for AdhesionScene {
                fn from(law: $Name) -> Self {
                    AdhesionScene::new(LawName::$Name, law.work_of_adhesion, law.range)
                }
            }
        )+
    };
}

laws! {
    /// The 9-3 law between surfaces, with its own repulsion: gaps are measured from where it pulls and pushes
    /// equally, and may be negative.
    LennardJones(
        /// The law of a work of adhesion (J/m^2) and the distance of equilibrium (m).
    );
    /// Tension that falls as `exp(-gap/range)`, with a wall behind it.
    Exponential(
        /// The law of a work of adhesion (J/m^2) and a range (m), which is the work over the greatest tension.
    );
}

impl From<f64> for Range {
    fn from(length: f64) -> Self {
        Range::Length(length)
    }
}

impl AdhesionScene {
    /// A law by its name, with its work of adhesion (J/m^2) and its range (m): solved together with the
    /// contact, the same everywhere and at every speed.
    pub fn new(law: LawName, work_of_adhesion: f64, range: impl Into<Range>) -> Self {
        AdhesionScene {
            law,
            work_of_adhesion,
            range: range.into(),
            taper: None,
            treatment: Treatment::Full,
            map: None,
            rate: None,
        }
    }

    /// How the attraction is found; by default together with the contact.
    pub fn treatment(self, treatment: Treatment) -> Self {
        AdhesionScene { treatment, ..self }
    }

    /// A factor on the tension at each point.
    pub fn map(self, map: AdhesionMap) -> Self {
        AdhesionScene {
            map: Some(map),
            ..self
        }
    }

    /// How the work of adhesion grows with the speed of a receding edge.
    pub fn rate(self, rate: RateScene) -> Self {
        AdhesionScene {
            rate: Some(rate),
            ..self
        }
    }
}

impl From<MaugisDugdale> for AdhesionScene {
    fn from(law: MaugisDugdale) -> Self {
        AdhesionScene {
            taper: law.taper,
            ..AdhesionScene::new(LawName::MaugisDugdale, law.work_of_adhesion, law.range)
        }
    }
}
