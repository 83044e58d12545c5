//! One convolution: transform, multiply by the half-space's stiffness, transform back.
//!
//! `cargo bench --bench operator`. Ids are `operator/backend/points`; the throughput counts points.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use tabor::backend::{Backend, Shape, cpu::CpuBackend};
use tabor::elastic::periodic_stiffness;
use tabor::grid::Grid;
use tabor::kernel::{Gate, common};

fn operator(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("operator");
    group.sample_size(10);
    for points in [512, 1024, 2048] {
        let grid = Grid::new([points; 2], [1.0; 2]);
        let mut backend = CpuBackend::<f64>::new();
        let level = backend.level("fine", Shape::whole(points, points));
        let displacement = backend.field(level, "displacement");
        let pressure = backend.field(level, "pressure");
        let stiffness = backend.spectrum(level, "stiffness", &periodic_stiffness(&grid, 1.0, None));
        let waves: Vec<f64> = (0..grid.len()).map(|i| (0.1 * i as f64).sin()).collect();
        backend.write(displacement, &waves);
        group.throughput(Throughput::Elements(grid.len() as u64));
        group.bench_function(BenchmarkId::new("cpu", points), |bencher| {
            bencher.iter(|| {
                backend.forward(&common::LOAD_FIELD, level, &[displacement]);
                backend.multiply(stiffness, false, Gate::Always);
                backend.backward(&common::STORE_PRESSURE, level, &[pressure]);
                // Waits: a backend that records must run what it recorded.
                black_box(backend.scalars().expect("the processor does not fail"))
            });
        });
    }
    group.finish();
}

criterion_group!(benches, operator);
criterion_main!(benches);
