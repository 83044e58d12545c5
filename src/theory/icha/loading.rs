//! A rough surface, represented by its summits, under increasing load.

use super::lattice::Lattice;
use super::merge::solve_with_merging;
use super::newton::{Equilibrium, Prescribed, Tolerances};
use super::set::Set;
use super::summits::find_summits;
use super::{Asperity, Contact, GapField, MergeRule, gap};
use crate::grid::Grid;
use crate::theory::TheoryError;
use crate::theory::error::{positive, within};
use crate::theory::roots::root;

/// Ratio of successive loads. It affects which contacts merge, as does the misfit at which circles
/// are merged; both change the contact area by a few per cent.
const LOAD_STEP: f64 = 1.2;
/// Share of the first requested load at which loading starts.
const FIRST_LOAD: f64 = 1e-3;

/// Largest aspect ratio of a cell whose images are summed; their number grows with its square root.
const LONGEST_CELL: f64 = 1e4;

/// Ratio of successive loads below which a step that does not converge is abandoned.
const SMALLEST_STEP: f64 = 1.0005;
/// Loads that [`Loading::press`] may try on one way up, those that do not settle included. In steps of
/// `LOAD_STEP` the way from the first load takes 39, and over all numbers that a scene may hold 800.
const MOST_LOADS: usize = 4000;

/// A periodic cell of a rough surface with its asperities.
#[derive(Clone, Debug)]
pub struct Icha<'a> {
    grid: Grid,
    heights: &'a [f64],
    summits: Vec<Asperity>,
    lattice: Lattice,
}

impl<'a> Icha<'a> {
    /// Finds the asperities of `heights` (m, shape `[ny, nx]`, positive towards the solid) on a
    /// periodic cell.
    ///
    /// # Errors
    /// Heights that are not finite, a map without a summit, and a cell more than 10 000 times longer than
    /// wide.
    pub fn new(grid: Grid, heights: &'a [f64]) -> Result<Self, TheoryError> {
        let ratio = grid.lx.max(grid.ly) / grid.lx.min(grid.ly);
        within(
            "longer over shorter side of the cell",
            ratio,
            ratio <= LONGEST_CELL,
            "no more than 10000, or the sums over its images take too long",
        )?;
        let summits = find_summits(&grid, heights)?;
        if summits.is_empty() {
            return Err(TheoryError::NoSolution {
                what: "a summit of the surface",
            });
        }
        let lattice = Lattice::periodic([grid.lx, grid.ly]).with_mesh(summits.len());
        Ok(Icha {
            grid,
            heights,
            summits,
            lattice,
        })
    }

    /// The asperities before any merged.
    #[doc(hidden)]
    pub fn summits(&self) -> &[Asperity] {
        &self.summits
    }

    /// The grid of the map.
    #[doc(hidden)]
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// The map, m.
    #[doc(hidden)]
    pub fn heights(&self) -> &'a [f64] {
        self.heights
    }

    /// The unloaded surface, at the start of a loading.
    pub fn loading(&self, rule: MergeRule) -> Loading<'_> {
        self.loading_in_steps(rule, LOAD_STEP)
    }

    /// As [`Icha::loading`], with another ratio (above 1) between successive loads, at most
    /// 4000 of them.
    #[doc(hidden)]
    pub fn loading_in_steps(&self, rule: MergeRule, step: f64) -> Loading<'_> {
        Loading {
            surface: self,
            rule,
            step: step.max(1.0 + f64::EPSILON),
            set: Set::new(self.summits.clone(), &self.lattice),
            state: None,
            pressure: 0.0,
        }
    }
}

/// A surface under increasing load.
///
/// An elastic contact without adhesion does not depend on its history. So overlapping circles are
/// merged separately at each requested load. Only if a circle comes to cover another summit do the
/// two have no separate equilibrium: these are merged permanently at constant displaced volume,
/// since they no longer have two caps.
#[derive(Clone, Debug)]
pub struct Loading<'a> {
    surface: &'a Icha<'a>,
    rule: MergeRule,
    step: f64,
    /// The asperities, with those merged permanently.
    set: Set,
    state: Option<Equilibrium>,
    /// Mean pressure over the modulus so far.
    pressure: f64,
}

impl Loading<'_> {
    /// Increases the load to a mean pressure over the contact modulus, not below the previous one.
    ///
    /// # Errors
    /// A decreasing load, asperities that do not converge, more than 4000 loads, and contacts
    /// that merge over the whole cell.
    pub fn press(&mut self, pressure_over_modulus: f64) -> Result<Pressed, TheoryError> {
        let target = positive("pressure over modulus", pressure_over_modulus)?;
        within(
            "pressure over modulus",
            target,
            target >= self.pressure,
            "no less than that before: contacts that cover each other do not part",
        )?;
        let mut pressure = if self.state.is_some() {
            self.pressure
        } else {
            FIRST_LOAD * target / self.step
        };
        let mut factor = self.step;
        let mut tried = 0;
        while self.pressure < target {
            if tried == MOST_LOADS {
                return Err(TheoryError::NotConverged {
                    what: "the way up in load",
                });
            }
            tried += 1;
            let next = (pressure * factor).min(target);
            match self.press_at_once(next) {
                Ok(()) => {
                    pressure = next;
                    factor = (factor * factor).min(self.step);
                }
                // Circles came to cover each other before they could merge: take a smaller step.
                Err(TheoryError::NotConverged { .. }) if factor > SMALLEST_STEP => {
                    factor = factor.sqrt();
                }
                Err(error) => return Err(error),
            }
        }
        let state = self.state.clone().ok_or(TheoryError::NoSolution {
            what: "an equilibrium",
        })?;
        let (set, state) = solve_with_merging(
            self.set.clone(),
            &self.surface.lattice,
            Prescribed::Load(target * self.surface.grid.area()),
            state,
            self.rule,
            Tolerances::FINAL,
        )?;
        let mut contacts = state.contacts(&set.asperities);
        contacts.retain(|contact| contact.contact_radius > 0.0);
        let pressed = Pressed {
            plane: state.plane,
            contacts,
            nominal_area: self.surface.grid.area(),
        };
        // All merged into one that covers more than the cell: outside the model.
        if pressed.contact_area_fraction() >= 1.0 {
            return Err(TheoryError::NoSolution {
                what: "a contact of less than the nominal area",
            });
        }
        Ok(pressed)
    }

    /// Moves to a load with the permanently merged contacts only.
    fn press_at_once(&mut self, pressure: f64) -> Result<(), TheoryError> {
        let surface = self.surface;
        let load = pressure * surface.grid.area();
        let solve = |start: Equilibrium| {
            solve_with_merging(
                self.set.clone(),
                &surface.lattice,
                Prescribed::Load(load),
                start,
                MergeRule::DisplacedVolume,
                Tolerances::PASSING.merging_covered(),
            )
        };
        let asperities = &self.set.asperities;
        let (set, state) = match &self.state {
            Some(state) => solve(state.clone()),
            // From the highest alone many others of its height would come in touch at once.
            None => solve(first_touch(asperities, load))
                .or_else(|_| solve(shared_touch(asperities, load)?)),
        }?;
        self.set = set;
        self.state = Some(state);
        self.pressure = pressure;
        Ok(())
    }
}

/// The highest asperity alone under a load over the modulus, m^2.
fn first_touch(asperities: &[Asperity], load: f64) -> Equilibrium {
    let mut indentations = vec![0.0; asperities.len()];
    let highest = (0..asperities.len())
        .max_by(|&i, &j| asperities[i].height.total_cmp(&asperities[j].height));
    let mut plane = 0.0;
    if let Some(i) = highest {
        let contact_radius = (0.75 * load * asperities[i].radius).cbrt();
        indentations[i] = contact_radius * contact_radius / asperities[i].radius;
        plane = asperities[i].height - indentations[i];
    }
    Equilibrium {
        plane,
        lowered: vec![0.0; asperities.len()],
        indentations,
    }
}

/// All asperities that share a load over the modulus, m^2, each as if it were alone.
fn shared_touch(asperities: &[Asperity], load: f64) -> Result<Equilibrium, TheoryError> {
    let by_height = |one: &&Asperity, other: &&Asperity| one.height.total_cmp(&other.height);
    let highest = asperities
        .iter()
        .max_by(by_height)
        .ok_or(TheoryError::NoSolution {
            what: "a summit of the surface",
        })?;
    let indentations = |depth: f64| -> Vec<f64> {
        let below = |asperity: &Asperity| (asperity.height - highest.height + depth).max(0.0);
        asperities.iter().map(below).collect()
    };
    let carried = |depth: f64| -> f64 {
        let one = |(asperity, delta): (&Asperity, f64)| delta * (asperity.radius * delta).sqrt();
        4.0 / 3.0
            * asperities
                .iter()
                .zip(indentations(depth))
                .map(one)
                .sum::<f64>()
    };
    // The highest alone would carry it at this depth.
    let alone = (0.75 * load / highest.radius.sqrt()).cbrt().powi(2);
    let depth = root(
        "a first touch",
        |depth| carried(depth) / load - 1.0,
        0.0,
        2.0 * alone,
        1e-9 * alone,
    )?;
    Ok(Equilibrium {
        plane: highest.height - depth,
        lowered: vec![0.0; asperities.len()],
        indentations: indentations(depth),
    })
}

/// Contacts of a surface under a load.
#[derive(Clone, Debug, PartialEq)]
pub struct Pressed {
    /// Height of the plane, m: the rigid flat, measured where the surface displacement has zero
    /// mean.
    pub plane: f64,
    /// The contacts, none of which overlap.
    pub contacts: Vec<Contact>,
    nominal_area: f64,
}

impl Pressed {
    /// Contact area over nominal area.
    pub fn contact_area_fraction(&self) -> f64 {
        self.contacts.iter().map(Contact::area).sum::<f64>() / self.nominal_area
    }

    /// Mean pressure over the contact modulus.
    #[doc(hidden)]
    pub fn pressure_over_modulus(&self) -> f64 {
        let load: f64 = self.contacts.iter().map(Contact::load_over_modulus).sum();
        load / self.nominal_area
    }

    /// The gap over the whole map, m; see [`GapField`].
    pub fn gap(&self, surface: &Icha) -> GapField {
        gap::gap_field(&surface.grid, surface.heights, self.plane, &self.contacts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An egg-box of so many waves a side, with crests 2e-3 above the troughs.
    fn egg_box(waves: usize) -> (Grid, Vec<f64>) {
        let side = 8 * waves;
        let place = |i: usize| (std::f64::consts::TAU * i as f64 / 8.0).cos();
        let heights = (0..side * side).map(|i| 1e-3 * (place(i % side) + place(i / side)));
        (Grid::new([side; 2], [1.0, 1.0]), heights.collect())
    }

    /// Sixteen crests of one height carry the same load each: Hertz, of a radius that differences on 32 points a wave have 0.3 % too
    /// large.
    #[test]
    fn crests_of_one_height_share_the_load() {
        let (grid, heights) = egg_box(4);
        let surface = Icha::new(grid, &heights).expect("summits");
        assert_eq!(surface.summits().len(), 16);
        let pressed = surface.loading(MergeRule::Volume).press(1e-7);
        let found = pressed.expect("a state").contact_area_fraction();
        let radius = 1.0 / (1e-3 * (8.0 * std::f64::consts::PI).powi(2));
        let a = (0.75 * radius * 1e-7 / 16.0).cbrt();
        let hertz = 16.0 * std::f64::consts::PI * a * a;
        assert!((found / hertz - 1.0).abs() < 0.01, "{found} {hertz}");
    }

    /// Loads that rounding keeps from rising end the way up, as do too many small ones.
    #[test]
    fn a_way_up_ends() {
        let (grid, heights) = egg_box(1);
        let surface = Icha::new(grid, &heights).expect("a summit");
        for step in [0.0, 1.0, 1.0 + 1e-12] {
            let mut loading = surface.loading_in_steps(MergeRule::Volume, step);
            let error = loading.press(1e-4).expect_err("too long a way");
            assert!(error.to_string().contains("the way up in load"), "{error}");
        }
        // The shortest steps that get there.
        let step = (1.01 / FIRST_LOAD).powf(1.0 / MOST_LOADS as f64);
        let mut loading = surface.loading_in_steps(MergeRule::Volume, step);
        loading.press(1e-4).expect("a state");
    }
}
