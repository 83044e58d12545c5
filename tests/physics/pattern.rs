//! Adhesion that differs from point to point.

use std::f64::consts::PI;

use tabor::scene::FieldName;

use crate::bench::{Solved, solve, solve_table};
use crate::controls::{LAWS, adhesion, rough};
use crate::shared::trials::tests;

const PATH: &str = "control = \"pressure\"\npath = [5e-3, 2e-2, 1e-3, -2e-4]";

fn mapped(law: &str, work: f64, low: f64, high: f64) -> String {
    format!(
        "{}\nmap = {{ pattern = \"checker\", period = 0.25, low = {low}, high = {high} }}",
        adhesion(law, work, 3e-3)
    )
}

fn same_bits(a: &Solved, b: &Solved) {
    for (a, b) in a.rows().zip(b.rows()) {
        let mut a = a.clone();
        a.seconds = b.seconds;
        assert_eq!(&a, b);
    }
}

/// A map of ones is no map, bit for bit, and one of twos doubles the work of adhesion.
fn uniform_maps() {
    for law in LAWS {
        let plain = solve_table(&rough(&adhesion(law, 2e-5, 3e-3), PATH));
        same_bits(
            &plain,
            &solve_table(&rough(&mapped(law, 2e-5, 1.0, 1.0), PATH)),
        );
        // Powers of two carry through every product.
        same_bits(
            &plain,
            &solve_table(&rough(&mapped(law, 1e-5, 2.0, 2.0), PATH)),
        );
    }
}

/// Points whose factor is 0 are within the range and not attracted.
fn points_without_attraction_are_not_attracted() {
    let solved = solve_table(&format!(
        "[grid]\npoints = 16\nsize = 1.0\n[solid]\ncontact_modulus = 1.0\n[[surface]]\nkind = \"flat\"\n{}\n\
         [loading]\ncontrol = \"mean-gap\"\npath = [1e-3]\n",
        mapped("maugis-dugdale", 2e-5, 0.0, 1.0)
    ));
    let row = solved.rows().next().expect("a row");
    assert_eq!(row.attractive_area_fraction, 0.5);
}

/// A flat solid within the range of stripes: the tension is the pattern itself, the same whatever
/// the gap, and each wave of it lifts the surface by its own compliance.
fn stripes_lift_a_flat_surface() {
    for layer in ["", "poisson_ratio = 0.5\nthickness = 0.1\n"] {
        let solved = solve(&format!(
            r#"
            [grid]
            points = [64, 8]
            size = [1.0, 0.125]
            [solid]
            contact_modulus = 1.0
            {layer}
            [[surface]]
            kind = "flat"
            [adhesion]
            law = "maugis-dugdale"
            work_of_adhesion = 1e-4
            range = 1e-2
            taper = 0
            map = {{ pattern = "stripe", period = 0.5, low = 0.25, high = 1.5 }}
            [loading]
            control = "mean-gap"
            path = [4e-3]
            [solver]
            tolerance = 1e-10
            "#
        ));
        let fields = solved.fields(0);
        let gap = fields.field(FieldName::Gap, &[]);
        let stripe = |x: usize| {
            if (x / 16).is_multiple_of(2) {
                1.5
            } else {
                0.25
            }
        };
        let mut lifted = [0.0; 2];
        for (i, pressure) in fields.pressure.iter().enumerate() {
            let expected = -1e-2 * stripe(i % 64);
            assert!(
                (pressure - expected).abs() < 1e-12,
                "{i}: {pressure} {expected}"
            );
            let phase = 2.0 * PI * 2.0 * (i % 64) as f64 / 64.0;
            lifted[0] += (gap[i] - 4e-3) * phase.cos() / 256.0;
            lifted[1] += pressure * phase.cos() / 256.0;
        }
        let q = 4.0 * PI;
        let k = q * 0.1;
        let share = match layer {
            "" => 1.0,
            _ => ((2.0 * k).sinh() - 2.0 * k) / ((2.0 * k).cosh() + 2.0 * k * k + 1.0),
        };
        let expected = 2.0 / q * share * lifted[1];
        assert!(
            (lifted[0] / expected - 1.0).abs() < 1e-8,
            "{}: {} {expected}",
            layer,
            lifted[0]
        );
        let force = -1e-2 * 0.875 * 0.125;
        assert!((solved.steps[0].row.force - force).abs() < 1e-12);
        let energy = -(1e-2 - 4e-3) * 1e-2 * 0.875 * 0.125;
        // The lift is along the pattern: it adds the work of the tension on it.
        let row = &solved.steps[0].row;
        assert!((row.adhesive_energy - energy + 2.0 * row.elastic_energy).abs() < 1e-12);
    }
}

/// On a rough surface the map's places decide: low where it touches least changes least, and the
/// treatment that sums the attraction afterwards sums the mapped one.
fn a_map_changes_what_it_covers() {
    let table = |low: f64| {
        format!(
            "{}\ntreatment = \"dmt\"",
            mapped("exponential", 2e-5, low, 1.0)
        )
    };
    let load = "control = \"mean-gap\"\npath = [0.01]";
    let all = solve_table(&rough(&table(1.0), load));
    let half = solve_table(&rough(&table(0.0), load));
    let wall = solve_table(&rough("", load));
    let net = |solved: &Solved| solved.steps[0].row.force;
    let pulled = net(&wall) - net(&all);
    let pulled_half = net(&wall) - net(&half);
    assert!(pulled > 0.0 && pulled_half > 0.0);
    // Checkers of a quarter of the cell each way hold between a quarter and three quarters of it.
    let share = pulled_half / pulled;
    assert!(share > 0.25 && share < 0.75, "{share}");
    assert_eq!(
        half.steps[0].row.contact_area_fraction,
        wall.steps[0].row.contact_area_fraction
    );
}

tests![
    uniform_maps,
    points_without_attraction_are_not_attracted,
    stripes_lift_a_flat_surface,
    a_map_changes_what_it_covers,
];
