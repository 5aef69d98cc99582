//! How plans differ, and what is added to the plan of a study later: seeds and arms.

use std::path::Path;

use serde_json::Value;

use super::arm::Arm;
use super::numbers::Numbers;
use super::plan::Plan;
use super::plan_error::PlanError;
use crate::lab::{Difference, differences_in, told};
use crate::words::shell_path;

impl Plan {
    /// Returns the plan with those of these seeds and arms that it lacks. Seeds and arms that it
    /// has already stay where they are, and so do their runs.
    ///
    /// # Errors
    /// When the plan has another arm of the same name, or cannot be carried out with the new ones.
    pub fn with_more(&self, seeds: Option<&Numbers>, arms: Vec<Arm>) -> Result<Self, PlanError> {
        let mut plan = self.clone();
        let file = "study add";
        if let Some(seeds) = seeds {
            plan.seeds = plan
                .seeds
                .with(seeds)
                .map_err(|message| PlanError::Invalid {
                    file: file.to_owned(),
                    place: String::from("--seeds"),
                    message,
                })?;
        }
        for arm in arms {
            let known = plan.arms.iter().find(|known| known.name == arm.name);
            match known {
                Some(known) if *known != arm => return Err(other_arm(file, known, &arm)),
                Some(_) => {}
                None => plan.arms.push(arm),
            }
        }
        plan.choose_control();
        plan.checked(file)
    }

    /// Returns what differs between this plan and another, by dotted keys. Scenarios and arms have
    /// their names as keys.
    #[must_use]
    pub fn differences(&self, other: &Self) -> Vec<Difference> {
        differences_in(&by_name(self), &by_name(other))
    }

    /// Returns whether two plans are the same but for their seeds.
    #[must_use]
    pub fn differs_in_seeds_only(&self, other: &Self) -> bool {
        let seeds = other.seeds.clone();
        Self {
            seeds,
            ..self.clone()
        } == *other
    }
}

/// Returns the command that adds to the study in `folder` what `wanted` has more than its plan; `None`
/// if there is more to it than seeds and arms without settings.
pub(super) fn command(folder: &Path, plan: &Plan, wanted: &Plan) -> Option<String> {
    let lacking = |arm: &&Arm| !plan.arms.contains(arm);
    let arms: Vec<_> = wanted.arms.iter().filter(lacking).cloned().collect();
    let grown = plan.with_more(Some(&wanted.seeds), arms.clone()).ok()?;
    let has_all = wanted
        .with_more(Some(&plan.seeds), plan.arms.clone())
        .ok()?;
    let same_but_for_order = Plan {
        seeds: grown.seeds.clone(),
        arms: grown.arms.clone(),
        ..has_all
    };
    let are_bases = arms.iter().all(|arm| *arm == Arm::of(arm.base));
    if same_but_for_order != grown || !are_bases || grown == *plan {
        return None;
    }
    let mut command = format!("maxq-lab study add {}", shell_path(folder));
    if grown.seeds != plan.seeds {
        command += &format!(" --seeds {}", wanted.seeds);
    }
    if !arms.is_empty() {
        let names: Vec<_> = arms.iter().map(|arm| arm.name.as_str()).collect();
        command += &format!(" --arms {}", names.join(","));
    }
    Some(command)
}

fn other_arm(file: &str, known: &Arm, arm: &Arm) -> PlanError {
    let json = |arm: &Arm| serde_json::to_value(arm).unwrap_or_default();
    let differences = differences_in(&json(known), &json(arm));
    PlanError::Invalid {
        file: file.to_owned(),
        place: format!("arm {}", arm.name),
        message: format!(
            "found another arm of this name in the study: {}; allowed: another name",
            told(&differences)
        ),
    }
}

/// Returns a plan as JSON in which scenarios and arms have their names as keys.
fn by_name(plan: &Plan) -> Value {
    let mut json = serde_json::to_value(plan).unwrap_or_default();
    for list in ["scenarios", "arms"] {
        if let Some(Value::Array(items)) = json.get_mut(list).map(Value::take) {
            let named = items.into_iter().map(|item| {
                let name = item.get("name").and_then(Value::as_str).unwrap_or_default();
                (name.to_owned(), item)
            });
            json[list] = Value::Object(named.collect());
        }
    }
    json
}
