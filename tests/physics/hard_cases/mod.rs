//! The hard cases: each converges to the right answer within its bound, or says that it did not.
//!
//! Every case runs on every path of the processor that the build has; on the graphics processor every eighth one, in
//! mixed and single precision in turn, and every fourth of those with stretched numbers in double (with `TABOR_LONG=1` all in each). What comes out is asked of
//! the files: an equilibrium, in double precision, by transforms and laws of the test's own; a closed form where
//! there is one; and the numbers of the processor in double precision for the other paths. The table
//! in docs/hard_cases.md is written by this test (`TABOR_HARD_CASES=write`) and compared by it;
//! `TABOR_HARD_CASES_ONLY=word` tries the cases with that word in their name.

mod case;
mod cores;
pub mod extremes;
mod flats;
mod grids;
mod jumps;
mod paths;
mod run;
mod spheres;
mod table;
mod truth;
mod units;
mod walls;

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use case::Case;
use paths::{PATHS, Path};
use run::Run;
use table::Entry;
use truth::Fields;

use crate::shared::device::device;
use crate::shared::trials::tests;

/// Runs at a time: each takes one thread.
const WORKERS: usize = 2;

fn outcome(case: &Case, run: &Run) -> String {
    // What pixels decide is no more than an equilibrium of theirs, and is warned of.
    let right = match case.compared {
        true => "right",
        false => "equilibrium on its grid, with a warning",
    };
    match run.status {
        2 => "refused, with a remedy".to_owned(),
        3 => format!("not converged in step {}, reported", run.rows.len()),
        _ => {
            let warned = run.messages.contains(": a pixel is");
            assert!(case.compared || warned, "{}: {}", case.name, run.messages);
            let states = run.states();
            let apart = states.iter().filter(|state| **state == "separated").count();
            match apart {
                0 => right.to_owned(),
                _ if apart == states.len() => format!("{right}: separated"),
                _ => format!("{right}: separated in {apart} of {} steps", states.len()),
            }
        }
    }
}

/// Runs a case on all paths and checks what comes of it.
fn try_case(case: &Case, place: usize, paths: &[&'static Path]) -> Vec<Entry> {
    let judge = run::run(case, paths[0]);
    let mut entries = Vec::new();
    let mut heights: Vec<Option<Vec<f64>>> = Vec::new();
    for step in 1..=judge.rows.len() {
        heights.push(judge.field(step, "heights"));
    }
    let heights = heights.into_iter().flatten().next();
    for path in paths.iter().filter(|path| path.tries(&case.name, place)) {
        let other;
        let run = if path.name == paths[0].name {
            &judge
        } else {
            other = run::run(case, path);
            &other
        };
        for (index, row) in run.rows.iter().enumerate() {
            let what = format!("{} on {}, step {}", case.name, path.name, index + 1);
            let Some(fields) = Fields::at_step(run, index + 1) else {
                continue;
            };
            if !row.converged {
                continue;
            }
            let heights = heights.as_ref().expect("the judge wrote heights");
            truth::check(case, path, row, &fields, heights, &what);
            if let Some(judged) = judge
                .rows
                .get(index)
                .filter(|_| run.status == 0 && case.compared)
            {
                assert_eq!(row.state, judged.state, "{what}");
                let judge_fields = Fields::at_step(&judge, index + 1).expect("the judge's fields");
                truth::compare(case, path, [row, judged], [&fields, &judge_fields], &what);
            }
        }
        if let (0, Some(truth)) = (run.status, &case.truth) {
            println!("{} on {}", case.name, path.name);
            truth(run, path);
        }
        entries.push(Entry {
            case: case.name.clone(),
            path: path.name.to_owned(),
            outcome: outcome(case, run),
            iterations: run.rows.iter().map(|row| row.iterations).sum(),
        });
    }
    entries
}

fn every_case_is_right_or_says_that_it_is_not() {
    let only = std::env::var("TABOR_HARD_CASES_ONLY").ok();
    let some_only = only.is_some();
    let mut cases = walls::cases();
    cases.extend(spheres::cases());
    cases.extend(jumps::cases());
    cases.extend(cores::cases());
    cases.extend(flats::cases());
    cases.extend(grids::cases());
    cases.extend(units::cases());
    if let Some(only) = only {
        cases.retain(|case| case.name.contains(&only));
    }
    let paths: Vec<&'static Path> = PATHS
        .iter()
        .filter(|path| path.is_built() && path.is_here())
        .collect();
    let next = AtomicUsize::new(0);
    let failures = Mutex::new(Vec::new());
    let results: Mutex<Vec<(usize, Vec<Entry>)>> = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..WORKERS {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(case) = cases.get(index) else { break };
                    let tried = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
                        try_case(case, index, &paths)
                    }));
                    match tried {
                        Ok(entries) => results.lock().expect("whole").push((index, entries)),
                        Err(_) => failures.lock().expect("whole").push(case.name.clone()),
                    }
                }
            });
        }
    });
    let failures = failures.into_inner().expect("whole");
    assert!(failures.is_empty(), "{failures:#?}");
    let mut results = results.into_inner().expect("whole");
    results.sort_by_key(|(index, _)| *index);
    let entries: Vec<Entry> = results
        .into_iter()
        .flat_map(|(_, entries)| entries)
        .collect();
    for entry in &entries {
        println!("{}", entry.line());
    }
    if !some_only {
        let waits = |name: &str, path: &Path| {
            let place = cases.iter().position(|case| case.name == name);
            place.is_some_and(|place| !path.tries(name, place))
        };
        table::keep(&entries, &paths, waits);
    }
}

/// Without an adapter the cases are tried on the processor alone, and this test says so.
fn a_graphics_processor_tries_them_too() {
    device();
    assert!(
        PATHS
            .iter()
            .any(|path| path.backend == "gpu" && path.is_built() && path.is_here())
    );
}

/// A bound that nothing misses would show nothing: gaps that are off by a thousandth, and forces, are seen.
fn a_wrong_answer_is_seen() {
    let named = |cases: Vec<Case>, name: &str| {
        cases
            .into_iter()
            .find(|case| case.name == name)
            .expect("a case")
    };
    let wall = named(walls::cases(), "rough, 95 % contact");
    let sphere = named(spheres::cases(), "sphere, Tabor number 1");
    for case in [wall, sphere] {
        let path = &PATHS[0];
        let run = run::run(&case, path);
        let heights = run.field(1, "heights").expect("heights");
        let seen = |change: &dyn Fn(&mut run::Row, &mut Fields)| {
            let (mut row, mut fields) = (
                run.rows[0].clone(),
                Fields::at_step(&run, 1).expect("fields"),
            );
            change(&mut row, &mut fields);
            let tried = std::panic::AssertUnwindSafe(|| {
                truth::check(&case, path, &row, &fields, &heights, "changed");
            });
            std::panic::catch_unwind(tried).is_err()
        };
        assert!(!seen(&|_, _| {}));
        assert!(seen(&|_, fields| fields
            .gap
            .iter_mut()
            .for_each(|gap| *gap *= 1.001)));
        assert!(seen(&|_, fields| fields
            .pressure
            .iter_mut()
            .for_each(|p| *p *= 1.001)));
        assert!(seen(&|row, _| row.contact += 1e-4));
        assert!(seen(&|row, _| {
            row.mean_pressure += 1e-3;
            row.force += 1e-3;
        }));
    }
}

tests![
    every_case_is_right_or_says_that_it_is_not,
    a_graphics_processor_tries_them_too,
    a_wrong_answer_is_seen,
];
