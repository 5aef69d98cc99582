//! One learned control step: sense, choose through the whole hierarchy, move, learn.
//!
//! The hierarchy is the complete one of Thesis Figure 4.2, and one whose composite subtasks have
//! many children, by the thesis's method and with all options of `environment-4`. One element is
//! one step.

#![expect(
    clippy::expect_used,
    reason = "a benchmark that cannot be set up should fail"
)]

use std::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{
    BatchSize, BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main,
};
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
/// Two composite subtasks, each over its behaviours and commands.
const MANY_CHILDREN: &str = "(Root \
    (Capture Recall ApproachBattery Wander Forward Left Right SpinLeft Back) \
    (Deliver Recall ApproachNest Wander Forward Left Right SpinLeft Back))";
/// The settings of the thesis's method.
const THESIS: [&str; 9] = [
    "learning.discount=0.9",
    "learning.composite_reward=subtask",
    "learning.exit_value=pseudo_reward",
    "learning.bootstrap=greedy",
    "learning.persistence=1",
    "learning.replay=0",
    "learning.composite_temperature=null",
    "learning.temperature_decrease=0.995",
    "learning.cool_on=termination",
];
const STEPS: u32 = 20_000;

fn complete(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("learned control steps, complete hierarchy");
    for name in ["environment-1", "environment-2", "environment-3"] {
        control_steps(
            &mut group,
            name,
            &Scenario::load(name).expect("shipped"),
            COMPLETE,
        );
    }
    group.finish();
}

fn many_children(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("learned control steps, many children");
    let all = Scenario::load("environment-4").expect("shipped");
    let thesis = all.clone().with_settings(&THESIS.map(String::from));
    control_steps(&mut group, "thesis", &thesis.expect("valid"), MANY_CHILDREN);
    control_steps(&mut group, "all options", &all, MANY_CHILDREN);
    group.finish();
}

fn control_steps(
    group: &mut BenchmarkGroup<'_, WallTime>,
    name: &str,
    scenario: &Scenario,
    tree: &str,
) {
    group.throughput(Throughput::Elements(u64::from(STEPS)));
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
    let tree = parse(tree, world.catalogue()).expect("valid");
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

criterion_group!(benches, complete, many_children);
criterion_main!(benches);
