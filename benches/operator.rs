//! One convolution: transform, multiply by the half-space's stiffness, transform back.
//!
//! `cargo bench --bench operator`. Ids are `operator/backend/points`; the throughput counts points. A
//! graphics processor is timed where there is one; software that stands in for one by its name, as in
//! `WGPU_ADAPTER_NAME=llvmpipe`. Sizes go from 256 to 2048, or to what `BENCH_POINTS` says.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use tabor::backend::gpu::{AdapterChoice, GpuBackend, GpuDevice, Number};
use tabor::backend::{Backend, Factors, Response, Shape, cpu};
use tabor::elastic::HalfSpace;
use tabor::grid::Grid;
use tabor::kernel::{Gate, displacement};

/// Points each way, from 256 to 16384, up to the number in `BENCH_POINTS` (2048 without it).
fn sizes() -> impl Iterator<Item = usize> {
    let most = std::env::var("BENCH_POINTS")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(2048);
    (8..=14)
        .map(|power| 1usize << power)
        .filter(move |&points| points <= most)
}

fn operator(criterion: &mut Criterion) {
    let device = GpuDevice::new(&AdapterChoice::default()).ok();
    let mut group = criterion.benchmark_group("operator");
    group.sample_size(10);
    for points in sizes() {
        let grid = Grid::new([points; 2], [1.0; 2]);
        group.throughput(Throughput::Elements(grid.len() as u64));
        let cpu: Box<dyn Backend> = cpu::double(None);
        let gpu = device
            .as_ref()
            .filter(|device| device.description().takes([points; 2], Number::Single))
            .map(GpuBackend::on);
        let gpu = gpu.map(|backend| ("gpu", Box::new(backend) as Box<dyn Backend>));
        for (name, mut backend) in std::iter::once(("cpu", cpu)).chain(gpu) {
            let level = backend.level("fine", Shape::whole(points, points));
            let displacement = backend.field(level, "displacement");
            let pressure = backend.field(level, "pressure");
            let half_space = Factors::HalfSpace(HalfSpace::new(grid, 1.0), Response::Stiffness);
            let stiffness = backend.spectrum(level, "stiffness", half_space);
            let waves: Vec<f64> = (0..grid.len()).map(|i| (0.1 * i as f64).sin()).collect();
            backend.write(displacement, &waves);
            group.bench_function(BenchmarkId::new(name, points), |bencher| {
                bencher.iter(|| {
                    backend.run(&displacement::LOAD_FIELD, level, &[displacement]);
                    backend.multiply(stiffness, false, Gate::Always);
                    backend.run(&displacement::STORE_FIELD, level, &[pressure]);
                    // Waits: a backend that records must run what it recorded.
                    black_box(backend.scalars().expect("no backend fails here"))
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, operator);
criterion_main!(benches);
