//! Throughput of the tosses of both event-driven engines, and of the parts a toss consists of.
//! `cargo bench -p coinmc-bench`.

use coinmc_bench::{Workload, space_workloads, workloads};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::time::Duration;

/// Tosses per iteration: every iteration makes the same ones, enough for a run's mixture of short
/// and long tosses.
const BATCH: u64 = 1000;

fn throughput(criterion: &mut Criterion, name: &str, works: &[Workload]) {
    let mut group = criterion.benchmark_group(name);
    group.throughput(Throughput::Elements(BATCH));
    for work in works {
        group.bench_function(&work.name, |bencher| bencher.iter(|| work.run(0..BATCH)));
    }
    group.finish();
}

fn flat(criterion: &mut Criterion) {
    throughput(criterion, "flat", &workloads());
}

fn space(criterion: &mut Criterion) {
    throughput(criterion, "space", &space_workloads());
}

fn settings(measurement: Duration, samples: usize) -> Criterion {
    Criterion::default()
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(measurement)
        .sample_size(samples)
}

criterion_group! {
    name = flat_tosses;
    config = settings(Duration::from_secs(3), 50);
    targets = flat
}
criterion_group! {
    name = space_tosses;
    config = settings(Duration::from_secs(5), 30);
    targets = space
}
criterion_main!(flat_tosses, space_tosses);
