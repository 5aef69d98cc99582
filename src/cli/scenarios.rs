//! `maxq-lab scenarios` and `maxq-lab schema`.

use std::path::Path;
use std::process::ExitCode;

use clap::ValueEnum;
use serde::Serialize;

use super::output::{self, CommandResult, Format};
use crate::report::Plan;
use crate::scenario::{EMBEDDED, EMBEDDED_PLANS, Scenario};

/// List the embedded scenarios and plans of studies, or print one.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  maxq-lab scenarios environment-2 > my-scenario.json     a file to start from")]
pub(super) struct Args {
    /// Print the file of this scenario, or of this plan, instead.
    name: Option<String>,

    /// How to report the list.
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

/// Carries out the command.
pub(super) fn main(args: &Args) -> CommandResult {
    if let Some(name) = &args.name {
        let embedded = EMBEDDED
            .iter()
            .chain(EMBEDDED_PLANS)
            .find(|embedded| embedded.name == name);
        let names: Vec<_> = EMBEDDED
            .iter()
            .chain(EMBEDDED_PLANS)
            .map(|embedded| embedded.name)
            .collect();
        let embedded = embedded
            .ok_or_else(|| format!("no scenario {name:?}; allowed: {}", names.join(", ")))?;
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
                    output::text("\nplans, for 'maxq-lab study':\n")?;
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

/// Print the JSON Schema of scenario files, or of plans.
///
/// Editors use it to complete and check these files; 'maxq-lab check' also checks what a
/// schema cannot say.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab schema > scenario.schema.json
  maxq-lab schema --of plan > plan.schema.json")]
pub(super) struct SchemaArgs {
    /// What the schema is of.
    #[arg(long, value_enum, default_value_t)]
    of: FileKind,
}

/// A kind of file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum FileKind {
    /// A scenario.
    #[default]
    Scenario,
    /// The plan of a study.
    Plan,
}

/// Carries out the command.
pub(super) fn schema(args: &SchemaArgs) -> CommandResult {
    output::json(&match args.of {
        FileKind::Scenario => Scenario::schema(),
        FileKind::Plan => Plan::schema(),
    })?;
    Ok(ExitCode::SUCCESS)
}
