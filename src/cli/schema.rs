//! `maxq-lab schema`: the JSON Schema of the files that people write.

use std::process::ExitCode;

use clap::ValueEnum;

use super::output::{self, Done};
use crate::report::Plan;
use crate::scenario::Scenario;

/// Print the JSON Schema of scenario files, or of plans.
///
/// Editors use it to complete and check these files; 'maxq-lab check' also checks what a
/// schema cannot say.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab schema > scenario.schema.json
  maxq-lab schema --of plan > plan.schema.json")]
pub(super) struct Args {
    /// What the schema is of.
    #[arg(long, value_enum, default_value_t)]
    of: Kind,
}

/// A kind of file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// A scenario.
    #[default]
    Scenario,
    /// The plan of a study.
    Plan,
}

/// Carries out the command.
pub(super) fn main(args: &Args) -> Done {
    output::json(&match args.of {
        Kind::Scenario => Scenario::schema(),
        Kind::Plan => Plan::schema(),
    })?;
    Ok(ExitCode::SUCCESS)
}
