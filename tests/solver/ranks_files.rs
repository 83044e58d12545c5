//! Height files and adhesion maps over several ranks: the rows of each are those of one process.

use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::thread;

use tabor::backend::ranks::{Ranks, ThreadRanks};
use tabor::scene::{Scene, SurfacePart};
use tabor::surface::Surface;

use crate::shared::trials::tests;

const ADHESION: &str =
    "[adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = \"10 mJ/m^2\"\nrange = \"10 nm\"\n";
const PRESSURE: &str = "[loading]\ncontrol = \"pressure\"\npath = [2e5]";
const FORCE: &str = "[loading]\ncontrol = \"force\"\npath = [1e-6]";

/// Maps of other programs in tests/files.
const FILES: [&str; 40] = [
    "asylum.ibw",
    "bruker_10.spm",
    "bruker_5.spm",
    "description.vk4",
    "description.vk6",
    "gdal.xyz",
    "gdal_6.grd",
    "gdal_7.grd",
    "gdal_differences.tif",
    "gdal_text.grd",
    "gwyddion.gsf",
    "gwyddion.gwy",
    "gwyddion.sdf",
    "gwyddion.sur",
    "gwyddion.txt",
    "gwyddion.xyz",
    "gwyfile_mask.gwy",
    "mountains.x3p",
    "nanosurf.nid",
    "numpy_columns.csv",
    "numpy_fortran.npy",
    "numpy_half.npy",
    "pillow_16.png",
    "pillow_lzw.tif",
    "pypng_interlaced.png",
    "sensofar.plu",
    "surfalize.al3d",
    "surfalize.sur",
    "surfalize_binary.sdf",
    "surfalize_holes.sur",
    "surfalize_text.sdf",
    "tifffile_16.tif",
    "tifffile_deflate.tif",
    "tifffile_float.tif",
    "tifffile_packbits.tif",
    "tifffile_planes.tif",
    "tifffile_planes_64.tif",
    "tifffile_strips.tif",
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

/// The bits of heights and adhesion map, and what a run is warned of.
type Found = ([Vec<u64>; 2], Vec<String>);

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// The surface on so many ranks: heights and map of all of them and the warnings of the first, or what each one says.
fn surface_over(scene: &Scene, count: usize) -> Result<Found, Vec<String>> {
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
    let mut warnings = Vec::new();
    for (rank, surface) in built.into_iter().flatten().enumerate() {
        all[0].extend(bits(&surface.heights));
        all[1].extend(bits(&surface.adhesion_map.unwrap_or_default()));
        if rank == 0 {
            warnings = surface.warnings;
        }
    }
    Ok((all, warnings))
}

/// The surface of a scene is on each of so many ranks that of one process, or wrong in the same words. Whether it is one.
fn same_over(scene: &Scene, counts: &[usize], what: &str) -> bool {
    let one = Surface::build(scene).map(|surface| {
        let map = surface.adhesion_map.unwrap_or_default();
        ([bits(&surface.heights), bits(&map)], surface.warnings)
    });
    for &count in counts {
        match (&one, surface_over(scene, count)) {
            (Ok(one), Ok(found)) => {
                assert_eq!(one.1, found.1, "{what} on {count}");
                assert!(one.0 == found.0, "{what} on {count}");
            }
            (Err(error), Err(said)) => {
                let error = error.to_string();
                assert_eq!(said[0], error);
                let is_known = |words: &String| {
                    *words == error || words.contains("rank 0 of this run has ended")
                };
                assert!(said.iter().all(is_known), "{said:?}");
            }
            (one, found) => panic!("{what} on {count}: {one:?}, {found:?}"),
        }
    }
    one.is_ok()
}

fn file(name: &str, asked: &str) -> String {
    format!("[[surface]]\nkind = \"file\"\npath = \"{name}\"\nscale = 2.0\n{asked}")
}

/// A scene of these surfaces and of this adhesion map, which may be none.
fn scene(place: &Path, grid: &str, boundary: &str, surface: &str, map: &str) -> Scene {
    let map = if map.is_empty() {
        String::new()
    } else {
        format!("{ADHESION}map = {map}\n")
    };
    let text = format!(
        "[grid]\n{grid}\nboundary = \"{boundary}\"\n[solid]\ncontact_modulus = \"50 MPa\"\n{surface}{map}{}\n",
        if boundary == "free" { FORCE } else { PRESSURE }
    );
    Scene::parse(&text, "scene.toml", place, &[]).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Rough heights on a tilted plane.
fn height(row: usize, column: usize) -> f64 {
    1e-9 * ((row * 7 + column * 3) as f64).sin() + 3e-10 * row as f64 - 2e-10 * column as f64
}

/// Heights and maps from files, whose formats give rows or all, have the bits of one process; what is wrong with a file is
/// said once, in the same words.
fn height_files() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let points = [24, 38];
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
    let map = (0..points[1]).map(line).collect::<String>();
    fs::write(at("map.txt"), &map).expect("a file");
    // Wrong in the last line, in two ways.
    fs::write(at("word.txt"), map.clone() + &line(0).replace("e-", "x")).expect("a file");
    fs::write(at("short.txt"), map.clone() + "1 2\n").expect("a file");
    let grid = format!("DSAA\n24 39\n0 2\n0 3\n0 1\n{map}");
    fs::write(at("map.grd"), grid.clone() + &line(5)).expect("a file");
    fs::write(at("word.grd"), grid + &line(5).replace("e-", "x")).expect("a file");
    fs::write(
        at("holes.csv"),
        map.replacen("e-9 ", "e-9,,", 3).replace(' ', ","),
    )
    .expect("a file");
    fs::write(at("line.txt"), line(0)).expect("a file");
    npy(&at("larger.npy"), [31, 50], false, height);
    npy(&at("line.npy"), [24, 1], false, height);
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
        (file("holes.npy", ""), ""),
        (file("none.npy", ""), ""),
        (
            file("larger.npy", "crop = [5, 9, 24, 38]\ndetrend = \"plane\"\n"),
            "\"map.npy\"",
        ),
        (file("larger.npy", "crop = [0, 12, 24, 38]\n"), ""),
        (file("larger.npy", "crop = [5, 20, 24, 38]\n"), ""),
        (file("line.npy", ""), ""),
        (file("line.txt", ""), ""),
        (
            file(
                "map.txt",
                "crop = [2, 3, 20, 30]\nedges = \"mirror\"\nresample = [24, 38]\n",
            ),
            "\"map.txt\"",
        ),
        (file("word.txt", "crop = [0, 0, 24, 38]\n"), ""),
        (file("short.txt", ""), ""),
        (file("map.grd", "crop = [0, 1, 24, 38]\n"), ""),
        (file("word.grd", "crop = [0, 0, 24, 38]\n"), ""),
        (file("holes.csv", "fill = \"interpolate\"\n"), ""),
        (file("holes.csv", ""), ""),
        (file("rows.npy", ""), "\"wrong.npy\""),
        (file("rows.npy", ""), "\"nothing.npy\""),
    ] {
        for boundary in ["periodic", "free"] {
            let grid = format!("points = {points:?}\nsize = [\"2 um\", \"3 um\"]");
            let scene = scene(place.path(), &grid, boundary, &surface, map);
            same_over(&scene, &[2, 5, 7], &format!("{surface}{map}"));
        }
    }
}

/// What makes other points of those of a file is done by all ranks, each of its rows, with the bits of one process: also where
/// there are more ranks than rows, and of columns of prime length.
fn prepared_files() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| place.path().join(name);
    let wave = |row: usize, column: usize, [columns, rows]: [usize; 2]| {
        let turn = |at: usize, count: usize| std::f64::consts::TAU * at as f64 / count as f64;
        1e-9 * (turn(column, columns) + 2.0 * turn(row, rows)).sin() + 2e-9 * turn(row, rows).cos()
    };
    npy(&at("small.npy"), [13, 17], false, height);
    npy(&at("half.npy"), [12, 19], false, height);
    npy(&at("large.npy"), [31, 53], true, height);
    npy(&at("wide.npy"), [90, 7], false, height);
    npy(&at("waves.npy"), [18, 46], false, |row, column| {
        wave(row, column, [18, 46])
    });
    npy(&at("holes.npy"), [31, 53], false, |row, column| {
        match [row, column] {
            [0, 0] | [7, 20] | [8, 20] | [52, 30] => f64::NAN,
            [30, 30] => 1e-6,
            _ => height(row, column),
        }
    });
    npy(&at("line.npy"), [30, 1], false, height);
    npy(&at("down.npy"), [1, 24], false, height);
    npy(&at("gap.npy"), [24, 1], false, |row, column| match column {
        5 => f64::NAN,
        _ => height(row, column),
    });
    let numbers: String = (0..24).map(|at| format!("{:e} ", height(at, 2))).collect();
    fs::write(at("line.txt"), numbers).expect("a file");
    let pairs = (0..24).map(|at| format!("{:e} {:e}\n", 1e-7 * at as f64, height(at, 2)));
    fs::write(at("places.txt"), pairs.collect::<String>()).expect("a file");
    let given = "points = [24, 38]\nsize = [\"2 um\", \"3 um\"]";
    let by_file = "size = \"2 um\"";
    let of_places = "points = [24, 5]";
    let profile = |asked: &str| format!("profile = true\n{asked}");
    let [fewer, more] = ["resample = [24, 38]\n", "resample = [62, 97]\n"];
    let mirror = "edges = \"mirror\"\n";
    let window = "edges = \"window\"\n";
    let crop = "crop = [2, 3, 12, 19]\n";
    let all = format!(
        "fill = \"interpolate\"\noutliers = 8.0\ndetrend = \"plane\"\n{crop}{mirror}resample = [24, 38]\n"
    );
    for (grid, name, asked, is_one) in [
        (given, "line.txt", profile(""), true),
        (given, "down.npy", profile(""), true),
        (by_file, "line.npy", profile(""), true),
        (of_places, "places.txt", profile(""), true),
        (
            of_places,
            "places.txt",
            profile("resample = [24, 1]\n"),
            true,
        ),
        // Of many lines the first, which is a column here and a row there.
        (by_file, "small.npy", profile(""), true),
        (by_file, "wide.npy", profile(mirror), true),
        (given, "line.npy", profile("crop = [3, 0, 24, 1]\n"), true),
        (given, "line.npy", profile(fewer), true),
        (given, "small.npy", profile(fewer), true),
        (
            given,
            "half.npy",
            profile("crop = [3, 0, 12, 1]\nedges = \"mirror\"\n"),
            true,
        ),
        (
            given,
            "wide.npy",
            profile(&(mirror.to_owned() + fewer)),
            true,
        ),
        (given, "gap.npy", profile("fill = \"interpolate\"\n"), true),
        (by_file, "small.npy", fewer.to_owned(), true),
        (by_file, "small.npy", more.to_owned(), true),
        (by_file, "large.npy", fewer.to_owned(), true),
        (by_file, "large.npy", more.to_owned(), true),
        (by_file, "large.npy", window.to_owned() + fewer, true),
        (by_file, "large.npy", window.to_owned() + more, true),
        (by_file, "waves.npy", fewer.to_owned(), true),
        (by_file, "waves.npy", more.to_owned(), true),
        (
            by_file,
            "waves.npy",
            "resample = [11, 3]\n".to_owned(),
            true,
        ),
        (by_file, "wide.npy", "resample = [9, 41]\n".to_owned(), true),
        (
            by_file,
            "wide.npy",
            format!("{window}resample = [9, 41]\n"),
            true,
        ),
        (given, "half.npy", mirror.to_owned(), true),
        (given, "half.npy", mirror.to_owned() + fewer, true),
        (given, "large.npy", mirror.to_owned() + fewer, true),
        (by_file, "large.npy", mirror.to_owned() + more, true),
        (given, "large.npy", crop.to_owned() + mirror, true),
        (given, "large.npy", crop.to_owned() + fewer, true),
        (given, "large.npy", crop.to_owned() + window + fewer, true),
        (given, "holes.npy", all, true),
        // What one process refuses.
        (given, "line.npy", profile(""), false),
        (given, "line.npy", profile("crop = [8, 0, 24, 1]\n"), false),
        (given, "gap.npy", profile(""), false),
        (given, "none.npy", profile(""), false),
        (given, "large.npy", mirror.to_owned(), false),
        (given, "holes.npy", fewer.to_owned(), false),
        (given, "large.npy", more.to_owned(), false),
    ] {
        for boundary in ["periodic", "free"] {
            let what = format!("{boundary} {name} {asked}");
            let scene = scene(place.path(), grid, boundary, &file(name, &asked), "");
            let found = same_over(&scene, &[1, 2, 3, 4, 7, 40], &what);
            assert_eq!(found, is_one, "{what}");
        }
    }
    // More than a scene file can ask for.
    let mut scene = scene(place.path(), by_file, "free", &file("small.npy", fewer), "");
    if let [SurfacePart::File(file)] = &mut scene.surfaces[..] {
        file.preparation.resample = Some([usize::MAX, 2]);
    }
    assert!(!same_over(&scene, &[2], "too many points"));
    let said = Surface::build(&scene).expect_err("too many points");
    assert!(said.to_string().contains("points are too many"), "{said}");
}

/// Files of other programs, in every format, have the bits of one process.
fn files_of_other_programs() {
    let place = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files");
    let is_built = |name: &str, size: &str, asked: &str| {
        let text = format!(
            "[grid]\nboundary = \"free\"\n{size}[solid]\ncontact_modulus = \"50 MPa\"\n[[surface]]\nkind = \"file\"\npath = \"{name}\"\nfill = \"interpolate\"\n{asked}{FORCE}\n"
        );
        let scene = Scene::parse(&text, "scene.toml", &place, &[]).expect("a scene");
        same_over(&scene, &[2, 3], name)
    };
    for name in FILES {
        let is_grey = name.ends_with(".png")
            || (name.ends_with(".tif")
                && !["float", "planes", "differences"]
                    .iter()
                    .any(|kind| name.contains(kind)));
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

tests![height_files, prepared_files, files_of_other_programs];
