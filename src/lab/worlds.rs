//! From a scenario to the code compiled for its world.

use thiserror::Error;

use crate::evolution::{Experiment, ExperimentError};
use crate::rules::Problem;
use crate::scenario::Scenario;
use crate::worlds::Visitor;
use crate::worlds::scene::Scenic;

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
    /// Its world cannot be built.
    #[error("{0}")]
    World(Problem),
    /// Its first hierarchies cannot be used.
    #[error(transparent)]
    Experiment(#[from] ExperimentError),
}

/// Makes `scenario` ready and carries out `task` with it.
///
/// # Errors
/// When the scenario's world or its hierarchies cannot be built.
pub fn with_world<T: WorldTask>(scenario: Scenario, task: T) -> Result<T::Output, SetupError> {
    let settings = scenario.world.clone();
    settings
        .visit(Setup { scenario, task })
        .map_err(|problem| SetupError::World(problem.within("world")))?
}

/// Makes an experiment of the world that it visits.
struct Setup<T> {
    scenario: Scenario,
    task: T,
}

impl<T: WorldTask> Visitor for Setup<T> {
    type Output = Result<T::Output, SetupError>;

    fn visit<W: Scenic + 'static>(self, world: W) -> Self::Output {
        let experiment = Experiment::new(self.scenario, world)?;
        Ok(self.task.carry_out(experiment))
    }
}
