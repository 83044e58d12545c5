//! The DMT study of rough contacts: full field, interacting asperities, Persson, GW-M.
//!
//! `cargo run --release --example dmt_study [LARGEST]` runs the surfaces of Hurst exponent 0.4, 0.6, 0.8 and
//! N = 16, 32, 64 (up to LARGEST, default 64) with three seeds each, writes `docs/dmt_study.csv` row by row,
//! then the pictures `docs/pictures/dmt_study_*.png` and the docs' two tables, of misses and of claims, on standard output.
//! `dmt_study asperities` recomputes the rows of the interacting asperities and keeps the others, `dmt_study theories` those of Persson and
//! GW-M,
//! `dmt_study missing` computes only missing ones of them, `dmt_study draw` only draws the table,
//! `dmt_study boxes` solves wider boxes.

mod claims;
mod figures;
mod rows;
mod sphere_claims;

use std::error::Error;
use std::fs::File;
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

fn run(largest: usize) -> Result<(), Box<dyn Error>> {
    let head = format!(
        "# cargo run --release --example dmt_study {largest} (commit {})",
        commit()
    );
    let mut file = begin(&[head.as_str(), UNITS])?;
    for ratio in [16, 32, 64].into_iter().filter(|ratio| *ratio <= largest) {
        for hurst in [0.8, 0.6, 0.4] {
            keep(&mut file, &rows::theory_rows(hurst, ratio)?)?;
            for seed in 1..=3 {
                let case = Case { hurst, ratio, seed };
                let clock = Instant::now();
                let sample = Sample::new(case)?;
                keep(&mut file, &rows::field_rows(case, &sample)?)?;
                let field = clock.elapsed().as_secs_f64();
                keep(&mut file, &rows::icha_rows(case, &sample)?)?;
                let both = clock.elapsed().as_secs_f64();
                eprintln!("{case:?}: field {field:.1} s, ICHA {:.1} s", both - field);
            }
        }
    }
    Ok(())
}

/// Recomputes the rows of asperities after those of the field of the same surface and keeps all
/// others. With `missing` existing rows of asperities stay too.
fn run_asperities(missing: bool) -> Result<(), Box<dyn Error>> {
    let text = std::fs::read_to_string(TABLE)?;
    let kept: Vec<Row> = rows::read(&text)?
        .into_iter()
        .filter(|row| missing || !is_of_asperities(row))
        .collect();
    let mut file = begin_again(&text, "icha rows", "asperities")?;
    for group in kept.chunk_by(|one, next| one.case == next.case) {
        keep(&mut file, group)?;
        let case = group[0].case;
        if case.seed > 0 && !group.iter().any(is_of_asperities) {
            let clock = Instant::now();
            keep(&mut file, &rows::icha_rows(case, &Sample::new(case)?)?)?;
            eprintln!("{case:?}: {:.1} s", clock.elapsed().as_secs_f64());
        }
    }
    Ok(())
}

/// Recomputes the rows of the theories and keeps all others.
fn run_theories() -> Result<(), Box<dyn Error>> {
    let text = std::fs::read_to_string(TABLE)?;
    let rows = rows::read(&text)?;
    let mut file = begin_again(&text, "persson and gw-m rows", "theories")?;
    for group in rows.chunk_by(|one, next| one.case == next.case) {
        let Case { hurst, ratio, seed } = group[0].case;
        match seed {
            0 => keep(&mut file, &rows::theory_rows(hurst, ratio)?)?,
            _ => keep(&mut file, group)?,
        }
    }
    Ok(())
}

/// Pull-off of the field in boxes of single and double width, H = 0.4 and N = 16, as a table on
/// standard output, and Persson's with the waves that fit the box and with those of an infinite
/// plane.
fn run_boxes() -> Result<(), Box<dyn Error>> {
    println!("| box | seed | pull-off eps/w |\n|---|---|---|");
    let (hurst, ratio) = (0.4, 16);
    for times in [1, 2] {
        for seed in 1..=3 {
            let case = Case { hurst, ratio, seed };
            let sample = Sample::in_box(case, times)?;
            let found = rows::field_rows(case, &sample)?;
            let tension = rows::pull_off(&found.iter().collect::<Vec<_>>());
            let share = tension * sample.unit * rows::RANGE / rows::WORK;
            println!("| {times} | {seed} | {share:.4} |");
        }
    }
    // Waves on a lattice of spacing q represent all from q/sqrt(pi) on.
    for smallest in [1.0, 1.0 / std::f64::consts::PI.sqrt()] {
        let share = rows::persson_from(smallest * rows::SMALLEST, hurst, ratio)?
            .pull_off(&rows::ADHESION)?
            .tension
            * rows::RANGE
            / rows::WORK;
        println!("| Persson from {smallest:.3} qL | | {share:.4} |");
    }
    Ok(())
}

fn is_of_asperities(row: &Row) -> bool {
    rows::ICHA.iter().any(|(model, _)| *model == row.model)
}

const UNITS: &str =
    "# pressures in E* h', mean gap in rms heights; seed 0: the model does not know it";

fn begin(head: &[&str]) -> std::io::Result<File> {
    let mut file = File::create(TABLE)?;
    for line in head {
        writeln!(file, "{line}")?;
    }
    writeln!(file, "{}", rows::HEADER)?;
    Ok(file)
}

/// Begins the table `text` anew, of which the command `dmt_study argument` computes these `rows`.
fn begin_again(text: &str, rows: &str, argument: &str) -> std::io::Result<File> {
    let own = format!("# {rows}: ");
    let heads = text.lines().take_while(|line| line.starts_with('#'));
    let mut heads: Vec<&str> = heads
        .filter(|line| *line != UNITS && !line.starts_with(&own))
        .collect();
    let command = format!(
        "{own}cargo run --release --example dmt_study {argument} (commit {})",
        commit()
    );
    heads.extend([command.as_str(), UNITS]);
    begin(&heads)
}

fn keep(file: &mut File, rows: &[Row]) -> std::io::Result<()> {
    file.write_all(rows::lines(rows).as_bytes())?;
    file.flush()
}

fn main() -> Result<(), Box<dyn Error>> {
    let argument = std::env::args().nth(1);
    match argument.as_deref() {
        Some("draw") => {}
        Some("theories") => run_theories()?,
        Some("boxes") => return run_boxes(),
        Some("asperities") => run_asperities(false)?,
        Some("missing") => run_asperities(true)?,
        Some(largest) => run(largest.parse()?)?,
        None => run(64)?,
    }
    let table = rows::read(&std::fs::read_to_string(TABLE)?)?;
    println!("{}", figures::misses(&table));
    println!("{}", claims::text(&claims::claims(&table)?));
    figures::draw(&table, Path::new("docs/pictures"))
}
