//! The transform of a line by a workgroup, written out in WGSL for one length.
//!
//! Stockham's self-sorting scheme: at each stage a thread takes the values `j + k n/r` of its
//! butterflies `j`, multiplies them by roots of unity, transforms them over `k` and stores them
//! where the next stage reads them. All loops of known length are unrolled into named variables,
//! since an array with a computed index would leave the registers.
//!
//! The code refers to `thread` and `line` (this thread's place in its line, and the line's place in
//! the workgroup), `exchange` (workgroup memory) and `roots` (the table of [`roots`](super::plan::roots)).

use std::fmt::Write;

use super::butterfly::{Direction, butterfly};
use super::plan::{BANKS, Exchange, LinePlan, Stage};

/// Writes the transforms of one line length.
pub struct LineWriter<'a> {
    plan: &'a LinePlan,
    /// Whether neighbouring threads belong to neighbouring lines, not to the same one.
    interleaved: bool,
    /// Whether workgroup memory still holds values that another thread may read.
    occupied: bool,
    /// The WGSL written so far.
    pub source: String,
}

/// The place in workgroup memory of a place in a line.
fn banked(plan: &LinePlan, place: &str) -> String {
    match plan.spreads() {
        true => format!("bank({place})"),
        false => format!("({place})"),
    }
}

/// A thread's butterfly at one stage.
pub struct Butterfly {
    /// Index among the thread's butterflies.
    round: usize,
    /// Values in it.
    pub radix: usize,
    /// Distance of its values in the line.
    pub stride: usize,
}

impl Butterfly {
    /// The number of the variable of leg `k`.
    fn value(&self, leg: usize) -> usize {
        self.round * self.radix + leg
    }

    /// The variable of leg `k`.
    pub fn name(&self, leg: usize) -> String {
        format!("v{}", self.value(leg))
    }

    /// Where leg `k` lies in the line before the first stage and after the last one.
    pub fn position(&self, leg: usize) -> String {
        format!("(j + {}u)", leg * self.stride)
    }
}

impl<'a> LineWriter<'a> {
    /// A writer that has declared its variables.
    pub fn new(plan: &'a LinePlan, interleaved: bool) -> Self {
        let mut source = String::new();
        for value in 0..plan.values() {
            let _ = writeln!(source, "var v{value} = vec2<real>(0.0, 0.0);");
        }
        if let Exchange::Rounds(_) = plan.exchange {
            for value in 0..plan.values() {
                let _ = writeln!(source, "var w{value}: real = 0.0;");
            }
        }
        LineWriter {
            plan,
            interleaved,
            occupied: false,
            source,
        }
    }

    /// The same for a line that is not the first one of its thread: memory may be in use.
    pub fn again(mut self) -> Self {
        self.occupied = true;
        self
    }

    /// Declares the memory through which the threads of a workgroup exchange values.
    pub fn declarations(plan: &LinePlan) -> String {
        let kind = match plan.exchange {
            Exchange::Whole => "vec2<real>",
            Exchange::Split | Exchange::Rounds(_) => "real",
        };
        let mut text = format!(
            "var<workgroup> exchange: array<{kind}, {}>;\nconst LINES: u32 = {}u;\n",
            plan.exchange.places(plan.length) * plan.lines,
            plan.lines,
        );
        if plan.spreads() {
            // Within a block of places, the lower digits of each are changed by higher ones of its own. All keep different
            // places, since each digit depends on higher ones alone.
            let _ = writeln!(
                text,
                "fn bank(place: u32) -> u32 {{ return place ^ ((place >> 3u) & {}u); }}",
                BANKS - 1
            );
        }
        text
    }

    /// The workgroup's size along x and y.
    pub fn workgroup_size(plan: &LinePlan, interleaved: bool) -> [usize; 2] {
        if interleaved {
            [plan.lines, plan.threads]
        } else {
            [plan.threads, plan.lines]
        }
    }

    /// Calls `body` for each butterfly that a thread has at a stage; `j` is its number.
    pub fn butterflies(&mut self, radix: usize, mut body: impl FnMut(&mut String, &Butterfly)) {
        let stride = self.plan.length / radix;
        let threads = self.plan.threads;
        for round in 0..stride.div_ceil(threads) {
            let _ = writeln!(self.source, "{{ let j = thread + {}u;", round * threads);
            let partly_idle = (round + 1) * threads > stride;
            if partly_idle {
                let _ = writeln!(self.source, "if (j < {stride}u) {{");
            }
            body(
                &mut self.source,
                &Butterfly {
                    round,
                    radix,
                    stride,
                },
            );
            self.source
                .push_str(if partly_idle { "}\n}\n" } else { "}\n" });
        }
    }

    /// Transforms the line that the variables hold, first stage's places to last stage's places.
    pub fn transform(&mut self, direction: Direction) {
        let stages = self.plan.stages(direction);
        for (place, stage) in stages.iter().enumerate() {
            self.stage(direction, stage);
            let Some(next) = stages.get(place + 1) else {
                return;
            };
            let (radix, before, next) = (stage.radix, stage.before, next.radix);
            match self.plan.exchange {
                Exchange::Whole => self.pass(radix, before, next, ""),
                Exchange::Split => {
                    self.pass(radix, before, next, ".x");
                    self.pass(radix, before, next, ".y");
                }
                Exchange::Rounds(rounds) => {
                    self.pass_in_rounds(radix, before, next, ".x", rounds);
                    self.pass_in_rounds(radix, before, next, ".y", rounds);
                }
            }
        }
    }

    /// The butterflies of a stage.
    fn stage(&mut self, direction: Direction, stage: &Stage) {
        let turn = match direction {
            Direction::Forward => "turn",
            Direction::Inverse => "turn_back",
        };
        let (radix, before) = (stage.radix, stage.before);
        self.butterflies(radix, |source, each| {
            if before > 1 {
                let _ = writeln!(source, "let root = j % {before}u;");
                for leg in 1..radix {
                    let (name, first) = (each.name(leg), stage.leg_at(leg));
                    let _ = writeln!(source, "{name} = {turn}({name}, roots[{first}u + root]);");
                }
            }
            let names: Vec<String> = (0..radix).map(|leg| each.name(leg)).collect();
            butterfly(source, direction, &names);
        });
    }

    /// Moves the real or imaginary parts from their places after a stage to those before the next.
    fn pass(&mut self, radix: usize, before: usize, next: usize, part: &str) {
        let (plan, interleaved) = (self.plan, self.interleaved);
        let (length, lines) = (plan.length, plan.lines);
        let address = move |place: &str| {
            let place = banked(plan, place);
            if interleaved {
                format!("exchange[{place} * {lines}u + line]")
            } else {
                format!("exchange[line * {length}u + {place}]")
            }
        };
        if self.occupied {
            self.source.push_str("workgroupBarrier();\n");
        }
        self.butterflies(radix, |source, each| {
            let _ = writeln!(
                source,
                "let start = (j / {before}u) * {}u + j % {before}u;",
                before * radix
            );
            for leg in 0..radix {
                let place = address(&format!("start + {}u", leg * before));
                let _ = writeln!(source, "{place} = {}{part};", each.name(leg));
            }
        });
        self.source.push_str("workgroupBarrier();\n");
        self.butterflies(next, |source, each| {
            for leg in 0..next {
                let place = address(&each.position(leg));
                let _ = writeln!(source, "{}{part} = {place};", each.name(leg));
            }
        });
        self.occupied = true;
    }

    /// As `pass`, for a part of the line at a time where workgroup memory holds no more. Received values
    /// wait in separate variables, since values of later rounds have yet to be sent.
    fn pass_in_rounds(
        &mut self,
        radix: usize,
        before: usize,
        next: usize,
        part: &str,
        rounds: usize,
    ) {
        let places = self.plan.exchange.places(self.plan.length);
        let slot = banked(self.plan, &format!("place % {places}u"));
        for round in 0..rounds {
            if self.occupied {
                self.source.push_str("workgroupBarrier();\n");
            }
            self.butterflies(radix, |source, each| {
                let _ = writeln!(
                    source,
                    "let start = (j / {before}u) * {}u + j % {before}u;",
                    before * radix
                );
                for leg in 0..radix {
                    let _ = writeln!(
                        source,
                        "{{ let place = start + {}u; if (place / {places}u == {round}u) {{ exchange[{slot}] = {}{part}; }} }}",
                        leg * before,
                        each.name(leg)
                    );
                }
            });
            self.source.push_str("workgroupBarrier();\n");
            self.butterflies(next, |source, each| {
                for leg in 0..next {
                    let _ = writeln!(
                        source,
                        "{{ let place = {}; if (place / {places}u == {round}u) {{ w{} = exchange[{slot}]; }} }}",
                        each.position(leg),
                        each.value(leg)
                    );
                }
            });
            self.occupied = true;
        }
        self.butterflies(next, |source, each| {
            for leg in 0..next {
                let value = each.value(leg);
                let _ = writeln!(source, "v{value}{part} = w{value};");
            }
        });
    }
}
