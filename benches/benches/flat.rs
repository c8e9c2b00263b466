//! Throughput of the flat toss and of the parts it is made of. `cargo bench -p coinmc-bench`.

use coinmc_bench::workloads;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::time::Duration;

/// Tosses an iteration: every iteration does the same ones, and enough of them that the mixture
/// of short and long tosses is that of a run.
const BATCH: u64 = 1000;

fn flat(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("flat");
    group.throughput(Throughput::Elements(BATCH));
    for work in workloads() {
        group.bench_function(&work.name, |bencher| bencher.iter(|| work.run(0..BATCH)));
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(3))
        .sample_size(50);
    targets = flat
}
criterion_main!(benches);
