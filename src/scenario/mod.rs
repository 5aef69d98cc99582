#![doc = include_str!("README.md")]

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::files::{FileError, Limits, parse_json, read_standard_input, read_text, stated_format};
use crate::rules::Problem;
use crate::worlds::WorldSettings;

pub mod defaults;
mod embedded;
mod overrides;
mod rules;
mod settings;

pub use embedded::{EMBEDDED, EMBEDDED_PLANS, Embedded, names};
pub use settings::{
    Bootstrap, CompositeChoice, CompositeReward, CoolOn, EvolutionSettings, ExitValue, Inheritance,
    LearningSettings, PrimitiveLearning, PseudoReward, Reset, Selection, Then, Variation,
};

/// The version of the scenario format that this program reads.
pub const FORMAT: u32 = 1;

/// Limits of scenario files. The built-in ones are a hundred times smaller.
pub const LIMITS: Limits = Limits {
    bytes: 1 << 20,
    depth: 16,
    values: 100_000,
};

/// The name that means standard input.
pub const STANDARD_INPUT: &str = "-";

/// One experiment: a world, how agents learn in it, and how their hierarchies evolve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "maxq-lab scenario")]
pub struct Scenario {
    /// Version of this format: 1.
    pub format: u32,
    /// Short name, used in the names of run folders: lower-case letters, digits, `-`, `_`, `.`.
    pub name: String,
    /// Purpose of the scenario, in one sentence.
    #[serde(default)]
    pub description: String,
    /// The world in which agents act.
    pub world: WorldSettings,
    /// How agents learn.
    #[serde(default)]
    pub learning: LearningSettings,
    /// How hierarchies evolve.
    pub evolution: EvolutionSettings,
}

impl Scenario {
    /// Loads the file `name` if it exists, and else the built-in scenario of that name; `-` is
    /// standard input.
    ///
    /// # Examples
    /// ```
    /// use maxq_lab::scenario::Scenario;
    ///
    /// let scenario = Scenario::load("environment-1")?;
    /// assert_eq!(scenario.evolution.population_size, 16);
    ///
    /// let settings = [String::from("learning.discount=0.95")];
    /// let scenario = scenario.with_settings(&settings)?;
    /// assert_eq!(scenario.learning.discount, 0.95);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When neither exists, or the file cannot be read, is too large, is not a scenario, or
    /// breaks a rule.
    pub fn load(name: &str) -> Result<Self, ScenarioError> {
        let path = Path::new(name);
        if name == STANDARD_INPUT {
            return Self::parse(&read_standard_input(LIMITS.bytes)?, "standard input");
        }
        if path.is_file() {
            return Self::read(path);
        }
        match EMBEDDED.iter().find(|embedded| embedded.name == name) {
            Some(embedded) => Self::parse(embedded.json, embedded.name),
            // A pipe is not a regular file but can be read; reading a folder gives the error.
            None if path.exists() => Self::read(path),
            None => Err(ScenarioError::NotFound {
                name: name.to_owned(),
            }),
        }
    }

    /// Reads the scenario file at `path`.
    ///
    /// # Errors
    /// As [`Scenario::load`].
    pub fn read(path: &Path) -> Result<Self, ScenarioError> {
        let file = path.display().to_string();
        Self::parse(&read_text(path, LIMITS.bytes)?, &file)
    }

    /// Parses and checks the text of a scenario. Errors name it `file`.
    ///
    /// # Errors
    /// When the text is not a scenario or breaks a rule.
    pub fn parse(text: &str, file: &str) -> Result<Self, ScenarioError> {
        let wrong = |error| FileError::new(file, error);
        LIMITS.check(text).map_err(wrong)?;
        if let Some(format) = stated_format(text).filter(|&format| format != FORMAT) {
            return Err(ScenarioError::Invalid {
                file: file.to_owned(),
                problems: vec![Problem::new("format", format, FORMAT)],
            });
        }
        let parsed: Self = parse_json(text).map_err(wrong)?;
        parsed.checked(file)
    }

    /// Returns this scenario with `KEY=VALUE` settings applied in order.
    ///
    /// A key is a dotted path into the output of `maxq-lab check --format json`, such as
    /// `learning.discount` or `world.foraging.arena.batteries_mm.0`. A value is JSON; text that
    /// is not JSON is taken as a string.
    ///
    /// # Errors
    /// When a setting is malformed, its key does not exist, or the result breaks a rule.
    pub fn with_settings(self, settings: &[String]) -> Result<Self, ScenarioError> {
        if settings.is_empty() {
            return Ok(self);
        }
        overrides::apply(&self, settings)?.checked("--set")
    }

    /// Returns this scenario if it obeys every rule. Errors name it `file`.
    ///
    /// # Errors
    /// When rules are broken; the error holds all of them.
    pub fn checked(self, file: &str) -> Result<Self, ScenarioError> {
        let problems = rules::problems(&self);
        if problems.is_empty() {
            Ok(self)
        } else {
            Err(ScenarioError::Invalid {
                file: file.to_owned(),
                problems,
            })
        }
    }

    /// Returns the JSON Schema of scenario files.
    #[must_use]
    pub fn schema() -> schemars::Schema {
        schemars::schema_for!(Scenario)
    }
}

/// Why a scenario cannot be used.
#[derive(Debug, Error)]
pub enum ScenarioError {
    /// Neither a file nor a built-in scenario has this name.
    #[error(
        "no scenario {name:?}: there is no such file, and the built-in scenarios are {}",
        embedded::names(EMBEDDED)
    )]
    NotFound {
        /// The name that was given.
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
        /// Every broken rule; at least one.
        problems: Vec<Problem>,
    },
    /// A `--set` argument is not `KEY=VALUE`, or its key or value does not exist.
    #[error("--set {setting}: {message}")]
    Setting {
        /// The argument.
        setting: String,
        /// What was found and what is allowed.
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

#[cfg(test)]
mod tests {
    use super::Scenario;

    #[test]
    fn the_example_on_the_page_is_a_scenario() {
        let page = include_str!("README.md");
        let (_, after) = page.split_once("```json\n").unwrap();
        let (example, _) = after.split_once("```").unwrap();
        Scenario::parse(example, "README.md").unwrap();
    }
}
