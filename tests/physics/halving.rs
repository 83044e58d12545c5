//! The length of the steps: a loop walked in half steps is the same loop.

use crate::bench::{Solved, solve_table};
use crate::energy::{RMS_HEIGHT, laws, loop_path, rough, sphere};
use crate::shared::trials::tests;

/// Agreement of a force that both paths reach on one branch: each solve ends at a residual of 1e-9,
/// which the softest state, some thousandth of the stiffest, turns into this.
const SAME_STATE: f64 = 1e-5;

/// Force over place of a loop, with what it encloses and where it jumps.
struct Loop {
    forces: Vec<f64>,
    enclosed: f64,
    pull_off: f64,
    jumps: Vec<usize>,
}

impl Loop {
    fn from_solved(solved: &Solved) -> Loop {
        let forces: Vec<f64> = solved.rows().map(|row| row.force).collect();
        let end = &solved.end;
        Loop {
            pull_off: -forces.iter().copied().fold(0.0, f64::min),
            enclosed: end.hysteresis_energy.expect("a closed path").abs(),
            jumps: end
                .jump_in_steps
                .iter()
                .chain(&end.jump_off_steps)
                .map(|step| step - 1)
                .collect(),
            forces,
        }
    }

    /// By how much halving steps of a length may change what is enclosed, and pull-off.
    ///
    /// A step's work is a trapezium. Of a jump it knows no more than the step in which it falls, so it is
    /// off by at most half the step times the jump, of halved steps by a quarter: three quarters apart.
    /// Where the force is smooth a trapezium is off by a twelfth of the step times the change of the
    /// force's own change, halved steps by a quarter of that: within an eighth.
    ///
    /// The largest tension lies within a step of a row. On a smooth crest it is above the row by an eighth
    /// of that change, here twice as much for a crest that bends more than its rows; before a jump
    /// the branch goes on for less than a step, by no more than it did in the step before.
    fn allowed(&self, step: f64) -> [f64; 2] {
        let change = |i: usize| self.forces[i] - self.forces[i - 1];
        let jumps: f64 = self.jumps.iter().map(|&i| change(i).abs()).sum();
        let jumped = |i: &usize| self.jumps.contains(i) || self.jumps.contains(&(i + 1));
        let bends = |i: usize| (change(i + 1) - change(i)).abs();
        let inner = (1..self.forces.len() - 1).filter(|i| !jumped(i));
        let smooth: f64 = inner.map(bends).sum();
        let rows = 1..self.forces.len() - 1;
        let lowest = rows
            .min_by(|a, b| self.forces[*a].total_cmp(&self.forces[*b]))
            .expect("rows");
        let above = match jumped(&lowest) {
            true => change(lowest).abs(),
            false => 0.25 * bends(lowest),
        };
        [step * (0.75 * jumps + 0.125 * smooth), above]
    }
}

/// `stated` are the shares by which the loop and pull-off may change.
fn compare(name: &str, coarse: &Loop, fine: &Loop, step: f64, stated: [f64; 2]) {
    let [enclosed, pull_off] = coarse.allowed(step);
    let changed = (coarse.enclosed - fine.enclosed).abs();
    let pulled = fine.pull_off - coarse.pull_off;
    println!(
        "{name}: loop {:.4e}, halved steps change it by {:.2} % ({:.2} % allowed), pull-off by {:.3} % ({:.3} %); {} jumps, {}",
        fine.enclosed,
        100.0 * changed / fine.enclosed,
        100.0 * enclosed / fine.enclosed,
        100.0 * pulled / fine.pull_off,
        100.0 * pull_off / fine.pull_off,
        coarse.jumps.len(),
        fine.jumps.len(),
    );
    assert!(
        !coarse.jumps.is_empty(),
        "{name}: nothing jumps, nothing is shown"
    );
    // What is stated: a bound that says nothing would be met by anything.
    let shares = [enclosed / fine.enclosed, pull_off / fine.pull_off];
    assert!(
        shares[0] < stated[0] && shares[1] < stated[1],
        "{name}: {shares:?} allowed"
    );
    assert!(
        changed <= enclosed,
        "{name}: {changed:e} of {enclosed:e} allowed"
    );
    // Every row of the coarse path is one of the fine.
    let rounding = SAME_STATE * fine.pull_off;
    assert!(
        pulled >= -rounding && pulled <= pull_off + rounding,
        "{name}: {pulled:e} of {pull_off:e} allowed"
    );
}

fn a_sphere() {
    let steps = 120;
    let [from, to] = [-3.8, -1.0];
    let [coarse, fine] = [steps, 2 * steps]
        .map(|steps| Loop::from_solved(&sphere(2.0, 8.0, &loop_path(from, to, steps))));
    compare(
        "sphere, Lennard-Jones, mu 2",
        &coarse,
        &fine,
        (to - from) / steps as f64,
        [0.04, 0.001],
    );
    // On a branch the state knows nothing of the steps that led to it.
    let size = coarse.pull_off;
    for (i, force) in coarse.forces.iter().enumerate() {
        if !coarse.jumps.contains(&i) {
            let off = (force - fine.forces[2 * i]).abs();
            assert!(off <= SAME_STATE * size, "step {i}: {off:e}");
        }
    }
}

/// chi = w dx/(E* range^2) = 0.46: where pixels trap the edge (beyond 0.65, of which a run warns) there are
/// equilibria enough for two paths to end in two of them.
fn a_rough_surface() {
    let steps = 200;
    let [from, to] = [3.5 * RMS_HEIGHT, 0.75 * RMS_HEIGHT];
    let (_, adhesion) = &laws(2e-4, 3e-3)[1];
    // The automatic taper, twice the range on so few points, leaves no jump to look at.
    let adhesion = format!("{adhesion}\ntaper = 2.7e-3");
    let [coarse, fine] = [steps, 2 * steps].map(|steps| {
        let path = loop_path(from, to, steps);
        let loading = format!("control = \"mean-gap\"\npath = {path:?}");
        Loop::from_solved(&solve_table(&rough(48, &adhesion, &loading)))
    });
    let step = (from - to) / steps as f64;
    // A dozen jumps of a loop that is a few per cent of the work done: each lies anywhere within its step.
    compare("rough, tapered", &coarse, &fine, step, [0.4, 0.02]);
}

/// A search halves a step eight times at most, and leaves out what loses less than a hundredth of the work of the points
/// that changed: what bends, or jumps besides, hides a jump in a step that is long for the range. In steps of a tenth of
/// the range none hides whose force is a tenth of the greatest: those of steps an eighth as long are all listed.
fn short_steps_list_the_jumps_of_shorter_ones() {
    const STEPS: usize = 48;
    const FINER: usize = 8;
    let mut listed = 0;
    for seed in [1, 11] {
        let [coarse, fine] = [STEPS, FINER * STEPS].map(|steps| {
            let path = loop_path(-3e-7, 1.5e-7, steps);
            Loop::from_solved(&solve_table(&format!(
                r#"
grid = {{ points = 32, size = "20 um" }}
solid = {{ contact_modulus = "2 MPa" }}
surface = [{{ kind = "self-affine", hurst = 0.5, rms_slope = 0.1, longest = "20 um", rolloff = "20 um", shortest = "5 um", seed = {seed} }}]
adhesion = {{ law = "maugis-dugdale", work_of_adhesion = "20 mJ/m^2", range = "100 nm" }}
loading = {{ control = "approach", path = {path:?} }}
"#
            )))
        });
        let forces = &fine.forces;
        let greatest = forces
            .iter()
            .fold(0.0_f64, |most, force| most.max(force.abs()));
        for &jump in &fine.jumps {
            if (forces[jump] - forces[jump - 1]).abs() > 0.1 * greatest {
                let step = jump.div_ceil(FINER);
                assert!(coarse.jumps.contains(&step), "seed {seed}: step {step}");
                listed += 1;
            }
        }
    }
    assert!(listed > 3, "{listed} jumps");
}

tests![
    a_sphere,
    a_rough_surface,
    short_steps_list_the_jumps_of_shorter_ones,
];
