//! Bad force curves, as `tabor fit` reads them.

use std::fs;

use tabor::fit::{
    ColumnChoice, CurveColumns, FitError, ForceCurve, Freedom, Sample, fit_curve, fit_relaxation,
    fit_with_slope,
};

use super::Reached;

const FREE: Freedom = Freedom {
    approach_offset: true,
    force_offset: false,
    baseline_slope: false,
    range: None,
};

fn rows(head: &str, count: usize, row: impl Fn(usize) -> String) -> String {
    let rows: String = (0..count).map(|i| row(i) + "\n").collect();
    format!("{head}\n{rows}")
}

/// Every way in which a curve can be wrong, with what is said about it.
pub fn reached() -> Vec<Reached> {
    let mut reached = Vec::new();
    let mut reach = |variant: &str, error: &FitError| {
        reached.push(Reached {
            variant: format!("FitError::{variant}"),
            message: error.to_string(),
        });
    };
    let good = |i: usize| format!("{i}e-9,{}e-9", i as f64 - 5.0);
    let with = |line: usize, text: &str| {
        let text = text.to_owned();
        move |i: usize| if i == line { text.clone() } else { good(i) }
    };
    let head = "approach,force";
    let hertz = |i: usize| (i as f64).powf(1.5);
    let dmt = |i: usize| if i < 15 { 0.0 } else { hertz(i - 15) - 60.0 };
    let cases: Vec<(&str, String, &str)> = vec![
        (
            "NoHead",
            rows("1,2", 20, good),
            "has no header; its first line must name the columns",
        ),
        ("NoHead", "# only a comment\n".to_owned(), "has no header"),
        (
            "NoColumn",
            rows("depth,force", 20, good),
            "line 1: no column `approach` among \"depth, force\"; name it `approach` (SI) or with its unit, `approach [nm]`",
        ),
        (
            "NoColumn",
            rows("approach,load", 20, good),
            "no column `force` among",
        ),
        (
            "NoColumn",
            rows("force,Force [nN]", 20, good),
            "no column `approach`",
        ),
        (
            "TwoColumns",
            rows("approach,force,Force [nN]", 20, |i| format!("{i},1,1")),
            "two columns `force`",
        ),
        (
            "Unit",
            rows("approach [nN],force", 20, good),
            "line 1, column `approach`:",
        ),
        (
            "Unit",
            rows("approach [furlong],force", 20, good),
            "is not a unit",
        ),
        (
            "Ragged",
            rows(head, 20, with(4, "1,2,3")),
            "line 6: 3 values where the header names 2 columns",
        ),
        (
            "NotANumber",
            rows(head, 20, with(4, "1,much")),
            "line 6, column `force`: \"much\" is not a number",
        ),
        (
            "NotANumber",
            rows(head, 20, with(0, "1e999,2")),
            "line 2, column `approach`:",
        ),
        (
            "TooFewRows",
            rows(head, 9, good),
            "9 rows with an approach and a force, of 10 that a fit needs",
        ),
        ("TooFewRows", rows(head, 20, |_| ",".to_owned()), "0 rows"),
        (
            "Extreme",
            rows(head, 20, |i| format!("{i}e-9,{}e40", i as f64 - 5.0)),
            "column `force`: its largest number is 1.4e41; it must be between 1e-30 and 1e30 in SI units: check the unit in the header",
        ),
        (
            "Extreme",
            rows(head, 20, |i| format!("{i}e-40,{}e-9", i as f64 - 5.0)),
            "column `approach`: its largest number is 1.9e-39; it must be",
        ),
        (
            "Broken",
            "\\*Force file list\r\n\\*File list end\r\n".to_owned(),
            "is not a whole Nanoscope force curve: it holds no deflection of a force curve",
        ),
        (
            "Broken",
            "PK\u{3}\u{4} and nothing more".to_owned(),
            "is not a whole .jpk-force force curve: its archive is not whole",
        ),
        (
            "Constant",
            rows(head, 20, |i| format!("1,{i}")),
            "the approach is the same in every row",
        ),
        (
            "Constant",
            rows(head, 20, |i| format!("{i},1")),
            "the force is the same in every row",
        ),
        (
            "NoCompression",
            rows(head, 20, |i| format!("{i},-{}", i + 1)),
            "no row is in compression",
        ),
        (
            "NoContact",
            rows(head, 40, |i| {
                let noise = (i * i * 7 % 23) as f64 - 11.0;
                format!("{i}e-9,{noise}e-12")
            }),
            "the forces are noise about the baseline",
        ),
        (
            "WrongWay",
            rows(head, 20, |i| format!("{i},{}", hertz(19 - i))),
            "the force grows as the surfaces separate",
        ),
        (
            "WrongWay",
            rows(head, 60, |i| format!("{i},{}", -dmt(i))),
            "the tension grows as the surfaces close",
        ),
        (
            "WrongWay",
            rows(head, 60, |i| format!("{i},{}", -dmt(59 - i))),
            "approach and force are both reversed",
        ),
    ];
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("curve.csv");
    for (variant, text, expected) in &cases {
        fs::write(&path, text).expect("written");
        let result = ForceCurve::read(&path)
            .and_then(|curve| fit_curve(&curve, &path, 1e-6, FREE).map(|_| ()));
        let error = result.expect_err(variant);
        let message = error.to_string();
        assert!(message.contains(expected), "{variant}: {message}");
        assert!(message.contains("curve.csv"), "{variant}: {message}");
        reach(variant, &error);
    }
    // Columns of an instrument.
    let raw = |row: &str| rows("Z [um],Defl [V],F [nN]", 20, |_| row.to_owned());
    for (variant, choices, text, expected) in [
        (
            "NoChosenColumn",
            "position=height,deflection=Defl",
            raw("1,2,3"),
            "line 1: no column \"height\" for the position among \"Z [um], Defl [V], F [nN]\"; choose one of these",
        ),
        (
            "NoChosenColumn",
            "position=4,deflection=Defl",
            raw("1,2,3"),
            "no column \"4\" for the position",
        ),
        (
            "NoSensitivity",
            "position=Z,deflection=Defl",
            raw("1,2,3"),
            "the deflection is in volts; give its sensitivity",
        ),
        (
            "TwoChoices",
            "position=Z,deflection=Defl,force=F",
            raw("1,2,3"),
            "columns are chosen for deflection and for force, of which a curve has one; choose one of the two",
        ),
        (
            "TwoChoices",
            "approach=Z,force=F,position=Defl",
            raw("1,2,3"),
            "for approach and for position",
        ),
        (
            "NoSpring",
            "position=Z,force=F",
            raw("1,2,3"),
            "the position needs the spring constant",
        ),
        (
            "NoSpring",
            "approach=Z,deflection=Defl [nm]",
            raw("1,2,3"),
            "the deflection needs the spring constant",
        ),
    ] {
        fs::write(&path, text).expect("written");
        let mut columns = CurveColumns::default();
        let choices = choices.split(',').map(ColumnChoice::parse);
        columns.choices = choices.collect::<Result<_, _>>().expect("choices");
        let error = ForceCurve::read_columns(&path, &columns).expect_err(variant);
        let message = error.to_string();
        assert!(message.contains(expected), "{variant}: {message}");
        reach(variant, &error);
    }
    for text in ["position", "height=Z", "position=", "position=-"] {
        let said = ColumnChoice::parse(text).expect_err(text);
        assert!(said.contains("QUANTITY=COLUMN"), "{text}: {said}");
    }
    // Four points apart do not tell a slope.
    let few = rows(head, 12, |i| {
        let approach = i as f64 - 4.0;
        format!("{approach}e-9,{:e}", 1e-9 * approach.max(0.0).powf(1.5))
    });
    fs::write(&path, few).expect("written");
    let curve = ForceCurve::read(&path).expect("a curve");
    let known = Freedom {
        approach_offset: false,
        ..FREE
    };
    let error = fit_with_slope(&curve, &path, 1e-6, known).expect_err("no baseline");
    assert!(
        error.to_string().contains("too few for the slope"),
        "{error}"
    );
    reach("NoBaseline", &error);
    for bytes in [&b"approach,force\n1,\xff\n"[..], b"approach,force\n1,2\0\n"] {
        fs::write(&path, bytes).expect("written");
        let error = ForceCurve::read(&path).expect_err("no text");
        assert!(matches!(error, FitError::NotText { .. }), "{error}");
        reach("NotText", &error);
    }
    let error = ForceCurve::read(&folder.path().join("none.csv")).expect_err("no file");
    assert!(matches!(error, FitError::Unreadable { .. }), "{error}");
    reach("Unreadable", &error);
    // A file of that size in name only: its bytes are never written.
    let file = fs::File::create(&path).expect("created");
    file.set_len((256 << 20) + 1).expect("sparse");
    let error = ForceCurve::read(&path).expect_err("too large");
    assert!(error.to_string().contains("268435457 bytes"), "{error}");
    reach("TooLarge", &error);
    fs::write(&path, rows(head, 20, good)).expect("written");
    let curve = ForceCurve::read(&path).expect("a curve");
    // Without time, and without a loading in contact.
    let pressed = |touch: usize, times: Vec<f64>| {
        let sample = |i: usize| Sample {
            approach: i as f64 * 1e-9,
            force: (i.saturating_sub(touch) as f64).powf(1.5) * 1e-9,
        };
        let samples = (0..40).map(sample).collect();
        ForceCurve {
            samples,
            times,
            ..ForceCurve::default()
        }
    };
    let seconds = || (0..40).map(|i| i as f64);
    for (variant, curve, expected) in [
        (
            "NoTime",
            pressed(10, Vec::new()),
            "needs the time of each row, increasing",
        ),
        (
            "NoTime",
            pressed(10, seconds().rev().collect()),
            "name its column `time` (s)",
        ),
        (
            "NoLoading",
            pressed(35, seconds().collect()),
            "points of loading in contact, too few",
        ),
    ] {
        let result = fit_curve(&curve, &path, 1e-6, FREE).expect("a fit");
        let error = fit_relaxation(&curve, &path, &result).expect_err(variant);
        assert!(error.to_string().contains(expected), "{variant}: {error}");
        reach(variant, &error);
    }

    let in_hours = rows("time [h],approach,force", 40, |i| {
        let force = (i.saturating_sub(10) as f64).powf(1.5);
        format!("{i},{i}e-9,{force:e}")
    });
    fs::write(&path, in_hours).expect("written");
    let hours = ForceCurve::read(&path).expect("a curve");
    let result = fit_curve(&hours, &path, 1e-6, FREE).expect("a fit");
    let error = fit_relaxation(&hours, &path, &result).expect_err("hours");
    let expected = "line 1, column `time`: \"h\" is not a unit that is known here";
    assert!(error.to_string().contains(expected), "{error}");
    reach("UnreadTime", &error);

    let error = fit_curve(&curve, &path, -1.0, FREE).expect_err("no radius");
    assert!(matches!(error, FitError::Theory(_)), "{error}");
    reach("Theory", &error);
    let error = ForceCurve::read(folder.path()).expect_err("a folder");
    assert!(
        error.to_string().contains(
            "is not a regular file (but a folder, a pipe or a device); save the curve to a file"
        ),
        "{error}"
    );
    reach("NotRegular", &error);
    // Forces so large that no modulus is a number; no file may hold them.
    let absurd = |i: usize| Sample {
        approach: i as f64 * 1e-300,
        force: (i as f64 - 5.0) * 1e300,
    };
    let curve = ForceCurve {
        samples: (0..20).map(absurd).collect(),
        ..ForceCurve::default()
    };
    let error = fit_curve(&curve, &path, 1e-6, FREE).expect_err("no fit");
    assert!(matches!(error, FitError::NoFit { .. }), "{error}");
    reach("NoFit", &error);
    reached
}
