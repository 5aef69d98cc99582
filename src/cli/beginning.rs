//! Where the trials begin that a dashboard shows.

use super::output::Failure;
use crate::lab::specimen::{Bench, Start};

/// Where the trials of rollouts begin.
#[derive(Debug, clap::Args)]
pub(super) struct Beginning {
    /// The state in which the trials of rollouts begin: what is the case, and where the
    /// agent is, such as 'from R to B at 0,3' or 'carrying at 500,1200 heading 90'.
    #[arg(long, value_name = "STATE")]
    start: Option<String>,
}

impl Beginning {
    /// The state in the world of a bench, if the person has named one.
    pub(super) fn read(&self, bench: &dyn Bench) -> Result<Option<Start>, Failure> {
        let start = self.start.as_deref().map(|text| Start::read(text, bench));
        let start = start.transpose();
        start.map_err(|error| format!("--start: {error}").into())
    }
}
