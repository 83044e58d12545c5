//! Compares widths of the Maugis-Dugdale taper: the table of `docs/solver.md`.
//!
//! `cargo run --release --example taper_study` solves waves whose contact edges lie along, across
//! and oblique to the grid, spheres, a rough surface and smoother ones with tapers of 2 to 8 `sigma0 dx/E*` (no
//! wider than twice the range, or, for comparison, than the range), compares them with closed
//! forms, and prints the table: some minutes on two cores, a case on each. With names behind `--`
//! (`strip`, `sphere`, `rough`, `smooth`) it prints only those parts.

mod rough;
mod run;
mod smooth;
mod spheres;
mod strips;

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

use run::Failure;

/// A taper.
#[derive(Clone, Copy, Debug)]
pub struct Taper {
    /// In `sigma0 dx/E*`.
    pub width: f64,
    /// Over the range, at most.
    pub cap: f64,
}

impl Taper {
    /// The length, m.
    pub fn length(self, peak: f64, pixel: f64, modulus: f64, range: f64) -> f64 {
        (self.width * peak * pixel / modulus).min(self.cap * range)
    }
}

/// The columns.
const TAPERS: [Taper; 6] = [
    wide(2.0, 2.0),
    wide(3.0, 2.0),
    wide(4.0, 2.0),
    wide(6.0, 2.0),
    wide(8.0, 2.0),
    wide(8.0, 1.0),
];

const fn wide(width: f64, cap: f64) -> Taper {
    Taper { width, cap }
}

/// Computes a cell of the table.
type Job = Box<dyn Fn() -> Result<String, Failure> + Send + Sync>;

/// Rows of one kind.
pub struct Part {
    /// Its name on the command line.
    pub name: &'static str,
    /// Legend of the numbers in a cell.
    pub legend: &'static str,
    /// Name, chi, and the job of each taper.
    pub rows: Vec<(String, f64, Vec<Job>)>,
}

fn main() -> Result<(), Failure> {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let parts: Vec<Part> = [
        rough::part()?,
        smooth::part(),
        strips::part(),
        spheres::part(),
    ]
    .into_iter()
    .filter(|part| asked.is_empty() || asked.iter().any(|word| word == part.name))
    .collect();
    let jobs: Vec<&Job> = parts
        .iter()
        .flat_map(|part| part.rows.iter().flat_map(|(_, _, jobs)| jobs))
        .collect();
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    let cores = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..cores {
            let (sender, next, jobs) = (sender.clone(), &next, &jobs);
            scope.spawn(move || {
                while let Some(job) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let at = jobs.iter().position(|other| std::ptr::eq(*other, *job));
                    // The receiver lives as long as the scope.
                    let _ = sender.send((at, job()));
                }
            });
        }
    });
    drop(sender);
    let mut cells = vec![String::new(); jobs.len()];
    for (at, cell) in receiver {
        if let Some(at) = at {
            cells[at] = cell?;
        }
    }
    let mut cells = cells.into_iter();
    for part in &parts {
        println!("\n{}\n", part.legend);
        let widths = TAPERS.map(|taper| match taper.cap {
            cap if cap < 2.0 => format!("{}, at most h0", taper.width),
            _ => format!("{}", taper.width),
        });
        println!("| {} | chi | {} |", part.name, widths.join(" | "));
        println!("|---|---|{}", "---|".repeat(TAPERS.len()));
        for (name, chi, jobs) in &part.rows {
            let line: Vec<String> = cells.by_ref().take(jobs.len()).collect();
            println!("| {name} | {chi:.2} | {} |", line.join(" | "));
        }
    }
    Ok(())
}
