//! The surroundings of an agent: a scenario, its world and a trained primitive set.

use maxq_lab::evolution::{Experiment, Workers};
use maxq_lab::hierarchy::parse;
use maxq_lab::learning::{Agent, Gate, Hierarchy, PrimitiveSet};
use maxq_lab::scenario::Scenario;
use maxq_lab::worlds::WorldSettings;
use maxq_lab::worlds::foraging::ForagingSettings;
use maxq_lab::worlds::foraging::ForagingWorld;

use super::Recorder;

/// The longest trial, in time steps.
pub const STEP_LIMIT: u32 = 20_000;

/// A scenario with its world, and a primitive set trained for a short time.
pub struct Lab {
    /// The scenario and its world.
    pub experiment: Experiment<ForagingWorld>,
    model: ForagingSettings,
    /// The primitive set.
    pub primitives: PrimitiveSet,
}

impl Lab {
    /// Loads a scenario with these settings.
    pub fn new(scenario: &str, settings: &[&str]) -> Self {
        let primitives = [
            "avoid",
            "wander",
            "approach_battery",
            "approach_nest",
            "turn",
        ];
        let training = primitives
            .map(|p| format!("world.foraging.primitive_training.{p}.steps=10000"))
            .into_iter();
        let settings = settings.iter().map(|&setting| setting.to_owned());
        let settings: Vec<_> = training.chain(settings).collect();
        let scenario = Scenario::load(scenario).unwrap();
        let scenario = scenario.with_settings(&settings).unwrap();
        let WorldSettings::Foraging(model) = scenario.world.clone() else {
            panic!("a foraging scenario")
        };
        let world = ForagingWorld::new(&model).unwrap();
        let experiment = Experiment::new(scenario, world).unwrap();
        let workers = Workers::new(1).unwrap();
        let primitives = experiment.train(1, 0, &workers, &Gate::default()).unwrap();
        Self {
            experiment,
            model: *model,
            primitives,
        }
    }

    /// A hierarchy that has learned nothing.
    pub fn untrained(&self, tree: &str) -> Hierarchy {
        let tree = parse(tree, self.experiment.catalogue()).unwrap();
        self.experiment.untrained(tree)
    }

    /// An agent with the given hierarchy.
    pub fn agent(&self, hierarchy: Hierarchy) -> Agent<'_, ForagingWorld> {
        Agent::new(
            &self.experiment.world,
            &self.experiment.encoder,
            &self.experiment.scenario.learning,
            hierarchy,
            self.primitives.clone(),
            STEP_LIMIT,
        )
    }

    /// A recorder of an agent's events.
    pub fn recorder(&self) -> Recorder<'_> {
        Recorder {
            world: &self.experiment.world,
            features: self.model.features.clone(),
            events: Vec::new(),
        }
    }
}
