//! What a hard case is: a contact, the path it is led along, and what must come of it.

use super::paths::Path;
use super::run::Run;

/// An attraction; `taper` is `None` for `auto`.
#[derive(Clone, Copy, Debug)]
pub enum Law {
    Wall,
    MaugisDugdale {
        work: f64,
        range: f64,
        taper: Option<f64>,
    },
    Exponential {
        work: f64,
        range: f64,
    },
    LennardJones {
        work: f64,
        range: f64,
    },
}

/// A contact of a surface with a half-space.
#[derive(Clone, Debug)]
pub struct Contact {
    pub points: [usize; 2],
    pub size: [f64; 2],
    pub free: bool,
    pub modulus: f64,
    pub law: Law,
}

/// What must hold of a run, besides equilibrium.
pub type Truth = Box<dyn Fn(&Run, &Path) + Sync + Send>;

/// A hard case.
pub struct Case {
    pub name: String,
    pub contact: Contact,
    /// The `[[surface]]` tables.
    pub surface: String,
    /// Height files that they name.
    pub files: Vec<(String, Vec<f64>)>,
    pub control: &'static str,
    pub path: Vec<f64>,
    pub max_iterations: usize,
    /// The tolerance to ask for in place of the path's own.
    pub tolerance: Option<f64>,
    /// Whether every step's fields are checked, or the last one's alone.
    pub every_step: bool,
    /// Whether other paths must come to the judge's numbers: not where equilibria lie so close
    /// that rounding picks one.
    pub compared: bool,
    pub truth: Option<Truth>,
    /// What a refusal must say, on the paths that must refuse it; all others must not.
    pub refused: fn(&Case, &Path) -> Option<Vec<String>>,
    /// A line of the scene, and what is written in its place.
    pub reworded: Option<(String, String)>,
}

impl Case {
    pub fn new(name: impl Into<String>, contact: Contact, surface: impl Into<String>) -> Self {
        Case {
            name: name.into(),
            contact,
            surface: surface.into(),
            files: Vec::new(),
            control: "pressure",
            path: Vec::new(),
            max_iterations: 3000,
            tolerance: None,
            every_step: true,
            compared: true,
            truth: None,
            refused: |case, path| {
                let below =
                    path.is_single() && case.tolerance.is_some_and(|asked| asked < path.tolerance);
                below.then(|| vec!["at least 1e-4".to_owned()])
            },
            reworded: None,
        }
    }

    pub fn under(mut self, control: &'static str, path: impl Into<Vec<f64>>) -> Self {
        (self.control, self.path) = (control, path.into());
        self
    }

    pub fn surfaced(mut self, surface: impl Into<String>) -> Self {
        self.surface = surface.into();
        self
    }

    pub fn with_file(mut self, name: &str, heights: Vec<f64>) -> Self {
        self.files.push((name.to_owned(), heights));
        self
    }

    pub fn to(mut self, tolerance: f64) -> Self {
        self.tolerance = Some(tolerance);
        self
    }

    pub fn last_step_only(mut self) -> Self {
        self.every_step = false;
        self
    }

    pub fn not_compared(mut self) -> Self {
        self.compared = false;
        self
    }

    pub fn so_that(mut self, truth: impl Fn(&Run, &Path) + Sync + Send + 'static) -> Self {
        self.truth = Some(Box::new(truth));
        self
    }

    pub fn reworded(mut self, line: String, instead: &str) -> Self {
        self.reworded = Some((line, instead.to_owned()));
        self
    }

    /// The tolerance asked on a path.
    pub fn tolerance(&self, path: &Path) -> f64 {
        self.tolerance.unwrap_or(path.tolerance)
    }

    /// The scene file. On a graphics processor, which may be software, a load that parts is looked for to a factor of 2
    /// and not to a hundredth: rows are the same bits either way (`pull_off::rows_stay_as_they_are`), and nothing is
    /// asked of the loads between them.
    pub fn scene(&self, path: &Path) -> String {
        let Contact {
            points: [nx, ny],
            size: [lx, ly],
            free,
            modulus,
            law,
        } = &self.contact;
        let text = format!(
            "[grid]\npoints = [{nx}, {ny}]\nsize = [{lx:e}, {ly:e}]\nboundary = \"{}\"\n\
             [solid]\ncontact_modulus = {modulus:e}\n{}\n{}\n\
             [loading]\ncontrol = \"{}\"\npath = [{}]\n{}\
             [solver]\ntolerance = {:e}\nmax_iterations = {}\n\
             [output]\nimages = []\nfields = [\"gap\", \"pressure\", \"heights\"]\nsteps = \"{}\"\n",
            if *free { "free" } else { "periodic" },
            self.surface,
            law.table(),
            self.control,
            self.path
                .iter()
                .map(|value| format!("{value:e}"))
                .collect::<Vec<_>>()
                .join(", "),
            match (path.backend, self.control) {
                ("gpu", "pressure" | "force") => "pull_off_tolerance = 0.5\n",
                _ => "",
            },
            self.tolerance(path),
            self.max_iterations,
            if self.every_step { "all" } else { "last" },
        );
        match &self.reworded {
            None => text,
            Some((line, instead)) => {
                assert!(text.contains(line), "{line} is not in {text}");
                text.replace(line, instead)
            }
        }
    }
}

impl Law {
    fn table(self) -> String {
        let (law, work, range, more) = match self {
            Law::Wall => return String::new(),
            Law::MaugisDugdale { work, range, taper } => {
                let more = taper.map(|taper| format!("taper = {taper:e}\n"));
                ("maugis-dugdale", work, range, more.unwrap_or_default())
            }
            Law::Exponential { work, range } => ("exponential", work, range, String::new()),
            Law::LennardJones { work, range } => ("lennard-jones", work, range, String::new()),
        };
        format!(
            "[adhesion]\nlaw = \"{law}\"\nwork_of_adhesion = {work:e}\nrange = {range:e}\n{more}"
        )
    }

    /// Attraction across a gap, from the laws as they are published and not from the code's own.
    pub fn traction(self, gap: f64, contact: &Contact) -> f64 {
        match self {
            Law::Wall => 0.0,
            Law::MaugisDugdale { work, range, taper } => {
                let peak = work / range;
                let width = taper.unwrap_or_else(|| {
                    let [dx, dy] = contact.pixel();
                    (6.0 * peak * dx.max(dy) / contact.modulus).min(2.0 * range)
                });
                if width > 0.0 {
                    peak * ((range + 0.5 * width - gap) / width).clamp(0.0, 1.0)
                } else if gap < range {
                    peak
                } else {
                    0.0
                }
            }
            Law::Exponential { work, range } => work / range * (-gap / range).exp(),
            Law::LennardJones { work, range } => {
                let near = range / (gap + range);
                8.0 * work / (3.0 * range) * (near.powi(3) - near.powi(9))
            }
        }
    }

    pub fn has_wall(self) -> bool {
        !matches!(self, Law::LennardJones { .. })
    }
}

impl Contact {
    /// A periodic square cell of side 1 and modulus 1.
    pub fn cell(points: usize, law: Law) -> Contact {
        Contact {
            points: [points; 2],
            size: [1.0; 2],
            free: false,
            modulus: 1.0,
            law,
        }
    }

    /// A window of a free half-space.
    pub fn window(points: usize, side: f64, modulus: f64, law: Law) -> Contact {
        Contact {
            points: [points; 2],
            size: [side; 2],
            free: true,
            modulus,
            law,
        }
    }

    pub fn pixel(&self) -> [f64; 2] {
        [0, 1].map(|i| self.size[i] / self.points[i] as f64)
    }

    pub fn count(&self) -> usize {
        self.points[0] * self.points[1]
    }
}
