//! Contract: a control step allocates no memory.
//!
//! A step takes less than a microsecond, an allocation a tenth of that, and threads that
//! allocate wait for each other. So an agent allocates its room at the start or in its first
//! trials, and from then on senses, chooses, acts and learns without an allocation: with
//! Gaussian features in foraging, and with tables. The allocations for selection probabilities,
//! the other large part of evolution's work, must not grow with the number of states.

#![allow(clippy::unwrap_used)]

use allocation_counter::measure;
use maxq_lab::evolution::{Experiment, Workers};
use maxq_lab::learning::{Gate, PolicySamples};
use maxq_lab::random::{Purpose, stream};
use maxq_lab::scenario::Scenario;
use maxq_lab::worlds::WorldFn;
use maxq_lab::worlds::scene::Scenic;

/// Trials in which the agent may allocate: enough for one that reaches the step limit.
const FIRST_TRIALS: usize = 60;
const TRIALS: usize = 30;
const STEP_LIMIT: u32 = 400;

/// Runs trials of the first and the last hierarchy of the initial population. Returns for each
/// the allocations and the time steps of the later trials.
struct Trials(Scenario);

impl WorldFn for Trials {
    type Output = Vec<(u64, u32)>;

    fn call<W: Scenic + 'static>(self, world: W) -> Self::Output {
        let experiment = Experiment::new(self.0, world).unwrap();
        let (workers, gate) = (Workers::new(1).unwrap(), Gate::default());
        let primitives = experiment.train(1, 0, &workers, &gate).unwrap();
        let trees = &experiment.initial_population;
        let trees = [trees.first().unwrap(), trees.last().unwrap()];
        let counts = trees.map(|tree| {
            let mut agent =
                experiment.agent(experiment.untrained(tree.clone()), primitives.clone());
            let mut rng = stream(1, 0, 0, Purpose::Trials);
            let mut trial = |limit| {
                let start = experiment.world.draw_start(&mut rng);
                agent.run_trial(&start, limit, &mut rng, &gate).unwrap()
            };
            let longest = (0..FIRST_TRIALS).map(|_| trial(STEP_LIMIT).steps).max();
            let limit = longest.unwrap();
            let mut steps = 0;
            let counted = measure(|| {
                for _ in 0..TRIALS {
                    steps += trial(limit).steps;
                }
            });
            (counted.count_total, steps)
        });
        counts.to_vec()
    }
}

#[test]
fn a_control_step_allocates_no_memory() {
    for name in [
        "environment-1",
        "environment-2",
        "environment-3",
        "taxi",
        "cliff",
    ] {
        let scenario = Scenario::load(name).unwrap();
        for (allocations, steps) in scenario.world.clone().build(Trials(scenario)).unwrap() {
            assert!(steps > 100, "{name}: {steps} steps are too few");
            assert_eq!(allocations, 0, "{name}, in {steps} steps");
        }
    }
}

/// Counts the allocations for selection probabilities in this many states of each type.
struct Probabilities(Scenario, usize);

impl WorldFn for Probabilities {
    type Output = u64;

    fn call<W: Scenic + 'static>(self, world: W) -> u64 {
        let experiment = Experiment::new(self.0, world).unwrap();
        let (workers, gate) = (Workers::new(1).unwrap(), Gate::default());
        let primitives = experiment.train(1, 0, &workers, &gate).unwrap();
        let tree = experiment.initial_population.last().unwrap().clone();
        let hierarchy = experiment.untrained(tree);
        let mut rng = stream(1, 0, 0, Purpose::PolicySamples);
        let (world, encoder) = (&experiment.world, &experiment.encoder);
        let samples = PolicySamples::draw(world, self.1, &mut rng, &gate).unwrap();
        let model = &experiment.scenario.learning;
        let counted = measure(|| {
            samples
                .probabilities(world, encoder, model, &hierarchy, &primitives, &gate)
                .unwrap();
        });
        counted.count_total
    }
}

#[test]
fn allocations_for_selection_probabilities_do_not_grow_with_the_states() {
    let count = |states| {
        let scenario = Scenario::load("environment-3").unwrap();
        let world = scenario.world.clone();
        world.build(Probabilities(scenario, states)).unwrap()
    };
    let (few, many) = (count(10), count(200));
    assert!(few > 0, "nothing was counted");
    assert_eq!(few, many);
}
