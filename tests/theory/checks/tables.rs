//! The tables of `tests/reference` against the closed forms.

use std::path::Path;
use tabor::theory::lennard_jones_sphere::{self, LennardJonesSphere};
use tabor::theory::maugis_dugdale::{FOLD_LAMBDA, MaugisDugdale};
use tabor::theory::viscoelastic::Solid;
use tabor::theory::{Law, Sphere, dmt, hertz, jkr, tabor_map, westergaard};

/// A CSV file: the names of its columns and its rows, comments left out.
struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn read(name: &str) -> Table {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference");
        let text = std::fs::read_to_string(path.join(name)).expect("the table is readable");
        let mut lines = text
            .lines()
            .filter(|line| !line.starts_with('#') && !line.is_empty())
            .map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        let columns = lines.next().expect("the table has a head");
        Table {
            columns,
            rows: lines.collect(),
        }
    }

    fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|cells| Row { table: self, cells })
    }
}

struct Row<'a> {
    table: &'a Table,
    cells: &'a [String],
}

impl Row<'_> {
    fn text(&self, column: &str) -> &str {
        let place = self.table.columns.iter().position(|name| name == column);
        &self.cells[place.unwrap_or_else(|| panic!("no column {column}"))]
    }

    fn number(&self, column: &str) -> f64 {
        let text = self.text(column);
        text.parse().unwrap_or_else(|_| panic!("{column}: {text}"))
    }

    /// Compares with a column; the tables hold 12 digits.
    fn check(&self, column: &str, got: f64, relative: f64, absolute: f64) {
        let expected = self.number(column);
        assert!(
            (got - expected).abs() <= absolute + relative * expected.abs(),
            "{column}: got {got}, expected {expected}, in {:?}",
            self.cells
        );
    }
}

#[test]
fn jkr_curve() {
    for row in Table::read("jkr_curve.csv").rows() {
        let a = row.number("a_bar");
        row.check("F_bar", jkr::reduced_force(a), 1e-11, 1e-11);
        row.check("delta_bar", jkr::reduced_approach(a), 1e-11, 1e-11);
    }
    for row in Table::read("jkr_summary.csv").rows() {
        let a = match row.text("point") {
            "pulloff_force_control" => jkr::pull_off(),
            "pulloff_displacement_control" => jkr::grip(),
            "zero_load" => jkr::zero_load(),
            "zero_approach" => jkr::zero_approach(),
            other => panic!("no point {other}"),
        };
        row.check("a_bar", a, 1e-11, 0.0);
        row.check("F_bar", jkr::reduced_force(a), 1e-11, 1e-11);
        row.check("delta_bar", jkr::reduced_approach(a), 1e-11, 1e-11);
    }
}

#[test]
fn hertz_curve() {
    // A sphere whose Maugis units are 1: w R = 1/pi, K R = 1 with R = 1.
    let sphere = Sphere::new(1.0, 0.75, std::f64::consts::PI.recip()).expect("a sphere");
    for row in Table::read("hertz_dmtf_curve.csv").rows() {
        let a = row.number("a_bar");
        row.check("F_bar_hertz", hertz::force(&sphere, a), 1e-11, 1e-15);
        row.check("delta_bar", hertz::approach(&sphere, a), 1e-11, 1e-15);
        // Any Tabor parameter will do, since Maugis' constant has no range.
        let approach = tabor_map::lj_from_maugis_approach(a * a, 0.3);
        let force = dmt::force(dmt::Method::Constant, Law::LennardJones, approach, 0.3);
        row.check("F_over_2piwR_dmt", force.expect("a force"), 1e-11, 1e-11);
    }
}

#[test]
fn maugis_dugdale_curves() {
    for (name, lambda) in [("0.1", 0.1), ("0.5", 0.5), ("2", 2.0)] {
        let sphere = MaugisDugdale::new(lambda).expect("a sphere");
        for row in Table::read(&format!("md_curve_lambda{name}.csv")).rows() {
            let (a, c) = (row.number("a_bar"), row.number("c_bar"));
            let state = if row.text("branch") == "open" || a == 0.0 {
                sphere.open_state(c.min(sphere.touching_radius()))
            } else {
                sphere.state(a)
            };
            let state = state.unwrap_or_else(|error| panic!("{error} at a = {a}, c = {c}"));
            row.check("c_bar", state.cohesive_radius, 1e-10, 0.0);
            row.check("F_bar", state.force, 1e-10, 1e-10);
            row.check("delta_bar", state.approach, 1e-10, 1e-10);
            row.check("gap0_bar", state.central_gap, 1e-10, 1e-10);
        }
    }
}

#[test]
fn maugis_dugdale_special_points() {
    for row in Table::read("md_special_points.csv").rows() {
        let sphere = MaugisDugdale::new(row.number("lambda")).expect("a sphere");
        // The place of a minimum is known to the square root of rounding only.
        let pull = sphere.pull_off().expect("a pull-off");
        row.check("pull_F_over_2piwR", -0.5 * pull.force, 1e-11, 0.0);
        row.check("pull_a_bar", pull.contact_radius, 1e-6, 0.0);
        row.check("pull_c_bar", pull.cohesive_radius, 1e-6, 0.0);
        row.check("pull_delta_bar", pull.approach, 1e-6, 0.0);
        let grip = sphere.grip().expect("a grip limit");
        row.check("jo_delta_bar", grip.approach, 1e-11, 0.0);
        row.check("jo_a_bar", grip.contact_radius, 1e-6, 0.0);
        row.check("jo_c_bar", grip.cohesive_radius, 1e-6, 0.0);
        row.check("jo_F_over_2piwR_abs", -0.5 * grip.force, 1e-6, 0.0);
        assert_eq!(
            row.text("jo_branch") == "touch",
            sphere.lambda() > FOLD_LAMBDA
        );
        row.check("ji_delta_bar", -sphere.range(), 1e-11, 0.0);
        let landing = sphere.jump_in().expect("a landing");
        row.check("ji_land_a_bar", landing.contact_radius, 1e-10, 0.0);
        row.check("ji_land_c_bar", landing.cohesive_radius, 1e-10, 0.0);
        row.check("ji_land_F_over_2piwR", 0.5 * landing.force, 1e-10, 0.0);
        let free = sphere.states_at_force(0.0).expect("a free state");
        let free = free.last().expect("a free state");
        row.check("zero_a_bar", free.contact_radius, 1e-11, 0.0);
        row.check("zero_c_bar", free.cohesive_radius, 1e-11, 0.0);
        row.check("zero_delta_bar", free.approach, 1e-11, 0.0);
        row.check("touch_c_bar", sphere.touching_radius(), 1e-11, 0.0);
    }
}

#[test]
fn maugis_dugdale_profile() {
    let sphere = MaugisDugdale::new(0.5).expect("a sphere");
    for row in Table::read("md_profile_lambda0.5.csv").rows() {
        let state = sphere.state(row.number("a_bar")).expect("a state");
        row.check("c_bar", state.cohesive_radius, 1e-10, 0.0);
        let (r, c) = (row.number("r_bar"), row.number("c_bar"));
        // On the rim itself the last digit decides between tension and nothing.
        if (r - c).abs() > 1e-9 {
            row.check("p_bar", sphere.pressure(&state, r), 1e-9, 1e-9);
        }
    }
}

#[test]
fn westergaard_tables() {
    for row in Table::read("westergaard_load_area.csv").rows() {
        let a = 0.5 * row.number("contact_fraction");
        let mean = westergaard::mean_pressure(a).expect("a pressure");
        row.check("pbar_over_pstar", mean, 1e-11, 1e-13);
        let peak = westergaard::pressure(a, 0.0).expect("a pressure");
        row.check("pmax_over_pstar", peak, 1e-11, 1e-13);
        let gap = westergaard::mean_gap(mean).expect("a gap");
        row.check("mean_gap_over_Delta", gap, 1e-10, 1e-12);
    }
    for row in Table::read("westergaard_profiles.csv").rows() {
        let (a, x) = (0.5 * row.number("contact_fraction"), row.number("x_over_L"));
        let pressure = westergaard::pressure(a, x).expect("a pressure");
        // A root at the edge of contact turns the rounding of x into its square root.
        row.check("p_over_pstar", pressure, 1e-10, 5e-8);
        let gap = westergaard::gap(a, x).expect("a gap");
        row.check("gap_over_Delta", gap, 1e-10, 1e-11);
    }
}

/// The equilibrium on a traced curve at an approach, nearest to a force where the curve folds.
fn nearest(
    sphere: &LennardJonesSphere,
    curve: &[lennard_jones_sphere::State],
    approach: f64,
    force: f64,
) -> Option<lennard_jones_sphere::State> {
    let miss = |pair: &&[lennard_jones_sphere::State]| {
        let share = (approach - pair[0].approach) / (pair[1].approach - pair[0].approach);
        let guess = pair[0].force + share * (pair[1].force - pair[0].force);
        ((0.0..=1.0).contains(&share)).then_some((guess - force).abs())
    };
    let pair = curve
        .windows(2)
        .filter(|pair| miss(pair).is_some())
        .min_by(|a, b| miss(a).partial_cmp(&miss(b)).expect("finite misses"))?;
    sphere.between(pair, approach).ok()
}

#[test]
fn lennard_jones_curves() {
    for (name, mu, every) in [("0.1", 0.1, 2), ("0.5", 0.5, 4), ("2", 2.0, 12)] {
        let deepest = 1.5;
        let sphere = LennardJonesSphere::new(mu, deepest).expect("a sphere");
        let curve = sphere
            .curve(|states| states.last().is_some_and(|last| last.approach > deepest))
            .expect("a curve");
        let mut compared = 0;
        for row in Table::read(&format!("lj_curve_mu{name}.csv"))
            .rows()
            .step_by(every)
        {
            let (approach, force) = (row.number("A"), row.number("F_over_2piwR"));
            if approach < curve[0].approach || approach > deepest {
                continue;
            }
            // Right beside a fold there may be no pair of neighbours around the row; the special
            // points stand for those.
            let Some(state) = nearest(&sphere, &curve, approach, force) else {
                continue;
            };
            compared += 1;
            row.check("F_over_2piwR", state.force, 1e-7, 1e-7);
            row.check("u0", 1.0 + sphere.gap(&state, 0.0), 1e-7, 1e-7);
            for (column, gap) in [("r_eq", 0.0), ("r_pk", Law::LennardJones.peak_gap())] {
                if row.number(column) > 0.0 {
                    let radius = sphere.radius_of_gap(&state, gap).expect("a radius");
                    row.check(column, radius, 1e-6, 1e-6);
                }
            }
        }
        assert!(compared > 12, "only {compared} rows of {name}");
    }
}

#[test]
fn lennard_jones_special_points() {
    for row in Table::read("lj_special_points.csv").rows() {
        let mu = row.number("mu");
        let sphere = LennardJonesSphere::new(mu, 0.0).expect("a sphere");
        let pull = sphere.pull_off().expect("a pull-off");
        row.check("pull_F_over_2piwR", -pull.force, 1e-7, 0.0);
        // The place of a minimum is known to the square root of rounding, at best.
        row.check("pull_A", pull.approach, 0.0, 1e-4);
        let folds = sphere.folds().expect("a curve");
        assert_eq!(folds.is_some(), row.number("n_folds_in") > 0.0);
        if let Some((jump_in, jump_off)) = folds {
            row.check("jump_in_A", jump_in.approach, 1e-7, 0.0);
            row.check("jump_in_F_over_2piwR_abs", -jump_in.force, 1e-4, 0.0);
            row.check("jump_off_A", jump_off.approach, 1e-7, 0.0);
            row.check("jump_off_F_over_2piwR_abs", -jump_off.force, 1e-4, 0.0);
        }
    }
}

/// Shallow folds, which steps along the curve could pass over.
///
/// Solved with another discretisation: rings of uniform pressure (elliptic integrals of discs),
/// followed by the gap on the axis instead of the arc length, on 300 and 600 rings, whose error
/// falls with the square of their width. The extrapolated places are good to about 2e-6.
#[test]
fn lennard_jones_shallow_folds() {
    for (mu, jump_in, jump_off) in [
        (0.8, (-1.379_543, -0.425_013), (-1.404_233, -0.543_349)),
        (1.0, (-1.629_217, -0.340_547), (-1.743_430, -0.516_216)),
    ] {
        let sphere = LennardJonesSphere::new(mu, 0.0).expect("a sphere");
        let folds = sphere.folds().expect("a curve").expect("two folds");
        for (fold, expected) in [(folds.0, jump_in), (folds.1, jump_off)] {
            assert!(
                (fold.approach - expected.0).abs() < 5e-6,
                "{mu}: {}",
                fold.approach
            );
            // Beside a fold the force changes with the root of the approach.
            assert!(
                (fold.force - expected.1).abs() < 5e-5,
                "{mu}: {}",
                fold.force
            );
        }
    }
    let stiff = LennardJonesSphere::new(0.65, 0.0).expect("a sphere");
    assert!(stiff.folds().expect("a curve").is_none());
}

#[test]
fn lennard_jones_profiles() {
    let sphere = LennardJonesSphere::new(0.5, 2.0).expect("a sphere");
    let mut state: Option<lennard_jones_sphere::State> = None;
    for row in Table::read("lj_profile_mu0.5.csv").rows().step_by(5) {
        let approach = row.number("A");
        if state.as_ref().is_none_or(|s| s.approach != approach) {
            state = Some(sphere.at_approach(approach).expect("a state"));
        }
        let state = state.as_ref().expect("a state");
        let x = row.number("x");
        row.check("u", 1.0 + sphere.gap(state, x), 1e-7, 1e-7);
        row.check("p", sphere.pressure(state, x), 1e-6, 1e-6);
    }
}

#[test]
fn step_load_on_a_viscoelastic_sphere() {
    // Moduli in E_0, times in the relaxation time, lengths such that a_0 = 1 and R = 1.
    let solid = Solid::new(0.1, 0.9, 1.0).expect("a solid");
    let (radius, force) = (1.0, 4.0 / 3.0);
    let unit = 3.0 * force / (2.0 * std::f64::consts::PI);
    for row in Table::read("lee_radok_step_ratio0.1.csv").rows() {
        let time = row.number("t_over_tau_r");
        row.check("E0_J", solid.creep(time), 1e-10, 0.0);
        let contact = solid.sphere_contact_radius(radius, force, time);
        row.check("a_over_a0", contact.expect("a radius"), 1e-10, 0.0);
        for (column, r) in [("p_r0", 0.0), ("p_r0.5a0", 0.5), ("p_r0.9a0", 0.9)] {
            let pressure = solid.sphere_pressure(radius, force, time, r);
            row.check(column, pressure.expect("a pressure") / unit, 1e-7, 1e-9);
        }
    }
}
