//! Which curves a run has: load against distance, contact area against load.

use super::axis::Axis;
use super::{Chart, Stretch};
use crate::scene::{Boundary, Control, Scene};
use crate::study::StepRow;

/// Rows beyond which a curve is thinned: more than a picture has columns.
const MOST: usize = 4000;

/// The curves of the finished rows of a path.
///
/// Rows that carry no load, because no equilibrium does, break a curve; rows that did not converge
/// are no part of it.
pub(super) fn charts(scene: &Scene, rows: &[StepRow]) -> Vec<Chart> {
    let control = scene.loading.control;
    let by_gap = matches!(control, Control::Pressure | Control::MeanGap);
    let by_force = scene.grid.boundary == Boundary::Free
        || matches!(control, Control::Force | Control::Approach);
    let distance = |row: &StepRow| if by_gap { row.mean_gap } else { row.approach };
    let load = |row: &StepRow| {
        if by_force {
            row.force
        } else {
            row.mean_pressure
        }
    };
    let (load_name, load_unit) = if by_force {
        ("force", "N")
    } else {
        ("mean pressure", "Pa")
    };
    let distance_name = if by_gap { "mean gap" } else { "approach" };
    let first: Vec<Option<[f64; 2]>> = rows
        .iter()
        .map(|row| distance(row).map(|x| [x, load(row)]))
        .collect();
    let second: Vec<Option<[f64; 2]>> = rows
        .iter()
        .map(|row| distance(row).map(|_| [load(row), row.contact_area_fraction]))
        .collect();
    let loading = directions(scene, rows.len());
    let chart = |title: String, names: [(&'static str, &str); 2], points: Vec<Option<[f64; 2]>>| {
        let stretches = stretches(rows, &points, &loading);
        let values = |axis: usize| {
            let points = stretches.iter().flat_map(|stretch| &stretch.points);
            points.map(move |at| at[axis])
        };
        Chart {
            title,
            x: Axis::new(names[0].0, names[0].1, values(0)),
            y: Axis::new(names[1].0, names[1].1, values(1)),
            stretches,
        }
    };
    vec![
        chart(
            format!("{load_name} against {distance_name}"),
            [(distance_name, "m"), (load_name, load_unit)],
            first,
        ),
        chart(
            format!("contact area against {load_name}"),
            [(load_name, load_unit), ("contact area", "")],
            second,
        ),
    ]
}

/// Whether each step brings the surfaces closer or presses harder than the one before.
fn directions(scene: &Scene, count: usize) -> Vec<bool> {
    let path = &scene.loading.path;
    let sign = match scene.loading.control {
        Control::MeanGap => -1.0,
        _ => 1.0,
    };
    let mut loading = vec![true; count];
    for step in 1..count.min(path.len()) {
        let change = sign * (path[step] - path[step - 1]);
        loading[step] = if change == 0.0 {
            loading[step - 1]
        } else {
            change > 0.0
        };
    }
    // The first step has the direction of the second.
    if count > 1 {
        loading[0] = loading[1];
    }
    loading
}

fn stretches(rows: &[StepRow], points: &[Option<[f64; 2]>], loading: &[bool]) -> Vec<Stretch> {
    let stride = rows.len().div_ceil(MOST).max(1);
    let mut found: Vec<Stretch> = Vec::new();
    let mut before: Option<[f64; 2]> = None;
    for (index, (row, point)) in rows.iter().zip(points).enumerate() {
        let turns = (index + 1 < rows.len()) && loading[index] != loading[index + 1];
        if index % stride != 0 && index + 1 != rows.len() && !turns {
            continue;
        }
        let fits = |at: &[f64; 2]| row.converged && at.iter().all(|value| value.is_finite());
        let Some(at) = point.filter(fits) else {
            before = None;
            continue;
        };
        match (found.last_mut(), before) {
            (Some(last), Some(_)) if last.loading == loading[index] => last.points.push(at),
            (_, before) => found.push(Stretch {
                loading: loading[index],
                points: before.into_iter().chain([at]).collect(),
            }),
        }
        before = Some(at);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::State;

    fn scene(loading: &str) -> Scene {
        let text = format!(
            "[grid]\npoints = 8\nsize = 1e-6\n[solid]\ncontact_modulus = 1e9\n[[surface]]\nkind = \"flat\"\n[loading]\n{loading}"
        );
        Scene::parse(&text, "scene.toml", ".".as_ref(), &[]).expect("the scene is right")
    }

    fn row(step: usize, gap: Option<f64>, pressure: f64) -> StepRow {
        StepRow {
            step,
            time: None,
            approach: gap.map(|gap| -gap),
            mean_gap: gap,
            force: 1e-12 * pressure,
            mean_pressure: pressure,
            contact_area_fraction: 0.1,
            attractive_area_fraction: 0.0,
            elastic_energy: 0.0,
            adhesive_energy: 0.0,
            iterations: 1,
            residual: 0.0,
            converged: true,
            seconds: 0.0,
            contact_area_fraction_corrected: None,
            state: State::Contact,
            columns: Vec::new(),
        }
    }

    #[test]
    fn loading_and_unloading_are_stretches_that_share_their_turning_point() {
        let scene = scene("control = \"pressure\"\npath = [1e6, 2e6, 1e6, -1e6, 1e6]");
        let rows = [
            row(1, Some(3e-9), 1e6),
            row(2, Some(2e-9), 2e6),
            row(3, Some(2.5e-9), 1e6),
            row(4, None, 0.0),
            row(5, Some(3e-9), 1e6),
        ];
        let charts = charts(&scene, &rows);
        assert_eq!(charts[0].title, "mean pressure against mean gap");
        let found: Vec<(bool, usize)> = charts[0]
            .stretches
            .iter()
            .map(|stretch| (stretch.loading, stretch.points.len()))
            .collect();
        // Up; down from the peak; alone again after the surfaces had parted.
        assert_eq!(found, [(true, 2), (false, 2), (true, 1)]);
        assert_eq!(charts[0].stretches[1].points[0], [2e-9, 2e6]);
        assert_eq!(charts[1].stretches[0].points[1], [2e6, 0.1]);
    }

    #[test]
    fn a_smaller_mean_gap_is_loading_and_long_paths_are_thinned() {
        let scene = scene(
            "control = \"mean-gap\"\nstart = \"9 um\"\n[[loading.ramp]]\nto = 0\nsteps = 8999\n[[loading.ramp]]\nto = \"9 um\"\nsteps = 9000",
        );
        let path = scene.loading.path.clone();
        let rows: Vec<StepRow> = (path.iter().enumerate())
            .map(|(index, gap)| row(index + 1, Some(*gap), 1e6 - gap))
            .collect();
        let charts = charts(&scene, &rows);
        let stretches = &charts[0].stretches;
        assert_eq!(stretches.len(), 2);
        assert!(stretches[0].loading && !stretches[1].loading);
        let count: usize = stretches.iter().map(|s| s.points.len()).sum();
        assert!(count < 2 * MOST, "{count}");
        assert_eq!(stretches[1].points[0][0], 0.0, "the turning point stays");
    }
}
