//! Every mistake that a user can make, with the message it must give: one line a mistake, which
//! names the file, where in it, what is wrong and what would be right.
//!
//! Four tables hold them: edits of scenes (`scenes`), height files (`files`), force curves
//! (`curves`), and calls of the binary and of the library (`calls`). Together they reach every variant of every error enum of the
//! crate. `variants` reads those from the source, so a new variant fails the test below until a
//! table reaches it.

mod calls;
mod curves;
mod files;
pub mod pull_off;
pub mod scenes;
pub mod variants;

use std::collections::BTreeMap;

use crate::shared::trials::tests;

/// A mistake that was made and what came of it.
pub struct Reached {
    /// As in `FileError::Ragged`.
    pub variant: String,
    /// What the user reads.
    pub message: String,
}

/// Variants that no scene, file or call can reach, with the reason.
const OUT_OF_REACH: &[(&str, &str)] = &[
    (
        "ContactError::Interrupted",
        "a watcher of the library ends a solve: tests/command_line/contact.rs",
    ),
    (
        "BackendError::Fields",
        "a kernel of this crate with a wrong list of fields: tests/house/cost.rs plans every kernel",
    ),
    (
        "BackendError::Device",
        "the device fails amid a run; without a thread pool the whole machine is out of threads",
    ),
    (
        "FileError::LongLine",
        "takes several processes and a line of 512 MiB: a test in src/surface/formats/lines.rs has it, with a lesser limit",
    ),
    (
        "FileError::Sorting",
        "takes several processes and a temporary folder that cannot be written",
    ),
    (
        "Failure::KilledRank",
        "takes the feature `mpi` and a launcher: .ci/ranks kills a rank",
    ),
    (
        "FileError::MissingOnRanks",
        "takes several processes: a test in src/surface/fill.rs has it, with a lesser limit",
    ),
    (
        "GpuError::NoDevice",
        "an adapter that is listed and then gives no device",
    ),
    (
        "GpuError::TooLarge",
        "the command line refuses the grid before, in words of the scene: see calls::past_the_adapter",
    ),
    (
        "GpuError::NoShader",
        "a kernel of this crate without a shader: tests/gpu/shaders.rs looks for each",
    ),
    (
        "GpuError::Fields",
        "a kernel of this crate with a wrong list of fields",
    ),
    (
        "GpuError::Precision",
        "needs an adapter: tests/gpu/run.rs asks for it",
    ),
    ("GpuError::Device", "the device fails amid a run"),
    (
        "GpuError::OutOfMemory",
        "needs an adapter that is out of memory: tests/gpu/run.rs forces it",
    ),
    (
        "GpuError::NotFinite",
        "needs an adapter that errs: tests/gpu/run.rs forces it",
    ),
    (
        "GpuError::Size",
        "the command line refuses the grid before, in words of the scene: see calls::past_the_adapter",
    ),
    (
        "SurfaceError::Memory",
        "the system promises memory and then refuses it: the count before it refuses first",
    ),
    (
        "WalkError::Backend",
        "passes the device's failure on; the command line shows what is inside",
    ),
    (
        "WalkError::Observer",
        "passes an output's failure on; the command line shows what is inside",
    ),
    (
        "TheoryError::NotConverged",
        "root finding and quadrature reach their tolerance within the range of their inputs, which is checked before",
    ),
    ("Failure::Backend", "passes the device's failure on"),
    (
        "DeviceError::NotBuilt",
        "needs a build without the feature `gpu`: src/contact asks for it there",
    ),
    ("MemoryError::Cost", "passes a wrong list of fields on"),
    (
        "RunError::Surface",
        "passes a surface's mistake on; the command line shows it with its scene",
    ),
    (
        "RunError::Memory",
        "passes on what the memory does not hold; the command line shows what is inside",
    ),
    (
        "RunError::Device",
        "passes the choice of a device on; the command line shows what is inside",
    ),
    (
        "RunError::Backend",
        "passes the device's failure on; the command line shows what is inside",
    ),
    (
        "RunError::Output",
        "passes an output's failure on; the command line shows what is inside",
    ),
    (
        "SurfaceError::Rank",
        "needs several ranks: tests/solver/ranks.rs ends one",
    ),
    (
        "RunError::Rank",
        "needs several ranks: tests/solver/ranks.rs ends one",
    ),
    (
        "Failure::Rank",
        "needs several ranks: tests/solver/ranks.rs ends one",
    ),
    (
        "DeviceError::Ranks",
        "needs several ranks: tests/solver/ranks.rs asks for it there",
    ),
    (
        "MemoryError::Ranks",
        "needs several ranks: tests/solver/ranks.rs asks for too much there",
    ),
    ("Failure::Mpi", "needs a build with the feature `mpi`"),
    (
        "FileError::Memory",
        "the system promises memory and then refuses it: the count before it refuses first",
    ),
    ("Failure::Fit", "passes a mistake in a curve on"),
    ("MapError::File", "passes a mistake in a height file on"),
    (
        "AccuracyError::Surface",
        "passes a surface's mistake on; the command line shows it with its scene",
    ),
    (
        "CompareError::Output",
        "passes an output's failure on; the command line shows what is inside",
    ),
    (
        "CompareError::Backend",
        "passes the device's failure on; the command line shows what is inside",
    ),
    (
        "ContactError::Mistakes",
        "passes mistakes of a scene on, which tests/command_line/contact.rs reads",
    ),
    ("ContactError::Surface", "passes a surface's mistake on"),
    (
        "ContactError::Memory",
        "passes on what the memory does not hold",
    ),
    (
        "ContactError::Device",
        "passes the choice of a device on: tests/command_line/contact.rs reads it",
    ),
    ("ContactError::Backend", "passes the device's failure on"),
    ("Stopped::Out", "a model of compare ends; a note says why"),
    (
        "Stopped::End",
        "a model of compare ends after some of its rows; a note says why",
    ),
    ("Stopped::Theory", "passes a theory's own range on"),
    ("Stopped::Output", "passes an output's failure on"),
];

/// The fewest bad scenes, files and calls that are held here.
const FEWEST: usize = 200;

fn every_variant_of_every_error_is_reached() {
    let edits = scenes::reached();
    let mut reached: Vec<Reached> = edits
        .iter()
        .map(|mistake| Reached {
            variant: format!("SceneError::{}", head(&mistake.error)),
            message: mistake.error.to_string(),
        })
        .collect();
    for mistake in &edits {
        if let tabor::scene::SceneError::Unit(error) = &mistake.error {
            reached.push(Reached {
                variant: format!("UnitError::{}", head(error)),
                message: error.to_string(),
            });
        }
    }
    let (files, calls, curves) = (files::reached(), calls::reached(), curves::reached());
    let count = scenes::count() + files.len() + calls.len() + curves.len();
    assert!(count >= FEWEST, "only {count} mistakes");
    reached.extend(files);
    reached.extend(calls);
    reached.extend(curves);

    let variants = variants::all();
    assert!(
        variants.len() > 80,
        "only {} variants found",
        variants.len()
    );
    let mut wrong = Vec::new();
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for one in &reached {
        match variants.iter().find(|variant| variant.name == one.variant) {
            None => wrong.push(format!("{} is no variant of the crate", one.variant)),
            Some(variant) => {
                *counts.entry(&variant.name).or_default() += 1;
                if !variant.is_in(&one.message) {
                    wrong.push(format!("{} does not say: {}", one.variant, one.message));
                }
            }
        }
    }
    for variant in &variants {
        let is_reached = counts.contains_key(variant.name.as_str());
        let reason = OUT_OF_REACH.iter().find(|(name, _)| *name == variant.name);
        match (is_reached, reason) {
            (false, None) => wrong.push(format!(
                "{} ({}) is not reached: add a row to a table of tests/command_line/mistakes, or its reason to OUT_OF_REACH",
                variant.name,
                variant.file.display()
            )),
            (true, Some(_)) => wrong.push(format!("{} is reached, and listed as not", variant.name)),
            _ => {}
        }
    }
    for (name, _) in OUT_OF_REACH {
        if !variants.iter().any(|variant| variant.name == *name) {
            wrong.push(format!("{name} of OUT_OF_REACH is no variant of the crate"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The variant of an error, by its `Debug` form.
fn head(error: &impl std::fmt::Debug) -> String {
    format!("{error:?}")
        .chars()
        .take_while(|letter| letter.is_alphanumeric())
        .collect()
}

tests![every_variant_of_every_error_is_reached,];
