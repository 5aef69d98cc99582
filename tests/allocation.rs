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

/// Runs trials of the first and the last hierarchy of the initial population, up to a step limit.
/// Returns the allocations and the time steps of each of the later trials.
struct Trials(Scenario, u32);

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
            let longest = (0..FIRST_TRIALS).map(|_| trial(self.1).steps).max();
            let limit = longest.unwrap();
            let later = (0..TRIALS).map(|_| {
                let mut steps = 0;
                let counted = measure(|| steps = trial(limit).steps);
                (counted.count_total, steps)
            });
            later.collect::<Vec<_>>()
        });
        counts.concat()
    }
}

/// The later trials in a scenario.
fn trials(name: &str, settings: &[&str], limit: u32) -> Vec<(u64, u32)> {
    let settings: Vec<_> = settings.iter().map(|&setting| setting.to_owned()).collect();
    let scenario = Scenario::load(name).unwrap();
    let scenario = scenario.with_settings(&settings).unwrap();
    let world = scenario.world.clone();
    world.build(Trials(scenario, limit)).unwrap()
}

fn assert_no_allocation(name: &str, trials: &[(u64, u32)]) {
    let steps: u32 = trials.iter().map(|trial| trial.1).sum();
    assert!(steps > 200, "{name}: {steps} steps are too few");
    let allocations: u64 = trials.iter().map(|trial| trial.0).sum();
    assert_eq!(allocations, 0, "{name}, in {steps} steps");
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
        assert_no_allocation(name, &trials(name, &[], STEP_LIMIT));
    }
}

/// With replay an agent holds the whole trial, and keeps the room of a trial of up to 256 states:
/// 255 steps.
#[test]
fn a_control_step_allocates_no_memory_where_trials_are_repeated() {
    for name in ["environment-1-timed", "environment-4", "environment-6"] {
        assert_no_allocation(name, &trials(name, &[], 255));
    }
    let settings = ["learning.replay=1", "learning.persistence=3"];
    assert_no_allocation("taxi", &trials("taxi", &settings, 255));
}

/// The room of a longer trial is given back and grows again in the next one. It doubles each time,
/// so that a trial allocates a few dozen times however long it is.
#[test]
fn a_long_trial_that_is_repeated_allocates_a_few_dozen_times() {
    let mut long = 0;
    for (allocations, steps) in trials("environment-6", &[], 2000) {
        assert!(allocations < 100, "{allocations} in {steps} steps");
        long += usize::from(steps > 1000);
    }
    assert!(long > 3, "{long} long trials");
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
