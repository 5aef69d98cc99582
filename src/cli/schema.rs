//! `maxq-lab schema`: the JSON Schema of scenario files.

use std::process::ExitCode;

use super::output::{self, Done};
use crate::scenario::Scenario;

/// Print the JSON Schema of scenario files.
///
/// Editors use it to complete and check scenarios; 'maxq-lab check' also checks what a
/// schema cannot say.
#[derive(Debug, clap::Args)]
pub(super) struct Args {}

/// Carries out the command.
pub(super) fn main(_args: &Args) -> Done {
    output::json(&Scenario::schema())?;
    Ok(ExitCode::SUCCESS)
}
