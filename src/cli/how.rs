//! How a run is carried out and shown: arguments that `run` and `resume` share.

use clap::ValueEnum;

use super::output::Format;
use super::show::Show;
use crate::lab::{Keep, RunOptions};

/// What becomes of a run when the line drops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum OnHangup {
    /// It goes on without a terminal, to its end.
    #[default]
    Detach,
    /// It is saved and ended.
    Stop,
}

/// How a run is carried out, whatever it is.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct How {
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

    /// How to report the result.
    #[arg(long, value_enum, default_value_t)]
    pub(super) format: Format,

    #[command(flatten)]
    pub(super) show: Show,
}

impl How {
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
