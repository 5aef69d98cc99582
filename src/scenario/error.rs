//! Errors of scenario files: which file, where in it, what was found, what is allowed.

use thiserror::Error;

use crate::files::FileError;
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
    /// The file cannot be read, or is not the JSON of a scenario.
    #[error(transparent)]
    File(#[from] FileError),
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
