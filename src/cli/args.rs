//! Arguments that several commands share.

use std::path::Path;

use clap::{Args, ValueEnum};

use super::dashboard::DashboardArgs;
use super::output::{Failure, Format};
use crate::lab::AnyExperiment;
use crate::lab::inspection::Start;
use crate::lab::{Keep, RunOptions};
use crate::scenario::{EMBEDDED, Scenario};

/// What becomes of a run when the line drops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum OnHangup {
    /// It goes on without a terminal, to its end.
    #[default]
    Detach,
    /// It is saved and ended.
    Stop,
}

/// ExecutionArgs a run is carried out, whatever it is.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct ExecutionArgs {
    /// Computing threads; 0 means one for each processor.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    threads: u16,

    /// Checkpoints kept in generations/: all, none, or every N-th generation's.
    #[arg(long, value_name = "all|none|N", default_value = "all")]
    keep: Keep,

    /// Open no dashboard, although there is a terminal; a bar on standard error shows the
    /// progress.
    #[arg(long)]
    pub(super) headless: bool,

    /// What becomes of the run when the line drops: it goes on without a terminal, or is
    /// saved and ended. 'maxq-lab watch' and 'maxq-lab resume' find it again.
    #[arg(long, value_enum, default_value_t)]
    pub(super) on_hangup: OnHangup,

    /// ExecutionArgs to report the result.
    #[arg(long, value_enum, default_value_t)]
    pub(super) format: Format,

    #[command(flatten)]
    pub(super) dashboard: DashboardArgs,
}

impl ExecutionArgs {
    /// The library's options.
    pub(super) fn options(&self, force: bool) -> RunOptions {
        RunOptions {
            threads: usize::from(self.threads),
            keep: self.keep,
            force,
        }
    }

    /// The arguments with which another process goes on with the run as it was, without a
    /// terminal.
    pub(super) fn resume_headless(&self) -> Vec<String> {
        let (threads, keep) = (self.threads.to_string(), self.keep.to_string());
        let arguments = [
            "resume",
            "--headless",
            "--threads",
            &threads,
            "--keep",
            &keep,
        ];
        arguments.map(String::from).to_vec()
    }
}

/// A scenario with changes.
#[derive(Clone, Debug, Args)]
pub(super) struct ScenarioArgs {
    /// A scenario file, or the name of an embedded scenario ('maxq-lab scenarios').
    scenario: String,

    /// Change a setting of the scenario; may be repeated.
    ///
    /// The key is a dotted path into the complete scenario, as 'maxq-lab check --format json
    /// SCENARIO' prints it, the value JSON or a bare word: learning.discount=0.95,
    /// evolution.selection=random.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    settings: Vec<String>,
}

impl ScenarioArgs {
    /// The scenario with its changes.
    pub(super) fn load(&self) -> Result<Scenario, Failure> {
        let name = &self.scenario;
        let is_embedded = EMBEDDED.iter().any(|embedded| embedded.name == name);
        if !is_embedded && Path::new(name).join("run.json").is_file() {
            let message = format!(
                "{name}: found a run folder; allowed: a scenario file, or the name of an embedded \
                 scenario; 'maxq-lab resume {name}' goes on with the run, 'maxq-lab replay {name}' \
                 shows it"
            );
            return Err(message.into());
        }
        Ok(Scenario::load(name)?.with_settings(&self.settings)?)
    }
}

/// Where the trials of rollouts begin.
#[derive(Debug, clap::Args)]
pub(super) struct StartArg {
    /// The state in which the trials of rollouts begin: what is the case, and where the
    /// agent is, such as 'from R to B at 0,3' or 'carrying at 500,1200 heading 90'.
    #[arg(long, value_name = "STATE")]
    start: Option<String>,
}

impl StartArg {
    /// The state in the world of the experiment, if the person has named one.
    pub(super) fn read(&self, experiment: &dyn AnyExperiment) -> Result<Option<Start>, Failure> {
        let start = self
            .start
            .as_deref()
            .map(|text| experiment.read_start(text));
        let start = start.transpose();
        start.map_err(|error| format!("--start: {error}").into())
    }
}
