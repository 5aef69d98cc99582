//! A plan: which scenarios, arms and seeds a study has.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::arm::{Arm, Base};
use super::numbers::Numbers;
use super::plan_error::PlanError;
use crate::files::{FileError, parse_json, read_text, stated_format};
use crate::scenario::{EMBEDDED_PLANS, Scenario, ScenarioError};

/// Version of the plan format.
pub const PLAN_FORMAT: u32 = 1;

/// The plan in the folder of a study.
pub(super) const PLAN_FILE: &str = "study.json";

/// Largest plan that is read, in bytes; a plan may hold many scenarios.
pub const MAX_PLAN_BYTES: u64 = 1 << 24;

/// A plan with its scenarios written out. `study.json` is one, and can be used as a plan
/// file again.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// Version of this format; 1.
    pub format: u32,
    /// Short name, of the letters that scenario names are made of.
    pub name: String,
    /// What the study is for, in a sentence.
    pub description: String,
    /// The scenarios, each with a name of its own.
    pub scenarios: Vec<Scenario>,
    /// The seeds.
    pub seeds: Numbers,
    /// The arms, each with a name of its own.
    pub arms: Vec<Arm>,
    /// Name of the arm that every claim is held against, if there is one.
    pub control: Option<String>,
    /// How winners are evaluated anew.
    pub reevaluation: Reevaluation,
}

/// How the winner of a run is evaluated anew: fresh hierarchies of its structure, fresh
/// trials, freshly trained sets of primitive subtasks, by seeds that no run uses and that
/// all arms share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Reevaluation {
    /// Trials of each repeat before scoring starts.
    #[schemars(range(min = 0, max = 10_000))]
    pub warmup: usize,
    /// Scored trials of each repeat.
    #[schemars(range(min = 1, max = 10_000))]
    pub trials: usize,
    /// Fresh hierarchies.
    #[schemars(range(min = 2, max = 10_000))]
    pub repeats: usize,
    /// Freshly trained sets of primitive subtasks that the repeats are spread over.
    #[schemars(range(min = 1, max = 10_000))]
    pub banks: usize,
}

impl Default for Reevaluation {
    /// Warm-up and scored trials as in a generation of the thesis; as many repeats as make
    /// the standard error of one winner small against the spread between seeds.
    fn default() -> Self {
        Self {
            warmup: 8,
            trials: 8,
            repeats: 32,
            banks: 4,
        }
    }
}

impl Plan {
    /// Reads the plan by `name`: a file, or that of a study's folder, where there is one,
    /// else an embedded plan.
    ///
    /// # Errors
    /// When there is none, or it is not a plan that can be carried out.
    pub fn load(name: &str) -> Result<Self, PlanError> {
        let embedded = EMBEDDED_PLANS.iter().find(|plan| plan.name == name);
        let path = match (file_of(name), embedded) {
            (Some(path), _) => path,
            (None, Some(plan)) => return Self::parse(plan.json, plan.name, Path::new("")),
            // Not a regular file: a pipe can be read, a folder says why not.
            (None, None) if Path::new(name).exists() => PathBuf::from(name),
            (None, None) => {
                let names: Vec<_> = EMBEDDED_PLANS.iter().map(|plan| plan.name).collect();
                return Err(PlanError::NotFound {
                    name: name.to_owned(),
                    allowed: names.join(", "),
                });
            }
        };
        let file = path.display().to_string();
        let text = read_text(&path, MAX_PLAN_BYTES)?;
        Self::parse(&text, &file, path.parent().unwrap_or(Path::new("")))
    }

    /// Whether `name` is that of a plan rather than of a scenario: an embedded plan, the
    /// folder of a study, or a JSON file that has arms or scenarios, or speaks of them where
    /// it is broken.
    #[must_use]
    pub fn is_plan(name: &str) -> bool {
        let Some(path) = file_of(name) else {
            return EMBEDDED_PLANS.iter().any(|plan| plan.name == name);
        };
        if path != Path::new(name) {
            return true;
        }
        let text = read_text(&path, MAX_PLAN_BYTES).unwrap_or_default();
        // Either may be what is missing.
        let mut keys = ["arms", "scenarios"].into_iter();
        match serde_json::from_str::<Value>(&text) {
            Ok(json) => keys.any(|key| json.get(key).is_some()),
            Err(_) => keys.any(|key| text.contains(&format!("{key:?}"))),
        }
    }

    /// Parses plan `text`; `file` names it in errors, scenario files are sought in `folder`.
    ///
    /// # Errors
    /// When it is not a plan that can be carried out.
    pub fn parse(text: &str, file: &str, folder: &Path) -> Result<Self, PlanError> {
        if let Some(found) = stated_format(text).filter(|&format| format != PLAN_FORMAT) {
            return Err(PlanError::Invalid {
                file: file.to_owned(),
                place: String::from("format"),
                message: format!("found {found}; allowed: {PLAN_FORMAT}"),
            });
        }
        PlanFile::parse(text, file)?
            .write_out(file, folder)?
            .checked(file)
    }

    /// The JSON Schema of plans.
    #[must_use]
    pub fn schema() -> schemars::Schema {
        schemars::schema_for!(PlanFile)
    }

    /// A plan for scenarios given by name. The control is `random_selection` if it is
    /// among the arms.
    ///
    /// # Errors
    /// When a scenario cannot be used, or the plan cannot be carried out.
    pub fn of(scenarios: &[String], seeds: Numbers, arms: Vec<Arm>) -> Result<Self, PlanError> {
        let file = "the study";
        let loaded = scenarios.iter().enumerate().map(|(index, name)| {
            Scenario::load(name).map_err(|source| PlanError::Scenario {
                file: file.to_owned(),
                index,
                source: Box::new(source),
            })
        });
        let scenarios: Vec<_> = loaded.collect::<Result<_, _>>()?;
        let names: Vec<_> = scenarios
            .iter()
            .map(|scenario| scenario.name.as_str())
            .collect();
        // Too many names make no name.
        let name = names.join("_");
        let control = arms.iter().find(|arm| arm.base == Base::RandomSelection);
        Self {
            format: PLAN_FORMAT,
            name: Some(name)
                .filter(|name| is_name(name))
                .unwrap_or_else(|| String::from("study")),
            description: String::new(),
            control: control.map(|arm| arm.name.clone()),
            scenarios,
            seeds,
            arms,
            reevaluation: Reevaluation::default(),
        }
        .checked(file)
    }

    /// The plan as a file: the bytes of `study.json`.
    ///
    /// # Errors
    /// When serialisation fails.
    pub fn to_file(&self) -> Result<Vec<u8>, serde_json::Error> {
        let mut bytes = serde_json::to_vec_pretty(self)?;
        bytes.push(b'\n');
        Ok(bytes)
    }

    /// This plan if it can be carried out.
    fn checked(self, file: &str) -> Result<Self, PlanError> {
        let invalid = |place: &str, message: String| {
            Err(PlanError::Invalid {
                file: file.to_owned(),
                place: place.to_owned(),
                message,
            })
        };
        if !is_name(&self.name) {
            return invalid("name", format!("found {:?}; allowed: {NAMES}", self.name));
        }
        if self.scenarios.is_empty() || self.arms.is_empty() {
            return invalid(
                "scenarios, arms",
                String::from("found none; allowed: at least one"),
            );
        }
        let names: BTreeSet<_> = self
            .scenarios
            .iter()
            .map(|scenario| &scenario.name)
            .collect();
        if names.len() != self.scenarios.len() {
            return invalid(
                "scenarios",
                String::from("found two with one name; allowed: different names"),
            );
        }
        let names: BTreeSet<_> = self.arms.iter().map(|arm| arm.name.as_str()).collect();
        if names.len() != self.arms.len() {
            return invalid(
                "arms",
                String::from("found two with one name; allowed: different names"),
            );
        }
        if let Some(name) = names.iter().find(|name| !is_name(name)) {
            return invalid("arms", format!("found name {name:?}; allowed: {NAMES}"));
        }
        if let Some(control) = self
            .control
            .as_deref()
            .filter(|control| !names.contains(control))
        {
            let allowed = names.into_iter().collect::<Vec<_>>().join(", ");
            return invalid("control", format!("found {control:?}; allowed: {allowed}"));
        }
        self.check_reevaluation(file)?;
        for scenario in &self.scenarios {
            for arm in &self.arms {
                arm.apply(scenario).map_err(|source| PlanError::Arm {
                    file: file.to_owned(),
                    arm: arm.name.clone(),
                    scenario: scenario.name.clone(),
                    source: Box::new(source),
                })?;
            }
        }
        Ok(self)
    }

    fn check_reevaluation(&self, file: &str) -> Result<(), PlanError> {
        let Reevaluation {
            warmup,
            trials,
            repeats,
            banks,
        } = self.reevaluation;
        for (name, found, least) in [
            ("warmup", warmup, 0),
            ("trials", trials, 1),
            ("repeats", repeats, 2),
            ("banks", banks, 1),
        ] {
            if !(least..=10_000).contains(&found) {
                return Err(PlanError::Invalid {
                    file: file.to_owned(),
                    place: format!("reevaluation.{name}"),
                    message: format!("found {found}; allowed: {least} to 10000"),
                });
            }
        }
        Ok(())
    }
}

const NAMES: &str = "1 to 64 of a-z, 0-9, '-', '_' and '.', not starting with '.' or '-'";

fn is_name(name: &str) -> bool {
    let letter = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "-_.".contains(c);
    (1..=64).contains(&name.len()) && name.chars().all(letter) && !name.starts_with(['.', '-'])
}

/// The file that a name means, if there is one: itself, or the plan of a study's folder.
fn file_of(name: &str) -> Option<PathBuf> {
    let path = PathBuf::from(name);
    [path.join(PLAN_FILE), path]
        .into_iter()
        .find(|path| path.is_file())
}

/// A study: scenarios, arms and seeds, each scenario with each arm and seed a run.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "maxq-lab plan")]
struct PlanFile {
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
    fn parse(text: &str, file: &str) -> Result<Self, PlanError> {
        Ok(parse_json(text).map_err(|error| FileError::new(file, error))?)
    }

    /// The plan with its scenarios and arms written out; `file` names it in errors, scenario
    /// files are sought in `folder`.
    fn write_out(self, file: &str, folder: &Path) -> Result<Plan, PlanError> {
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
