//! Surfaces from outside: scenes with files in, heights or one clear sentence out.

use std::f64::consts::PI;
use std::fs;
use std::path::{Path, PathBuf};

use approx::assert_relative_eq;
use tabor::scene::{
    Boundary, Detrend, Edges, Fill, GridScene, HeightFileScene, Roughness, SelfAffineScene,
    SurfacePart,
};
use tabor::surface::{Surface, SurfaceError, Top};

/// A .npy file of version 1 with this description and these bytes.
fn npy(description: &str, bytes: &[u8]) -> Vec<u8> {
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((description.len() as u16).to_le_bytes());
    file.extend(description.as_bytes());
    file.extend(bytes);
    file
}

/// Description of an array of `kind` and `shape` as NumPy writes it.
fn description(kind: &str, fortran: &str, shape: &str) -> String {
    format!("{{'descr': '{kind}', 'fortran_order': {fortran}, 'shape': {shape}, }}\n")
}

/// The heights 0, 1, ... 5 in 2 rows of 3 columns as little-endian doubles.
fn six() -> Vec<u8> {
    (0..6).flat_map(|i| f64::from(i).to_le_bytes()).collect()
}

fn file_part(path: &Path) -> HeightFileScene {
    HeightFileScene {
        preparation: tabor::scene::Preparation::default(),
        path: path.to_owned(),
        unit: 1.0,
        scale: 1.0,
        black: None,
        white: None,
        detrend: Detrend::None,
        fill: Fill::None,
    }
}

fn grid(points: Option<[usize; 2]>) -> GridScene {
    GridScene {
        points,
        size: Some([3e-6, 2e-6]),
        boundary: Boundary::Free,
    }
}

/// Builds the surface of one file on a free grid of 3 by 2 micrometres.
fn build(part: HeightFileScene) -> Result<Surface, SurfaceError> {
    Surface::from_parts(&grid(None), &[SurfacePart::File(part)])
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, bytes).unwrap();
    path
}

#[test]
#[rustfmt::skip]
fn bad_files_are_refused_in_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let c_order = |kind: &str, shape: &str| description(kind, "False", shape);
    let mut other_version = npy(&c_order("<f8", "(2, 3)"), &six());
    other_version[6] = 9;
    let mut endless_header = b"\x93NUMPY\x02\x00".to_vec();
    endless_header.extend(u32::MAX.to_le_bytes());
    let deep = format!("{{'descr': {}'<f8', 'fortran_order': False, 'shape': (2, 3)}}", "(".repeat(100));

    let files: Vec<(&str, Vec<u8>, &str)> = vec![
        ("empty.npy", vec![], "the file is empty (0 bytes)"),
        ("empty.txt", vec![], "the file is empty (0 bytes)"),
        ("blank.txt", b"\n \n\t\n".to_vec(), "the file holds no numbers"),
        ("comments.txt", b"# 1 2\n% 3 4\n// 5\n".to_vec(), "the file holds no numbers"),
        ("words.csv", b"height,width\n".to_vec(), "the file holds no numbers"),
        ("ragged.txt", b"1 2 3\n4 5 6\n7 8\n".to_vec(), "line 3 (row 3) has 2 values where the rows above have 3; every row must have as many"),
        ("ragged.csv", b"# c\n1,2\n\n3,4,5\n".to_vec(), "line 4 (row 2) has 3 values where the rows above have 2"),
        ("word.txt", b"1 2\n3 four\n".to_vec(), "line 2 (row 2), column 2: \"four\" is not a number"),
        ("two_headers.txt", b"a b\nc d\n1 2\n".to_vec(), "line 2 (row 1), column 1: \"c\" is not a number"),
        ("two_marks.csv", b"1;2\n3;1,000.5\n".to_vec(), "line 2 (row 2), column 2: \"1,000.5\" is not a number"),
        ("nan.txt", b"1 nan\nnan inf\n".to_vec(), "3 of 4 pixels are missing (1 of them infinite), the first at row 1, column 2; write fill = \"interpolate\""),
        ("places.csv", b";1;2;3\n1;5;9;4\n2;6;3;8\n3;4;4;1\n".to_vec(), "from their neighbours; if the first row and the first column are places, crop leaves them out"),
        ("hole.csv", b"1;2\n3;\n5;6\n".to_vec(), "1 of 6 pixels are missing (0 of them infinite), the first at row 2, column 2"),
        ("nul.txt", b"1 2\n3 \0\n".to_vec(), "the file is not text: byte 6 is 0"),
        ("wide.txt", b"\xFF\xFE1\0 \0".to_vec(), "the text is in UTF-16; save it as UTF-8"),
        ("map.png", b"\x89PNG\r\n\x1a\n".to_vec(), "broken PNG image: "),
        ("map.gsf", b"Gwyddion Simple Field 1.0\n".to_vec(), "broken .gsf file at byte 26: no zero byte ends the header"),
        ("map.vtk", b"# vtk\n".to_vec(), "height files of kind .vtk are not in this version; docs/surfaces.md lists those that are"),
        ("map.TIF", b"II*\0".to_vec(), "broken TIFF image: "),
        ("map", b"1 2\n".to_vec(), "the name has no extension"),
        ("image.txt", b"\x89PNG\r\n\x1a\n".to_vec(), "the name says .txt, but the file holds a PNG image"),
        ("array.csv", npy(&c_order("<f8", "(2, 3)"), &six()), "the name says .csv, but the file holds a NumPy array (.npy)"),
        ("text.npy", b"1 2\n3 4\n".to_vec(), "the name says .npy, but the file holds no NumPy array"),
        ("archive.npy", b"PK\x03\x04....".to_vec(), "the name says .npy, but the file holds a ZIP archive"),
        ("short.npy", npy(&c_order("<f8", "(2, 3)"), &six()[..40]), "the file is cut short: 2 rows of 3 columns need 48 bytes, there are 40"),
        ("huge.npy", npy(&c_order("<f8", "(20000, 20000)"), &six()), "20000 rows of 20000 columns need 3200000000 bytes, there are 48"),
        ("vast.npy", npy(&c_order("<f8", "(4294967296, 4294967)"), &six()), "18446742802399232 points are too many; at most 17179869184 can be taken"),
        ("overflow.npy", npy(&c_order("<f8", "(18446744073709551615, 18446744073709551615)"), &six()), "its shape (18446744073709551615, 18446744073709551615) exceeds all memory"),
        ("twice.npy", npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), 'shape': (99999999999, 99999999999)}", &six()), "exceeds all memory"),
        ("line.npy", npy(&c_order("<f8", "(6,)"), &six()), "the array has shape [6]; heights need two dimensions, [rows (y), columns (x)]"),
        ("cube.npy", npy(&c_order("<f8", "(1, 2, 3)"), &six()), "the array has shape [1, 2, 3]"),
        ("scalar.npy", npy(&c_order("<f8", "()"), &six()), "the array has shape []"),
        ("nothing.npy", npy(&c_order("<f8", "(0, 3)"), &[]), "the file holds no numbers"),
        ("complex.npy", npy(&c_order("<c16", "(1, 3)"), &six()), "elements of type <c16 are not heights; save them as float32, float64 or an integer type"),
        ("quadruple.npy", npy(&c_order("<f16", "(1, 3)"), &six()), "elements of type <f16 are not heights"),
        ("mask.npy", npy(&c_order("|b1", "(2, 3)"), &six()), "elements of type |b1 are not heights"),
        ("strings.npy", npy(&c_order("<U4", "(1, 3)"), &six()), "elements of type <U4 are not heights"),
        ("objects.npy", npy(&c_order("|O", "(1, 1)"), &six()), "elements of type |O are not heights"),
        ("record.npy", npy("{'descr': [('x', '<f8'), ('y', '<f8')], 'fortran_order': False, 'shape': (1, 3)}", &six()), "are not heights"),
        ("magic.npy", b"\x93NUMPY".to_vec(), "broken .npy file: it ends within the header"),
        ("header.npy", b"\x93NUMPY\x01\x00\xFF\x00{'descr'".to_vec(), "broken .npy file: it ends within the header"),
        ("endless.npy", endless_header, "broken .npy file: a header of 4294967295 bytes is too long for a plain array"),
        ("version.npy", other_version, "broken .npy file: version 9 of the format is not known"),
        ("python.npy", npy("{'descr': '<f8'}", &six()), "broken .npy file: dict is missing key 'fortran_order'"),
        ("garbage.npy", npy("{{{{", &six()), "broken .npy file: could not parse"),
        ("deep.npy", npy(&deep, &six()), "broken .npy file: its header does not describe a plain array"),
        ("control.npy", npy("{'descr': '\u{7}'}", &six()), "broken .npy file: its header does not describe a plain array"),
        ("negative.npy", npy(&c_order("<f8", "(-2, 3)"), &six()), "broken .npy file: dimension cannot be negative"),
        ("nan.npy", npy(&c_order("<f8", "(1, 1)"), &f64::NAN.to_le_bytes()), "1 of 1 pixels are missing"),
    ];
    assert!(files.len() >= 25);
    for (name, bytes, fragment) in &files {
        let path = write(folder.path(), name, bytes);
        let message = build(file_part(&path)).expect_err(name).to_string();
        assert!(message.contains(fragment), "{name}: {message}");
        let start = format!("[[surface]] 1: {}: ", path.display());
        assert!(message.starts_with(&start), "{name}: {message}");
        assert!(!message.contains('\n'), "{name}: {message}");
    }
    let refused = |path: &Path, fragment: &str| {
        let message = build(file_part(path)).unwrap_err().to_string();
        assert!(message.contains(fragment), "{message}");
    };
    refused(&folder.path().join("absent.npy"), "there is no such file; a path in a scene is relative to the folder of the scene file");
    fs::create_dir(folder.path().join("folder.npy")).unwrap();
    refused(&folder.path().join("folder.npy"), "this is a folder");
    refused(Path::new(""), "there is no such file");
    #[cfg(unix)]
    refused(Path::new("/dev/zero"), "not a regular file");
}

#[test]
fn wrong_settings_of_a_good_file_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path(), "map.txt", b"1 2 3\n4 5 6\n");
    let nothing = write(folder.path(), "nothing.txt", b"nan nan\n");
    let refused = |grid: &GridScene, part: HeightFileScene, fragment: &str| {
        let message = Surface::from_parts(grid, &[SurfacePart::Flat, SurfacePart::File(part)])
            .unwrap_err()
            .to_string();
        assert!(message.contains(fragment), "{message}");
    };
    let good = file_part(&path);
    refused(&grid(Some([4, 2])), good.clone(), "[[surface]] 2: ");
    refused(
        &grid(Some([4, 2])),
        good.clone(),
        "the map has 3 x 2 points (x, y), but [grid] points has 4 x 2; leave points out",
    );
    refused(
        &grid(Some([2, 3])),
        good.clone(),
        "but [grid] points has 2 x 3; rows of a file are y and columns x: transpose it",
    );
    let mut part = good.clone();
    part.scale = f64::NAN;
    refused(
        &grid(None),
        part,
        "scale = NaN must be between 1e-30 and 1e30, or minus that; check the powers of ten",
    );
    let mut part = good.clone();
    part.unit = 0.0;
    refused(
        &grid(None),
        part,
        "unit = 0e0 must be between 1e-30 and 1e30",
    );
    let mut part = good.clone();
    part.scale = 1e30;
    part.unit = 1e10;
    refused(
        &grid(None),
        part,
        "m; heights must be 0 or between 1e-30 and 1e30 m: check the unit and the powers of ten",
    );
    let mut part = file_part(&nothing);
    part.fill = Fill::Interpolate;
    refused(&grid(None), part, "all 2 pixels are missing");
    let mut sizeless = grid(None);
    sizeless.size = None;
    refused(&sizeless, good, "[grid] size is missing");
}

/// Places around a matrix are warned of where they are taken for heights.
#[test]
fn places_around_a_matrix_are_left_out_by_a_crop() {
    let folder = tempfile::tempdir().unwrap();
    let text = b"0,1,2,3,4\n1,5,9,4,7\n2,6,3,8,1\n3,4,4,1,6\n";
    let path = write(folder.path(), "places.csv", text);
    let told = |part: HeightFileScene| {
        let surface = build(part).unwrap();
        let is_told = |text: &&String| text.contains("leave them out with crop = [1, 1, 4, 3]");
        surface.warnings.iter().filter(is_told).count()
    };
    assert_eq!(told(file_part(&path)), 1);
    for (crop, count) in [([1, 1, 4, 3], 0), ([0, 0, 4, 4], 1)] {
        let mut part = file_part(&path);
        part.preparation.crop = Some(crop);
        assert_eq!(told(part), count, "{crop:?}");
    }
}

#[test]
fn grids_are_checked_before_memory_is_asked_for() {
    let refused = |points, size, fragment: &str| {
        let scene = GridScene {
            points,
            size,
            boundary: Boundary::Periodic,
        };
        let message = Surface::from_parts(&scene, &[SurfacePart::Flat])
            .unwrap_err()
            .to_string();
        assert!(message.contains(fragment), "{message}");
    };
    let size = Some([1.0, 1.0]);
    refused(None, size, "[grid] points is missing");
    refused(Some([8, 8]), None, "[grid] size is missing");
    refused(Some([0, 8]), size, "[grid] points = [0, 8] is not possible");
    refused(Some([1 << 20, 1 << 20]), size, "is not possible");
    refused(Some([usize::MAX, 2]), size, "is not possible");
    refused(
        Some([8, 8]),
        Some([1.0, 0.0]),
        "[grid] size = [1e0, 0e0] m must be two lengths between 1e-30 and 1e30 m; check the unit",
    );
    refused(
        Some([8, 8]),
        Some([f64::NAN, 1.0]),
        "must be two lengths between",
    );
    let message = Surface::from_parts(&grid(Some([2, 2])), &[]).unwrap_err();
    assert!(message.to_string().contains("the scene has no [[surface]]"));
}

#[test]
fn every_type_and_order_of_npy_gives_the_same_heights() {
    let folder = tempfile::tempdir().unwrap();
    // Rows are y: [[0, 1, 2], [3, 4, 5]] has 3 points along x, 2 along y.
    let expected: Vec<f64> = (0..6).map(f64::from).collect();
    let stored = [0_u8, 1, 2, 3, 4, 5];
    macro_rules! bytes {
        ($kind:ty, $swap:ident) => {
            stored
                .iter()
                .flat_map(|i| (*i as $kind).$swap())
                .collect::<Vec<u8>>()
        };
    }
    let half = |i: &u8| half::f16::from_f64(f64::from(*i));
    let kinds: Vec<(&str, Vec<u8>)> = vec![
        (
            "<f2",
            stored.iter().flat_map(|i| half(i).to_le_bytes()).collect(),
        ),
        (
            ">f2",
            stored.iter().flat_map(|i| half(i).to_be_bytes()).collect(),
        ),
        ("<f4", bytes!(f32, to_le_bytes)),
        (">f4", bytes!(f32, to_be_bytes)),
        ("<f8", bytes!(f64, to_le_bytes)),
        (">f8", bytes!(f64, to_be_bytes)),
        ("|i1", bytes!(i8, to_le_bytes)),
        ("|u1", bytes!(u8, to_le_bytes)),
        ("<i2", bytes!(i16, to_le_bytes)),
        (">i2", bytes!(i16, to_be_bytes)),
        ("<u2", bytes!(u16, to_le_bytes)),
        (">u2", bytes!(u16, to_be_bytes)),
        ("<i4", bytes!(i32, to_le_bytes)),
        (">i4", bytes!(i32, to_be_bytes)),
        ("<u4", bytes!(u32, to_le_bytes)),
        (">u4", bytes!(u32, to_be_bytes)),
        ("<i8", bytes!(i64, to_le_bytes)),
        (">i8", bytes!(i64, to_be_bytes)),
        ("<u8", bytes!(u64, to_le_bytes)),
        (">u8", bytes!(u64, to_be_bytes)),
    ];
    for (kind, bytes) in kinds {
        let path = write(
            folder.path(),
            "c.npy",
            &npy(&description(kind, "False", "(2, 3)"), &bytes),
        );
        let surface = build(file_part(&path)).unwrap_or_else(|error| panic!("{kind}: {error}"));
        assert_eq!(*surface.heights, expected, "{kind}");
        assert_eq!((surface.grid.nx, surface.grid.ny), (3, 2));
        assert_eq!(surface.highest, 5.0);
    }
    let columns = [0.0, 3.0, 1.0, 4.0, 2.0, 5.0_f64];
    let bytes: Vec<u8> = columns
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    let path = write(
        folder.path(),
        "f.npy",
        &npy(&description("<f8", "True", "(2, 3)"), &bytes),
    );
    assert_eq!(*build(file_part(&path)).unwrap().heights, expected);
    // What follows the array is not read, and said.
    let mut longer = npy(&description("<f8", "False", "(2, 3)"), &six());
    longer.extend([0; 7]);
    let path = write(folder.path(), "longer.npy", &longer);
    let surface = build(file_part(&path)).unwrap();
    assert_eq!(*surface.heights, expected);
    assert!(surface.warnings[0].contains("[[surface]] 1: the file holds 7 bytes after its array"));
}

#[test]
fn units_scales_trends_holes_and_sums() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path(), "map.csv", b"x;y;z\n0;1;2\n3;;5\n6;7;8\n");
    let mut part = file_part(&path);
    part.unit = 1e-9;
    part.scale = -2.0;
    part.fill = Fill::Interpolate;
    let surface = build(part.clone()).unwrap();
    // The hole is the mean of 1, 3, 5, 7.
    assert_relative_eq!(surface.heights[4], -8e-9, max_relative = 1e-12);
    assert_relative_eq!(surface.heights[8], -16e-9, max_relative = 1e-12);
    assert!(surface.warnings[0].contains("1 of 9 pixels (11.11 %) were missing"));
    part.detrend = Detrend::Plane;
    let level = build(part.clone()).unwrap();
    assert!(level.heights.iter().all(|height| height.abs() < 1e-22));
    // A sum of parts: the file and a sphere.
    let sphere = SurfacePart::Sphere {
        radius: 1e-6,
        centre: Some([0.0, 0.0]),
    };
    let sum = Surface::from_parts(&grid(None), &[SurfacePart::File(part), sphere.clone()]).unwrap();
    assert_eq!(sum.top, Top::Unknown);
    assert_relative_eq!(sum.heights[1], -0.5e-6, max_relative = 1e-12);
    let alone = Surface::from_parts(&grid(Some([4, 4])), &[SurfacePart::Flat, sphere]).unwrap();
    assert_eq!((alone.top, alone.highest), (Top::Sphere(1e-6), 0.0));
}

#[test]
fn a_file_may_carry_its_size() {
    let folder = tempfile::tempdir().unwrap();
    let text = "# Width: 3.00 um\n# Height: 2.00 um\n# Value units: nm\n1 2 3\n4 5 6\n";
    let path = write(folder.path(), "map.txt", text.as_bytes());
    let mut scene = grid(None);
    scene.size = None;
    let parts = [SurfacePart::File(file_part(&path))];
    let surface = Surface::from_parts(&scene, &parts).unwrap();
    assert_relative_eq!(surface.grid.lx, 3e-6, max_relative = 1e-14);
    assert_relative_eq!(surface.heights[5], 6e-9, max_relative = 1e-14);
    scene.size = Some([3e-6, 3e-6]);
    let message = Surface::from_parts(&scene, &parts).unwrap_err().to_string();
    assert!(
        message.contains("but [grid] size says 3e-6 x 3e-6 m"),
        "{message}"
    );
}

#[test]
fn edges_that_do_not_match_get_a_warning_on_a_periodic_grid() {
    let folder = tempfile::tempdir().unwrap();
    let rows: Vec<String> = (0..16)
        .map(|y| (0..16).map(|x| format!("{} ", x + (y % 2))).collect())
        .collect();
    let path = write(folder.path(), "tilt.txt", rows.join("\n").as_bytes());
    let mut scene = grid(None);
    scene.boundary = Boundary::Periodic;
    let mut part = file_part(&path);
    let surface = Surface::from_parts(&scene, &[SurfacePart::File(part.clone())]).unwrap();
    let [tilted, warning] = &surface.warnings[..] else {
        panic!("{:?}", surface.warnings);
    };
    assert!(tilted.contains("the map is tilted"), "{tilted}");
    assert!(
        warning.contains("edges across x do not match: rms jump 1.500e1 m against 1.000e0 m"),
        "{warning}"
    );
    part.detrend = Detrend::Plane;
    let surface = Surface::from_parts(&scene, &[SurfacePart::File(part.clone())]).unwrap();
    assert_eq!(surface.warnings, Vec::<String>::new());
    part.detrend = Detrend::None;
    let surface = build(part).unwrap();
    assert_eq!(surface.warnings, std::slice::from_ref(tilted));
}

/// A pixel that is missing at the edge of a tilted map is the mean of its neighbours, or of those beyond the opposite edge where
/// the map is said to repeat. Those were taken of a patch too whose edges are made to meet.
#[test]
fn holes_at_the_edges_of_a_patch_are_filled_from_inside() {
    let folder = tempfile::tempdir().unwrap();
    let rows: Vec<String> = (0..16)
        .map(|y| {
            let row = (0..16).map(|x| match (x, y) {
                (0, 5) => "nan ".to_owned(),
                _ => format!("{x} "),
            });
            row.collect()
        })
        .collect();
    let path = write(folder.path(), "hole.txt", rows.join("\n").as_bytes());
    let mut scene = grid(None);
    scene.boundary = Boundary::Periodic;
    let filled = |edges: Edges, detrend: Detrend| {
        let mut part = file_part(&path);
        (part.fill, part.detrend, part.preparation.edges) = (Fill::Interpolate, detrend, edges);
        let surface = Surface::from_parts(&scene, &[SurfacePart::File(part)]).unwrap();
        surface.heights[5 * surface.grid.nx] - surface.heights[4 * surface.grid.nx]
    };
    // The edges of a ramp do not meet: the plane through the others, which are all on it, goes on to them.
    for (edges, detrend) in [
        (Edges::None, Detrend::None),
        (Edges::None, Detrend::Lines),
        (Edges::Mirror, Detrend::None),
        (Edges::None, Detrend::Plane),
    ] {
        assert!(filled(edges, detrend).abs() < 1e-9, "{edges:?} {detrend:?}");
    }
}

#[test]
fn a_self_affine_surface_has_the_moments_it_was_asked_for() {
    let size = 25e-6;
    let rough = |roughness| {
        SurfacePart::SelfAffine(SelfAffineScene {
            hurst: 0.8,
            roughness,
            longest: size,
            rolloff: size / 4.0,
            shortest: size / 64.0,
            seed: 1,
        })
    };
    let scene = GridScene {
        points: Some([256, 256]),
        size: Some([size, size]),
        boundary: Boundary::Periodic,
    };
    let build = |roughness| Surface::from_parts(&scene, &[rough(roughness)]).unwrap();
    let surface = build(Roughness::RmsHeight(0.52e-9));
    assert_eq!(surface.warnings, Vec::<String>::new());
    let moments = surface.statistics(Boundary::Periodic).moments;
    assert_relative_eq!(moments.rms_height(), 0.52e-9, max_relative = 1e-12);
    // The slope of the same band in a cell of 2 pi / 2.5e5 m, scaled with the size.
    let slope = 0.0011397533839009979 * (2.0 * PI / 2.5e5) / size;
    assert_relative_eq!(moments.rms_slope(), slope, max_relative = 1e-9);
    let moments = build(Roughness::RmsSlope(0.1))
        .statistics(Boundary::Periodic)
        .moments;
    assert_relative_eq!(moments.rms_slope(), 0.1, max_relative = 1e-12);
}
