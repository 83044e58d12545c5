//! The shader that reads every member of the params and the scalars, for a test of both layouts.

use std::fmt::Write;

use super::super::layout::{self, Wide};
use super::preamble;
use crate::kernel::Scalars;
use crate::kernel::declare::{DeviceValue, Kind, members};

/// Copies every word of the params and then of the scalars into an array of wide numbers. Its entry point is
/// `copy_members`. Also says how many words there are.
pub fn copy_members(wide: Wide) -> (String, usize) {
    let mut source = String::new();
    preamble(&mut source, wide, "read");
    source.push_str(
        "@group(1) @binding(0) var<storage, read_write> found: array<wide>;\n\
         @compute @workgroup_size(1)\n\
         fn copy_members() {\n",
    );
    let mut count = 0;
    for (owner, members) in [
        ("params", layout::params_members()),
        ("scalars", members(Scalars::KIND)),
    ] {
        for (member, kind) in members {
            match kind {
                Kind::Wide(1) => {
                    let _ = writeln!(source, "found[{count}] = {owner}.{member};");
                    count += 1;
                }
                Kind::Wide(length) => {
                    for place in 0..length {
                        let _ = writeln!(source, "found[{count}] = {owner}.{member}[{place}];");
                        count += 1;
                    }
                }
                Kind::Count | Kind::Group(_) => {
                    let _ = writeln!(source, "found[{count}] = wide({owner}.{member});");
                    count += 1;
                }
            }
        }
    }
    source.push_str("}\n");
    (source, count)
}
