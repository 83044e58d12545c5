//! From a scene and its surface to the problem that is solved.

use super::plan::{Plan, Regime};
use crate::law::Law;
use crate::scene::{AdhesionScene, Boundary, Range, Scene, Treatment};
use crate::solver::Problem;
use crate::surface::{MapOutline, Outline, Source, Surface, statistics::Statistics};

/// Everything that the steps of a path share.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The scene.
    pub scene: Scene,
    /// Its surface.
    pub surface: Surface,
    /// Statistics of the surface.
    pub statistics: Statistics,
    /// The law in SI units; the hard wall without adhesion.
    pub law: Law,
    /// The reduced problem; without the law where the attraction is summed afterwards.
    pub problem: Problem,
    /// Whether attraction is summed over the gap of the solution without it.
    pub dmt: bool,
    /// Regime and resolution of the adhesion, where there is any.
    pub regime: Option<Regime>,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// Real two-dimensional transforms that the statistics took.
    pub transforms: f64,
}

/// Width of the automatic taper over `sigma0 dx/E*`, what a pixel of the peak tension opens.
///
/// The least at which a straight edge along the grid comes off within 1 % of the closed form; the table of
/// `docs/solver.md`.
pub const AUTO_TAPER: f64 = 6.0;

/// The law of a scene on pixels of side `pixel` (m), with what `auto` stands for where the map's
/// largest factor on the tension is `strongest`.
pub fn resolve_law(
    adhesion: &AdhesionScene,
    pixel: f64,
    contact_modulus: f64,
    strongest: f64,
) -> Law {
    let work = adhesion.work_of_adhesion;
    let resolved = (strongest * work * pixel / contact_modulus).sqrt();
    let range = match adhesion.range {
        Range::Length(range) => range,
        Range::Auto => adhesion.law.shortest_range() * resolved,
    };
    // Summed over a gap that does not feel it, the attraction traps nothing.
    let auto = match adhesion.treatment {
        Treatment::Full => AUTO_TAPER * strongest * (work / range) * pixel / contact_modulus,
        Treatment::Dmt => 0.0,
    };
    let taper = adhesion.taper.unwrap_or(auto).min(2.0 * range);
    adhesion.law.law(work, range, taper)
}

impl Setup {
    /// Puts a scene and its surface together.
    pub fn new(scene: Scene, surface: Surface) -> Self {
        let grid = surface.grid;
        let statistics = Statistics::of(&grid, &surface.heights, scene.grid.boundary);
        let outline = Outline {
            grid,
            moments: statistics.moments,
            source: Source::Heights,
            sphere_radius: surface.sphere_radius,
            map: surface.adhesion_map.as_deref().map(MapOutline::of),
            warnings: surface.warnings.clone(),
        };
        let Plan {
            scene,
            law,
            dmt,
            regime,
            warnings,
            ..
        } = Plan::new(scene, outline);
        let transforms = match scene.grid.boundary {
            Boundary::Periodic => 1.0,
            Boundary::Free => 0.0,
        };
        let problem = Problem::new(
            grid,
            scene.grid.boundary,
            scene.solid.contact_modulus,
            &surface.heights,
            statistics.moments.rms_slope(),
            if dmt { Law::HardWall } else { law },
        );
        let rated = scene.adhesion.as_ref().is_some_and(|a| a.rate.is_some());
        let problem = match &surface.adhesion_map {
            Some(factor) if !dmt => problem.patterned(factor.clone()),
            // Where an edge recedes there will be a factor.
            None if rated => problem.patterned(vec![1.0; grid.len()]),
            _ => problem,
        };
        let problem = match scene.solid.layer {
            Some(layer) => problem.on_layer(layer),
            None => problem,
        };
        let problem = match scene.solid.hardness {
            Some(hardness) => problem.yielding(hardness),
            None => problem,
        };
        let problem = match scene.conductance {
            Some(_) => problem.conducting(),
            None => problem,
        };
        Setup {
            warnings,
            scene,
            surface,
            statistics,
            law,
            problem,
            dmt,
            regime,
            transforms,
        }
    }

    /// The law that is solved for, SI; the hard wall where the attraction is summed afterwards.
    pub fn solved_law(&self) -> Law {
        if self.dmt { Law::HardWall } else { self.law }
    }

    /// Factor on the law's tension at a grid point.
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
        map.map_or(1.0, |map| map.iter().copied().fold(0.0, f64::max))
    }
}
