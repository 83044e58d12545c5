//! `tabor sweep`: a study of many runs.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use indicatif::ProgressBar;

use super::interrupts::Interrupts;
use super::progress::{bar, time};
use super::{Failure, folder_or_default, key_and_value, print, say, warn};
use crate::sweep::{Jobs, Listener, Outcome, Share, Study, SweepFolder, command, solve};

/// Most failures that are told one by one.
const TOLD: usize = 10;

#[derive(Debug, Args)]
pub(super) struct SweepArguments {
    /// The study, a TOML file: a scene and its axes
    #[arg(value_name = "STUDY")]
    path: PathBuf,
    /// Folder for the tables and pictures [default: the study's name]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Cases at a time [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Threads of each case [default: an equal share of the cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Solve share i of n alone, as one of n processes, in one folder or in several; --merge joins them
    #[arg(long, value_name = "i/n")]
    only: Option<Share>,
    /// Print one command for each case, and solve nothing
    #[arg(long, conflicts_with_all = ["only", "merge", "jobs"])]
    list: bool,
    /// Solve nothing: join what is finished, here and in these folders, into the tables and the picture
    #[arg(long, value_name = "DIR", num_args = 0.., conflicts_with = "only")]
    merge: Option<Vec<PathBuf>>,
    /// No progress; warnings and errors are still said
    #[arg(long)]
    quiet: bool,
    /// Override a key of the scene, as in grid.points=128; may be repeated
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_and_value, display_order = 900)]
    set: Vec<(String, String)>,
}

/// Solves the cases of a study and writes its tables.
pub(super) fn sweep(arguments: &SweepArguments) -> Result<(), Failure> {
    let study = Study::read(&arguments.path, &arguments.set)?;
    let path = folder_or_default(arguments.out.as_deref(), &arguments.path, "");
    if arguments.list {
        let set = &arguments.set;
        let threads = arguments.threads;
        let threads = threads.map_or(String::new(), |count| format!(" --threads {count}"));
        let lines = study.cases().map(|case| {
            let command = command(&arguments.path, &path, &case, study.count(), set);
            format!("{command}{threads}\n")
        });
        return print(&lines.collect::<String>());
    }
    let interrupts = Interrupts::watch();
    let mut folder = SweepFolder::open(&path, &study, arguments.only)?;
    if let Some(warning) = folder.warning() {
        warn(warning);
    }
    let mut interrupted = false;
    if let Some(others) = &arguments.merge {
        for other in others {
            folder.merge(other, &study)?;
        }
    } else {
        interrupts.keep(format!(
            "note: finished cases are kept in {}; the same command continues with the others",
            path.display()
        ));
        let number = |given: Option<u16>| given.map(usize::from);
        let jobs = Jobs::new(number(arguments.jobs), number(arguments.threads));
        let mut progress = Progress {
            quiet: arguments.quiet,
            bar: None,
            begun: Instant::now(),
            ended: 0,
            cases: 0,
            interrupts,
        };
        let is_own = |case: usize| arguments.only.is_none_or(|share| share.has(case));
        if let Some(warning) = folder.without_folder(&study, is_own) {
            warn(&warning);
        }
        interrupted = solve(&study, &mut folder, arguments.only, jobs, &mut progress)?;
    }
    // Shares run side by side: --merge joins them.
    if arguments.only.is_none()
        && let Some(warning) = folder.write_tables(&study)?
    {
        warn(&warning);
    }
    report(arguments, &study, &folder, interrupted)
}

/// What came of the study, in words and as the exit status.
fn report(
    arguments: &SweepArguments,
    study: &Study,
    folder: &SweepFolder,
    interrupted: bool,
) -> Result<(), Failure> {
    let is_own = |number: usize| arguments.only.is_none_or(|share| share.has(number));
    let cases = (1..=study.count()).filter(|number| is_own(*number)).count();
    let ended = || folder.outcomes().filter(|it| is_own(it.number));
    let failed: Vec<&Outcome> = ended().filter(|it| !it.is_finished()).collect();
    let finished = ended().count() - failed.len();
    let table = match arguments.only {
        None => folder.path().join("runs.csv"),
        Some(_) => folder.path().to_path_buf(),
    };
    for outcome in failed.iter().take(TOLD) {
        warn(&format!("case {}: {}", outcome.number, outcome.message));
    }
    if failed.len() > TOLD {
        let more = failed.len() - TOLD;
        warn(&format!("{more} more cases did not end well"));
    }
    if interrupted {
        return Err(Failure::InterruptedSweep {
            finished,
            cases,
            folder: folder.path().to_path_buf(),
        });
    }
    let doubtful = ended().filter(|it| it.is_finished() && !it.message.is_empty());
    let doubtful = doubtful.count();
    if doubtful > 0 {
        warn(&format!(
            "finished cases with warnings: {doubtful}; see the column message of runs.csv"
        ));
    }
    if !arguments.quiet {
        let place = match arguments.only {
            None => format!("the tables are {} and sweep.csv", table.display()),
            Some(share) => format!(
                "those of share {share} are kept in {}, and --merge joins all",
                folder.path().display()
            ),
        };
        say(&format!("{finished} of {cases} cases solved; {place}"));
    }
    if failed.is_empty() {
        Ok(())
    } else {
        Err(Failure::FailedCases {
            failed: failed.len(),
            cases,
            table,
        })
    }
}

/// Shows how far the study is.
struct Progress {
    quiet: bool,
    bar: Option<ProgressBar>,
    begun: Instant,
    ended: usize,
    cases: usize,
    interrupts: Interrupts,
}

impl Listener for Progress {
    fn begins(&mut self, cases: usize, finished: usize) {
        self.cases = cases;
        if finished > 0 && !self.quiet {
            say(&format!(
                "{finished} cases are finished already; {cases} are left"
            ));
        }
        self.bar = bar(
            "{bar:24} case {pos}/{len}  {wide_msg}",
            cases as u64,
            self.quiet,
        );
    }

    fn ended(&mut self, _outcome: &Outcome) {
        self.ended += 1;
        if let Some(bar) = &self.bar {
            let left = (self.cases - self.ended) as f64;
            let estimate = self.begun.elapsed().as_secs_f64() / self.ended as f64 * left;
            bar.set_position(self.ended as u64);
            bar.set_message(format!("about {} left", time(estimate)));
        }
    }

    fn continues(&mut self) -> bool {
        !self.interrupts.raised()
    }
}

impl Drop for Progress {
    /// Removes the bar, so that a message starts on a line of its own.
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
