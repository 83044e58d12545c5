//! What a scene costs, derived from its effects and compared with what the solver plans on a
//! counting backend: an effect that is not named costs nothing.

use std::fs;
use std::path::Path;

use tabor::backend::dry_run::{Allocation, Place};
use tabor::effect::Effect;
use tabor::grid::Grid;
use tabor::law::Law;
use tabor::scene::{AdhesionScene, Boundary, Control, Precision, Scene, Treatment};
use tabor::solver::good_size;
use tabor::study::{Cost, Setup};
use tabor::surface::Surface;

fn setup(scene: Scene) -> Setup {
    let surface = Surface::build(&scene).unwrap_or_else(|error| panic!("{error}"));
    Setup::new(scene, surface)
}

fn shipped_scenes() -> Vec<(String, Scene)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes");
    let mut scenes: Vec<(String, Scene)> = fs::read_dir(&folder)
        .expect("the folder of scenes is there")
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .map(|path| {
            let scene = Scene::read(&path, &[]).unwrap_or_else(|errors| panic!("{errors}"));
            (path.display().to_string(), scene)
        })
        .collect();
    scenes.sort_by(|a, b| a.0.cmp(&b.0));
    assert!(scenes.len() >= 2);
    scenes
}

/// What the solver is told by the scene alone.
struct Expected {
    fields: Vec<&'static str>,
    /// Fields that the host keeps between the steps.
    history: usize,
    passes: Vec<&'static str>,
    points: [usize; 2],
}

fn expected(scene: &Scene, grid: Grid, law: &Law) -> Expected {
    let pixel = grid.dx().max(grid.dy());
    let grid = [grid.nx, grid.ny];
    let free = scene.grid.boundary == Boundary::Free;
    let points = if free {
        grid.map(|n| good_size(2 * n - 1))
    } else {
        grid
    };
    // The DMT treatment solves the contact without the law.
    let solved_law = scene
        .adhesion
        .as_ref()
        .filter(|adhesion| adhesion.treatment == Treatment::Full)
        .map(|adhesion| adhesion.law.name());
    let core = solved_law == Some("lennard-jones");
    let tail = match solved_law {
        None => false,
        Some("maugis-dugdale") => scene
            .adhesion
            .as_ref()
            .is_some_and(|a| a.taper != Some(0.0)),
        Some(_) => true,
    };
    let held = !free
        && match scene.loading.control {
            Control::MeanGap => true,
            // What yields in series with the surfaces turns an approach into a load.
            Control::Approach => {
                scene.loading.spring.is_none()
                    && scene
                        .solid
                        .layer
                        .is_none_or(|layer| layer.poisson_ratio == 0.5)
            }
            _ => false,
        };
    let levels = levels(points, scene);
    let depth = levels.len();

    let mut fields = vec![
        "heights",
        "gap",
        "pressure",
        "direction",
        "previous_residual",
    ];
    if core {
        fields.push("step");
    }
    let hard = scene.solid.hardness.is_some();
    // A trial that is scaled back to the mean gap by linearity takes what the heights alone would press.
    let linear = held && !core && !hard;
    if linear {
        fields.push("heights_pressure");
    }
    let factored = |a: &AdhesionScene| a.map.is_some() || a.rate.is_some();
    if solved_law.is_some() && scene.adhesion.as_ref().is_some_and(factored) {
        fields.push("law_factor");
    }
    // A second sweep where an attraction falls with the gap from a wall on, no more steeply than the pixels resolve, has a
    // residual of its own.
    let resolved = scene.solid.contact_modulus / (3.0 * pixel) >= 0.5 * law.steepest_fall();
    let softens = depth > 0 && tail && !core && resolved;
    if softens {
        fields.push("softened_residual");
    }
    if depth > 0 {
        fields.extend(["projected_residual", "share", "weight", "coarsest_z"]);
        fields.extend(vec!["restricted"; depth]);
    }
    // What a viscoelastic solid carries: its displacement and the spring of each branch.
    let branches = scene.solid.relaxation.len();
    // The plastic depth, as the path keeps it and as the solver does.
    let history = if branches > 0 { branches + 1 } else { 0 } + if hard { 2 } else { 0 };
    let mut passes: Vec<&'static str> = Vec::new();
    if depth > 0 {
        passes.extend(vec!["coarsen"; depth]);
        passes.extend([
            "free_share",
            "load_field",
            "multiply",
            "weigh",
            "multiply",
            "store_weighted",
        ]);
        passes.extend(vec!["refine"; depth - 1]);
        if softens {
            passes.extend(["soften", "store_retained"]);
            passes.extend(vec!["coarsen"; depth]);
            passes.extend(["load_weighted", "multiply", "store_weighted"]);
            passes.extend(vec!["refine"; depth - 1]);
        }
        passes.push("level_descent");
    } else {
        passes.extend(["multiply", "descent"]);
    }
    if held && (core || hard) {
        passes.extend(["direction", "load_trial"]);
    } else {
        passes.push("trial");
    }
    passes.push("multiply");
    if tail {
        passes.push("search");
    }
    if held {
        passes.extend(["advance", "load_residual"]);
    } else {
        passes.push("update_state");
    }
    Expected {
        fields,
        history,
        passes,
        points,
    }
}

/// Points of the coarser levels of the preconditioner: halved while an even number remains, eight at
/// least, three times at most.
fn levels(points: [usize; 2], scene: &Scene) -> Vec<[usize; 2]> {
    // None of these scenes has pixels more than twice as long as wide, and none a thin layer.
    assert!(scene.solid.layer.is_none_or(|layer| layer.thickness > 0.0));
    let halved = (1..=3).map(|times| points.map(|n| n >> times));
    let fits = |level: &[usize; 2]| level.iter().all(|n| n % 2 == 0 && *n >= 8);
    let exact = |times: usize| points.iter().all(|n| n % (1 << times) == 0);
    (1..)
        .zip(halved)
        .take_while(|(times, level)| exact(*times) && fits(level))
        .map(|(_, level)| level)
        .collect()
}

/// In double precision, whatever `auto` takes on the scene's grid.
fn check(name: &str, scene: &Scene) {
    let mut scene = scene.clone();
    scene.solver.precision = Precision::Double;
    let scene = &scene;
    let setup = setup(scene.clone());
    let cost = Cost::for_setup(&setup).unwrap_or_else(|error| panic!("{name}: {error}"));
    let grid = setup.surface.grid;
    let expected = expected(scene, grid, &setup.law);
    assert_eq!(cost.points, expected.points, "{name}");
    assert_eq!(cost.passes, expected.passes, "{name}");
    let history = expected.history * expected.points[0] * expected.points[1] * 8;
    assert_eq!(cost.history_bytes(), history, "{name}");
    // The compliance of all waves is tabulated where a conductance is asked, and nowhere else.
    let tabulated = cost.spectra.iter().any(|held| held.name == "compliance");
    assert_eq!(tabulated, scene.tables.conductance.is_some(), "{name}");
    let mut names: Vec<&str> = cost.fields.iter().map(|field| field.name).collect();
    let mut wanted = expected.fields.clone();
    names.sort_unstable();
    wanted.sort_unstable();
    assert_eq!(names, wanted, "{name}");
    let fine = expected.points[0] * expected.points[1] * 8;
    let coarser = levels(expected.points, scene);
    let bytes = |points: &[usize; 2]| points[0] * points[1] * 8;
    let mut restricted = coarser.iter().map(bytes);
    // Beside iterations in single precision the state in double takes it too.
    let mut mixed = scene.clone();
    mixed.solver.precision = Precision::Mixed;
    let beside = Cost::for_scene(&mixed, grid, Place::Single)
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    let taken = |held: &[Allocation]| held.iter().any(|held| held.name == "heights_pressure");
    assert!(!beside.reference.is_empty() || scene.solid.hardness.is_some());
    assert_eq!(taken(&beside.reference), taken(&cost.fields), "{name}");
    for field in &cost.fields {
        let expected = match field.name {
            "restricted" => restricted.next().unwrap_or(0),
            "share" | "weight" | "coarsest_z" => coarser.last().map_or(0, bytes),
            _ => fine,
        };
        assert_eq!(field.bytes, expected, "{name}: {}", field.name);
    }
}

#[test]
fn every_shipped_scene_costs_what_its_effects_say() {
    for (name, scene) in shipped_scenes() {
        check(&name, &scene);
        for effect in Effect::ALL {
            if effect.is_on(&scene) {
                check(
                    &format!("{name} without {}", effect.name()),
                    &effect.removed_from(&scene),
                );
            }
        }
    }
}

/// Every law, both boundaries and every control, whether a shipped scene has them or not.
#[test]
fn every_combination_of_effects() {
    let mut count = 0;
    for (boundary, layer) in [
        ("periodic", ""),
        ("periodic", "hardness = 0.5\n"),
        ("free", "hardness = 0.5\n"),
        ("periodic", "poisson_ratio = 0.3\nthickness = 1.0\n"),
        ("periodic", "poisson_ratio = 0.5\nthickness = 1.0\n"),
        ("free", ""),
    ] {
        for adhesion in [
            "",
            "law = \"maugis-dugdale\"\nrange = 0.1",
            "law = \"maugis-dugdale\"\nrange = 0.1\ntaper = 0",
            "law = \"exponential\"\nrange = 0.1",
            "law = \"lennard-jones\"\nrange = 0.1",
            "law = \"lennard-jones\"\nrange = 0.1\ntreatment = \"dmt\"",
            "law = \"exponential\"\nrange = 0.1\nmap = { pattern = \"stripe\", period = 1.0, low = 0.5, high = 1.0 }",
        ] {
            for control in [
                "control = \"pressure\"\npath = [1e-3]",
                "control = \"force\"\npath = [1e-3]",
                "control = \"approach\"\npath = [1e-3]",
                "control = \"approach\"\npath = [1e-3]\nspring = 1.0",
                "control = \"mean-gap\"\npath = [1.0]",
            ] {
                let free_refuses = control.contains("pressure") || control.contains("mean-gap");
                if boundary == "free" && free_refuses {
                    continue;
                }
                let adhesion = if adhesion.is_empty() {
                    String::new()
                } else {
                    format!("[adhesion]\nwork_of_adhesion = 0.01\n{adhesion}\n")
                };
                let text = format!(
                    "[grid]\npoints = [40, 36]\nsize = [4.0, 3.6]\nboundary = \"{boundary}\"\n[solid]\ncontact_modulus = 1.0\n{layer}[[surface]]\nkind = \"sphere\"\nradius = 10.0\n{adhesion}[loading]\n{control}\n"
                );
                let scene = Scene::parse(&text, "test.toml", Path::new("."), &[]);
                // What this version refuses, it refuses by name.
                match scene {
                    Ok(scene) => {
                        check(&text, &scene);
                        count += 1;
                    }
                    Err(errors) => assert!(
                        errors.to_string().contains("not in this version")
                            || errors
                                .to_string()
                                .contains("does not determine the plastic depth"),
                        "{errors}"
                    ),
                }
            }
        }
    }
    assert!(count >= 90, "{count}");
}

/// On a graphics processor a periodic half-space has no tables but those of the coarsest level; a
/// layer and a free boundary have that of their stiffness, and with adhesion of its inverse.
#[test]
fn a_half_space_has_no_tables_on_a_graphics_processor() {
    let tables = |grid: &str, solid: &str, adhesion: &str, place: Place| -> Vec<&'static str> {
        let text = format!(
            "[grid]\npoints = 40\nsize = 4.0\n{grid}[solid]\ncontact_modulus = 1.0\n{solid}[[surface]]\nkind = \"sphere\"\nradius = 10.0\n{adhesion}[loading]\ncontrol = \"force\"\npath = [1e-3]\n"
        );
        let scene = Scene::parse(&text, "test.toml", Path::new("."), &[])
            .unwrap_or_else(|errors| panic!("{errors}"));
        let grid = Grid::new([40, 40], [4.0, 4.0]);
        let cost = Cost::for_scene(&scene, grid, place).unwrap_or_else(|error| panic!("{error}"));
        cost.spectra.iter().map(|held| held.name).collect()
    };
    let adhesion = "[adhesion]\nlaw = \"exponential\"\nwork_of_adhesion = 0.01\nrange = 0.1\n";
    let layer = "poisson_ratio = 0.3\nthickness = 1.0\n";
    let free = "boundary = \"free\"\n";
    let all = [
        "stiffness",
        "smoothing",
        "coarsest_compliance",
        "preconditioner",
    ];
    for place in [Place::Gpu, Place::GpuDouble] {
        assert_eq!(tables("", "", adhesion, place), all[1..3]);
        assert_eq!(tables("", "", "", place), all[1..3]);
        assert_eq!(tables("", layer, "", place), all[..3]);
        assert_eq!(tables("", layer, adhesion, place), all);
        assert_eq!(tables(free, "", adhesion, place), all);
    }
    assert_eq!(tables("", "", adhesion, Place::Single), all);
}

/// The law of a scene without adhesion is the hard wall, not a law of zero strength.
#[test]
fn no_adhesion_is_no_law() {
    for (_, scene) in shipped_scenes() {
        let adhesion = Effect::from_name("adhesion").expect("an effect");
        let setup = setup(adhesion.removed_from(&scene));
        assert_eq!(setup.law, Law::HardWall);
        assert!(setup.regime.is_none());
    }
}
