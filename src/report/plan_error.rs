//! What can be wrong with a plan.

use thiserror::Error;

use super::arm::ArmError;
use crate::files::FileError;
use crate::scenario::ScenarioError;

/// Why a plan cannot be used.
#[derive(Debug, Error)]
pub enum PlanError {
    /// There is no such plan.
    #[error("no plan {name:?}: there is no such file, and the built-in plans are {allowed}")]
    NotFound {
        /// The name asked for.
        name: String,
        /// The names there are.
        allowed: String,
    },
    /// The file cannot be read, or is not the JSON of a plan.
    #[error(transparent)]
    File(#[from] FileError),
    /// It says what cannot be.
    #[error("{file}: at {place}: {message}")]
    Invalid {
        /// The file, or what the plan was made from.
        file: String,
        /// Where in it.
        place: String,
        /// What was found and what is allowed.
        message: String,
    },
    /// A scenario of the plan cannot be used.
    #[error("{file}: at scenarios[{index}]: {source}")]
    Scenario {
        /// The file, or what the plan was made from.
        file: String,
        /// Which scenario, from 0.
        index: usize,
        /// Why.
        source: Box<ScenarioError>,
    },
    /// An arm of the plan does not fit a scenario.
    #[error("{file}: arm {arm} of scenario {scenario}: {source}")]
    Arm {
        /// The file, or what the plan was made from.
        file: String,
        /// Name of the arm.
        arm: String,
        /// Name of the scenario.
        scenario: String,
        /// Why.
        source: Box<ArmError>,
    },
}
