//! What a scene may hold fixed: the controls agree with each other, also where no equilibrium is.

use tabor::law::{Cohesion, LennardJones};
use tabor::study::{PointState, State};

use crate::bench::{Solved, setup, solve, solve_table};
use crate::rough::{MODULUS, Surface, scene};
use crate::shared::trials::tests;

/// Relative agreement of two solves to a residual of 1e-9: the smallest stiffness of a state is
/// some thousandth of the largest, by which a residual turns into an error of position.
const AGREE: f64 = 1e-5;

pub const LAWS: [&str; 3] = ["maugis-dugdale", "exponential", "lennard-jones"];

pub fn rough(adhesion: &str, loading: &str) -> String {
    format!(
        r#"
        [grid]
        points = [64, 48]
        size = [1.0, 0.75]
        [solid]
        contact_modulus = 1.0
        [[surface]]
        kind = "self-affine"
        hurst = 0.8
        rms_height = 0.01
        longest = 1.0
        rolloff = 0.5
        shortest = 0.125
        seed = 2
        {adhesion}
        [loading]
        {loading}
        [solver]
        tolerance = 1e-9
        "#
    )
}

fn sphere(adhesion: &str, loading: &str) -> String {
    format!(
        r#"
        [grid]
        points = [48, 64]
        size = [6.0, 8.0]
        boundary = "free"
        [solid]
        contact_modulus = 1.0
        [[surface]]
        kind = "sphere"
        radius = 1.0
        {adhesion}
        [loading]
        {loading}
        [solver]
        tolerance = 1e-9
        "#
    )
}

pub fn adhesion(law: &str, work: f64, range: f64) -> String {
    format!("[adhesion]\nlaw = \"{law}\"\nwork_of_adhesion = {work:e}\nrange = {range:e}")
}

fn close(a: f64, b: f64, scale: f64) -> bool {
    (a - b).abs() <= AGREE * scale
}

/// The scene solved at one value of a control, reached from a heavier load.
fn held(
    text: &dyn Fn(&str, &str) -> String,
    table: &str,
    control: &str,
    values: [f64; 2],
    spring: Option<f64>,
) -> Solved {
    let spring = spring
        .map(|k| format!("spring = {k:e}"))
        .unwrap_or_default();
    let path = format!(
        "control = \"{control}\"\npath = [{:e}, {:e}]\n{spring}",
        values[0], values[1]
    );
    solve(&text(table, &path))
}

/// Solves by one control, then asks every other for what it found.
pub fn agree(
    name: &str,
    text: &dyn Fn(&str, &str) -> String,
    table: &str,
    first: (&str, [f64; 2]),
    others: &[&str],
    area: f64,
    length: f64,
) {
    let found = held(text, table, first.0, first.1, None);
    let rows: Vec<_> = found.rows().cloned().collect();
    let force = rows[0].force.abs().max(rows[1].force.abs());
    for control in others {
        let ask = |i: usize| match *control {
            "pressure" => rows[i].mean_pressure,
            "force" => rows[i].force,
            "mean-gap" => rows[i].mean_gap.expect("a gap"),
            _ => rows[i].approach.expect("an approach"),
        };
        let solved = held(text, table, control, [ask(0), ask(1)], None);
        for (row, expected) in solved.rows().zip(&rows) {
            let what = format!("{name}: {control} against {}, step {}", first.0, row.step);
            assert!(
                close(row.force, expected.force, force),
                "{what}: force {} {}",
                row.force,
                expected.force
            );
            assert!(close(row.mean_pressure * area, row.force, force), "{what}");
            assert!(
                close(row.approach.unwrap(), expected.approach.unwrap(), length),
                "{what}: approach"
            );
            assert!(
                close(row.mean_gap.unwrap(), expected.mean_gap.unwrap(), length),
                "{what}: mean gap"
            );
            assert_eq!(
                row.contact_area_fraction, expected.contact_area_fraction,
                "{what}: contact"
            );
            assert!(
                close(row.elastic_energy, expected.elastic_energy, force * length),
                "{what}: energy"
            );
            assert!(
                close(
                    row.adhesive_energy,
                    expected.adhesive_energy,
                    force * length
                ),
                "{what}: energy"
            );
        }
    }
    // A spring as stiff as the contact: force = k (far end - approach).
    let stiffness = force / length;
    let far = |i: usize| rows[i].approach.unwrap() + rows[i].force / stiffness;
    let solved = held(text, table, "approach", [far(0), far(1)], Some(stiffness));
    for (i, (row, expected)) in solved.rows().zip(&rows).enumerate() {
        let what = format!("{name}: spring, step {}", row.step);
        let stretched = stiffness * (far(i) - row.approach.unwrap());
        assert!(
            close(row.force, stretched, force),
            "{what}: {} {stretched}",
            row.force
        );
        assert!(
            close(row.force, expected.force, force),
            "{what}: {} {}",
            row.force,
            expected.force
        );
        assert!(
            close(row.approach.unwrap(), expected.approach.unwrap(), length),
            "{what}"
        );
        assert!(
            close(row.elastic_energy, expected.elastic_energy, force * length),
            "{what}: energy"
        );
    }
}

fn all_controls_agree_on_a_periodic_cell() {
    for law in LAWS {
        agree(
            law,
            &rough,
            &adhesion(law, 2e-5, 3e-3),
            ("mean-gap", [0.008, 0.012]),
            &["mean-gap", "approach", "pressure", "force"],
            0.75,
            0.01,
        );
    }
    agree(
        "hard wall",
        &rough,
        "",
        ("mean-gap", [0.008, 0.012]),
        &["approach", "pressure", "force"],
        0.75,
        0.01,
    );
}

fn all_controls_agree_on_a_free_boundary() {
    for law in LAWS {
        agree(
            law,
            &sphere,
            &adhesion(law, 0.2, 0.5),
            ("approach", [1.0, 0.2]),
            &["approach", "force"],
            48.0,
            1.0,
        );
    }
    agree(
        "hard wall",
        &sphere,
        "",
        ("approach", [1.0, 0.2]),
        &["force"],
        48.0,
        1.0,
    );
}

/// Through a spring softer than the contact's fold a sphere jumps in and off, and force and stretch
/// stay one number all the way.
fn a_soft_spring_through_both_jumps() {
    for law in LAWS {
        let mut path: Vec<f64> = (0..12).map(|i| -3.0 + 0.6 * f64::from(i)).collect();
        path.extend((0..20).map(|i| 3.0 - 0.6 * f64::from(i)));
        let stiffness = 0.3;
        let solved = solve_table(&sphere(
            &adhesion(law, 0.2, 0.5),
            &format!("control = \"approach\"\npath = {path:?}\nspring = {stiffness}"),
        ));
        for (row, far) in solved.rows().zip(&path) {
            let stretched = stiffness * (far - row.approach.expect("held"));
            assert!(
                close(row.force, stretched, 1.0),
                "{law} at {far}: {} {stretched}",
                row.force
            );
        }
        let pull_off = solved.rows().map(|row| -row.force).fold(0.0, f64::max);
        assert!(pull_off > 0.5, "{law}: {pull_off}");
        assert_eq!(
            (
                solved.end.jump_in_steps.len(),
                solved.end.jump_off_steps.len()
            ),
            (1, 1),
            "{law}"
        );
        let last = solved.steps.last().expect("rows");
        assert_ne!(last.row.state, State::Contact, "{law}");
    }
}

/// A tension that nothing carries ends a step `separated`; the path goes on, and a compressive load
/// brings the surfaces back.
fn beyond_pull_off_and_back() {
    for law in LAWS {
        let cases = [
            (
                "periodic",
                solve_table(&rough(
                    &adhesion(law, 2e-5, 3e-3),
                    "control = \"pressure\"\npath = [1e-2, -1.0, -1e-2, 0.02, 1e-2]",
                )),
                1e-2 * 0.75,
            ),
            (
                "free",
                solve_table(&sphere(
                    &adhesion(law, 0.2, 0.5),
                    "control = \"force\"\npath = [1.0, -10.0, -1.5, 2.0, 1.0]",
                )),
                1.0,
            ),
        ];
        for (boundary, solved, force) in cases {
            let rows: Vec<_> = solved.rows().collect();
            for row in &rows[1..3] {
                assert_eq!(
                    row.state,
                    State::Separated,
                    "{law}, {boundary}: step {}",
                    row.step
                );
                assert_eq!((row.force, row.approach, row.mean_gap), (0.0, None, None));
                assert!(row.converged);
            }
            for row in &rows[3..] {
                assert_eq!(
                    row.state,
                    State::Contact,
                    "{law}, {boundary}: step {}",
                    row.step
                );
            }
            assert!(close(rows[4].force, force, force));
            // These ranges are long enough that a load has one equilibrium, however it is reached.
            let (first, again) = (rows[0].approach.unwrap(), rows[4].approach.unwrap());
            assert!(
                (first - again).abs() < 1e-4 * first.abs().max(0.01),
                "{law}, {boundary}: {first} {again}"
            );
            assert_eq!(solved.end.jump_off_steps, [2], "{law}, {boundary}");
            assert_eq!(solved.end.jump_in_steps, [4], "{law}, {boundary}");
        }
    }
}

/// A wall alone carries no tension, and at zero load it only touches.
fn a_hard_wall_without_load_is_separated() {
    let periodic = solve_table(&rough(
        "",
        "control = \"pressure\"\npath = [1e-3, 0.0, -1e-3, 1e-3]",
    ));
    let free = solve_table(&sphere(
        "",
        "control = \"force\"\npath = [1e-3, 0.0, -1e-3, 1e-3]",
    ));
    for solved in [periodic, free] {
        let rows: Vec<_> = solved.rows().collect();
        let states: Vec<State> = rows.iter().map(|row| row.state).collect();
        assert_eq!(
            states,
            [
                State::Contact,
                State::Separated,
                State::Separated,
                State::Contact
            ]
        );
        assert_eq!(rows[1].force, 0.0);
        assert_eq!(rows[0].contact_area_fraction, rows[3].contact_area_fraction);
    }
    // Apart by a held position: nothing touches, nothing pulls.
    let apart = solve_table(&sphere(
        "",
        "control = \"approach\"\npath = [-0.1, 0.1, -0.1]",
    ));
    let states: Vec<State> = apart.rows().map(|row| row.state).collect();
    assert_eq!(states, [State::Separated, State::Contact, State::Separated]);
    assert_eq!(apart.steps[2].row.force, 0.0);
}

/// With the attraction summed afterwards the net load is the one asked, and contact is the hard
/// wall's at the load that the contact itself carries.
fn dmt_is_a_hard_wall_under_a_larger_load() {
    let net = [2e-2, 5e-3, 0.0];
    for law in LAWS {
        let table = format!("{}\ntreatment = \"dmt\"", adhesion(law, 2e-5, 3e-3));
        let path = format!("control = \"pressure\"\npath = {net:?}");
        let solved = solve(&rough(&table, &path));
        let area = solved.setup.surface.grid.area();
        for (i, (row, net)) in solved.rows().zip(net).enumerate() {
            let fields = solved.fields(i);
            assert_eq!(row.mean_pressure, net);
            let carried: f64 = fields
                .pressure
                .iter()
                .zip(&fields.points)
                .filter(|(_, point)| **point == PointState::Contact)
                .map(|(pressure, _)| pressure)
                .sum::<f64>()
                / fields.pressure.len() as f64;
            // Less what is attracted where only the staircase of pixels closes the gap.
            let corrected = fields.contact_corrected.expect("a wall");
            let at_edges = solved.setup.law.traction(0.0) * (fields.contact - corrected);
            let carried = carried + at_edges;
            // The bracketed search ends at the solver's tolerance of the loads involved.
            assert!(
                (fields.force / area - net).abs() < 1e-7 * carried,
                "{law}: {} {net}",
                fields.force / area
            );
            assert!(carried > net, "{law}");
            let wall = solve_table(&rough(
                "",
                &format!("control = \"pressure\"\npath = [{carried:e}]"),
            ));
            let wall = &wall.steps[0].row;
            assert_eq!(
                row.contact_area_fraction, wall.contact_area_fraction,
                "{law} at {net}"
            );
            assert!(
                close(row.mean_gap.unwrap(), wall.mean_gap.unwrap(), 0.01),
                "{law} at {net}"
            );
        }
        // No hysteresis by construction.
        assert!(solved.end.jump_in_steps.is_empty() && solved.end.jump_off_steps.is_empty());
        // Far beyond the largest attraction there is no balance.
        let apart = solve_table(&rough(
            &table,
            "control = \"pressure\"\npath = [0.0, -1.0, 1e-3]",
        ));
        let states: Vec<State> = apart.rows().map(|row| row.state).collect();
        assert_eq!(
            states,
            [State::Contact, State::Separated, State::Contact],
            "{law}"
        );
    }
}

/// Rough surfaces of another boundary-element code: contact, mean gap, largest pressure, and the
/// attraction of a Lennard-Jones law over the gap outside contact, all to that table's tolerance.
fn attraction_summed_over_other_codes_gaps() {
    let file = std::env::var_os("TABOR_THEORY_CHECKS").map_or_else(
        || {
            concat!(
                env!("CARGO_MANIFEST_DIR"),
                "/tests/reference/theory_checks.json"
            )
            .into()
        },
        std::path::PathBuf::from,
    );
    let text = std::fs::read_to_string(file).expect("the checks");
    let checks: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let law = LennardJones {
        work_of_adhesion: 0.2,
        range: 1e-9,
    };
    for (key, check) in checks.as_object().expect("a table") {
        if key.split('#').next() != Some("bem_det_surface") {
            continue;
        }
        let input = |name: &str| check["inputs"][name].as_f64().expect("a number");
        let surface = Surface {
            hurst: input("H"),
            ratio: input("N") as usize,
            points: input("n") as usize,
            seed: input("seed") as u64,
        };
        let slope = setup(&scene(&surface, "", &[1.0], 1e-6))
            .statistics
            .moments
            .rms_slope();
        let unit = MODULUS * slope;
        let solved = solve(&scene(&surface, "", &[input("x") * unit], 1e-9));
        let (row, fields) = (&solved.steps[0].row, solved.fields(0));
        let count = fields.gap.len() as f64;
        let attraction = fields
            .gap
            .iter()
            .zip(&fields.points)
            .filter(|(_, point)| **point != PointState::Contact)
            .map(|(&gap, _)| law.traction(gap))
            .sum::<f64>()
            / count;
        let largest = fields.pressure.iter().copied().fold(0.0, f64::max);
        for (name, found) in [
            ("A", row.contact_area_fraction),
            (
                "A_corr",
                row.contact_area_fraction_corrected.expect("a wall"),
            ),
            ("ubar_over_h", row.mean_gap.expect("a gap") / 0.52e-9),
            ("pad_over_Ehp", attraction / unit),
            ("pmax_over_Ehp", largest / unit),
        ] {
            let Some(expected) = check["expected"][name].as_f64() else {
                continue;
            };
            let error = (found / expected - 1.0).abs();
            println!("{key} {name}: {found} {expected} ({error:.1e})");
            assert!(
                error <= check["rtol"].as_f64().expect("a tolerance"),
                "{key} {name}: {found} {expected}"
            );
        }
        // The walk's own sum, asked for the net load that leaves the same repulsive one.
        if surface.points <= 256 {
            let net = input("x") * unit - attraction;
            let table = "[adhesion]\nlaw = \"lennard-jones\"\nwork_of_adhesion = 0.2\nrange = 1e-9\ntreatment = \"dmt\"";
            let summed = solve_table(&scene(&surface, table, &[net], 1e-9));
            assert_eq!(
                summed.steps[0].row.contact_area_fraction, row.contact_area_fraction,
                "{key}"
            );
        }
    }
}

/// A soft solid whose few spots give way to contact around a few holes, all within a small step of its mean gap. The direction of the solve
/// descends by points that the wall stops; it goes on from where each point has moved by itself, and every step converges, down to the last that
/// holds.
fn a_soft_solid_is_drawn_off_through_its_jumps() {
    for seed in [2, 6] {
        let solved = solve_table(&format!(
            "[grid]\npoints = 48\nsize = \"20 um\"\n[solid]\ncontact_modulus = \"1 MPa\"\n\
             [[surface]]\nkind = \"self-affine\"\nhurst = 0.8\nrms_height = \"50 nm\"\nlongest = \"20 um\"\nrolloff = \"10 um\"\n\
             shortest = \"2.5 um\"\nseed = {seed}\n\
             [adhesion]\nlaw = \"maugis-dugdale\"\nwork_of_adhesion = \"50 mJ/m^2\"\nrange = \"300 nm\"\n\
             [loading]\ncontrol = \"mean-gap\"\npath = [\"1 nm\"]\nuntil = \"apart\"\n"
        ));
        let last = solved.steps.last().expect("rows");
        assert_eq!(last.row.state, State::Separated, "seed {seed}");
    }
}

tests![
    a_soft_solid_is_drawn_off_through_its_jumps,
    all_controls_agree_on_a_periodic_cell,
    all_controls_agree_on_a_free_boundary,
    a_soft_spring_through_both_jumps,
    beyond_pull_off_and_back,
    a_hard_wall_without_load_is_separated,
    dmt_is_a_hard_wall_under_a_larger_load,
    attraction_summed_over_other_codes_gaps,
];
