//! `maxq-lab check`: validates scenario files and plans.

use std::path::Path;
use std::process::ExitCode;

use serde::Serialize;

use super::names;
use super::output::{self, CommandResult, Format};
use crate::files::read_standard_input;
use crate::lab::experiment;
use crate::report::{PLAN_LIMITS, Plan, plan_warnings};
use crate::scenario::{STANDARD_INPUT, Scenario};
use crate::words::quoted;

/// Validate scenario files and study plans.
///
/// What is odd about a scenario, or one of a plan, though it is valid, is a warning. Warnings do not change the
/// exit code.
///
/// With --format json, complete scenarios are printed, including defaults: every setting that
/// 'maxq-lab run --set' can change.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab check mine.json my-plan.json
  jq '.learning.discount = 0.95' mine.json | maxq-lab check -
  maxq-lab check environment-1 --format json | jq '.[0].scenario'       all settings for --set
  maxq-lab check mine.json --set learning.discount=0.95")]
pub(super) struct Args {
    /// Scenario files, plan files, or names of built-in scenarios and plans; - is standard input.
    #[arg(required = true, value_parser = names::scenarios_and_plans(), hide_possible_values = true)]
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
        report.error = report.check(settings).err();
        report.valid = report.error.is_none();
        report
    }

    /// Reads the file as what it is, and says what is wrong with it.
    fn check(&mut self, settings: &[String]) -> Result<(), String> {
        let file = self.file.as_str();
        if file == STANDARD_INPUT {
            let text = read_standard_input(PLAN_LIMITS.bytes).map_err(told)?;
            self.file = String::from("standard input");
            return self.check_text(&text, settings);
        }
        if Plan::is_plan(file) {
            self.take_plan(Plan::load(file).map_err(told)?, settings)
        } else {
            self.take_scenario(Scenario::load(file).map_err(told)?, settings)
        }
    }

    fn check_text(&mut self, text: &str, settings: &[String]) -> Result<(), String> {
        if Plan::is_text_of_plan(text) {
            let plan = Plan::parse(text, &self.file, Path::new(""));
            self.take_plan(plan.map_err(told)?, settings)
        } else {
            let scenario = Scenario::parse(text, &self.file);
            self.take_scenario(scenario.map_err(told)?, settings)
        }
    }

    /// Takes a scenario, and says what is odd about it.
    fn take_scenario(&mut self, scenario: Scenario, settings: &[String]) -> Result<(), String> {
        let scenario = scenario.with_settings(settings).map_err(told)?;
        let ready = experiment(scenario.clone(), 0);
        let ready = ready.map_err(|error| format!("{}: {error}", self.file))?;
        self.warnings = ready.warnings().iter().map(ToString::to_string).collect();
        self.scenario = Some(scenario);
        Ok(())
    }

    fn take_plan(&mut self, plan: Plan, settings: &[String]) -> Result<(), String> {
        if let Some(found) = settings.first() {
            return Err(format!(
                "--set: found {} with the plan {}; allowed: with scenarios only (the settings of a \
                 plan stand in its arms)",
                quoted(found),
                self.file
            ));
        }
        self.warnings = plan_warnings(&plan);
        self.plan = Some(plan);
        Ok(())
    }
}

fn told(error: impl ToString) -> String {
    error.to_string()
}
