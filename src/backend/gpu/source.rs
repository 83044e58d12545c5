//! Whole shaders, joined from parts: a kernel of the catalogue with what its form needs around it.
//!
//! Group 0 binds the params, the scalars and the level's partial sums; group 1 the kernel's fields
//! in declared order; group 2 the roots of unity and the work space of a transform. Each of them is
//! bound whether a kernel uses it or not.

use std::fmt::Write;

use super::butterfly::{Direction, literal};
use super::catalogue::{self, LawPart, Shader};
use super::error::GpuError;
use super::fft::LineWriter;
use super::layout::{self, Wide};
use super::plan::{GroupLimits, LinePlan};
use crate::backend::Shape;
use crate::kernel::{Form, Gate, Kernel, Reduce, SUMS, ScalarKernel};

/// Threads in a workgroup of a sweep and of a reduction.
const SWEEP_THREADS: usize = 256;
/// Most workgroups of a sweep; each of its threads takes several points beyond.
const SWEEP_GROUPS: usize = 1024;
/// Work done in a level's transforms is counted in these: transforms of all its rows.
pub const ROW_TRANSFORMS_PER_TRANSFORM: f64 = 2.0;

/// How a level is cut into workgroups.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct LevelPlan {
    /// Its points.
    pub shape: [usize; 2],
    /// Those of them that are surface.
    pub surface: [usize; 2],
    /// Transforms along x of ny/2 pairs of rows.
    pub rows: LinePlan,
    /// Transforms along y of nx/2 + 1 columns.
    pub columns: LinePlan,
}

impl LevelPlan {
    /// The plan of a shape, if its numbers are even, smooth and not too large.
    pub fn new(shape: Shape, limits: GroupLimits) -> Result<Self, GpuError> {
        let [nx, ny] = shape.points;
        let refused = || GpuError::Size {
            nx,
            ny,
            largest: LinePlan::longest(limits),
        };
        if nx % 2 != 0 || ny % 2 != 0 {
            return Err(refused());
        }
        Ok(LevelPlan {
            shape: shape.points,
            surface: shape.surface,
            rows: LinePlan::new(nx, ny / 2, limits).ok_or_else(refused)?,
            columns: LinePlan::new(ny, nx / 2 + 1, limits).ok_or_else(refused)?,
        })
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.shape[0] * self.shape[1]
    }

    /// Pairs of rows, transformed as one complex row each: row y with row y + ny/2.
    pub fn pairs(&self) -> usize {
        self.shape[1] / 2
    }

    /// Columns transformed; each stands for itself and its mirror image.
    pub fn column_count(&self) -> usize {
        self.shape[0] / 2 + 1
    }

    /// Workgroups of a kernel on this level.
    pub fn groups(&self, form: Form) -> usize {
        match form {
            Form::Sweep => self.points().div_ceil(SWEEP_THREADS).min(SWEEP_GROUPS),
            Form::Load | Form::Store => self.rows.groups(self.pairs()),
        }
    }

    /// Workgroups of the columns.
    pub fn column_groups(&self) -> usize {
        self.columns.groups(self.column_count())
    }

    /// Partial sums that the kernels of this level write at most.
    pub fn partials(&self) -> usize {
        let kernels = self.groups(Form::Sweep).max(self.groups(Form::Load)) * SUMS;
        kernels.max(self.column_groups())
    }
}

/// The WGSL function of a gate.
pub fn gate_name(gate: Gate) -> &'static str {
    match gate {
        Gate::Always => "gate_always",
        Gate::Running => "gate_running",
        Gate::Fresh => "gate_fresh",
        Gate::Accepted => "gate_accepted",
        Gate::Searching => "gate_searching",
    }
}

fn reduce_name(reduce: Reduce) -> &'static str {
    match reduce {
        Reduce::Add => "add",
        Reduce::Min => "min",
        Reduce::Max => "max",
    }
}

fn neutral(reduce: Reduce) -> &'static str {
    match reduce {
        Reduce::Add => "wide(0.0)",
        Reduce::Min => "params.infinity",
        Reduce::Max => "-params.infinity",
    }
}

/// The parts before a kernel: numbers, gates, and what reduces its sums in a workgroup.
fn preamble(source: &mut String, wide: Wide, access: &str, threads: usize, sums: bool) {
    source.push_str(&layout::declarations(wide));
    source.push_str(catalogue::COMMON);
    let _ = writeln!(
        source,
        "@group(0) @binding(1) var<storage, {access}> scalars: Scalars;"
    );
    source.push_str(catalogue::GATE);
    if sums {
        // The largest power of two below the number of threads.
        let half = threads.next_power_of_two() / 2;
        let _ = writeln!(
            source,
            "const GROUP_THREADS: u32 = {threads}u;\nconst GROUP_HALF: u32 = {half}u;"
        );
        source.push_str(catalogue::REDUCE);
    }
}

/// Private sums, their start, and how a workgroup hands them in.
fn sums(source: &mut String, reduces: &[Reduce], groups: usize) {
    if reduces.is_empty() {
        return;
    }
    let _ = writeln!(
        source,
        "var<private> sums: array<wide, {}>;\nfn start_sums() {{",
        reduces.len()
    );
    for (slot, &reduce) in reduces.iter().enumerate() {
        let _ = writeln!(source, "sums[{slot}] = {};", neutral(reduce));
    }
    source.push_str("}\nfn hand_in(group: u32, thread: u32) {\nvar total: wide;\n");
    for (slot, &reduce) in reduces.iter().enumerate() {
        let _ = writeln!(
            source,
            "total = gather_{}(sums[{slot}], thread);\n\
             if (thread == 0u) {{ partials.values[{}u + group] = total; }}",
            reduce_name(reduce),
            slot * groups
        );
    }
    source.push_str("}\n");
}

fn on_surface(source: &mut String, plan: &LevelPlan) {
    let [width, _] = plan.shape;
    let [nx, ny] = plan.surface;
    let body = if plan.shape == plan.surface {
        "true".to_string()
    } else {
        format!("index % {width}u < {nx}u && index / {width}u < {ny}u")
    };
    let _ = writeln!(
        source,
        "fn on_surface(index: u32) -> bool {{ return {body}; }}"
    );
}

/// The shader of a kernel on a level. `whole` is the shape of the field it reads anywhere.
pub fn kernel(
    kernel: &Kernel,
    plan: &LevelPlan,
    whole: [usize; 2],
    law: LawPart,
    wide: Wide,
) -> Result<String, GpuError> {
    let shader = catalogue::shader(kernel.name).ok_or(GpuError::NoShader(kernel.name))?;
    let threads = match kernel.form {
        Form::Sweep => SWEEP_THREADS,
        Form::Load | Form::Store => plan.rows.group_threads(),
    };
    let mut source = String::new();
    preamble(&mut source, wide, "read", threads, !kernel.sums.is_empty());
    sums(&mut source, kernel.sums, plan.groups(kernel.form));
    on_surface(&mut source, plan);
    let [width, height] = plan.shape;
    let _ = writeln!(
        source,
        "const WIDTH: u32 = {width}u;\nconst HEIGHT: u32 = {height}u;\n\
         const WHOLE_WIDTH: u32 = {}u;\nconst WHOLE_HEIGHT: u32 = {}u;",
        whole[0], whole[1]
    );
    join(&mut source, shader, law);
    match kernel.form {
        Form::Sweep => sweep_main(&mut source, kernel, plan),
        Form::Load => load_main(&mut source, kernel, plan),
        Form::Store => store_main(&mut source, kernel, plan),
    }
    Ok(source)
}

fn join(source: &mut String, shader: &Shader, law: LawPart) {
    if shader.law {
        source.push_str(law.source());
    }
    for part in shader.parts {
        source.push_str(part);
    }
}

/// What a kernel does before and after its points.
fn frame(kernel: &Kernel) -> (String, &'static str) {
    let mut open = format!("if (!{}()) {{ return; }}\n", gate_name(kernel.gate));
    if kernel.sums.is_empty() {
        (open, "")
    } else {
        open.push_str("start_sums();\n");
        (open, "hand_in(group.x, index_in_group);\n")
    }
}

fn sweep_main(source: &mut String, kernel: &Kernel, plan: &LevelPlan) {
    let (open, close) = frame(kernel);
    let stride = plan.groups(Form::Sweep) * SWEEP_THREADS;
    let _ = write!(
        source,
        "@compute @workgroup_size({SWEEP_THREADS})\n\
         fn {}(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {{\n\
         {open}\
         for (var index = group.x * {SWEEP_THREADS}u + index_in_group; index < {points}u; index = index + {stride}u) {{\n\
         point(index, on_surface(index));\n\
         }}\n\
         {close}}}\n",
        kernel.name,
        points = plan.points(),
    );
}

/// The head of a kernel that transforms pairs of rows; `pair` is this thread's pair of rows.
fn rows_head(source: &mut String, name: &str, plan: &LevelPlan, open: &str) {
    source.push_str(&LineWriter::declarations(&plan.rows));
    source.push_str(catalogue::FFT);
    let [x, y] = LineWriter::workgroup_size(&plan.rows, true);
    let _ = write!(
        source,
        "@group(2) @binding(0) var<storage, read> roots: array<vec2<f32>>;\n\
         @group(2) @binding(1) var<storage, read_write> work: array<vec2<f32>>;\n\
         @compute @workgroup_size({x}, {y})\n\
         fn {name}(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {{\n\
         {open}\
         let line = place.x;\n\
         let thread = place.y;\n\
         let pair = group.x * LINES + line;\n\
         let inside = pair < {pairs}u;\n\
         if (group.x == 0u && index_in_group == 0u) {{ partials.transforms = partials.transforms + 1u; }}\n",
        pairs = plan.pairs(),
    );
}

fn load_main(source: &mut String, kernel: &Kernel, plan: &LevelPlan) {
    let (open, close) = frame(kernel);
    rows_head(source, kernel.name, plan, &open);
    let width = plan.shape[0];
    let (pairs, half) = (plan.pairs(), plan.pairs() * width);
    let (first, last) = ends(&plan.rows);
    let mut writer = LineWriter::new(&plan.rows, true);
    writer.source.push_str("if (inside) {\n");
    writer.butterflies(first, |source, each| {
        for leg in 0..each.radix {
            let _ = writeln!(
                source,
                "{{ let index = pair * {width}u + {};\n\
                 {} = vec2<f32>(load_point(index, on_surface(index)), load_point(index + {half}u, on_surface(index + {half}u))); }}",
                each.position(leg),
                each.name(leg),
            );
        }
    });
    writer.source.push_str("}\n");
    writer.transform(Direction::Forward);
    writer.source.push_str("if (inside) {\n");
    writer.butterflies(last, |source, each| {
        for leg in 0..each.radix {
            let _ = writeln!(
                source,
                "work[{} * {pairs}u + pair] = {};",
                each.position(leg),
                each.name(leg)
            );
        }
    });
    writer.source.push_str("}\n");
    source.push_str(&writer.source);
    source.push_str(close);
    source.push_str("}\n");
}

fn store_main(source: &mut String, kernel: &Kernel, plan: &LevelPlan) {
    let (open, close) = frame(kernel);
    rows_head(source, kernel.name, plan, &open);
    let width = plan.shape[0];
    let (pairs, half) = (plan.pairs(), plan.pairs() * width);
    let (first, last) = ends(&plan.rows);
    let mut writer = LineWriter::new(&plan.rows, true);
    writer.source.push_str("if (inside) {\n");
    writer.butterflies(last, |source, each| {
        for leg in 0..each.radix {
            let _ = writeln!(
                source,
                "{} = work[{} * {pairs}u + pair];",
                each.name(leg),
                each.position(leg),
            );
        }
    });
    writer.source.push_str("}\n");
    writer.transform(Direction::Inverse);
    writer.source.push_str("if (inside) {\n");
    writer.butterflies(first, |source, each| {
        for leg in 0..each.radix {
            let _ = writeln!(
                source,
                "{{ let index = pair * {width}u + {};\n\
                 store_point(index, on_surface(index), {name}.x);\n\
                 store_point(index + {half}u, on_surface(index + {half}u), {name}.y); }}",
                each.position(leg),
                name = each.name(leg),
            );
        }
    });
    writer.source.push_str("}\n");
    source.push_str(&writer.source);
    source.push_str(close);
    source.push_str("}\n");
}

/// First and last radix of a forward transform.
fn ends(plan: &LinePlan) -> (usize, usize) {
    // A plan has at least one radix.
    let first = plan.radices.first().copied().unwrap_or(1);
    (first, plan.radices.last().copied().unwrap_or(1))
}

/// The columns: their transform, the factors, and the transform back, in place.
///
/// Work holds z = p(y) + i p(y + ny/2), transformed along x. Its values at kx and -kx give the
/// transforms A and B of the two halves of the rows apart: `A = (z(kx) + conj z(-kx))/2`,
/// `B = (z(kx) - conj z(-kx))/2i`. Since the first radix is even, the lower legs of a butterfly
/// are values of A and the upper ones those of B at the same places.
pub fn multiply(plan: &LevelPlan, energy: bool, gate: Gate, wide: Wide) -> String {
    let columns = &plan.columns;
    let [width, height] = plan.shape;
    let pairs = plan.pairs();
    let mut source = String::new();
    preamble(&mut source, wide, "read", columns.group_threads(), energy);
    let reduces: &[Reduce] = if energy { &[Reduce::Add] } else { &[] };
    sums(&mut source, reduces, plan.column_groups());
    source.push_str(&LineWriter::declarations(columns));
    source.push_str(catalogue::FFT);
    let [x, y] = LineWriter::workgroup_size(columns, false);
    let _ = write!(
        source,
        "@group(1) @binding(0) var<storage, read> roots: array<vec2<f32>>;\n\
         @group(1) @binding(1) var<storage, read_write> work: array<vec2<f32>>;\n\
         @group(1) @binding(2) var<storage, read> factors: array<f32>;\n\
         @compute @workgroup_size({x}, {y})\n\
         fn multiply(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {{\n\
         if (!{gate}()) {{ return; }}\n\
         {start}\
         let thread = place.x;\n\
         let line = place.y;\n\
         let column = group.x * LINES + line;\n\
         let inside = column < {columns}u;\n\
         let own = column == 0u || 2u * column == {width}u;\n\
         let here = column * {pairs}u;\n\
         let there = select({width}u - column, 0u, column == 0u) * {pairs}u;\n\
         if (group.x == 0u && index_in_group == 0u) {{ partials.transforms = partials.transforms + 2u; }}\n",
        gate = gate_name(gate),
        start = if energy { "start_sums();\n" } else { "" },
        columns = plan.column_count(),
    );
    let (first, last) = ends(columns);
    let mut writer = LineWriter::new(columns, false);
    writer.source.push_str("if (inside) {\n");
    writer.butterflies(first, |source, each| {
        for leg in 0..first / 2 {
            let _ = writeln!(
                source,
                "{{ let z = work[here + {at}];\n\
                 let mirror = work[there + {at}];\n\
                 {a} = 0.5 * vec2<f32>(z.x + mirror.x, z.y - mirror.y);\n\
                 {b} = 0.5 * vec2<f32>(z.y + mirror.y, mirror.x - z.x); }}",
                at = each.position(leg),
                a = each.name(leg),
                b = each.name(leg + first / 2),
            );
        }
    });
    writer.source.push_str("}\n");
    writer.transform(Direction::Forward);
    let scale = literal(1.0 / plan.points() as f64);
    let row = height / 2 + 1;
    writer.source.push_str("if (inside) {\n");
    if energy {
        writer
            .source
            .push_str("let weight = select(2.0, 1.0, own);\n");
    }
    writer.butterflies(last, |source, each| {
        for leg in 0..each.radix {
            let name = each.name(leg);
            let _ = writeln!(
                source,
                "{{ let row = {at};\n\
                 let factor = factors[column * {row}u + min(row, {height}u - row)];",
                at = each.position(leg),
            );
            if energy {
                let _ = writeln!(
                    source,
                    "sums[0] = sums[0] + wide(weight * factor * dot({name}, {name}));"
                );
            }
            let _ = writeln!(source, "{name} = ({scale} * factor) * {name}; }}");
        }
    });
    writer.source.push_str("}\n");
    writer.transform(Direction::Inverse);
    writer.source.push_str("if (inside) {\n");
    writer.butterflies(first, |source, each| {
        for leg in 0..first / 2 {
            let (a, b) = (each.name(leg), each.name(leg + first / 2));
            let at = each.position(leg);
            let _ = writeln!(
                source,
                "work[here + {at}] = vec2<f32>({a}.x - {b}.y, {a}.y + {b}.x);\n\
                 if (!own) {{ work[there + {at}] = vec2<f32>({a}.x + {b}.y, {b}.x - {a}.y); }}",
            );
        }
    });
    writer.source.push_str("}\n");
    source.push_str(&writer.source);
    if energy {
        source.push_str("hand_in(group.x, index_in_group);\n");
    }
    source.push_str("}\n");
    source
}

/// Where a reduction's results go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Results {
    /// The scalars' sums, put together as the kernel says.
    Sums(&'static [Reduce]),
    /// The curvature, over so many points.
    Curvature(usize),
}

/// Puts the partial sums of `groups` workgroups together in a fixed order, if the gate of the
/// kernel that wrote them was open.
pub fn reduce(results: Results, groups: usize, gate: Gate, wide: Wide) -> String {
    let mut source = String::new();
    preamble(&mut source, wide, "read_write", SWEEP_THREADS, true);
    let _ = write!(
        source,
        "@compute @workgroup_size({SWEEP_THREADS})\n\
         fn reduce(@builtin(local_invocation_index) thread: u32) {{\n\
         var total: wide;\n"
    );
    let reduces: &[Reduce] = match results {
        Results::Sums(reduces) => reduces,
        Results::Curvature(_) => &[Reduce::Add],
    };
    for (slot, &reduce) in reduces.iter().enumerate() {
        let name = reduce_name(reduce);
        let target = match results {
            Results::Sums(_) => format!("scalars.sums[{slot}] = total"),
            Results::Curvature(points) => {
                format!("scalars.curvature = total / wide({points}.0)")
            }
        };
        let _ = write!(
            source,
            "total = {neutral};\n\
             for (var group = thread; group < {groups}u; group = group + {SWEEP_THREADS}u) {{\n\
             total = join_{name}(total, partials.values[{start}u + group]);\n\
             }}\n\
             total = gather_{name}(total, thread);\n\
             if (thread == 0u && {gate}()) {{ {target}; }}\n",
            neutral = neutral(reduce),
            start = slot * groups,
            gate = gate_name(gate),
        );
    }
    source.push_str("}\n");
    source
}

/// The shader of a scalar kernel, or an error where it has none.
pub fn scalar(kernel: &ScalarKernel, _wide: Wide) -> Result<String, GpuError> {
    Err(GpuError::NoShader(kernel.name))
}
