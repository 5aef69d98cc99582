//! What the commands share that compute an answer and print it.

use std::process::ExitCode;
use std::sync::Arc;

use serde::Serialize;

use super::output::{self, CommandResult, Failure, Format};
use super::signals::SignalWatcher;
use crate::evolution::Workers;
use crate::lab::{AnyExperiment, experiment};
use crate::learning::Gate;
use crate::scenario::Scenario;

/// The arguments of these commands.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct AnswerArgs {
    /// Seed of all random streams.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true)]
    pub(super) seed: u64,

    /// Computing threads; 0 means one for each processor.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    threads: u16,

    /// Format of the output.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// What an answer is computed with.
pub(super) struct Means<'m> {
    pub(super) experiment: &'m dyn AnyExperiment,
    pub(super) workers: &'m Workers,
    pub(super) gate: &'m Gate,
}

impl AnswerArgs {
    /// Computes an answer and prints it; `describe` writes the text for people.
    ///
    /// A signal stops the computation; nothing is printed then.
    pub(super) fn answer<A: Serialize>(
        &self,
        scenario: Scenario,
        compute: impl FnOnce(Means<'_>) -> Result<A, Failure>,
        describe: impl FnOnce(&A) -> String,
    ) -> CommandResult {
        let gate = Arc::new(Gate::default());
        let stopping = Arc::clone(&gate);
        let ended = SignalWatcher::now()?.then(move || stopping.stop())?;
        let experiment = experiment(scenario, self.seed)?;
        let answer = compute(Means {
            experiment: &*experiment,
            workers: &Workers::new(usize::from(self.threads))?,
            gate: &gate,
        });
        if let Some(code) = ended.exit_code() {
            return Ok(ExitCode::from(code));
        }
        let answer = answer?;
        match self.format {
            Format::Json => output::json(&answer)?,
            Format::Text => output::text(&describe(&answer))?,
        }
        Ok(ExitCode::SUCCESS)
    }
}
