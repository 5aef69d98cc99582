//! `maxq-lab check`: are scenario files and plans valid?

use std::process::ExitCode;

use serde::Serialize;

use super::output::{self, CommandResult, Format};
use crate::lab::experiment;
use crate::report::Plan;
use crate::scenario::Scenario;

/// Check scenario files, and plans of studies.
///
/// With --format json the complete scenarios are printed, defaults written out: what
/// 'maxq-lab run --set' can change.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab check mine.json my-plan.json
  maxq-lab check environment-1 --format json | jq '.[0].scenario'       all that --set can change
  maxq-lab check mine.json --set learning.discount=0.95")]
pub(super) struct Args {
    /// Scenario files, plans, or names of embedded ones.
    #[arg(required = true)]
    files: Vec<String>,

    /// Check the scenarios with a setting changed, as 'maxq-lab run --set' would; may be
    /// repeated.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    settings: Vec<String>,

    /// How to report.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

#[derive(Serialize)]
struct Report {
    file: String,
    valid: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    scenario: Option<Scenario>,
    #[serde(skip_serializing_if = "Option::is_none")]
    plan: Option<Plan>,
}

/// Carries out the command.
pub(super) fn main(args: &Args) -> CommandResult {
    let report = |file: &String| match Plan::is_plan(file) {
        true => report_plan(file, &args.settings),
        false => report_scenario(file, &args.settings),
    };
    let reports: Vec<_> = args.files.iter().map(report).collect();
    match args.format {
        Format::Json => output::json(&reports)?,
        Format::Text => {
            for report in &reports {
                match &report.error {
                    None => output::text(&format!("{}: valid\n", report.file))?,
                    Some(error) => output::message(&format!("error: {error}")),
                }
            }
        }
    }
    match reports.iter().all(|report| report.valid) {
        true => Ok(ExitCode::SUCCESS),
        false => Ok(ExitCode::FAILURE),
    }
}

fn report_scenario(file: &str, settings: &[String]) -> Report {
    let loaded = Scenario::load(file)
        .and_then(|scenario| scenario.with_settings(settings))
        .map_err(|error| error.to_string());
    let checked = loaded.and_then(|scenario| {
        let ready = experiment(scenario.clone(), 0);
        ready
            .map(|_| scenario)
            .map_err(|error| format!("{file}: {error}"))
    });
    let (scenario, error) = match checked {
        Ok(scenario) => (Some(scenario), None),
        Err(error) => (None, Some(error)),
    };
    Report {
        file: file.to_owned(),
        valid: error.is_none(),
        error,
        scenario,
        plan: None,
    }
}

fn report_plan(file: &str, settings: &[String]) -> Report {
    let (plan, error) = match (Plan::load(file), settings.first()) {
        (Ok(plan), None) => (Some(plan), None),
        (Ok(_), Some(found)) => (
            None,
            Some(format!(
                "--set: found {found:?} for the plan {file}; allowed: for scenarios, since the \
                 settings of a plan are those of its arms"
            )),
        ),
        (Err(error), _) => (None, Some(error.to_string())),
    };
    Report {
        file: file.to_owned(),
        valid: error.is_none(),
        error,
        scenario: None,
        plan,
    }
}
