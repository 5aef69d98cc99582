//! The bench of a world.

use std::sync::OnceLock;

use super::policy_map::{MapView, PolicyMap, policy_map};
use super::profile::{Profile, profiles};
use super::rollout::{Rollout, WorldRollout};
use super::{Bench, Specimen, Start};
use crate::evolution::{EvolutionState, Experiment};
use crate::lab::checkpoint::Checkpoint;
use crate::lab::checkpoint_error::CheckpointError;
use crate::lab::worlds::{SetupError, WorldTask, with_world};
use crate::learning::{Gate, Policy, PolicySamples, SelectionProbabilities};
use crate::random::{Purpose, stream};
use crate::scenario::Scenario;
use crate::worlds::Catalogue;
use crate::worlds::scene::{Scenery, Scenic};

/// Makes a scenario ready for looking at individuals of a run with this seed.
///
/// A bench is made once for a run and stays until the process ends, so that whatever lies
/// on it can be handed around freely.
///
/// # Errors
/// When the scenario's world or its hierarchies cannot be built.
pub fn bench(scenario: Scenario, seed: u64) -> Result<&'static dyn Bench, SetupError> {
    with_world(scenario, Setup { seed })
}

struct Setup {
    seed: u64,
}

impl WorldTask for Setup {
    type Output = &'static dyn Bench;

    fn carry_out<W: Scenic + 'static>(self, experiment: Experiment<W>) -> Self::Output {
        Box::leak(Box::new(WorldBench {
            scenery: experiment.world.scenery(),
            variants: experiment.world.variants(),
            samples: OnceLock::new(),
            seed: self.seed,
            experiment,
        }))
    }
}

/// An experiment for looking.
struct WorldBench<W: Scenic> {
    experiment: Experiment<W>,
    seed: u64,
    scenery: Scenery,
    variants: Vec<String>,
    /// Drawn when first asked for.
    samples: OnceLock<PolicySamples<W::Percept>>,
}

impl<W: Scenic + 'static> WorldBench<W> {
    fn policy(&self, specimen: Specimen<'_>) -> Policy<'_> {
        let Experiment {
            scenario,
            world,
            encoder,
            ..
        } = &self.experiment;
        Policy::new(
            world.catalogue(),
            encoder,
            &scenario.learning,
            &specimen.individual.hierarchy,
            specimen.primitives,
        )
    }

    /// The very states that the run measures selection probabilities in.
    fn samples(&self) -> &PolicySamples<W::Percept> {
        self.samples.get_or_init(|| {
            let mut rng = stream(self.seed, 0, 0, Purpose::PolicySamples);
            let count = self.experiment.scenario.evolution.policy_samples;
            let world = &self.experiment.world;
            PolicySamples::draw(world, count, &mut rng, &Gate::default())
                .unwrap_or_else(|_| unreachable!("nobody stops a gate of one's own"))
        })
    }
}

impl<W: Scenic + 'static> Bench for WorldBench<W> {
    fn scenario(&self) -> &Scenario {
        &self.experiment.scenario
    }

    fn seed(&self) -> u64 {
        self.seed
    }

    fn catalogue(&self) -> &Catalogue {
        self.experiment.catalogue()
    }

    fn scenery(&self) -> &Scenery {
        &self.scenery
    }

    fn variants(&self) -> &[String] {
        &self.variants
    }

    fn rollout(
        &'static self,
        specimen: Specimen<'_>,
        number: u64,
        start: Option<Start>,
    ) -> Box<dyn Rollout> {
        let id = specimen.individual.id;
        let rng = stream(self.seed, number, id, Purpose::Watching);
        Box::new(WorldRollout::new(&self.experiment, specimen, start, rng))
    }

    fn can_begin(&self, start: Start) -> bool {
        let mut rng = stream(self.seed, 0, 0, Purpose::Watching);
        let Start {
            at,
            heading,
            variant,
        } = start;
        let world = &self.experiment.world;
        let state = world.state_at(at, heading, variant, &mut rng);
        let terminal = world.catalogue().terminal();
        state.is_some_and(|state| world.state_type(&state) != terminal)
    }

    fn profiles(&self, specimen: Specimen<'_>, node: usize) -> Vec<Profile> {
        let tree = specimen.individual.hierarchy.tree();
        profiles(
            &self.experiment.world,
            tree,
            node,
            &mut self.policy(specimen),
        )
    }

    fn policy_map(&self, specimen: Specimen<'_>, view: MapView) -> PolicyMap {
        let mut policy = self.policy(specimen);
        policy_map(&self.experiment.world, &mut policy, view, self.seed)
    }

    fn selection(&self, specimen: Specimen<'_>) -> SelectionProbabilities {
        let Experiment {
            scenario,
            world,
            encoder,
            ..
        } = &self.experiment;
        let hierarchy = &specimen.individual.hierarchy;
        let (model, gate) = (&scenario.learning, Gate::default());
        self.samples()
            .probabilities(world, encoder, model, hierarchy, specimen.primitives, &gate)
            .unwrap_or_else(|_| unreachable!("nobody stops a gate of one's own"))
    }

    fn population(&self, checkpoint: &Checkpoint) -> Result<EvolutionState, CheckpointError> {
        checkpoint.state(&self.experiment)
    }
}
