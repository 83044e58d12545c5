//! The studies of `docs/accuracy.md`: a sphere, a rough surface, and one that sticks strongly.
//!
//! `cargo run --release --example accuracy_study` runs `tabor accuracy` on the three scenes beside this
//! file, in about seven minutes on two cores, and writes their tables (`docs/accuracy_NAME.csv`), their
//! pictures (`docs/pictures/accuracy_NAME.png`) and the parts of the page between `<!-- NAME -->` and
//! `<!-- /NAME -->`. With names behind `--` it runs only those.

mod tables;

use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use tables::STUDIES;

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let names: Vec<String> = std::env::args().skip(1).collect();
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    for study in STUDIES {
        if !names.is_empty() && !names.iter().any(|name| name == study.name) {
            continue;
        }
        let out = std::env::temp_dir().join(format!("tabor_accuracy_{}", study.name));
        let scene = root.join(format!("examples/accuracy_study/{}.toml", study.name));
        eprintln!("{}: at most {}", study.name, study.budget);
        let ended = Command::new(&cargo)
            .current_dir(root)
            .args([
                "run",
                "--release",
                "--quiet",
                "--bin",
                "tabor",
                "--",
                "accuracy",
            ])
            .arg(&scene)
            .args(["--budget", study.budget, "--out"])
            .arg(&out)
            .stderr(Stdio::piped())
            .output()?;
        let said = String::from_utf8_lossy(&ended.stderr).into_owned();
        eprint!("{said}");
        if !ended.status.success() {
            return Err(format!("{}: {}", study.name, ended.status).into());
        }
        let table = fs::read_to_string(out.join("accuracy.csv"))?;
        fs::write(
            root.join(format!("docs/accuracy_{}.csv", study.name)),
            &table,
        )?;
        let picture = root.join(format!("docs/pictures/accuracy_{}.png", study.name));
        fs::copy(out.join("accuracy.png"), picture)?;
        let page = root.join("docs/accuracy.md");
        let text = fs::read_to_string(&page)?;
        let part = format!("{}\n{}", tables::tables(&table)?, tables::named(&said)?);
        fs::write(&page, tables::replaced(&text, study.name, &part)?)?;
    }
    Ok(())
}
