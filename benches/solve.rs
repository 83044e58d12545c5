//! Whole solves of rough surfaces, from cold: `solve_hard` without adhesion, `solve_adhesive` with.
//!
//! `cargo bench --bench solve`. Ids are `what/backend/points`; the throughput counts points. The
//! surface: Hurst exponent 0.8, roll-off at a quarter of the side, 8 pixels across the shortest wave,
//! rms slope 1, seed 1; mean pressure 0.05 E* times the rms slope, tolerance 1e-6: in double precision
//! on the processor, in mixed on a graphics processor, where there is one (software that stands in for
//! one by its name, as in `WGPU_ADAPTER_NAME=llvmpipe`). Sizes go from 256 to 2048, or to what
//! `BENCH_POINTS` says; with adhesion to half as many points each way, from 512 on. A filter such as
//! `solve_hard/gpu` leaves the processor out, whose solves of large grids take minutes.

#[path = "shared/rough.rs"]
mod rough;

use std::cell::OnceCell;
use std::path::Path;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use tabor::backend::gpu::{AdapterChoice, GpuBackend, GpuDevice, Number};
use tabor::backend::{Backend, cpu};
use tabor::scene::Scene;
use tabor::study::{Setup, walk};
use tabor::surface::Surface;

use rough::rough;

/// Tabor number about 1, a pixel 0.1 of the cohesive zone at 512 points.
const ADHESION: &str = r#"
    [adhesion]
    law = "maugis-dugdale"
    work_of_adhesion = 2e-4
    range = 2e-3
"#;

fn setup(points: usize, adhesion: &str) -> Setup {
    let text = rough(points, "", adhesion);
    let scene = Scene::parse(&text, "bench", Path::new("."), &[]).expect("a right scene");
    let surface = Surface::build(&scene).expect("a surface of the scene");
    Setup::new(scene, surface)
}

/// Most points each way: the number in `BENCH_POINTS`, 2048 without it.
fn most() -> usize {
    std::env::var("BENCH_POINTS")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(2048)
}

/// Points each way, from 256 to `most`, at most 16384.
fn sizes(most: usize) -> impl Iterator<Item = usize> {
    (8..=14)
        .map(|power| 1usize << power)
        .filter(move |&points| points <= most)
}

fn solve(
    criterion: &mut Criterion,
    name: &str,
    sizes: impl Iterator<Item = usize>,
    adhesion: &str,
) {
    let device = GpuDevice::new(&AdapterChoice::default()).ok();
    let cpu = || cpu::double(None);
    let gpu = |device: &GpuDevice| -> Box<dyn Backend + Send> {
        Box::new(GpuBackend::on(device).corrected())
    };
    let mut group = criterion.benchmark_group(name);
    group
        .sample_size(10)
        .warm_up_time(Duration::from_millis(1))
        .measurement_time(Duration::from_secs(5));
    for points in sizes {
        // Made for what is timed alone: a filter may leave out all of a grid.
        let prepared = OnceCell::new();
        group.throughput(Throughput::Elements((points * points) as u64));
        let timed: &[Option<&GpuDevice>] = match &device {
            Some(device) if device.description().takes([points; 2], Number::Single) => {
                &[None, Some(device)]
            }
            _ => &[None],
        };
        for &place in timed {
            let name = if place.is_some() { "gpu" } else { "cpu" };
            let make_backend = || place.map_or_else(cpu, gpu);
            group.bench_function(BenchmarkId::new(name, points), |bencher| {
                let setup = prepared.get_or_init(|| setup(points, adhesion));
                bencher.iter(|| {
                    let end = walk(setup, &make_backend, &mut ()).expect("a solve");
                    assert!(end.rows[0].converged);
                    end.transforms
                });
            });
        }
    }
    group.finish();
}

fn hard(criterion: &mut Criterion) {
    solve(criterion, "solve_hard", sizes(most()), "");
}

fn adhesive(criterion: &mut Criterion) {
    let most = (most() / 2).max(512);
    solve(criterion, "solve_adhesive", sizes(most), ADHESION);
}

criterion_group!(benches, hard, adhesive);
criterion_main!(benches);
