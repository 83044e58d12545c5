//! `tabor devices`: adapters found and what each can do.

use std::num::NonZero;

use super::{Failure, print};
#[cfg(feature = "gpu")]
use crate::backend::gpu::{AdapterDescription, Number};
#[cfg(feature = "gpu")]
use crate::device::{best, list};
#[cfg(feature = "gpu")]
use crate::scene::Precision;

/// Prints the adapters and which one `auto` takes.
#[cfg(feature = "gpu")]
pub(super) fn devices(verbose: bool) -> Result<(), Failure> {
    print(&describe(&list(verbose)))
}

/// Prints the processor.
#[cfg(not(feature = "gpu"))]
pub(super) fn devices(_verbose: bool) -> Result<(), Failure> {
    print(&format!(
        "{}\nadapter       none looked for: this build is without the feature `gpu`\nauto          the processor\n",
        processor()
    ))
}

/// The processor, in words.
fn processor() -> String {
    let threads = std::thread::available_parallelism().map_or(1, NonZero::get);
    format!(
        "processor     {threads} threads\n\
         \x20 precision   single, mixed, double\n\
         \x20 largest     any grid that the memory holds"
    )
}

#[cfg(feature = "gpu")]
fn describe(found: &[AdapterDescription]) -> String {
    let mut lines = vec![processor()];
    for (index, adapter) in found.iter().enumerate() {
        let side = adapter.largest_side(Number::Single);
        let in_double = adapter.largest_side(Number::Double);
        lines.push(format!(
            "adapter {}     {}\n\
             \x20 type        {}\n\
             \x20 driver      {} {}\n\
             \x20 precision   single, mixed{}\n\
             \x20 largest     {side} x {side} points in single and mixed, {half} x {half} with a free boundary{}",
            index + 1,
            adapter.name,
            adapter.kind.name(),
            adapter.interface,
            adapter.driver,
            match adapter.double {
                true => ", double; sums in double",
                false => "; no double on the device, so sums are compensated and the processor corrects",
            },
            match adapter.double {
                true => format!(
                    "\n\
                     \x20             {in_double} x {in_double} in double, {0} x {0} with a free boundary; above, the processor corrects mixed",
                    in_double / 2
                ),
                false => String::new(),
            },
            half = side / 2,
        ));
    }
    if found.is_empty() {
        lines.push("adapter       none found: no Vulkan, Metal or Direct3D 12 driver".to_owned());
    }
    lines.push(match (best(found), found) {
        (Some(adapter), _) => format!(
            "auto          {}, from 512 x 512 solved points on: in single precision for tolerances from {:e}, in mixed below; {}; the processor for smaller grids",
            adapter.name,
            Precision::SINGLE_FLOOR,
            match adapter.double {
                true => "in double for precision = \"double\"",
                false => "the processor for precision = \"double\"",
            }
        ),
        (None, []) => "auto          the processor: there is no adapter".to_owned(),
        (None, _) => "auto          the processor: no adapter is more than software on it".to_owned(),
    });
    lines.push(String::new());
    lines.join("\n")
}
