//! Plans, setups and costs with the effects of this version: the functions of `study`, called with their list.

use std::sync::Arc;

use super::LIST;
use crate::backend::ranks::Ranks;
use crate::backend::{BackendError, dry_run::Place};
use crate::grid::Grid;
use crate::scene::Scene;
use crate::solver::good_size;
use crate::study::{Column, Cost, Effects, Memory, Plan, Setup};
use crate::surface::{Outline, Surface, SurfaceError};

/// Points that the sizes of a suggested grid are multiples of.
const STRIDE: usize = 4;

impl Plan {
    /// Plans a scene. Heights are built for a height file only.
    ///
    /// # Errors
    /// A surface that cannot be built.
    pub fn for_scene(scene: Scene) -> Result<Plan, SurfaceError> {
        let outline = Outline::from_scene(&scene)?;
        Ok(Plan::new(scene, outline))
    }

    /// Puts a scene and the outline of its surface together.
    pub fn new(scene: Scene, outline: Outline) -> Plan {
        Plan::with_effects(&LIST, scene, outline)
    }
}

impl Setup {
    /// Puts a scene and its surface together.
    pub fn new(scene: Scene, surface: Surface) -> Setup {
        Setup::with_effects(&LIST, scene, surface, None)
    }

    /// The same on one of several ranks, with its rows of the surface.
    pub fn on_ranks(scene: Scene, surface: Surface, ranks: Option<Arc<dyn Ranks>>) -> Setup {
        Setup::with_effects(&LIST, scene, surface, ranks)
    }
}

impl Column {
    /// Columns that the effects of a scene ask for, in their order.
    pub fn for_scene(scene: &Scene) -> Vec<Column> {
        Effects::on(&LIST, scene).columns(scene)
    }
}

impl Cost {
    /// The cost of a scene on a grid: without heights, and without memory for any.
    ///
    /// # Errors
    /// As [`Cost::for_setup`].
    pub fn for_scene(scene: &Scene, grid: Grid, place: Place) -> Result<Cost, BackendError> {
        Cost::with_effects(&Effects::on(&LIST, scene), scene, grid, place)
    }
}

impl Memory {
    /// The grid of the same shape, to a few points, with the most of them whose run takes at most
    /// `available` bytes of this machine's memory; `None` where not even the smallest does. Sizes
    /// are multiples of 4, which a coarse grid halves, and transform well along x.
    ///
    /// # Errors
    /// As [`Cost::for_scene`].
    pub fn largest_grid(
        scene: &Scene,
        grid: Grid,
        available: u64,
    ) -> Result<Option<[usize; 2]>, BackendError> {
        let scaled = |nx: usize| -> [usize; 2] {
            let ny = nx as f64 * grid.ny as f64 / grid.nx as f64;
            let ny = (ny / STRIDE as f64).round() as usize * STRIDE;
            [nx, ny.max(STRIDE).min(grid.ny)]
        };
        let fits = |points: [usize; 2]| -> Result<bool, BackendError> {
            let grid = Grid::new(points, [grid.lx, grid.ly]);
            let cost = Cost::for_scene(scene, grid, Place::for_scene(scene, &grid))?;
            Ok(Memory::new(scene, grid, &cost).machine <= available)
        };
        let sizes: Vec<usize> = (STRIDE..=grid.nx)
            .step_by(STRIDE)
            .filter(|&size| good_size(size) == size)
            .collect();
        let (mut fitting, mut beyond) = (0, sizes.len());
        while fitting < beyond {
            let middle = (fitting + beyond) / 2;
            if fits(scaled(sizes[middle]))? {
                fitting = middle + 1;
            } else {
                beyond = middle;
            }
        }
        Ok(fitting.checked_sub(1).map(|last| scaled(sizes[last])))
    }
}
