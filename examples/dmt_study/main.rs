//! The DMT study of rough contacts: full field, interacting asperities, Persson, GW-M.
//!
//! `cargo run --release --example dmt_study [LARGEST [LARGEST_ICHA]]` runs the surfaces of Hurst exponent
//! 0.4, 0.6, 0.8 and N = 16, 32, 64 (up to LARGEST, default 64) with three seeds each, writes
//! `docs/dmt_study.csv` row by row, then the pictures `docs/pictures/dmt_study_*.png` and a table of misses
//! on standard output. Interacting asperities, which take by far the longest, are left out beyond N of
//! LARGEST_ICHA. `dmt_study draw` only draws from the table that is there.

mod figures;
mod rows;

use std::error::Error;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use rows::{Case, Row, Sample};

const TABLE: &str = "docs/dmt_study.csv";

fn commit() -> String {
    let output = Command::new("git")
        .args(["rev-parse", "--short", "HEAD"])
        .output();
    match output {
        Ok(output) if output.status.success() => {
            String::from_utf8_lossy(&output.stdout).trim().to_owned()
        }
        _ => "unknown".to_owned(),
    }
}

fn run(largest: usize, largest_icha: usize) -> Result<(), Box<dyn Error>> {
    let mut file = OpenOptions::new()
        .create(true)
        .write(true)
        .truncate(true)
        .open(TABLE)?;
    let command = format!("cargo run --release --example dmt_study {largest} {largest_icha}");
    writeln!(file, "# {command} (commit {})", commit())?;
    writeln!(
        file,
        "# pressures in E* h', mean gap in rms heights; seed 0: the model does not know it"
    )?;
    writeln!(file, "{}", rows::HEADER)?;
    let mut keep = |rows: &[Row]| -> std::io::Result<()> {
        file.write_all(rows::lines(rows).as_bytes())?;
        file.flush()
    };
    for ratio in [16, 32, 64].into_iter().filter(|ratio| *ratio <= largest) {
        for hurst in [0.8, 0.6, 0.4] {
            keep(&rows::theory_rows(hurst, ratio)?)?;
            for seed in 1..=3 {
                let case = Case { hurst, ratio, seed };
                let clock = Instant::now();
                let sample = Sample::new(case)?;
                keep(&rows::field_rows(case, &sample)?)?;
                let field = clock.elapsed().as_secs_f64();
                if ratio > largest_icha {
                    eprintln!("{case:?}: field {field:.1} s");
                    continue;
                }
                match rows::icha_rows(case, &sample) {
                    Ok(rows) => keep(&rows)?,
                    Err(error) => eprintln!("{case:?}: no ICHA: {error}"),
                }
                let both = clock.elapsed().as_secs_f64();
                eprintln!("{case:?}: field {field:.1} s, ICHA {:.1} s", both - field);
            }
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let argument = std::env::args().nth(1);
    match argument.as_deref() {
        Some("draw") => {}
        Some(largest) => {
            let largest = largest.parse()?;
            let icha = std::env::args()
                .nth(2)
                .map_or(Ok(largest), |text| text.parse())?;
            run(largest, icha)?;
        }
        None => run(64, 64)?,
    }
    let table = rows::read(&std::fs::read_to_string(TABLE)?)?;
    print!("{}", figures::misses(&table));
    figures::draw(&table, Path::new("docs/pictures"))
}
