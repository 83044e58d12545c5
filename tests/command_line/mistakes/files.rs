//! Bad height files, each in the scene of a folder of its own, as the binary refuses them.

use std::fs;
use std::path::Path;

use super::Reached;
use super::calls::{one_line, tabor};

/// A .npy file of version 1 with this description and these bytes.
fn npy(kind: &str, shape: &str, bytes: &[u8]) -> Vec<u8> {
    let description =
        format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}\n");
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((description.len() as u16).to_le_bytes());
    file.extend(description.as_bytes());
    file.extend(bytes);
    file
}

/// The scene around a height file; `more` goes into its part.
pub fn scene(name: &str, more: &str) -> String {
    format!(
        "[grid]\nsize = [\"3 um\", \"2 um\"]\nboundary = \"free\"\n[solid]\ncontact_modulus = 1e9\n[[surface]]\nkind = \"file\"\npath = \"{name}\"\n{more}\n[loading]\ncontrol = \"force\"\npath = [1e-9]\n"
    )
}

/// A grey image that is right.
const GREY: &[u8] = include_bytes!("../../files/pillow_16.png");

struct BadFile {
    name: &'static str,
    bytes: Vec<u8>,
    /// Keys of the surface part beside kind and path.
    more: &'static str,
    variant: &'static str,
    expected: &'static str,
}

#[rustfmt::skip] // one file a line
fn table() -> Vec<BadFile> {
    let six: Vec<u8> = (0..6).flat_map(|i| f64::from(i).to_le_bytes()).collect();
    let bad = |name, bytes: &[u8], variant, expected| BadFile { name, bytes: bytes.to_vec(), more: "", variant, expected };
    let good = |more, variant, expected| BadFile { name: "map.txt", bytes: b"1 2 3\n4 5 6\n".to_vec(), more, variant, expected };
    vec![
        bad("map.stl", b"solid", "FileError::NotInThisVersion", "height files of kind .stl are not in this version; docs/surfaces.md lists those that are"),
        bad("map", b"1 2\n", "FileError::NoExtension", "the name has no extension and the first bytes are those of no known kind; name it .txt"),
        bad("empty.npy", b"", "FileError::Empty", "the file is empty (0 bytes)"),
        bad("empty.txt", b"", "FileError::Empty", "the file is empty (0 bytes)"),
        bad("image.txt", b"\x89PNG\r\n\x1a\n", "FileError::OtherContent", "the name says .txt, but the file holds a PNG image; give it the right extension"),
        bad("tiff.csv", b"II*\0....", "FileError::OtherContent", "the name says .csv, but the file holds a TIFF image"),
        bad("zip.npy", b"PK\x03\x04....", "FileError::OtherContent", "the name says .npy, but the file holds a ZIP archive"),
        bad("text.npy", b"1 2\n3 4\n", "FileError::OtherContent", "the name says .npy, but the file holds no NumPy array"),
        bad("array.dat", &npy("<f8", "(2, 3)", &six), "FileError::OtherContent", "the name says .dat, but the file holds a NumPy array (.npy)"),
        bad("nul.txt", b"1 2\n3 \0\n", "FileError::Binary", "the file is not text: byte 6 is 0"),
        bad("wide.txt", b"\xFF\xFE1\0 \0", "FileError::Utf16", "the text is in UTF-16; save it as UTF-8"),
        bad("short_header.npy", b"\x93NUMPY\x01", "FileError::BrokenNpy", "broken .npy file: it ends within the header"),
        bad("version.npy", b"\x93NUMPY\x09\x00\x00\x00", "FileError::BrokenNpy", "version 9 of the format is not known"),
        bad("no_keys.npy", b"\x93NUMPY\x01\x00\x02\x00{}", "FileError::BrokenNpy", "broken .npy file: "),
        bad("overflow.npy", &npy("<f8", "(18446744073709551615, 2)", &six), "FileError::BrokenNpy", "exceeds all memory"),
        bad("line.npy", &npy("<f8", "(6,)", &six), "FileError::Dimensions", "the array has shape [6]; heights need two dimensions, [rows (y), columns (x)]"),
        bad("cube.npy", &npy("<f8", "(1, 2, 3)", &six), "FileError::Dimensions", "the array has shape [1, 2, 3]"),
        bad("complex.npy", &npy("<c16", "(1, 3)", &six), "FileError::ElementType", "elements of type <c16 are not heights; save them as float32, float64 or an integer type"),
        bad("words.npy", &npy("<U4", "(1, 3)", &six), "FileError::ElementType", "elements of type <U4 are not heights"),
        bad("cut.npy", &npy("<f8", "(2, 3)", &six[..40]), "FileError::Truncated", "the file is cut short: 2 rows of 3 columns need 48 bytes, there are 40"),
        bad("huge.npy", &npy("<f8", "(20000, 20000)", &six), "FileError::Truncated", "20000 rows of 20000 columns need 3200000000 bytes, there are 48"),
        bad("vast.npy", &npy("<f8", "(4294967296, 4294967)", &six), "FileError::TooManyPoints", "18446742802399232 points are too many; at most 17179869184 can be taken"),
        bad("nothing.npy", &npy("<f8", "(0, 3)", &[]), "FileError::NoNumbers", "the file holds no numbers"),
        bad("comments.txt", b"# 1 2\n% 3 4\n", "FileError::NoNumbers", "the file holds no numbers"),
        bad("ragged.txt", b"1 2 3\n4 5 6\n7 8\n", "FileError::Ragged", "line 3 (row 3) has 2 values where the rows above have 3; every row must have as many"),
        bad("ragged.csv", b"# c\n1,2\n\n3,4,5\n", "FileError::Ragged", "line 4 (row 2) has 3 values where the rows above have 2"),
        bad("word.txt", b"1 2\n3 four\n", "FileError::NotANumber", "line 2 (row 2), column 2: \"four\" is not a number"),
        bad("nan.txt", b"1 nan\nnan inf\n", "FileError::Missing", "3 of 4 pixels are missing (1 of them infinite), the first at row 1, column 2; write fill = \"interpolate\""),
        bad("hole.csv", b"1;2\n3;\n5;6\n", "FileError::Missing", "1 of 6 pixels are missing (0 of them infinite), the first at row 2, column 2"),
        bad("inf.npy", &npy("<f8", "(1, 1)", &f64::INFINITY.to_le_bytes()), "FileError::Missing", "1 of 1 pixels are missing (1 of them infinite)"),
        BadFile { name: "all.txt", bytes: b"nan nan\n".to_vec(), more: "fill = \"interpolate\"", variant: "FileError::AllMissing", expected: "all 2 pixels are missing: there is nothing to interpolate from" },
        bad("sized.txt", b"# Width: 4 um\n# Height: 2 um\n1 2 3\n4 5 6\n", "FileError::OtherSize", "the map says it is 4e-6 x 2e-6 m (x, y), but [grid] size says 3e-6 x 2e-6 m; leave size out or correct one"),
        BadFile { name: "far.txt", bytes: b"9e29 2 3\n4 5 6\n".to_vec(), more: "[[surface]]\nkind = \"file\"\npath = \"far.txt\"", variant: "SurfaceError::NotFinite", expected: "the heights are not finite, or exceed 1e30 m, at row 1, column 1" },
        bad("farther.txt", b"1e300 2 3\n4 5 6\n", "FileError::Extreme", "the largest height is 1e300 m; heights must be 0 or between 1e-30 and 1e30 m: check the unit and the powers of ten"),
        bad("nearer.txt", b"1e-300 2e-299 0\n0 0 0\n", "FileError::Extreme", "the largest height is 2e-299 m; heights must be 0 or"),
        bad("scan.txt", &b"1 2\n".repeat(20), "FileError::LineScan", "2 x 20 points (x, y) are a line scan and no map; write profile = true"),
        good("crop = [0, 0, 4, 2]", "FileError::Crop", "crop = [0, 0, 4, 2] (x, y of the first point, points along x and y) is not within the 3 x 2 points of the map"),
        bad("magic.gwy", b"GWYP", "FileError::Broken", "broken .gwy file at byte 4: the file ends within the name of an object"),
        bad("word.grd", b"DSAA\n2 2\n0 1\n0 1\n0 1\n1 2\n3 x\n", "FileError::BrokenText", "broken .grd file, line 7: \"x\" is not a number"),
        bad("nothing.grd", b"DSAA\n2.5 2\n", "FileError::Counts", "the file says it has 2 rows of 0 columns; both must be at least 1"),
        bad("cut.png", b"\x89PNG\r\n\x1a\n", "FileError::BrokenImage", "broken PNG image: "),
        bad("packed.sur", &[&b"DSCOMPRESSED"[..], &[0; 600]].concat(), "FileError::NotSupported", "compressed .sur files are not in this version; save it without compression"),
        bad("volts.gsf", b"Gwyddion Simple Field 1.0\nXRes = 1\nYRes = 1\nZUnits = V\n\0\0\0\0\0", "FileError::NotALength", "the file gives its heights in \"V\", which is not a length"),
        bad("pairs.xyz", b"1 2\n3 4\n", "FileError::NotAGrid", "the points x, y, z do not form a grid: its lines have 2 numbers"),
        BadFile { name: "profile.txt", bytes: b"0 5\n1 7\n3 4\n4 5\n".to_vec(), more: "profile = true", variant: "FileError::UnevenPlaces", expected: "the distances between the places of the profile are not equal: place 2 is 1; a profile has one line of heights, or two of places at equal distances and heights" },
        BadFile { name: "behind.txt", bytes: b"5 0\n7 1\n4 2\n5 3\n".to_vec(), more: "profile = true", variant: "FileError::PlacesBehindHeights", expected: "the second of its two lines seems to be that of places, since its distances are equal: put the places first" },
        bad("grey.png", GREY, "FileError::GreyEndsMissing", "this is a grey image: write black and white, the heights of its ends"),
        BadFile { name: "even.png", bytes: GREY.to_vec(), more: "black = 1\nwhite = 1", variant: "FileError::GreyEndsEqual", expected: "black and white are both 1e0 m: an image of one height" },
        good("black = 0\nwhite = 1", "FileError::GreyEndsUnused", "black and white are for grey images; this file holds heights"),
        good("[[surface]]\nkind = \"file\"\npath = \"other.txt\"", "FileError::NotFound", "[[surface]] 2: FOLDER/other.txt: there is no such file"),
        good("[adhesion]\nlaw = \"exponential\"\nwork_of_adhesion = 1e-2\nrange = 1e-8\nmap = \"wide.csv\"", "SurfaceError::AdhesionMap", "[adhesion] map FOLDER/wide.csv: the map has 4 x 2 points (x, y), but the grid has 3 x 2; a map has a factor for each point of the grid"),
        good("[adhesion]\nlaw = \"exponential\"\nwork_of_adhesion = 1e-2\nrange = 1e-8\nmap = \"hole.txt\"", "MapError::Factor", "[adhesion] map FOLDER/hole.txt: row 1, column 2: a factor of NaN; it must be finite and at least 0"),
        good("[adhesion]\nlaw = \"lennard-jones\"\nwork_of_adhesion = 1e-2\nrange = 1e-8\nmap = \"zeros.txt\"", "MapError::Factor", "[adhesion] map FOLDER/zeros.txt: row 1, column 1: a factor of 0e0; it must be above 0"),
        good("[adhesion]\nlaw = \"exponential\"\nwork_of_adhesion = 1e-2\nrange = 1e-8\nmap = \"lengths.txt\"", "FileError::LengthsAsFactors", "[adhesion] map FOLDER/lengths.txt: the file gives its numbers in units of 1e-9 m, and factors have none; save them without a unit"),
        good("[adhesion]\nlaw = \"exponential\"\nwork_of_adhesion = 1e-2\nrange = 1e-8\nmap = \"zeros.txt\"", "MapError::Nothing", "every factor is 0; leave [adhesion] out"),
        good("[adhesion]\nlaw = \"exponential\"\nwork_of_adhesion = 1e-2\nrange = 1e-8\nmap = { pattern = \"stripe\", period = 1.5e-6, low = 0, high = 1 }", "MapError::PeriodTooShort", "period = 1.5e-6 m along x is shorter than two pixels of 1e-6 m; take more points"),
        good("[[surface]]\nkind = \"file\"\npath = \"wide.csv\"", "FileError::OtherPoints", "[[surface]] 2: FOLDER/wide.csv: the map has 4 x 2 points (x, y), but an earlier height file has 3 x 2; leave points out"),
    ]
}

/// Checks every file and returns what was reached.
pub fn reached() -> Vec<Reached> {
    let mut reached: Vec<Reached> = table().iter().map(refused).collect();
    reached.extend(odd_paths());
    reached
}

fn refused(bad: &BadFile) -> Reached {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("wide.csv"), "1,2,3,4\n5,6,7,8\n").expect("a file");
    fs::write(folder.path().join("zeros.txt"), "0 0 0\n0 0 0\n").expect("a file");
    fs::write(folder.path().join("hole.txt"), "1 nan 1\n1 1 1\n").expect("a file");
    let lengths = "# Value units: nm\n1 1 1\n1 1 1\n";
    fs::write(folder.path().join("lengths.txt"), lengths).expect("a file");
    fs::write(folder.path().join(bad.name), &bad.bytes).expect("a file");
    let expected = bad.expected.replace("FOLDER", ".");
    let message = check(folder.path(), &scene(bad.name, bad.more), &expected);
    if bad.more.is_empty() {
        let place = format!("error: scene.toml: [[surface]] 1: ./{}: ", bad.name);
        assert!(message.starts_with(&place), "{message}");
    }
    Reached {
        variant: bad.variant.to_owned(),
        message,
    }
}

/// The one message of a scene in a folder.
fn check(folder: &Path, scene: &str, expected: &str) -> String {
    fs::write(folder.join("scene.toml"), scene).expect("a scene");
    let output = tabor(folder, &["check", "scene.toml"], &[]);
    one_line(&output, 2, expected)
}

/// Paths that are no files, and files that cannot be read.
fn odd_paths() -> Vec<Reached> {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("folder.npy")).expect("a folder");
    let mut cases = vec![
        (
            "absent.npy".to_owned(),
            "FileError::NotFound",
            "there is no such file; a path in a scene is relative to the folder of the scene file",
        ),
        (
            "folder.npy".to_owned(),
            "FileError::Folder",
            "this is a folder; path must name one height file",
        ),
        (".".to_owned(), "FileError::Folder", "this is a folder"),
    ];
    if cfg!(unix) {
        cases.push((
            "/dev/zero".to_owned(),
            "FileError::NotRegular",
            "this is not a regular file; copy the heights into one",
        ));
        // Longer than any file system takes.
        cases.push((
            format!("{}.npy", "x".repeat(5000)),
            "FileError::Read",
            "cannot be read: ",
        ));
    }
    cases
        .into_iter()
        .map(|(path, variant, expected)| Reached {
            variant: variant.to_owned(),
            message: check(folder.path(), &scene(&path, ""), expected),
        })
        .collect()
}
