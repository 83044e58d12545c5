// A pressure that is limited by the hardness. Below zero a gap is the depth of plastic indentation. Twins:
// kernel/constraint.rs, HardnessLimit.
const STORES_STEP: bool = false;

fn state(gap: real, elastic: real) -> Here {
    let pull = traction(max(gap, 0.0));
    let excess = elastic - real(params.hardness);
    let y = elastic + pull;
    let above = gap > 0.0 || y < 0.0;
    let yields = gap < 0.0 || (!above && excess > 0.0);
    let rests = select(real(0.0), y, above);
    return Here(gap, gap, elastic, pull, select(rests, excess, yields), yields || above, real(1.0), real(0.0));
}

fn violation(here: Here) -> Violation {
    let y = here.elastic + here.pull;
    // The middle one of the two slopes and the gap.
    let off = max(min(y, here.gap * real(params.stiffness_max)), here.elastic - real(params.hardness));
    return Violation(off, reaction(here.gap, y), here.pull);
}

fn preconditioned(here: Here, line: real) -> real {
    return select(real(0.0), line, here.free);
}

// Whether a point is below zero or may only go there.
fn goes_down(open: real, y: real) -> bool {
    return open < 0.0 || (open == 0.0 && y > 0.0);
}

// s = s0 + correction (g + s0) with s0 the way to clip(g + moved); below zero with the opposite sign of
// the correction, so that a prescribed mean is kept on either side.
fn trial_step(here: Here, moved: real, correction: real) -> Tried {
    if (goes_down(here.open, here.y)) {
        let down = min(moved, -here.open);
        return Tried(down - correction * (here.open + down), here.open + moved > 0.0);
    }
    let up = max(moved, -here.open);
    return Tried(up + correction * (here.open + up), here.open + moved < 0.0);
}

fn corrected_step(here: Here, step: real, correction: real, in_domain: bool) -> real {
    return step;
}

fn touches(open: real, step: real) -> bool {
    return (open >= 0.0 && step < 0.0) || (open < 0.0 && step > 0.0);
}

// The gap after t of a step: no point crosses zero.
fn land(here: Here, step: real, t: real) -> real {
    let moved = here.gap + t * step;
    let snap = real(scalars.snap);
    if (goes_down(here.gap, here.y)) {
        return select(moved, closed_gap(), moved > 0.0 || (step > 0.0 && moved > -snap));
    }
    return select(moved, closed_gap(), moved < 0.0 || (step < 0.0 && moved < snap));
}

fn pressure_weight(here: Here) -> real {
    return abs(here.gap);
}

fn corrected_gap(gap: real, correction: real) -> real {
    return gap + correction;
}

fn net_traction(here: Here) -> real {
    return select(here.pull, -real(params.hardness), here.gap < 0.0);
}
