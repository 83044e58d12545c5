// A gap that is not negative. Twins: kernel/constraint.rs, Unilateral.
const STORES_STEP: bool = false;

fn state(gap: real, elastic: real) -> Here {
    let open_here = open(gap);
    let pull = traction(gap);
    let y = elastic + pull;
    return Here(gap, open_here, elastic, pull, y, open_here > 0.0 || y < 0.0, real(1.0), real(0.0));
}

fn violation(here: Here) -> Violation {
    let off = min(here.y, here.open * real(params.stiffness_max));
    return Violation(off, reaction(here.open, here.y), here.pull);
}

fn preconditioned(here: Here, line: real) -> real {
    return select(real(0.0), line, here.free);
}

fn goes_down(open: real, y: real) -> bool {
    return false;
}

// s = s0 + correction (g + s0) with s0 = max(-g, moved).
fn trial_step(here: Here, moved: real, correction: real) -> Tried {
    let step = max(moved, -here.open);
    return Tried(step + correction * (here.open + step), here.open + moved < 0.0);
}

fn corrected_step(here: Here, step: real, correction: real, in_domain: bool) -> real {
    return step;
}

fn touches(open: real, step: real) -> bool {
    return step < 0.0;
}

// The gap after t of a step.
fn land(here: Here, step: real, t: real) -> real {
    // By what is left of the gap, which a cut makes exactly zero.
    let left = here.open + t * step;
    let lands = left <= 0.0 || (step < 0.0 && left < real(scalars.snap));
    return select(here.gap + t * step, closed_gap(), lands);
}

fn pressure_weight(here: Here) -> real {
    return here.open;
}

// The outer gap with a correction that was found in single precision, which closes the points where it
// undoes the outer gap as single precision has it.
fn corrected_gap(gap: real, correction: real) -> real {
    let moved = gap + correction;
    return select(moved, real(0.0), correction <= -real(f32(gap)) || moved < 0.0);
}

fn net_traction(here: Here) -> real {
    return here.pull;
}
