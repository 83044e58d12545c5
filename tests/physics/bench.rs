//! Runs a scene through the library and keeps what it found.

use std::path::Path;

use tabor::backend::Backend;
use tabor::backend::cpu;
use tabor::kernel::Scalars;
use tabor::scene::Scene;
use tabor::study::{Evaluation, FinishedStep, Jump, Observer, Setup, StepRow, WalkEnd, walk};
use tabor::surface::Surface;

/// A finished step with its fields.
pub struct Step {
    pub row: StepRow,
    pub evaluation: Option<Evaluation>,
    pub jump: Option<Jump>,
}

#[derive(Default)]
struct Keep {
    steps: Vec<Step>,
    fields: bool,
}

impl Observer for Keep {
    type Error = std::convert::Infallible;

    fn step(&mut self, step: FinishedStep) -> Result<(), Self::Error> {
        self.steps.push(Step {
            row: step.row.clone(),
            evaluation: step.evaluation.filter(|_| self.fields),
            jump: step.jump,
        });
        Ok(())
    }

    fn iteration(&mut self, _step: usize, _scalars: &Scalars) -> bool {
        true
    }
}

/// A solved scene.
pub struct Solved {
    pub setup: Setup,
    pub steps: Vec<Step>,
    pub end: WalkEnd,
}

impl Solved {
    pub fn rows(&self) -> impl Iterator<Item = &StepRow> {
        self.steps.iter().map(|step| &step.row)
    }

    /// The fields of a step.
    pub fn fields(&self, index: usize) -> &Evaluation {
        self.steps[index]
            .evaluation
            .as_ref()
            .expect("the step has fields")
    }
}

/// The scene's problem, ready to solve.
pub fn setup(text: &str) -> Setup {
    let scene = Scene::parse(text, "test.toml", Path::new("."), &[])
        .unwrap_or_else(|errors| panic!("{errors}\n{text}"));
    let surface = Surface::build(&scene).unwrap_or_else(|error| panic!("{error}"));
    Setup::new(scene, surface)
}

pub fn cpu() -> Box<dyn Backend + Send> {
    cpu::double(None)
}

/// Makes the backends of a solve.
pub type Maker<'a> = &'a (dyn Fn() -> Box<dyn Backend + Send> + Sync);

fn run(text: &str, fields: bool, backend: Maker) -> Solved {
    let setup = setup(text);
    let mut keep = Keep {
        fields,
        ..Keep::default()
    };
    let end = walk(&setup, &|| backend(), &mut keep).unwrap_or_else(|error| panic!("{error}"));
    Solved {
        setup,
        steps: keep.steps,
        end,
    }
}

/// Solves a scene on backends of a kind and keeps every step's fields, whether the last step converges or not.
pub fn solve_on(text: &str, backend: Maker) -> Solved {
    run(text, true, backend)
}

/// Solves a scene and keeps every step's fields.
pub fn solve(text: &str) -> Solved {
    let solved = run(text, true, &cpu);
    assert!(
        solved.rows().all(|row| row.converged),
        "a step did not converge"
    );
    solved
}

/// Solves a scene and keeps its table.
pub fn solve_table(text: &str) -> Solved {
    let solved = run(text, false, &cpu);
    assert!(
        solved.rows().all(|row| row.converged),
        "a step did not converge"
    );
    solved
}
