//! A loading path with half and with twice the steps, through the same turning points; for a
//! viscoelastic solid also with `steps = "auto"`, with equal steps, and with steps finer than all
//! of these.

use crate::scene::{DEFAULT_TIME_TOLERANCE, LoadingScene, Scene};

/// Time tolerances tried for `steps = "auto"`.
const TIME_TOLERANCES: [f64; 4] = [1e-1, 1e-2, 1e-3, 1e-4];
/// Times that differ by less than this share of the path's time are equal: they were summed in
/// different orders.
const SAME_TIME: f64 = 1e-12;

/// How finely a path is divided into steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Steps {
    /// Every other step between turning points is omitted.
    Halved,
    /// The scene's own steps.
    AsGiven,
    /// One more step half way to each step.
    Doubled,
    /// As many steps between turning points as the scene has, all of the same duration.
    Equal,
    /// `steps = "auto"` with this time tolerance.
    Auto(f64),
    /// Every tried step is divided at least in two.
    Finest,
}

/// Position of a step of the scene within another path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepPosition {
    /// Index of the step that it equals or that precedes it.
    pub step: usize,
    /// Position towards the next step by time, from 0 to below 1.
    pub share: f64,
}

impl StepPosition {
    fn at(step: usize) -> StepPosition {
        StepPosition { step, share: 0.0 }
    }
}

/// A path, and the positions of the scene's steps in it.
#[derive(Clone, Debug, PartialEq)]
pub struct PathVariant {
    /// The path.
    pub loading: LoadingScene,
    /// Position of each step of the scene; `None` if the path lacks it.
    pub places: Vec<Option<StepPosition>>,
}

impl Steps {
    /// The path of a scene with these steps.
    pub fn path(self, scene: &Scene) -> PathVariant {
        let loading = &scene.loading;
        let as_given = || PathVariant {
            loading: loading.clone(),
            places: (0..loading.path.len())
                .map(|s| Some(StepPosition::at(s)))
                .collect(),
        };
        let timed = match self {
            Steps::AsGiven => return as_given(),
            Steps::Halved => return halved(loading),
            Steps::Doubled => return doubled(loading),
            Steps::Equal => equal(loading),
            Steps::Auto(tolerance) => scene.auto_steps(tolerance),
            Steps::Finest => finest_tolerance(scene)
                .and_then(|tolerance| scene.auto_steps(tolerance))
                .map(|auto| doubled(&both(&doubled(loading).loading, &auto)).loading),
        };
        // A path without time has no time-dependent variants.
        timed.map_or_else(as_given, |timed| PathVariant {
            places: places(loading, &timed),
            loading: timed,
        })
    }

    /// The steps of the reference of a scene.
    pub fn for_reference(scene: &Scene) -> Steps {
        finest_tolerance(scene).map_or(Steps::Doubled, |_| Steps::Finest)
    }

    /// The steps that show the uncertainty of the reference in time: the difference from the finest
    /// steps that are compared.
    pub fn for_time_uncertainty(scene: &Scene) -> Steps {
        finest_tolerance(scene).map_or(Steps::AsGiven, Steps::Auto)
    }

    /// Every alternative to the scene's own steps.
    pub fn others(scene: &Scene) -> Vec<Steps> {
        let path = &scene.loading.path;
        let mut found = Vec::new();
        if path.len() > 1 {
            found.push(Steps::Doubled);
        }
        if halved(&scene.loading).loading.path.len() < path.len() {
            found.push(Steps::Halved);
        }
        let tolerances = time_tolerances(scene);
        let uneven = |equal: LoadingScene| {
            let places = places(&scene.loading, &equal);
            let mut steps = places.iter().enumerate();
            !steps.all(|(step, place)| *place == Some(StepPosition::at(step)))
        };
        if !tolerances.is_empty() && equal(&scene.loading).is_some_and(uneven) {
            found.push(Steps::Equal);
        }
        found.extend(tolerances.into_iter().map(Steps::Auto));
        found
    }

    /// A description such as `, half the steps`; empty for the scene's own.
    pub fn words(self) -> String {
        match self {
            Steps::AsGiven => String::new(),
            Steps::Halved => ", half the steps".to_owned(),
            Steps::Doubled => ", twice the steps".to_owned(),
            Steps::Equal => ", equal steps".to_owned(),
            Steps::Auto(tolerance) => format!(", auto steps to {tolerance:e}"),
            Steps::Finest => ", steps of the reference".to_owned(),
        }
    }
}

/// The time tolerances tried: down to the default, and below that while the path has no more than
/// twice the scene's own steps.
fn time_tolerances(scene: &Scene) -> Vec<f64> {
    let most = 2 * scene.loading.path.len();
    let is_tried = |tolerance: &f64| {
        let steps = scene.auto_steps(*tolerance);
        steps.is_some_and(|auto| *tolerance >= DEFAULT_TIME_TOLERANCE || auto.path.len() <= most)
    };
    TIME_TOLERANCES.into_iter().filter(is_tried).collect()
}

fn finest_tolerance(scene: &Scene) -> Option<f64> {
    time_tolerances(scene).into_iter().reduce(f64::min)
}

fn halved(loading: &LoadingScene) -> PathVariant {
    let kept = kept(&loading.path);
    let mut places = vec![None; loading.path.len()];
    for (step, own) in kept.iter().enumerate() {
        places[*own] = Some(StepPosition::at(step));
    }
    let ends = ends(loading);
    let durations = ends.map(|ends| {
        let before = |step: usize| if step == 0 { 0.0 } else { ends[kept[step - 1]] };
        (0..kept.len())
            .map(|step| ends[kept[step]] - before(step))
            .collect()
    });
    PathVariant {
        loading: LoadingScene {
            path: kept.iter().map(|own| loading.path[*own]).collect(),
            durations,
            ..loading.clone()
        },
        places,
    }
}

fn doubled(loading: &LoadingScene) -> PathVariant {
    let between = |values: &[f64], share: fn(f64, f64) -> [f64; 2]| {
        let pairs = values.windows(2).flat_map(|pair| share(pair[0], pair[1]));
        values.iter().copied().take(1).chain(pairs).collect()
    };
    let path = &loading.path;
    PathVariant {
        loading: LoadingScene {
            path: between(path, |from, to| [0.5 * (from + to), to]),
            durations: loading
                .durations
                .as_ref()
                .map(|durations| between(durations, |_, time| [0.5 * time; 2])),
            ..loading.clone()
        },
        places: (0..path.len())
            .map(|s| Some(StepPosition::at(2 * s)))
            .collect(),
    }
}

/// As many steps in each interval, all of the same duration; `None` if the path takes no time.
fn equal(loading: &LoadingScene) -> Option<LoadingScene> {
    loading.durations.as_ref()?;
    let mut path = vec![*loading.path.first()?];
    let mut durations = vec![0.0];
    for stretch in loading.stretches() {
        let (from, count) = (path[path.len() - 1], stretch.steps as f64);
        path.extend(
            (1..stretch.steps).map(|step| from + (stretch.to - from) * (step as f64 / count)),
        );
        path.push(stretch.to);
        durations.resize(path.len(), stretch.duration / count);
    }
    Some(LoadingScene {
        path,
        durations: Some(durations),
        ..loading.clone()
    })
}

/// The union of the steps of two paths through the same turning points; the first one has all jumps
/// of the second.
fn both(one: &LoadingScene, other: &LoadingScene) -> LoadingScene {
    let (Some(one_ends), Some(other_ends)) = (ends(one), ends(other)) else {
        return one.clone();
    };
    let same_time = SAME_TIME * one_ends.last().copied().unwrap_or(0.0);
    let mut others = other_ends.iter().zip(&other.path).peekable();
    let mut merged: Vec<(f64, f64)> = Vec::new();
    for (end, value) in one_ends.iter().zip(&one.path) {
        while let Some((between, value)) = others.next_if(|(other, _)| **other < end - same_time) {
            merged.push((*between, *value));
        }
        merged.push((*end, *value));
        // The same time, or a jump that the first path also has.
        while others
            .next_if(|(other, _)| (**other - end).abs() <= same_time)
            .is_some()
        {}
    }
    let mut before = 0.0;
    LoadingScene {
        path: merged.iter().map(|(_, value)| *value).collect(),
        durations: Some(
            merged
                .iter()
                .map(|(end, _)| end - std::mem::replace(&mut before, *end))
                .collect(),
        ),
        ..one.clone()
    }
}

/// End time of each step, s; `None` if the path takes no time.
fn ends(loading: &LoadingScene) -> Option<Vec<f64>> {
    let durations = loading.durations.as_ref()?;
    let ends = durations.iter().scan(0.0, |time, duration| {
        *time += duration;
        Some(*time)
    });
    Some(ends.collect())
}

/// Positions of the steps of a path within another through the same turning points, by time.
fn places(own: &LoadingScene, walk: &LoadingScene) -> Vec<Option<StepPosition>> {
    let (Some(own_ends), Some(ends)) = (ends(own), ends(walk)) else {
        return vec![None; own.path.len()];
    };
    let whole = ends.last().copied().unwrap_or(0.0);
    let same_time = SAME_TIME * whole;
    let scale = own.path.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    let place = |(time, value): (&f64, &f64)| {
        // At a jump of the path several steps share one time.
        let first = ends.partition_point(|end| *end < time - same_time);
        let at = (first..ends.len()).take_while(|step| ends[*step] <= time + same_time);
        let off = |step: &usize| (walk.path[*step] - value).abs();
        let nearest = at.min_by(|a, b| off(a).total_cmp(&off(b)));
        match nearest {
            Some(step) => (off(&step) <= SAME_TIME * scale).then(|| StepPosition::at(step)),
            None => (first > 0 && first < ends.len()).then(|| {
                let (before, after) = (ends[first - 1], ends[first]);
                StepPosition {
                    step: first - 1,
                    share: (time - before) / (after - before),
                }
            }),
        }
    };
    own_ends.iter().zip(&own.path).map(place).collect()
}

/// Indices of the steps that remain: both ends, turning points, holds, and every other step
/// between.
fn kept(path: &[f64]) -> Vec<usize> {
    let direction = |step: usize| (path[step + 1] - path[step]).partial_cmp(&0.0);
    let last = path.len() - 1;
    let mut kept = vec![0];
    let mut since = 0;
    for step in 1..=last {
        let turns = step < last && direction(step - 1) != direction(step);
        since += 1;
        if step == last || turns || since == 2 {
            kept.push(step);
            since = 0;
        }
    }
    kept.truncate(path.len());
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Control;

    fn loading(path: &[f64], durations: Option<Vec<f64>>) -> LoadingScene {
        LoadingScene {
            control: Control::Approach,
            path: path.to_vec(),
            durations,
            spring: None,
            pull_off_tolerance: 0.01,
            until_apart: false,
        }
    }

    fn own(walk: &PathVariant) -> Vec<Option<usize>> {
        let step = |place: &Option<StepPosition>| {
            place.map(|place| {
                assert_eq!(place.share, 0.0);
                place.step
            })
        };
        walk.places.iter().map(step).collect()
    }

    /// A force applied, held, and removed in half the time, on a solid of two relaxation times.
    fn relaxing(steps: &str) -> Scene {
        let text = format!(
            r#"
            [grid]
            points = 16
            size = 1.0
            boundary = "free"
            [solid]
            contact_modulus = 1.0
            [[solid.relaxation]]
            modulus = 5.0
            time = 0.1
            [[solid.relaxation]]
            modulus = 2.0
            time = 3.0
            [[surface]]
            kind = "sphere"
            radius = 1.0
            [loading]
            control = "force"
            start = 0
            [[loading.ramp]]
            to = 0.3
            steps = {steps}
            duration = 1
            [[loading.ramp]]
            hold = 7
            steps = {steps}
            [[loading.ramp]]
            to = 0.1
            steps = {steps}
            duration = 0.5
            "#
        );
        let parsed = Scene::parse(&text, "test.toml", std::path::Path::new("."), &[]);
        parsed.unwrap_or_else(|errors| panic!("{errors}"))
    }

    #[test]
    fn halving_keeps_ends_and_turning_points() {
        let scene = loading(&[0.0, 1.0, 2.0, 3.0, 4.0, 3.0, 2.0, 0.0], None);
        let half = halved(&scene);
        assert_eq!(half.loading.path, [0.0, 2.0, 4.0, 2.0, 0.0]);
        let kept = [
            Some(0),
            None,
            Some(1),
            None,
            Some(2),
            None,
            Some(3),
            Some(4),
        ];
        assert_eq!(own(&half), kept);
        let double = doubled(&loading(&[0.0, 1.0, -1.0], None));
        assert_eq!(double.loading.path, [0.0, 0.5, 1.0, 0.0, -1.0]);
        assert_eq!(own(&double), [Some(0), Some(2), Some(4)]);
        let one = loading(&[2.0], None);
        for walk in [halved(&one), doubled(&one)] {
            assert_eq!(walk.loading.path, [2.0]);
        }
    }

    #[test]
    fn halving_keeps_times() {
        let scene = loading(&[0.0, 1.0, 2.0, 2.0], Some(vec![0.0, 1.0, 3.0, 5.0]));
        // The final hold is a turning point, so the step before it stays.
        let half = halved(&scene);
        assert_eq!(half.loading.path, [0.0, 2.0, 2.0]);
        assert_eq!(half.loading.durations, Some(vec![0.0, 4.0, 5.0]));
        let double = doubled(&scene);
        assert_eq!(
            double.loading.durations,
            Some(vec![0.0, 0.5, 0.5, 1.5, 1.5, 2.5, 2.5])
        );
    }

    #[test]
    fn positions_within_a_path_follow_time() {
        let fine = loading(
            &[0.0, 1.0, 2.0, 3.0, 9.0, 9.0],
            Some(vec![0.0, 1.0, 1.0, 1.0, 0.0, 2.0]),
        );
        let coarse = loading(&[0.0, 3.0, 9.0, 9.0], Some(vec![0.0, 3.0, 0.0, 2.0]));
        let found = places(&fine, &coarse);
        // The jump at time 3 has a step before and one after it.
        for (own, step) in [(0, 0), (3, 1), (4, 2), (5, 3)] {
            assert_eq!(found[own], Some(StepPosition::at(step)));
        }
        for (own, share) in [(1, 1.0 / 3.0), (2, 2.0 / 3.0)] {
            let place = found[own].expect("within the path");
            assert_eq!(place.step, 0);
            assert!((place.share - share).abs() < 1e-15);
        }
        assert!(places(&coarse, &fine).iter().all(Option::is_some));
    }

    /// Within a step the response is linear in time, so a compared step must span at least two
    /// steps of the reference.
    #[test]
    fn the_reference_is_twice_as_fine_as_all_compared_paths() {
        for steps in ["2", "30", "500", "\"auto\""] {
            let scene = relaxing(steps);
            assert_eq!(Steps::for_reference(&scene), Steps::Finest);
            let finest = ends(&Steps::Finest.path(&scene).loading).expect("a path in time");
            let mut judged = Steps::others(&scene);
            assert!(judged.contains(&Steps::Auto(1e-1)) && judged.contains(&Steps::Auto(1e-3)));
            assert_eq!(judged.contains(&Steps::Auto(1e-4)), steps == "500");
            assert_eq!(judged.contains(&Steps::Equal), steps == "\"auto\"");
            judged.push(Steps::AsGiven);
            for steps in judged {
                let walk = steps.path(&scene);
                assert!(walk.places.iter().all(|place| place.is_some()) || steps == Steps::Halved);
                let coarse = ends(&walk.loading).expect("a path in time");
                for pair in coarse.windows(2) {
                    let longest = finest
                        .windows(2)
                        .filter(|fine| fine[0] < pair[1] - 1e-9 && fine[1] > pair[0] + 1e-9)
                        .map(|fine| fine[1] - fine[0])
                        .fold(0.0, f64::max);
                    assert!(
                        longest < 0.501 * (pair[1] - pair[0]),
                        "{steps:?}: {longest} {pair:?}"
                    );
                }
            }
        }
        let elastic = Scene {
            solid: crate::scene::SolidScene {
                relaxation: Vec::new(),
                ..relaxing("4").solid
            },
            ..relaxing("4")
        };
        assert_eq!(Steps::for_reference(&elastic), Steps::Doubled);
        assert_eq!(Steps::others(&elastic), [Steps::Doubled, Steps::Halved]);
    }

    #[test]
    fn equal_steps_are_as_many_on_each_ramp() {
        let auto = relaxing("\"auto\"");
        let equal = Steps::Equal.path(&auto);
        assert_eq!(equal.loading.path.len(), auto.loading.path.len());
        let stretches = |loading: &LoadingScene| -> Vec<(f64, usize)> {
            loading
                .stretches()
                .iter()
                .map(|part| (part.to, part.steps))
                .collect()
        };
        assert_eq!(stretches(&equal.loading), stretches(&auto.loading));
        assert_eq!(stretches(&auto.loading).len(), 3);
        let durations = equal.loading.durations.expect("a path in time");
        let mut different = durations[1..].to_vec();
        different.dedup();
        assert_eq!(different.len(), 3);
    }
}
