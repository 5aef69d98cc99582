//! Plans: the scenarios, arms and seeds of a study.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use super::arm::{Arm, Base};
use super::numbers::Numbers;
use super::plan_error::PlanError;
use crate::files::{FileError, JsonError, Limits, parse_json, read_text, stated_format};
use crate::rules::{NAMES, is_name};
use crate::scenario::{self, EMBEDDED_PLANS, Scenario, ScenarioError, Then};
use crate::words::quoted;

/// Version of the plan format.
pub const PLAN_FORMAT: u32 = 1;

/// The file in the folder of a study that holds its plan.
pub const PLAN_FILE: &str = "study.json";

/// Limits of plans. A plan may hold many scenarios.
pub const PLAN_LIMITS: Limits = Limits {
    bytes: 1 << 24,
    depth: scenario::LIMITS.depth + 2,
    values: 10 * scenario::LIMITS.values,
};

/// A plan with its scenarios written out. `study.json` holds one and can itself be used as a
/// plan file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// Version of this format: 1.
    pub format: u32,
    /// Short name, which follows the rules for names of scenarios.
    pub name: String,
    /// Purpose of the study, in one sentence.
    pub description: String,
    /// The scenarios, with different names.
    pub scenarios: Vec<Scenario>,
    /// The seeds.
    pub seeds: Numbers,
    /// The arms, with different names.
    pub arms: Vec<Arm>,
    /// Name of the control arm, against which claims are tested.
    pub control: Option<String>,
    /// How the winners of runs are evaluated.
    pub reevaluation: Reevaluation,
}

/// How the winner of a run is evaluated. Its structure is tested with new hierarchies, new
/// trials and newly trained sets of primitive subtasks. The seeds are ones that no run uses, and
/// they are the same in all arms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Reevaluation {
    /// Trials of each repeat that come before the scored ones.
    #[schemars(range(min = 0, max = 10_000))]
    pub warmup: usize,
    /// Scored trials of each repeat.
    #[schemars(range(min = 1, max = 10_000))]
    pub trials: usize,
    /// Repeats, each with a new hierarchy.
    #[schemars(range(min = 2, max = 10_000))]
    pub repeats: usize,
    /// Newly trained sets of primitive subtasks, over which the repeats are spread.
    #[serde(rename = "banks")]
    #[schemars(range(min = 1, max = 10_000))]
    pub primitive_sets: usize,
}

impl Default for Reevaluation {
    /// Has as many warm-up and scored trials as a generation of the thesis, and enough repeats to
    /// make the standard error of one winner small compared with the spread between seeds.
    fn default() -> Self {
        Self {
            warmup: 8,
            trials: 8,
            repeats: 32,
            primitive_sets: 4,
        }
    }
}

impl Plan {
    /// Loads the plan `name`: the file of that name, or the plan of the study in the folder of
    /// that name, or else the built-in plan of that name.
    ///
    /// # Errors
    /// When there is none, or it cannot be carried out.
    pub fn load(name: &str) -> Result<Self, PlanError> {
        let embedded = EMBEDDED_PLANS.iter().find(|plan| plan.name == name);
        let path = match (file_of(name), embedded) {
            (Some(path), _) => path,
            (None, Some(plan)) => return Self::parse(plan.json, plan.name, Path::new("")),
            // A pipe is not a regular file but can be read; reading a folder gives the error.
            (None, None) if Path::new(name).exists() => PathBuf::from(name),
            (None, None) => {
                return Err(PlanError::NotFound {
                    name: name.to_owned(),
                });
            }
        };
        let file = path.display().to_string();
        let text = read_text(&path, PLAN_LIMITS.bytes)?;
        Self::parse(&text, &file, path.parent().unwrap_or(Path::new("")))
    }

    /// Returns whether `name` means a plan rather than a scenario: a built-in plan, the folder of
    /// a study, or a JSON file with arms or scenarios. A file that is not JSON counts if it
    /// mentions them.
    #[must_use]
    pub fn is_plan(name: &str) -> bool {
        let Some(path) = file_of(name) else {
            return EMBEDDED_PLANS.iter().any(|plan| plan.name == name);
        };
        if path != Path::new(name) {
            return true;
        }
        let text = read_text(&path, PLAN_LIMITS.bytes).unwrap_or_default();
        Self::is_text_of_plan(&text)
    }

    /// Returns whether a JSON text has arms or scenarios, as a plan has; a plan may lack either of
    /// them by mistake. A text that is not JSON counts if it mentions them.
    #[must_use]
    pub fn is_text_of_plan(text: &str) -> bool {
        #[derive(Deserialize)]
        struct Keys {
            arms: Option<IgnoredAny>,
            scenarios: Option<IgnoredAny>,
        }
        match serde_json::from_str::<Keys>(text) {
            Ok(Keys { arms, scenarios }) => arms.is_some() || scenarios.is_some(),
            Err(_) => ["\"arms\"", "\"scenarios\""]
                .iter()
                .any(|key| text.contains(key)),
        }
    }

    /// Parses and checks the text of a plan. Errors name it `file`. Scenario files are looked for
    /// in `folder` first.
    ///
    /// # Errors
    /// When the text is not a plan, or the plan cannot be carried out.
    pub fn parse(text: &str, file: &str, folder: &Path) -> Result<Self, PlanError> {
        PLAN_LIMITS
            .check(text)
            .map_err(|error| FileError::new(file, error))?;
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

    /// Returns the JSON Schema of plan files.
    #[must_use]
    pub fn schema() -> schemars::Schema {
        schemars::schema_for!(PlanFile<'static>)
    }

    /// Creates a plan for scenarios given by name. The first arm with the base
    /// `random_selection` is the control.
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
        let names = scenarios.iter().map(|scenario| scenario.name.as_str());
        let name = names.collect::<Vec<_>>().join("_");
        let mut plan = Self {
            format: PLAN_FORMAT,
            // Many scenarios together are too long for a name.
            name: if is_name(&name) {
                name
            } else {
                String::from("study")
            },
            description: String::new(),
            control: None,
            scenarios,
            seeds,
            arms,
            reevaluation: Reevaluation::default(),
        };
        plan.choose_control();
        plan.checked(file)
    }

    /// Makes the first arm with the base `random_selection` the control, if there is none yet.
    pub(super) fn choose_control(&mut self) {
        if self.control.is_none() {
            let mut arms = self.arms.iter();
            let control = arms.find(|arm| arm.base == Base::RandomSelection);
            self.control = control.map(|arm| arm.name.clone());
        }
    }

    /// Returns the bytes of `study.json`.
    ///
    /// # Errors
    /// When serialisation fails.
    pub fn to_file(&self) -> Result<Vec<u8>, serde_json::Error> {
        let mut bytes = serde_json::to_vec_pretty(self)?;
        bytes.push(b'\n');
        Ok(bytes)
    }

    /// Returns this plan if it can be carried out.
    pub(super) fn checked(self, file: &str) -> Result<Self, PlanError> {
        let invalid = |place: &str, message: String| {
            Err(PlanError::Invalid {
                file: file.to_owned(),
                place: place.to_owned(),
                message,
            })
        };
        if !is_name(&self.name) {
            return invalid(
                "name",
                format!("found {}; allowed: {NAMES}", quoted(&self.name)),
            );
        }
        if self.scenarios.is_empty() || self.arms.is_empty() {
            let message = String::from("found none; allowed: at least one");
            return invalid("scenarios, arms", message);
        }
        let different = || String::from("found two with one name; allowed: different names");
        let names: BTreeSet<_> = self.scenarios.iter().map(|s| &s.name).collect();
        if names.len() != self.scenarios.len() {
            return invalid("scenarios", different());
        }
        let names: BTreeSet<_> = self.arms.iter().map(|arm| arm.name.as_str()).collect();
        if names.len() != self.arms.len() {
            return invalid("arms", different());
        }
        if let Some(name) = names.iter().find(|name| !is_name(name)) {
            return invalid(
                "arms",
                format!("found name {}; allowed: {NAMES}", quoted(name)),
            );
        }
        let control = self.control.as_deref();
        if let Some(control) = control.filter(|control| !names.contains(control)) {
            let allowed = names.into_iter().collect::<Vec<_>>().join(", ");
            return invalid(
                "control",
                format!("found {}; allowed: {allowed}", quoted(control)),
            );
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
            primitive_sets,
        } = self.reevaluation;
        for (name, found, least) in [
            ("warmup", warmup, 0),
            ("trials", trials, 1),
            ("repeats", repeats, 2),
            ("banks", primitive_sets, 1),
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

/// Returns the plan file that `name` means, if it exists: the file of that name, or the plan of
/// the study in the folder of that name.
fn file_of(name: &str) -> Option<PathBuf> {
    let path = PathBuf::from(name);
    [path.join(PLAN_FILE), path]
        .into_iter()
        .find(|path| path.is_file())
}

/// The plan of a study. Every combination of a scenario, an arm and a seed is a run.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "maxq-lab plan")]
struct PlanFile<'t> {
    /// Version of this format: 1.
    #[schemars(range(min = 1, max = 1))]
    format: u32,
    /// Short name, which follows the rules for names of scenarios.
    #[schemars(regex(pattern = r"^[a-z0-9_][a-z0-9_.-]{0,63}$"))]
    name: String,
    /// Purpose of the study, in one sentence.
    #[serde(default)]
    description: String,
    /// The scenarios, with different names.
    #[schemars(with = "Vec<ScenarioEntry>", length(min = 1))]
    #[serde(borrow)]
    scenarios: Vec<&'t RawValue>,
    /// The seeds: numbers and inclusive ranges, separated by commas, such as `1..30` or
    /// `1,2,5..9`.
    #[schemars(
        with = "String",
        regex(pattern = r"^\s*\d+(\.\.=?\d+)?\s*(,\s*\d+(\.\.=?\d+)?\s*)*$")
    )]
    seeds: Numbers,
    /// The arms, with different names.
    #[schemars(with = "Vec<ArmEntry>", length(min = 1))]
    #[serde(borrow)]
    arms: Vec<&'t RawValue>,
    /// Name of the control arm, against which claims are tested.
    #[serde(default)]
    control: Option<String>,
    /// How the winners of runs are evaluated.
    #[serde(default)]
    reevaluation: Reevaluation,
    /// What happens after each evolution: the `evolution.then` of every scenario.
    #[serde(default)]
    then: Option<Then>,
}

/// A scenario of a plan, for the schema. It is parsed by hand, for errors that name the place.
#[derive(JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "describes what is parsed by hand")]
enum ScenarioEntry {
    /// The name of a built-in scenario or of a file, which is looked for in the plan's folder
    /// first.
    Name(String),
    /// A whole scenario.
    Whole(Box<Scenario>),
}

/// An arm of a plan, for the schema. It is parsed by hand, for errors that name the place.
#[derive(JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "describes what is parsed by hand")]
enum ArmEntry {
    /// The name of a base: an arm without settings of its own.
    Base(Base),
    /// A whole arm.
    Whole(Arm),
}

impl<'t> PlanFile<'t> {
    /// Parses plan `text`; `file` names it in errors.
    fn parse(text: &'t str, file: &str) -> Result<Self, PlanError> {
        Ok(parse_json(text).map_err(|error| FileError::new(file, error))?)
    }

    /// Returns the plan with its scenarios and arms written out. Errors name it `file`. Scenario
    /// files are looked for in `folder` first.
    fn write_out(self, file: &str, folder: &Path) -> Result<Plan, PlanError> {
        let scenarios = self.scenarios.iter().enumerate().map(|(index, value)| {
            scenario(value, folder).map_err(|source| PlanError::Scenario {
                file: file.to_owned(),
                index,
                source: Box::new(source),
            })
        });
        let mut scenarios = scenarios.collect::<Result<Vec<Scenario>, _>>()?;
        if self.then.is_some() {
            for scenario in &mut scenarios {
                scenario.evolution.then = self.then;
            }
        }
        let arms = self.arms.iter().enumerate().map(|(index, value)| {
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

/// Returns the scenario that stands in a plan: a name, or a whole scenario.
fn scenario(value: &RawValue, folder: &Path) -> Result<Scenario, ScenarioError> {
    let Ok(name) = serde_json::from_str::<String>(value.get()) else {
        return Scenario::parse(value.get(), "counted from its beginning");
    };
    let beside = folder.join(&name);
    if beside.is_file() {
        Scenario::read(&beside)
    } else {
        Scenario::load(&name)
    }
}

/// Returns the arm that stands in a plan: the name of a base, or a whole arm.
fn arm(value: &RawValue) -> Result<Arm, String> {
    let Ok(name) = serde_json::from_str::<String>(value.get()) else {
        let arm = parse_json(value.get());
        return arm.map_err(|JsonError { place, message, .. }| format!("{place}: {message}"));
    };
    let base = Base::find(&name);
    base.map(Arm::of).ok_or_else(|| {
        let found = quoted(&name);
        format!("found {found}; allowed: {}, or an arm", Base::names())
    })
}
