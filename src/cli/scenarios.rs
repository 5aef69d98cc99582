//! `maxq-lab scenarios`: the embedded scenarios.

use std::process::ExitCode;

use serde::Serialize;

use super::output::{self, Done, Format};
use crate::scenario::{EMBEDDED, EMBEDDED_PLANS, Scenario};

/// List the embedded scenarios, or print one, or the plan of the embedded study, 'thesis'.
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
    description: String,
}

/// Carries out the command.
pub(super) fn main(args: &Args) -> Done {
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
    let mut rows = Vec::new();
    for embedded in EMBEDDED {
        rows.push(Row {
            name: embedded.name,
            description: Scenario::parse(embedded.json, embedded.name)?.description,
        });
    }
    match args.format {
        Format::Json => output::json(&rows)?,
        Format::Text => {
            for Row { name, description } in rows {
                output::text(&format!("{name:15} {description}\n"))?;
            }
        }
    }
    Ok(ExitCode::SUCCESS)
}
