//! A loading path in half and in twice as many steps, through the same turning points.

use crate::scene::LoadingScene;

/// How finely a path is walked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Steps {
    /// Every other step between turning points left out.
    Halved,
    /// As the scene has it.
    AsGiven,
    /// A step half way to each step.
    Doubled,
}

/// A path and which of its steps are the scene's.
#[derive(Clone, Debug, PartialEq)]
pub struct Walk {
    /// The path to walk.
    pub loading: LoadingScene,
    /// For each step of it, the scene's step that it is, from 0.
    pub scene_step: Vec<Option<usize>>,
}

impl Steps {
    /// The path of a scene walked this finely.
    pub fn of(self, loading: &LoadingScene) -> Walk {
        let path = &loading.path;
        let scene_step: Vec<Option<usize>> = match self {
            Steps::AsGiven => (0..path.len()).map(Some).collect(),
            Steps::Halved => kept(path).into_iter().map(Some).collect(),
            Steps::Doubled => (0..2 * path.len() - 1)
                .map(|step| step.is_multiple_of(2).then_some(step / 2))
                .collect(),
        };
        let value = |step: usize| match scene_step[step] {
            Some(own) => path[own],
            // Between the two steps of the scene on either side.
            None => 0.5 * (path[step / 2] + path[step / 2 + 1]),
        };
        let times = loading.durations.as_ref().map(|durations| {
            let ends: Vec<f64> = durations
                .iter()
                .scan(0.0, |time, duration| {
                    *time += duration;
                    Some(*time)
                })
                .collect();
            let time = |step: usize| match scene_step[step] {
                Some(own) => ends[own],
                None => 0.5 * (ends[step / 2] + ends[step / 2 + 1]),
            };
            (0..scene_step.len())
                .map(|step| time(step) - if step == 0 { 0.0 } else { time(step - 1) })
                .collect()
        });
        Walk {
            loading: LoadingScene {
                path: (0..scene_step.len()).map(value).collect(),
                durations: times,
                ..loading.clone()
            },
            scene_step,
        }
    }
}

/// Steps that stay when the others are left out: both ends, where the path turns or holds, and every
/// other one between.
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
        }
    }

    #[test]
    fn both_ends_and_the_turns_stay() {
        let scene = loading(&[0.0, 1.0, 2.0, 3.0, 4.0, 3.0, 2.0, 0.0], None);
        let halved = Steps::Halved.of(&scene);
        assert_eq!(halved.loading.path, [0.0, 2.0, 4.0, 2.0, 0.0]);
        assert_eq!(
            halved.scene_step,
            [Some(0), Some(2), Some(4), Some(6), Some(7)]
        );
        let doubled = Steps::Doubled.of(&loading(&[0.0, 1.0, -1.0], None));
        assert_eq!(doubled.loading.path, [0.0, 0.5, 1.0, 0.0, -1.0]);
        assert_eq!(doubled.scene_step, [Some(0), None, Some(1), None, Some(2)]);
        assert_eq!(Steps::AsGiven.of(&scene).loading, scene);
        let one = loading(&[2.0], None);
        for steps in [Steps::Halved, Steps::Doubled] {
            assert_eq!(steps.of(&one).loading.path, [2.0]);
        }
    }

    #[test]
    fn the_time_at_a_step_stays() {
        let scene = loading(&[0.0, 1.0, 2.0, 2.0], Some(vec![0.0, 1.0, 3.0, 5.0]));
        // The hold at the end is a turn, so the step before it stays.
        let halved = Steps::Halved.of(&scene);
        assert_eq!(halved.loading.path, [0.0, 2.0, 2.0]);
        assert_eq!(halved.loading.durations, Some(vec![0.0, 4.0, 5.0]));
        let doubled = Steps::Doubled.of(&scene);
        assert_eq!(
            doubled.loading.durations,
            Some(vec![0.0, 0.5, 0.5, 1.5, 1.5, 2.5, 2.5])
        );
    }
}
