//! Arguments that several commands share.

use std::path::Path;

use clap::Args;

use super::output::Failure;
use crate::scenario::{EMBEDDED, Scenario};

/// A scenario with changes.
#[derive(Clone, Debug, Args)]
pub(super) struct Source {
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

impl Source {
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
