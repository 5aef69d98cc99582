//! What does not change while a run lasts.

use crate::evolution::Experiment;
use crate::lab::{SetupError, WorldTask, with_world};
use crate::scenario::Scenario;
use crate::worlds::Catalogue;
use crate::worlds::scene::{Scenery, Scenic};

/// What does not change while a run lasts: its scenario and its world.
#[derive(Clone, Debug)]
pub struct Setting {
    /// The scenario.
    pub scenario: Scenario,
    /// The seed of the run.
    pub seed: u64,
    /// The run folder, for people.
    pub folder: String,
    /// The subtasks of the world.
    pub catalogue: Catalogue,
    /// What there is to see of the world.
    pub scenery: Scenery,
}

impl Setting {
    /// The setting of a run.
    ///
    /// # Errors
    /// When the scenario's world cannot be built.
    pub fn new(scenario: Scenario, seed: u64, folder: String) -> Result<Self, SetupError> {
        let (catalogue, scenery) = with_world(scenario.clone(), Look)?;
        Ok(Self {
            scenario,
            seed,
            folder,
            catalogue,
            scenery,
        })
    }
}

struct Look;

impl WorldTask for Look {
    type Output = (Catalogue, Scenery);

    fn carry_out<W: Scenic + 'static>(self, experiment: Experiment<W>) -> Self::Output {
        (experiment.catalogue().clone(), experiment.world.scenery())
    }
}
