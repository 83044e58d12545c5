//! Height files and adhesion maps over several ranks: the rows of each are those of one process.

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::thread;

use tabor::backend::ranks::{Ranks, ThreadRanks};
use tabor::scene::Scene;
use tabor::surface::Surface;

use crate::shared::trials::tests;

const ADHESION: &str =
    "[adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = \"10 mJ/m^2\"\nrange = \"10 nm\"\n";
const PRESSURE: &str = "[loading]\ncontrol = \"pressure\"\npath = [2e5]";
const FORCE: &str = "[loading]\ncontrol = \"force\"\npath = [1e-6]";

/// Maps of other programs in tests/files.
const FILES: [&str; 32] = [
    "asylum.ibw",
    "bruker_10.spm",
    "bruker_5.spm",
    "description.vk4",
    "description.vk6",
    "gdal.xyz",
    "gdal_6.grd",
    "gdal_7.grd",
    "gdal_text.grd",
    "gwyddion.gsf",
    "gwyddion.gwy",
    "gwyddion.sdf",
    "gwyddion.sur",
    "gwyddion.txt",
    "gwyfile_mask.gwy",
    "mountains.x3p",
    "nanosurf.nid",
    "numpy_fortran.npy",
    "numpy_half.npy",
    "pillow_16.png",
    "pillow_lzw.tif",
    "sensofar.plu",
    "surfalize.al3d",
    "surfalize.sur",
    "surfalize_binary.sdf",
    "surfalize_holes.sur",
    "surfalize_text.sdf",
    "tifffile_16.tif",
    "tifffile_deflate.tif",
    "tifffile_float.tif",
    "wyko.opd",
    "zygo.dat",
];

/// A .npy file of doubles, `order` C or Fortran.
fn npy(
    path: &Path,
    [columns, rows]: [usize; 2],
    is_fortran: bool,
    value: impl Fn(usize, usize) -> f64,
) {
    let fortran = if is_fortran { "True" } else { "False" };
    let header =
        format!("{{'descr': '<f8', 'fortran_order': {fortran}, 'shape': ({rows}, {columns}), }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    for at in 0..rows * columns {
        let [row, column] = if is_fortran {
            [at % rows, at / rows]
        } else {
            [at / columns, at % columns]
        };
        bytes.extend(value(row, column).to_le_bytes());
    }
    fs::write(path, bytes).expect("a file");
}

/// The surface on so many ranks: heights and map of all of them, or what each one says.
fn surface_over(scene: &Scene, count: usize) -> Result<[Vec<u64>; 2], Vec<String>> {
    let built: Vec<_> = thread::scope(|scope| {
        let built = |rank| {
            let ranks: Arc<dyn Ranks> = Arc::new(rank);
            scope.spawn(move || Surface::on_ranks(scene, Some(ranks)))
        };
        let threads: Vec<_> = ThreadRanks::new(count).into_iter().map(built).collect();
        let ends = threads.into_iter().map(|thread| thread.join());
        ends.map(|end| end.expect("no panic")).collect()
    });
    if built.iter().any(|surface| surface.is_err()) {
        let said = built.into_iter().map(|surface| match surface {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        });
        return Err(said.collect());
    }
    let mut all = [Vec::new(), Vec::new()];
    for surface in built.into_iter().flatten() {
        all[0].extend(surface.heights.iter().map(|height| height.to_bits()));
        let map = surface.adhesion_map.unwrap_or_default();
        all[1].extend(map.into_iter().map(f64::to_bits));
    }
    Ok(all)
}

/// Heights and maps from files have the bits of one process: read by rows, and read whole by one rank; what is wrong with a
/// file is said once, in the same words.
fn height_files() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let points = [24, 38];
    let height = |row: usize, column: usize| {
        1e-9 * ((row * 7 + column * 3) as f64).sin() + 3e-10 * row as f64 - 2e-10 * column as f64
    };
    let at = |name: &str| place.path().join(name);
    npy(&at("rows.npy"), points, false, height);
    npy(&at("columns.npy"), points, true, height);
    npy(&at("holes.npy"), points, false, |row, column| {
        match [row, column] {
            // Holes over the edges of the map and of the rows of a rank.
            [9, 4] | [30, 5] | [0, 3] | [37, 3] | [7, 20] | [8, 20] => f64::NAN,
            [31, 7] => f64::INFINITY,
            _ => height(row, column),
        }
    });
    npy(&at("spikes.npy"), points, false, |row, column| {
        height(row, column)
            * if [row, column] == [16, 8] || [row, column] == [0, 23] {
                300.0
            } else {
                1.0
            }
    });
    npy(&at("map.npy"), points, false, |row, column| {
        0.5 + ((row + column) % 3) as f64
    });
    npy(&at("wrong.npy"), points, false, |row, _| {
        if row == 20 { -2.5 } else { 1.0 }
    });
    npy(&at("nothing.npy"), points, false, |_, _| 0.0);
    let line = |row: usize| -> String {
        let numbers = (0..points[0]).map(|column| format!("{:e} ", height(row, column)));
        numbers.collect::<String>() + "\n"
    };
    fs::write(at("map.txt"), (0..points[1]).map(line).collect::<String>()).expect("a file");
    fs::write(at("line.txt"), line(0)).expect("a file");
    npy(&at("larger.npy"), [31, 50], false, height);
    npy(&at("line.npy"), [24, 1], false, height);
    let file = |name: &str, asked: &str| {
        format!("[[surface]]\nkind = \"file\"\npath = \"{name}\"\nscale = 2.0\n{asked}")
    };
    let scene = |surface: &str, map: &str, boundary: &str| {
        let map = if map.is_empty() {
            String::new()
        } else {
            format!("{ADHESION}map = {map}\n")
        };
        let text = format!(
            "[grid]\npoints = {points:?}\nsize = [\"2 um\", \"3 um\"]\nboundary = \"{boundary}\"\n[solid]\ncontact_modulus = \"50 MPa\"\n{surface}{map}{}\n",
            if boundary == "free" { FORCE } else { PRESSURE }
        );
        Scene::parse(&text, "scene.toml", place.path(), &[])
            .unwrap_or_else(|e| panic!("{e}\n{text}"))
    };
    let whole = |scene: &Scene| {
        Surface::build(scene).map(|surface| {
            let map = surface.adhesion_map.unwrap_or_default();
            let bits = |values: &[f64]| {
                values
                    .iter()
                    .map(|value| value.to_bits())
                    .collect::<Vec<_>>()
            };
            [bits(&surface.heights), bits(&map)]
        })
    };
    let both = file("rows.npy", "detrend = \"quadratic\"\n") + &file("map.txt", "");
    for (surface, map) in [
        (file("rows.npy", ""), ""),
        (file("rows.npy", "detrend = \"plane\"\n"), "\"map.npy\""),
        (file("rows.npy", "detrend = \"lines\"\n"), "\"map.npy\""),
        (
            both,
            "{ pattern = \"checker\", period = 0.5e-6, low = 0.2, high = 1.5 }",
        ),
        (
            file("columns.npy", "detrend = \"mean\"\n"),
            "\"columns.npy\"",
        ),
        (file("rows.npy", "edges = \"window\"\n"), ""),
        (file("holes.npy", "fill = \"interpolate\"\n"), ""),
        (file("spikes.npy", "outliers = 5.0\n"), ""),
        (
            file(
                "holes.npy",
                "fill = \"interpolate\"\noutliers = 6.0\nedges = \"window\"\ncrop = [1, 0, 23, 37]\n",
            ),
            "",
        ),
        (
            file("rows.npy", "edges = \"mirror\"\nresample = [24, 38]\n"),
            "",
        ),
        (file("line.txt", "profile = true\n"), ""),
        (file("holes.npy", ""), ""),
        (file("none.npy", ""), ""),
        (
            file("larger.npy", "crop = [5, 9, 24, 38]\ndetrend = \"plane\"\n"),
            "\"map.npy\"",
        ),
        (file("larger.npy", "crop = [0, 12, 24, 38]\n"), ""),
        (file("larger.npy", "crop = [5, 20, 24, 38]\n"), ""),
        (file("line.npy", ""), ""),
        (file("rows.npy", ""), "\"wrong.npy\""),
        (file("rows.npy", ""), "\"nothing.npy\""),
    ] {
        for boundary in ["periodic", "free"] {
            let scene = scene(&surface, map, boundary);
            let one = whole(&scene);
            for count in [2, 5, 7] {
                match (&one, surface_over(&scene, count)) {
                    (Ok(one), Ok(found)) => assert!(*one == found, "{surface}{map} on {count}"),
                    (Err(error), Err(said)) => {
                        let error = error.to_string();
                        assert_eq!(said[0], error);
                        let is_known = |words: &String| {
                            *words == error || words.contains("rank 0 of this run has ended")
                        };
                        assert!(said.iter().all(is_known), "{said:?}");
                    }
                    (one, found) => panic!("{surface}{map} on {count}: {one:?}, {found:?}"),
                }
            }
        }
    }
}

/// A file that one rank would hold whole has few points, or is refused by all ranks in the same words, by what its header
/// says, by its length, or once its numbers are counted; a process alone reads it.
fn large_files_are_refused() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| place.path().join(name);
    let refused = |surface: &str, map: &str| -> String {
        let text = format!(
            "[grid]\npoints = [24, 38]\nsize = [\"2 um\", \"3 um\"]\n[solid]\ncontact_modulus = \"50 MPa\"\n{surface}{map}{PRESSURE}\n"
        );
        let scene = Scene::parse(&text, "scene.toml", place.path(), &[])
            .unwrap_or_else(|e| panic!("{e}\n{text}"));
        let said = surface_over(&scene, 3).expect_err("it is refused");
        assert!(said.iter().all(|words| *words == said[0]), "{said:?}");
        said[0].clone()
    };
    // The header and a hole, which takes no room: no number is read.
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (4097, 4096), }\n";
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    fs::write(at("filled.npy"), &bytes).expect("a file");
    let filled = fs::File::options().write(true).open(at("filled.npy"));
    let length = bytes.len() + 8 * 4097 * 4096;
    filled
        .and_then(|file| file.set_len(length as u64))
        .expect("a length");
    let header = "4096 x 4097 points are more than the 16777216 points that the first of several processes reads whole; prepare the file once on one process";
    let file = |name: &str| format!("[[surface]]\nkind = \"file\"\npath = \"{name}\"\n");
    for asked in ["edges = \"mirror\"\n", "resample = [24, 38]\n"] {
        let said = refused(&(file("filled.npy") + asked), "");
        assert!(
            said.contains(header) && said.contains("filled.npy"),
            "{said}"
        );
    }
    let long = fs::File::create(at("long.txt")).expect("a file");
    long.set_len((1 << 29) + 1).expect("a length");
    let said = refused(&file("long.txt"), "");
    assert!(
        said.contains("536870913 bytes of numbers are more than"),
        "{said}"
    );
    let map = format!("{ADHESION}map = \"long.txt\"\n");
    let said = refused("[[surface]]\nkind = \"flat\"\n", &map);
    assert!(
        said.contains("536870913 bytes of numbers are more than") && said.contains("long.txt"),
        "{said}"
    );
    fs::write(at("map.txt"), ("0 ".repeat(4097) + "\n").repeat(4096)).expect("a file");
    let said = refused(&file("map.txt"), "");
    assert!(said.contains("4097 x 4096 points are more than"), "{said}");
}

/// Files of other programs, in every format, have the bits of one process.
fn files_of_other_programs() {
    let place = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files");
    let is_built = |name: &str, size: &str, asked: &str| {
        let text = format!(
            "[grid]\nboundary = \"free\"\n{size}[solid]\ncontact_modulus = \"50 MPa\"\n[[surface]]\nkind = \"file\"\npath = \"{name}\"\nfill = \"interpolate\"\n{asked}{FORCE}\n"
        );
        let scene = Scene::parse(&text, "scene.toml", &place, &[]).expect("a scene");
        let one = Surface::build(&scene);
        for count in [2, 3] {
            match (&one, surface_over(&scene, count)) {
                (Ok(one), Ok([found, _])) => {
                    let bits = one.heights.iter().map(|height| height.to_bits());
                    assert!(bits.eq(found), "{name} on {count}");
                }
                (Err(error), Err(said)) => assert_eq!(said[0], error.to_string(), "{name}"),
                (one, found) => panic!("{name} on {count}: {one:?}, {found:?}"),
            }
        }
        one.is_ok()
    };
    for name in FILES {
        let is_grey = name.ends_with(".png") || (name.ends_with(".tif") && !name.contains("float"));
        let asked = if is_grey {
            "black = 0.0\nwhite = 1e-9\n"
        } else {
            ""
        };
        // Not every file says how large its map is.
        let sizes = ["", "size = \"1 um\"\n"];
        let is_any = sizes.iter().any(|size| is_built(name, size, asked));
        assert!(is_any, "{name}");
    }
}

tests![
    height_files,
    large_files_are_refused,
    files_of_other_programs
];
