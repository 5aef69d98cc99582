//! Contract: a control step asks for no memory.
//!
//! A step takes less than a microsecond, an allocation a tenth of that, and two threads that
//! allocate wait for each other. So an agent has its room from the start, or grows it in its
//! first trials, and from then on senses, chooses, acts and learns in it: in foraging, where
//! features are computed, and with tables. The same for what evolution does most besides,
//! working out selection probabilities: their number may not grow with the number of states.

#![allow(clippy::unwrap_used)]

use allocation_counter::measure;
use maxq_lab::evolution::{Experiment, Workers};
use maxq_lab::learning::{Gate, PolicySamples};
use maxq_lab::random::{Purpose, stream};
use maxq_lab::scenario::Scenario;
use maxq_lab::worlds::WorldFn;
use maxq_lab::worlds::scene::Scenic;

/// Trials in which room may grow: until one has been as long as trials can be.
const FIRST_TRIALS: usize = 60;
const TRIALS: usize = 30;
const STEP_LIMIT: u32 = 400;

/// Trials of the first hierarchy of the initial population, and of the last: allocations of
/// each in the later trials, and the steps that these took.
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
fn a_control_step_asks_for_no_memory() {
    for name in [
        "environment-1",
        "environment-2",
        "environment-3",
        "taxi",
        "cliff",
    ] {
        let scenario = Scenario::load(name).unwrap();
        for (allocations, steps) in scenario.world.clone().build(Trials(scenario)).unwrap() {
            assert!(steps > 100, "{name}: {steps} steps say nothing");
            assert_eq!(allocations, 0, "{name}, in {steps} steps");
        }
    }
}

/// Allocations that the selection probabilities in so many states of each type take.
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
fn selection_probabilities_ask_for_no_memory_a_state() {
    let count = |states| {
        let scenario = Scenario::load("environment-3").unwrap();
        let world = scenario.world.clone();
        world.build(Probabilities(scenario, states)).unwrap()
    };
    let (few, many) = (count(10), count(200));
    assert!(few > 0, "nothing was counted");
    assert_eq!(few, many);
}
