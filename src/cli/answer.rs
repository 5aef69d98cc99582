//! Commands that compute an answer and print it: a signal stops them.

use std::process::ExitCode;
use std::sync::Arc;

use serde::Serialize;

use super::output::{self, Done, Failure, Format};
use super::signals::Caught;
use crate::evolution::Workers;
use crate::lab::{WorldTask, with_world};
use crate::learning::Gate;
use crate::scenario::Scenario;

/// What such commands are told alike.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct Asked {
    /// Seed of all random streams.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true)]
    pub(super) seed: u64,

    /// Computing threads; 0 means one for each processor.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    threads: u16,

    /// How to report.
    #[arg(long, value_enum, default_value_t)]
    pub(super) format: Format,
}

impl Asked {
    /// The threads that compute.
    pub(super) fn workers(&self) -> Result<Workers, Failure> {
        Ok(Workers::new(usize::from(self.threads))?)
    }
}

/// Carries out the task that `task` makes with a gate, in the world of `scenario`, and
/// prints its result as `format` says. A signal stops the gate: then nothing is printed.
pub(super) fn answer<T, R>(
    scenario: Scenario,
    format: Format,
    task: impl FnOnce(Arc<Gate>) -> T,
    describe: impl FnOnce(&R) -> String,
) -> Done
where
    T: WorldTask<Output = Result<R, Failure>>,
    R: Serialize,
{
    let gate = Arc::new(Gate::default());
    let stopping = Arc::clone(&gate);
    let ended = Caught::now()?.then(move || stopping.stop())?;
    let result = with_world(scenario, task(gate))?;
    if let Some(code) = ended.exit_code() {
        return Ok(ExitCode::from(code));
    }
    let result = result?;
    match format {
        Format::Json => output::json(&result)?,
        Format::Text => output::text(&describe(&result))?,
    }
    Ok(ExitCode::SUCCESS)
}
