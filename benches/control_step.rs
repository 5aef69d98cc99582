//! One learned control step: sense, choose through the whole hierarchy, move, learn.
//!
//! The hierarchy is the complete one of Thesis Figure 4.2. One element is one step.

#![expect(
    clippy::expect_used,
    reason = "a benchmark that cannot be set up should fail"
)]

use std::hint::black_box;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use maxq_lab::hierarchy::parse;
use maxq_lab::learning::{Agent, Encoder, Gate, Hierarchy, PrimitiveSet, PrimitiveTrainer};
use maxq_lab::random::{Purpose, stream};
use maxq_lab::scenario::Scenario;
use maxq_lab::worlds::World;
use maxq_lab::worlds::WorldSettings;
use maxq_lab::worlds::foraging::ForagingWorld;

const COMPLETE: &str = "(Root (Capture (FindBattery Avoid Wander) \
    (VisibleBattery Avoid Wander ApproachBattery Turn)) (Deliver (FindNest Avoid Wander) \
    (VisibleNest Avoid Wander ApproachNest Turn)))";
const STEPS: u32 = 20_000;

fn control_step(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("learned control steps, complete hierarchy");
    group.throughput(Throughput::Elements(u64::from(STEPS)));
    for name in ["environment-1", "environment-2", "environment-3"] {
        let scenario = Scenario::load(name).expect("shipped");
        let WorldSettings::Foraging(model) = &scenario.world else {
            panic!("a foraging scenario")
        };
        let world = ForagingWorld::new(model).expect("shipped");
        let encoder = Encoder::new(world.catalogue());
        let gate = Gate::default();
        let trained = world.catalogue().primitives().map(|primitive| {
            let rng = stream(1, 0, primitive.index() as u64, Purpose::PrimitiveTraining);
            let learning = &scenario.learning;
            let mut trainer = PrimitiveTrainer::new(&world, &encoder, learning, primitive, rng);
            trainer.train(u32::MAX, &gate).expect("open");
            trainer.into_values()
        });
        let primitives = PrimitiveSet::new(trained.collect(), world.catalogue()).expect("complete");
        let tree = parse(COMPLETE, world.catalogue()).expect("valid");
        let fresh = || {
            let hierarchy = Hierarchy::new(tree.clone(), world.catalogue(), &scenario.learning);
            Agent::new(
                &world,
                &encoder,
                &scenario.learning,
                hierarchy,
                primitives.clone(),
                2000,
            )
        };
        group.bench_function(name, |bencher| {
            bencher.iter_batched_ref(
                || (fresh(), stream(1, 0, 0, Purpose::Trials)),
                |(agent, rng)| {
                    let mut left = STEPS;
                    while left > 0 {
                        let start = world.draw_start(rng);
                        let trial = agent.run_trial(&start, left.min(2000), rng, &gate);
                        left -= trial.expect("open").steps;
                    }
                    black_box(agent);
                },
                BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, control_step);
criterion_main!(benches);
