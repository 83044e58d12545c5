//! A contact assembled in SI units: heights, solid, law, boundary.

use std::fmt;
use std::sync::Arc;

use super::control::{Control, Load};
use super::error::{ContactError, ContactMistake};
use super::path::Path;
use super::solution::Solution;
use crate::device::Device;
use crate::elastic::Layer;
use crate::scene::{
    AdhesionMap, AdhesionScene, Axis, Boundary, CapillaryScene, ConductanceScene, Conduction,
    EffectTables, FrictionScene, GridScene, LeakageScene, LoadingScene, OutputScene, Precision,
    Ramp, RateScene, RelaxationScene, Scene, SceneError, SolidScene, StepChoice, SurfacePart,
    Treatment, WearScene,
};

/// A rough, rigid counter-face over an elastic solid, in SI units.
///
/// ```
/// use tabor::{Boundary, Contact, Control, MaugisDugdale};
///
/// // A sphere of 5 um on 64 x 64 points over 4 x 4 um.
/// let n = 64;
/// let size = 4e-6;
/// let place = |index: usize| (index as f64 / n as f64 - 0.5) * size;
/// let heights: Vec<f64> = (0..n * n)
///     .map(|point| -(place(point % n).powi(2) + place(point / n).powi(2)) / (2.0 * 5e-6))
///     .collect();
/// let solution = Contact::new(heights, [n, n], [size, size])
///     .contact_modulus(50e6)
///     .law(MaugisDugdale::new(10e-3, 20e-9))
///     .boundary(Boundary::Free)
///     .solve(Control::Force(1e-7))?;
/// assert!(solution.converged);
/// assert_eq!(solution.pressure.len(), n * n);
/// # Ok::<(), tabor::ContactError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Contact {
    pub(super) scene: Scene,
    /// Whether a contact modulus was given.
    has_modulus: bool,
    /// Effects of the adhesion, which it may be given after.
    treatment: Option<Treatment>,
    map: Option<AdhesionMap>,
    rate: Option<RateScene>,
    pub(super) threads: Option<usize>,
    pub(super) device: Device,
    pub(super) watcher: Option<Watcher>,
}

/// What hears of iterations and may end a load.
#[derive(Clone)]
pub(super) struct Watcher(Arc<dyn Fn(usize, f64) -> bool + Send + Sync>);

impl Watcher {
    /// Tells an iteration of a load and its residual; whether to go on.
    pub(super) fn hears(&self, iteration: usize, residual: f64) -> bool {
        (self.0)(iteration, residual)
    }
}

impl fmt::Debug for Watcher {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("Watcher")
    }
}

impl Contact {
    /// A contact of these heights, m, positive towards the solid, shape `[ny, nx]`, row-major, on `points` =
    /// (nx, ny) points over `size` = (lx, ly), m, of a periodic cell. A slice, a vector, an array and the
    /// slice of an `ndarray` in standard layout will do; the numbers are copied once.
    pub fn new(heights: impl AsRef<[f64]>, points: [usize; 2], size: [f64; 2]) -> Self {
        let part = SurfacePart::from_heights(heights, points);
        Contact::from_parts([part], points, size)
    }

    /// A contact whose heights are the sum of these parts.
    pub fn from_parts(
        parts: impl IntoIterator<Item = SurfacePart>,
        points: [usize; 2],
        size: [f64; 2],
    ) -> Self {
        let loading = LoadingScene::new(crate::scene::Control::Pressure, []);
        let scene = Scene::new(
            GridScene::new(points, size),
            SolidScene::new(1.0),
            parts.into_iter().collect(),
            loading,
        );
        Contact {
            has_modulus: false,
            ..Contact::from_scene(scene)
        }
    }

    /// The contact of a scene, which may have been read from a file. Its path is [`Contact::loads`].
    pub fn from_scene(scene: Scene) -> Self {
        Contact {
            has_modulus: true,
            treatment: None,
            map: None,
            rate: None,
            threads: None,
            device: Device::from(scene.solver.backend),
            watcher: None,
            scene,
        }
    }

    /// Sets the contact modulus, Pa, with the counter-face's share: `1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2`.
    pub fn contact_modulus(mut self, contact_modulus: f64) -> Self {
        self.scene.solid.contact_modulus = contact_modulus;
        self.has_modulus = true;
        self
    }

    /// Sets the solid, as by [`SolidScene::from_young_modulus`].
    pub fn solid(mut self, solid: SolidScene) -> Self {
        self.scene.solid = solid;
        self.has_modulus = true;
        self
    }

    /// Puts a layer on a rigid base in the half-space's place. Periodic grids only.
    pub fn layer(mut self, layer: Layer) -> Self {
        self.scene.solid = self.scene.solid.layer(layer);
        self
    }

    /// Lets the solid flow where the net pressure reaches its hardness, Pa.
    pub fn hardness(mut self, hardness: f64) -> Self {
        self.scene.solid.hardness = Some(hardness);
        self
    }

    /// Puts Maxwell branches beside the contact modulus, which is then the relaxed one. Loads then need
    /// [times](Control::after).
    pub fn relaxation(mut self, branches: impl Into<Vec<RelaxationScene>>) -> Self {
        self.scene.solid.relaxation = branches.into();
        self
    }

    /// Sets what lies beyond the edge; [`Boundary::Periodic`] by default.
    pub fn boundary(mut self, boundary: Boundary) -> Self {
        self.scene.grid.boundary = boundary;
        self
    }

    /// Adds a further part to the heights.
    pub fn part(mut self, part: impl Into<SurfacePart>) -> Self {
        self.scene.surfaces.push(part.into());
        self
    }

    /// Sets the attraction: [`MaugisDugdale`](crate::MaugisDugdale), [`LennardJones`](crate::LennardJones) or
    /// [`Exponential`](crate::Exponential). Without one a hard wall is all there is.
    pub fn law(mut self, law: impl Into<AdhesionScene>) -> Self {
        self.scene.adhesion = Some(law.into());
        self
    }

    /// Lets a liquid condense between the surfaces, which is the attraction in the law's place.
    pub fn capillary(mut self, liquid: CapillaryScene) -> Self {
        self.scene.capillary = Some(liquid);
        self
    }

    /// Sets how the attraction is found; [`Treatment::Full`] by default.
    pub fn treatment(mut self, treatment: Treatment) -> Self {
        self.treatment = Some(treatment);
        self
    }

    /// Multiplies the tension of the law by a factor at each point: a pattern, a file, or an array as
    /// `AdhesionMap::Factors(GridValues::new(factors, [nx, ny]))`.
    pub fn adhesion_map(mut self, map: AdhesionMap) -> Self {
        self.map = Some(map);
        self
    }

    /// Lets the work of adhesion grow with the speed of a receding edge: `w (1 + (v/v*)^n)`. Loads then need
    /// [times](Control::after).
    pub fn rate(mut self, reference_speed: f64, exponent: f64) -> Self {
        self.rate = Some(RateScene {
            reference_speed,
            exponent,
        });
        self
    }

    /// Puts a spring of a stiffness, N/m, between the prescribed approach and the body.
    pub fn spring(mut self, stiffness: f64) -> Self {
        self.scene.loading.spring = Some(stiffness);
        self
    }

    /// Sets how well the tension at which a path under a load or on a spring lets go is narrowed down, relative; 0 for not
    /// at all, 0.01 by default.
    pub fn pull_off_tolerance(mut self, tolerance: f64) -> Self {
        self.scene.loading.pull_off_tolerance = tolerance;
        self
    }

    /// Asks for the effects of these tables, which hold numbers alone; [`friction`](Contact::friction),
    /// [`conductance`](Contact::conductance), [`wear`](Contact::wear) and [`leakage`](Contact::leakage) set one each.
    pub fn tables(mut self, tables: EffectTables) -> Self {
        self.scene.tables = tables;
        self
    }

    /// Asks for the friction force of a shear strength, Pa, of the area in contact.
    pub fn friction(mut self, shear_strength: f64) -> Self {
        self.scene.tables.friction = Some(FrictionScene { shear_strength });
        self
    }

    /// Asks for what the contact conducts between bodies of these conductivities, W/(m K); S/m for a current.
    pub fn conductance(mut self, solid: f64, counter_face: f64) -> Self {
        self.scene.tables.conductance = Some(ConductanceScene {
            conductivity: solid,
            counter_conductivity: counter_face,
            kind: Conduction::Thermal,
        });
        self
    }

    /// Asks for the volume that sliding wears off, of a specific wear rate, m^3/(N m).
    pub fn wear(mut self, specific_wear_rate: f64) -> Self {
        self.scene.tables.wear = Some(WearScene { specific_wear_rate });
        self
    }

    /// Asks for the flow of a fluid of a viscosity, Pa s, through the gap along an axis.
    pub fn leakage(mut self, viscosity: f64, axis: Axis) -> Self {
        self.scene.tables.leakage = Some(LeakageScene { viscosity, axis });
        self
    }

    /// Sets where the arithmetic runs; [`Device::auto`] by default.
    pub fn device(mut self, device: Device) -> Self {
        self.scene.solver.backend = device.backend();
        self.device = device;
        self
    }

    /// Sets the arithmetic; [`Precision::Auto`] by default. Single precision takes its floor,
    /// [`Precision::SINGLE_FLOOR`], for a tolerance below it that was not set.
    pub fn precision(mut self, precision: Precision) -> Self {
        let untouched =
            self.scene.solver.tolerance == crate::scene::SolverScene::default().tolerance;
        if precision == Precision::Single && untouched {
            self.scene.solver.tolerance = Precision::SINGLE_FLOOR;
        }
        self.scene.solver.precision = precision;
        self
    }

    /// Sets the largest accepted residual; 1e-6 by default.
    pub fn tolerance(mut self, tolerance: f64) -> Self {
        self.scene.solver.tolerance = tolerance;
        self
    }

    /// Sets the most iterations of a load; 5000 by default.
    pub fn max_iterations(mut self, iterations: usize) -> Self {
        self.scene.solver.max_iterations = iterations;
        self
    }

    /// Sets the threads of the processor; one a core by default. Results do not depend on it.
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = Some(threads);
        self
    }

    /// Tells every iteration of a load, from 1, with its residual. A load ends where the answer is `false`: then the
    /// path ends too, with [`ContactError::Interrupted`].
    ///
    /// ```
    /// use tabor::{Contact, ContactError, Control, SurfacePart};
    ///
    /// let wave = SurfacePart::Wavy { amplitude: 10e-9, wavelength: [1e-6, 1e-6] };
    /// let contact = Contact::from_parts([wave], [32, 32], [1e-6, 1e-6])
    ///     .contact_modulus(1e9)
    ///     .watch(|iteration, _residual| iteration < 2);
    /// let ended = contact.solve(Control::MeanPressure(1e6));
    /// assert!(matches!(ended, Err(ContactError::Interrupted)));
    /// ```
    pub fn watch(mut self, watcher: impl Fn(usize, f64) -> bool + Send + Sync + 'static) -> Self {
        self.watcher = Some(Watcher(Arc::new(watcher)));
        self
    }

    /// Sets the title of pictures and reports, where a [scene](Contact::scene) of it is run.
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.scene.title = Some(title.into());
        self
    }

    /// Sets which pictures and fields are written, where a [scene](Contact::scene) of it is run.
    pub fn output(mut self, output: OutputScene) -> Self {
        self.scene.output = output;
        self
    }

    /// Solves one load, from the undeformed surfaces.
    ///
    /// # Errors
    /// Values that cannot stand, heights that cannot be used, a contact that the memory does not hold, and a
    /// device that cannot be used or fails. A load that does not converge is a [`Solution`] that says so.
    pub fn solve(&self, load: impl Into<Load>) -> Result<Solution, ContactError> {
        let mut path = self.path([load.into()]);
        path.next().expect("there is one load")
    }

    /// Solves loads of one kind one after another, as the iterator is asked for them, each from the state of
    /// the one before; so a path may come and go, and be made up on the way. It ends after the first load
    /// that does not converge, and after the first error. Between loads it keeps its threads and the fields of
    /// its solver.
    ///
    /// ```
    /// use tabor::{Contact, Control, SurfacePart};
    ///
    /// let wave = SurfacePart::Wavy { amplitude: 10e-9, wavelength: [1e-6, 1e-6] };
    /// let contact = Contact::from_parts([wave], [32, 32], [1e-6, 1e-6]).contact_modulus(1e9);
    /// let mut areas = Vec::new();
    /// for solution in contact.path([1e6, 5e6, 20e6].map(Control::MeanPressure)) {
    ///     areas.push(solution?.contact_area_fraction);
    /// }
    /// assert!(areas.is_sorted());
    /// # Ok::<(), tabor::ContactError>(())
    /// ```
    pub fn path<I>(&self, loads: I) -> Path<I::IntoIter>
    where
        I: IntoIterator,
        I::Item: Into<Load>,
    {
        Path::new(self.for_loads(), loads.into_iter())
    }

    /// This contact without what a scene that it was made from says of the steps of its own path.
    fn for_loads(&self) -> Contact {
        let mut contact = self.clone();
        // Nothing is written, and the loads are not known yet among which a step might be named.
        contact.scene.output.steps = StepChoice::Last;
        // The loads are those that the caller gives, and no others behind each.
        contact.scene.loading.until_apart = false;
        contact
    }

    /// The loads of the scene that this contact was made from; empty for a contact built with methods.
    pub fn loads(&self) -> Vec<Load> {
        loads_of(&self.scene.loading)
    }

    /// The loads of a path of ramps, from a first load on. Ramps that find
    /// [their steps](Ramp::auto_steps) go by `time_tolerance`, the error in time, 1e-3 by default.
    ///
    /// ```
    /// use tabor::{Contact, Control, Ramp, scene::RelaxationScene};
    ///
    /// let contact = Contact::new([0.0; 16], [4, 4], [1e-6, 1e-6])
    ///     .contact_modulus(1e6)
    ///     .relaxation([RelaxationScene { modulus: 4e6, time: 0.1 }]);
    /// let ramps = [Ramp::to(1e5, 4).during(0.1), Ramp::hold(1.0, 1).auto_steps()];
    /// let loads = contact.ramps(Control::MeanPressure(0.0), &ramps, None)?;
    /// assert!(loads.len() > 6);
    /// # Ok::<(), tabor::ContactError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Contact::solve`], of values.
    pub fn ramps(
        &self,
        start: Control,
        ramps: &[Ramp],
        time_tolerance: Option<f64>,
    ) -> Result<Vec<Load>, ContactError> {
        let scene = self.for_loads().assembled()?;
        let loading = scene.loading_of_ramps(start.kind(), start.value(), ramps, time_tolerance)?;
        Ok(loads_of(&loading))
    }

    /// The scene of this contact and a path, for [`run`](crate::run()).
    ///
    /// # Errors
    /// As [`Contact::solve`], of values.
    pub fn scene<I>(&self, loads: I) -> Result<Scene, ContactError>
    where
        I: IntoIterator,
        I::Item: Into<Load>,
    {
        let mut scene = self.assembled()?;
        scene.loading.path.clear();
        scene.loading.durations = None;
        for load in loads {
            append(&mut scene, load.into())?;
        }
        scene.check()?;
        Ok(scene)
    }

    /// The scene without loads, with the adhesion put together.
    pub(super) fn assembled(&self) -> Result<Scene, ContactError> {
        if !self.has_modulus {
            let example = "Contact::contact_modulus(100e6)".to_owned();
            let missing = SceneError::Missing { example };
            return Err(ContactMistake::new("solid.contact_modulus", missing).into());
        }
        let mut scene = self.scene.clone();
        if let Some(liquid) = &scene.capillary {
            if self.scene.adhesion.is_some() && self.scene.adhesion != liquid.adhesion() {
                return Err(ContactMistake::conflict(
                    "capillary",
                    "the liquid is the attraction, and Contact::law is given too; give one of the two",
                )
                .into());
            }
            scene.adhesion = liquid.adhesion();
        }
        let effects = [
            ("adhesion.treatment", self.treatment.is_some()),
            ("adhesion.map", self.map.is_some()),
            ("adhesion.rate", self.rate.is_some()),
        ];
        if let Some((key, _)) = effects.iter().find(|(_, given)| *given)
            && (scene.adhesion.is_none() || scene.capillary.is_some())
        {
            return Err(ContactMistake::conflict(
                key,
                "is of a law, and there is none; give Contact::law, or leave this out",
            )
            .into());
        }
        if let Some(adhesion) = &mut scene.adhesion {
            adhesion.treatment = self.treatment.unwrap_or(adhesion.treatment);
            adhesion.map = self.map.clone().or(adhesion.map.take());
            adhesion.rate = self.rate.or(adhesion.rate);
        }
        Ok(scene)
    }
}

/// Appends a load to the path of a scene.
pub(super) fn append(scene: &mut Scene, load: Load) -> Result<(), ContactError> {
    let loading = &mut scene.loading;
    let first = loading.path.is_empty();
    let kind = load.control.kind();
    if !first && kind != loading.control {
        return Err(ContactMistake::conflict(
            "loading.control",
            "the loads of a path prescribe one quantity, and this one another than the first; begin another path",
        )
        .into());
    }
    let is_timed = load.duration.is_some();
    // The first load may be without a time where the second has one.
    let begins = is_timed && loading.path.len() == 1;
    if !first && is_timed != loading.durations.is_some() && !begins {
        return Err(ContactMistake::conflict(
            "loading.duration",
            "some loads have a time and others none; give each but the first its time, or none",
        )
        .into());
    }
    if let Some(duration) = load.duration
        && !(duration >= 0.0 && duration.is_finite())
    {
        return Err(ContactMistake::new(
            "loading.duration",
            SceneError::OutOfRange {
                found: format!("{duration}"),
                allowed: "a time in seconds, at least 0".to_owned(),
            },
        )
        .into());
    }
    loading.control = kind;
    loading.path.push(load.control.value());
    if first {
        // From nothing before it.
        loading.durations = load.duration.map(|_| vec![0.0]);
    } else if let Some(duration) = load.duration {
        loading
            .durations
            .get_or_insert_with(|| vec![0.0])
            .push(duration);
    }
    Ok(())
}

/// The loads of a path, with its times.
fn loads_of(loading: &LoadingScene) -> Vec<Load> {
    let controls = loading
        .path
        .iter()
        .map(|&value| Control::from_kind(loading.control, value));
    match &loading.durations {
        None => controls.map(Load::from).collect(),
        Some(durations) => controls
            .zip(durations)
            .map(|(control, &seconds)| control.after(seconds))
            .collect(),
    }
}
