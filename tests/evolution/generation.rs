//! A generation: which trials run, which are scored, what is recorded, when evolution ends.

use std::collections::BTreeSet;
use std::sync::Mutex;

use maxq_lab::evolution::{Evolution, Experiment, GenerationRecord, Origin, Workers};
use maxq_lab::hierarchy::{parse, structural_difference};
use maxq_lab::learning::Gate;
use maxq_lab::random::Stream;
use maxq_lab::scenario::{Scenario, Selection};
use maxq_lab::worlds::TrainingSettings;
use maxq_lab::worlds::foraging::{ForagingState, ForagingWorld, INPUTS, Pose};
use maxq_lab::worlds::{Catalogue, Probe, StateType, SubtaskId, World};

use super::trees::chance;
use super::{assert_frequencies, experiment, foraging, individuals, state, step, still_scenario};

/// A trial as seen by the world: its start and its steps.
type Trial = ([u64; 3], u32);

/// The foraging world with a log of every trial.
struct Logged {
    inner: ForagingWorld,
    trials: Mutex<Vec<Trial>>,
}

impl World for Logged {
    type Start = Pose;
    type State = ForagingState;
    type Percept = [f32; INPUTS];

    fn begin(&self, start: &Pose, rng: &mut Stream) -> ForagingState {
        let place = [start.position.x, start.position.y, start.heading.x].map(f64::to_bits);
        self.trials.lock().unwrap().push((place, 0));
        self.inner.begin(start, rng)
    }
    fn step(
        &self,
        state: &mut ForagingState,
        p: SubtaskId,
        action: usize,
        rng: &mut Stream,
    ) -> f32 {
        self.trials.lock().unwrap().last_mut().unwrap().1 += 1;
        self.inner.step(state, p, action, rng)
    }

    fn catalogue(&self) -> &Catalogue {
        self.inner.catalogue()
    }
    fn draw_start(&self, rng: &mut Stream) -> Pose {
        self.inner.draw_start(rng)
    }
    fn state_type(&self, state: &ForagingState) -> StateType {
        self.inner.state_type(state)
    }
    fn percept(&self, state: &ForagingState) -> [f32; INPUTS] {
        self.inner.percept(state)
    }
    fn sample(&self, state_type: StateType, rng: &mut Stream) -> Option<[f32; INPUTS]> {
        self.inner.sample(state_type, rng)
    }
    fn probes(&self, primitive: SubtaskId) -> Vec<Probe<[f32; INPUTS]>> {
        self.inner.probes(primitive)
    }
    fn training(&self, primitive: SubtaskId) -> Option<&TrainingSettings> {
        self.inner.training(primitive)
    }
    fn begin_training(&self, primitive: SubtaskId, rng: &mut Stream) -> Option<ForagingState> {
        self.inner.begin_training(primitive, rng)
    }
    fn training_goes_on(&self, p: SubtaskId, a: &ForagingState, b: &mut ForagingState) -> bool {
        self.inner.training_goes_on(p, a, b)
    }
}

/// The starts of some trials, without their order.
fn starts(trials: &[Trial]) -> BTreeSet<[u64; 3]> {
    trials.iter().map(|trial| trial.0).collect()
}

/// A scenario with four trials in each half, long enough that some deliver.
fn learning_scenario() -> Scenario {
    let mut scenario = Scenario::load("smoke").unwrap();
    scenario.evolution.trials_per_generation = 8;
    scenario.evolution.trial_step_limit = 300;
    scenario.evolution.policy_samples = 1;
    scenario
}

#[test]
fn all_run_the_same_starts_and_only_the_scored_half_counts() {
    let scenario = learning_scenario();
    let inner = foraging(&scenario);
    let trials = Mutex::default();
    let experiment = Experiment::new(scenario, Logged { inner, trials }).unwrap();
    let mut rng = chance(1);
    let trees = experiment.scenario.evolution.initial_population.clone();
    let catalogue = experiment.catalogue();
    let first = individuals(trees.iter().map(String::as_str), catalogue, &mut rng);
    let mut now = state(first, catalogue, 0);
    let (mut before, mut orders) = (BTreeSet::new(), BTreeSet::new());
    for _ in 0..3 {
        let steps_before = now.control_steps;
        let (record, next) = step(&experiment, 1, now);
        now = next;
        let all = std::mem::take(&mut *experiment.world.trials.lock().unwrap());
        let reproduced = record
            .individuals
            .iter()
            .filter(|r| r.origin == Origin::Reproduced);
        let reproduced = reproduced.count();
        // A single thread runs the individuals one after the other, the reproduced last.
        let (new, experienced) = all.split_at(all.len() - 4 * reproduced);
        assert_eq!(new.len(), 8 * (8 - reproduced));
        let (unscored, scored) = (starts(&new[..4]), starts(&new[4..8]));
        assert_eq!((unscored.len(), scored.len()), (4, 4));
        assert!(unscored.is_disjoint(&scored));
        for life in new.chunks(8) {
            assert_eq!(
                starts(&life[..4]),
                unscored,
                "the first half is the same for all"
            );
            assert_eq!(
                starts(&life[4..]),
                scored,
                "the scored half is the same for all"
            );
        }
        for life in experienced.chunks(4) {
            assert_eq!(
                starts(life),
                scored,
                "the reproduced run the scored half alone"
            );
        }
        // Each individual has its own order.
        let halves = all
            .chunks(4)
            .map(|half| half.iter().map(|t| t.0).collect::<Vec<_>>());
        orders.extend(halves);
        assert!(
            before.is_disjoint(&unscored) && before.is_disjoint(&scored),
            "fresh starts"
        );
        before.extend(unscored.into_iter().chain(scored));

        // Fitness: time steps over the scored trials.
        let halves: Vec<_> = new.chunks(8).map(|life| &life[4..]).collect();
        let halves = halves.into_iter().chain(experienced.chunks(4));
        let mut ran: Vec<Vec<u32>> = halves.map(|h| h.iter().map(|t| t.1).collect()).collect();
        let mut recorded: Vec<Vec<u32>> = Vec::new();
        for individual in &record.individuals {
            let steps: Vec<_> = individual.trials.iter().map(|trial| trial.steps).collect();
            assert_eq!(
                individual.fitness_steps,
                steps.iter().map(|&s| u64::from(s)).sum::<u64>()
            );
            for trial in &individual.trials {
                assert!(trial.steps == 300 || (trial.delivered && trial.steps < 300));
            }
            recorded.push(steps);
        }
        ran.sort();
        recorded.sort();
        assert_eq!(ran, recorded);
        let steps: u64 = all.iter().map(|trial| u64::from(trial.1)).sum();
        assert_eq!(record.control_steps, steps_before + steps);
        let fitness = record
            .individuals
            .iter()
            .map(|individual| individual.fitness_steps);
        assert!(fitness.is_sorted(), "the best come first");
        let ranks = record.individuals.iter().map(|individual| individual.rank);
        assert!(ranks.eq(1..=8));
    }
    // 3 generations of two halves with 24 possible orders each. One order for all
    // individuals would give 6.
    assert!(orders.len() > 20, "{} orders", orders.len());
}

/// Runs trials of two steps, in which no individual can deliver. All are equal, so they are
/// ranked in the given order.
fn ranked(trees: [&str; 8]) -> GenerationRecord {
    let experiment = experiment(still_scenario());
    let mut rng = chance(1);
    let first = individuals(trees, experiment.catalogue(), &mut rng);
    let (record, after) = step(&experiment, 1, state(first, experiment.catalogue(), 0));
    let ids = record.individuals.iter().map(|individual| individual.id);
    assert!(ids.eq(100..108));
    assert_eq!(after.converged, record.converged);
    record
}

const ONE: &str = "(Root (Capture Avoid Wander ApproachBattery) Wander ApproachNest)";
/// The same structure in another order.
const SAME: &str = "(Root ApproachNest Wander (Capture ApproachBattery Wander Avoid))";
const OTHER: &str = "(Root (Capture Avoid Wander ApproachBattery) Avoid ApproachNest)";

#[test]
fn evolution_ends_exactly_when_the_better_half_has_one_structure() {
    assert!(ranked([ONE; 8]).converged);
    assert!(ranked([ONE, SAME, SAME, ONE, OTHER, OTHER, OTHER, OTHER]).converged);
    for odd in 0..4 {
        let mut trees = [SAME; 8];
        trees[odd] = OTHER;
        assert!(!ranked(trees).converged, "rank {} differs", odd + 1);
    }
    assert!(ranked([SAME, ONE, ONE, SAME, OTHER, ONE, ONE, ONE]).converged);
}

#[test]
fn evolution_is_over_at_the_limit_or_when_it_has_converged() {
    let mut scenario = still_scenario();
    scenario.evolution.generation_limit = 2;
    let experiment = experiment(scenario);
    let catalogue = experiment.catalogue();
    let workers = Workers::new(1).unwrap();
    let is_over = |trees: [&str; 8], steps: u32| {
        let first = individuals(trees, catalogue, &mut chance(1));
        let (gate, first) = (Gate::default(), state(first, catalogue, 0));
        let mut evolution = Evolution::resume(&experiment, &workers, 1, first, &gate).unwrap();
        assert!(!evolution.is_over());
        for _ in 0..steps {
            evolution.step(&gate, |_| ()).unwrap();
        }
        evolution.is_over()
    };
    let mixed = [ONE, OTHER, ONE, OTHER, ONE, OTHER, ONE, OTHER];
    assert!(!is_over(mixed, 1));
    assert!(is_over(mixed, 2), "the limit");
    assert!(is_over([ONE; 8], 1), "converged");
}

/// Two trials of two steps; from the second generation on two individuals run one of them.
#[test]
fn evolution_is_over_with_the_generation_that_reaches_the_limit_of_control_steps() {
    let after = [1000 + 8 * 4, 1000 + 8 * 4 + 6 * 4 + 2 * 2];
    for (limit, generations) in [
        (1, 0),
        (1001, 1),
        (after[0], 1),
        (after[0] + 1, 2),
        (after[1], 2),
    ] {
        let mut scenario = still_scenario();
        scenario.evolution.stop_on_convergence = false;
        scenario.evolution.control_step_limit = Some(limit);
        let experiment = experiment(scenario);
        let first = individuals([ONE; 8], experiment.catalogue(), &mut chance(1));
        let first = state(first, experiment.catalogue(), 0);
        let (workers, gate) = (Workers::new(1).unwrap(), Gate::default());
        let evolution = Evolution::resume(&experiment, &workers, 1, first, &gate);
        let mut evolution = evolution.unwrap();
        let mut lived = 0;
        while !evolution.is_over() {
            let record = evolution.step(&gate, |_| ()).unwrap();
            assert_eq!(record.control_steps, after[lived]);
            lived += 1;
        }
        assert_eq!(lived, generations, "limit {limit}");
    }
}

#[test]
fn evolution_goes_on_after_convergence_if_the_scenario_says_so() {
    for stops in [true, false] {
        let mut scenario = still_scenario();
        scenario.evolution.stop_on_convergence = stops;
        scenario.evolution.generation_limit = 2;
        let experiment = experiment(scenario);
        let first = individuals([ONE; 8], experiment.catalogue(), &mut chance(1));
        let (record, after) = step(&experiment, 1, state(first, experiment.catalogue(), 0));
        assert_eq!((record.converged, after.converged), (stops, stops));
        assert_eq!(after.is_over(&experiment.scenario.evolution), stops);
        let (_, after) = step(&experiment, 1, after);
        assert!(after.is_over(&experiment.scenario.evolution), "the limit");
    }
}

#[test]
fn differences_are_those_to_the_best_averaged_over_the_better_half() {
    let trees = [
        "(Root Wander ApproachBattery ApproachNest)",
        "(Root Avoid ApproachBattery ApproachNest Turn)",
        "(Root (Capture Wander ApproachBattery) (Deliver Wander ApproachNest))",
        "(Root Wander ApproachBattery ApproachNest)",
        "(Root Avoid)",
        "(Root (FindBattery Wander) Wander)",
        ONE,
        OTHER,
    ];
    let record = ranked(trees);
    // 1 + 1 + 1; 4 + 4 + 2 + 2 + 3; nothing.
    let better: Vec<_> = record.individuals[..4]
        .iter()
        .map(|i| i.difference_to_best)
        .collect();
    assert_eq!(better, [0, -3, -15, 0]);
    assert_eq!(record.mean_difference, -18.0 / 3.0);
    let world = foraging(&still_scenario());
    let catalogue = world.catalogue();
    let best = parse(trees[0], catalogue).unwrap();
    for (individual, text) in record.individuals.iter().zip(trees) {
        let tree = parse(text, catalogue).unwrap();
        assert_eq!(individual.tree, text);
        let difference = structural_difference(&tree, &best, catalogue);
        assert_eq!(individual.difference_to_best, difference);
    }
}

/// The control `selection: random`: ranks do not depend on fitness.
#[test]
fn random_selection_ranks_by_chance() {
    let mut scenario = still_scenario();
    scenario.evolution.selection = Selection::Random;
    let experiment_ = experiment(scenario);
    let catalogue = experiment_.catalogue();
    let first = individuals([ONE; 8], catalogue, &mut chance(1));
    let mut ranks = [[0; 8]; 8];
    for seed in 0..800 {
        let (record, _) = step(&experiment_, seed, state(first.clone(), catalogue, 0));
        for (rank, individual) in record.individuals.iter().enumerate() {
            ranks[rank][individual.id as usize - 100] += 1;
        }
    }
    for counts in ranks {
        assert_frequencies(&counts, &[1.0 / 8.0; 8]);
    }

    // With different fitness the order is not that of fitness.
    let mut scenario = learning_scenario();
    scenario.evolution.selection = Selection::Random;
    let experiment_ = experiment(scenario);
    let trees = experiment_.scenario.evolution.initial_population.clone();
    let catalogue = experiment_.catalogue();
    let first = individuals(trees.iter().map(String::as_str), catalogue, &mut chance(2));
    let sorted = (0..4).filter(|&seed| {
        let (record, _) = step(&experiment_, seed, state(first.clone(), catalogue, 0));
        record
            .individuals
            .iter()
            .map(|individual| individual.fitness_steps)
            .is_sorted()
    });
    assert_eq!(sorted.count(), 0);
}
