//! `report.html`: one self-contained page with the results of a run.
//!
//! The page contains neither seconds nor dates, so that the same run gives the same page. It loads
//! nothing and runs no script: pictures are embedded, and a content policy forbids the rest.

mod base64;
mod scene_table;

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use super::chart;
use super::picture::Load;
use super::summary::Summary;
use super::visible::visible;
use crate::effect::Effect;
use crate::study::{Checkpoint, Setup, State, StepRow};
use crate::units::format_si;
use base64::base64;

/// Most pictures on a page.
const MOST_PICTURES: usize = 24;
/// Most bytes of pictures on a page, so that a phone can open it; one picture is always shown.
const MOST_PICTURE_BYTES: usize = 12 << 20;
/// Rows at either end of a long table of steps.
const SHOWN_STEPS: usize = 60;

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

/// Escapes text for tags and attributes and removes characters that a page must not contain.
pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in visible(text).chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            other => escaped.push(other),
        }
    }
    escaped
}

impl Report<'_> {
    /// The page.
    pub fn html(&self) -> String {
        let title = self.title();
        let mut page = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'\">\n\
             <meta name=\"generator\" content=\"tabor {}\">\n\
             <link rel=\"icon\" href=\"data:,\">\n<title>{}</title>\n<style>\n{}</style>\n</head>\n<body>\n",
            env!("CARGO_PKG_VERSION"),
            escape(&title),
            include_str!("style.css")
        );
        let parts = [
            format!(
                "<header>\n<h1>{}</h1>\n{}</header>\n",
                escape(&title),
                self.status()
            ),
            self.figures(),
            self.warnings(),
            self.curves(),
            self.pictures(),
            self.effects(),
            scene_table::html(self.setup),
            self.solution(),
            self.steps(),
            format!(
                "<footer>Written by tabor {}. Beside this page: <code>curve.csv</code> has every step with all its columns, <code>summary.json</code> the same facts for programs.</footer>\n",
                env!("CARGO_PKG_VERSION")
            ),
        ];
        page.push_str("<main>\n");
        for part in parts {
            page.push_str(&part);
        }
        page.push_str("</main>\n</body>\n</html>\n");
        page
    }

    fn title(&self) -> String {
        let title = self.setup.scene.title.as_deref().unwrap_or_default();
        match title.trim() {
            "" => "A contact solved by tabor".to_owned(),
            title => title.to_owned(),
        }
    }

    /// The progress of the run.
    fn status(&self) -> String {
        let (done, steps) = (self.rows.len(), self.setup.scene.loading.path.len());
        let plural = if steps == 1 { "" } else { "s" };
        let early = |words: String| format!("<p class=\"status early\">{words}</p>\n");
        match (self.rows.last(), self.summary) {
            (Some(last), Some(_)) if !last.converged => early(format!(
                "Ended early: step {done} of {steps} did not converge (residual {:.1e}, asked {:.1e}). The steps before it stand; this one is shown as it was.",
                last.residual, self.setup.scene.solver.tolerance
            )),
            (_, Some(_)) if done == steps => format!(
                "<p class=\"status\">Finished: {steps} step{plural}, converged to {:e}.</p>\n",
                self.setup.scene.solver.tolerance
            ),
            (_, Some(_)) => early(format!(
                "Ended early: {done} of {steps} steps are finished. <code>tabor run</code> with <code>--resume</code> continues after them."
            )),
            (_, None) => early(format!(
                "Not finished: {done} of {steps} steps were done when this page was written. If the run has ended, <code>tabor run</code> with <code>--resume</code> continues after them."
            )),
        }
    }

    /// The main results.
    fn figures(&self) -> String {
        let mut found: Vec<(&str, String, String)> = Vec::new();
        let largest = self
            .rows
            .iter()
            .max_by(|a, b| a.contact_area_fraction.total_cmp(&b.contact_area_fraction));
        if let Some(row) = largest {
            let note = format!("of the nominal area, step {}", row.step);
            let value = format!("{:.3} %", 100.0 * row.contact_area_fraction);
            found.push(("Largest contact", value, note));
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
        let steps = |steps: &[usize]| match steps {
            [step] => format!("step {step}"),
            steps => {
                let shown: Vec<String> = steps.iter().take(6).map(usize::to_string).collect();
                let more = if steps.len() > 6 { " ..." } else { "" };
                format!("steps {}{more}", shown.join(", "))
            }
        };
        let jumps = [
            ("Jumps into contact", &self.tallies.jump_in_steps),
            ("Jumps out of contact", &self.tallies.jump_off_steps),
        ];
        for (name, at) in jumps {
            if !at.is_empty() {
                found.push((name, at.len().to_string(), steps(at)));
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
        if found.is_empty() {
            return String::new();
        }
        let mut text = String::from("<dl class=\"figures\">\n");
        for (name, value, note) in found {
            let (value, note) = (escape(&value), escape(&note));
            let _ = writeln!(
                text,
                "<div><dt>{name}</dt><dd>{value}<small>{note}</small></dd></div>"
            );
        }
        text.push_str("</dl>\n");
        text
    }

    fn warnings(&self) -> String {
        if self.warnings.is_empty() {
            return String::new();
        }
        let items: String = self
            .warnings
            .iter()
            .map(|warning| format!("<li>{}</li>\n", escape(warning)))
            .collect();
        format!(
            "<section class=\"warnings\">\n<strong>Warnings</strong>\n<ul>\n{items}</ul>\n</section>\n"
        )
    }

    fn curves(&self) -> String {
        if !self.rows.iter().any(|row| row.converged) {
            return String::new();
        }
        let mut text = String::from("<section>\n<h2>Curves</h2>\n<div class=\"grid\">\n");
        for curve in chart::charts(&self.setup.scene, self.rows) {
            let _ = write!(text, "<figure>\n{}</figure>\n", chart::svg(&curve));
        }
        text.push_str("</div>\n<p class=\"status\">Force and pressure are positive in compression, approach is positive towards the solid.</p>\n</section>\n");
        text
    }

    fn pictures(&self) -> String {
        let chosen = spread(self.pictures.len(), MOST_PICTURES);
        let mut figures = String::new();
        let (mut shown, mut bytes_shown) = (0, 0);
        let loading = &self.setup.scene.loading;
        for index in chosen {
            let (step, field, path) = &self.pictures[index];
            // A picture that cannot be read is left out.
            let Ok(bytes) = fs::read(path) else { continue };
            if shown > 0 && bytes_shown + bytes.len() > MOST_PICTURE_BYTES {
                continue;
            }
            let load = loading
                .path
                .get(step.wrapping_sub(1))
                .map(|&value| format!(", {}", Load::new(loading.control, value).words()));
            let words = escape(&format!("{field}, step {step}{}", load.unwrap_or_default()));
            let size = png_size(&bytes).map_or_else(String::new, |[width, height]| {
                format!(" width=\"{width}\" height=\"{height}\"")
            });
            let _ = writeln!(
                figures,
                "<figure>\n<img alt=\"{words}\"{size} src=\"data:image/png;base64,{}\">\n<figcaption>{words}</figcaption>\n</figure>",
                base64(&bytes)
            );
            shown += 1;
            bytes_shown += bytes.len();
        }
        if shown == 0 {
            return String::new();
        }
        let rest = match self.pictures.len() - shown {
            0 => String::new(),
            rest => format!(
                "<p class=\"status\">{shown} of {} pictures; the other {rest} are in <code>images/</code>.</p>\n",
                self.pictures.len()
            ),
        };
        format!(
            "<section>\n<h2>Snapshots</h2>\n<div class=\"grid\">\n{figures}</div>\n{rest}</section>\n"
        )
    }

    fn effects(&self) -> String {
        let mut text = String::from(
            "<section>\n<h2>Effects</h2>\n<div class=\"scroll\"><table>\n<thead><tr><th scope=\"col\">Effect</th><th scope=\"col\"></th><th scope=\"col\">What it does</th></tr></thead>\n<tbody>\n",
        );
        for effect in Effect::ALL {
            let (class, word) = if effect.is_on(&self.setup.scene) {
                ("on", "on")
            } else {
                ("off", "off")
            };
            let _ = writeln!(
                text,
                "<tr><th scope=\"row\">{}</th><td class=\"{class}\">{word}</td><td class=\"{class}\">{}</td></tr>",
                escape(effect.name()),
                escape(effect.purpose())
            );
        }
        text.push_str("</tbody>\n</table></div>\n<p class=\"status\">An effect that is off takes no memory and no time.</p>\n</section>\n");
        text
    }

    /// How the run was solved.
    fn solution(&self) -> String {
        let setup = self.setup;
        let grid = setup.surface.grid;
        let moments = setup.statistics.moments;
        let iterations: usize = self.rows.iter().map(|row| row.iterations).sum();
        let mut facts = vec![
            ("grid", format!("{} × {} points", grid.nx, grid.ny)),
            ("rms height", format_si(moments.rms_height(), "m")),
            ("rms slope", format!("{:.4}", moments.rms_slope())),
            ("computed on", self.machine.clone()),
            ("tolerance", format!("{:e}", setup.scene.solver.tolerance)),
            ("iterations", iterations.to_string()),
            (
                "transforms",
                format!("{:.1}", self.tallies.transforms + setup.transforms),
            ),
        ];
        if let Some(regime) = &setup.regime {
            let pixels = format!("{:.2} pixels across it", regime.zone_pixels);
            facts.push(("cohesive zone", pixels));
        }
        let rows: String = facts
            .into_iter()
            .map(|(name, value)| {
                format!(
                    "<tr><th scope=\"row\">{name}</th><td>{}</td></tr>\n",
                    escape(&value)
                )
            })
            .collect();
        format!(
            "<section>\n<h2>Solution</h2>\n<div class=\"scroll\"><table>\n<tbody>\n{rows}</tbody>\n</table></div>\n</section>\n"
        )
    }

    fn steps(&self) -> String {
        if self.rows.is_empty() {
            return String::new();
        }
        let mut text = String::from(
            "<section>\n<h2>Steps</h2>\n<div class=\"scroll\"><table class=\"steps\">\n<thead><tr><th scope=\"col\" class=\"number\">step</th>",
        );
        for head in [
            "approach",
            "mean gap",
            "force",
            "mean pressure",
            "contact",
            "iterations",
            "residual",
        ] {
            let _ = write!(text, "<th scope=\"col\" class=\"number\">{head}</th>");
        }
        text.push_str("<th scope=\"col\">state</th></tr></thead>\n<tbody>\n");
        let length = |value: Option<f64>| value.map_or("–".to_owned(), |v| format_si(v, "m"));
        let long = self.rows.len() > 2 * SHOWN_STEPS;
        for (index, row) in self.rows.iter().enumerate() {
            if long && index >= SHOWN_STEPS && index + SHOWN_STEPS < self.rows.len() {
                if index == SHOWN_STEPS {
                    let left_out = self.rows.len() - 2 * SHOWN_STEPS;
                    let _ = writeln!(
                        text,
                        "<tr><td colspan=\"9\">{left_out} steps more are in <code>curve.csv</code></td></tr>"
                    );
                }
                continue;
            }
            let cells = [
                row.step.to_string(),
                length(row.approach),
                length(row.mean_gap),
                format_si(row.force, "N"),
                format_si(row.mean_pressure, "Pa"),
                format!("{:.3} %", 100.0 * row.contact_area_fraction),
                row.iterations.to_string(),
                format!("{:.1e}", row.residual),
            ];
            text.push_str("<tr>");
            for cell in cells {
                let _ = write!(text, "<td class=\"number\">{cell}</td>");
            }
            let state = match row.state {
                State::Contact => "contact",
                State::Attracted => "attracted",
                State::Separated => "separated",
            };
            let failed = if row.converged { "" } else { ", not converged" };
            let _ = writeln!(text, "<td>{state}{failed}</td></tr>");
        }
        text.push_str("</tbody>\n</table></div>\n</section>\n");
        text
    }
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
    fn texts_of_a_scene_cannot_break_the_page() {
        assert_eq!(
            escape("<script>\"a\" & 'b'</script>"),
            "&lt;script&gt;&quot;a&quot; &amp; 'b'&lt;/script&gt;"
        );
    }

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
