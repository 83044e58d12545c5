//! A harness for tests that find out only when they run that they cannot: without an adapter, a browser or a
//! table they are reported as ignored, with the reason. The compiler's own harness would say that they passed.
//!
//! A module lists its tests with [`tests!`], which stands where `#[test]` would, and the binary's `main` hands
//! the lists to [`run`]. A function that no list names is unused code, which lints refuse.

use std::panic::{catch_unwind, resume_unwind};
use std::process::{Command, ExitCode};
use std::time::Instant;

use libtest_mimic::{Arguments, Completion, Trial};
use tabor::backend::cpu::with_threads;

/// Why a test cannot run; what [`ignore`] unwinds with.
struct Ignored(String);

/// Whether every claim is tried on all that it is about (`TABOR_LONG=1`), which takes some minutes more.
pub fn is_long() -> bool {
    std::env::var("TABOR_LONG").is_ok_and(|value| value == "1")
}

/// Whether the seconds of each test are printed (`TABOR_TEST_SECONDS=1`).
fn tells_seconds() -> bool {
    std::env::var("TABOR_TEST_SECONDS").is_ok_and(|value| value == "1")
}

/// Ends the running test, which is reported as ignored.
pub fn ignore(reason: impl Into<String>) -> ! {
    // Unlike `panic!`, this prints nothing.
    resume_unwind(Box::new(Ignored(reason.into())))
}

/// Lists the tests of a module: functions without arguments.
#[allow(unused_macros, reason = "not every binary needs this harness")]
macro_rules! tests {
    ($($(#[$attribute:meta])* $name:ident),* $(,)?) => {
        /// The tests of this module.
        #[allow(clippy::vec_init_then_push, reason = "an attribute may leave a push out, but no element of a list")]
        pub fn tests() -> Vec<libtest_mimic::Trial> {
            let mut listed = Vec::new();
            $(
                $(#[$attribute])*
                listed.push($crate::shared::trials::trial(module_path!(), stringify!($name), $name));
            )*
            listed
        }
    };
}
#[allow(unused_imports, reason = "not every binary needs this harness")]
pub(crate) use tests;

/// A test by its module and name, as the compiler's harness would name it.
///
/// It runs on a pool of one thread: tests run side by side already, and a solve from outside of a pool wakes
/// another thread for each of its kernels. Results have the same bits on any number of threads.
///
/// A function by its address: another type for each test would compile all of this for each.
pub fn trial(module: &str, name: &str, test: fn()) -> Trial {
    let module = module.split_once("::").map_or("", |(_, below)| below);
    let name = format!("{module}::{name}");
    Trial::ignorable_test(name.clone(), move || {
        let begun = Instant::now();
        let end = catch_unwind(|| with_threads(Some(1), test).expect("a thread"));
        if tells_seconds() {
            eprintln!("{:7.2} s  {name}", begun.elapsed().as_secs_f64());
        }
        let Err(payload) = end else {
            return Ok(Completion::Completed);
        };
        match payload.downcast::<Ignored>() {
            Ok(ignored) => Ok(Completion::ignored_with(ignored.0)),
            Err(failure) => resume_unwind(failure),
        }
    })
}

/// Runs one test of this binary in a process of its own, with an environment, and fails unless it is ignored for
/// a reason that holds `reason`.
pub fn expect_ignored(test: &str, environment: &[(&str, &str)], reason: &str) {
    let output = Command::new(std::env::current_exe().expect("this binary"))
        .args(["--exact", test])
        .env_remove("TABOR_REQUIRE_GPU")
        .env_remove("TABOR_REQUIRE_BROWSER")
        .envs(environment.iter().copied())
        .output()
        .expect("this binary runs");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{said}");
    let line = said.lines().find(|line| line.starts_with("test "));
    let line = line.unwrap_or_else(|| panic!("{test} is not run:\n{said}"));
    assert!(
        line.contains("ignored (") && line.contains(reason),
        "{said}"
    );
    assert!(said.contains("0 passed; 0 failed; 1 ignored"), "{said}");
}

/// Runs a binary's tests as its arguments say.
pub fn run<const N: usize>(modules: [Vec<Trial>; N]) -> ExitCode {
    start(modules, Arguments::from_args())
}

/// The same with one test at a time.
pub fn run_one_by_one<const N: usize>(modules: [Vec<Trial>; N]) -> ExitCode {
    let mut arguments = Arguments::from_args();
    arguments.test_threads = Some(1);
    start(modules, arguments)
}

fn start<const N: usize>(modules: [Vec<Trial>; N], arguments: Arguments) -> ExitCode {
    let tests = modules.into_iter().flatten().collect();
    libtest_mimic::run(&arguments, tests).exit_code()
}
