//! Errors of plans.

use thiserror::Error;

use super::arm::ArmError;
use crate::files::FileError;
use crate::scenario::{EMBEDDED_PLANS, ScenarioError, names};

/// Why a plan cannot be used.
#[derive(Debug, Error)]
pub enum PlanError {
    /// Neither a file nor a built-in plan has this name.
    #[error(
        "no plan {name:?}: there is no such file, and the built-in plans are {}",
        names(EMBEDDED_PLANS)
    )]
    NotFound {
        /// The name that was given.
        name: String,
    },
    /// The file cannot be read, or is not the JSON of a plan.
    #[error(transparent)]
    File(#[from] FileError),
    /// A value of the plan is not allowed.
    #[error("{file}: at {place}: {message}")]
    Invalid {
        /// The file, or what the plan was made from.
        file: String,
        /// The place in it.
        place: String,
        /// What was found and what is allowed.
        message: String,
    },
    /// A scenario of the plan cannot be used.
    #[error("{file}: at scenarios[{index}]: {source}")]
    Scenario {
        /// The file, or what the plan was made from.
        file: String,
        /// Index of the scenario, from 0.
        index: usize,
        /// The cause.
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
        /// The cause.
        source: Box<ArmError>,
    },
}
