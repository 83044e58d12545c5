//! The result of a run in a sentence: the last words of `tabor run` and the first line of a report.

use super::summary::Summary;
use crate::study::{State, StepRow, largest_contact};
use crate::units::format_si;

/// Loads below this share of the greatest count as zero: a treatment that searches for its load meets it to about this.
const UNLOADED: f64 = 1e-6;
/// Most steps that are named.
const NAMED: usize = 6;

/// The result of the rows of a run: contact area, pull-off or what still sticks, jumps, lost energy.
pub(crate) fn sentence(summary: &Summary, rows: &[StepRow]) -> String {
    let Some(largest) = largest_contact(rows) else {
        let words = match rows {
            [] => "No step is finished.",
            _ => "No step has a solution.",
        };
        return words.to_owned();
    };
    let mut clauses = vec![if largest.contact_area_fraction > 0.0 {
        let share = per_cent(largest.contact_area_fraction);
        format!(
            "The largest contact area is {share} of the nominal area (step {})",
            largest.step
        )
    } else {
        "The surfaces do not touch".to_owned()
    }];
    let solved = rows.iter().filter(|row| row.converged);
    let strongest = solved.min_by(|a, b| a.force.total_cmp(&b.force));
    if let Some(row) = strongest
        && largest.contact_area_fraction == 0.0
        && summary.pull_off_force.is_none()
        && row.force < 0.0
    {
        clauses.push(format!(
            "the greatest tension between them is {} (step {})",
            format_si(-row.force, "N"),
            row.step
        ));
    }
    let stuck = AtZeroLoad::from_rows(rows);
    if let (Some(force), Some(step)) = (summary.pull_off_force, summary.pull_off_step) {
        clauses.push(format!(
            "the pull-off force is {} (step {step})",
            format_si(force, "N")
        ));
    } else if let Some(left) = stuck.map(|place| place.value(rows, |row| row.contact_area_fraction))
        && left > 0.0
    {
        clauses.push(format!(
            "the surfaces stick at zero load, {} of the area in contact",
            per_cent(left)
        ));
    }
    let jumps: Vec<String> = [
        ("into", &summary.jump_in_steps),
        ("out of", &summary.jump_off_steps),
    ]
    .into_iter()
    .filter(|(_, steps)| !steps.is_empty())
    .map(|(way, steps)| format!("{way} contact in {}", step_words(steps)))
    .collect();
    if !jumps.is_empty() {
        clauses.push(format!("the surfaces jump {}", jumps.join(" and ")));
    }
    clauses.extend(loss(summary).map(|lost| format!("the loop loses {lost}")));
    let last = clauses.pop().unwrap_or_default();
    if clauses.is_empty() {
        format!("{last}.")
    } else {
        format!("{}, and {last}.", clauses.join(", "))
    }
}

/// What a loop loses, J: an upper bound where the loss is less than its uncertainty; `None` where no step jumps and the loss is below that.
pub(super) fn loss(summary: &Summary) -> Option<String> {
    let energy = summary.hysteresis_energy?;
    let jumps = !(summary.jump_in_steps.is_empty() && summary.jump_off_steps.is_empty());
    match summary.hysteresis_uncertainty {
        Some(uncertainty) if energy <= uncertainty => {
            jumps.then(|| format!("at most {}", format_si(energy + uncertainty, "J")))
        }
        _ => (energy > 0.0).then(|| format_si(energy, "J")),
    }
}

/// Where the load of a path falls back to zero after its greatest and the surfaces still hold together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AtZeroLoad {
    /// Index of the row at or beyond zero load.
    index: usize,
    /// How far zero lies from the row before to that row, from 0 to 1.
    share: f64,
}

impl AtZeroLoad {
    /// That place of a path, if it has one.
    pub fn from_rows(rows: &[StepRow]) -> Option<AtZeroLoad> {
        let greatest = rows
            .iter()
            .enumerate()
            .filter(|(_, row)| row.has_solution())
            .max_by(|a, b| a.1.force.total_cmp(&b.1.force))?
            .0;
        let none = UNLOADED * rows[greatest].force;
        // Without attraction nothing is left at zero load.
        let unloaded = |row: &StepRow| {
            row.converged && (row.force <= 0.0 || row.force <= none && row.adhesive_energy < 0.0)
        };
        let index = greatest + rows[greatest..].iter().position(unloaded)?;
        let [before, row] = [&rows[index.checked_sub(1)?], &rows[index]];
        let holds = row.state != State::Separated && index > greatest && before.force > 0.0;
        holds.then(|| AtZeroLoad {
            index,
            share: before.force / (before.force - row.force.min(0.0)),
        })
    }

    /// A value there, on the straight line between the two rows.
    pub fn value(self, rows: &[StepRow], value: impl Fn(&StepRow) -> f64) -> f64 {
        let [before, row] = [&rows[self.index - 1], &rows[self.index]].map(value);
        before + (row - before) * self.share
    }
}

pub(super) fn per_cent(share: f64) -> String {
    format!("{:.3} %", 100.0 * share)
}

/// As in `steps 3, 5`; of many the first ones.
pub(super) fn step_words(steps: &[usize]) -> String {
    if let [step] = steps {
        return format!("step {step}");
    }
    let shown: Vec<String> = steps.iter().take(NAMED).map(usize::to_string).collect();
    let more = if steps.len() > NAMED { " ..." } else { "" };
    format!("steps {}{more}", shown.join(", "))
}
