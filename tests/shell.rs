//! The command line at home in a shell: completions, man pages, colour, quiet runs, and values of
//! `--set` as a shell hands them over.

mod shared;

use std::fs;
use std::process::{Command, Stdio};

use shared::{scene, tabor};

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

const COMMANDS: [&str; 10] = [
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
];

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

#[test]
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
    // The shell itself takes the script, where there is one.
    let script = tabor(folder.path(), &["completions", "bash"]).stdout;
    fs::write(folder.path().join("tabor.bash"), script).expect("a script");
    match Command::new("bash")
        .current_dir(folder.path())
        .args(["-c", ". ./tabor.bash && complete -p tabor"])
        .output()
    {
        Ok(output) => {
            assert!(output.status.success(), "{}", text(&output.stderr));
            assert!(text(&output.stdout).contains("_tabor"));
        }
        Err(_) => println!("skipped: no bash"),
    }
}

#[test]
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

#[test]
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
#[test]
#[cfg(target_os = "linux")]
fn on_a_terminal_colour_is_the_users_choice() {
    let folder = scene(SCENE);
    let on_a_terminal = |arguments: &str, no_color: Option<&str>| {
        let mut command = Command::new("script");
        command
            .current_dir(folder.path())
            .args([
                "-qec",
                &format!("{} {arguments}", shared::BINARY),
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
        println!("skipped: no script");
        return;
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

#[test]
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
#[test]
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
