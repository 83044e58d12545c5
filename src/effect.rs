//! Effects: what a scene may ask for beyond hard, frictionless, elastic contact of a periodic cell.
//!
//! An effect that the scene does not name is not there: it holds no field and makes no pass. What
//! one costs is found by planning the scene with and without it.

use crate::backend::BackendError;
use crate::grid::Grid;
use crate::scene::{Boundary, Scene, Treatment};
use crate::study::Cost;

/// An effect of this version.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// `[adhesion]`: a cohesive law acts across the gap.
    Adhesion,
    /// `treatment = "dmt"`: attraction is summed over the gap of the solution without it.
    Dmt,
    /// `boundary = "free"`: one isolated contact on an unbounded half-space.
    FreeBoundary,
    /// `spring`: the approach acts through a cantilever.
    Spring,
}

/// What an effect adds to a scene's cost and what it takes away.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EffectCost {
    /// Fields that are there because of it.
    pub fields_added: Vec<&'static str>,
    /// Fields that are not there because of it.
    pub fields_spared: Vec<&'static str>,
    /// Passes of an iteration that are there because of it.
    pub passes_added: Vec<&'static str>,
    /// Passes that are not there because of it.
    pub passes_spared: Vec<&'static str>,
    /// Bytes more, or less.
    pub bytes: i128,
}

impl Effect {
    /// Every effect of this version.
    pub const ALL: [Effect; 4] = [
        Effect::Adhesion,
        Effect::Dmt,
        Effect::FreeBoundary,
        Effect::Spring,
    ];

    /// Its name in summaries.
    pub fn name(self) -> &'static str {
        match self {
            Effect::Adhesion => "adhesion",
            Effect::Dmt => "dmt treatment",
            Effect::FreeBoundary => "free boundary",
            Effect::Spring => "spring",
        }
    }

    /// What it does, in a line.
    pub fn purpose(self) -> &'static str {
        match self {
            Effect::Adhesion => "the surfaces attract across the gap by a cohesive law",
            Effect::Dmt => {
                "attraction is summed over the gap of the contact without it, which it does not deform"
            }
            Effect::FreeBoundary => {
                "one isolated contact on an unbounded half-space, on twice the points each way"
            }
            Effect::Spring => {
                "the approach is prescribed at the far end of a spring, so contacts snap in and off"
            }
        }
    }

    /// Whether a scene asks for it.
    pub fn is_on(self, scene: &Scene) -> bool {
        match self {
            Effect::Adhesion => scene.adhesion.is_some(),
            Effect::Dmt => scene
                .adhesion
                .as_ref()
                .is_some_and(|adhesion| adhesion.treatment == Treatment::Dmt),
            Effect::FreeBoundary => scene.grid.boundary == Boundary::Free,
            Effect::Spring => scene.loading.spring.is_some(),
        }
    }

    /// The scene without it.
    pub fn taken_from(self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        match self {
            Effect::Adhesion => scene.adhesion = None,
            Effect::Dmt => {
                if let Some(adhesion) = &mut scene.adhesion {
                    adhesion.treatment = Treatment::Full;
                }
            }
            Effect::FreeBoundary => scene.grid.boundary = Boundary::Periodic,
            Effect::Spring => scene.loading.spring = None,
        }
        scene
    }

    /// What it costs in a scene that asks for it, of which `with` is the cost on `grid`.
    ///
    /// # Errors
    /// As [`Cost::of_scene`].
    pub fn cost(self, scene: &Scene, with: &Cost, grid: Grid) -> Result<EffectCost, BackendError> {
        let without = Cost::of_scene(&self.taken_from(scene), grid, with.place)?;
        let names = |cost: &Cost| {
            cost.fields
                .iter()
                .map(|field| field.name)
                .collect::<Vec<_>>()
        };
        Ok(EffectCost {
            fields_added: difference(&names(with), &names(&without)),
            fields_spared: difference(&names(&without), &names(with)),
            passes_added: difference(&with.passes, &without.passes),
            passes_spared: difference(&without.passes, &with.passes),
            bytes: with.bytes() as i128 - without.bytes() as i128,
        })
    }
}

/// What is in `left` more often than in `right`.
fn difference(left: &[&'static str], right: &[&'static str]) -> Vec<&'static str> {
    let mut rest = right.to_vec();
    left.iter()
        .copied()
        .filter(|name| match rest.iter().position(|other| other == name) {
            Some(place) => {
                rest.swap_remove(place);
                false
            }
            None => true,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_count() {
        assert_eq!(difference(&["a", "b", "a"], &["a", "c"]), ["b", "a"]);
        assert!(difference(&["a"], &["a", "a"]).is_empty());
    }
}
