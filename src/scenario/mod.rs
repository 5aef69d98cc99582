//! What an experiment is: the JSON model of a scenario, its defaults and its rules.
//!
//! A scenario file names a world, the settings of learning and the settings of
//! evolution. Whatever it leaves out has a default with a source ([`defaults`]);
//! whatever it says that does not exist or cannot be is an error that names the
//! file, the place, the value found and the values allowed.

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::files::{FileError, parse_json, read_text, stated_format};
use crate::rules::Problem;
use crate::worlds::WorldSettings;

pub mod defaults;
mod embedded;
mod error;
mod overrides;
mod rules;
mod settings;

pub use embedded::{EMBEDDED, EMBEDDED_PLANS, Embedded};
pub use error::ScenarioError;
pub use settings::{
    CompletionBootstrap, CompositeChoice, CoolOn, EvolutionSettings, Inheritance, LearningSettings,
    PrimitiveLearning, PseudoReward, Selection, Variation,
};

/// The version of the scenario format that this program reads.
pub const FORMAT: u32 = 1;

/// Largest scenario file that is read, in bytes; the shipped ones are a hundredth of it.
pub const MAX_FILE_BYTES: u64 = 1 << 20;

/// A whole experiment: a world, how its agents learn, how their hierarchies evolve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "maxq-lab scenario")]
pub struct Scenario {
    /// Version of this format; 1.
    pub format: u32,
    /// Short name, used in run folders: lower-case letters, digits, `-`, `_` and `.`.
    pub name: String,
    /// What the scenario is for, in a sentence.
    #[serde(default)]
    pub description: String,
    /// Where the agent acts.
    pub world: WorldSettings,
    /// How it learns.
    #[serde(default)]
    pub learning: LearningSettings,
    /// How hierarchies evolve.
    pub evolution: EvolutionSettings,
}

impl Scenario {
    /// Reads a scenario by `name`: a file where there is one, else an embedded scenario.
    ///
    /// # Errors
    /// When neither exists, or the file cannot be read, is too large, is not JSON of
    /// this model, or breaks a rule.
    pub fn load(name: &str) -> Result<Self, ScenarioError> {
        let path = Path::new(name);
        if path.is_file() {
            return Self::read(path);
        }
        match EMBEDDED.iter().find(|embedded| embedded.name == name) {
            Some(embedded) => Self::parse(embedded.json, embedded.name),
            // Not a regular file: a pipe can be read, a folder says why not.
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
        Self::parse(&read_text(path, MAX_FILE_BYTES)?, &file)
    }

    /// Parses and checks scenario `text`; `file` names it in errors.
    ///
    /// # Errors
    /// When the text is not JSON of this model or breaks a rule.
    pub fn parse(text: &str, file: &str) -> Result<Self, ScenarioError> {
        if let Some(format) = stated_format(text).filter(|&format| format != FORMAT) {
            return Err(ScenarioError::Invalid {
                file: file.to_owned(),
                problems: vec![Problem::new("format", format, FORMAT)],
            });
        }
        let parsed: Self = parse_json(text).map_err(|error| FileError::new(file, error))?;
        parsed.checked(file)
    }

    /// This scenario with `key=value` settings applied in order.
    ///
    /// A key is a dotted path as `maxq-lab check --format json` prints it, such as
    /// `learning.discount` or `world.foraging.arena.batteries_mm.0`; a value is JSON,
    /// or else taken as a string.
    ///
    /// # Errors
    /// When a setting is malformed, names no existing key, or breaks a rule.
    pub fn with_settings(self, settings: &[String]) -> Result<Self, ScenarioError> {
        if settings.is_empty() {
            return Ok(self);
        }
        overrides::apply(&self, settings)?.checked("--set")
    }

    /// This scenario if it obeys every rule; `file` names it in errors.
    ///
    /// # Errors
    /// With all rules that are broken.
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

    /// The JSON Schema of scenario files.
    #[must_use]
    pub fn schema() -> schemars::Schema {
        schemars::schema_for!(Scenario)
    }
}
