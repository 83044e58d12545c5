//! A rank runs in a child process of the one that the launcher started. That one waits, says why a rank was killed, and
//! ends as the rank does: a launcher knows only that a signal ended a process, and has a status of its own for it.

use std::process::{Child, Command};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use rustix::process::{Pid, Signal, kill_process};

use super::Failure;
use super::interrupts::INTERRUPTED;
use super::launcher::{count_of_ranks, is_launched, rank_in_launch};

/// Tells the child whose child it is: the number of the process that waits for it.
const WAITING: &str = "TABOR_WAITING_PROCESS";
/// Has the allocator of glibc give back at once what it else keeps for later.
const TRIM: [&str; 2] = ["MALLOC_TRIM_THRESHOLD_", "131072"];

/// The end of the rank where this process is the one that waits for it; `None` where it is to run itself, as the rank or
/// without a launcher.
///
/// # Errors
/// A signal ended the rank that nobody sent to this process.
pub(super) fn wait(scene: &std::path::Path) -> Result<Option<u8>, Failure> {
    if !is_launched() || is_child() {
        return Ok(None);
    }
    // Where no child can be started, this process is the rank.
    let Some(mut child) = start() else {
        return Ok(None);
    };
    let asked = Arc::new(AtomicBool::new(false));
    pass_on_signals(&child, &asked);
    let Ok(status) = child.wait() else {
        return Ok(Some(1));
    };
    if let Some(code) = status.code() {
        return Ok(Some(u8::try_from(code).unwrap_or(1)));
    }
    // The launcher ends the other ranks after the first one, and the user all.
    if asked.load(Ordering::Relaxed) {
        return Ok(Some(INTERRUPTED));
    }
    let signal = std::os::unix::process::ExitStatusExt::signal(&status);
    Err(Failure::KilledRank {
        rank: rank_in_launch(),
        cause: cause(signal.unwrap_or_default(), scene),
    })
}

/// Whether this process is the rank. It then ends with the one that waits for it.
fn is_child() -> bool {
    let is_of_parent = || {
        let parent = std::os::unix::process::parent_id().to_string();
        std::env::var(WAITING).is_ok_and(|waiting| waiting == parent)
    };
    if !is_of_parent() {
        return false;
    }
    #[cfg(target_os = "linux")]
    {
        // Where the system refuses, a launcher still ends both.
        let _ = rustix::process::set_parent_process_death_signal(Some(Signal::KILL));
        if !is_of_parent() {
            super::interrupts::leave(1);
        }
    }
    true
}

/// This call once more, as a child with the same arguments, environment and streams.
fn start() -> Option<Child> {
    let mut command = Command::new(std::env::current_exe().ok()?);
    command.args(std::env::args_os().skip(1));
    command.env(WAITING, std::process::id().to_string());
    let [name, value] = TRIM;
    if std::env::var_os(name).is_none() {
        command.env(name, value);
    }
    command.spawn().ok()
}

/// Sends on to the rank what asks this process to end. A launcher that asks all its processes reaches the rank too,
/// which takes the second signal for an echo of the first.
fn pass_on_signals(child: &Child, asked: &Arc<AtomicBool>) {
    let (rank, asked) = (Pid::from_child(child), Arc::clone(asked));
    // Without a handler this process ends, and the rank with it.
    let _ = ctrlc::set_handler(move || {
        asked.store(true, Ordering::Relaxed);
        // A rank that has ended needs none.
        let _ = kill_process(rank, Signal::TERM);
    });
}

/// What a signal says of the end of a rank, and what helps.
fn cause(signal: i32, scene: &std::path::Path) -> String {
    let name = signal_hook::low_level::signal_name(signal).unwrap_or("a signal");
    if signal != signal_hook::consts::SIGKILL {
        return format!(
            "was ended by {name} (signal {signal}), a fault of the program or of a library"
        );
    }
    format!(
        "was killed by {name} (signal {signal}); the system kills processes when memory is short, and `tabor check {} --ranks {}` \
         states what a rank needs",
        scene.display(),
        count_of_ranks().unwrap_or(1),
    )
}
