//! Selection probabilities (Thesis 4.5.4).

use maxq_lab::learning::{
    Agent, Encoder, Gate, Hierarchy, Observer, PolicySamples, SelectionProbabilities, average,
};
use maxq_lab::random::{Purpose, Stream, stream};
use maxq_lab::scenario::CompositeChoice;
use maxq_lab::worlds::foraging::INPUTS;
use maxq_lab::worlds::{Catalogue, StateType, SubtaskId, World};

use super::trees::{chance, valid_tree};
use super::{experiment, individuals, learned, state, step, still_scenario, untrained};

type Percept = [f32; INPUTS];

/// A world in which nothing moves, so that an agent chooses in the same state again and
/// again.
struct Frozen {
    catalogue: Catalogue,
}

impl World for Frozen {
    type Start = (StateType, Percept);
    type State = (StateType, Percept);
    type Percept = Percept;

    fn catalogue(&self) -> &Catalogue {
        &self.catalogue
    }
    fn begin(&self, start: &Self::Start, _: &mut Stream) -> Self::State {
        *start
    }
    fn step(&self, _: &mut Self::State, _: SubtaskId, _: usize, _: &mut Stream) -> f32 {
        0.0
    }
    fn state_type(&self, state: &Self::State) -> StateType {
        state.0
    }
    fn percept(&self, state: &Self::State) -> Percept {
        state.1
    }
    fn draw_start(&self, _: &mut Stream) -> Self::Start {
        unreachable!("tests say where to start")
    }
    fn sample(&self, _: StateType, _: &mut Stream) -> Option<Percept> {
        unreachable!("samples come from the real world")
    }
}

/// Records which node acted last.
struct Last(usize);

impl Observer<Frozen> for Last {
    fn acted(&mut self, node: usize, _: usize, _: f32, _: &(StateType, Percept)) {
        self.0 = node;
    }
}

const SAMPLES: usize = 20;

/// Counts how often an agent ends in each primitive subtask, in the same samples.
fn frequencies(
    experiment: &maxq_lab::evolution::Experiment<maxq_lab::worlds::foraging::ForagingWorld>,
    hierarchy: &Hierarchy,
) -> Vec<Vec<f64>> {
    const DRAWS: u32 = 500;
    let catalogue = experiment.catalogue();
    let world = Frozen {
        catalogue: catalogue.clone(),
    };
    let encoder = Encoder::new(catalogue);
    let learning = &experiment.scenario.learning;
    let primitives = untrained(catalogue);
    let mut agent = Agent::new(&world, &encoder, learning, hierarchy.clone(), primitives, 1);
    let mut samples = samples_stream();
    let mut rng = stream(9, 0, 0, Purpose::Trials);
    let primitives: Vec<_> = catalogue.primitives().collect();
    let mut of = |state_type| {
        let mut counts = vec![0.0; primitives.len()];
        for _ in 0..SAMPLES {
            let percept = experiment.world.sample(state_type, &mut samples).unwrap();
            for _ in 0..DRAWS {
                let mut last = Last(0);
                let mut trial = agent.begin(&(state_type, percept), &mut rng);
                agent.advance(&mut trial, 1, &mut rng, &mut last);
                let subtask = hierarchy.tree().subtask(last.0);
                let place = primitives.iter().position(|p| *p == subtask).unwrap();
                counts[place] += 1.0 / f64::from(DRAWS) / SAMPLES as f64;
            }
        }
        counts
    };
    catalogue.types().map(&mut of).collect()
}

fn samples_stream() -> Stream {
    stream(5, 0, 0, Purpose::PolicySamples)
}

fn probabilities(
    experiment: &maxq_lab::evolution::Experiment<maxq_lab::worlds::foraging::ForagingWorld>,
    count: usize,
    hierarchy: &Hierarchy,
) -> SelectionProbabilities {
    let (gate, world) = (Gate::default(), &experiment.world);
    let samples = PolicySamples::draw(world, count, &mut samples_stream(), &gate).unwrap();
    let learning = &experiment.scenario.learning;
    let primitives = untrained(experiment.catalogue());
    let encoder = &experiment.encoder;
    let found = samples.probabilities(world, encoder, learning, hierarchy, &primitives, &gate);
    found.unwrap()
}

#[test]
fn probabilities_are_the_frequencies_of_what_agents_do() {
    let mut experiment = experiment(still_scenario());
    for (seed, choice) in (0..)
        .zip([CompositeChoice::Softmax; 6])
        .chain([(9, CompositeChoice::Random)])
    {
        experiment.scenario.learning.composite_choice = choice;
        let catalogue = experiment.catalogue();
        let mut rng = chance(seed);
        let tree = valid_tree(&mut rng).tree(catalogue);
        let hierarchy = learned(0, tree, catalogue, &mut rng).hierarchy;
        let found = probabilities(&experiment, SAMPLES, &hierarchy);
        let frequencies = frequencies(&experiment, &hierarchy);
        assert_eq!(found.len(), 4);
        for (found, frequencies) in found.into_iter().zip(frequencies) {
            let found = found.unwrap();
            assert!((found.iter().sum::<f64>() - 1.0).abs() < 1e-6);
            for (p, frequency) in found.iter().zip(&frequencies) {
                // Five standard deviations of 10 000 draws.
                let allowed = 5.0 * (p * (1.0 - p) / 10_000.0).max(0.0).sqrt() + 1e-6;
                assert!((p - frequency).abs() < allowed, "{found:?} {frequencies:?}");
            }
        }
    }
}

#[test]
fn a_generation_reports_the_average_over_the_better_half() {
    let mut scenario = still_scenario();
    scenario.evolution.policy_samples = SAMPLES;
    let experiment = experiment(scenario);
    let catalogue = experiment.catalogue();
    let trees = experiment.scenario.evolution.initial_population.clone();
    let first = individuals(trees.iter().map(String::as_str), catalogue, &mut chance(1));
    // Nobody can deliver in two steps, so the order stays.
    let (record, _) = step(&experiment, 5, state(first.clone(), catalogue, 0));
    let better = first[..4].iter();
    let better = better.map(|i| probabilities(&experiment, SAMPLES, &i.hierarchy));
    let expected = average(&better.collect::<Vec<_>>());
    assert_eq!(record.selection_probabilities.len(), 4);
    for (row, expected) in record.selection_probabilities.iter().zip(expected) {
        let (row, expected) = (row.as_ref().unwrap(), expected.unwrap());
        assert!((row.values().sum::<f64>() - 1.0).abs() < 1e-6);
        assert_eq!(row.len(), expected.len());
        for (primitive, expected) in catalogue.primitives().zip(expected) {
            let found = row[primitive.name(catalogue)];
            assert!((found - expected).abs() < 1e-12);
        }
    }
}
