//! From a scene and its surface to the problem that is solved.

use std::sync::Arc;

use super::control::Controller;
use super::cut_edges::CutEdges;
use super::hooks::{Effects, Hooks};
use super::plan::Plan;
use super::regime::Regime;
use super::row::Column;
use crate::backend::ranks::Ranks;
use crate::law::Law;
use crate::scene::{Boundary, Control, Scene};
use crate::solver::Problem;
use crate::surface::statistics::Statistics;
use crate::surface::{MapOutline, Outline, Source, Surface, depths_of_highest, has_flats};
use crate::units::format_si;

/// Everything that the steps of a path share.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The scene.
    pub scene: Scene,
    /// Its surface, of several ranks this one's rows.
    pub surface: Surface,
    /// Statistics of the surface.
    pub statistics: Statistics,
    /// The law in SI units; the hard wall without adhesion.
    pub law: Law,
    /// The reduced problem; without the law where the attraction is summed afterwards.
    pub problem: Arc<Problem>,
    /// Regime and resolution of the adhesion, where there is any.
    pub regime: Option<Regime>,
    /// Warnings.
    pub warnings: Vec<String>,
    /// Real two-dimensional transforms that the statistics took.
    pub transforms: f64,
    /// The effects that the scene asks for.
    pub(super) effects: Effects,
    /// The edges that cut the surface off.
    pub(super) cut_edges: CutEdges,
}

impl Setup {
    /// Puts a scene and its surface together, with those of a list of effects that the scene asks for.
    ///
    /// Of several ranks each is given its rows of the surface.
    pub(crate) fn with_effects(
        all: &[&'static dyn Hooks],
        scene: Scene,
        surface: Surface,
        ranks: Option<Arc<dyn Ranks>>,
    ) -> Self {
        let grid = surface.grid;
        let share = Problem::share(&grid, scene.grid.boundary, ranks);
        let heights = surface.heights.as_slice();
        let statistics = Statistics::of_share(&grid, &share, heights, scene.grid.boundary);
        let cut_edges = CutEdges::from_surface(&surface, &share, scene.grid.boundary);
        let outline = Outline {
            grid,
            moments: statistics.moments,
            source: Source::Heights,
            top: surface.top,
            has_flats: has_flats(heights, &share),
            highest: match scene.attracts() {
                true => depths_of_highest(heights, &share),
                false => Vec::new(),
            },
            map: surface
                .adhesion_map
                .as_deref()
                .map(|map| MapOutline::from_factors(map, &share)),
            warnings: surface.warnings.clone(),
        };
        let Plan {
            scene,
            law,
            regime,
            warnings,
            effects,
            ..
        } = Plan::with_effects(all, scene, outline);
        let transforms = match scene.grid.boundary {
            Boundary::Periodic => 1.0,
            Boundary::Free => 0.0,
        };
        let problem = Problem::sharing(
            share,
            grid,
            scene.grid.boundary,
            scene.solid.contact_modulus,
            surface.heights.clone(),
            statistics.moments.rms_slope(),
            effects.solved_law(law),
        );
        let problem = effects.pose(problem, &scene, surface.adhesion_map.as_deref());
        let mut setup = Setup {
            warnings,
            scene,
            surface,
            statistics,
            law,
            problem: Arc::new(problem),
            regime,
            transforms,
            effects,
            cut_edges,
        };
        setup.warnings.extend(setup.beyond_closure());
        setup
    }

    /// A warning of a path that would end early, at a position that no contact has. The first step says so itself.
    fn beyond_closure(&self) -> Option<String> {
        let controller = Controller::new(self, &self.problem);
        let mut steps = self.scene.loading.path.iter().zip(1..).skip(1);
        let (value, step) = steps.find(|(value, _)| controller.is_beyond_closure(**value))?;
        let what = match self.scene.loading.control {
            Control::MeanGap => "a mean gap",
            _ => "an approach",
        };
        Some(format!(
            "step {step} prescribes {what} of {}, and the surfaces are closed everywhere at {}: the path ends there; end it earlier",
            format_si(*value, "m"),
            format_si(controller.closure()?, "m"),
        ))
    }

    /// The law that is solved for, SI; the hard wall where the attraction is summed afterwards.
    pub fn solved_law(&self) -> Law {
        self.effects.solved_law(self.law)
    }

    /// Whether attraction is summed over the gap of the solution without it.
    pub fn sums_attraction(&self) -> bool {
        self.solved_law() != self.law
    }

    /// Columns of `curve.csv` that the scene's effects ask for, in their order.
    pub fn columns(&self) -> Vec<Column> {
        self.effects.columns(&self.scene)
    }

    /// Spring between a prescribed approach and the body, N/m.
    pub(crate) fn spring(&self) -> Option<f64> {
        self.effects.spring(&self.scene)
    }

    /// Factor on the law's tension at a held grid point.
    #[inline]
    pub fn law_factor(&self, point: usize) -> f64 {
        match &self.surface.adhesion_map {
            Some(map) => map[point],
            None => 1.0,
        }
    }

    /// The largest factor on the law's tension.
    pub fn largest_law_factor(&self) -> f64 {
        let map = self.surface.adhesion_map.as_deref();
        map.map_or(1.0, |map| self.problem.share.greatest_of(map).max(0.0))
    }
}
