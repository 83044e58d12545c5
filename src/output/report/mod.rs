//! `report.html`: one self-contained page with the results of a run.
//!
//! The page contains neither seconds nor dates, so that the same run gives the same page. It loads
//! nothing and runs no script: pictures are embedded, and a content policy forbids the rest.

mod scene_table;

use std::fs;
use std::path::PathBuf;

use base64::{Engine as _, engine::general_purpose::STANDARD};
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::picture::Load;
use super::plot::curves;
use super::summary::Summary;
use super::visible::visible;
use crate::effect::Effect;
use crate::study::{Checkpoint, Setup, StepRow};
use crate::units::format_si;

/// Most pictures on a page.
const MOST_PICTURES: usize = 24;
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
    pub pictures: &'a [(usize, &'static str, PathBuf)],
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
                    header { h1 { (title) } (self.status()) }
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
        let (done, steps) = (self.rows.len(), self.setup.scene.loading.path.len());
        let tolerance = self.setup.scene.solver.tolerance;
        let plural = if steps == 1 { "" } else { "s" };
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
            (_, Some(_)) if done == steps => html! {
                p.status { "Finished: " (steps) " step" (plural) ", converged to " (format!("{tolerance:e}")) "." }
            },
            (_, Some(_)) => html! {
                p.status.early { "Ended early: " (done) " of " (steps) " steps are finished. " (resume) }
            },
            (_, None) => html! {
                p.status.early {
                    "Not finished: " (done) " of " (steps) " steps were done when this page was written. "
                    "If the run has ended, " (resume)
                }
            },
        }
    }

    /// The main results: name, value and note.
    fn main_results(&self) -> Vec<(&'static str, String, String)> {
        let mut found = Vec::new();
        let area = |row: &&StepRow| row.contact_area_fraction;
        let largest = self.rows.iter().max_by(|a, b| area(a).total_cmp(&area(b)));
        if let Some(row) = largest {
            let note = format!("of the nominal area, step {}", row.step);
            found.push(("Largest contact", per_cent(row.contact_area_fraction), note));
        }
        let tension = self
            .rows
            .iter()
            .filter(|row| row.force < 0.0)
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
        for (name, at) in [
            ("Jumps into contact", &self.tallies.jump_in_steps),
            ("Jumps out of contact", &self.tallies.jump_off_steps),
        ] {
            if !at.is_empty() {
                found.push((name, at.len().to_string(), step_words(at)));
            }
        }
        if let Some(energy) = self.summary.and_then(|summary| summary.hysteresis_energy) {
            let note = "lost over the loop".to_owned();
            found.push(("Hysteresis", format_si(energy, "J"), note));
        }
        if let Some(regime) = &self.setup.regime {
            let name = regime.name().split(':').next().unwrap_or_default();
            let value = format!("{:.3}", regime.tabor);
            found.push(("Tabor number", value, name.to_owned()));
        }
        found
    }

    fn figures(&self) -> Markup {
        let found = self.main_results();
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
        let figures = curves::figures(&self.setup.scene, self.rows);
        let curves = html! {
            div.grid {
                @for figure in &figures { figure { (figure.svg(&figure.panels[0].title)) } "\n" }
            }
            p.status { "Force and pressure are positive in compression, approach is positive towards the solid." }
        };
        section("Curves", curves)
    }

    fn pictures(&self) -> Markup {
        let loading = &self.setup.scene.loading;
        let mut shown = Vec::new();
        let mut bytes_shown = 0;
        for index in spread(self.pictures.len(), MOST_PICTURES) {
            let (step, field, path) = &self.pictures[index];
            // A picture that cannot be read is left out.
            let Ok(bytes) = fs::read(path) else { continue };
            if !shown.is_empty() && bytes_shown + bytes.len() > MOST_PICTURE_BYTES {
                continue;
            }
            let load = loading
                .path
                .get(step.wrapping_sub(1))
                .map(|&value| format!(", {}", Load::new(loading.control, value).words()));
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
        let effects = Effect::ALL.iter().map(|effect| {
            let on = effect.is_on(&self.setup.scene);
            (effect, if on { "on" } else { "off" })
        });
        let table = html! {
            div.scroll { table {
                thead { tr {
                    th scope="col" { "Effect" } th scope="col" {} th scope="col" { "What it does" }
                } }
                tbody { @for (effect, word) in effects {
                    tr {
                        th scope="row" { (effect.name()) } td class=(word) { (word) }
                        td class=(word) { (effect.purpose()) }
                    }
                } }
            } }
            p.status { "An effect that is off takes no memory and no time." }
        };
        section("Effects", table)
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
        let steps = html! {
            div.scroll { table.steps {
                thead { tr {
                    @for head in STEP_HEADS { th scope="col" .number { (head) } }
                    th scope="col" { "state" }
                } }
                tbody {
                    @for row in first { (step(row)) }
                    @if left_out > 0 {
                        tr { td colspan="9" { (left_out) " steps more are in " code { "curve.csv" } } }
                    }
                    @for row in last { (step(row)) }
                }
            } }
        };
        section("Steps", steps)
    }
}

/// A row of the table of steps.
fn step(row: &StepRow) -> Markup {
    let length = |value: Option<f64>| value.map_or("–".to_owned(), |v| format_si(v, "m"));
    let cells = [
        row.step.to_string(),
        length(row.approach),
        length(row.mean_gap),
        format_si(row.force, "N"),
        format_si(row.mean_pressure, "Pa"),
        per_cent(row.contact_area_fraction),
        row.iterations.to_string(),
        format!("{:.1e}", row.residual),
    ];
    html! {
        tr {
            @for cell in cells { td.number { (cell) } }
            td { (row.state.name()) @if !row.converged { ", not converged" } }
        }
        "\n"
    }
}

fn per_cent(share: f64) -> String {
    format!("{:.3} %", 100.0 * share)
}

/// As in `steps 3, 5`; of many the first ones.
fn step_words(steps: &[usize]) -> String {
    if let [step] = steps {
        return format!("step {step}");
    }
    let shown: Vec<String> = steps.iter().take(6).map(usize::to_string).collect();
    let more = if steps.len() > 6 { " ..." } else { "" };
    format!("steps {}{more}", shown.join(", "))
}

/// At most `most` of `count` indices, evenly spread, including both ends.
fn spread(count: usize, most: usize) -> Vec<usize> {
    if count <= most {
        return (0..count).collect();
    }
    (0..most).map(|k| k * (count - 1) / (most - 1)).collect()
}

/// Width and height of a PNG, from its header.
fn png_size(png: &[u8]) -> Option<[u32; 2]> {
    let number = |at: usize| -> Option<u32> {
        Some(u32::from_be_bytes(png.get(at..at + 4)?.try_into().ok()?))
    };
    Some([number(16)?, number(20)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_spread_with_both_ends() {
        assert_eq!(spread(3, 24), [0, 1, 2]);
        let chosen = spread(1000, 24);
        assert_eq!(chosen.len(), 24);
        assert_eq!((chosen[0], chosen[23]), (0, 999));
        assert!(chosen.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!(spread(25, 24).len(), 24);
    }
}
