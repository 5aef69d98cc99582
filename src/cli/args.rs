//! Arguments that several commands share.

use std::num::NonZeroUsize;
use std::path::Path;

use clap::{Args, ValueEnum};

use super::dashboard::DashboardArgs;
use super::names;
use super::output::{Failure, Format};
use crate::dashboard::terminal;
use crate::evolution::processors;
use crate::lab::inspection::Start;
use crate::lab::{AnyExperiment, Keep, MANIFEST, RunOptions};
use crate::scenario::{EMBEDDED, Scenario};
use crate::words::shell_word;

/// A scenario and changes to its settings.
#[derive(Clone, Debug, Args)]
pub(super) struct ScenarioArgs {
    /// Scenario file, the name of a built-in scenario ('maxq-lab scenarios' lists them), or - for
    /// standard input.
    #[arg(value_parser = names::scenarios(), hide_possible_values = true)]
    scenario: String,

    /// Change a setting of the scenario; may be repeated.
    ///
    /// The key is a dotted path into the complete scenario, as 'maxq-lab check --format json
    /// SCENARIO' prints it. The value is JSON or a plain word. Examples:
    /// learning.discount=0.95, evolution.selection=random.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    settings: Vec<String>,
}

impl ScenarioArgs {
    /// The scenario with its changes.
    pub(super) fn load(&self) -> Result<Scenario, Failure> {
        let name = &self.scenario;
        let is_embedded = EMBEDDED.iter().any(|embedded| embedded.name == name);
        if !is_embedded && Path::new(name).join(MANIFEST).is_file() {
            let folder = shell_word(name);
            let message = format!(
                "{name}: found a run folder; allowed: a scenario file, or the name of a built-in \
                 scenario; to resume this run: maxq-lab resume {folder}; to view it: maxq-lab \
                 replay {folder}"
            );
            return Err(message.into());
        }
        Ok(Scenario::load(name)?.with_settings(&self.settings)?)
    }
}

/// The state in which rollouts start.
#[derive(Debug, Args)]
pub(super) struct StartArg {
    /// Start every rollout in this state, such as 'from R to B at 0,3' or 'carrying at
    /// 500,1200 heading 90' [default: a random start]
    #[arg(long, value_name = "STATE")]
    start: Option<String>,
}

impl StartArg {
    /// The state in the world of `experiment`, if one was given.
    pub(super) fn read(&self, experiment: &dyn AnyExperiment) -> Result<Option<Start>, Failure> {
        let start = self
            .start
            .as_deref()
            .map(|text| experiment.read_start(text));
        let start = start.transpose();
        start.map_err(|error| format!("--start: {error}").into())
    }
}

/// What happens to a run when its terminal is lost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum OnHangup {
    /// Continue to the end without a terminal.
    #[default]
    Detach,
    /// Save and exit.
    Stop,
}

impl OnHangup {
    /// Whether the work goes on after SIGHUP.
    ///
    /// Without a terminal that could be lost, SIGHUP is a request to end.
    pub(super) fn survives(self) -> bool {
        self == Self::Detach && terminal::is_attached()
    }
}

/// How a run is executed and shown.
#[derive(Clone, Debug, Args)]
pub(super) struct ExecutionArgs {
    /// Number of threads, at most one per processor; 0 means one per processor.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    threads: u16,

    /// Which states to keep in generations/, for looking at past generations: thinned, all, none,
    /// or one every N generations [default: thinned; a resumed run: as it was started].
    ///
    /// thinned: those of the last 64 generations, every second of the 64 before, every fourth of
    /// the 128 before these, and so on, so that the folder hardly grows. all: the program says
    /// what that costs.
    #[arg(long, value_name = "thinned|all|none|N")]
    keep: Option<Keep>,

    /// Show a progress bar instead of the dashboard.
    #[arg(long)]
    pub(super) headless: bool,

    /// What to do when the terminal is lost (SIGHUP): continue without one, or save and exit.
    ///
    /// 'maxq-lab watch' shows a run that continues; 'maxq-lab resume' resumes a run that was
    /// saved.
    #[arg(long, value_name = "ACTION", value_enum, default_value_t)]
    pub(super) on_hangup: OnHangup,

    /// Format of the result.
    #[arg(long, value_enum, default_value_t)]
    pub(super) format: Format,

    #[command(flatten)]
    pub(super) dashboard: DashboardArgs,
}

impl ExecutionArgs {
    /// The options of the run.
    pub(super) fn options(&self, force: bool) -> RunOptions {
        RunOptions {
            threads: useful_threads(self.threads).get(),
            keep: self.keep,
            force,
        }
    }

    /// The arguments with which another process resumes the run without a terminal.
    pub(super) fn resume_headless(&self) -> Vec<String> {
        let threads = self.threads.to_string();
        let words = ["resume", "--headless", "--threads", &threads];
        words.map(String::from).to_vec()
    }
}

/// Returns how many of the threads asked for are started: more than processors only get in each
/// other's way.
pub(super) fn useful_threads(asked: u16) -> NonZeroUsize {
    let most = processors();
    NonZeroUsize::new(usize::from(asked)).map_or(most, |asked| asked.min(most))
}
