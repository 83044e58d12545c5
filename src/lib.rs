//! Two rough bodies are pushed together and they attract: where do they touch, with what pressure,
//! and what force pulls them apart?
//!
//! tabor answers with the whole pressure field. The counter-face is rigid and carries the composite
//! roughness, the solid is an elastic half-space of contact modulus E*, and a cohesive law acts
//! across the gap, in contact and out of it. Heights go in as an array, gap and pressure come out as
//! arrays, everything in SI units:
//!
//! ```
//! use tabor::{Contact, Control, Grid, MaugisDugdale, Roughness, SelfAffine};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let grid = Grid::new([128, 128], [20e-6, 20e-6]); // points and metres, x first
//! let rough = SelfAffine {
//!     hurst: 0.8, roughness: Roughness::RmsSlope(0.12),
//!     longest: 20e-6, rolloff: 5e-6, shortest: 1.6e-6, seed: 1,
//! };
//! let contact = Contact::new(rough.heights(grid)?, grid.points(), grid.size())
//!     .contact_modulus(100e6)
//!     .law(MaugisDugdale::new(0.05, 20e-9));
//! for solution in contact.path([1e6, 4e6, 0.0].map(Control::MeanPressure)) {
//!     let solution = solution?; // solution.gap, .pressure, .displacement: one number a point
//!     println!("{:.1e} Pa: {:.4} in contact", solution.mean_pressure, solution.contact_area_fraction);
//!     # assert!(solution.converged);
//!     # let pressed = solution.mean_pressure > 0.0; // without load few spots hold on such a coarse grid
//!     # assert!(!pressed || solution.contact_area_fraction > 0.05);
//! }
//! # Ok(())
//! # }
//! ```
//!
//! # Where to look next
//!
//! - [`Contact`]: what touches what; everything that a scene file can say has a method.
//! - [`Solution`], [`Path`]: a solved load as arrays; loads one after another.
//! - [`run`](fn@run): a [`Scene`], from a file or from [`Contact::scene`], solved into a folder of results.
//! - [`Device`]: the processor, or a graphics processor.
//! - [`scene`], [`surface`]: the tables of a scene; heights, their statistics and spectra.
//! - [`theory`]: closed forms to compare with.
//! - [`fit`]: work of adhesion and modulus from a measured force curve.
//! - [`output`]: the files of a run, to read and to write.
//!
//! # Features
//!
//! `cli` (default) is the program `tabor`, `gpu` (default) the graphics processor, `images`, which `cli` brings
//! with it, pictures, reports and height maps from PNG and TIFF. Without any of them remains the solver on the
//! processor with everything above, which depends on no graphics, no fonts and no command line, and compiles
//! for `wasm32-unknown-unknown` (there seconds are 0 and threads one). Two features ask for a library of the system,
//! and no other brings them with it: `mpi` lets `tabor run` share one contact between the processes of `mpirun`
//! (`docs/cluster.md`), `netcdf` is the command `tabor netcdf`, which makes one file of a run (`docs/results.md`).
//!
//! # The map
//!
//! A module uses only modules that stand above it in this list; a test keeps that true.
//!
//! | module | what it holds |
//! |---|---|
//! | [`units`] | text with units to SI and back; the one place that knows unit names |
//! | `clock` | time that passes; the one place that asks the system for it |
//! | [`grid`] | points, sizes, wavevectors, the order of a field, what the transforms are scaled by |
//! | `shared_values` | numbers that several hold and nobody copies: heights |
//! | [`real`] | the two kinds of number that kernels run in |
//! | `plans` | plans of one-dimensional Fourier transforms, made once a process |
//! | [`law`] | how strongly surfaces attract across a gap, one file a law |
//! | [`elastic`] | stiffness of the half-space or of a layer at each wavevector, periodic or free |
//! | [`kernel`] | the catalogue of passes over points, and the numbers of the algorithm |
//! | [`backend`] | where the arithmetic runs: the trait, the processor, alone or with a slab of the rows on each of several ranks, what the host holds of these, shaders through wgpu, the dry run that only counts |
//! | [`solver`] | the one algorithm, for every law and both boundaries |
//! | [`scene`] | TOML to a checked scene, or every mistake of it with line, key and remedy |
//! | [`surface`] | heights: self-affine, shapes, files; their statistics and the spectrum that fits |
//! | [`study`] | loading paths: what is prescribed, jumps, energies, the rows of `curve.csv`, the hooks of effects |
//! | [`flow`] | the flow of a thin film through a gap, and its critical constriction, in strips of rows on all threads and ranks |
//! | [`effect`] | what a scene may ask for besides, one file each, and what each costs |
//! | [`output`] | the files of a run: curve, summary, fields, pictures, report, and the state to resume from |
//! | [`device`] | where a run computes: the processor or a graphics processor, and in which arithmetic |
//! | [`run`](mod@run) | a scene solved into its folder, or resumed; whether the memory holds it |
//! | `contact` | [`Contact`]: arrays in, arrays out |
//! | [`theory`] | closed forms and models to compare with: Hertz, JKR, Maugis, Persson and others |
//! | [`compare`] | one rough surface through the full field and the models of it, with seconds and ranges |
//! | [`fit`] | work of adhesion and modulus from a measured force curve, and which model suits it |
//! | `accuracy` | error against seconds: a scene over grids, precisions, steps and models |
//! | `sweep` | a study: a scene over values of its keys, into one table |
//! | `cli` | the command line |
//!
//! # What an iteration does
//!
//! The unknown is the gap. Without adhesion, under a mean pressure, an iteration takes the residual on
//! the points that may move, smooths it by about the compliance of the half-space (on three halved grids, a
//! tenth of a transform in all), makes it a conjugate direction, cuts it where a gap would close, and asks what
//! pressure the step takes (two transforms); then gap and pressure move.
//! The work on points rides in the rows of those transforms, so a field is read while it is in cache, and
//! what one pass leaves for the next stays in their work space. With adhesion a line search is added, point by
//! point, without transforms, and over a wall far from a solution the compliance is a convolution (two more transforms). An
//! effect that the scene does not name has no field and no pass;
//! `tabor check` lists both. The residual that ends a solve is defined in `docs/solver.md`.
//!
//! On a graphics processor an iteration takes so many dispatches and moves so many fields, in numbers
//! a grid point (four bytes each, eight in double precision; what is updated counts twice, tables and coarse
//! grids by their size):
//!
//! | at | dispatches | fields |
//! |---|---|---|
//! | no adhesion, a pressure | 17 | 24.8 |
//! | sharp Maugis-Dugdale, a pressure | 17 | 24.8 |
//! | sharp Maugis-Dugdale, a mean gap | 19 | 29.8 |
//! | the same with a hardness, a mean gap | 21 | 30.8 |
//! | exponential, a pressure | 29 | 35.5 |
//! | Lennard-Jones, a pressure | 25 | 35.8 |
//! | Lennard-Jones, a mean gap | 29 | 39.8 |
//!
//! Of these fields a convolution takes six: the half-space's stiffness is computed in registers. A solid
//! with a table in its place (a layer, a free boundary) moves a quarter of a field more. Eleven of the dispatches
//! are those of the halved grids, ten more and 8.7 fields those of their second sweep, where an attraction falls with the gap from a
//! wall on and a grid of at most 2^19 points resolves it; far from a solution with adhesion over a wall, where these have no part, an iteration takes
//! ten dispatches and 1.8 fields less than with one sweep. Of the dispatches and fields
//! of a law with a tail two each are a pass of the search for the step length: one in a round behind a wall, where it looks at
//! four steps, four with Lennard-Jones, whose iterations take as many on average and whose first step rides in the trial. A pass
//! that is not needed moves nothing; a
//! search that needs more continues in the next round, which does nothing else. In the rounds of mixed
//! precision every kernel of a law reads a field more. Under a mean gap the trial step is scaled back to
//! it: by linearity, so that no pass comes between, but with Lennard-Jones and with a hardness, where
//! the share that is added to a point is not linear in its step.
//!
//! `python/` is the Python package, a crate of its own over this one's public front.
//!
//! Modules that are named here and not listed below are the solver's own. They are public for the tests and
//! benches of this crate, which would otherwise build it twice (a feature for them makes another build of
//! the crate than that of the program), and may change in every version.
#![warn(missing_docs)]
// Both macros panic where nobody reads; `cli` has one place for each stream.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

#[cfg(feature = "cli")]
mod accuracy;
#[doc(hidden)]
pub mod backend;
#[cfg(feature = "cli")]
mod cli;
mod clock;
#[doc(hidden)]
pub mod compare;
mod contact;
#[doc(hidden)]
pub mod device;
#[doc(hidden)]
pub mod effect;
#[doc(hidden)]
pub mod elastic;
pub mod fit;
pub mod flow;
#[doc(hidden)]
pub mod grid;
#[doc(hidden)]
pub mod kernel;
#[doc(hidden)]
pub mod law;
pub mod output;
mod plans;
#[doc(hidden)]
pub mod real;
pub mod run;
pub mod scene;
mod shared_values;
#[doc(hidden)]
pub mod solver;
#[doc(hidden)]
pub mod study;
pub mod surface;
#[cfg(feature = "cli")]
mod sweep;
pub mod theory;
#[doc(hidden)]
pub mod units;

#[cfg(feature = "cli")]
#[doc(hidden)]
pub use cli::{main as command_line, main_with as command_line_with, theory_table};
pub use contact::{
    Contact, ContactError, ContactMistake, ContactMistakes, Control, Load, Path, Solution,
};
pub use device::{Device, DeviceError};
pub use elastic::{Base, Layer};
pub use grid::Grid;
pub use run::{RunEnd, RunError, RunObserver, RunOptions, RunStatus, run, run_with};
pub use scene::{
    AdhesionMap, Boundary, Exponential, GridValues, LennardJones, MaugisDugdale, Precision, Ramp,
    Range, Roughness, Scene, SelfAffineScene as SelfAffine, SurfacePart, Treatment,
};
pub use shared_values::SharedValues;
pub use study::{Jump, State, StepRow, Unreachable};
pub use units::UnitError;

/// The README's program is compiled and run like the one above.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;
