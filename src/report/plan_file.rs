//! A plan as people write it: names in the place of scenarios and arms, defaults left out.

use std::path::Path;

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;

use super::arm::{Arm, Base};
use super::numbers::Numbers;
use super::plan::{Plan, Reevaluation};
use super::plan_error::PlanError;
use crate::files::parse_json;
use crate::scenario::{Scenario, ScenarioError};

/// A study: scenarios, arms and seeds, each scenario with each arm and seed a run.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "maxq-lab plan")]
pub(super) struct PlanFile {
    /// Version of this format; 1.
    #[schemars(range(min = 1, max = 1))]
    format: u32,
    /// Short name, of the letters that scenario names are made of.
    #[schemars(regex(pattern = r"^[a-z0-9_][a-z0-9_.-]{0,63}$"))]
    name: String,
    /// What the study is for, in a sentence.
    #[serde(default)]
    description: String,
    /// The scenarios, each with a name of its own.
    #[schemars(with = "Vec<ScenarioEntry>", length(min = 1))]
    scenarios: Vec<Value>,
    /// The seeds: numbers and ranges, both ends counted, separated by commas, such as `1..30`
    /// or `1,2,5..9`.
    #[schemars(
        with = "String",
        regex(pattern = r"^\s*\d+(\.\.=?\d+)?\s*(,\s*\d+(\.\.=?\d+)?\s*)*$")
    )]
    seeds: Numbers,
    /// The arms, each with a name of its own.
    #[schemars(with = "Vec<ArmEntry>", length(min = 1))]
    arms: Vec<Value>,
    /// Name of the arm that every claim is held against, if there is one.
    #[serde(default)]
    control: Option<String>,
    /// How winners are evaluated anew.
    #[serde(default)]
    reevaluation: Reevaluation,
}

/// A scenario of a plan, for the schema; reading it by hand gives errors with places.
#[derive(JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "describes what is read by hand")]
enum ScenarioEntry {
    /// The name of an embedded scenario, or a file, sought in the plan's folder first.
    Name(String),
    /// The scenario itself.
    Whole(Box<Scenario>),
}

/// An arm of a plan, for the schema; reading it by hand gives errors with places.
#[derive(JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "describes what is read by hand")]
enum ArmEntry {
    /// An arm that is nothing but its base.
    Base(Base),
    /// A base with settings.
    Whole(Arm),
}

impl PlanFile {
    /// Parses plan `text`; `file` names it in errors.
    pub(super) fn parse(text: &str, file: &str) -> Result<Self, PlanError> {
        parse_json(text).map_err(|source| PlanError::Syntax {
            file: file.to_owned(),
            source,
        })
    }

    /// The plan with its scenarios and arms written out; `file` names it in errors, scenario
    /// files are sought in `folder`.
    pub(super) fn write_out(self, file: &str, folder: &Path) -> Result<Plan, PlanError> {
        let scenarios = self.scenarios.iter().enumerate().map(|(index, value)| {
            scenario(value, folder).map_err(|source| PlanError::Scenario {
                file: file.to_owned(),
                index,
                source: Box::new(source),
            })
        });
        let scenarios = scenarios.collect::<Result<_, _>>()?;
        let arms = self.arms.into_iter().enumerate().map(|(index, value)| {
            arm(value).map_err(|message| PlanError::Invalid {
                file: file.to_owned(),
                place: format!("arms[{index}]"),
                message,
            })
        });
        Ok(Plan {
            format: self.format,
            name: self.name,
            description: self.description,
            scenarios,
            seeds: self.seeds,
            arms: arms.collect::<Result<_, _>>()?,
            control: self.control,
            reevaluation: self.reevaluation,
        })
    }
}

fn scenario(value: &Value, folder: &Path) -> Result<Scenario, ScenarioError> {
    match value {
        Value::String(name) => {
            let beside = folder.join(name);
            match beside.is_file() {
                true => Scenario::read(&beside),
                false => Scenario::load(name),
            }
        }
        whole => Scenario::parse(&whole.to_string(), "written in one line"),
    }
}

fn arm(value: Value) -> Result<Arm, String> {
    match &value {
        Value::String(name) => {
            let base = Base::find(name);
            base.map(Arm::of)
                .ok_or_else(|| format!("found {name:?}; allowed: {}, or an arm", Base::names()))
        }
        _ => serde_path_to_error::deserialize(value)
            .map_err(|error| format!("{}: {}", error.path(), error.inner())),
    }
}
