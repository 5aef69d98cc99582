//! Errors of scenario files: which file, where in it, what was found, what is allowed.

use thiserror::Error;

use crate::files::ReadError;
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
    #[error("{file}: line {line}, column {column}, at {place}: {message}")]
    Syntax {
        /// The file.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// Dotted path of the value.
        place: String,
        /// What was found and what was expected.
        message: String,
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

impl ScenarioError {
    pub(super) fn syntax(
        file: &str,
        error: &serde_path_to_error::Error<serde_json::Error>,
    ) -> Self {
        let place = match error.path().to_string().as_str() {
            // `?` is a key that could not be read.
            "." | "?" => String::from("the top level"),
            path => path.to_owned(),
        };
        Self::from_json(file, place, error.inner())
    }

    pub(super) fn trailing(file: &str, error: &serde_json::Error) -> Self {
        Self::from_json(file, String::from("the end of the scenario"), error)
    }

    fn from_json(file: &str, place: String, error: &serde_json::Error) -> Self {
        let (line, column) = (error.line(), error.column());
        let text = error.to_string();
        let suffix = format!(" at line {line} column {column}");
        Self::Syntax {
            file: file.to_owned(),
            line,
            column,
            place,
            message: text.strip_suffix(&suffix).unwrap_or(&text).to_owned(),
        }
    }
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
