//! Commands that compute an answer, which a signal can stop, and print it.

use std::process::ExitCode;
use std::sync::Arc;

use serde::Serialize;

use super::args::useful_threads;
use super::output::{self, CommandResult, Failure, Format};
use super::signals::{SignalWatcher, Termination};
use crate::evolution::Workers;
use crate::lab::{AnyExperiment, experiment};
use crate::learning::Gate;
use crate::scenario::Scenario;

/// The arguments that these commands share.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct AnswerArgs {
    /// Random seed: the same seed gives bit for bit the same result.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true)]
    pub(super) seed: u64,

    /// Number of threads, at most one per processor; 0 means one per processor.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    threads: u16,

    /// Output format.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// The resources of a computation.
pub(super) struct Resources<'r> {
    pub(super) experiment: &'r dyn AnyExperiment,
    pub(super) workers: &'r Workers,
    pub(super) gate: &'r Gate,
}

impl AnswerArgs {
    /// Computes an answer and prints it as JSON or as the text of `describe`.
    ///
    /// A signal stops the computation; then nothing is printed.
    pub(super) fn answer<A: Serialize>(
        &self,
        scenario: Scenario,
        compute: impl FnOnce(Resources<'_>) -> Result<A, Failure>,
        describe: impl FnOnce(&A) -> String,
    ) -> CommandResult {
        let gate = Arc::new(Gate::default());
        let stopping = Arc::clone(&gate);
        let termination = Termination::default();
        let stop = move || stopping.stop();
        SignalWatcher::start()?.stop_on_signals(&termination, false, stop)?;
        let experiment = experiment(scenario, self.seed)?;
        let name = &experiment.scenario().name;
        let odd = experiment.warnings().into_iter();
        output::warnings(&odd.map(|odd| format!("{name}: {odd}")).collect::<Vec<_>>());
        let answer = compute(Resources {
            experiment: &*experiment,
            workers: &Workers::new(useful_threads(self.threads).get())?,
            gate: &gate,
        });
        if let Some(code) = termination.exit_code() {
            return Ok(ExitCode::from(code));
        }
        self.format.print(&answer?, describe)?;
        Ok(ExitCode::SUCCESS)
    }
}
