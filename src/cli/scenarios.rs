//! `maxq-lab scenarios` and `maxq-lab schema`: the files that users write.

use std::path::Path;
use std::process::ExitCode;

use clap::ValueEnum;
use serde::Serialize;

use super::names;
use super::output::{self, CommandResult, Format};
use crate::report::Plan;
use crate::scenario::{EMBEDDED, EMBEDDED_PLANS, Scenario};

/// List the built-in scenarios and study plans, or print one.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  maxq-lab scenarios environment-2 > my-scenario.json     a copy to edit")]
pub(super) struct Args {
    /// Print the file of this scenario or plan.
    #[arg(value_parser = names::scenarios_and_plans(), hide_possible_values = true)]
    name: Option<String>,

    /// Format of the list.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

#[derive(Serialize)]
struct Row {
    name: &'static str,
    kind: Kind,
    description: String,
}

#[derive(Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
enum Kind {
    Scenario,
    Plan,
}

/// Runs `maxq-lab scenarios`.
pub(super) fn main(args: &Args) -> CommandResult {
    if let Some(name) = &args.name {
        let all = || EMBEDDED.iter().chain(EMBEDDED_PLANS);
        let Some(embedded) = all().find(|embedded| embedded.name == name) else {
            let names: Vec<_> = all().map(|embedded| embedded.name).collect();
            let allowed = names.join(", ");
            return Err(format!("NAME: found {name:?}; allowed: {allowed}").into());
        };
        output::text(embedded.json)?;
        return Ok(ExitCode::SUCCESS);
    }
    let rows = rows()?;
    match args.format {
        Format::Json => output::json(&rows)?,
        Format::Text => {
            let mut kind = Kind::Scenario;
            for row in rows {
                if row.kind != kind {
                    output::text("\nPlans, for 'maxq-lab study':\n")?;
                    kind = row.kind;
                }
                output::text(&format!("{:15} {}\n", row.name, row.description))?;
            }
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn rows() -> Result<Vec<Row>, Box<dyn std::error::Error>> {
    let scenarios = EMBEDDED.iter().map(|embedded| {
        Ok(Row {
            name: embedded.name,
            kind: Kind::Scenario,
            description: Scenario::parse(embedded.json, embedded.name)?.description,
        })
    });
    let plans = EMBEDDED_PLANS.iter().map(|embedded| {
        let plan = Plan::parse(embedded.json, embedded.name, Path::new(""))?;
        Ok(Row {
            name: embedded.name,
            kind: Kind::Plan,
            description: plan.description,
        })
    });
    scenarios.chain(plans).collect()
}

/// Print the JSON Schema of scenario files or of study plans.
///
/// Editors use a schema to complete and validate these files. 'maxq-lab check' also enforces
/// rules that a schema cannot express.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab schema > scenario.schema.json
  maxq-lab schema --of plan > plan.schema.json")]
pub(super) struct SchemaArgs {
    /// Kind of file.
    #[arg(long, value_name = "KIND", value_enum, default_value_t)]
    of: FileKind,
}

/// A kind of file that has a schema.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum FileKind {
    /// Scenario file.
    #[default]
    Scenario,
    /// Study plan.
    Plan,
}

/// Runs `maxq-lab schema`.
pub(super) fn schema(args: &SchemaArgs) -> CommandResult {
    output::json(&match args.of {
        FileKind::Scenario => Scenario::schema(),
        FileKind::Plan => Plan::schema(),
    })?;
    Ok(ExitCode::SUCCESS)
}
