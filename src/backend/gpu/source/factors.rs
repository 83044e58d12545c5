//! The factors of the columns: read from a table, or computed where they are used.

use std::fmt::Write;

use super::super::catalogue;
use super::super::level::LevelPlan;
use crate::backend::{Factors, Response};

/// Constants that a spectrum without a table binds in its place: the factor of the zero wavevector and
/// the two steps of the half-space's wavevectors.
pub const OWN_FACTORS: usize = 3;

/// How a shader obtains a spectrum's factors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FactorSource {
    /// From a table, one number for each wavevector.
    Table,
    /// The stiffness of a half-space.
    Stiffness,
    /// Its compliance.
    Compliance,
}

impl FactorSource {
    /// All variants.
    pub const ALL: [FactorSource; 3] = [
        FactorSource::Table,
        FactorSource::Stiffness,
        FactorSource::Compliance,
    ];

    /// The source of a spectrum's factors.
    pub fn new(factors: &Factors) -> Self {
        match factors {
            Factors::Table(_) | Factors::Each(_) => FactorSource::Table,
            Factors::HalfSpace(_, Response::Stiffness) => FactorSource::Stiffness,
            Factors::HalfSpace(_, Response::Compliance) => FactorSource::Compliance,
        }
    }

    /// Defines `factor_of`, the factor of a column of the grid and a row up to the middle one.
    pub(super) fn define(self, source: &mut String, plan: &LevelPlan) {
        let parts: &[&str] = match self {
            FactorSource::Table => {
                let first = match plan.parts {
                    1 => "0u".to_string(),
                    _ => format!("slab.number * {}u", plan.part_columns()),
                };
                let _ = writeln!(
                    source,
                    "const FACTOR_ROWS: u32 = {}u;\n\
                     fn first_column() -> u32 {{ return {first}; }}",
                    plan.shape[1] / 2 + 1
                );
                &[catalogue::FACTOR_TABLE]
            }
            FactorSource::Stiffness => &[catalogue::HALF_SPACE, catalogue::FACTOR_STIFFNESS],
            FactorSource::Compliance => &[catalogue::HALF_SPACE, catalogue::FACTOR_COMPLIANCE],
        };
        parts.iter().for_each(|part| source.push_str(part));
    }
}
