//! The automatic taper of Maugis-Dugdale: straight contact edges along the grid, which no curvature frees
//! from the pixels, and what it leaves of a sphere.
//!
//! A wave that is constant along the grid has such edges. What Johnson 1995 says of it with a range of
//! nothing, [`CohesiveWave`] says with one.

use std::f64::consts::PI;

use tabor::study::State;
use tabor::theory::cohesive_wave::CohesiveWave;
use tabor::theory::maugis_dugdale::{FOLD_LAMBDA, MaugisDugdale};
use tabor::theory::westergaard::adhesive_extrema;

use crate::bench::{Solved, solve_table};
use crate::shared::trials::tests;

const AMPLITUDE: f64 = 0.01;
/// p* of a wave of length 1 on a solid of modulus 1.
const FULL: f64 = PI * AMPLITUDE;

/// A wave of length 1 along `points`, constant along the two others.
struct Strip {
    points: usize,
    adhesion: f64,
    chi: f64,
    along_y: bool,
}

impl Strip {
    fn work(&self) -> f64 {
        0.5 * (self.adhesion * PI * AMPLITUDE).powi(2)
    }

    fn range(&self) -> f64 {
        (self.work() / self.points as f64 / self.chi).sqrt()
    }

    /// Pull-off and the pressure that closes it, in Pa, both positive.
    fn closed_form(&self) -> [f64; 2] {
        let wave = CohesiveWave::new(self.adhesion, self.range() / AMPLITUDE).expect("numbers");
        let off = wave.pull_off().expect("a turn").mean_pressure;
        let closing = wave.closing().expect("a turn").mean_pressure;
        [-off * FULL, closing * FULL]
    }

    fn solve(&self, law: &str, path: &[f64]) -> Solved {
        let (points, side) = (self.points, 2.0 / self.points as f64);
        let (grid, size, wavelength) = if self.along_y {
            (
                format!("[2, {points}]"),
                format!("[{side:e}, 1.0]"),
                "[\"inf\", 1.0]",
            )
        } else {
            (
                format!("[{points}, 2]"),
                format!("[1.0, {side:e}]"),
                "[1.0, \"inf\"]",
            )
        };
        solve_table(&format!(
            r#"
            [grid]
            points = {grid}
            size = {size}
            [solid]
            contact_modulus = 1.0
            [[surface]]
            kind = "wavy"
            amplitude = {AMPLITUDE}
            wavelength = {wavelength}
            [adhesion]
            law = "{law}"
            work_of_adhesion = {:e}
            range = {:e}
            [loading]
            control = "pressure"
            path = {path:?}
            "#,
            self.work(),
            self.range(),
        ))
    }

    /// Shares by which it comes off and closes late, to the steps of `STEP`, at most `most`.
    fn late(&self, law: &str, most: f64) -> [f64; 2] {
        let turns = self.closed_form();
        let shares: Vec<f64> = [0.7, 0.9]
            .into_iter()
            .chain((0..).map(|i| FIRST + STEP * f64::from(i)))
            .take_while(|share| *share <= 1.0 + most)
            .collect();
        let path = |start: f64, turn: f64| -> Vec<f64> {
            let way = shares.iter().map(|share| share * turn);
            [start, 0.0].into_iter().chain(way).collect()
        };
        let off = self.solve(law, &path(0.5 * turns[1], -turns[0]));
        let off = off
            .rows()
            .filter(|row| row.state == State::Contact)
            .map(|row| -row.mean_pressure)
            .fold(0.0, f64::max);
        let closing = self.solve(law, &path(0.0, turns[1]));
        let closing = closing
            .rows()
            .filter(|row| row.contact_area_fraction < 1.0)
            .map(|row| row.mean_pressure)
            .fold(0.0, f64::max);
        [
            off / turns[0] - 1.0 + 0.5 * STEP,
            closing / turns[1] - 1.0 + 0.5 * STEP,
        ]
    }
}

/// The first load near a turn, and the step from there on, as shares of it.
const FIRST: f64 = 0.96;
const STEP: f64 = 0.002;

/// Off and closed within 1.5 % of the closed form at chi 0.25 and 1 % at 0.1, which is what the width was
/// chosen by; half a step besides. An exponential law, whose edge is free at these chi, is the control.
fn straight_edges_are_free() {
    for (points, adhesion, chi, along_y, allowed) in [
        (1024, 0.1, 0.25, false, 0.015),
        (1024, 0.3, 0.25, true, 0.015),
        (1024, 0.1, 0.1, false, 0.01),
        (1024, 0.3, 0.1, false, 0.01),
        (256, 0.3, 0.25, true, 0.015),
        (256, 0.3, 0.1, false, 0.01),
    ] {
        let strip = Strip {
            points,
            adhesion,
            chi,
            along_y,
        };
        if points == 1024 {
            // So short a range that Johnson's wave is met to a tenth of what is asked.
            let johnson = adhesive_extrema(adhesion).expect("both turns");
            let [off, closing] = strip.closed_form();
            assert!((off / FULL / johnson.pull_off - 1.0).abs() < 2e-3);
            assert!((closing / FULL / johnson.closing_pressure - 1.0).abs() < 2e-3);
        }
        let late = strip.late("maugis-dugdale", 2.0 * allowed);
        println!(
            "{points} points, alpha {adhesion}, chi {chi}: off {:+.2} %, closed {:+.2} %",
            100.0 * late[0],
            100.0 * late[1]
        );
        for (turn, late) in ["off", "closed"].iter().zip(late) {
            assert!(
                late.abs() < allowed + 0.5 * STEP,
                "{points} points, alpha {adhesion}, chi {chi}: {turn} {:+.2} %",
                100.0 * late
            );
        }
    }
    let strip = Strip {
        points: 1024,
        adhesion: 0.3,
        chi: 0.25,
        along_y: false,
    };
    let late = strip.late("exponential", 0.02);
    assert!(late.iter().all(|late| late.abs() < 0.01), "{late:?}");
}

/// Where the taper cannot be wide enough the run says by how much straight edges come off late, and where it says
/// nothing they are right: to 3 % up to chi 0.65, to 11 % up to 1.3 and one step.
fn trapped_edges_are_warned_of() {
    for (chi, warned, allowed) in [
        (0.5, false, 0.03),
        (0.65, false, 0.03),
        (0.8, true, 0.11),
        (1.3, true, 0.11),
    ] {
        let strip = Strip {
            points: 256,
            adhesion: 0.3,
            chi,
            along_y: false,
        };
        let [off, _] = strip.late("maugis-dugdale", 0.12);
        println!("chi {chi}: off {:+.2} %", 100.0 * off);
        assert!(off < allowed + STEP, "chi {chi}: {off}");
        let said = strip.solve("maugis-dugdale", &[0.0]).setup.warnings;
        let trapped = said
            .iter()
            .find(|text| text.contains("straight along the grid"));
        assert_eq!(trapped.is_some(), warned, "chi {chi}: {said:?}");
        assert!(
            !warned || off > 0.03,
            "a needless warning at chi {chi}: {off}"
        );
    }
}

/// Surfaces that are smoother than the range part as a whole: the taper lowers their pull-off, of which a run warns, and the sharp law
/// is right on the same grid, of which it warns no more. Against the sharp law on a grid four times as fine.
fn the_taper_of_smooth_surfaces_is_warned_of() {
    const FACTOR: f64 = 1.01;
    for (roughness, chi, tapered) in [(0.6, 0.1, [0.05, 0.10]), (0.33, 0.3, [0.18, 0.24])] {
        // Lengths over the size; the modulus is 1.
        let (pixel, range) = (1.0 / 48.0, 7.5e-4);
        let work = chi * range * range / pixel;
        let peak = work / range;
        let pulled = |points: usize, taper: &str| {
            let tensions =
                std::iter::successors(Some(0.3 * peak), |tension| Some(tension * FACTOR));
            let mut path = vec![2.0 * peak, 0.0];
            path.extend(
                tensions
                    .take_while(|&tension| tension < peak)
                    .map(|tension| -tension),
            );
            let solved = solve_table(&format!(
                r#"
                [grid]
                points = {points}
                size = 1.0
                [solid]
                contact_modulus = 1.0
                [[surface]]
                kind = "self-affine"
                hurst = 0.7
                rms_height = {:e}
                longest = 1.0
                rolloff = 0.5
                shortest = {:e}
                seed = 3
                [adhesion]
                law = "maugis-dugdale"
                work_of_adhesion = {work:e}
                range = {range:e}
                {taper}
                [loading]
                control = "pressure"
                path = {path:?}
                "#,
                roughness * range,
                10.0 * pixel
            ));
            let held = solved.rows().filter(|row| row.state != State::Separated);
            let off = held.map(|row| -row.mean_pressure).fold(0.0, f64::max);
            (off, solved.setup.warnings.join("\n"))
        };
        let (reference, _) = pulled(192, "taper = 0");
        let (sharp, said) = pulled(48, "taper = 0");
        assert!(
            (sharp / reference - 1.0).abs() < 0.05,
            "{sharp} {reference}"
        );
        assert!(!said.contains("traps"), "{said}");
        let (wide, said) = pulled(48, "");
        let low = 1.0 - wide / reference;
        println!(
            "rms height {roughness} h0, chi {chi}: {:.1} % low",
            100.0 * low
        );
        assert!((tapered[0]..tapered[1]).contains(&low), "{low}");
        assert!(
            said.contains("part as a whole") && said.contains("take taper = 0"),
            "{said}"
        );
    }
}

/// Between its two turns the wave has one state at a load, so loading and unloading have one area: to the pixel
/// at each edge that lies on a point's boundary.
fn a_wave_loads_and_unloads_alike() {
    for (adhesion, chi) in [(0.1, 0.25), (0.3, 0.25), (0.3, 0.1)] {
        let strip = Strip {
            points: 1024,
            adhesion,
            chi,
            along_y: false,
        };
        let [_, closing] = strip.closed_form();
        let path = [0.0, 0.25, 0.5, 0.75, 0.5, 0.25, 0.0].map(|share| share * closing);
        for law in ["maugis-dugdale", "exponential"] {
            let solved = strip.solve(law, &path);
            let pixels: Vec<f64> = solved
                .rows()
                .map(|row| row.contact_area_fraction * strip.points as f64)
                .collect();
            let apart = (0..3)
                .map(|i| (pixels[i] - pixels[pixels.len() - 1 - i]).abs())
                .fold(0.0, f64::max);
            println!("{law}, alpha {adhesion}, chi {chi}: ways {apart:.0} pixels apart");
            assert!(
                apart <= 2.0,
                "{law}, alpha {adhesion}, chi {chi}: {pixels:?}"
            );
        }
    }
}

/// Errors of a sphere in Maugis' units on a window of `points`: pull-off, and the largest of the force on the
/// way out in 2 pi w R, against the closed form; and chi.
fn sphere_errors(lambda: f64, points: usize, narrow: bool) -> ([f64; 2], f64) {
    let theory = MaugisDugdale::new(lambda).expect("a number");
    let pull_off = -theory.pull_off().expect("a fold").force;
    // Below the lambda of the fold a contact closes to a point first.
    let least = if lambda > FOLD_LAMBDA {
        theory.grip().expect("a fold")
    } else {
        theory.state(1e-6).expect("a radius")
    };
    let zero = theory.states_at_force(0.0).expect("states");
    let zero = zero.last().expect("one holds");
    let side = 2.3 * zero.cohesive_radius;
    // sigma0 dx/(E* h0), sigma0 being lambda/2 and E* 3/4.
    let pixel = side / points as f64;
    let chi = 0.5 * lambda * pixel / (0.75 * theory.range());
    let taper = if narrow {
        format!("taper = {:e}", 2.0 * 0.5 * lambda * pixel / 0.75)
    } else {
        String::new()
    };
    let solve = |control: &str, path: &[f64]| {
        solve_table(&format!(
            r#"
            [grid]
            points = {points}
            size = {side:e}
            boundary = "free"
            [solid]
            contact_modulus = 0.75
            [[surface]]
            kind = "sphere"
            radius = 1.0
            [adhesion]
            law = "maugis-dugdale"
            work_of_adhesion = {:e}
            range = {:e}
            {taper}
            [loading]
            control = "{control}"
            path = {path:?}
            "#,
            1.0 / PI,
            theory.range(),
        ))
    };
    let mut path = vec![0.0, -0.6 * pull_off, -0.9 * pull_off];
    path.extend((0..32).map(|i| -pull_off * (0.96 + LOAD_STEP * f64::from(i))));
    let held = solve("force", &path)
        .rows()
        .filter(|row| row.state != State::Separated)
        .map(|row| -row.force)
        .fold(0.0, f64::max);
    let start = zero.approach + 0.3;
    let end = least.approach + 0.05;
    // The edge moves from pixel to pixel, and a force swings with it: 16 steps find the greatest error by chance.
    let path: Vec<f64> = (0..=80)
        .map(|i| start + (end - start) * f64::from(i) / 80.0)
        .collect();
    let force = solve("approach", &path)
        .rows()
        .zip(&path)
        .map(|(row, approach)| {
            let states = theory.states_at_approach(*approach).expect("states");
            0.5 * (row.force - states.last().expect("one holds").force).abs()
        })
        .fold(0.0, f64::max);
    (
        [(held / pull_off - 1.0 + 0.5 * LOAD_STEP).abs(), force],
        chi,
    )
}

/// Step of the load around pull-off, as a share of it.
const LOAD_STEP: f64 = 0.0025;

/// A wide taper changes what a sphere feels before it touches, and its contact hardly: on the same grid neither
/// error is above 1.3 times that with a taper of 2 sigma0 dx/E*, which stood here before, at chi 0.5 and below.
/// What is found is recorded in `docs/solver.md`.
fn spheres_lose_nothing_by_it() {
    for (lambda, points) in [(0.5, 64), (1.0, 64), (2.0, 96), (2.0, 64), (2.0, 48)] {
        let [(wide, chi), (narrow, _)] =
            [false, true].map(|narrow| sphere_errors(lambda, points, narrow));
        assert!(chi <= 0.5, "chi {chi}");
        println!(
            "lambda {lambda}, {points} points, chi {chi:.2}: pull-off {:.2} % ({:.2} %), force {:.2} % ({:.2} %) of 2 pi w R",
            100.0 * wide[0],
            100.0 * narrow[0],
            100.0 * wide[1],
            100.0 * narrow[1]
        );
        // A pull-off is known to half a step of the load; a force is what it is.
        for (wide, narrow, known) in [
            (wide[0], narrow[0], 0.5 * LOAD_STEP),
            (wide[1], narrow[1], 0.0),
        ] {
            assert!(
                wide <= 1.3 * narrow + known,
                "lambda {lambda}, {points} points: {wide} for {narrow}"
            );
        }
    }
}

tests![
    straight_edges_are_free,
    trapped_edges_are_warned_of,
    the_taper_of_smooth_surfaces_is_warned_of,
    a_wave_loads_and_unloads_alike,
    spheres_lose_nothing_by_it,
];
