//! From a scenario to the code compiled for its world.

use thiserror::Error;

use crate::evolution::{Experiment, ExperimentError};
use crate::scenario::{Scenario, WorldModel};
use crate::worlds::cliff::{CliffError, CliffWorld};
use crate::worlds::foraging::{ForagingError, ForagingWorld};
use crate::worlds::scene::Scenic;
use crate::worlds::taxi::{TaxiError, TaxiWorld};

/// Something to be done with the experiment of a scenario, whatever its world.
pub trait WorldTask {
    /// What comes of it.
    type Output;

    /// Does it. This is compiled once for each world.
    fn carry_out<W: Scenic + 'static>(self, experiment: Experiment<W>) -> Self::Output;
}

/// Why a scenario cannot be made ready.
#[derive(Debug, Error)]
pub enum SetupError {
    /// Its foraging world cannot be built.
    #[error(transparent)]
    Foraging(#[from] ForagingError),
    /// Its taxi world cannot be built.
    #[error(transparent)]
    Taxi(#[from] TaxiError),
    /// Its cliff world cannot be built.
    #[error(transparent)]
    Cliff(#[from] CliffError),
    /// Its first hierarchies cannot be used.
    #[error(transparent)]
    Experiment(#[from] ExperimentError),
}

/// Makes `scenario` ready and carries out `task` with it.
///
/// # Errors
/// When the scenario's world or its hierarchies cannot be built.
pub fn with_world<T: WorldTask>(scenario: Scenario, task: T) -> Result<T::Output, SetupError> {
    match &scenario.world {
        WorldModel::Foraging(model) => {
            let world = ForagingWorld::new(model)?;
            Ok(task.carry_out(Experiment::new(scenario, world)?))
        }
        WorldModel::Taxi(model) => {
            let world = TaxiWorld::new(model)?;
            Ok(task.carry_out(Experiment::new(scenario, world)?))
        }
        WorldModel::Cliff(model) => {
            let world = CliffWorld::new(model)?;
            Ok(task.carry_out(Experiment::new(scenario, world)?))
        }
    }
}
