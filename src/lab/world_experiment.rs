//! From a scenario to the code compiled for its world.

use std::sync::OnceLock;

use super::evaluate::{Protocol, Scored, evaluate};
use super::experiment::AnyExperiment;
use super::inspection::{
    InspectedIndividual, MapView, PolicyMap, Profile, Rollout, Start, WorldRollout,
    nothing_learned, policy_map, profiles,
};
use super::learn::{LearnError, LearnProtocol, Learned, learn};
use super::learner::Algorithm;
use super::outcome::Outcome;
use super::run_error::{RunError, SetupError};
use super::value_grid::{ValueGrid, value_grids};
use super::work::Work;
use crate::evolution::{Evolution, EvolutionState, Experiment, Workers};
use crate::hierarchy::Tree;
use crate::learning::{
    CompositeValues, Encoder, Gate, Policy, PolicySamples, PrimitiveSet, SelectionProbabilities,
    Stopped,
};
use crate::random::{Purpose, stream};
use crate::rules::Problem;
use crate::scenario::{PrimitiveLearning, Scenario};
use crate::worlds::scene::{Scenery, Scenic};
use crate::worlds::{Catalogue, Probe, SubtaskId, WorldFn};

/// Makes `scenario` ready, whichever its world. A caller that only reads subtasks and hierarchies
/// may pass any seed.
///
/// # Errors
/// When the scenario's world or its hierarchies cannot be built.
pub fn experiment(scenario: Scenario, seed: u64) -> Result<Box<dyn AnyExperiment>, SetupError> {
    let settings = scenario.world.clone();
    settings
        .build(Ready { scenario, seed })
        .map_err(|problem| SetupError::World(problem.within("world")))?
}

/// Makes `scenario` ready; the experiment is never freed.
///
/// Rollouts borrow from their experiment, and a dashboard passes both around freely. It opens few
/// runs, so what stays in memory is small.
///
/// # Errors
/// When the scenario's world or its hierarchies cannot be built.
pub fn lasting_experiment(
    scenario: Scenario,
    seed: u64,
) -> Result<&'static dyn AnyExperiment, SetupError> {
    experiment(scenario, seed).map(|experiment| &*Box::leak(experiment))
}

/// Hides the type of the world of an experiment. The dashboard and other callers that take an
/// [`AnyExperiment`] then work with a world that the program does not know.
pub fn any_experiment<W: Scenic + 'static>(
    experiment: Experiment<W>,
    seed: u64,
) -> Box<dyn AnyExperiment> {
    Box::new(WorldExperiment {
        scenery: experiment.world.scenery(),
        variants: experiment.world.variants(),
        samples: OnceLock::new(),
        seed,
        experiment,
    })
}

/// Bytes of a learned number in a saved state, on average. The primitive subtasks and all else in
/// it take a few hundredths of the whole.
const NUMBER_BYTES: u64 = 11;

struct Ready {
    scenario: Scenario,
    seed: u64,
}

impl WorldFn for Ready {
    type Output = Result<Box<dyn AnyExperiment>, SetupError>;

    fn call<W: Scenic + 'static>(self, world: W) -> Self::Output {
        let experiment = Experiment::new(self.scenario, world)?;
        Ok(any_experiment(experiment, self.seed))
    }
}

struct WorldExperiment<W: Scenic> {
    experiment: Experiment<W>,
    seed: u64,
    scenery: Scenery,
    variants: Vec<String>,
    /// The states that the run measures selection probabilities in, drawn when first used.
    samples: OnceLock<PolicySamples<W::Percept>>,
}

impl<W: Scenic + 'static> WorldExperiment<W> {
    fn policy<'p>(&'p self, individual: InspectedIndividual<'p>) -> Policy<'p> {
        Policy::new(
            self.experiment.catalogue(),
            &self.experiment.encoder,
            &self.experiment.scenario.learning,
            &individual.individual.hierarchy,
            individual.primitives,
        )
    }

    fn samples(&self) -> Result<&PolicySamples<W::Percept>, Stopped> {
        if let Some(samples) = self.samples.get() {
            return Ok(samples);
        }
        let mut rng = stream(self.seed, 0, 0, Purpose::PolicySamples);
        let count = self.experiment.scenario.evolution.policy_samples;
        let world = &self.experiment.world;
        let samples = PolicySamples::draw(world, count, &mut rng, &Gate::default())?;
        Ok(self.samples.get_or_init(|| samples))
    }
}

impl<W: Scenic + 'static> AnyExperiment for WorldExperiment<W> {
    fn scenario(&self) -> &Scenario {
        &self.experiment.scenario
    }

    fn warnings(&self) -> Vec<Problem> {
        let name = self.scenario().world.name();
        let warnings = self.experiment.world.warnings().iter().cloned();
        warnings
            .map(|warning| warning.within(name).within("world"))
            .collect()
    }

    fn seed(&self) -> u64 {
        self.seed
    }

    fn state_bytes(&self) -> u64 {
        let of_tree = |tree: &Tree| {
            let hierarchy = self.experiment.untrained(tree.clone());
            let composites = hierarchy.values().iter().flatten();
            let vectors = composites.flat_map(CompositeValues::vectors).flatten();
            vectors.map(|vector| vector.len()).sum::<usize>()
        };
        let numbers: usize = self.experiment.initial_population.iter().map(of_tree).sum();
        numbers as u64 * NUMBER_BYTES
    }

    fn catalogue(&self) -> &Catalogue {
        self.experiment.catalogue()
    }

    fn encoder(&self) -> &Encoder {
        &self.experiment.encoder
    }

    fn hand_made(&self) -> Option<&str> {
        self.experiment.world.hand_made()
    }

    fn is_finite(&self) -> bool {
        self.experiment.world.mdp().is_some()
    }

    fn probes(&self, primitive: SubtaskId) -> Vec<Probe<Vec<f32>>> {
        let probes = self.experiment.world.probes(primitive).into_iter();
        probes
            .map(|probe| Probe {
                label: probe.label,
                readings: probe.readings,
                percept: probe.percept.as_ref().to_vec(),
            })
            .collect()
    }

    fn nothing_learned(&self, subtask: SubtaskId) -> Option<String> {
        let Experiment {
            world, scenario, ..
        } = &self.experiment;
        if world.catalogue().subtask(subtask).is_composite() {
            return None;
        }
        let frozen = scenario.learning.primitive_learning == PrimitiveLearning::Frozen;
        let learns = world.training(subtask).is_some() || !frozen;
        nothing_learned(world.catalogue(), subtask, learns)
    }

    fn train(&self, set: u64, workers: &Workers, gate: &Gate) -> Result<PrimitiveSet, Stopped> {
        self.experiment.train(self.seed, set, workers, gate)
    }

    fn evolve(&self, workers: &Workers, gate: &Gate) -> Result<EvolutionState, Stopped> {
        let mut evolution = Evolution::begin(&self.experiment, workers, self.seed, gate)?;
        while !evolution.is_over() {
            evolution.step(gate, |_| {})?;
        }
        Ok(EvolutionState::clone(evolution.state()))
    }

    fn evaluate(
        &self,
        tree: &Tree,
        protocol: &Protocol,
        workers: &Workers,
        gate: &Gate,
        progress: &(dyn Fn(usize) + Sync),
    ) -> Result<Scored, Stopped> {
        evaluate(
            &self.experiment,
            self.seed,
            tree,
            protocol,
            workers,
            gate,
            progress,
        )
    }

    fn learn(
        &self,
        algorithm: &Algorithm,
        protocol: &LearnProtocol,
        workers: &Workers,
        gate: &Gate,
        progress: &(dyn Fn(usize) + Sync),
    ) -> Result<Learned, LearnError> {
        learn(
            &self.experiment,
            self.seed,
            algorithm,
            protocol,
            workers,
            gate,
            progress,
        )
    }

    fn value_grids(&self, learned: &Learned) -> Vec<ValueGrid> {
        value_grids(&self.experiment.world, learned)
    }

    fn scenery(&self) -> &Scenery {
        &self.scenery
    }

    fn variants(&self) -> &[String] {
        &self.variants
    }

    fn can_begin(&self, start: Start) -> bool {
        let mut rng = stream(self.seed, 0, 0, Purpose::Watching);
        let world = &self.experiment.world;
        let state = world.state_at(start.at, start.heading, start.variant, &mut rng);
        let terminal = world.catalogue().terminal();
        state.is_some_and(|state| world.state_type(&state) != terminal)
    }

    fn rollout(
        &'static self,
        individual: InspectedIndividual<'_>,
        number: u64,
        start: Option<Start>,
    ) -> Box<dyn Rollout> {
        let id = individual.individual.id;
        let rng = stream(self.seed, number, id, Purpose::Watching);
        Box::new(WorldRollout::new(&self.experiment, individual, start, rng))
    }

    fn profiles(&self, individual: InspectedIndividual<'_>, node: usize) -> Vec<Profile> {
        let tree = individual.individual.hierarchy.tree();
        let subtask = tree.nodes().get(node).map(|node| node.subtask);
        if subtask.is_some_and(|subtask| self.nothing_learned(subtask).is_some()) {
            return Vec::new();
        }
        let policy = &mut self.policy(individual);
        profiles(&self.experiment.world, tree, node, policy)
    }

    fn policy_map(&self, individual: InspectedIndividual<'_>, view: MapView) -> PolicyMap {
        let policy = &mut self.policy(individual);
        policy_map(&self.experiment.world, policy, view, self.seed)
    }

    fn selection(&self, individual: InspectedIndividual<'_>) -> SelectionProbabilities {
        let Experiment {
            scenario,
            world,
            encoder,
            ..
        } = &self.experiment;
        let hierarchy = &individual.individual.hierarchy;
        let (learning, gate) = (&scenario.learning, Gate::default());
        let probabilities = self.samples().and_then(|samples| {
            samples.probabilities(
                world,
                encoder,
                learning,
                hierarchy,
                individual.primitives,
                &gate,
            )
        });
        // Only a stopped gate is an error, and nothing stops this one.
        probabilities.unwrap_or_default()
    }

    fn run(&self, work: Work) -> Result<Outcome, RunError> {
        work.run(&self.experiment, self.seed)
    }
}
