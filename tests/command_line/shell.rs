//! The command line at home in a shell: completions, man pages, colour, quiet runs, and values of
//! `--set` as a shell hands them over.

use std::fs;
use std::process::{Command, Stdio};

use crate::shared::binary::{self, scene, tabor};
use crate::shared::trials::{ignore, tests};

const SCENE: &str = r#"[grid]
points = 16
size = "1 um"
[solid]
contact_modulus = "1 GPa"
[[surface]]
kind = "sphere"
radius = "1 um"
[loading]
control = "pressure"
path = ["1 MPa", "2 MPa"]
"#;

const COMMANDS: [&str; 13] = [
    "run",
    "check",
    "surface",
    "theory",
    "compare",
    "accuracy",
    "fit",
    "devices",
    "completions",
    "man",
    "new",
    "sweep",
    "plot",
];

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

fn completions_name_every_command() {
    let folder = scene(SCENE);
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let output = tabor(folder.path(), &["completions", shell]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let script = text(&output.stdout);
        for command in COMMANDS {
            assert!(script.contains(command), "{shell} lacks {command}");
        }
        assert!(
            script.contains("--precision") || script.contains("-l precision"),
            "{shell}"
        );
    }
    let output = tabor(folder.path(), &["completions", "csh"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("bash, elvish, fish, powershell, zsh"));
}

/// The shell itself takes the script.
fn bash_takes_its_completions() {
    let folder = scene(SCENE);
    let script = tabor(folder.path(), &["completions", "bash"]).stdout;
    fs::write(folder.path().join("tabor.bash"), script).expect("a script");
    let output = Command::new("bash")
        .current_dir(folder.path())
        .args(["-c", ". ./tabor.bash && complete -p tabor"])
        .output()
        .unwrap_or_else(|_| ignore("no bash"));
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("_tabor"));
}

fn man_pages_are_one_a_command() {
    let folder = scene(SCENE);
    let output = tabor(folder.path(), &["man"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let page = text(&output.stdout);
    assert!(
        page.contains(".TH tabor 1") && page.contains("tabor\\-run(1)"),
        "{page}"
    );
    let output = tabor(folder.path(), &["man", "pages"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(output.stdout.is_empty());
    for command in COMMANDS {
        let path = folder.path().join(format!("pages/tabor-{command}.1"));
        let page = fs::read_to_string(&path).unwrap_or_else(|_| panic!("no page of {command}"));
        assert!(page.contains(&format!("tabor\\-{command}")), "{page}");
    }
    let pages = fs::read_dir(folder.path().join("pages")).expect("a folder");
    assert_eq!(pages.count(), COMMANDS.len() + 1);
    // A file in the way: an output that cannot be written.
    let output = tabor(folder.path(), &["man", "scene.toml"]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("cannot create the folder scene.toml"));
}

fn without_a_terminal_there_is_no_colour() {
    let folder = scene(SCENE);
    for arguments in [
        &["check", "absent.toml"][..],
        &["run", "scene.toml"],
        &["--help"],
        &["no"],
    ] {
        let output = tabor(folder.path(), arguments);
        for stream in [&output.stdout, &output.stderr] {
            assert!(!stream.contains(&0x1b), "{arguments:?}: {}", text(stream));
        }
    }
}

/// On a terminal of its own, as `script` of util-linux makes one.
#[cfg(target_os = "linux")]
fn on_a_terminal_colour_is_the_users_choice() {
    let folder = scene(SCENE);
    let on_a_terminal = |arguments: &str, no_color: Option<&str>| {
        let mut command = Command::new("script");
        command
            .current_dir(folder.path())
            .args([
                "-qec",
                &format!("{} {arguments}", binary::BINARY),
                "/dev/null",
            ])
            .env("TERM", "xterm-256color")
            .env_remove("NO_COLOR")
            .env_remove("CLICOLOR")
            .stdin(Stdio::null());
        if let Some(value) = no_color {
            command.env("NO_COLOR", value);
        }
        command.output().ok()
    };
    let Some(coloured) = on_a_terminal("check absent.toml", None) else {
        ignore("no script(1)");
    };
    let message = text(&coloured.stdout);
    assert_eq!(coloured.status.code(), Some(2), "{message}");
    assert!(
        message.contains("\u{1b}[") && message.contains("absent.toml"),
        "{message}"
    );
    for arguments in ["check absent.toml", "--help", "no"] {
        let plain = on_a_terminal(arguments, Some("1")).expect("it ran before");
        let message = text(&plain.stdout);
        assert!(
            message.contains("tabor") || message.contains("absent.toml"),
            "{message}"
        );
        // Colours begin so; a progress line may move the cursor.
        assert!(
            !message.contains("\u{1b}[1m") && !message.contains("\u{1b}[3"),
            "{message}"
        );
    }
}

/// Text of a file, a key or a call that would change a terminal: clear it, turn red, ring, and begin a line that looks
/// like one of tabor's.
const ACTING: &str = "\u{1b}[2J\u{1b}]0;x\u{7}\u{1b}[31mred\u{9b}1m\rnote: forged\u{8}\u{202e}";

/// What a program's words do not hold but as its own colours.
fn acts(bytes: &[u8]) -> Option<String> {
    let text = String::from_utf8_lossy(bytes);
    // Its own: styles, ends of lines as a terminal has them, and the progress line, which is padded to its width and
    // drawn over.
    let mut left = text.replace("\r\n", "\n").replace(" \r", " \n");
    for own in [
        "\u{1b}[1m\u{1b}[31m",
        "\u{1b}[31m\u{1b}[1m",
        "\u{1b}[0m",
        "\u{1b}[1m",
        "\u{1b}[4m",
        "\u{1b}[32m",
        "\u{1b}[33m",
        // Clears the progress line.
        "\u{1b}[2K",
    ] {
        left = left.replace(own, "");
    }
    let odd = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
    left.lines()
        .find(|line| line.contains(odd))
        .map(|line| format!("{line:?}"))
}

#[cfg(target_os = "linux")]
fn nothing_from_outside_acts_on_a_terminal_or_a_page() {
    let escaped: String = ACTING
        .chars()
        .map(|c| format!("\\U{:08X}", c as u32))
        .collect();
    let folder = scene(SCENE);
    let path = folder.path();
    let write = |name: &str, text: &str| fs::write(path.join(name), text).expect("a file");
    write("titled.toml", &format!("title = \"{escaped}\"\n{SCENE}"));
    write("key.toml", &format!("\"{escaped}\" = 1\n{SCENE}"));
    write(
        "value.toml",
        &SCENE.replace("\"pressure\"", &format!("\"{escaped}\"")),
    );
    write("broken.toml", &format!("{SCENE}\n{ACTING} = ["));
    let heights = format!("1 2 3\n4 {ACTING} 6\n");
    write("heights.txt", &heights);
    write(&format!("{ACTING}.txt"), "1 2\n3 x\n");
    write(&format!("{ACTING}.toml"), SCENE);
    write("curve.csv", &format!("{ACTING},force\n1,2\n"));
    write("script", "exec \"$TABOR\" \"$@\"");
    let file = format!("{ACTING}.txt");
    let scene_file = format!("{ACTING}.toml");
    let set = format!("title={ACTING}");
    let odd_key = format!("grid.{ACTING}=1");
    let calls: &[&[&str]] = &[
        &[
            "run",
            "titled.toml",
            "--out",
            "titled",
            "--set",
            "output={ images = ['gap'] }",
        ],
        &["check", "titled.toml"],
        &["check", "key.toml"],
        &["check", "value.toml"],
        &["check", "broken.toml"],
        &["check", ACTING],
        &["check", "scene.toml", "--set", ACTING],
        &["check", "scene.toml", "--set", &set],
        &["check", "scene.toml", "--set", &odd_key],
        &["run", &scene_file],
        &["run", "scene.toml", "--out", ACTING, "--resume"],
        &["run", "titled.toml", "--out", ACTING],
        &["surface", "heights.txt", "--size", "1 um"],
        &["surface", &file, "--size", "1 um"],
        &["surface", &scene_file],
        &["fit", "curve.csv", "--radius", "1 um"],
        &["fit", ACTING, "--radius", "1 um"],
        &["theory", ACTING],
        &["theory", "hertz", "--radius", ACTING],
        &["theory", "hertz", ACTING],
        &["compare", ACTING],
        &["accuracy", ACTING],
        &["accuracy", "scene.toml", "--budget", ACTING],
        &[ACTING],
        &["run", "scene.toml", ACTING],
        &["run", "scene.toml", "--backend", ACTING],
        &["completions", ACTING],
        &["man", &scene_file],
    ];
    let mut wrong = Vec::new();
    let mut no_terminal = false;
    for call in calls {
        // Off a terminal, and on one of its own as `script` of util-linux makes it.
        let piped = tabor(path, call);
        for stream in [&piped.stdout, &piped.stderr] {
            wrong.extend(acts(stream).map(|line| format!("{call:?}: {line}")));
        }
        let words: Vec<String> = call
            .iter()
            .map(|word| format!("\"$(printf '{}')\"", octal(word)))
            .collect();
        let line = format!("\"$TABOR\" {}", words.join(" "));
        let on_a_terminal = Command::new("script")
            .current_dir(path)
            .env("TABOR", binary::BINARY)
            .env("TERM", "xterm-256color")
            .env("SHELL", "/bin/sh")
            .env_remove("NO_COLOR")
            .args(["-qec", &line, "/dev/null"])
            .stdin(Stdio::null())
            .output();
        let Ok(shown) = on_a_terminal else {
            no_terminal = true;
            continue;
        };
        assert_eq!(
            shown.status.code(),
            piped.status.code(),
            "{call:?}: {}",
            text_of(&shown.stdout)
        );
        wrong.extend(acts(&shown.stdout).map(|line| format!("{call:?} on a terminal: {line}")));
    }
    // The page and the pictures.
    let page = fs::read(path.join("titled/report.html")).expect("a page");
    assert!(!page.is_empty());
    wrong.extend(acts(&page).map(|line| format!("report.html: {line}")));
    let pictures = fs::read_dir(path.join("titled/images")).expect("pictures");
    let mut texts = 0;
    for entry in pictures.flatten() {
        let picture = fs::read(entry.path()).expect("a picture");
        let holds = |text: &str| {
            picture
                .windows(text.len())
                .any(|part| part == text.as_bytes())
        };
        texts += usize::from(holds("\\u{1b}[31mred"));
        if holds("\u{1b}[31mred") {
            wrong.push(format!("{} holds it raw", entry.path().display()));
        }
    }
    assert!(texts > 0, "the title stands in a picture");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    if no_terminal {
        ignore("pages, pictures and pipes are well, but there is no script(1) to make a terminal");
    }
}

/// The bytes of a word for `printf` of a shell.
fn octal(word: &str) -> String {
    word.bytes().map(|byte| format!("\\{byte:03o}")).collect()
}

fn text_of(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// What drivers print at their start is not tabor's to say, in a shell that has nothing but its paths.
fn nothing_but_tabor_speaks() {
    let folder = scene(SCENE);
    let path = folder.path();
    let bare = |arguments: &[&str]| {
        let mut command = Command::new(binary::BINARY);
        command
            .current_dir(path)
            .args(arguments)
            .env_clear()
            .stdin(Stdio::null());
        for name in ["PATH", "HOME"] {
            if let Some(value) = std::env::var_os(name) {
                command.env(name, value);
            }
        }
        command.output().expect("the binary runs")
    };
    let ours = |line: &str| {
        ["note: ", "warning: ", "error: "]
            .iter()
            .any(|head| line.starts_with(head))
            && !line.contains("XDG_RUNTIME_DIR")
    };
    let gpu = ["--backend", "gpu", "--quiet"];
    for call in [
        &["devices"][..],
        &[&["run", "scene.toml", "--out", "gpu"], &gpu[..]].concat(),
        &[
            "run",
            "scene.toml",
            "--out",
            "auto",
            "--quiet",
            "--set",
            "grid.points=256",
        ],
        &["check", "scene.toml", "--set", "solver.backend=gpu"],
        &["compare", "scene.toml"],
        &["accuracy", "scene.toml", "--set", "grid.points=8"],
        &[
            "accuracy",
            "scene.toml",
            "--quiet",
            "--budget",
            "1 s",
            "--out",
            "study",
        ],
    ] {
        let output = bare(call);
        let said = text(&output.stderr);
        assert!(said.lines().all(ours), "{call:?}: {said}");
    }
}

/// The loader of Vulkan says on request what it does: where no adapter can be used it is not even loaded.
#[cfg(target_os = "linux")]
fn no_adapter_is_asked_for_where_none_can_be_used() {
    let folder = scene(SCENE);
    let loader_spoke = |call: &[&str]| {
        let output = binary::command(folder.path(), call)
            .env("VK_LOADER_DEBUG", "all")
            .output()
            .expect("the binary runs");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        said.contains("Vulkan Loader") || said.contains("LAYER:") || said.contains("DRIVER:")
    };
    if !loader_spoke(&["devices", "--verbose"]) {
        ignore("no loader of Vulkan that speaks");
    }
    assert!(!loader_spoke(&["devices"]), "heard without --verbose");
    for call in [
        &["run", "scene.toml", "--verbose", "--out", "small"][..],
        &[
            "run",
            "scene.toml",
            "--verbose",
            "--out",
            "cpu",
            "--set",
            "grid.points=256",
            "--backend",
            "cpu",
        ],
        // No transform on an adapter.
        &[
            "run",
            "scene.toml",
            "--verbose",
            "--out",
            "odd",
            "--set",
            "grid.points=[1024, 65]",
        ],
        &[
            "run",
            "scene.toml",
            "--verbose",
            "--out",
            "seventh",
            "--backend",
            "gpu",
            "--set",
            "grid.points=11",
        ],
        &["check", "scene.toml", "--verbose"],
        &[
            "check",
            "scene.toml",
            "--verbose",
            "--set",
            "grid.points=1024",
        ],
        &["compare", "scene.toml", "--verbose"],
        &[
            "accuracy",
            "scene.toml",
            "--verbose",
            "--set",
            "grid.points=8",
        ],
        &["accuracy", "absent.toml", "--verbose"],
        &["surface", "scene.toml"],
        &[
            "theory",
            "hertz",
            "--radius",
            "1e-6",
            "--contact_modulus",
            "1e9",
        ],
        &["man"],
    ] {
        assert!(!loader_spoke(call), "{call:?}");
    }
}

/// Nobody reads on: no panic, and no failure, for nothing is lost.
#[cfg(unix)]
fn a_reader_that_leaves_is_no_failure() {
    let folder = scene(SCENE);
    let path = folder.path();
    let shell = |line: &str| {
        Command::new("bash")
            .current_dir(path)
            .env("TABOR", binary::BINARY)
            .args(["-c", &format!("set -o pipefail; {line}")])
            .stdin(Stdio::null())
            .output()
    };
    if shell("true").is_err() {
        ignore("no bash");
    }
    let hertz = "theory hertz --radius 1e-6 --contact_modulus 1e9";
    for line in [
        &format!("\"$TABOR\" {hertz} | head -1")[..],
        &format!("\"$TABOR\" {hertz} | (exec <&-; sleep 0.3)"),
        "\"$TABOR\" theory | (exec <&-; sleep 0.3)",
        "\"$TABOR\" check scene.toml | (exec <&-; sleep 0.3)",
        "\"$TABOR\" devices | (exec <&-; sleep 0.3)",
        "\"$TABOR\" man | (exec <&-; sleep 0.3)",
        "\"$TABOR\" completions bash | (exec <&-; sleep 0.3)",
        "\"$TABOR\" --help | (exec <&-; sleep 0.3)",
        "\"$TABOR\" surface scene.toml --out s | (exec <&-; sleep 0.3)",
        "\"$TABOR\" run scene.toml --out r 2>&1 | (exec <&-; sleep 0.3)",
        "\"$TABOR\" check scene.toml --set surface.0.radius=1e-8 2>&1 | (exec <&-; sleep 0.3)",
        "\"$TABOR\" compare scene.toml --out c 2>&1 | (exec <&-; sleep 0.3); true",
    ] {
        let output = shell(line).expect("it ran before");
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{line}: {said}");
        assert_eq!(said, "", "{line}");
    }
    for written in ["s/psd.csv", "r/summary.json", "r/report.html"] {
        assert!(path.join(written).exists(), "{written}");
    }
}

/// A limit on the length of files is met like a full disk: a sentence and 1, not an end by a signal.
#[cfg(unix)]
fn a_limit_on_files_ends_with_a_sentence() {
    let folder = scene(SCENE);
    let run = |limit: &str, line: &str| {
        Command::new("bash")
            .current_dir(folder.path())
            .env("TABOR", binary::BINARY)
            .args(["-c", &format!("ulimit -f {limit}; {line}")])
            .stdin(Stdio::null())
            .output()
    };
    if run("1000", "true").is_err() {
        ignore("no bash");
    }
    for (limit, line, named) in [
        (
            "0",
            "\"$TABOR\" run scene.toml --out none",
            "cannot write none",
        ),
        (
            "1",
            "\"$TABOR\" run scene.toml --out one --set 'output={ images = [\"gap\"] }'",
            "cannot write one",
        ),
        (
            "0",
            "\"$TABOR\" theory hertz --radius 1e-6 --contact_modulus 1e9 > table.csv",
            "cannot print",
        ),
        ("1", "\"$TABOR\" man pages", "cannot write pages"),
        (
            "1",
            "\"$TABOR\" surface scene.toml --out s",
            "cannot write s",
        ),
    ] {
        let output = run(limit, line).expect("it ran before");
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{line}: {said}");
        assert!(said.contains(&format!("error: {named}")), "{line}: {said}");
    }
}

fn a_quiet_run_says_nothing_but_warnings_and_errors() {
    let folder = scene(SCENE);
    let loud = tabor(folder.path(), &["run", "scene.toml", "--out", "loud"]);
    assert_eq!(loud.status.code(), Some(0), "{}", text(&loud.stderr));
    assert!(
        text(&loud.stderr).contains("contact"),
        "a table of the steps"
    );
    let quiet = tabor(
        folder.path(),
        &["run", "scene.toml", "--out", "quiet", "--quiet"],
    );
    assert_eq!(quiet.status.code(), Some(0));
    assert_eq!(
        (text(&quiet.stdout), text(&quiet.stderr)),
        (String::new(), String::new())
    );
    let warned = [
        "run",
        "scene.toml",
        "--out",
        "warned",
        "--quiet",
        "--set",
        "surface.0.centre=[1, 1]",
        "--set",
        "grid.boundary=free",
        "--set",
        "loading={ control = 'approach', path = [-1] }",
    ];
    let warned = tabor(folder.path(), &warned);
    assert_eq!(warned.status.code(), Some(0), "{}", text(&warned.stderr));
    assert!(text(&warned.stderr).contains("lies outside of the free grid"));
    assert!(
        text(&warned.stderr)
            .lines()
            .all(|line| line.starts_with("warning: "))
    );
    let failed = tabor(folder.path(), &["run", "absent.toml", "--quiet"]);
    assert!(text(&failed.stderr).starts_with("error: absent.toml: cannot be read: "));
}

/// A `--set`, and the line of the check that shows that it arrived.
#[rustfmt::skip] // one call a line
fn values_of_set_arrive_as_they_are_written() {
    let folder = scene(SCENE);
    for (set, line) in [
        ("grid.points=32", "32 x 32 points"),
        (" grid.points = 32 ", "32 x 32 points"),
        ("grid.points=[32, 8]", "32 x 8 points"),
        ("grid.size=2 um", "2 µm x 2 µm"),
        ("grid.size=\"2 um\"", "2 µm x 2 µm"),
        ("grid.size='2 um'", "2 µm x 2 µm"),
        ("grid.size=2 µm", "2 µm x 2 µm"),
        ("grid.size=0.002mm", "2 µm x 2 µm"),
        ("grid.size=2e-6", "2 µm x 2 µm"),
        ("grid.size=[\"2 um\", 1e-6]", "2 µm x 1 µm"),
        ("loading.path=[\"1 MPa\", 2e6, 0]", "pressure, 3 steps"),
        ("loading.path.1=-3e5", "pressure, 2 steps"),
        ("surface=[{ kind = \"flat\" }]", "rms height 0 m"),
        ("surface.0={ kind = 'wavy', amplitude = '1 nm', wavelength = '1 um' }", "rms height 707.1 pm"),
        ("surface.0.radius=+2.5e-6", "grid "),
        ("title=a = b, \"c\"", "grid "),
        ("title=", "grid "),
        ("adhesion={ law = 'exponential', work_of_adhesion = '50 mJ/m²', range = '10 nm' }", "exponential: work of adhesion 50 mJ/m^2, range 10 nm"),
    ] {
        let output = tabor(folder.path(), &["check", "scene.toml", "--set", set]);
        assert_eq!(output.status.code(), Some(0), "{set}: {}", text(&output.stderr));
        let found = text(&output.stdout);
        assert!(found.contains(line), "{set} gave\n{found}\nand not {line}");
    }
    for (set, message) in [
        ("grid.points", "write KEY=VALUE, as in --set grid.points=256"),
        ("=3", "write KEY=VALUE"),
        ("", "write KEY=VALUE"),
        ("grid.points=", "from --set: grid.points: the text \"\" where a whole number is expected"),
        ("grid.points=32 # a comment", "from --set: grid.points: "),
        ("grid.points=[32, ]]", "from --set: grid.points: not valid TOML"),
        ("grid.size=\"2 um", "from --set: grid.size: not valid TOML"),
        ("grid.size=1979-05-27", "from --set: grid.size: the date 1979-05-27 where a length in m is expected"),
        ("adhesion={ law = 'jkr', work_of_adhesion = 0.05, range = 1e-8 }", "scene.toml, from --set: adhesion.law: \"jkr\" is not one of"),
        ("surface=[{ kind = 'wavy', amplitude = '1 N', wavelength = 1e-6 }]", "scene.toml, from --set: surface.0.amplitude: \"N\" is a force"),
        ("surface=flat", "from --set: surface: the text \"flat\" where an array of tables is expected"),
        ("surface.0=flat", "the text \"flat\" where a table is expected"),
        ("loading.path=1 MPa, 2 MPa", "from --set: loading.path: the text \"1 MPa, 2 MPa\" where a list of values is expected"),
    ] {
        let output = tabor(folder.path(), &["check", "scene.toml", "--set", set]);
        assert_eq!(output.status.code(), Some(2), "{set}: {}", text(&output.stderr));
        let found = text(&output.stderr);
        assert!(found.contains(message), "{set} gave\n{found}\nand not {message}");
    }
}

tests![
    completions_name_every_command,
    bash_takes_its_completions,
    man_pages_are_one_a_command,
    without_a_terminal_there_is_no_colour,
    #[cfg(target_os = "linux")]
    on_a_terminal_colour_is_the_users_choice,
    #[cfg(target_os = "linux")]
    nothing_from_outside_acts_on_a_terminal_or_a_page,
    nothing_but_tabor_speaks,
    #[cfg(target_os = "linux")]
    no_adapter_is_asked_for_where_none_can_be_used,
    #[cfg(unix)]
    a_reader_that_leaves_is_no_failure,
    #[cfg(unix)]
    a_limit_on_files_ends_with_a_sentence,
    a_quiet_run_says_nothing_but_warnings_and_errors,
    values_of_set_arrive_as_they_are_written,
];
