//! What the machine's arithmetic can do at best: the bound that the speed of a control step
//! is held against.
//!
//! Vectors of 8 single-precision numbers, as the kernels use them, are multiplied and added
//! in chains that do not wait for each other, without memory. Nothing that computes with
//! such vectors does more operations a second on this processor.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pulp::{Arch, Simd, WithSimd};

/// Chains of each kind: enough to hide the latency of an operation, few enough for registers.
const CHAINS: usize = 6;
const ROUNDS: usize = 10_000;

struct Chains {
    factor: f32,
    summand: f32,
}

impl WithSimd for Chains {
    type Output = f32;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f32 {
        let factor = simd.splat_f32s(self.factor);
        let summand = simd.splat_f32s(self.summand);
        let mut products = [simd.splat_f32s(1.0); CHAINS];
        let mut sums = [simd.splat_f32s(0.0); CHAINS];
        for _ in 0..ROUNDS {
            for (product, sum) in products.iter_mut().zip(&mut sums) {
                *product = simd.mul_f32s(*product, factor);
                *sum = simd.add_f32s(*sum, summand);
            }
        }
        let chains = products.into_iter().chain(sums);
        chains.map(|chain| simd.reduce_sum_f32s(chain)).sum()
    }
}

fn peak(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("the machine's peak");
    group.throughput(Throughput::Elements((2 * CHAINS * ROUNDS) as u64));
    group.bench_function("vector operations", |bencher| {
        bencher.iter(|| {
            let (factor, summand) = (black_box(0.999_999), black_box(0.001));
            black_box(Arch::new().dispatch(Chains { factor, summand }))
        });
    });
    group.finish();
}

criterion_group!(benches, peak);
criterion_main!(benches);
