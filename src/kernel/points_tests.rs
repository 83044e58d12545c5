//! Tests of kernels that look at one point at a time.

use pulp::Scalar;

use super::*;
use crate::kernel::Whole;
use crate::kernel::constraint::Unilateral;

/// Reads one field, updates another and the line, and adds to one sum of each kind.
struct Probe;

impl PointKernel<f64, Unilateral<f64>, 1, 1, 3> for Probe {
    fn at(
        _: &Numbers<f64, Unilateral<f64>>,
        law: &impl Cohesion<f64>,
        point: &mut Point<f64, 1, 1, 3>,
    ) {
        let [read] = point.reads;
        let pull = if point.in_domain {
            law.traction(read)
        } else {
            -1.0
        };
        point.writes[0] += read;
        point.line *= pull;
        point.terms = [read * pull, read, read];
    }
}

/// Rows that are no multiple of a group long, with and without a pad: each point is visited once, in
/// its own place, and a place without a point adds nothing. Without wide vectors all comes out in the same bits.
#[test]
fn every_point_once() {
    let law = crate::law::MaugisDugdale {
        peak_tension: 2.0,
        range: 0.5,
        taper: 0.0,
    };
    for (width, count, surface) in [
        (7, 1, [7, 1]),
        (LANES + 5, 3, [LANES + 5, 3]),
        (2 * LANES, 4, [LANES + 1, 2]),
        (3, 5, [0, 0]),
    ] {
        let points = width * count;
        let read: Vec<f64> = (0..points).map(|i| (i as f64 * 0.37).sin()).collect();
        let factor: Vec<f64> = (0..points).map(|i| 1.0 + i as f64).collect();
        let walked = |side_by_side: bool| {
            let (mut written, mut lines) = (vec![1.0; points], vec![3.0; points]);
            let mut rows = Rows {
                first: 0,
                width,
                count,
                surface,
                lines: &mut lines,
                reads: [&read, &[], &[], &[]],
                writes: [&mut written, &mut [], &mut [], &mut []],
                whole: Whole::none(),
                around: Whole::none(),
                factor: &factor,
                outer_gap: &[],
                reduces: &[Reduce::Add, Reduce::Min, Reduce::Max],
            };
            let mut sums = [0.0; SUMS];
            (sums[1], sums[2]) = (f64::INFINITY, f64::NEG_INFINITY);
            let walk = Walk::<_, _, Probe, _, 1, 1, 3> {
                kernel: PhantomData,
                numbers: Numbers::<f64, Unilateral<f64>>::default(),
                law: AdhesionMap(law),
                rows: &mut rows,
                sums: &mut sums,
            };
            if side_by_side {
                Arch::new().dispatch(walk);
            } else {
                walk.with_simd(Scalar);
            }
            (written, lines, sums)
        };
        let (written, lines, sums) = walked(true);
        assert_eq!(walked(false), (written.clone(), lines.clone(), sums));
        let mut expected = 0.0;
        for i in 0..points {
            let in_domain = i % width < surface[0] && i / width < surface[1];
            let pull = match in_domain {
                true if read[i] < 0.5 => 2.0 * factor[i],
                true => 0.0,
                false => -1.0,
            };
            assert_eq!(written[i], 1.0 + read[i]);
            assert_eq!(lines[i], 3.0 * pull);
            expected += read[i] * pull;
        }
        let (least, most) = read
            .iter()
            .fold((f64::MAX, f64::MIN), |(a, b), &r| (a.min(r), b.max(r)));
        // The order of the additions is another one.
        assert!((sums[0] - expected).abs() <= 1e-12 * points as f64 * points as f64);
        assert_eq!([sums[1], sums[2]], [least, most]);
    }
}
