//! Height files of other programs, and files that are none, through the command line.
//!
//! `tests/files/values.csv` holds what other readers found in the files beside it; README.md there says
//! who wrote and who read each.

use std::fs;
use std::path::{Path, PathBuf};

use approx::assert_relative_eq;
use tabor::scene::{Boundary, Detrend, Fill, GridScene, HeightFileScene, SurfacePart};
use tabor::surface::Surface;

use crate::shared::binary::{errors, tabor};

fn files() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files")
}

fn good(name: &str) -> Vec<u8> {
    fs::read(files().join(name)).expect("a file of the collection")
}

/// Metres in the unit of a file of the collection that does not say it; see its README.
fn unit(name: &str) -> f64 {
    let in_nanometres = ["gdal", "numpy", "tifffile_float", "tifffile_planes"];
    if in_nanometres.iter().any(|start| name.starts_with(start)) {
        1e-9
    } else {
        1.0
    }
}

fn is_image(name: &str) -> bool {
    let holds_heights = ["differences", "float", "planes"];
    let is_shades = !holds_heights.iter().any(|kind| name.contains(kind));
    name.ends_with(".png") || name.ends_with(".tif") && is_shades
}

fn build(name: &str, fill: Fill, size: Option<[f64; 2]>) -> Result<Surface, String> {
    let ends = is_image(name).then_some([0.0, 1.0]);
    let part = HeightFileScene {
        preparation: tabor::scene::Preparation::default(),
        path: files().join(name),
        unit: unit(name),
        scale: 1.0,
        black: ends.map(|ends| ends[0]),
        white: ends.map(|ends| ends[1]),
        detrend: Detrend::None,
        fill,
    };
    let grid = GridScene {
        points: None,
        size,
        boundary: Boundary::Free,
    };
    Surface::from_parts(&grid, &[SurfacePart::File(part)]).map_err(|error| error.to_string())
}

/// What another reader found in a file.
struct Found {
    file: String,
    points: [usize; 2],
    size: Option<[f64; 2]>,
    missing: usize,
    /// Heights at (row, column) = (0, 0), (0, 1), (1, 0), (last, last), the least, the greatest, the mean.
    heights: Vec<f64>,
}

fn found_by_others() -> Vec<Found> {
    let table = fs::read_to_string(files().join("values.csv")).expect("the table is there");
    let rows = table.lines().skip(1).map(|line| {
        let fields: Vec<&str> = line.split(',').collect();
        let count = |index: usize| fields[index].parse::<usize>().expect("a count");
        let number = |index: usize| fields[index].parse::<f64>().expect("a number");
        Found {
            file: fields[0].to_owned(),
            points: [count(2), count(3)],
            size: (!fields[4].is_empty()).then(|| [number(4), number(5)]),
            missing: count(6),
            heights: (7..14).map(number).collect(),
        }
    });
    rows.collect()
}

#[test]
fn other_programs_files_hold_what_other_readers_find() {
    let found = found_by_others();
    assert!(found.len() >= 28, "{} files", found.len());
    for other in &found {
        let name = other.file.as_str();
        let size = other.size.is_none().then_some([6e-7, 7.2e-7]);
        // Missing points are counted by the refusal of them.
        let plain = build(name, Fill::None, size);
        match other.missing {
            0 => assert!(plain.is_ok(), "{name}: {plain:?}"),
            missing => {
                let message = plain.expect_err(name);
                let start = format!("{missing} of 108 pixels are missing");
                assert!(message.contains(&start), "{name}: {message}");
            }
        }
        let surface = build(name, Fill::Interpolate, size).expect(name);
        let grid = surface.grid;
        assert_eq!([grid.nx, grid.ny], other.points, "{name}");
        if let Some([x, y]) = other.size {
            // Sizes are steps of single precision times counts at worst.
            assert_relative_eq!(grid.lx, x, max_relative = 1e-7);
            assert_relative_eq!(grid.ly, y, max_relative = 1e-7);
        }
        let heights = &surface.heights;
        let mean = heights.iter().sum::<f64>() / heights.len() as f64;
        let least = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let mut ours = vec![
            heights[0],
            heights[1],
            heights[12],
            heights[107],
            least,
            surface.highest,
        ];
        let mut theirs = other.heights[..6].to_vec();
        if other.missing == 0 {
            ours.push(mean);
            theirs.push(other.heights[6]);
        }
        // That reader leaves the height of zero out of .sur files.
        if name.ends_with(".sur") {
            let (our_zero, their_zero) = (ours[0], theirs[0]);
            ours.iter_mut().for_each(|height| *height -= our_zero);
            theirs.iter_mut().for_each(|height| *height -= their_zero);
        }
        let range = theirs[5] - theirs[4];
        for (index, (our, their)) in ours.iter().zip(&theirs).enumerate() {
            // Both read the same digits; only the order of a multiplication may differ.
            assert!(
                (our - their).abs() < 1e-9 * range,
                "{name}, {index}: {our:e}, {their:e}"
            );
        }
    }
}

#[test]
fn the_same_heights_come_from_every_format() {
    // All files were made from one map; printed digits set them apart, by 5e-12 m
    // (`-1.0159e-07`) at most.
    let first = build("gwyddion.gwy", Fill::None, None).unwrap();
    for name in [
        "gwyddion.gsf",
        "gwyddion.sdf",
        "gwyddion.sur",
        "gwyddion.xyz",
        "surfalize.sur",
        "surfalize.al3d",
        "surfalize_binary.sdf",
        "surfalize_text.sdf",
        "gdal_text.grd",
        "gdal_6.grd",
        "gdal_7.grd",
        "gdal.xyz",
        "numpy_columns.csv",
        "surfacetopography.txt",
    ] {
        let surface = build(name, Fill::Interpolate, None).expect(name);
        assert_relative_eq!(surface.grid.lx, 6e-7, max_relative = 1e-6);
        assert_relative_eq!(surface.grid.ly, 7.2e-7, max_relative = 1e-6);
        for (index, (here, there)) in surface.heights.iter().zip(first.heights.iter()).enumerate() {
            // Row 2, column 3 and row 8, column 0 are missing in some of them.
            if index != 27 && index != 96 {
                assert!((here - there).abs() < 5.1e-12, "{name}, {index}");
            }
        }
    }
}

#[test]
fn a_name_without_a_known_extension_is_no_hindrance_where_the_first_bytes_are_clear() {
    let folder = tempfile::tempdir().unwrap();
    for (from, to) in [
        ("gwyddion.gsf", "map"),
        ("gwyddion.sur", "map.dst"),
        ("gdal_7.grd", "MAP.GRD"),
    ] {
        fs::write(folder.path().join(to), good(from)).unwrap();
        let output = tabor(
            folder.path(),
            &[
                "surface",
                to,
                "--fill",
                "interpolate",
                "--out",
                &format!("{to}_out"),
            ],
        );
        assert!(output.status.success(), "{to}: {}", errors(&output));
    }
}

#[test]
fn the_scene_may_leave_out_what_the_file_says_and_must_not_contradict_it() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("map.gsf"), good("gwyddion.gsf")).unwrap();
    let rest = "[solid]\ncontact_modulus = 1e9\n[[surface]]\nkind = \"file\"\npath = \"map.gsf\"\n\
                [loading]\ncontrol = \"pressure\"\npath = [1e6]\n";
    let check = |grid: &str| {
        fs::write(folder.path().join("scene.toml"), format!("{grid}{rest}")).unwrap();
        tabor(folder.path(), &["check", "scene.toml"])
    };
    for grid in [
        "",
        "[grid]\npoints = [12, 9]\n",
        "[grid]\nsize = [6e-7, \"720 nm\"]\n",
    ] {
        let output = check(grid);
        assert!(output.status.success(), "{grid}: {}", errors(&output));
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(text.contains("12 x 9 points, 600 nm x 720 nm"), "{text}");
    }
    for (grid, message) in [
        (
            "[grid]\npoints = 12\n",
            "the map has 12 x 9 points (x, y), but [grid] points has 12 x 12",
        ),
        ("[grid]\npoints = [9, 12]\n", "transpose it"),
        (
            "[grid]\nsize = \"600 nm\"\n",
            "the map says it is 6e-7 x 7.2e-7 m (x, y), but [grid] size says 6e-7 x 6e-7 m",
        ),
    ] {
        let output = check(grid);
        assert_eq!(output.status.code(), Some(2), "{grid}");
        assert!(errors(&output).contains(message), "{}", errors(&output));
    }
}

#[test]
fn grey_images_in_a_scene_take_black_and_white() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("map.png"), good("pillow_16.png")).unwrap();
    let scene = "[grid]\nsize = \"1 um\"\n[solid]\ncontact_modulus = 1e9\n[[surface]]\nkind = \"file\"\npath = \"map.png\"\n\
                 black = \"-10 nm\"\nwhite = 30e-9\n[loading]\ncontrol = \"pressure\"\npath = [1e6]\n";
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    let output = tabor(
        folder.path(),
        &["surface", "scene.toml", "--size", "1 um, 2 um"],
    );
    assert!(output.status.success(), "{}", errors(&output));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    for line in [
        "lowest               -1.00000e-8",
        "highest              3.00000e-8",
        "size_y               2.00000e-6",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
    // Bare numbers of black and white are in m, whatever the unit.
    assert!(errors(&output).is_empty(), "{}", errors(&output));
    let with_unit = scene.replace("white = 30e-9", "white = 30\nunit = \"nm\"");
    fs::write(folder.path().join("scene.toml"), with_unit).unwrap();
    let output = tabor(folder.path(), &["surface", "scene.toml"]);
    let warning = "unit = 1e-9 m does nothing for a grey image, whose heights run from black = -1e-8 m to white = 3e1 m";
    assert!(errors(&output).contains(warning), "{}", errors(&output));
}

/// The surface of a file of these bytes, missing heights filled, on its own grid.
fn surface_of(name: &str, bytes: &[u8]) -> Surface {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    // A path from the root replaces that of the collection.
    build(path.to_str().unwrap(), Fill::Interpolate, None).expect(name)
}

fn heights_of(name: &str, bytes: &[u8]) -> Vec<f64> {
    surface_of(name, bytes).heights.to_vec()
}

#[test]
fn every_type_of_number_of_a_binary_surface_data_file_is_read() {
    let columns = 3_u16;
    let types: [Vec<u8>; 8] = [
        vec![1, 2, 3],
        [1_u16, 65535, 3].map(u16::to_le_bytes).concat(),
        [1_u32, u32::MAX, 3].map(u32::to_le_bytes).concat(),
        [1_f32, f32::MIN, 3.0].map(f32::to_le_bytes).concat(),
        [1_i8, i8::MIN, 3].map(i8::to_le_bytes).concat(),
        [1_i16, i16::MIN, 3].map(i16::to_le_bytes).concat(),
        [1_i32, i32::MIN, 3].map(i32::to_le_bytes).concat(),
        [1_f64, f64::MIN, 3.0].map(f64::to_le_bytes).concat(),
    ];
    for version in [1, 2] {
        for (number, data) in (0_u8..).zip(&types) {
            let mut bytes = format!("bISO-{version}.0{:34}", "maker and dates").into_bytes();
            // Version 2 has wider counts.
            for count in [columns, 1] {
                match version {
                    1 => bytes.extend(count.to_le_bytes()),
                    _ => bytes.extend(u32::from(count).to_le_bytes()),
                }
            }
            for scale in [1e-6, 1e-6, 2e-9, -1.0_f64] {
                bytes.extend(scale.to_le_bytes());
            }
            bytes.extend([0, number, 0]);
            bytes.extend(data);
            // The missing one is the mean of its neighbours, 2, which is what type 0 says itself.
            let heights = heights_of("types.sdf", &bytes);
            for (height, expected) in heights.iter().zip([2e-9, 4e-9, 6e-9]) {
                assert_relative_eq!(*height, expected, max_relative = 1e-9);
            }
        }
    }
}

#[test]
fn surfaces_stored_upside_down_or_mirrored_are_turned() {
    let bytes = good("gwyddion.sur");
    let plain = heights_of("a.sur", &bytes);
    let turned = |inversion: u8| heights_of("a.sur", &patched(&bytes, 290, &[inversion]));
    // 1 turns the heights over, 2 the rows end for end besides, 3 the columns.
    let over: Vec<f64> = plain.iter().map(|height| -height).collect();
    assert_eq!(turned(1), over);
    let rows: Vec<f64> = over
        .chunks(12)
        .flat_map(|row| row.iter().rev().copied())
        .collect();
    assert_eq!(turned(2), rows);
    let columns: Vec<f64> = over.chunks(12).rev().flatten().copied().collect();
    assert_eq!(turned(3), columns);
}

#[test]
fn a_series_of_surfaces_is_told() {
    let bytes = good("surfalize.sur");
    let series = patched(&patched(&bytes, 14, &[3]), 18, &[5]);
    let found = surface_of("a.sur", &series);
    assert_eq!(found.heights.to_vec(), heights_of("a.sur", &bytes));
    let warned = found.warnings.join("\n");
    assert!(
        warned.contains("the file holds 3 objects; the first is read"),
        "{warned}"
    );
}

/// Deflections are lengths too, once they are calibrated.
#[test]
fn images_of_nanoscope_that_are_named_as_heights_come_first() {
    let bytes = good("bruker_10.spm");
    let bytes = with(
        &bytes,
        b"[ZSensor] \"Height Sensor",
        b"[Deflect] \"Deflection Er",
    );
    let warned = surface_of("a.spm", &bytes).warnings.join("\n");
    assert!(
        warned.contains(
            "names no image as one of heights; the first of lengths, Deflection Er, is read"
        ),
        "{warned}"
    );
    let bytes = with(
        &bytes,
        b"ForceDeflSens: V 1.000000 ",
        b"ForceDeflSens: V 45.0 nm/V",
    );
    let bytes = with(&bytes, b"[PeakForceError]", b"[HeightOfSensor]");
    let found = surface_of("a.spm", &bytes);
    let warned = found.warnings.join("\n");
    assert!(!warned.contains("is read"), "{warned}");
    let (numbers, _) = bytes[6432..].as_chunks();
    for (height, number) in found.heights.iter().zip(numbers) {
        let expected = f64::from(i32::from_le_bytes(*number)) / 2_f64.powi(32) * 24.576 * 45e-9;
        assert_relative_eq!(*height, expected, max_relative = 1e-12);
    }
}

/// Lengths are in nm, and so are heights unless they have a unit of their own.
#[test]
fn texts_of_spip_say_their_lengths() {
    let head = "# File Format = ASCII\r\n# Created by Gwyddion 2.62\r\n# x-pixels = 3\r\n# y-pixels = 2\r\n# x-length = 300\r\n\
                # y-length = 200.0\r\n# Bit2nm = 1.0\r\n";
    let rows = "# Start of Data:\r\n1\t2\t3\r\n4\t5\t6\r\n";
    for (more, unit) in [
        ("", 1e-9),
        ("# z-unit = \u{b5}m\r\n# voidpixels = 0\r\n", 1e-6),
    ] {
        let found = surface_of("a.asc", format!("{head}{more}{rows}").as_bytes());
        assert_relative_eq!(found.grid.lx, 300e-9, max_relative = 1e-12);
        assert_relative_eq!(found.grid.ly, 200e-9, max_relative = 1e-12);
        assert_relative_eq!(found.heights[5], 6.0 * unit, max_relative = 1e-12);
    }
}

#[test]
fn channels_of_nanosurf_that_are_named_as_heights_come_first() {
    let bytes = good("nanosurf.nid");
    let deflection = with(
        &bytes,
        b"Dim2Name=Deflection\r\nDim2Unit=N",
        b"Dim2Name=Deflection\r\nDim2Unit=m",
    );
    let [plain, found] = [bytes, deflection].map(|bytes| heights_of("a.nid", &bytes));
    assert_eq!(found, plain);
}

/// 12 x 9 points of a scan size of 1 um for both sides.
#[test]
fn images_of_nanoscope_may_be_longer_along_one_axis() {
    let plain = good("bruker_10.spm");
    let ratio = |bytes: &[u8], new: &[u8]| with(bytes, b"Ratio: 1:1", new);
    let lines = with(
        &plain,
        b"\\@Sens. DeflSens: V 1.000000",
        b"\\Lines: 18                  ",
    );
    // Of the scan and of the image; 3:3 is a square.
    let of_image = ratio(&ratio(&lines, b"Ratio: 3:3"), b"Ratio: 2:1");
    let of_both = ratio(&ratio(&lines, b"Ratio: 2:1"), b"Ratio: 2:1");
    let stated = with(
        &of_both,
        b"Size: 1 1 ~m\r\n\\Line",
        b"Size: 1 .5 ~m\r\n\\Lin",
    );
    for (bytes, expected) in [
        (plain, 1e-6),
        (of_image, 9.0 / 18.0 * 1e-6),
        (of_both, 9.0 / 12.0 * 1e-6),
        (stated, 0.5e-6),
    ] {
        let grid = surface_of("a.spm", &bytes).grid;
        assert_relative_eq!(grid.lx, 1e-6, max_relative = 1e-12);
        assert_relative_eq!(grid.ly, expected, max_relative = 1e-12);
    }
}

/// Bytes with `new` in place of the first `old`, which is there.
fn with(bytes: &[u8], old: &[u8], new: &[u8]) -> Vec<u8> {
    let at = bytes
        .windows(old.len())
        .position(|window| window == old)
        .unwrap_or_else(|| panic!("{:?} is not there", String::from_utf8_lossy(old)));
    [&bytes[..at], new, &bytes[at + old.len()..]].concat()
}

/// Bytes with `new` from offset `at` on.
fn patched(bytes: &[u8], at: usize, new: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    bytes[at..at + new.len()].copy_from_slice(new);
    bytes
}

/// A Gwyddion tree of objects within objects.
fn nested(depth: usize) -> Vec<u8> {
    let mut bytes = b"leaf\0\0\0\0\0".to_vec();
    for _ in 0..depth {
        let piece = [b"a\0o".as_slice(), &bytes].concat();
        bytes = [
            b"node\0".as_slice(),
            &(piece.len() as u32).to_le_bytes(),
            &piece,
        ]
        .concat();
    }
    [b"GWYP".as_slice(), &bytes].concat()
}

fn colour_png() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbImage::new(3, 2)
        .write_to(&mut bytes, image::ImageFormat::Png)
        .expect("an image is written");
    bytes.into_inner()
}

#[test]
#[rustfmt::skip]
fn bad_files_are_refused_in_a_sentence() {
    let [gsf, gwy, sdf, sur] = ["gwyddion.gsf", "gwyddion.gwy", "gwyddion.sdf", "gwyddion.sur"].map(good);
    let [sdf_binary, al3d] = ["surfalize_binary.sdf", "surfalize.al3d"].map(good);
    let [grd, grd_6, grd_7] = ["gdal_text.grd", "gdal_6.grd", "gdal_7.grd"].map(good);
    let [png, tif, mask] = ["pillow_16.png", "tifffile_16.tif", "gwyfile_mask.gwy"].map(good);
    let [spm, ibw, nid, zygo] = ["bruker_5.spm", "asylum.ibw", "nanosurf.nid", "zygo.dat"].map(good);
    let [opd, plu, vk4, x3p] = ["wyko.opd", "sensofar.plu", "description.vk4", "mountains.x3p"].map(good);
    let text = |text: &str| text.as_bytes().to_vec();
    // Rows of the table: name, bytes, part of the message.
    let files: Vec<(&str, Vec<u8>, &str)> = vec![
        // Names and content.
        ("field.gwy", gsf.clone(), "the name says .gwy, but the file holds a Gwyddion simple field (.gsf)"),
        ("map.grd", text("1 2\n3 4\n"), "the name says .grd, but the file holds no Surfer grid (.grd)"),
        ("netcdf.grd", b"CDF\x01".to_vec(), "the file holds no Surfer grid"),
        ("image.xyz", png.clone(), "the name says .xyz, but the file holds a PNG image"),
        ("surface.txt", sdf.clone(), "the name says .txt, but the file holds a surface data file (.sdf)"),
        ("archive.sur", b"PK\x03\x04....".to_vec(), "the name says .sur, but the file holds a ZIP archive"),
        ("map.mnt", text("1 2"), "height files of kind .mnt are not in this version; docs/surfaces.md lists those that are, and has one line of Python"),
        ("map", b"1 2".to_vec(), "the name has no extension and the first bytes are those of no known kind"),
        ("empty.gwy", vec![], "the file is empty (0 bytes)"),
        // Gwyddion simple fields.
        ("cut.gsf", gsf[..gsf.len() - 4].to_vec(), "the file is cut short: 9 rows of 12 columns need 432 bytes, there are 428"),
        ("header.gsf", text("Gwyddion Simple Field 1.0\nXRes = 3\n"), "broken .gsf file at byte 35: no zero byte ends the header"),
        ("no_data.gsf", b"Gwyddion Simple Field 1.0\nXRes = 1\nYRes = 1\n\0".to_vec(), "the field is said to begin at byte 48, but the file has 45"),
        ("no_points.gsf", with(&gsf, b"XRes", b"Xres"), "broken .gsf file at byte 0: its header has no XRes"),
        ("word.gsf", with(&gsf, b"XRes = 12", b"XRes = xx"), "broken .gsf file, line 2: XRes = \"xx\" is not a whole number"),
        ("nothing.gsf", with(&gsf, b"XRes = 12", b"XRes = 00"), "9 rows of 0 columns; both must be at least 1"),
        ("vast.gsf", with(&gsf, b"XRes = 12", b"XRes = 4294967296\nYRes = 4294967296"), "18446744073709551615 points are too many"),
        ("long.gsf", with(&gsf, b"XRes = 12", b"XRes = 99999999"), "9 rows of 99999999 columns need 3599999964 bytes, there are 434"),
        ("size.gsf", with(&gsf, b"XReal = 6e-07", b"XReal = -1"), "broken .gsf file, line 4: XReal = \"-1\" is not a positive number"),
        ("volts.gsf", with(&gsf, b"ZUnits = m", b"ZUnits = V"), "the file gives its heights in \"V\", which is not a length"),
        ("seconds.gsf", with(&gsf, b"XYUnits = m", b"XYUnits = s"), "the file gives its x and y in \"s\", which is not a length"),
        // Gwyddion's own files.
        ("magic.gwy", b"GWYP".to_vec(), "broken .gwy file at byte 4: the file ends within the name of an object"),
        ("cut.gwy", gwy[..1000].to_vec(), "broken .gwy file at byte 4: the object \"GwyContainer\" has"),
        ("no_image.gwy", b"GWYPGwyContainer\0\0\0\0\0".to_vec(), "it holds no image"),
        ("volts.gwy", with(&with(&gwy, b"unitstr\0sm\0", b"unitstr\0sV\0"), b"unitstr\0sm\0", b"unitstr\0sV\0"), "the file gives its heights in \"V\", which is not a length"),
        ("points.gwy", with(&gwy, b"xres\0i\x0c", b"xres\0i\x0d"), "108 heights for 13 x 9 points"),
        ("negative.gwy", with(&gwy, b"xres\0i\x0c\0\0\0", b"xres\0i\xff\xff\xff\xff"), "9 rows of -1 columns; both must be at least 1"),
        ("no_points.gwy", with(&gwy, b"xres\0i", b"xras\0i"), "the image here has no xres"),
        ("no_heights.gwy", with(&gwy, b"data\0D", b"dota\0D"), "the image here has no heights"),
        ("type.gwy", with(&gwy, b"xres\0i", b"xres\0Z"), "a component of the unknown type 'Z'"),
        ("list.gwy", with(&gwy, b"data\0Dl\0\0\0", b"data\0D\xff\xff\xff\x7f"), "the file ends within a list of numbers"),
        ("overrun.gwy", [b"GWYPa\0".as_slice(), &4_u32.to_le_bytes(), b"x\0i\x01\0\0\0"].concat(), "the object \"a\" runs over its end"),
        ("deep.gwy", nested(100), "its tree is too deep"),
        ("mask.gwy", {
            // The mask comes last: its 12 x 9 points become 9 x 12.
            let at = mask.windows(6).rposition(|window| window == b"xres\0i").expect("a mask") + 6;
            let turned = patched(&mask, at, &[9]);
            let at = mask.windows(6).rposition(|window| window == b"yres\0i").expect("a mask") + 6;
            patched(&turned, at, &[12])
        }, "a mask has another shape than its image"),
        // Instruments.
        ("no_image.spm", text("\\*File list\r\n\\Version: 1\r\n\\*File list end\r\n"), "its header names no image"),
        ("phase.spm", with(&with(&spm, b"V [Sens. Zsens]", b"V [Sens. Xsens]"), b"V [Sens. Zsens]", b"V [Sens. Xsens]"), "which is not a length"),
        ("cut.spm", spm[..6100].to_vec(), "9 rows of 12 columns need 216 bytes, there are 100"),
        ("length.spm", with(&spm, b"Data length: 216", b"Data length: 108"), "broken Nanoscope file at byte 0: 108 bytes for an image of 12 x 9 points"),
        ("points.spm", with(&spm, b"Samps/line: 12", b"Samps/line: xx"), "an image has no whole number as \"samps/line\""),
        ("type.ibw", patched(&ibw, 80, &[1]), "broken .ibw file at byte 80: numbers of the unknown type 1"),
        ("points.ibw", patched(&ibw, 132, &[13]), "324 numbers as 13 x 9 x 3 x 0 points"),
        ("volts.ibw", patched(&ibw, 212, b"V"), "the file gives its heights in \"V\", which is not a length"),
        ("cut.ibw", ibw[..400].to_vec(), "9 rows of 12 columns need 432 bytes, there are 16"),
        ("endless.nid", with(&nid, b"#!", b"##"), "its header has no end"),
        ("bits.nid", with(&nid, b"Dim2Unit=m\r\nDim2Range=1.0152e-05", b"Dim2Unit=m\r\nDim2Rnage=1.0152e-05"), "has no such number as Dim2Range"),
        ("phase.dat", patched(&zygo, 218, &[0, 9]), "a phase resolution of 9; 0 to 2 are known"),
        ("cut.dat", zygo[..zygo.len() - 1].to_vec(), "9 rows of 12 columns need 432 bytes, there are 431"),
        ("wave.opd", with(&opd, b"Wavelength", b"Wavelangth"), "it has no block of heights, or no wavelength"),
        ("cut.opd", opd[..100].to_vec(), "broken .opd file at byte 100: the file ends within the directory"),
        ("short.opd", patched(&opd, 44, &[3]), "broken .opd file at byte 170: its block Wavelength has 3 bytes of 4 at least"),
        ("heights.opd", patched(&opd, 116, &[0]), "its block Raw has 256 bytes, and 12 x 9 heights take 438"),
        ("kind.plu", patched(&plu, 428, &[1]), "a measurement of kind 1; 3 is a topography"),
        ("pixel.plu", patched(&plu, 404, &[0; 4]), "broken .plu file at byte 404: pixels of 0 x"),
        ("heights.vk4", patched(&vk4, 36, &[0; 4]), "broken .vk4 file at byte 36: it holds no heights"),
        ("bits.vk4", patched(&vk4, 84 + 4 * 76 + 8, &[24]), "heights of 24 bits; 8, 16 and 32 are known"),
        ("arrays.npz", with(&with(&x3p, b"main.xml", b"main.npy"), b"main.xml", b"main.npy"), "NumPy's archives (.npz) are not in this version"),
        ("cut.x3p", x3p[..x3p.len() - 30].to_vec(), "its archive is not whole"),
        // Surface data files.
        ("cut.sdf", sdf[..700].to_vec(), "broken .sdf file, line"),
        ("endless.sdf", text("aISO-1.0\nNumPoints = 2\n"), "broken .sdf file, line 1: no line with an asterisk ends the header"),
        ("entry.sdf", with(&sdf, b"NumPoints ", b"NumPaints "), "its header has no NumPoints"),
        ("word.sdf", with(&sdf, b"NumPoints   = 12", b"NumPoints   = xx"), "broken .sdf file, line 5: numpoints = \"xx\" is not a number"),
        ("height.sdf", with(&sdf, b"-4.83354e-08", b"-4.8335xe-08"), "\"-4.8335xe-08\" is not a number"),
        ("scale.sdf", with(&sdf, b"Xscale      = 5.000000e-08", b"Xscale      = 0"), "Xscale = 0, Yscale = 0.00000008, Zscale = 1 are not lengths"),
        ("long.sdf", with(&sdf, b"NumPoints   = 12", b"NumPoints   = 99999999"), "9 rows of 99999999 columns need"),
        ("vast.sdf", with(&sdf, b"NumPoints   = 12", b"NumPoints   = 1e300"), "points are too many"),
        ("packed.sdf", with(&sdf, b"Compression = 0", b"Compression = 1"), "compressed .sdf files are not in this version; save it without compression"),
        ("cut_binary.sdf", sdf_binary[..sdf_binary.len() - 1].to_vec(), "9 rows of 12 columns need 864 bytes, there are 863"),
        ("header_binary.sdf", sdf_binary[..60].to_vec(), "the file ends within the scales"),
        ("scale_binary.sdf", patched(&sdf_binary, 46, &[0; 8]), "broken .sdf file at byte 46: Xscale = 0"),
        ("type_binary.sdf", patched(&sdf_binary, 79, &[9]), "broken .sdf file at byte 79: type 9 of data is not known"),
        ("packed_binary.sdf", patched(&sdf_binary, 78, &[1]), "compressed .sdf files are not in this version"),
        ("nothing_binary.sdf", patched(&sdf_binary, 42, &[0, 0]), "9 rows of 0 columns"),
        // Digital Surf.
        ("header.sur", sur[..300].to_vec(), "broken .sur file at byte 300: the file ends within the header, which begins at byte 0"),
        ("cut.sur", sur[..sur.len() - 1].to_vec(), "9 rows of 12 columns need 432 bytes, there are 431"),
        ("packed.sur", with(&sur, b"DIGITAL SURF", b"DSCOMPRESSED"), "compressed .sur files are not in this version; save it without compression"),
        ("motorola.sur", patched(&sur, 12, &[1]), ".sur files with the bytes in Motorola's order are not in this version"),
        ("bits.sur", patched(&sur, 98, &[8]), "broken .sur file at byte 98: points of 8 bits; 16 or 32 are known"),
        ("image.sur", patched(&sur, 18, &[10]), ".sur files of images, spectra, force curves or contours are not in this version; save a surface"),
        ("negative.sur", patched(&sur, 108, &[0xff; 4]), "9 rows of -1 columns"),
        ("vast.sur", patched(&sur, 108, &[0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff, 0x7f]), "points are too many"),
        ("step.sur", patched(&sur, 120, &[0; 4]), "broken .sur file at byte 120: steps of 0 and"),
        ("unit.sur", patched(&sur, 180, &[0; 16]), "x and y have no unit"),
        ("volts.sur", patched(&sur, 212, b"V\0\0"), "the file gives its heights in \"V\""),
        ("comment.sur", patched(&sur, 334, &[0xff, 0xff]), "the heights is said to begin at byte 66047, but the file has 944"),
        // Alicona.
        ("cut.al3d", al3d[..al3d.len() - 9].to_vec(), "9 rows of 12 columns need 432 bytes, there are 423"),
        ("tags.al3d", al3d[..40].to_vec(), "the file ends within a tag"),
        ("version.al3d", with(&al3d, b"Version", b"Varsion"), "broken .al3d file at byte 17: the tag Version is missing"),
        ("count.al3d", patched(&al3d, 17 + 52 + 20, b"x"), "broken .al3d file at byte 69: TagCount = "),
        ("rows.al3d", with(&al3d, b"Rows", b"Raws"), "the tag Rows is missing"),
        ("offset.al3d", {
            let at = al3d.windows(16).position(|window| window == b"DepthImageOffset").expect("a tag") + 20;
            patched(&al3d, at, b"99999999")
        }, "the depth image is said to begin at byte 99999999, but the file has"),
        ("no_image.al3d", {
            let at = al3d.windows(16).position(|window| window == b"DepthImageOffset").expect("a tag") + 20;
            patched(&al3d, at, b"0\0")
        }, "it holds no depth image"),
        ("pixel.al3d", {
            let at = al3d.windows(15).position(|window| window == b"PixelSizeXMeter").expect("a tag") + 20;
            patched(&al3d, at, b"0\0")
        }, "PixelSizeXMeter = 0 is not a length"),
        ("line.al3d", patched(&al3d, 17 + 50, b"xx"), "broken .al3d file at byte 17: a tag does not end in a line end"),
        ("vast.al3d", {
            let at = al3d.windows(5).position(|window| window == b"Rows\0").expect("a tag") + 20;
            patched(&al3d, at, b"999999999999999999")
        }, "points are too many"),
        // Surfer grids.
        ("cut.grd", text("DSAA\n2 2\n0 1\n0 1\n0 1\n1 2 3\n"), "broken .grd file, line 6: the file ends before the height of row 2, column 2"),
        ("word.grd", text("DSAA\n2 2\n0 1\n0 1\n0 1\n1 2\n3 x\n"), "broken .grd file, line 7: \"x\" is not a number; the height of row 2, column 2 is expected"),
        ("reversed.grd", text("DSAA\n2 2\n1 0\n0 1\n0 1\n1 2\n3 4\n"), "the greatest x and y must lie above the least ones"),
        ("nothing.grd", text("DSAA\n2.5 2\n"), "2 rows of 0 columns"),
        ("long.grd", with(&grd, b"12 9", b"99999 999"), "999 rows of 99999 columns need"),
        ("cut_6.grd", grd_6[..grd_6.len() - 2].to_vec(), "9 rows of 12 columns need 432 bytes, there are 430"),
        ("reversed_6.grd", patched(&grd_6, 16, &[0; 8]), "broken .grd file at byte 8: the greatest x and y must lie above"),
        ("negative_6.grd", patched(&grd_6, 4, &[0xff; 2]), "9 rows of -1 columns"),
        ("cut_7.grd", grd_7[..grd_7.len() - 8].to_vec(), "9 rows of 12 columns need 864 bytes, there are 856"),
        ("header_7.grd", grd_7[..12].to_vec(), "it has no DATA section"),
        ("order_7.grd", with(&grd_7, b"GRID", b"NONE"), "its DATA section stands before its GRID section"),
        ("section_7.grd", patched(&grd_7, 16, &[0xff; 4]), "the next section is said to begin at byte"),
        ("steps_7.grd", patched(&grd_7, 20 + 8 + 16, &[0; 8]), "are not positive"),
        // Texts.
        ("void.asc", text("# File Format = ASCII\n# voidpixels = 1\n1 2\n3 4\n0 1\n0 0\n"), "texts of SPIP with void pixels are not in this version; save it as .gsf or .gwy"),
        // Columns.
        ("pairs.xyz", text("1 2\n3 4\n"), "the points x, y, z do not form a grid: its lines have 2 numbers; x, y and z are expected"),
        ("twice.xyz", text("0 0 1\n1 0 2\n0 1 3\n0 1 4\n"), "row 4 lies at x = 0, y = 1, as a row above"),
        ("uneven.xyz", text("0 0 1\n1 0 2\n5 0 3\n0 1 4\n1 1 5\n5 1 6\n"), "x: 1 is not evenly spaced; place 2 of 3 from 0 to 5 is 2.5"),
        ("cloud.xyz", text("0 0 1\n1 3 2\n2 1 3\n3 2 4\n4 4 5\n"), "its 5 points have 5 different x and 5 different y"),
        ("hole.xyz", text("0 0 1\nnan 0 2\n0 1 3\n1 1 4\n"), "x: row 2 has none"),
        ("word.xyz", text("0 0 1\n1 0 x\n"), "line 2 (row 2), column 3: \"x\" is not a number"),
        ("missing.xyz", text("0 0 1\n1 0 2\n0 1 3\n"), "1 of 4 pixels are missing (0 of them infinite), the first at row 2, column 2"),
        // Images.
        ("cut.png", png[..100].to_vec(), "broken PNG image: "),
        ("colour.png", colour_png(), "images other than grey ones of 8 or 16 bits are not in this version; colours are not heights"),
        ("grey.png", png.clone(), "this is a grey image: give --black and --white, the heights of its ends"),
        // The same bits as signed whole numbers.
        ("signed.tif", patched(&good("tifffile_float.tif"), 186, &[2, 0]), "TIFF images of signed whole numbers, of whole ones of 32 bits"),
        ("cut.tif", tif[..100].to_vec(), "broken TIFF image: "),
        ("tiles.tif", patched(&good("tifffile_deflate.tif"), 162, &[0, 0, 0x10, 0]), "16 rows of 1048576 columns need 8192 bytes, there are 546"),
        ("vast_tiles.tif", patched(&good("tifffile_deflate.tif"), 162, &[0xf0, 0xff, 0xff, 0xff]), "68719476480 points are too many"),
        ("cut_pixels.tif", tif[..tif.len() - 20].to_vec(), "broken TIFF image: "),
    ];
    let folder = tempfile::tempdir().unwrap();
    let mut wrong = Vec::new();
    for (name, bytes, fragment) in &files {
        fs::write(folder.path().join(name), bytes).unwrap();
        let output = tabor(folder.path(), &["surface", name, "--size", "1 um", "--out", "never"]);
        let message = errors(&output);
        if output.status.code() != Some(2) || !output.stdout.is_empty() {
            wrong.push(format!("{name}: {:?} {message}", output.status));
        }
        if !(message.starts_with(&format!("error: {name}: ")) && message.contains(fragment)) || message.lines().count() != 1 {
            wrong.push(format!("{name}: {fragment:?} is not in {message}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(!folder.path().join("never").exists());
}

#[test]
fn bad_calls_are_refused_in_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    put("grey.png", &good("pillow_8.png"));
    put("map.gsf", &good("gwyddion.gsf"));
    put("wide.tif", &wide_tiff());
    put("sizeless.txt", b"1 2\n3 4\n");
    put("scene.toml", b"[grid]\n");
    fs::create_dir(folder.path().join("folder.gwy")).unwrap();
    // A text longer than is taken: a file with a hole takes no room.
    let long = fs::File::create(folder.path().join("long.txt")).unwrap();
    long.set_len((1 << 32) + 1).unwrap();
    for (arguments, fragment) in [
        (&["absent.gwy"][..], "absent.gwy: there is no such file"),
        (&["folder.gwy"], "folder.gwy: this is a folder"),
        (
            &["map.gsf/inside.gsf"],
            "map.gsf/inside.gsf: cannot be read",
        ),
        (
            &["long.txt"],
            "long.txt: 4294967297 bytes are too many to read; save the heights as .npy",
        ),
        (
            &["sizeless.txt"],
            "sizeless.txt: the file does not say its size; give --size",
        ),
        (
            &["map.gsf", "--size", "1 um"],
            "map.gsf: the map says it is 6e-7 x 7.2e-7 m (x, y), but --size says 1e-6 x 1e-6 m",
        ),
        (
            &["map.gsf", "--black", "0", "--white", "1 um"],
            "--black and --white are for grey images; this file holds heights",
        ),
        (
            &["map.gsf", "--black", "0"],
            "--black and --white are for grey images",
        ),
        (
            &["grey.png", "--size", "1 um", "--black", "0"],
            "this is a grey image: give --black and --white",
        ),
        (
            &[
                "grey.png", "--size", "1 um", "--black", "1 nm", "--white", "1e-9",
            ],
            "black and white are both 1e-9 m: an image of one height",
        ),
        (
            &["wide.tif", "--size", "1 um"],
            "wide.tif: broken TIFF image: ",
        ),
        (&["map.gsf", "--set", "grid.pionts=8"], "grid.pionts"),
        (
            &["scene.toml", "--fill", "interpolate"],
            "are for files of heights",
        ),
        (
            &["map.gsf", "--detrend", "linear"],
            "[possible values: none, mean, plane, quadratic, lines]",
        ),
        (&["map.gsf", "--size", "1 kg"], "a mass"),
        (&["map.gsf", "--size", "1,2,3"], "give one length, or two"),
    ] {
        let output = tabor(folder.path(), &[&["surface"], arguments].concat());
        let message = errors(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        // What clap says of a value is its own sentence around ours.
        assert!(
            message.contains(fragment) || fragment == "a mass" && message.contains("kg"),
            "{arguments:?}: {message}"
        );
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
}

/// A small TIFF image that says it has 30000 x 30000 points.
fn wide_tiff() -> Vec<u8> {
    // Tags 256 and 257, big-endian: the type (4, 32 bits), the count (1), the value.
    let mut bytes = good("tifffile_16.tif");
    for tag in [0, 1] {
        let entry = [1, tag, 0, 4, 0, 0, 0, 1];
        let at = bytes.windows(8).position(|window| window == entry);
        let at = at.expect("the tag of a side") + entry.len();
        bytes = patched(&bytes, at, &30_000_u32.to_be_bytes());
    }
    bytes
}
