//! The command line: arguments, messages, exit statuses.

mod accuracy;
#[cfg(test)]
mod busy;
mod check;
mod compare;
mod devices;
mod failure;
mod file_limit;
mod fit;
mod fit_folder;
mod flags;
mod interrupts;
mod launcher;
#[cfg(feature = "netcdf")]
mod netcdf;
mod new;
mod patience;
mod plot;
mod progress;
mod quantity;
mod run;
mod shell;
mod surface;
mod sweep;
mod table;
mod theory;
#[cfg(all(feature = "mpi", unix))]
mod watched_rank;

use std::ffi::OsString;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand};

use failure::Failure;

use crate::output::{OutputError, expect_apart, visible, visible_line};
use crate::scene::{BackendName, Precision, Scene};
use crate::surface::SurfaceError;

/// Adhesive contact of rough surfaces, solved as a full field.
#[derive(Debug, Parser)]
#[command(name = "tabor", version, about, propagate_version = true)]
#[command(
    after_help = "Example:\n  tabor run examples/scenes/rough.toml --out rough\n  tabor check examples/scenes/rough.toml"
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Write a commented scene to begin with
    #[command(after_help = "Example:\n  tabor new rough mine\n  tabor run mine/scene.toml")]
    New(new::NewArguments),
    /// Solve every step of a scene and write its results
    #[command(
        after_help = "Example:\n  tabor run examples/scenes/sphere_pull_off.toml --out pull_off --set grid.points=256\n  tabor run examples/scenes/sphere_pull_off.toml --out pull_off --set grid.points=256 --resume"
    )]
    Run(RunArguments),
    /// Read a scene and say what it would do and cost, without solving it
    #[command(after_help = "Example:\n  tabor check examples/scenes/rough.toml")]
    Check(CheckArguments),
    /// Statistics of a scene's surface or of a height file, and the self-affine surface like it
    #[command(
        after_help = "Prints a table that is also the beginning of a scene, and writes pictures, tables and scene.toml; of a file also measured.toml, a scene of the map itself, with what --set says.\n\nExample:\n  tabor surface examples/scenes/ground.toml --out ground_surface\n  tabor surface map.gwy --detrend plane > scene.toml"
    )]
    Surface(surface::SurfaceArguments),
    /// Tabulate an analytic model as CSV; alone, list the models with their parameters
    #[command(
        disable_help_flag = true,
        override_usage = "tabor theory [NAME [--KEY VALUE ...]]",
        after_help = "Values are in SI, or text with a unit: --radius \"1 um\".\n`tabor theory` lists the models, `tabor theory NAME --help` explains one.\n\nExample:\n  tabor theory jkr --radius \"1 um\" --contact_modulus \"1 MPa\" --work_of_adhesion \"50 mJ/m^2\" > jkr.csv"
    )]
    Theory(TheoryArguments),
    /// The same surface through full field, DMT, ICHA, Persson, GW-M and BAM
    #[command(after_help = "Example:\n  tabor compare examples/scenes/dmt.toml --out compared")]
    Compare(CompareArguments),
    /// What accuracy costs: a scene over grids, tolerances, precisions, steps and models
    #[command(
        after_help = "Writes accuracy.csv and accuracy.png, and names the cheapest setting for 10 %, 1 % and 0.1 %. More in docs/accuracy.md.\n\nExample:\n  tabor accuracy examples/scenes/rough.toml --budget \"5 min\" --set grid.points=256"
    )]
    Accuracy(accuracy::AccuracyArguments),
    /// Work of adhesion and modulus from a force curve of a sphere
    #[command(
        after_help = "The curve has columns approach (positive closer) and force (positive in compression), in SI or\nwith the unit in the head: `approach [nm], force [nN]`. More in docs/fit.md.\n\nExamples:\n  tabor fit examples/force_curve.csv --radius \"10 um\" --out fit\n  tabor fit examples/force_curve.csv --radius \"10 um\" --advise\n  tabor fit --radius \"10 um\" --pull-off \"2 uN\" --stiffness \"30 N/m\""
    )]
    Fit(fit::FitArguments),
    /// Many runs: a scene over values of its keys, into one table
    #[command(
        after_help = "Writes sweep.csv (one row a case and step), runs.csv (one row a case), and means.csv, means.png and means.svg. A study that was interrupted continues where it was. More in docs/sweep.md.\n\nExample:\n  tabor sweep examples/studies/roughness.toml --out roughness --jobs 2\n  tabor sweep examples/studies/roughness.toml --list"
    )]
    Sweep(sweep::SweepArguments),
    /// Several runs in one picture, as PNG, SVG and CSV
    #[command(
        after_help = "Example:\n  tabor plot rough smooth --out rough_and_smooth.png\n  tabor plot rough/curve.csv smooth/curve.csv --x mean_pressure --y contact_area_fraction"
    )]
    Plot(plot::PlotArguments),
    /// A run as one netCDF file: curve, fields, units and scene
    #[cfg(feature = "netcdf")]
    #[command(
        after_help = "xarray and ParaView open it. More in docs/results.md.\n\nExample:\n  tabor netcdf rough --out rough.nc"
    )]
    Netcdf(netcdf::NetcdfArguments),
    /// Adapters found, what each can do, and which one `auto` takes
    #[command(after_help = "Example:\n  tabor devices")]
    Devices {
        /// Let graphics drivers say what they say at their start
        #[arg(long)]
        verbose: bool,
    },
    /// Print the completions of a shell
    #[command(
        after_help = "Example:\n  tabor completions bash > ~/.local/share/bash-completion/completions/tabor"
    )]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Print the man page, or write one a command into a folder
    #[command(after_help = "Example:\n  tabor man | man -l -\n  tabor man ~/.local/share/man/man1")]
    Man {
        /// Folder for the pages
        folder: Option<PathBuf>,
    },
}

/// The scene of a call.
#[derive(Clone, Debug, Args)]
struct SceneArguments {
    /// The scene, a TOML file
    #[arg(value_name = "SCENE")]
    path: PathBuf,
    /// Override a key of the scene, as in surface.0.hurst=0.4; may be repeated
    // After the other options in the help.
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_and_value, display_order = 900)]
    set: Vec<(String, String)>,
}

impl SceneArguments {
    /// Reads the scene with its overrides.
    fn read(&self) -> Result<Scene, Failure> {
        Ok(Scene::read(&self.path, &self.set)?)
    }

    /// Refuses outputs that would overwrite the scene or a file that it reads.
    fn expect_apart(
        &self,
        scene: &Scene,
        outputs: impl IntoIterator<Item = PathBuf>,
    ) -> Result<(), OutputError> {
        expect_apart(outputs, scene.files().chain([self.path.as_path()]))
    }

    /// A surface of this scene that cannot be built.
    fn surface_failure(&self, error: SurfaceError) -> Failure {
        let path = self.path.clone();
        Failure::Surface { path, error }
    }
}

#[derive(Clone, Debug, Args)]
struct RunArguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Folder for the results [default: the scene's name, in the current folder]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Where the arithmetic runs
    #[arg(long, value_parser = one_of(BackendName::ALL, BackendName::name))]
    backend: Option<String>,
    /// Arithmetic
    #[arg(long, value_parser = one_of(Precision::ALL, Precision::name))]
    precision: Option<String>,
    /// Threads [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Continue after the last finished step of an earlier run in this folder
    #[arg(long)]
    resume: bool,
    /// No progress; warnings and errors are still said
    #[arg(long)]
    quiet: bool,
    /// Let graphics drivers say what they say at their start
    #[arg(long)]
    verbose: bool,
}

#[derive(Debug, Args)]
struct CheckArguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Also say what each of so many MPI ranks takes (docs/cluster.md)
    #[arg(long, value_name = "P", value_parser = clap::value_parser!(u16).range(1..))]
    ranks: Option<u16>,
    /// Also list the solver's fields and kernels, the effects that are off, and messages of graphics drivers
    #[arg(long)]
    verbose: bool,
}

#[derive(Debug, Args)]
struct CompareArguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Folder for compare.csv and compare.png [default: the scene's name with _compare]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Let graphics drivers say what they say at their start
    #[arg(long)]
    verbose: bool,
}

#[derive(Debug, Args)]
struct TheoryArguments {
    /// The model, and its parameters as --KEY VALUE
    // Which parameters there are depends on the model, so clap leaves them to `theory`.
    #[arg(
        trailing_var_arg = true,
        allow_hyphen_values = true,
        value_name = "NAME"
    )]
    words: Vec<String>,
}

impl RunArguments {
    /// The scene with all that the call changes in it.
    fn read(&self) -> Result<Scene, Failure> {
        let mut scene = self.scene.clone();
        for (key, word) in [("backend", &self.backend), ("precision", &self.precision)] {
            let word = word.iter().map(|word| format!("\"{word}\""));
            scene
                .set
                .extend(word.map(|word| (format!("solver.{key}"), word)));
        }
        scene.read()
    }
}

/// One of the words of a list, as clap takes it.
fn one_of<T: Copy>(all: &[T], name: fn(T) -> &'static str) -> PossibleValuesParser {
    PossibleValuesParser::new(all.iter().map(|one| name(*one)))
}

/// The folder of the call, or the name of the file that it is about with `suffix`, in the current folder.
fn folder_or_default(asked: Option<&Path>, file: &Path, suffix: &str) -> PathBuf {
    asked.map_or_else(
        || {
            let mut name = file.file_stem().unwrap_or(file.as_os_str()).to_owned();
            name.push(suffix);
            PathBuf::from(name)
        },
        Path::to_path_buf,
    )
}

fn key_and_value(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() => {
            Ok((key.trim().to_owned(), value.trim().to_owned()))
        }
        _ => Err("write KEY=VALUE, as in --set grid.points=256".to_owned()),
    }
}

/// What `tabor theory` prints for the words of a call.
///
/// # Errors
/// What it says of a wrong call, or of a model that has no answer.
pub fn theory_table(words: &[String]) -> Result<String, String> {
    theory::text(words).map_err(|failure| failure.to_string())
}

/// Runs the command line of this process and says how it ended.
pub fn main() -> ExitCode {
    ExitCode::from(main_with(std::env::args_os().collect()))
}

/// Runs the command line `words`, the program's name first, and returns its exit code. A wrong call and a request for
/// help end the process.
pub fn main_with(words: Vec<OsString>) -> u8 {
    file_limit::survive();
    let arguments = match Arguments::try_parse_from(&words) {
        Ok(arguments) => arguments,
        Err(error) => refuse_call(error, &words),
    };
    #[cfg(all(feature = "mpi", unix))]
    if let Command::Run(arguments) = &arguments.command {
        match watched_rank::wait(&arguments.scene.path) {
            Ok(None) => {}
            Ok(Some(status)) => return status,
            Err(failure) => {
                fail(&failure.to_string());
                return failure.status();
            }
        }
    }
    let done = match arguments.command {
        Command::New(arguments) => new::new(&arguments),
        Command::Run(arguments) => run::run(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Surface(arguments) => surface::surface(&arguments),
        Command::Theory(arguments) => theory::theory(&arguments),
        Command::Compare(arguments) => compare::compare(&arguments),
        Command::Accuracy(arguments) => accuracy::accuracy(&arguments),
        Command::Fit(arguments) => fit::fit(&arguments),
        Command::Sweep(arguments) => sweep::sweep(&arguments),
        Command::Plot(arguments) => plot::plot(&arguments),
        #[cfg(feature = "netcdf")]
        Command::Netcdf(arguments) => netcdf::netcdf(&arguments),
        Command::Devices { verbose } => devices::devices(verbose),
        Command::Completions { shell } => shell::completions(shell),
        Command::Man { folder } => shell::man(folder.as_deref()),
    };
    match done {
        Ok(()) => 0,
        Err(failure) => {
            match &failure {
                // One line a mistake; what a scene holds begins none.
                Failure::Scene(mistakes) => {
                    mistakes.lines().for_each(|line| fail(&visible_line(&line)));
                }
                // A mistake a line here too; texts from outside are quoted in them.
                Failure::Usage(mistakes) => mistakes.lines().for_each(fail),
                other => fail(&other.to_string()),
            }
            failure.status()
        }
    }
}

/// Prints clap's words on a wrong call, or its help, and ends with clap's status.
fn refuse_call(error: clap::Error, words: &[OsString]) -> ! {
    let words = || words.iter().map(|word| word.to_string_lossy().into_owned());
    // clap repeats what it was given. Where that would act on a terminal, it is told in words that do not.
    if words().any(|word| visible_line(&word) != word) {
        match Arguments::try_parse_from(words().map(|word| visible_line(&word))) {
            Err(safe) if safe.kind() == error.kind() => safe.exit(),
            // Spelled out, another mistake comes first, or none: no colours then.
            _ => {
                say(&error.render().to_string());
                std::process::exit(error.exit_code());
            }
        }
    }
    error.exit()
}

/// Prints a line on standard error, and what follows it on lines of their own further in, so that no text from
/// outside looks like a message. Where standard error is closed nobody is there to be told.
fn say(text: &str) {
    write_lines("", text);
}

/// The same, with `note:` before it.
fn note(text: &str) {
    write_lines("note: ", text);
}

/// The same, with `warning:` before it.
fn warn(text: &str) {
    write_lines("warning: ", text);
}

/// The same, with `error:` before it: red on a terminal, plain elsewhere and with NO_COLOR.
fn fail(text: &str) {
    let red = anstyle::AnsiColor::Red.on_default().bold();
    write_lines(&format!("{red}error:{red:#} "), text);
}

fn write_lines(head: &str, text: &str) {
    let text = visible(&flags::with_options(text)).replace('\n', "\n  ");
    let _ = writeln!(anstream::stderr(), "{head}{}", text.trim_end());
}

/// Writes text to standard output.
fn print(text: &str) -> Result<(), Failure> {
    print_bytes(visible(text).as_bytes())
}

/// Writes bytes of our own to standard output. A reader that has gone, as `head` does, had what it wanted.
fn print_bytes(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        done => done.map_err(Failure::Print),
    }
}
