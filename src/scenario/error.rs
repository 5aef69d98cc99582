//! Errors of scenario files: which file, where in it, what was found, what is allowed.

use thiserror::Error;

use crate::files::{JsonError, ReadError};
use crate::rules::Problem;

/// Why a scenario cannot be used.
#[derive(Debug, Error)]
pub enum ScenarioError {
    /// Neither a file nor an embedded scenario has this name.
    #[error(
        "no scenario {name:?}: there is no such file, and the embedded scenarios are {}",
        super::embedded::names()
    )]
    NotFound {
        /// The name asked for.
        name: String,
    },
    /// The file cannot be read, or is larger than a scenario can be.
    #[error("{file}: {source}")]
    Read {
        /// The file.
        file: String,
        /// Why not.
        source: ReadError,
    },
    /// The text is not JSON of the scenario model.
    #[error("{file}: {source}")]
    Syntax {
        /// The file.
        file: String,
        /// Where, and why not.
        source: JsonError,
    },
    /// The scenario breaks rules.
    #[error("{file}: {}", list(.problems))]
    Invalid {
        /// The file, or `--set`.
        file: String,
        /// Every rule broken, at least one.
        problems: Vec<Problem>,
    },
    /// A `--set` argument is not `key=value`, or its key or value does not exist.
    #[error("--set {setting}: {message}")]
    Setting {
        /// The argument.
        setting: String,
        /// What is wrong, and what is allowed.
        message: String,
    },
}

fn list(problems: &[Problem]) -> String {
    match problems {
        [only] => only.to_string(),
        many => many
            .iter()
            .map(|problem| format!("\n  {problem}"))
            .collect(),
    }
}
