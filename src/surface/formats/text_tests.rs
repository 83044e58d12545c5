//! Forms of a text matrix, and errors with their place.

use std::io::Cursor;

use super::*;

/// The matrix of a text that is read whole; by rows the text has the same numbers, or is wrong in the same words.
fn read_map(bytes: &[u8]) -> Result<Matrix, FileError> {
    let opened = |opening| {
        read(Bytes::new(
            Cursor::new(bytes.to_vec()),
            bytes.len(),
            opening,
        ))
    };
    let whole = opened(Opening::Whole).and_then(Map::read);
    let bits =
        |values: &[f64]| -> Vec<u64> { values.iter().map(|value| value.to_bits()).collect() };
    match (&whole, opened(Opening::ByRows)) {
        (Ok(whole), Ok(map)) => {
            let (numbers, header) = map.split();
            let mut rows = numbers.into_rows();
            let mut found = vec![0.0; whole.values.len()];
            for part in found.chunks_mut(2 * whole.columns) {
                rows.next(part).expect("rows that have been checked");
            }
            assert_eq!(
                header.with(bits(&found)),
                whole.clone().split().1.with(bits(&whole.values))
            );
        }
        (Err(whole), Err(error)) => assert_eq!(whole.to_string(), error.to_string()),
        (whole, map) => panic!("{whole:?}, by rows {:?}", map.map(|map| map.split().1)),
    }
    whole
}

fn numbers(text: &str) -> (usize, usize, Vec<f64>) {
    let matrix = read_map(text.as_bytes()).unwrap_or_else(|error| panic!("{text:?}: {error}"));
    (matrix.rows, matrix.columns, matrix.values)
}

#[test]
fn the_same_matrix_in_every_form() {
    let expected = (2, 3, vec![1.0, -2.5, 3.0, 4.0, 5e-9, 6.25]);
    for text in [
        "1 -2.5 3\n4 5e-9 6.25\n",
        "1 -2.5 3\n4 5e-9 6.25",
        "  1\t-2.5   3 \r\n\r\n 4 5E-9\t6.25\r\n",
        "1 -2.5 3\r4 5e-9 6.25\r",
        "1,-2.5,3\n4,5e-9,6.25",
        "1, -2.5, 3\n4, 5e-9, 6.25",
        "1 , -2.5 , 3\n4 , 5e-9 , 6.25",
        "1,-2.5,3,\n4,5e-9,6.25,\n",
        "1;-2.5;3\n4;5e-9;6.25",
        "1;-2,5;3\n4;5e-9;6,25",
        "1; -2,5; 3;\n4; 5e-9; 6,25;",
        "1 -2,5 3\n4 5e-9 6,25",
        "1\t-2,5\t3\n4\t5e-9\t6,25",
        "1,\t-2.5,\t3\n4,\t5e-9,\t6.25",
        "\t1\t-2.5\t3\n\t4\t5e-9\t6.25\n",
        "\u{feff}# heights\n1 -2.5 3 % first\n4 5e-9 6.25 // second\n",
        "a b c\n1 -2.5 3\n4 5e-9 6.25",
        "\n# a comment\nheight (nm)\n1,-2.5,3\n4,5e-9,6.25",
        "\"1\",\"-2.5\",\"3\"\n4,5D-9,6.25",
        "+1 -2.50 3. \n4. 5d-9 +6.25",
        "1;\u{2212}2,5;3\n4;5e\u{2212}9;6,25",
    ] {
        assert_eq!(numbers(text), expected, "{text:?}");
    }
}

#[test]
fn missing_pixels_are_not_numbers() {
    for text in [
        "1;;3\n4;5;6",
        "1,,3\n4,5,6",
        "1\t\t3\n4\t5\t6",
        "1 nan 3\n4 5 6",
        "1 N/A 3\n4 5 6",
        "1,NaN,3\n4,5,6",
    ] {
        let (rows, columns, values) = numbers(text);
        assert_eq!((rows, columns), (2, 3), "{text:?}");
        assert!(
            values[1].is_nan() && values[0] == 1.0 && values[5] == 6.0,
            "{text:?}"
        );
    }
    // Only a separator that ends every line is not a missing pixel.
    let (_, columns, values) = numbers("1,2,\n3,4,5\n");
    assert!(columns == 3 && values[2].is_nan());
}

#[test]
fn what_other_programs_write_for_no_number_is_missing() {
    for mark in [
        "1.#QNAN",
        "-1.#IND00",
        "1.#INF",
        "1.#J",
        "-1.#R",
        "#N/A",
        "#N/A N/A",
        "#NV",
        "#VALUE!",
        "#WERT!",
        "#DIV/0!",
        "#NAME?",
        "\"#N/A\"",
    ] {
        for separator in [" ", "\t", ",", ";", "; "] {
            for place in 0..4 {
                let mut fields = ["1", "2", "3", "4"];
                fields[place] = mark;
                let [a, b, c, d] = fields;
                let text = format!("{a}{separator}{b} # a comment\n{c}{separator}{d}\n");
                let (rows, columns, values) = numbers(&text);
                assert_eq!((rows, columns), (2, 2), "{text:?}");
                for (at, value) in values.iter().enumerate() {
                    match at == place {
                        true => assert!(!value.is_finite(), "{text:?}"),
                        false => assert_eq!(*value, (at + 1) as f64, "{text:?}"),
                    }
                }
            }
        }
    }
    // With decimal commas, and one in a line.
    let (_, columns, values) = numbers("1,5 -1,#IND\n2,5 1,#QNAN00\n");
    assert!(columns == 2 && values[0] == 1.5 && values[1].is_nan() && values[3].is_nan());
    let (rows, _, values) = numbers("1\n#N/A\n3\n");
    assert!(rows == 3 && values[1].is_nan() && values[2] == 3.0);
    assert_eq!(
        numbers("1 2\n3 4 #1\n#N/A is missing\n#VALUES\n").2,
        [1.0, 2.0, 3.0, 4.0]
    );
    for text in ["1 2#3\n", "1 1.#X\n", "1 5%\n"] {
        let error = read_map(text.as_bytes()).unwrap_err();
        assert!(
            error.to_string().contains("is not a number"),
            "{text}: {error}"
        );
    }
}

#[test]
fn a_first_row_of_quoted_decimal_commas_or_minus_signs_is_no_header() {
    assert_eq!(
        numbers("\"1,5\";\"2,5\"\n\"3\";\"4\"\n"),
        (2, 2, vec![1.5, 2.5, 3.0, 4.0])
    );
    assert_eq!(
        numbers("\"a\";\"b\"\n\"3\";\"4\"\n"),
        (1, 2, vec![3.0, 4.0])
    );
    assert_eq!(
        numbers("\u{2212}1e\u{2212}2 \u{2212}2\n3 4\n"),
        (2, 2, vec![-1e-2, -2.0, 3.0, 4.0])
    );
    // Nor is one whose pixels are all missing.
    let (rows, _, values) = numbers(";;\n1;2;3\n");
    assert!(rows == 2 && values[0].is_nan() && values[5] == 3.0);
}

#[test]
fn one_row_one_column_one_number() {
    assert_eq!(numbers("1 2 3"), (1, 3, vec![1.0, 2.0, 3.0]));
    assert_eq!(numbers("1\n2\n"), (2, 1, vec![1.0, 2.0]));
    assert_eq!(numbers("7"), (1, 1, vec![7.0]));
    assert_eq!(numbers("1;\n2;\n"), (2, 1, vec![1.0, 2.0]));
    assert_eq!(numbers(";1;\n;2;\n"), (2, 1, vec![1.0, 2.0]));
}

#[test]
fn separators_alone_are_missing_pixels() {
    for text in [";", ";\n;;\n", "\t\n;", ",,,", ",\n,", ";;\n;;"] {
        match read_map(text.as_bytes()) {
            Ok(matrix) => assert!(matrix.values.iter().all(|value| value.is_nan())),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
}

#[test]
fn comments_may_state_the_size() {
    for micro in ["um", "\u{b5}m", "\u{3bc}m"] {
        let text = format!(
            "# Channel: Z\n# Width: 5.00 {micro}\n# Height: 2.5 {micro}\n# Value units: nm\n1 2\n"
        );
        let matrix = read_map(text.as_bytes()).unwrap();
        assert_eq!(matrix.size, Some(Size::Metres([5e-6, 2.5e-6])));
        assert_eq!(matrix.unit, Some(1e-9));
    }
    // In Latin-1 the micro sign is a byte that UTF-8 does not have.
    let matrix = read_map(b"# Width: 1e1 \xB5m\n# Height: 1e1 \xB5m\n1 2\n").unwrap();
    assert_eq!(matrix.size, Some(Size::Metres([1e1 * 1e-6; 2])));
    let matrix = read_map(b"# Width: 5 px\n# Height: -5 um\n1 2\n").unwrap();
    assert_eq!((matrix.size, matrix.unit), (None, None));
}

#[test]
fn errors_name_line_row_and_column() {
    for (text, fragment) in [
        (
            "1 2\n3\n",
            "line 2 (row 2) has 1 values where the rows above have 2",
        ),
        (
            "# c\n\n1,2\n3,4,5\n",
            "line 4 (row 2) has 3 values where the rows above have 2",
        ),
        (
            "1 2\n3 x4\n",
            "line 2 (row 2), column 2: \"x4\" is not a number",
        ),
        (
            "1,2,3\n4,5 6,7\n",
            "line 2 (row 2), column 2: \"5 6\" is not a number",
        ),
        ("1.5,2 3\n", "\"2 3\" is not a number"),
        ("1;2.5,5\n", "\"2.5,5\" is not a number"),
        ("1;1,2,3\n", "\"1,2,3\" is not a number"),
        ("words only\n", "holds no numbers"),
        (
            "words\nmore words\n1 2\n",
            "line 2 (row 1), column 1: \"more\" is not a number",
        ),
        // A first row without letters is no header.
        (
            "-- --\n1 2\n",
            "line 1 (row 1), column 1: \"--\" is not a number",
        ),
        ("# nothing\n\n", "holds no numbers"),
        ("0x10 1\n", "\"0x10\" is not a number"),
        ("1 2\0\n", "byte 3 is 0"),
        ("1 \u{fffd}2\n", "is not a number"),
    ] {
        let message = read_map(text.as_bytes()).unwrap_err().to_string();
        assert!(message.contains(fragment), "{text:?}: {message}");
    }
    let utf16 = read_map(b"\xFF\xFE1\0").unwrap_err().to_string();
    assert!(utf16.contains("UTF-16"), "{utf16}");
}

proptest::proptest! {
    /// Any bytes give a matrix or an error.
    #[test]
    fn any_bytes_give_an_error_or_a_matrix(bytes in proptest::collection::vec(proptest::prelude::any::<u8>(), 0..200)) {
        let _ = read_map(&bytes);
    }

    /// The same with the significant characters.
    #[test]
    fn any_text_gives_an_error_or_a_matrix(text in "[0-9a-e,;.\t\r\n #%/nax+-]{0,60}") {
        if let Ok(matrix) = read_map(text.as_bytes()) {
            assert_eq!(matrix.values.len(), matrix.rows * matrix.columns);
        }
    }
}

/// Gwyddion's export in other languages than English, and one with a size but no length for its values.
#[test]
fn sizes_are_read_in_any_language() {
    for head in [
        "# Kanal: Topo\n# Breite: 5,0 \u{b5}m\n# H\u{f6}he: 8 nm\n# Value units: nm\n",
        "# Kan\u{e1}l: Topo\n# \u{160}\u{ed}\u{159}ka: 5.0 um\n# V\u{fd}\u{161}ka: 8 nm\n# Jednotky hodnot: nm\n",
        "# \u{41a}\u{430}\u{43d}\u{430}\u{43b}: a: b\n# x: 5 \u{b5}m\n# y: 8.0 nm\n# z: nm\n",
        "# Canal: 3 um\n# Largeur: 5 \u{b5}m\n# Hauteur: 8 nm\n# Unit\u{e9}s: nm\n",
    ] {
        let matrix = read_map(format!("{head}1 2\n3 4\n").as_bytes()).unwrap();
        assert_eq!(matrix.size, Some(Size::Metres([5e-6, 8e-9])), "{head}");
        assert_eq!(matrix.unit, Some(1e-9), "{head}");
    }
    // Other lengths in a row are no sides, and Gwyddion's four comments stand above all others.
    for head in [
        "# Channel: Z\n# X offset: 5 um\n# Y offset: 6 um\n# Z units: nm\n",
        "# X Resolution: 500 nm\n# Y Resolution: 500 nm\n# Z units: nm\n",
        "# A: b\n# Scan size: 24 um\n# From: 5 um\n# To: 6 um\n# Z units: nm\n",
    ] {
        let matrix = read_map(format!("{head}1 2\n3 4\n").as_bytes()).unwrap();
        assert_eq!((matrix.size, matrix.unit), (None, None), "{head}");
    }
    let other = "# Kanal: Topo\n# Breite: 5 um\n# H\u{f6}he: 8 nm\n# Value units: V\n1 2\n3 4\n";
    let matrix = read_map(other.as_bytes()).unwrap();
    assert_eq!((matrix.size, matrix.unit), (None, None));
    assert!(
        matrix.warnings[0].contains("give the unit \"V\" of the values, which is not a length"),
        "{:?}",
        matrix.warnings
    );
}

/// Of a long text the beginning tells how it is read, and about how many rows it has; three columns may be points.
#[test]
fn a_glance_sees_the_beginning() {
    let glance = |text: &str| {
        let bytes = text.as_bytes().to_vec();
        read(Bytes::new(Cursor::new(bytes), text.len(), Opening::Glance))
    };
    let row = "1.25 -2.5e-3 3 4\n".repeat(2);
    let long = row.repeat(70000);
    assert!(long.len() > 2 * BEGINNING);
    let map = glance(&long).unwrap();
    assert!(matches!(map.values, Numbers::Rows(_)));
    assert_eq!(map.columns, 4);
    assert!(map.rows.abs_diff(140_000) < 140, "{}", map.rows);
    // What is wrong behind the beginning is not seen, and found when the text is opened to be read.
    let wrong = long.clone() + "1 2 3\n";
    assert!(glance(&wrong).is_ok());
    assert!(read_map(wrong.as_bytes()).is_err());
    // A line that begins within the beginning is read to its end.
    for end in ["", "\r\n", "\r"] {
        let line = "7;".repeat(BEGINNING) + "8" + end;
        let map = glance(&(line.clone() + &line)).unwrap();
        let [rows, lines] = if end.is_empty() { [1, 2] } else { [2, 1] };
        assert_eq!(
            [map.rows, map.columns],
            [rows, (BEGINNING + 1) * lines - (lines - 1)]
        );
    }
    assert_eq!(glance("1 2\n3 4\n5 6").unwrap().rows, 3);
    let points = "0 0 1\n1 0 2\n0 1 3\n1 1 4\n";
    let seen = glance(points).unwrap();
    assert_eq!([seen.rows, seen.columns], [2, 2]);
    // Three columns of heights are no points.
    let heights = "0 0 1\n1 0 2\n0 7 3\n1 1 4\n";
    let opened = read(Bytes::new(
        Cursor::new(heights.as_bytes()),
        heights.len(),
        Opening::ByRows,
    ));
    assert!(matches!(opened.unwrap().values, Numbers::Rows(_)));
    assert!(glance(&format!("# Width: 1 um\n# Height: 1 um\n{points}")).is_ok());
}

/// Units in the heads of columns, one for each.
#[test]
fn heads_of_columns_state_units() {
    let points = "0,0,1\n1,0,2\n0,1,3\n1,1,4\n";
    for head in [
        "x [um],y [um],z [nm]",
        "x (um), y (um), z (nm)",
        "\"X [\u{b5}m]\",\"Y [\u{b5}m]\",\"Height [nm]\"",
        "# x [um], y [um], z [nm]",
    ] {
        let map = read_map(format!("{head}\n{points}").as_bytes()).unwrap();
        assert_eq!(map.size, Some(Size::Metres([2.0 * 1e-6; 2])), "{head}");
        assert_eq!((map.unit, map.warnings.len()), (Some(1e-9), 0), "{head}");
        let blanks = format!("{head}\n{points}").replace(',', " ");
        let map = read_map(blanks.as_bytes()).unwrap();
        assert_eq!(map.unit, Some(1e-9), "{blanks}");
    }
    let map = read_map(format!("x [um],y [mm],z [nm]\n{points}").as_bytes()).unwrap();
    assert_eq!(map.size, Some(Size::Metres([2.0 * 1e-6, 2.0 * 1e-3])));
    // Without brackets in a header, behind a slash or an underscore.
    for head in [
        "X/um;Y/mm;Z/nm",
        "x_um, y_mm, height_nm",
        "x/um\ty/mm\tz/nm",
    ] {
        let map = read_map(format!("{head}\n{points}").as_bytes()).unwrap();
        assert_eq!(map.size, Some(Size::Metres([2.0 * 1e-6, 2.0 * 1e-3])));
        assert_eq!((map.unit, map.warnings.len()), (Some(1e-9), 0), "{head}");
    }
    // In the order y, x.
    let map =
        read_map(b"y [mm],x [um],z [nm]\n0,0,1\n0,1,2\n0,2,3\n1,0,4\n1,1,5\n1,2,6\n").unwrap();
    assert_eq!([map.rows, map.columns], [2, 3]);
    assert_eq!(map.values, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!(map.size, Some(Size::Metres([3.0 * 1e-6, 2.0 * 1e-3])));
    // The size in a comment is that of the map which the points form.
    let sized = format!("# Width: 3 um\n# Height: 2 um\n# Value units: nm\n{points}");
    let map = read_map(sized.as_bytes()).unwrap();
    assert_eq!([map.rows, map.columns], [2, 2]);
    assert_eq!(map.size, Some(Size::Metres([3e-6, 2e-6])));
    // A comment in Gwyddion's form is more definite.
    let named = format!("# Value units: pm\nx [um],y [um],z [nm]\n{points}");
    assert_eq!(read_map(named.as_bytes()).unwrap().unit, Some(1e-12));
    // Of heights all must be in the same.
    let map = read_map(b"a [nm];b [nm]\n1;2\n").unwrap();
    assert_eq!((map.unit, map.warnings.len()), (Some(1e-9), 0));
    // Of a profile the first is that of its places.
    let map = read_map(b"x [mm];z [nm]\n0;2\n1;3\n2;4\n").unwrap();
    assert_eq!((map.unit, map.lateral_unit), (Some(1e-9), Some(1e-3)));
    let map = read_map(b"# Lateral units: mm\n0 2\n1 3\n2 4\n").unwrap();
    assert_eq!((map.unit, map.lateral_unit), (None, Some(1e-3)));
    for head in ["height (nm)", "x [um], y [um], z", "x [um], y [um], z [V]"] {
        let map = read_map(format!("{head}\n{points}").as_bytes()).unwrap();
        assert_eq!((map.unit, map.warnings.len()), (None, 1), "{head}");
        assert!(map.warnings[0].contains("its header gives units"));
    }
}

/// Columns come in the order of their heads.
#[test]
fn heads_name_the_columns() {
    let grid = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
    for order in [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ] {
        for heads in [
            ["x [um]", "y [mm]", "z [nm]"],
            ["X position [um]", "Y position [mm]", "Height [nm]"],
            ["X/um", "Y/mm", "Z/nm"],
        ] {
            let mut text = order.map(|column| heads[column]).join(",") + "\n";
            for (y, row) in grid.iter().enumerate() {
                for (x, z) in row.iter().enumerate() {
                    let point = [format!("{}", 2 * x), format!("{}", 3 * y), format!("{z}")];
                    text += &(order.map(|column| point[column].as_str()).join(",") + "\n");
                }
            }
            let map = read_map(text.as_bytes()).unwrap();
            assert_eq!(map.values, grid.concat(), "{text}");
            assert_eq!(
                map.size,
                Some(Size::Metres([6.0 * 1e-6, 6.0 * 1e-3])),
                "{text}"
            );
            assert_eq!((map.unit, map.warnings.len()), (Some(1e-9), 0), "{text}");
        }
    }
    // Which of more words are the heads of three columns is not known.
    let words = read_map(b"x position y position z\n0 0 1\n1 0 2\n0 1 3\n1 1 4\n").unwrap();
    assert_eq!(words.values, [1.0, 2.0, 3.0, 4.0]);
    // Names of columns that are not there.
    let map = read_map(b"# z (nm)\nx y\n1\n2\n").unwrap();
    assert_eq!((map.columns, map.unit), (1, Some(1e-9)));
    // Of a profile.
    for (head, places) in [
        ("Z [nm],X [um]", Some(1)),
        ("Height (nm); Distance (um)", Some(1)),
        ("y/nm, x/um", Some(1)),
        ("x [um], z [nm]", Some(0)),
        ("Distance [um], height [nm]", Some(0)),
        ("Weg [um], H\u{f6}he [nm]", None),
    ] {
        let map = read_map(format!("{head}\n1,2\n3,4\n").as_bytes()).unwrap();
        assert_eq!(map.places, places, "{head}");
        assert_eq!(
            (map.unit, map.lateral_unit),
            (Some(1e-9), Some(1e-6)),
            "{head}"
        );
    }
}

/// One column of numbers with decimal commas is not two.
#[test]
fn a_zero_behind_a_comma_belongs_to_a_fraction() {
    assert_eq!(
        numbers("0,5\n-1,05\n2,25\n"),
        (3, 1, vec![0.5, -1.05, 2.25])
    );
    assert_eq!(numbers("0,5\n1,0\n2,25\n").1, 2);
    assert_eq!(numbers("0,5,05\n1,0,1\n").1, 3);
}

/// A comment with brackets is the heads of columns only if it has a unit for each.
#[test]
fn brackets_in_comments_are_no_heads_of_other_columns() {
    let points = "0 0 1\n1 0 2\n0 1 3\n1 1 4\n";
    for head in [
        "# x [um], y [um], z [nm]\n# scan 5 (um)\n",
        "# scan 5 (um)\n# x [um], y [um], z [nm]\n",
        "# a (mm), b (mm), c (mm)\n# x [um], y [um], z [nm]\n# area 5 (um) x 5 (um)\n",
        "# x [um], y [um], z [nm]\nx y z\n",
    ] {
        let map = read_map(format!("{head}{points}").as_bytes()).unwrap();
        assert_eq!(map.size, Some(Size::Metres([2.0 * 1e-6; 2])), "{head}");
        assert_eq!((map.unit, map.warnings.len()), (Some(1e-9), 0), "{head}");
    }
    // A header is nearer to the numbers.
    let head = "# x [um], y [um], z [nm]\nx [mm] y [mm] z [um]\n";
    let map = read_map(format!("{head}{points}").as_bytes()).unwrap();
    assert_eq!(map.unit, Some(1e-6));
    // Of one column.
    for (comment, unit) in [
        ("sample (A)", None),
        ("scan 5 (um)", None),
        ("scan 5 [um]", None),
        ("height (nm) of a sample", None),
        ("run[3] of sample (A)", None),
        ("run[3], height (nm)", Some(1e-9)),
        ("z (nm)", Some(1e-9)),
        ("Height (nm) ", Some(1e-9)),
        ("z(nm)", Some(1e-9)),
        ("[nm]", Some(1e-9)),
        ("Trace [nm]", Some(1e-9)),
        ("z 2 [nm]", Some(1e-9)),
    ] {
        let map = read_map(format!("# {comment}\n1\n2\n3\n").as_bytes()).unwrap();
        assert_eq!((map.unit, map.warnings.len()), (unit, 0), "{comment}");
    }
    let map = read_map(b"# x [mm], z [nm]\n# sample (A)\n0 2\n1 3\n2 4\n").unwrap();
    assert_eq!((map.unit, map.lateral_unit), (Some(1e-9), Some(1e-3)));
    let map = read_map(b"# Value units: pm\n# z (nm)\n1\n2\n").unwrap();
    assert_eq!(map.unit, Some(1e-12));
}

/// Points on one line are one line of heights, not a map of three columns.
#[test]
fn named_points_on_one_line_are_a_line() {
    for head in ["x,y,z", "# x [m], y [m], z [m]"] {
        for count in [4, 20] {
            for along_y in [false, true] {
                let point = |at: usize| match along_y {
                    true => format!("5,{},{}\n", 2 * at, at * at),
                    false => format!("{},5,{}\n", 2 * at, at * at),
                };
                let points: String = (0..count).map(point).collect();
                let map = read_map(format!("{head}\n{points}").as_bytes()).unwrap();
                let shape = if along_y { [count, 1] } else { [1, count] };
                assert_eq!([map.rows, map.columns], shape, "{head}");
                let heights: Vec<f64> = (0..count).map(|at| (at * at) as f64).collect();
                assert_eq!(map.values, heights, "{head}");
            }
        }
    }
    // Its width is that of one pixel, in the unit of the places that differ.
    let map = read_map(b"x [mm],y [um],z [nm]\n5,0,1\n5,2,2\n5,4,3\n5,6,4\n").unwrap();
    assert_eq!(map.size, Some(Size::Metres([2.0 * 1e-6, 8.0 * 1e-6])));
    // Without names they may be heights.
    assert_eq!(numbers("0 0 1\n1 0 2\n2 0 3\n3 0 4\n").1, 3);
}

/// Points that form no grid are refused where they are surely points, and else warned of.
#[test]
fn points_without_a_grid_are_told() {
    let scattered = |head: &str, fourth: &str| {
        let points =
            (0..30).map(|at| format!("{},{},{at}{fourth}\n", at * at % 31, at * at * at % 37));
        head.to_owned() + &points.collect::<String>()
    };
    for (text, what) in [
        (scattered("x,y,z\n", ""), "do not form a grid: x: "),
        (
            scattered("X [um], Y [um], height\n", ""),
            "do not form a grid",
        ),
        (
            scattered("x,y,z,quality\n", ",1"),
            "its lines have 4 numbers",
        ),
    ] {
        let error = read_map(text.as_bytes()).unwrap_err().to_string();
        assert!(error.contains(what), "{error}");
    }
    for (text, what) in [
        (
            scattered("", ""),
            "if they are points x y z, they form no grid: x: ",
        ),
        (
            scattered("", ",1"),
            "they form no grid: its lines have 4 numbers",
        ),
    ] {
        let map = read_map(text.as_bytes()).unwrap();
        assert!(map.warnings[0].contains(what), "{:?}", map.warnings);
    }
    // One point twice.
    let mut grid: String = (0..20)
        .map(|at| format!("{} {} {at}\n", at % 5, at / 5))
        .collect();
    assert_eq!(read_map(grid.as_bytes()).unwrap().columns, 5);
    grid += "3 2 17\n";
    let error = read_map(grid.as_bytes()).unwrap_err().to_string();
    assert!(
        error.contains("row 21 lies at x = 3, y = 2, as a row above"),
        "{error}"
    );
    // A few rows of three heights.
    assert!(
        read_map(b"0 0 1\n1 0 2\n0 7 3\n1 1 4\n")
            .unwrap()
            .warnings
            .is_empty()
    );
}
