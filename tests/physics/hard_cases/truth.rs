//! Whether fields that a run wrote are an equilibrium: asked of the files alone, in double
//! precision, with a plain transform or Love's coefficients and laws of its own.

use std::f64::consts::PI;

use num_complex::Complex;

use super::case::{Case, Contact, Law};
use super::paths::Path;
use super::run::{Row, Run};

/// Rounding errors of the fields that an unknown may carry: one from the solver, one from the file,
/// and as much again from a mean taken off in another order.
const ROUNDINGS: f64 = 4.0;

/// Fields of a step, as written.
pub struct Fields {
    pub gap: Vec<f64>,
    pub pressure: Vec<f64>,
}

impl Fields {
    pub fn at_step(run: &Run, step: usize) -> Option<Fields> {
        Some(Fields {
            gap: run.field(step, "gap")?,
            pressure: run.field(step, "pressure")?,
        })
    }
}

pub fn norm(values: impl IntoIterator<Item = f64>) -> f64 {
    values
        .into_iter()
        .map(|value| value * value)
        .sum::<f64>()
        .sqrt()
}

/// Stiffness E*|q|/2 of each wave of the cell, both half planes, `[ny, nx]`.
fn stiffness(contact: &Contact) -> Vec<f64> {
    let [nx, ny] = contact.points;
    let wave = |index: usize, count: usize, side: f64| {
        let signed = if 2 * index > count {
            index as f64 - count as f64
        } else {
            index as f64
        };
        2.0 * PI * signed / side
    };
    (0..nx * ny)
        .map(|i| {
            let (qx, qy) = (
                wave(i % nx, nx, contact.size[0]),
                wave(i / nx, ny, contact.size[1]),
            );
            0.5 * contact.modulus * qx.hypot(qy)
        })
        .collect()
}

/// Largest and least stiffness of a wave that is not uniform.
pub fn stiffest_and_softest(contact: &Contact) -> [f64; 2] {
    if contact.free {
        // Measured apart from this code for any m (the Nyquist corner), and Love's table summed.
        let [dx, dy] = contact.pixel();
        let side = (2 * contact.points[0].max(contact.points[1])) as f64;
        let pixel = (dx * dy).sqrt();
        return [1.722, 1.0 / (1.122 * side)].map(|share| share * contact.modulus / pixel);
    }
    let all = stiffness(contact);
    let waves = || all.iter().copied().filter(|k| *k > 0.0);
    if contact.count() == 1 {
        // No wave at all: the measure's unit.
        let [dx, dy] = contact.pixel();
        return [contact.modulus / (dx * dy).sqrt(); 2];
    }
    let most = waves().fold(0.0, f64::max);
    [most, waves().fold(most, f64::min)]
}

/// The Fourier transform of a line, split by the factors of its length; `roots` are those of unity for the line
/// that was split first.
fn transform(line: &[Complex<f64>], roots: &[Complex<f64>]) -> Vec<Complex<f64>> {
    let length = line.len();
    let Some(factor) = (2..=length).find(|factor| length.is_multiple_of(*factor)) else {
        return line.to_vec();
    };
    let parts: Vec<Vec<Complex<f64>>> = (0..factor)
        .map(|first| {
            let part: Vec<_> = line[first..].iter().step_by(factor).copied().collect();
            transform(&part, roots)
        })
        .collect();
    let stride = roots.len() / length;
    let root = |first: usize, wave: usize| roots[first * wave % length * stride];
    (0..length)
        .map(|wave| {
            let terms = parts.iter().enumerate();
            terms
                .map(|(first, part)| root(first, wave) * part[wave % part.len()])
                .sum()
        })
        .collect()
}

/// K*u on the periodic cell.
pub fn elastic_pressure(contact: &Contact, displacement: &[f64]) -> Vec<f64> {
    let [nx, ny] = contact.points;
    let mut field: Vec<Complex<f64>> = displacement.iter().map(|u| Complex::new(*u, 0.0)).collect();
    let stiffness = stiffness(contact);
    for forward in [true, false] {
        for (length, stride) in [(nx, 1), (ny, nx)] {
            let turn = if forward { -2.0 * PI } else { 2.0 * PI };
            let roots: Vec<Complex<f64>> = (0..length)
                .map(|i| Complex::cis(turn * i as f64 / length as f64))
                .collect();
            let mut line = vec![Complex::default(); length];
            for start in 0..nx * ny / length {
                let first = if stride == 1 { start * nx } else { start };
                (0..length).for_each(|i| line[i] = field[first + i * stride]);
                let waves = transform(&line, &roots);
                (0..length).for_each(|i| field[first + i * stride] = waves[i]);
            }
        }
        if forward {
            field
                .iter_mut()
                .zip(&stiffness)
                .for_each(|(wave, k)| *wave *= *k);
        }
    }
    field
        .iter()
        .map(|value| value.re / (nx * ny) as f64)
        .collect()
}

/// Displacement of the free half-space under uniform pressures on pixels (Love), summed directly.
fn displacement(contact: &Contact, pressure: &[f64]) -> Vec<f64> {
    let [nx, ny] = contact.points;
    let [dx, dy] = contact.pixel();
    let of_rectangle = |x: f64, y: f64| {
        let (a, b) = (0.5 * dx, 0.5 * dy);
        let part = |u: f64, v: f64, w: f64| u * ((w / u.abs()).asinh() - (v / u.abs()).asinh());
        (part(x + a, y - b, y + b) - part(x - a, y - b, y + b) + part(y + b, x - a, x + a)
            - part(y - b, x - a, x + a))
            / (PI * contact.modulus)
    };
    let table: Vec<f64> = (0..nx * ny)
        .map(|i| of_rectangle((i % nx) as f64 * dx, (i / nx) as f64 * dy))
        .collect();
    let mut out = vec![0.0; nx * ny];
    for (source, p) in pressure.iter().enumerate().filter(|(_, p)| **p != 0.0) {
        let (sx, sy) = (source % nx, source / nx);
        for (y, line) in out.chunks_exact_mut(nx).enumerate() {
            let away = &table[y.abs_diff(sy) * nx..][..nx];
            let (left, right) = line.split_at_mut(sx);
            for (u, share) in left.iter_mut().rev().zip(&away[1..]) {
                *u += share * p;
            }
            for (u, share) in right.iter_mut().zip(away) {
                *u += share * p;
            }
        }
    }
    out
}

/// Checks a step: gaps, complementarity, force balance and the counted area. `heights` are the
/// judge's, in double precision whatever the path.
pub fn check(case: &Case, path: &Path, row: &Row, fields: &Fields, heights: &[f64], what: &str) {
    let contact = &case.contact;
    let Fields { gap, pressure } = fields;
    let count = contact.count() as f64;
    assert!(
        gap.iter().chain(pressure).all(|value| value.is_finite()),
        "{what}"
    );
    let wall = contact.law.has_wall();
    assert!(
        !wall || gap.iter().all(|gap| *gap >= 0.0),
        "{what}: the surfaces overlap"
    );
    let touching = gap
        .iter()
        .filter(|gap| if wall { **gap == 0.0 } else { **gap < 0.0 })
        .count();
    assert_eq!(
        row.contact,
        touching as f64 / count,
        "{what}: counted contact"
    );
    let [most, softest] = stiffest_and_softest(contact);
    let spread = norm(
        heights
            .iter()
            .map(|h| h - heights.iter().sum::<f64>() / count),
    );
    let unknowns = norm(gap.iter().copied()).max(spread);
    // The size of the pressures, as docs/solver.md defines it; and what rounding alone makes of
    // the stiffest wave, for which a step that stops there counts as converged.
    let reaction = |i: usize| {
        let attraction = contact.law.traction(gap[i], contact);
        let wall = if wall && gap[i] == 0.0 {
            pressure[i] + attraction
        } else {
            0.0
        };
        [wall, attraction]
    };
    let size = norm((0..gap.len()).flat_map(reaction));
    let allowed = 1.1 * case.tolerance(path) * size
        + ROUNDINGS * path.epsilon * (most * unknowns + norm(pressure.iter().copied()));
    if !contact.free {
        let u: Vec<f64> = gap.iter().zip(heights).map(|(g, h)| g + h).collect();
        let violation = violation(
            contact,
            &elastic_pressure(contact, &u),
            row,
            gap,
            path,
            most,
        );
        assert!(
            violation <= allowed,
            "{what}: off balance by {violation:e}, {allowed:e} allowed"
        );
        let mean = pressure.iter().sum::<f64>() / count;
        let off = (mean - row.mean_pressure).abs();
        // The mean of what is off balance is at most its rms.
        let allowed = allowed / count.sqrt() + path.epsilon * size;
        assert!(
            off <= allowed,
            "{what}: the pressures' mean is off by {off:e}, {allowed:e} allowed"
        );
    } else {
        // The surface lies where its own pressures put it. An imbalance is worth at most the softest
        // answer to it; what rounds is the gap and the position.
        let apex = 0.0;
        let approach = row.approach.expect("a position");
        let predicted = displacement(contact, pressure);
        let off =
            norm((0..gap.len()).map(|i| apex - heights[i] - approach + predicted[i] - gap[i]));
        let rounding = ROUNDINGS * path.epsilon * (unknowns + approach.abs() * count.sqrt());
        let allowed = allowed / softest + rounding;
        assert!(
            off <= allowed,
            "{what}: displaced by {off:e}, {allowed:e} allowed"
        );
        let force = pressure.iter().sum::<f64>() * contact.pixel()[0] * contact.pixel()[1];
        let off = (force - row.force).abs();
        let area = contact.pixel()[0] * contact.pixel()[1] * count;
        let allowed = area * allowed * softest / count.sqrt() + 1e-12 * row.force.abs();
        assert!(
            off <= allowed,
            "{what}: the force is off by {off:e}, {allowed:e} allowed"
        );
    }
}

/// Norm of what is off balance: of points that press and gape at once the lesser part.
fn violation(
    contact: &Contact,
    elastic: &[f64],
    row: &Row,
    gap: &[f64],
    path: &Path,
    stiffest: f64,
) -> f64 {
    let wall = contact.law.has_wall();
    norm((0..gap.len()).map(|i| {
        // The law at the gap as far as its rounding tells: a sharp end may fall within it.
        let blur = ROUNDINGS * path.epsilon * gap[i].abs();
        let y = [gap[i] - blur, gap[i], gap[i] + blur]
            .map(|gap| elastic[i] + row.mean_pressure + contact.law.traction(gap, contact));
        let (low, high) = (y[0].min(y[1]).min(y[2]), y[0].max(y[1]).max(y[2]));
        let off = if low > 0.0 { low } else { high.min(0.0) };
        if wall {
            off.min(gap[i] * stiffest)
        } else {
            off
        }
    }))
}

/// Checks another path's step against the judge's.
pub fn compare(
    case: &Case,
    path: &Path,
    [ours, judge]: [&Row; 2],
    fields: [&Fields; 2],
    what: &str,
) {
    let contact = &case.contact;
    let [found, expected] = fields;
    let [most, softest] = stiffest_and_softest(contact);
    // Pressures off balance by a share move the softest wave by that share over its stiffness, and
    // both solves may be off; with adhesion the softest state is softer still.
    let soft = if is_adhesive(contact.law) {
        SOFTENED
    } else {
        1.0
    };
    let share = 2.0 * case.tolerance(path) * most / softest * soft;
    let unknowns = norm(expected.gap.iter().copied());
    let size = norm(expected.pressure.iter().copied());
    let rounding = ROUNDINGS * path.epsilon * most * unknowns;
    let differ = |a: &[f64], b: &[f64]| norm(a.iter().zip(b).map(|(a, b)| a - b));
    let gap = differ(&found.gap, &expected.gap);
    let pressure = differ(&found.pressure, &expected.pressure);
    let gap_allowed = share * unknowns.max(size / most) + rounding / softest;
    let pressure_allowed = share * size + rounding;
    println!(
        "{what}: gap {:.1e}, pressure {:.1e}, contact {} {}, {share:.1e} allowed",
        gap / unknowns,
        pressure / size,
        ours.contact,
        judge.contact
    );
    assert!(
        gap <= gap_allowed,
        "{what}: gaps differ by {gap:e}, {gap_allowed:e} allowed"
    );
    assert!(
        pressure <= pressure_allowed,
        "{what}: pressures differ by {pressure:e}, {pressure_allowed:e} allowed"
    );
    // Points that barely touch or barely gape may be counted either way.
    let count = contact.count() as f64;
    let undecided = (0..expected.gap.len()).filter(|&i| {
        let reaction = expected.pressure[i] + contact.law.traction(expected.gap[i], contact);
        match expected.gap[i] > 0.0 || !contact.law.has_wall() {
            true => expected.gap[i].abs() <= gap_allowed / count.sqrt(),
            false => reaction <= pressure_allowed / count.sqrt(),
        }
    });
    let allowed = (undecided.count() + 1) as f64 / count;
    let off = (ours.contact - judge.contact).abs();
    assert!(
        off <= allowed,
        "{what}: contact of {} and {}, {allowed:.1e} allowed",
        ours.contact,
        judge.contact
    );
}

/// How much softer than the softest wave a state with adhesion may be, away from its folds.
const SOFTENED: f64 = 10.0;

/// Whether the law acts at all.
pub fn is_adhesive(law: Law) -> bool {
    !matches!(law, Law::Wall)
}
