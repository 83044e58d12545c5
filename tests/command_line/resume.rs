//! Nothing is lost: runs that are killed, interrupted or run out of room go on where they were, and
//! end with the same files.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::shared::binary::{self, command, errors, scene, status, summary, tabor};
use crate::shared::device::device;
use crate::shared::random::Random;
use crate::shared::run_folder::{ROUGH, expect_same, files, rows};
use crate::shared::trials::{ignore, is_long, tests};

fn run_whole(folder: &Path, extra: &[&str]) -> Duration {
    let clock = Instant::now();
    let call = [&["run", "scene.toml", "--out", "whole"], extra].concat();
    let output = tabor(folder, &call);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    clock.elapsed()
}

fn resume(folder: &Path, out: &str, extra: &[&str]) {
    let call = [&["run", "scene.toml", "--resume", "--out", out], extra].concat();
    let output = tabor(folder, &call);
    assert_eq!(status(&output), 0, "{out}: {}", errors(&output));
    expect_same(
        &folder.join("whole"),
        &folder.join(out),
        &format!("in {out}"),
    );
}

/// Kills runs (SIGKILL) at random moments and has them gone on with. Returns how many were killed
/// between their first row and their end.
fn kill_and_resume(text: &str, kills: usize, extra: &[&str]) -> usize {
    let folder = scene(text);
    let folder = folder.path();
    let duration = run_whole(folder, extra);
    let mut random = Random(20);
    let mut midway = 0;
    for kill in 0..kills {
        let out = format!("killed{kill}");
        let call = [&["run", "scene.toml", "--quiet", "--out", &out], extra].concat();
        let mut child = command(folder, &call)
            .stderr(Stdio::null())
            .spawn()
            .expect("the binary runs");
        sleep(duration.mul_f64(random.share()));
        child.kill().expect("it can be killed");
        child.wait().expect("it ended");
        let place = folder.join(&out);
        if !rows(&place).is_empty() && !place.join("summary.json").exists() {
            midway += 1;
        }
        resume(folder, &out, extra);
        fs::remove_dir_all(place).expect("it is removed");
    }
    midway
}

fn twenty_killed_runs_go_on_and_end_with_the_same_files() {
    let midway = kill_and_resume(ROUGH, 20, &["--backend", "cpu"]);
    // The moments are spread over the run, so that most fall between two steps or within one.
    assert!(midway >= 3, "only {midway} of 20 were killed midway");
}

fn single_precision_and_the_last_step_alone() {
    let text = ROUGH.replace("steps = [1, 2, 3, 4, 5, 6, 7, 8]", "steps = \"last\"");
    kill_and_resume(&text, 4, &["--precision", "single", "--backend", "cpu"]);
}

/// Further steps follow from the rows.
fn a_pull_until_apart_goes_on_with_the_same_steps() {
    let start = ROUGH.find("[loading]").expect("a table");
    let end = ROUGH.find("[output]").expect("a table");
    let loading =
        "[loading]\ncontrol = \"mean-gap\"\npath = [\"20 nm\", \"10 nm\"]\nuntil = \"apart\"\n";
    let output = "[output]\nimages = [\"gap\"]\nfields = [\"gap\"]\n";
    let text = format!("{}{loading}{output}", &ROUGH[..start]);
    assert!(end > start);
    kill_and_resume(&text, 5, &["--backend", "cpu"]);
}

/// A solid that relaxes remembers more than its gap; both stretches of unlike durations go on, and so
/// does the column of an effect.
fn a_relaxing_solid_goes_on_with_what_it_remembers() {
    let text = ROUGH.replace(
        "[[surface]]",
        "[[solid.relaxation]]\nmodulus = 2e9\ntime = 1.0\n[friction]\nshear_strength = 1e7\n[[surface]]",
    );
    let loading = &text[text.find("[loading]").expect("a table")..];
    let end = loading[1..].find("\n[").map_or(loading.len(), |at| at + 1);
    let ramps = "[loading]\ncontrol = \"mean-gap\"\nstart = 2e-9\n[[loading.ramp]]\nto = 1.5e-9\nsteps = 4\nduration = 1\n[[loading.ramp]]\nto = 2e-9\nsteps = 4\nduration = 8\n";
    let text = text.replace(&loading[..end], ramps);
    assert!(text.contains("duration = 8"));
    kill_and_resume(&text, 6, &["--backend", "cpu"]);
    let single = ["--precision", "single", "--backend", "cpu"];
    kill_and_resume(&text, 3, &single);
}

fn killed_runs_on_the_graphics_processor() {
    device();
    // Each compiles its shaders anew.
    let kills = if is_long() { 3 } else { 1 };
    kill_and_resume(ROUGH, kills, &["--backend", "gpu"]);
}

/// Starts a run and waits until `count` steps are in its curve.
fn start(folder: &Path, out: &str, count: usize, extra: &[&str]) -> std::process::Child {
    let call = [&["run", "scene.toml", "--out", out], extra].concat();
    let child = command(folder, &call)
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary runs");
    let clock = Instant::now();
    while rows(&folder.join(out)).len() < count {
        assert!(clock.elapsed() < Duration::from_secs(120), "no step ends");
        sleep(Duration::from_millis(2));
    }
    child
}

/// A run long enough to be met in the middle: tight, on a larger grid.
fn long() -> String {
    ROUGH
        .replace("[64, 48]", "[256, 192]")
        .replace("steps = [1, 2, 3, 4, 5, 6, 7, 8]", "steps = \"last\"")
}

#[cfg(unix)]
fn an_interrupt_ends_after_the_iteration_with_everything_written() {
    let folder = scene(&long());
    let folder = folder.path();
    run_whole(folder, &[]);
    for (signal, out) in [("-INT", "interrupted"), ("-TERM", "terminated")] {
        let child = start(folder, out, 2, &[]);
        assert!(binary::signal(&child, signal));
        let output = child.wait_with_output().expect("it ended");
        assert_eq!(status(&output), 130, "{}", errors(&output));
        let said = errors(&output);
        assert!(
            said.contains("interrupted after") && said.contains("--resume"),
            "{said}"
        );
        let place = folder.join(out);
        let done = rows(&place).len();
        assert!((2..8).contains(&done), "{done} steps");
        let summary = summary(&place);
        assert!(
            summary["largest_contact_area_fraction"]
                .as_f64()
                .is_some_and(|f| f > 0.0)
        );
        let report = fs::read_to_string(place.join("report.html")).expect("a report");
        assert!(report.contains(&format!("Ended early: {done} of 8 steps finished")));
        assert!(place.join("curve.png").exists());
        // The last finished step has its pictures, which go when the run goes on.
        assert!(
            place
                .join(format!("images/step_{done:04}_pressure.png"))
                .exists()
        );
        resume(folder, out, &[]);
    }
}

fn an_unconverged_step_is_solved_again_and_the_solver_may_change_then_only() {
    // A cold start at a low load takes the most iterations; here the fifth step is one.
    let (before, rest) = ROUGH.split_once("path = ").expect("a path");
    let (_, after) = rest.split_once('\n').expect("a line");
    let path = "[\"1 MPa\", \"3 MPa\", 0, \"-5 MPa\", \"0.2 MPa\", \"1 MPa\"]";
    let after = after.replace("5, 6, 7, 8]", "5, 6]");
    let folder = scene(&format!("{before}path = {path}\n{after}"));
    let folder = folder.path();
    run_whole(folder, &[]);
    // Few enough iterations that some step, but not the first, fails.
    let most = rows(&folder.join("whole"))
        .iter()
        .map(|row| row[10].parse::<usize>().expect("iterations"))
        .collect::<Vec<_>>();
    let limit = most[0] + 1;
    assert!(most[1..].iter().any(|&count| count > limit), "{most:?}");
    let set = format!("solver.max_iterations={limit}");
    let call = ["run", "scene.toml", "--out", "failed", "--set", &set];
    let output = tabor(folder, &call);
    assert_eq!(status(&output), 3, "{}", errors(&output));
    let place = folder.join("failed");
    let failed = rows(&place).len();
    assert!(failed > 1);
    assert_eq!(rows(&place)[failed - 1][12], "false");
    let report = fs::read_to_string(place.join("report.html")).expect("a report");
    assert!(report.contains(&format!("step {failed} of 6 did not converge")));
    // The same [solver] fails again in the same place; another one goes on.
    let output = tabor(folder, &[&call[..], &["--resume"]].concat());
    assert_eq!(status(&output), 3, "{}", errors(&output));
    assert_eq!(rows(&place).len(), failed);
    // One that is killed before it finishes a step goes on too, though the row that failed is dropped.
    let killed = command(
        folder,
        &["run", "scene.toml", "--out", "failed", "--resume"],
    )
    .env("TABOR_TEST_CRASH", "2")
    .output()
    .expect("the binary runs");
    assert_eq!(killed.status.code(), None, "{}", errors(&killed));
    assert_eq!(rows(&place).len(), failed - 1);
    resume(folder, "failed", &[]);

    // Steps that converged were solved with their [solver].
    let call = [
        "run",
        "scene.toml",
        "--out",
        "failed",
        "--resume",
        "--set",
        "solver.tolerance=1e-7",
    ];
    let output = tabor(folder, &call);
    assert_eq!(status(&output), 2);
    assert!(errors(&output).contains("[solver]"), "{}", errors(&output));
    expect_same(&folder.join("whole"), &place, "after the refusal");
}

fn other_scenes_and_damaged_states_are_refused_with_reasons() {
    let folder = scene(ROUGH);
    let folder = folder.path();
    run_whole(folder, &[]);
    let again = |set: &[&str]| {
        let call = [&["run", "scene.toml", "--out", "whole", "--resume"], set].concat();
        let output = tabor(folder, &call);
        (status(&output), errors(&output))
    };
    let before = files(&folder.join("whole"));
    for (set, named) in [
        ("surface.0.seed=2", "surface.0.seed"),
        ("solid.contact_modulus=51e6", "solid.contact_modulus"),
        (
            "loading.path=[1e5,1e6,3e6,1e6,0,-5e6,2e5,9e5]",
            "loading.path.0",
        ),
        ("title=Other", "title"),
        ("output.steps=last", "output.steps"),
    ] {
        let (code, said) = again(&["--set", set]);
        assert_eq!(code, 2, "{set}");
        assert!(
            said.contains("another scene") && said.contains(named),
            "{said}"
        );
    }
    // A finished run is gone on with by doing nothing.
    let (code, said) = again(&[]);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("all 8 steps were finished"), "{said}");
    assert!(before == files(&folder.join("whole")));
    // So is one that is told where to compute, if that is where it did.
    let (code, said) = again(&["--set", "solver.backend=cpu"]);
    assert_eq!(code, 0, "{said}");
    let (code, said) = again(&["--set", "solver.precision=single"]);
    assert_eq!(code, 2, "{said}");
    assert!(said.contains("[solver]"), "{said}");

    let state = folder.join("whole/state/last_step.bin");
    let good = fs::read(&state).expect("a state");
    let curve = folder.join("whole/curve.csv");
    let rows_before = fs::read_to_string(&curve).expect("a curve");
    let mut flipped = good.clone();
    flipped[good.len() / 2] ^= 4;
    for (bytes, named) in [
        (good[..good.len() / 2].to_vec(), "damaged"),
        (flipped, "damaged"),
        (b"PK\x03\x04".to_vec(), "not a state"),
        (Vec::new(), "not a state"),
    ] {
        fs::write(&state, bytes).expect("it is written");
        let (code, said) = again(&[]);
        assert_eq!(code, 2, "{said}");
        assert!(
            said.contains("last_step.bin") && said.contains(named),
            "{said}"
        );
        assert!(said.contains("without --resume"), "{said}");
    }
    fs::remove_file(&state).expect("it is removed");
    let (code, said) = again(&[]);
    assert_eq!(code, 2, "{said}");
    assert!(said.contains("is missing"), "{said}");
    fs::write(&state, &good).expect("it is written");
    fs::write(&curve, rows_before.replacen(",contact,", ",attracted,", 1)).expect("it is written");
    let (code, said) = again(&[]);
    assert_eq!(code, 2, "{said}");
    assert!(
        said.contains("curve.csv") && said.contains("changed"),
        "{said}"
    );
    fs::write(&curve, &rows_before[..rows_before.len() / 2]).expect("it is written");
    let (code, said) = again(&[]);
    assert_eq!(code, 2, "{said}");
    assert!(said.contains("whole rows"), "{said}");

    // A folder that tabor did not write.
    fs::create_dir(folder.join("mine")).expect("a folder");
    fs::write(folder.join("mine/notes.txt"), "mine").expect("a file");
    for extra in [&[][..], &["--resume"]] {
        let call = [&["run", "scene.toml", "--out", "mine"], extra].concat();
        let output = tabor(folder, &call);
        assert_eq!(status(&output), 2);
        assert!(
            errors(&output).contains("did not write"),
            "{}",
            errors(&output)
        );
    }
}

fn a_height_map_that_changed_is_another_scene() {
    let text = "[grid]\nboundary = \"free\"\nsize = 1e-6\n[solid]\ncontact_modulus = 1e9\n[[surface]]\nkind = \"file\"\npath = \"map.txt\"\n[loading]\ncontrol = \"approach\"\npath = [1e-9, 2e-9]\n";
    let folder = scene(text);
    let folder = folder.path();
    let map = |peak: f64| {
        let rows: Vec<String> = (0..16)
            .map(|y| {
                let row = (0..16).map(|x: i32| {
                    let r2 = f64::from((x - 8).pow(2) + (y - 8i32).pow(2));
                    format!("{:e}", peak - 1e-10 * r2)
                });
                row.collect::<Vec<_>>().join(" ")
            })
            .collect();
        fs::write(folder.join("map.txt"), rows.join("\n")).expect("the map is written");
    };
    map(0.0);
    run_whole(folder, &[]);
    resume(folder, "whole", &[]);
    map(1e-10);
    let output = tabor(folder, &["run", "scene.toml", "--out", "whole", "--resume"]);
    assert_eq!(status(&output), 2);
    assert!(
        errors(&output).contains("checksum of the heights"),
        "{}",
        errors(&output)
    );
}

fn an_adhesion_map_that_changed_is_another_scene() {
    let text = ROUGH.replace("range = \"10 nm\"", "range = \"10 nm\"\nmap = \"map.txt\"");
    let folder = scene(&text);
    let folder = folder.path();
    let map = |factor: &str| {
        let row = [factor; 64].join(" ");
        fs::write(folder.join("map.txt"), [&row[..]; 48].join("\n")).expect("the map is written");
    };
    map("1");
    run_whole(folder, &[]);
    resume(folder, "whole", &[]);
    map("1.5");
    let output = tabor(folder, &["run", "scene.toml", "--out", "whole", "--resume"]);
    let said = errors(&output);
    assert_eq!(status(&output), 2, "{said}");
    assert!(said.contains("checksum of the adhesion map"), "{said}");
}

/// A wall bears no tension: the second step has no fields, and none are missed.
fn steps_without_fields_are_not_taken_for_lost() {
    let folder = scene(
        "[grid]\npoints = 16\nsize = 1.0\n[solid]\ncontact_modulus = 1.0\n[[surface]]\nkind = \"wavy\"\namplitude = 0.01\nwavelength = 1.0\n[loading]\ncontrol = \"pressure\"\npath = [0.01, 0.0, -0.01, 0.02]\n[output]\nfields = [\"gap\"]\nsteps = \"all\"\n",
    );
    let folder = folder.path();
    run_whole(folder, &[]);
    let warnings = summary(&folder.join("whole"))["warnings"].to_string();
    assert_eq!(warnings.matches("no fields to write").count(), 1);
    let output = tabor(folder, &["run", "scene.toml", "--out", "whole", "--resume"]);
    let said = errors(&output);
    assert_eq!(status(&output), 0, "{said}");
    assert!(!said.contains("missing or cut short"), "{said}");
    assert_eq!(
        summary(&folder.join("whole"))["warnings"].to_string(),
        warnings
    );
}

/// No gap is smaller than none: the third step has no solution, and the fields that are written are those of the second.
/// A run that is resumed there, to the same end, does not lose them.
fn fields_before_a_step_without_any_stay() {
    let folder = scene(
        "[grid]\npoints = 16\nsize = 1.0\n[solid]\ncontact_modulus = 1.0\n[[surface]]\nkind = \"wavy\"\namplitude = 0.01\nwavelength = 1.0\n[loading]\ncontrol = \"approach\"\npath = [0.001, 0.005, 0.02]\n[output]\nfields = [\"gap\"]\nimages = [\"gap\"]\n",
    );
    let folder = folder.path();
    let run = |extra: &[&str]| {
        let call = [&["run", "scene.toml", "--out", "out"], extra].concat();
        let output = tabor(folder, &call);
        assert_eq!(status(&output), 3, "{}", errors(&output));
        ["fields/step_0002_gap.npy", "images/step_0002_gap.png"]
            .map(|name| fs::read(folder.join("out").join(name)).expect(name))
    };
    let whole = run(&[]);
    assert!(run(&["--resume"]) == whole);
    // A run killed in its third step has none of them; the one that resumes it there says so.
    for part in ["fields", "images"] {
        fs::remove_dir_all(folder.join("out").join(part)).expect("it is removed");
    }
    for _ in 0..2 {
        let call = ["run", "scene.toml", "--out", "out", "--resume"];
        let said = errors(&tabor(folder, &call));
        assert_eq!(said.matches("missing or cut short").count(), 1, "{said}");
        assert!(said.contains("step_0002_gap.png"), "{said}");
        let warnings = summary(&folder.join("out"))["warnings"].to_string();
        assert_eq!(warnings.matches("missing or cut short").count(), 1);
    }
}

#[cfg(unix)]
fn a_folder_that_vanishes_ends_the_run() {
    let folder = scene(&long());
    let folder = folder.path();
    let child = start(folder, "gone", 1, &[]);
    fs::rename(folder.join("gone"), folder.join("elsewhere")).expect("it is moved away");
    let output = child.wait_with_output().expect("it ended");
    let said = errors(&output);
    assert_eq!(status(&output), 1, "{said}");
    // By whichever file it was about to write.
    assert!(
        said.contains("cannot find the folder gone") || said.contains("cannot write gone"),
        "{said}"
    );
    assert!(said.contains("is gone"), "{said}");
    assert!(!folder.join("gone").exists(), "no half of it is made anew");
    // Brought back it goes on.
    run_whole(folder, &[]);
    resume(folder, "elsewhere", &[]);
}

fn a_file_where_a_folder_should_be_ends_the_run() {
    let folder = scene(ROUGH);
    let folder = folder.path();
    run_whole(folder, &[]);
    let place = folder.join("blocked");
    let call = [
        "run",
        "scene.toml",
        "--out",
        "blocked",
        "--set",
        "solver.max_iterations=1",
    ];
    assert_eq!(status(&tabor(folder, &call)), 3);
    for part in ["images", "fields"] {
        let part = place.join(part);
        if part.exists() {
            fs::remove_dir_all(&part).expect("it is removed");
        }
        fs::write(&part, "a file").expect("it is written");
        let output = tabor(
            folder,
            &["run", "scene.toml", "--out", "blocked", "--resume"],
        );
        let said = errors(&output);
        assert_eq!(status(&output), 1, "{said}");
        assert!(
            said.contains(part.file_name().and_then(|n| n.to_str()).expect("a name")),
            "{said}"
        );
        fs::remove_file(&part).expect("it is removed");
    }
    resume(folder, "blocked", &[]);
}

/// A shell refuses files beyond a size, as a full disk would; the signal for it is ignored, so that
/// the write fails instead.
#[cfg(unix)]
fn a_disk_without_room_keeps_what_was_finished() {
    let folder = scene(ROUGH);
    let folder = folder.path();
    run_whole(folder, &[]);
    let sizes = |named: &dyn Fn(&str) -> bool| -> Vec<usize> {
        files(&folder.join("whole"))
            .iter()
            .filter(|(name, _)| named(name))
            .map(|(_, bytes)| bytes.len())
            .collect()
    };
    let script = "trap '' XFSZ; ulimit -f $1; shift; exec \"$@\"";
    let run = |blocks: usize, extra: &[&str]| {
        Command::new("sh")
            .args(["-c", script, "sh", &blocks.to_string(), binary::BINARY])
            .args(["run", "scene.toml", "--out", "full"])
            .args(extra)
            .current_dir(folder)
            .output()
            .expect("the shell runs")
    };
    // Blocks are 512 bytes. Nothing at all has room, then all but the largest files.
    let output = run(0, &[]);
    let said = errors(&output);
    assert_eq!(status(&output), 1, "{said}");
    assert!(said.contains("cannot write full"), "{said}");
    let least = sizes(&|name| name.ends_with(".png") && name.starts_with("images/"));
    let least = least.into_iter().min().expect("pictures");
    let output = run(least / 512 - 1, &[]);
    let said = errors(&output);
    assert_eq!(status(&output), 1, "{said}");
    assert!(
        said.contains("step_0001") && said.contains("no step was finished"),
        "{said}"
    );
    // Room for the files of every step, but not for the report with its pictures.
    let largest = sizes(&|name| !name.ends_with("report.html") && name != "curve.png");
    let largest = largest.into_iter().max().expect("files");
    let output = run(largest / 512 + 2, &["--resume"]);
    let said = errors(&output);
    assert_eq!(status(&output), 1, "{said}");
    assert!(
        said.contains("report.html") && said.contains("kept in full"),
        "{said}"
    );
    resume(folder, "full", &[]);
}

/// A disk of a few kilobytes, where this machine lets a test mount one.
#[cfg(target_os = "linux")]
fn a_full_disk_keeps_what_was_finished() {
    let folder = scene(ROUGH);
    let folder = folder.path();
    let disk = folder.join("disk");
    fs::create_dir(&disk).expect("a folder");
    let mounted = Command::new("mount")
        .args(["-t", "tmpfs", "-o", "size=600k", "tmpfs"])
        .arg(&disk)
        .output();
    if !mounted.is_ok_and(|output| output.status.success()) {
        ignore("no disk can be mounted here");
    }
    let output = tabor(folder, &["run", "scene.toml", "--out", "disk/full"]);
    let kept = rows(&disk.join("full"));
    let copied = Command::new("cp")
        .args(["-r", "disk/full", "room"])
        .current_dir(folder)
        .status();
    let unmounted = Command::new("umount").arg(&disk).status();
    assert!(unmounted.expect("umount runs").success());
    assert!(copied.expect("cp runs").success());
    let said = errors(&output);
    assert_eq!(status(&output), 1, "{said}");
    assert!(
        said.contains("No space left") && said.contains("disk/full"),
        "{said}"
    );
    assert!(!kept.is_empty() && kept.len() < 8, "{} rows", kept.len());
    run_whole(folder, &[]);
    resume(folder, "room", &[]);
}

tests![
    twenty_killed_runs_go_on_and_end_with_the_same_files,
    single_precision_and_the_last_step_alone,
    a_pull_until_apart_goes_on_with_the_same_steps,
    a_relaxing_solid_goes_on_with_what_it_remembers,
    killed_runs_on_the_graphics_processor,
    #[cfg(unix)]
    an_interrupt_ends_after_the_iteration_with_everything_written,
    an_unconverged_step_is_solved_again_and_the_solver_may_change_then_only,
    other_scenes_and_damaged_states_are_refused_with_reasons,
    a_height_map_that_changed_is_another_scene,
    an_adhesion_map_that_changed_is_another_scene,
    steps_without_fields_are_not_taken_for_lost,
    fields_before_a_step_without_any_stay,
    #[cfg(unix)]
    a_folder_that_vanishes_ends_the_run,
    a_file_where_a_folder_should_be_ends_the_run,
    #[cfg(unix)]
    a_disk_without_room_keeps_what_was_finished,
    #[cfg(target_os = "linux")]
    a_full_disk_keeps_what_was_finished,
];
