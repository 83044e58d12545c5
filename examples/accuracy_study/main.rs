//! The studies of `docs/accuracy.md`: a sphere, a rough surface, a strongly adhesive one, and one
//! that creeps.
//!
//! `cargo run --release --example accuracy_study` runs `tabor accuracy` on the four scenes beside this
//! file, in about eight minutes on two cores, and writes their tables (`docs/accuracy_NAME.csv`), their
//! pictures (`docs/pictures/accuracy_NAME.png`) and the parts of the page between `<!-- NAME -->` and
//! `<!-- /NAME -->`. With names behind `--` it runs only those.

mod tables;

use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use tables::STUDIES;

/// How long each study may take.
const BUDGETS: [&str; 4] = ["150 s", "90 s", "180 s", "60 s"];

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let names: Vec<String> = std::env::args().skip(1).collect();
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    for (name, budget) in STUDIES.into_iter().zip(BUDGETS) {
        if !names.is_empty() && !names.iter().any(|asked| asked == name) {
            continue;
        }
        let out = std::env::temp_dir().join(format!("tabor_accuracy_{}", name));
        let scene = root.join(format!("examples/accuracy_study/{}.toml", name));
        eprintln!("{}: at most {}", name, budget);
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
            .args(["--budget", budget, "--out"])
            .arg(&out)
            .stderr(Stdio::piped())
            .output()?;
        let said = String::from_utf8_lossy(&ended.stderr).into_owned();
        eprint!("{said}");
        if !ended.status.success() {
            return Err(format!("{}: {}", name, ended.status).into());
        }
        let table = fs::read_to_string(out.join("accuracy.csv"))?;
        fs::write(root.join(format!("docs/accuracy_{}.csv", name)), &table)?;
        let picture = root.join(format!("docs/pictures/accuracy_{}.png", name));
        fs::copy(out.join("accuracy.png"), picture)?;
        let page = root.join("docs/accuracy.md");
        let text = fs::read_to_string(&page)?;
        let part = format!("{}\n{}", tables::tables(&table)?, named(&said)?);
        fs::write(&page, replaced(&text, name, &part)?)?;
    }
    Ok(())
}

/// Summary of the command: the reference, the cheapest settings and the skipped ones.
fn named(said: &str) -> Result<String, String> {
    let reference = said.lines().find(|line| line.starts_with("reference: "));
    let reference = reference.ok_or("no reference is named")?;
    let mut text = format!("What the command names:\n\n```text\n{reference}\n");
    let from = said
        .lines()
        .skip_while(|line| !line.starts_with("cheapest for"));
    for line in from.filter(|line| !line.starts_with("order of")) {
        text.push_str(line);
        text.push('\n');
    }
    text.push_str("```\n");
    Ok(text)
}

/// The page with a study's part replaced.
fn replaced(page: &str, name: &str, part: &str) -> Result<String, String> {
    let (begin, end) = (format!("<!-- {name} -->\n"), format!("<!-- /{name} -->"));
    let missing = || format!("docs/accuracy.md has no {begin}");
    let (before, rest) = page.split_once(&begin).ok_or_else(missing)?;
    let (_, after) = rest.split_once(&end).ok_or_else(missing)?;
    Ok(format!("{before}{begin}\n{part}\n{end}{after}"))
}
