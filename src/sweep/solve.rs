//! Runs the cases of a study that are not finished, some at a time.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use super::cases::{Case, Share};
use super::error::SweepError;
use super::folder::{SweepFolder, case_folder};
use super::outcome::Outcome;
use super::study::Study;
use crate::backend::cpu::with_threads;
use crate::clock::Clock;
use crate::run::{RunError, RunObserver, RunOptions, RunStatus, run_with, solve_with};

/// How often the listener is asked whether to continue, and the longest that an ended case is not on the disk.
const LOOK: Duration = Duration::from_millis(100);

/// How cases run side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Jobs {
    /// Cases at a time.
    pub jobs: usize,
    /// Threads of each.
    pub threads: usize,
}

impl Jobs {
    /// So many cases at a time, or one for each core, each with so many threads, or an equal share of the cores.
    pub fn new(jobs: Option<usize>, threads: Option<usize>) -> Jobs {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let jobs = jobs.unwrap_or(match threads {
            None => cores,
            Some(threads) => (cores / threads).max(1),
        });
        Jobs {
            jobs,
            threads: threads.unwrap_or((cores / jobs).max(1)),
        }
    }
}

/// Is told which cases end, and may end the study.
pub trait Listener {
    /// So many cases are to be solved; others are finished already.
    fn begins(&mut self, _cases: usize, _finished: usize) {}
    /// A case ended.
    fn ended(&mut self, _outcome: &Outcome) {}
    /// Whether to continue; cases that run are left, and solved again by the next call.
    fn continues(&mut self) -> bool {
        true
    }
}

impl Listener for () {}

/// Ends a run where the study is ended.
struct Watcher<'a> {
    stop: &'a AtomicBool,
}

impl RunObserver for Watcher<'_> {
    fn iteration(&mut self, _step: usize, _iteration: usize, _residual: f64) -> bool {
        !self.stop.load(Ordering::Relaxed)
    }
}

/// Solves the cases of a share, or of all, that are not finished in the folder, and keeps each as it ends. Returns
/// whether the listener ended it before its last case.
///
/// # Errors
/// A folder that cannot be written; a case that fails is an outcome.
pub fn solve(
    study: &Study,
    folder: &mut SweepFolder,
    share: Option<Share>,
    jobs: Jobs,
    listener: &mut dyn Listener,
) -> Result<bool, SweepError> {
    let own = |case: &Case| share.is_none_or(|share| share.has(case.number));
    let all = study.cases().filter(own).count();
    let open: Vec<Case> = study
        .cases()
        .filter(|case| own(case) && !folder.has(case.number))
        .collect();
    listener.begins(open.len(), all - open.len());
    let (stop, next) = (AtomicBool::new(false), AtomicUsize::new(0));
    let path = folder.path().to_path_buf();
    let (mut failure, mut ended) = (None, 0);
    std::thread::scope(|scope| {
        let (sender, receiver) = channel();
        for _ in 0..jobs.jobs.clamp(1, open.len().max(1)) {
            let sender = sender.clone();
            let (stop, next, open, path) = (&stop, &next, &open, &path);
            scope.spawn(move || {
                let work = || {
                    while !stop.load(Ordering::Relaxed) {
                        let Some(case) = open.get(next.fetch_add(1, Ordering::Relaxed)) else {
                            break;
                        };
                        let Some(outcome) = solve_case(study, case, path, jobs.threads, stop)
                        else {
                            break;
                        };
                        if sender.send(outcome).is_err() {
                            break;
                        }
                    }
                };
                // One pool for all cases of this job; where the system has no threads left, that of all jobs.
                if with_threads(Some(jobs.threads), work).is_err() {
                    work();
                }
            });
        }
        drop(sender);
        let mut synced = Clock::start();
        loop {
            let received = receiver.recv_timeout(LOOK);
            let is_over = matches!(received, Err(RecvTimeoutError::Disconnected));
            let mut kept = Ok(());
            if let Ok(outcome) = received {
                listener.ended(&outcome);
                ended += 1;
                if failure.is_none() {
                    kept = folder.keep(outcome);
                }
            }
            // Waiting for the disk after each case would cost more than a short case itself.
            if kept.is_ok() && (is_over || synced.seconds() >= LOOK.as_secs_f64()) {
                kept = folder.sync();
                synced = Clock::start();
            }
            if let Err(error) = kept {
                stop.store(true, Ordering::Relaxed);
                failure.get_or_insert(error);
            }
            if is_over {
                break;
            }
            if !listener.continues() {
                stop.store(true, Ordering::Relaxed);
            }
        }
    });
    match failure {
        Some(error) => Err(error),
        None => Ok(ended < open.len()),
    }
}

/// The outcome of a case; `None` where it was ended.
fn solve_case(
    study: &Study,
    case: &Case,
    folder: &Path,
    threads: usize,
    stop: &AtomicBool,
) -> Option<Outcome> {
    let clock = Clock::start();
    let scene = match study.scene(case) {
        Ok(scene) => scene,
        Err(errors) => {
            return Some(Outcome::failed(
                case,
                None,
                study.mistakes(case, &errors),
                clock.seconds(),
            ));
        }
    };
    let mut watcher = Watcher { stop };
    let solved: Result<_, RunError> = if study.keeps(case) {
        let folder = case_folder(folder, case.number);
        let options = RunOptions::new().threads(threads);
        run_with(scene.clone(), &folder, &options, &mut watcher)
    } else {
        solve_with(scene.clone(), &RunOptions::new(), &mut watcher)
    };
    match solved {
        Ok(end) if matches!(end.status, RunStatus::Interrupted { .. }) => None,
        Ok(end) => Some(Outcome::ended(case, &scene, &end, clock.seconds())),
        Err(error) => Some(Outcome::failed(
            case,
            Some(&scene),
            error.to_string(),
            clock.seconds(),
        )),
    }
}
