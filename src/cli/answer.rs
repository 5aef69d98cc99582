//! Commands that compute an answer and print it: a signal stops them.

use std::process::ExitCode;
use std::sync::Arc;

use serde::Serialize;

use super::output::{self, CommandResult, Failure, Format};
use super::signals::SignalWatcher;
use crate::evolution::{Experiment, Workers};
use crate::lab::{WorldTask, with_world};
use crate::learning::Gate;
use crate::scenario::Scenario;
use crate::worlds::scene::Scenic;

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

/// A question that a command computes the answer to, in any world.
pub(super) trait Question {
    /// What comes out.
    type Answer: Serialize;

    /// Computes the answer. When the gate is stopped, it is not wanted any more.
    fn compute<W: Scenic + 'static>(
        &self,
        experiment: &Experiment<W>,
        gate: &Gate,
    ) -> Result<Self::Answer, Failure>;

    /// The answer, for people.
    fn describe(answer: &Self::Answer) -> String;
}

/// Computes the answer to a question in the world of `scenario` and prints it as `format`
/// says. After a signal nothing is printed.
pub(super) fn answer<Q: Question>(
    question: &Q,
    scenario: Scenario,
    format: Format,
) -> CommandResult {
    let gate = Arc::new(Gate::default());
    let stopping = Arc::clone(&gate);
    let ended = SignalWatcher::now()?.then(move || stopping.stop())?;
    let asking = Asking {
        question,
        gate: &gate,
    };
    let answer = with_world(scenario, asking)?;
    if let Some(code) = ended.exit_code() {
        return Ok(ExitCode::from(code));
    }
    let answer = answer?;
    match format {
        Format::Json => output::json(&answer)?,
        Format::Text => output::text(&Q::describe(&answer))?,
    }
    Ok(ExitCode::SUCCESS)
}

struct Asking<'q, Q> {
    question: &'q Q,
    gate: &'q Gate,
}

impl<Q: Question> WorldTask for Asking<'_, Q> {
    type Output = Result<Q::Answer, Failure>;

    fn carry_out<W: Scenic + 'static>(self, experiment: Experiment<W>) -> Self::Output {
        self.question.compute(&experiment, self.gate)
    }
}
