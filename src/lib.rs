//! Two rough bodies are pushed together and they attract: where do they touch, with what pressure,
//! and what force pulls them apart?
//!
//! tabor answers with the whole pressure field. The counter-face is rigid and carries the composite
//! roughness, the solid is an elastic half-space of contact modulus E*, and a cohesive law acts
//! across the gap, in contact and out of it. A scene says what is there:
//!
//! ```
//! use tabor::backend::{Backend, cpu::CpuBackend};
//! use tabor::study::{Setup, walk};
//! use tabor::{scene::Scene, surface::Surface};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let smaller = [("grid.points".to_owned(), "128".to_owned())]; // as --set on the command line
//! let scene = Scene::read("examples/scenes/rough.toml".as_ref(), &smaller)?;
//! let setup = Setup::new(scene.clone(), Surface::build(&scene)?);
//! let cpu = || -> Box<dyn Backend + Send> { Box::new(CpuBackend::<f64>::new()) };
//! let end = walk(&setup, &cpu, &mut ())?; // an `Observer` in place of `()` gets the fields
//! for row in &end.rows {
//!     println!("{:.2e} Pa: {:.4} in contact", row.mean_pressure, row.contact_area_fraction);
//! }
//! # assert!(end.rows.iter().all(|row| row.converged));
//! # assert!(end.rows[3].contact_area_fraction > end.rows[0].contact_area_fraction);
//! # Ok(())
//! # }
//! ```
//!
//! # The map
//!
//! A module uses only modules that stand above it in this list; a test keeps that true.
//!
//! | module | what it holds |
//! |---|---|
//! | [`units`] | text with units to SI and back; the one place that knows unit names |
//! | [`grid`] | points, sizes, wavevectors, the order of a field, what the transforms are scaled by |
//! | [`real`] | the two kinds of number that kernels run in |
//! | [`law`] | how strongly surfaces attract across a gap, one file a law |
//! | [`elastic`] | stiffness of the half-space or of a layer at each wavevector, periodic or free |
//! | [`kernel`] | the catalogue of passes over points, and the numbers of the algorithm |
//! | [`backend`] | where the arithmetic runs: the trait, the processor, shaders through wgpu, the dry run that only counts |
//! | [`solver`] | the one algorithm, for every law and both boundaries |
//! | [`scene`] | TOML to a checked scene, or every mistake of it with line, key and remedy |
//! | [`surface`] | heights: self-affine, shapes, files; their statistics and the spectrum that fits |
//! | [`study`] | loading paths: what is prescribed, jumps, energies, the rows of `curve.csv`, the hooks of effects |
//! | [`effect`] | what a scene may ask for besides, one file each, and what each costs |
//! | [`output`] | the folder of a run: curve, summary, fields, pictures, report, and the state to go on from |
//! | [`theory`] | closed forms and models to compare with: Hertz, JKR, Maugis, Persson and others |
//! | [`compare`] | one rough surface through the full field and the models of it, with seconds and ranges |
//! | [`fit`] | work of adhesion and modulus from a measured force curve |
//! | [`accuracy`] | error against seconds: a scene over grids, precisions, steps and models |
//! | [`cli`] | the command line |
//!
//! # What an iteration does
//!
//! The unknown is the gap. Without adhesion, under a mean pressure, an iteration takes the residual on
//! the points that may move, smooths it with the half-space's compliance (two transforms, and about
//! a quarter of one on a coarse grid for the long waves), makes it a conjugate direction, cuts it
//! where a gap would close, and asks what pressure the step takes (two transforms); then gap and
//! pressure move, and the rows of the new residual go into the next iteration's first transform at once.
//! The work on points rides in the rows of those transforms, so a field is read while it is in cache, and
//! what one pass leaves for the next stays in their work space. With adhesion the coarse grid goes and a search for the step length comes, point by
//! point, without transforms. An effect that the scene does not name has no field and no pass;
//! `tabor check` lists both. The residual that ends a solve is defined in `docs/solver.md`.
//!
//! On a graphics processor an iteration takes so many dispatches and moves so many fields, in numbers
//! a grid point (four bytes each, eight in double precision; what is updated counts twice, tables and coarse
//! grids by their size):
//!
//! | at | dispatches | fields |
//! |---|---|---|
//! | no adhesion, a pressure | 13 | 25.0 |
//! | sharp Maugis-Dugdale, a pressure | 7 | 23.0 |
//! | sharp Maugis-Dugdale, a mean gap | 9 | 28.0 |
//! | the same with a hardness, a mean gap | 11 | 29.0 |
//! | exponential, a pressure | 9 | 25.0 |
//! | Lennard-Jones, a pressure | 9 | 27.0 |
//! | Lennard-Jones, a mean gap | 13 | 32.0 |
//!
//! Of these fields a convolution takes six: the half-space's stiffness is computed in registers. A solid
//! with tables in its place (a layer, a free boundary) moves half a field more. Of the dispatches and fields
//! of a law with a tail two each are a pass of the search for the step length, which behind a wall looks at four
//! steps; of Lennard-Jones the first step rides in the trial. A pass that is not needed moves nothing; a
//! search that needs more goes on in the next round, which does nothing else. In the rounds of mixed
//! precision every kernel of a law reads two fields more. Under a mean gap the trial step is scaled back to
//! it: by linearity, so that no pass comes between, but with Lennard-Jones and with a hardness, where
//! the share that is added to a point is not linear in its step.
#![warn(missing_docs)]
// Both macros panic where nobody reads; `cli` has one place for each stream.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

pub mod accuracy;
pub mod backend;
pub mod cli;
pub mod compare;
pub mod effect;
pub mod elastic;
pub mod fit;
pub mod grid;
pub mod kernel;
pub mod law;
pub mod output;
pub mod real;
pub mod scene;
pub mod solver;
pub mod study;
pub mod surface;
pub mod theory;
pub mod units;

/// The README's program is compiled and run like the one above.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;
