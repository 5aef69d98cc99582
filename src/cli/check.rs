//! `maxq-lab check`: validates scenario files and plans.

use std::process::ExitCode;

use serde::Serialize;

use super::output::{self, CommandResult, Format};
use crate::lab::experiment;
use crate::report::Plan;
use crate::scenario::Scenario;

/// Validate scenario files and study plans.
///
/// What is odd about a scenario, though it is valid, is a warning. Warnings do not change the
/// exit code.
///
/// With --format json, complete scenarios are printed, including defaults: every setting that
/// 'maxq-lab run --set' can change.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab check mine.json my-plan.json
  maxq-lab check environment-1 --format json | jq '.[0].scenario'       all settings for --set
  maxq-lab check mine.json --set learning.discount=0.95")]
pub(super) struct Args {
    /// Scenario files, plan files, or names of built-in scenarios and plans.
    #[arg(required = true)]
    files: Vec<String>,

    /// Change a setting before validation, as 'maxq-lab run --set' does; may be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    settings: Vec<String>,

    /// Output format.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

#[derive(Serialize)]
struct Report {
    file: String,
    valid: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    warnings: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    scenario: Option<Scenario>,
    #[serde(skip_serializing_if = "Option::is_none")]
    plan: Option<Plan>,
}

/// Runs `maxq-lab check`.
pub(super) fn main(args: &Args) -> CommandResult {
    let report = |file: &String| Report::of(file, &args.settings);
    let reports: Vec<_> = args.files.iter().map(report).collect();
    match args.format {
        Format::Json => output::json(&reports)?,
        Format::Text => {
            for report in &reports {
                match &report.error {
                    None => {
                        output::text(&format!("{}: valid\n", report.file))?;
                        let file = &report.file;
                        let placed = report.warnings.iter().map(|odd| format!("{file}: {odd}"));
                        output::warnings(&placed.collect::<Vec<_>>());
                    }
                    Some(error) => output::message(&format!("error: {error}")),
                }
            }
        }
    }
    let all_valid = reports.iter().all(|report| report.valid);
    Ok(ExitCode::from(u8::from(!all_valid)))
}

impl Report {
    fn of(file: &str, settings: &[String]) -> Self {
        let mut report = Self {
            file: file.to_owned(),
            valid: false,
            error: None,
            warnings: Vec::new(),
            scenario: None,
            plan: None,
        };
        let result = if Plan::is_plan(file) {
            checked_plan(file, settings).map(|plan| report.plan = Some(plan))
        } else {
            checked_scenario(file, settings).map(|(scenario, warnings)| {
                report.scenario = Some(scenario);
                report.warnings = warnings;
            })
        };
        report.valid = result.is_ok();
        report.error = result.err();
        report
    }
}

/// Reads a scenario, and says what is odd about it.
fn checked_scenario(file: &str, settings: &[String]) -> Result<(Scenario, Vec<String>), String> {
    let scenario = Scenario::load(file).and_then(|scenario| scenario.with_settings(settings));
    let scenario = scenario.map_err(|error| error.to_string())?;
    let ready = experiment(scenario.clone(), 0).map_err(|error| format!("{file}: {error}"))?;
    let warnings = ready.warnings().iter().map(ToString::to_string).collect();
    Ok((scenario, warnings))
}

fn checked_plan(file: &str, settings: &[String]) -> Result<Plan, String> {
    let plan = Plan::load(file).map_err(|error| error.to_string())?;
    match settings.first() {
        None => Ok(plan),
        Some(found) => Err(format!(
            "--set: found {found:?} with the plan {file}; allowed: with scenarios only (the \
             settings of a plan stand in its arms)"
        )),
    }
}
