//! What a run has written stays: a second run keeps out, files that others take away or change are noticed, and
//! no way out of a damaged folder costs rows.

use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::shared::binary::{self, command, errors, scene, status, summary, tabor};
use crate::shared::device::device;
use crate::shared::run_folder::{ROUGH, expect_same, files, rows};
use crate::shared::trials::tests;

/// A run that is met in the middle for sure: each of its steps takes many iterations on a larger grid.
fn long() -> String {
    ROUGH
        .replace("[64, 48]", "[256, 192]")
        .replace("steps = [1, 2, 3, 4, 5, 6, 7, 8]", "steps = \"last\"")
}

fn run_whole(folder: &Path) {
    let output = tabor(folder, &["run", "scene.toml", "--out", "whole"]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
}

/// Starts a run and waits until `count` steps are in its curve.
fn start(folder: &Path, count: usize) -> Child {
    let child = command(folder, &["run", "scene.toml", "--out", "out"])
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary runs");
    let clock = Instant::now();
    while rows(&folder.join("out")).len() < count {
        assert!(clock.elapsed() < Duration::from_secs(120), "no step ends");
        sleep(Duration::from_millis(2));
    }
    child
}

fn a_second_run_into_a_folder_is_refused_and_told_of_the_first() {
    let folder = scene(&long());
    let folder = folder.path();
    run_whole(folder);
    let first = start(folder, 1);
    for extra in [&[][..], &["--resume"]] {
        let call = [&["run", "scene.toml", "--out", "out"], extra].concat();
        let second = tabor(folder, &call);
        let said = errors(&second);
        assert_eq!(status(&second), 2, "{extra:?}: {said}");
        let process = format!("(process {}", first.id());
        assert!(
            said.contains("another run is writing it") && said.contains(&process),
            "{said}"
        );
        assert!(said.contains("--out"), "the way out: {said}");
    }
    let output = first.wait_with_output().expect("it ended");
    assert_eq!(status(&output), 0, "{}", errors(&output));
    expect_same(&folder.join("whole"), &folder.join("out"), "beside others");
    // Once it has ended, the folder is free; so it is after a kill.
    let mut killed = start_again(folder);
    killed.kill().expect("it can be killed");
    killed.wait().expect("it ended");
    let call = ["run", "scene.toml", "--out", "out", "--resume"];
    let output = tabor(folder, &call);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    expect_same(&folder.join("whole"), &folder.join("out"), "after a kill");
}

/// A run from the first step into a folder that holds a whole one.
fn start_again(folder: &Path) -> Child {
    let before = fs::read(folder.join("out/summary.json")).expect("a summary");
    assert!(!before.is_empty());
    let child = command(folder, &["run", "scene.toml", "--out", "out"])
        .stderr(Stdio::null())
        .spawn()
        .expect("the binary runs");
    let clock = Instant::now();
    // The rows of the run before stand there until they are replaced.
    let whole = rows(&folder.join("whole")).len();
    let is_new = || (1..whole).contains(&rows(&folder.join("out")).len());
    while folder.join("out/summary.json").exists() || !is_new() {
        assert!(clock.elapsed() < Duration::from_secs(120), "no step ends");
        sleep(Duration::from_millis(2));
    }
    child
}

/// A run from the first step over a whole one, killed before each of the changes that it makes to the folder until
/// it has rows of its own: `--resume` then solves all of it.
fn a_run_over_a_whole_one_can_be_resumed_wherever_it_is_killed() {
    let folder = scene(&ROUGH.replace("steps = [1, 2, 3, 4, 5, 6, 7, 8]", "steps = \"last\""));
    let folder = folder.path();
    run_whole(folder);
    let whole = rows(&folder.join("whole"));
    let out = folder.join("out");
    for changes in 0.. {
        let output = tabor(folder, &["run", "scene.toml", "--out", "out"]);
        assert_eq!(status(&output), 0, "{}", errors(&output));
        let killed = command(folder, &["run", "scene.toml", "--out", "out"])
            .env("TABOR_TEST_CRASH", changes.to_string())
            .output()
            .expect("the binary runs");
        assert_eq!(
            killed.status.code(),
            None,
            "it is killed: {}",
            errors(&killed)
        );
        let left = rows(&out).len();
        let output = tabor(folder, &["run", "scene.toml", "--out", "out", "--resume"]);
        assert_eq!(
            status(&output),
            0,
            "after {changes} changes: {}",
            errors(&output)
        );
        expect_same(
            &folder.join("whole"),
            &out,
            &format!("after {changes} changes"),
        );
        if (1..whole.len()).contains(&left) {
            // Marker, state, pictures, fields, summary, report, the two drawn curves and the curve itself.
            assert!(changes >= 8, "only {changes} changes before the first row");
            return;
        }
    }
}

/// Two that begin at the same moment: one of them writes the folder, whole.
fn of_two_runs_at_once_one_keeps_out() {
    let folder = scene(ROUGH);
    let folder = folder.path();
    run_whole(folder);
    for round in 0..5 {
        let out = format!("out{round}");
        let both = [0, 1].map(|_| {
            command(folder, &["run", "scene.toml", "--out", &out])
                .stderr(Stdio::piped())
                .spawn()
                .expect("the binary runs")
        });
        let ended = both.map(|child| child.wait_with_output().expect("it ended"));
        let mut codes = [status(&ended[0]), status(&ended[1])];
        codes.sort_unstable();
        // The second may come after the first has ended, and then solves it all again.
        assert!(
            codes == [0, 2] || codes == [0, 0],
            "{codes:?}: {} {}",
            errors(&ended[0]),
            errors(&ended[1])
        );
        expect_same(&folder.join("whole"), &folder.join(&out), "of two at once");
    }
}

fn a_curve_that_others_remove_or_change_is_written_anew() {
    let folder = scene(&long());
    let folder = folder.path();
    run_whole(folder);
    let whole = files(&folder.join("whole"));
    let curve = folder.join("out/curve.csv");
    let kept = folder.join("out/curve.csv.before");
    let remove: &dyn Fn() = &|| fs::remove_file(&curve).expect("it is removed");
    let replace = &|| {
        fs::write(folder.join("theirs"), "theirs\n").expect("it is written");
        fs::rename(folder.join("theirs"), &curve).expect("it is replaced");
    };
    // As long as before: only its content tells.
    let overwrite = &|| {
        let text = fs::read_to_string(&curve).expect("a curve");
        fs::write(&curve, text.replacen("step,", "STEP,", 1)).expect("it is written");
    };
    for (change, said, theirs) in [
        (remove, "was removed", None),
        (replace, "was changed by another program", Some("theirs\n")),
        (overwrite, "was changed by another program", Some("STEP,")),
    ] {
        let run = start(folder, 2);
        change();
        let output = run.wait_with_output().expect("it ended");
        let heard = errors(&output);
        assert_eq!(status(&output), 0, "{heard}");
        assert!(heard.contains(said), "{heard}");
        let warned = summary(&folder.join("out"))["warnings"].to_string();
        assert!(warned.contains(said), "{warned}");
        assert!(
            files(&folder.join("out"))["curve.csv"] == whole["curve.csv"],
            "all rows of {}",
            fs::read_to_string(&curve).expect("a curve")
        );
        match theirs {
            Some(theirs) => {
                let text = fs::read_to_string(&kept).expect("theirs is kept");
                assert!(text.starts_with(theirs), "{text}");
                assert!(heard.contains("curve.csv.before"), "{heard}");
            }
            None => assert!(!kept.exists()),
        }
        fs::remove_dir_all(folder.join("out")).expect("it is removed");
    }
}

fn going_on_names_files_of_finished_steps_that_are_lost() {
    let folder = scene(ROUGH);
    let folder = folder.path();
    run_whole(folder);
    let place = folder.join("whole");
    let cut = |name: &str| {
        let bytes = fs::read(place.join(name)).expect("a file");
        fs::write(place.join(name), &bytes[..bytes.len() / 2]).expect("it is cut");
    };
    let resume = || {
        let output = tabor(folder, &["run", "scene.toml", "--out", "whole", "--resume"]);
        let said = errors(&output);
        assert_eq!(status(&output), 0, "{said}");
        (said, summary(&place)["warnings"].to_string())
    };
    let (said, _) = resume();
    let lost = [
        "images/step_0002_gap.png",
        "images/step_0003_pressure.png",
        "fields/step_0004_gap.npy",
        "fields/step_0001_pressure.npy",
        "fields/step_0005.vti",
    ];
    let is_named = |name: &&str| said.contains(*name);
    assert!(!lost.iter().any(is_named), "nothing is lost yet: {said}");
    fs::remove_file(place.join(lost[0])).expect("it is removed");
    fs::remove_file(place.join(lost[3])).expect("it is removed");
    for name in [lost[1], lost[2], lost[4]] {
        cut(name);
    }
    for _ in 0..2 {
        let (said, warned) = resume();
        for name in lost {
            assert!(
                said.contains(name) && warned.contains(name),
                "{name}: {said}"
            );
        }
        for name in ["step_0006", "step_0004_pressure.npy", "step_0003.vti"] {
            assert!(!said.contains(name), "{name} is whole: {said}");
        }
        assert!(said.contains("--out"), "the way to get them: {said}");
        assert_eq!(warned.matches(lost[0]).count(), 1, "said once: {warned}");
    }
}

fn no_way_out_of_a_damaged_folder_costs_rows() {
    let folder = scene(ROUGH);
    let folder = folder.path();
    run_whole(folder);
    let place = folder.join("whole");
    let curve = place.join("curve.csv");
    let good = fs::read_to_string(&curve).expect("a curve");
    let state = place.join("state/last_step.bin");
    let run = |extra: &[&str]| {
        let call = [&["run", "scene.toml", "--out", "whole"], extra].concat();
        let output = tabor(folder, &call);
        (status(&output), errors(&output))
    };
    // A sound folder is written anew without ado.
    assert_eq!(run(&[]).0, 0);
    assert!(!place.join("curve.csv.before").exists());
    let whole = fs::read(&state).expect("a state");
    let damages: [(&str, &dyn Fn()); 3] = [
        ("curve.csv.before", &|| {
            fs::write(&state, &whole[..whole.len() / 2]).expect("it is cut");
        }),
        ("curve.csv.before2", &|| {
            fs::remove_file(&state).expect("it is removed");
        }),
        ("curve.csv.before3", &|| {
            let shorter = good.lines().take(4).map(|line| format!("{line}\n"));
            fs::write(&curve, shorter.collect::<String>()).expect("it is cut");
        }),
    ];
    for (name, damage) in damages {
        damage();
        let before = fs::read_to_string(&curve).expect("a curve");
        let (code, said) = run(&["--resume"]);
        assert_eq!(code, 2, "{said}");
        assert!(
            said.contains("without --resume") && said.contains("curve.csv.before"),
            "{said}"
        );
        // The advice is followed.
        let (code, said) = run(&[]);
        assert_eq!(code, 0, "{said}");
        assert!(said.contains(name), "{said}");
        let kept = fs::read_to_string(place.join(name)).expect("the rows are kept");
        assert_eq!(kept, before);
    }
}

/// A shader that compiles for a minute: a signal ends the run all the same, and the steps that were finished stay.
#[cfg(unix)]
fn a_signal_while_a_shader_compiles_ends_the_run_at_once() {
    device();
    let folder = scene(ROUGH);
    let folder = folder.path();
    // In few shaders, each of which software compiles slowly.
    let few = ["--precision", "single", "--set", "grid.points=32"];
    let call = ["run", "scene.toml", "--backend", "gpu", "--out", "out"];
    let call = [&call[..], &few].concat();
    let begin = |extra: &[&str], slow: &str| {
        command(folder, &[&call[..], extra].concat())
            .env("TABOR_TEST_GPU", slow)
            .stderr(Stdio::piped())
            .spawn()
            .expect("the binary runs")
    };
    let out = folder.join("out");
    let until = |met: &dyn Fn() -> bool| {
        let clock = Instant::now();
        while !met() {
            assert!(clock.elapsed() < Duration::from_secs(120), "it never does");
            sleep(Duration::from_millis(5));
        }
    };
    // Some steps are finished before.
    let mut run = begin(&[], "");
    until(&|| rows(&out).len() >= 2);
    run.kill().expect("it can be killed");
    run.wait().expect("it ended");
    let before = rows(&out);
    // Two signals together are one that came twice; a second one later ends the run before the first does.
    for (signals, pause, twice) in [
        (&["-INT"][..], 0, false),
        (&["-TERM", "-TERM"], 0, false),
        (&["-INT", "-INT"], 600, true),
    ] {
        let run = begin(&["--resume"], "compiling=60000");
        let me = run.id().to_string();
        until(&|| {
            let holder = fs::read_to_string(out.join("state/lock")).unwrap_or_default();
            holder.starts_with(&me)
        });
        // It reads its state and asks for the first shader.
        sleep(Duration::from_millis(500));
        let clock = Instant::now();
        for signal in signals {
            assert!(binary::signal(&run, signal));
            sleep(Duration::from_millis(pause));
        }
        let output = run.wait_with_output().expect("it ended");
        let waited = clock.elapsed();
        let said = errors(&output);
        assert_eq!(status(&output), 130, "{said}");
        assert!(waited < Duration::from_secs(2), "{waited:?}: {said}");
        assert_eq!(said.contains("twice"), twice, "{said}");
        assert!(
            said.contains("error: interrupted") && said.contains("--resume continues after"),
            "{said}"
        );
        let kept = rows(&out);
        assert!(kept.len() + 1 >= before.len() && kept[..] == before[..kept.len()]);
    }
    // Nothing is half written, and the folder is free.
    let run = begin(&["--resume"], "");
    let output = run.wait_with_output().expect("it ended");
    assert_eq!(status(&output), 0, "{}", errors(&output));
    assert_eq!(rows(&out).len(), 8);
}

/// The other commands that write for a while hold their folders too.
fn studies_and_surfaces_keep_out_of_folders_that_are_held() {
    let folder = scene(ROUGH);
    let folder = folder.path();
    for (command, lock) in [
        ("compare", "held/.tabor-lock"),
        ("accuracy", "held/.tabor-lock"),
        ("surface", "held/state/lock"),
        ("run", "held/state/lock"),
    ] {
        let lock = folder.join(lock);
        fs::create_dir_all(lock.parent().expect("a folder")).expect("it is made");
        fs::write(&lock, "7 0 box\n").expect("it is written");
        let held = fs::File::open(&lock).expect("it is there");
        held.lock().expect("this file system knows locks");
        let output = tabor(folder, &[command, "scene.toml", "--out", "held"]);
        let said = errors(&output);
        assert_eq!(status(&output), 2, "{command}: {said}");
        assert!(
            said.contains("(process 7 on box, for "),
            "{command}: {said}"
        );
        drop(held);
        fs::remove_dir_all(folder.join("held")).expect("it is removed");
    }
}

tests![
    a_second_run_into_a_folder_is_refused_and_told_of_the_first,
    a_run_over_a_whole_one_can_be_resumed_wherever_it_is_killed,
    of_two_runs_at_once_one_keeps_out,
    a_curve_that_others_remove_or_change_is_written_anew,
    going_on_names_files_of_finished_steps_that_are_lost,
    no_way_out_of_a_damaged_folder_costs_rows,
    #[cfg(unix)]
    a_signal_while_a_shader_compiles_ends_the_run_at_once,
    studies_and_surfaces_keep_out_of_folders_that_are_held,
];
