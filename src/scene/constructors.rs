//! Scenes put together in Rust: what each table cannot do without, and defaults for the rest.

use std::path::PathBuf;

use super::capillary::{ROOM, water_at};
use super::loading::PULL_OFF_TOLERANCE;
use super::solid::plane_compliance;
use super::*;
use crate::elastic::Layer;

impl Scene {
    /// A scene of these parts, without adhesion and without any effect.
    pub fn new(
        grid: GridScene,
        solid: SolidScene,
        surfaces: Vec<SurfacePart>,
        loading: LoadingScene,
    ) -> Self {
        Scene {
            title: None,
            grid,
            solid,
            surfaces,
            adhesion: None,
            capillary: None,
            tables: EffectTables::default(),
            loading,
            solver: SolverScene::default(),
            output: OutputScene::default(),
            folder: PathBuf::new(),
        }
    }
}

impl GridScene {
    /// `points` = (nx, ny) points over `size` = (lx, ly), m, of a periodic cell.
    pub fn new(points: [usize; 2], size: [f64; 2]) -> Self {
        GridScene {
            points: Some(points),
            size: Some(size),
            boundary: Boundary::Periodic,
        }
    }

    /// The grid that a height file carries, of a periodic cell.
    pub fn from_file() -> Self {
        GridScene {
            points: None,
            size: None,
            boundary: Boundary::Periodic,
        }
    }

    /// Sets what lies beyond the edge.
    pub fn boundary(self, boundary: Boundary) -> Self {
        GridScene { boundary, ..self }
    }
}

impl SolidScene {
    /// An elastic half-space of a contact modulus E*, Pa, with the counter-face's share.
    pub fn new(contact_modulus: f64) -> Self {
        SolidScene {
            contact_modulus,
            poisson_ratio: None,
            layer: None,
            hardness: None,
            relaxation: Vec::new(),
        }
    }

    /// An elastic half-space of a Young modulus (Pa) and a Poisson ratio against a rigid counter-face:
    /// `1/E* = (1 - nu^2)/E`.
    pub fn from_young_modulus(young_modulus: f64, poisson_ratio: f64) -> Self {
        SolidScene {
            poisson_ratio: Some(poisson_ratio),
            ..SolidScene::new(1.0 / plane_compliance(young_modulus, poisson_ratio))
        }
    }

    /// The same against an elastic counter-face of a Young modulus (Pa) and a Poisson ratio:
    /// `1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2`.
    pub fn from_young_moduli(solid: [f64; 2], counter_face: [f64; 2]) -> Self {
        let [compliance, counter] =
            [solid, counter_face].map(|[modulus, ratio]| plane_compliance(modulus, ratio));
        SolidScene {
            poisson_ratio: Some(solid[1]),
            ..SolidScene::new(1.0 / (compliance + counter))
        }
    }

    /// A layer on a rigid base in place of the half-space.
    pub fn layer(self, layer: Layer) -> Self {
        SolidScene {
            poisson_ratio: Some(layer.poisson_ratio),
            layer: Some(layer),
            ..self
        }
    }
}

impl CapillaryScene {
    /// Water at 298.15 K that wets both surfaces, at a relative humidity from 0 to below 1.
    pub fn water(humidity: f64) -> Self {
        CapillaryScene::water_at(humidity, ROOM)
    }

    /// The same at another temperature, K, below the critical one of water, 647 K, with its surface tension and molar volume
    /// there.
    pub fn water_at(humidity: f64, temperature: f64) -> Self {
        let (surface_tension, molar_volume) = water_at(temperature);
        CapillaryScene {
            humidity,
            surface_tension,
            molar_volume,
            temperature,
            contact_angle: 0.0,
        }
    }
}

impl LoadingScene {
    /// A path of values in the unit of the control, one a step.
    pub fn new(control: Control, path: impl Into<Vec<f64>>) -> Self {
        LoadingScene {
            control,
            path: path.into(),
            durations: None,
            spring: None,
            pull_off_tolerance: PULL_OFF_TOLERANCE,
            until_apart: false,
        }
    }
}

impl HeightFileScene {
    /// A file of heights in metres, or in the unit that it says itself, taken as they are.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        HeightFileScene {
            path: path.into(),
            unit: 1.0,
            scale: 1.0,
            black: None,
            white: None,
            detrend: Detrend::None,
            fill: Fill::None,
            preparation: Preparation::default(),
        }
    }
}

impl SurfacePart {
    /// The heights of an array, m, shape `[ny, nx]`, row-major, of `points` = (nx, ny) points.
    pub fn from_heights(heights: impl AsRef<[f64]>, points: [usize; 2]) -> Self {
        SurfacePart::Heights(GridValues::new(heights, points))
    }

    /// A paraboloid of a radius of curvature, m, in the middle of the grid.
    pub fn sphere(radius: f64) -> Self {
        SurfacePart::Sphere {
            radius,
            centre: None,
        }
    }

    /// A cone of an angle between axis and flank, rad, in the middle of the grid.
    pub fn cone(half_angle: f64) -> Self {
        SurfacePart::Cone {
            half_angle,
            centre: None,
        }
    }
}

impl From<SelfAffineScene> for SurfacePart {
    fn from(rough: SelfAffineScene) -> Self {
        SurfacePart::SelfAffine(rough)
    }
}

impl From<HeightFileScene> for SurfacePart {
    fn from(file: HeightFileScene) -> Self {
        SurfacePart::File(file)
    }
}
