//! Throughput of the toss in space. `cargo bench -p coinmc-bench --bench space`.

use coinmc_bench::space_workloads;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::time::Duration;

/// Tosses an iteration: every iteration does the same ones, and enough of them that the mixture
/// of short and long tosses is that of a run.
const BATCH: u64 = 1000;

fn space(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("space");
    group.throughput(Throughput::Elements(BATCH));
    for work in space_workloads() {
        group.bench_function(&work.name, |bencher| bencher.iter(|| work.run(0..BATCH)));
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(5))
        .sample_size(30);
    targets = space
}
criterion_main!(benches);
