//! The curves of a run: load against distance, contact area against load.

use super::{Axis, DIRECTIONS, Figure, LARGE, Panel, PlotPoint, SMALL, Series, Style};
use crate::scene::{Boundary, Control, Scene};
use crate::study::StepRow;

/// Rows above which a curve is thinned: more than a picture has columns.
const MOST: usize = 4000;
/// Points of a curve up to which each is marked.
const MARKED: usize = 120;
/// Indices into [`DIRECTIONS`], and their names.
const LOADING: usize = 0;
const UNLOADING: usize = 1;
const NAMES: [&str; 2] = ["loading", "unloading"];
/// Sizes of a curve on the page of the report.
const PAGE: Style = Style {
    width: 460,
    heights: &[300],
    mark: 3.4,
    ticks: 6,
    ..SMALL
};

/// The curves of a run side by side.
pub fn run_figure(scene: &Scene, rows: &[StepRow]) -> Figure {
    Figure {
        title: scene.title.clone().unwrap_or_default(),
        style: LARGE,
        ..figure(panels(scene, rows))
    }
}

/// A further quantity of the steps.
pub(in crate::output) struct Quantity {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// Its value in each row, where it has one.
    pub values: Vec<Option<f64>>,
    /// Whether it is drawn against the distance, in place of the load.
    pub by_distance: bool,
}

/// A figure for each curve of a run, and one for each further quantity that has values.
pub(in crate::output) fn figures(
    scene: &Scene,
    rows: &[StepRow],
    quantities: &[Quantity],
) -> Vec<Figure> {
    let alone = |panel| Figure {
        style: PAGE,
        ..figure(vec![panel])
    };
    let curves = Curves::new(scene, rows);
    let with_values = |quantity: &&Quantity| quantity.values.iter().any(Option::is_some);
    let further = quantities.iter().filter(with_values);
    panels(scene, rows)
        .into_iter()
        .chain(further.map(|quantity| curves.quantity(quantity)))
        .map(alone)
        .collect()
}

/// Panels whose directions are named where there are two.
fn figure(panels: Vec<Panel>) -> Figure {
    let has = |name: usize| {
        let mut series = panels.iter().flat_map(|panel| &panel.series);
        series.any(|series| series.name == name)
    };
    let names: &[&str] = if has(LOADING) && has(UNLOADING) {
        &NAMES
    } else {
        &[]
    };
    Figure {
        names: names.iter().map(|name| (*name).to_owned()).collect(),
        pens: DIRECTIONS,
        panels,
        ..Figure::default()
    }
}

/// A stretch of a curve in one direction.
#[derive(Clone, Debug, PartialEq)]
struct Stretch {
    loading: bool,
    /// Whether it begins at the last point of the one before.
    continues: bool,
    points: Vec<[f64; 2]>,
}

/// The finished rows of a path as curves.
///
/// Rows without an equilibrium interrupt a curve; rows that did not converge are left out.
struct Curves<'a> {
    rows: &'a [StepRow],
    loading: Vec<bool>,
    by_gap: bool,
    by_force: bool,
}

impl<'a> Curves<'a> {
    fn new(scene: &Scene, rows: &'a [StepRow]) -> Self {
        let control = scene.loading.control;
        Curves {
            rows,
            loading: directions(scene, rows.len()),
            by_gap: matches!(control, Control::Pressure | Control::MeanGap),
            by_force: scene.grid.boundary == Boundary::Free
                || matches!(control, Control::Force | Control::Approach),
        }
    }

    /// Name and unit of the load.
    fn load_name(&self) -> [&'static str; 2] {
        if self.by_force {
            ["force", "N"]
        } else {
            ["mean pressure", "Pa"]
        }
    }

    fn load(&self, row: &StepRow) -> f64 {
        if self.by_force {
            row.force
        } else {
            row.mean_pressure
        }
    }

    /// Name and unit of the distance.
    fn distance_name(&self) -> [&'static str; 2] {
        [if self.by_gap { "mean gap" } else { "approach" }, "m"]
    }

    fn distance(&self, row: &StepRow) -> Option<f64> {
        if self.by_gap {
            row.mean_gap
        } else {
            row.approach
        }
    }

    /// A panel of `y` against `x`, each a name and a unit; `point` gives both of a row by its index.
    fn panel(
        &self,
        y: [&str; 2],
        x: [&str; 2],
        point: impl Fn(usize, &StepRow) -> Option<[f64; 2]>,
    ) -> Panel {
        let rows = self.rows.iter().enumerate();
        let points: Vec<Option<[f64; 2]>> = rows
            .map(|(index, row)| self.distance(row).and_then(|_| point(index, row)))
            .collect();
        Panel {
            title: format!("{} against {}", y[0], x[0]),
            x: Axis::linear(x[0], x[1]),
            y: Axis::linear(y[0], y[1]),
            series: series(&stretches(self.rows, &points, &self.loading)),
        }
    }

    fn quantity(&self, quantity: &Quantity) -> Panel {
        let y = [quantity.name.as_str(), quantity.unit];
        let mut panel = if quantity.by_distance {
            self.panel(y, self.distance_name(), |index, row| {
                Some([self.distance(row)?, quantity.values[index]?])
            })
        } else {
            self.panel(y, self.load_name(), |index, row| {
                Some([self.load(row), quantity.values[index]?])
            })
        };
        panel.y.logarithmic = spans_decades(quantity.values.iter().flatten());
        panel
    }
}

/// Share of the greatest value below which one is lost on a linear axis.
const LOST: f64 = 1.0 / 30.0;

/// Whether a linear axis would lose most of the values, none of which is below 0.
fn spans_decades<'v>(values: impl Iterator<Item = &'v f64>) -> bool {
    let mut values: Vec<f64> = values.copied().filter(|value| *value != 0.0).collect();
    values.sort_by(f64::total_cmp);
    let (Some(least), Some(greatest)) = (values.first(), values.last()) else {
        return false;
    };
    *least > 0.0 && values[values.len() / 2] < LOST * greatest
}

/// Load against distance, and contact area against load.
fn panels(scene: &Scene, rows: &[StepRow]) -> Vec<Panel> {
    let curves = Curves::new(scene, rows);
    let [load, distance] = [curves.load_name(), curves.distance_name()];
    vec![
        curves.panel(load, distance, |_, row| {
            Some([curves.distance(row)?, curves.load(row)])
        }),
        curves.panel(["contact area", "%"], load, |_, row| {
            Some([curves.load(row), row.contact_area_fraction])
        }),
    ]
}

/// A line for each stretch, and marks where there are few: that of a turning point belongs to the stretch before it.
fn series(stretches: &[Stretch]) -> Vec<Series> {
    let count: usize = stretches.iter().map(|stretch| stretch.points.len()).sum();
    let name = |stretch: &Stretch| if stretch.loading { LOADING } else { UNLOADING };
    let points = |stretch: &Stretch, skipped: usize| -> Vec<PlotPoint> {
        let points = stretch.points.iter().skip(skipped);
        let hollow = !stretch.loading;
        points.map(|&[x, y]| PlotPoint { x, y, hollow }).collect()
    };
    let lines = stretches
        .iter()
        .map(|it| Series::line(name(it), points(it, 0)));
    let marks = stretches
        .iter()
        .filter(|_| count <= MARKED)
        .map(|it| Series::marks(name(it), points(it, usize::from(it.continues))));
    lines.chain(marks).collect()
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
    // Steps behind the path pull.
    loading
        .iter_mut()
        .skip(path.len())
        .for_each(|step| *step = false);
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
                continues: before.is_some(),
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

    #[test]
    fn what_falls_by_decades_has_a_logarithmic_axis() {
        let flows = [3.1e-15, 2.4e-16, 5e-17, 1.4e-17, 2.5e-19, 0.0];
        assert!(spans_decades(flows.iter()));
        assert!(!spans_decades([-1e-9, 3e-15, 1e-17].iter()));
        // Few small values, or none at all.
        assert!(!spans_decades([1.0, 0.9, 0.7, 1e-6].iter()));
        assert!(!spans_decades([0.0, 0.0].iter()));
    }

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
        let panels = panels(&scene, &rows);
        assert_eq!(panels[0].title, "mean pressure against mean gap");
        let lines = |panel: &Panel| -> Vec<Series> {
            let series = panel.series.iter().filter(|series| series.line);
            series.cloned().collect()
        };
        let [first, second] = [lines(&panels[0]), lines(&panels[1])];
        let found: Vec<(usize, usize)> = first
            .iter()
            .map(|series| (series.name, series.points.len()))
            .collect();
        // Up; down from the peak; alone again after the surfaces had parted.
        assert_eq!(found, [(LOADING, 2), (UNLOADING, 2), (LOADING, 1)]);
        let place = |point: &PlotPoint| [point.x, point.y];
        assert_eq!(place(&first[1].points[0]), [2e-9, 2e6]);
        assert_eq!(place(&second[0].points[1]), [2e6, 0.1]);
        // The turning point has one mark.
        let marked = panels[0].series.iter().filter(|series| series.marks);
        assert_eq!(marked.map(|series| series.points.len()).sum::<usize>(), 4);
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
        let panels = panels(&scene, &rows);
        // Lines without marks.
        let series = &panels[0].series;
        let names: Vec<usize> = series.iter().map(|series| series.name).collect();
        assert_eq!(names, [LOADING, UNLOADING]);
        let count: usize = series.iter().map(|series| series.points.len()).sum();
        assert!(count < 2 * MOST, "{count}");
        assert_eq!(series[1].points[0].x, 0.0, "the turning point stays");
    }
}
