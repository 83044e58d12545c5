//! `report.html`: one self-contained page with the results of a run.
//!
//! The page contains neither seconds nor dates, so that the same run gives the same page. It loads
//! nothing and runs no script: pictures are embedded, and a content policy forbids the rest.

mod pictures;
mod scene_table;

use std::fs;

use base64::{Engine as _, engine::general_purpose::STANDARD};
use maud::{DOCTYPE, Markup, PreEscaped, html};

use self::pictures::{Pictured, chosen, png_size};
use super::picture::Load;
use super::plot::curves::{self, Quantity};
use super::sentence::{AtZeroLoad, loss, per_cent, sentence, step_words};
use super::summary::Summary;
use super::visible::visible;
use crate::effect::Effect;
use crate::study::{Checkpoint, Planned, Setup, StepRow, count_of_steps, largest_contact};
use crate::units::format_si;

/// Most bytes of pictures on a page, so that a phone can open it; one picture is always shown.
const MOST_PICTURE_BYTES: usize = 12 << 20;
/// Rows at either end of a long table of steps.
const SHOWN_STEPS: usize = 60;
/// Heads of the table of steps but for the last.
const STEP_HEADS: [&str; 8] = [
    "step",
    "approach",
    "mean gap",
    "force",
    "mean pressure",
    "contact",
    "iterations",
    "residual",
];
/// Column of the force with which the surfaces attract each other.
const ATTRACTION: &str = "attractive_force";
/// The end of the column names of what is infinite without contact.
const RESISTANCE: &str = "resistance";
const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Nothing is loaded, and no script runs.
const POLICY: &str = "default-src 'none'; img-src data:; style-src 'unsafe-inline'";

/// Contents of the page.
pub struct Report<'a> {
    /// The scene and its setup.
    pub setup: &'a Setup,
    /// Backend, adapter and precision, in words.
    pub machine: String,
    /// Rows of all steps done.
    pub rows: &'a [StepRow],
    /// Jumps and transforms so far.
    pub tallies: &'a Checkpoint,
    /// Warnings so far.
    pub warnings: &'a [String],
    /// The existing pictures: step, field and file.
    pub pictures: &'a [Pictured],
    /// The summary, once the run has ended.
    pub summary: Option<&'a Summary>,
}

/// A part of the page under a heading.
fn section(heading: &str, content: Markup) -> Markup {
    html! {
        section { h2 { (heading) } (content) }
        "\n"
    }
}

/// A table of a name and a value a row.
fn facts<N: AsRef<str>>(rows: &[(N, String)]) -> Markup {
    html! {
        div.scroll { table { tbody {
            @for (name, value) in rows { tr { th scope="row" { (name.as_ref()) } td { (value) } } "\n" }
        } } }
    }
}

impl Report<'_> {
    /// The page.
    pub fn html(&self) -> String {
        let title = self.title();
        let style = PreEscaped(include_str!("style.css"));
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta http-equiv="Content-Security-Policy" content=(POLICY);
                    meta name="generator" content={ "tabor " (VERSION) };
                    link rel="icon" href="data:,";
                    title { (title) }
                    style { (style) }
                }
                body { main {
                    header {
                        h1 { (title) }
                        @if let Some(summary) = self.summary { p.result { (sentence(summary, self.rows)) } }
                        (self.status())
                    }
                    (self.figures())
                    (self.warnings())
                    (self.curves())
                    (self.pictures())
                    (self.effects())
                    (section("Scene", scene_table::html(self.setup)))
                    (section("Solution", facts(&self.solution())))
                    (self.steps())
                    footer {
                        "Written by tabor " (VERSION) ". Beside this page: " code { "curve.csv" }
                        " has every step with all its columns, " code { "summary.json" }
                        " the same facts for programs."
                    }
                } }
            }
        };
        // What a scene or a file name brings along can neither move a cursor nor turn the direction of writing.
        visible(&page.into_string()).into_owned()
    }

    fn title(&self) -> String {
        let title = self.setup.scene.title.as_deref().unwrap_or_default();
        match title.trim() {
            "" => "A contact solved by tabor".to_owned(),
            title => title.to_owned(),
        }
    }

    /// The progress of the run.
    fn status(&self) -> Markup {
        let done = self.rows.len();
        let is_over = Planned::after(self.setup, self.rows).is_none();
        let steps = self.setup.scene.loading.path.len().max(done);
        let tolerance = self.setup.scene.solver.tolerance;
        let plural = if steps == 1 { "" } else { "s" };
        let finished = count_of_steps(done, steps);
        let resume =
            html! { code { "tabor run" } " with " code { "--resume" } " continues after them." };
        match (self.rows.last(), self.summary) {
            (Some(last), Some(_)) if !last.converged => html! {
                p.status.early {
                    "Ended early: step " (done) " of " (steps) " did not converge (residual "
                    (format!("{:.1e}, asked {tolerance:.1e}", last.residual))
                    "). The steps before it stand; this one is shown as it was."
                }
            },
            (_, Some(_)) if is_over => html! {
                p.status { "Finished: " (steps) " step" (plural) ", converged to " (format!("{tolerance:e}")) "." }
            },
            (_, Some(_)) => html! {
                p.status.early { "Ended early: " (finished) " finished. " (resume) }
            },
            (_, None) => html! {
                p.status.early {
                    "Not finished: " (finished) " done when this page was written. "
                    "If the run has ended, " (resume)
                }
            },
        }
    }

    /// What effects add to the rows, and the work of a loop.
    fn quantities(&self) -> Vec<Quantity> {
        let columns = self.setup.columns().into_iter();
        let mut found: Vec<Quantity> = columns
            .map(|column| Quantity {
                name: column.name().replace('_', " "),
                unit: column.unit,
                values: self.rows.iter().map(|row| column.value(row)).collect(),
                by_distance: false,
            })
            .collect();
        if let Some(spring) = self.setup.scene.loading.spring {
            let base = |row: &StepRow| row.approach.map(|approach| approach + row.force / spring);
            found.push(Quantity {
                name: "base position".to_owned(),
                unit: "m",
                values: self.rows.iter().map(base).collect(),
                by_distance: true,
            });
        }
        if self
            .summary
            .is_some_and(|summary| summary.hysteresis_energy.is_some())
        {
            found.push(Quantity {
                name: "work done".to_owned(),
                unit: "J",
                values: work_done(self.rows),
                by_distance: true,
            });
        }
        found
    }

    /// Results that effects add: those that grow along the path at its end, the others at the largest contact, or where
    /// they are greatest on a path without contact.
    fn results_of_effects(&self) -> Vec<(String, String, String)> {
        let solved = || self.rows.iter().filter(|row| row.converged);
        let largest = largest_contact(self.rows);
        let touches = largest.is_some_and(|row| row.contact_area_fraction > 0.0);
        let at_zero = AtZeroLoad::from_rows(self.rows);
        let mut found = Vec::new();
        for column in self.setup.columns() {
            let grows = column.is_dissipated_energy;
            let row = match (grows, touches) {
                (true, _) => self.rows.last(),
                (false, true) => largest,
                (false, false) => solved()
                    .filter_map(|row| Some((row, column.value(row)?.abs())))
                    // The first of equal ones.
                    .rev()
                    .max_by(|a, b| a.1.total_cmp(&b.1))
                    .map(|(row, _)| row),
            };
            let Some((row, value)) = row.and_then(|row| Some((row, column.value(row)?))) else {
                continue;
            };
            // What is left of the attraction has a figure of its own.
            let at_zero = at_zero.filter(|_| column.name() != ATTRACTION);
            // A resistance is there what the conductance is.
            let inverse = column.name().ends_with(RESISTANCE);
            let turned = |value: f64| if inverse { value.recip() } else { value };
            let left = at_zero.map(|place| {
                let value = |row: &StepRow| column.value(row).map_or(f64::NAN, turned);
                turned(place.value(self.rows, value))
            });
            let place = match touches {
                true => format!("at the largest contact, step {}", row.step),
                false => format!("the greatest of the path, step {}", row.step),
            };
            let note = match left.filter(|left| left.is_finite()) {
                _ if grows => format!("lost up to step {}", row.step),
                Some(left) => format!("{place}; {} at zero load", format_si(left, column.unit)),
                None => place,
            };
            let mut name = column.name().replace('_', " ");
            name[..1].make_ascii_uppercase();
            found.push((name, format_si(value, column.unit), note));
        }
        found
    }

    /// The main results: name, value and note.
    fn main_results(&self) -> Vec<(&'static str, String, String)> {
        let mut found = Vec::new();
        if let Some(row) = largest_contact(self.rows) {
            let note = match row.contact_area_fraction > 0.0 {
                true => format!("of the nominal area, step {}", row.step),
                false => "the surfaces do not touch".to_owned(),
            };
            found.push(("Largest contact", per_cent(row.contact_area_fraction), note));
        }
        let tension = self
            .rows
            .iter()
            .filter(|row| row.converged && row.force < 0.0)
            .min_by(|a, b| a.force.total_cmp(&b.force));
        let bounds = self.summary.and_then(|summary| {
            let bounds = summary.pull_off_lower.zip(summary.pull_off_upper)?;
            Some((summary.pull_off_force?, summary.pull_off_step?, bounds))
        });
        if let Some((force, step, (lower, upper))) = bounds {
            let [lower, upper] = [lower, upper].map(|force| format_si(force, "N"));
            let note = format!("after step {step}, between {lower} and {upper}");
            found.push(("Pull-off", format_si(force, "N"), note));
        } else if let Some(row) = tension {
            let note = format!("step {}", row.step);
            found.push(("Largest tension", format_si(-row.force, "N"), note));
        }
        if let Some(place) = AtZeroLoad::from_rows(self.rows) {
            let left = place.value(self.rows, |row| row.contact_area_fraction);
            let note = "in contact, of the nominal area".to_owned();
            found.push(("Left at zero load", per_cent(left), note));
            let force = |row: &StepRow| row.column(ATTRACTION).unwrap_or(f64::NAN);
            let left = place.value(self.rows, force);
            if left.is_finite() {
                let note = "balanced by the pressure of the contact".to_owned();
                found.push(("Attraction left at zero load", format_si(left, "N"), note));
            }
        }
        for (name, at) in [
            ("Jumps into contact", &self.tallies.jump_in_steps),
            ("Jumps out of contact", &self.tallies.jump_off_steps),
        ] {
            if !at.is_empty() {
                found.push((name, at.len().to_string(), step_words(at)));
            }
        }
        if let Some(lost) = self.summary.and_then(loss) {
            found.push(("Hysteresis", lost, "lost over the loop".to_owned()));
        }
        if let Some(regime) = &self.setup.regime
            && let Some(tabor) = regime.tabor
        {
            let name = regime.name().split(':').next().unwrap_or_default();
            let value = format!("{tabor:.3}");
            found.push(("Tabor number", value, name.to_owned()));
        }
        found
    }

    fn figures(&self) -> Markup {
        let own = self.main_results().into_iter();
        let own = own.map(|(name, value, note)| (name.to_owned(), value, note));
        let found: Vec<_> = own.chain(self.results_of_effects()).collect();
        html! {
            @if !found.is_empty() {
                dl.figures {
                    @for (name, value, note) in found { div { dt { (name) } dd { (value) small { (note) } } } }
                }
            }
        }
    }

    fn warnings(&self) -> Markup {
        html! {
            @if !self.warnings.is_empty() {
                section.warnings { strong { "Warnings" } ul { @for warning in self.warnings { li { (warning) } } } }
            }
        }
    }

    fn curves(&self) -> Markup {
        if !self.rows.iter().any(|row| row.converged) {
            return html! {};
        }
        let figures = curves::figures(&self.setup.scene, self.rows, &self.quantities());
        let curves = html! {
            div.grid {
                @for figure in &figures { figure { (figure.svg(&figure.panels[0].title)) } "\n" }
            }
            p.status {
                "Force and pressure are positive in compression, approach is positive towards the solid"
                @if self.setup.scene.loading.spring.is_some() {
                    " and is that of the probe; the base position is that of the spring's far end, which the path prescribes"
                }
                "."
            }
        };
        section("Curves", curves)
    }

    fn pictures(&self) -> Markup {
        let loading = &self.setup.scene.loading;
        let mut shown = Vec::new();
        let mut bytes_shown = 0;
        for (step, field, path) in chosen(self.pictures) {
            // A picture that cannot be read is left out.
            let Ok(bytes) = fs::read(path) else { continue };
            if !shown.is_empty() && bytes_shown + bytes.len() > MOST_PICTURE_BYTES {
                continue;
            }
            let load = Planned::of_step(self.setup, self.rows, *step)
                .map(|value| format!(", {}", Load::on_path(loading, value).words()));
            let words = format!("{field}, step {step}{}", load.unwrap_or_default());
            let [width, height] = png_size(&bytes).map_or([None; 2], |size| size.map(Some));
            let source = format!("data:image/png;base64,{}", STANDARD.encode(&bytes));
            shown.push(html! {
                figure {
                    img alt=(words) width=[width] height=[height] src=(source);
                    figcaption { (words) }
                }
                "\n"
            });
            bytes_shown += bytes.len();
        }
        if shown.is_empty() {
            return html! {};
        }
        let rest = self.pictures.len() - shown.len();
        let pictures = html! {
            div.grid { @for picture in &shown { (picture) } }
            @if rest > 0 {
                p.status {
                    (shown.len()) " of " (self.pictures.len()) " pictures; the other " (rest) " are in "
                    code { "images/" } "."
                }
            }
        };
        section("Snapshots", pictures)
    }

    fn effects(&self) -> Markup {
        let scene = &self.setup.scene;
        let effects = Effect::ALL.iter().filter(|effect| effect.is_on(scene));
        let effects: Vec<(&str, String)> = effects
            .map(|effect| (effect.name(), effect.purpose().to_owned()))
            .collect();
        if effects.is_empty() {
            return html! {};
        }
        section("Effects", facts(&effects))
    }

    /// How the run was solved.
    fn solution(&self) -> Vec<(&'static str, String)> {
        let setup = self.setup;
        let grid = setup.surface.grid;
        let moments = setup.statistics.moments;
        let iterations: usize = self.rows.iter().map(|row| row.iterations).sum();
        let transforms = self.tallies.transforms + setup.transforms;
        let mut facts = vec![
            ("grid", format!("{} × {} points", grid.nx, grid.ny)),
            ("rms height", format_si(moments.rms_height(), "m")),
            ("rms slope", format!("{:.4}", moments.rms_slope())),
            ("computed on", self.machine.clone()),
            ("tolerance", format!("{:e}", setup.scene.solver.tolerance)),
            ("iterations", iterations.to_string()),
            ("transforms", format!("{transforms:.1}")),
        ];
        if let Some(regime) = &setup.regime {
            let pixels = format!("{:.2} pixels across it", regime.zone_pixels);
            facts.push(("cohesive zone", pixels));
        }
        facts
    }

    fn steps(&self) -> Markup {
        if self.rows.is_empty() {
            return html! {};
        }
        // All, or both ends.
        let left_out = self.rows.len().saturating_sub(2 * SHOWN_STEPS);
        let (first, last) = match left_out {
            0 => (self.rows, &[][..]),
            left_out => (
                &self.rows[..SHOWN_STEPS],
                &self.rows[SHOWN_STEPS + left_out..],
            ),
        };
        let quantities = self.quantities();
        let names = quantities.iter().map(|quantity| quantity.name.as_str());
        let heads: Vec<&str> = STEP_HEADS.into_iter().chain(names).collect();
        let steps = html! {
            div.scroll { table.steps {
                thead { tr {
                    @for head in &heads { th scope="col" .number { (head) } }
                    th scope="col" { "state" }
                } }
                tbody {
                    @for (index, row) in first.iter().enumerate() { (step(row, &quantities, index)) }
                    @if left_out > 0 {
                        tr { td colspan=(heads.len() + 1) { (left_out) " steps more are in " code { "curve.csv" } } }
                    }
                    @for (index, row) in last.iter().enumerate() {
                        (step(row, &quantities, SHOWN_STEPS + left_out + index))
                    }
                }
            } }
        };
        section("Steps", steps)
    }
}

/// Work done on the surfaces up to each step of a path of approach or mean gap, J.
fn work_done(rows: &[StepRow]) -> Vec<Option<f64>> {
    let mut work = Some(0.0);
    let mut before: Option<&StepRow> = None;
    let after = |row| {
        if let Some(before) = before.replace(row) {
            let moved = row
                .approach
                .zip(before.approach)
                .map(|(to, from)| to - from);
            work = work
                .zip(moved)
                .map(|(work, moved)| work + 0.5 * (before.force + row.force) * moved);
        }
        work
    };
    rows.iter().map(after).collect()
}

/// A row of the table of steps, with the further quantities at its index.
fn step(row: &StepRow, quantities: &[Quantity], index: usize) -> Markup {
    let shown = |value: Option<f64>, unit: &str| {
        let value = value.filter(|value| !value.is_nan());
        value.map_or("–".to_owned(), |value| match unit {
            "%" => per_cent(value),
            _ => format_si(value, unit),
        })
    };
    let length = |value: Option<f64>| shown(value, "m");
    let cells = [
        row.step.to_string(),
        length(row.approach),
        length(row.mean_gap),
        shown(Some(row.force), "N"),
        shown(Some(row.mean_pressure), "Pa"),
        shown(Some(row.contact_area_fraction), "%"),
        row.iterations.to_string(),
        format!("{:.1e}", row.residual),
    ];
    html! {
        tr {
            @for cell in cells { td.number { (cell) } }
            @for quantity in quantities { td.number { (shown(quantity.values[index], quantity.unit)) } }
            td { (row.state_words()) }
        }
        "\n"
    }
}
