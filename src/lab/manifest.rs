//! `run.json`: the scenario and the seed of a run, and how it was started.

use std::path::Path;
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use super::keep::Keep;
use crate::scenario::Scenario;
use crate::words::shell_word;

/// Version of the format of `run.json`.
pub const MANIFEST_FORMAT: u32 = 1;

/// The content of `run.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// Version of this format.
    pub format: u32,
    /// The complete scenario, with all defaults and settings.
    pub scenario: Scenario,
    /// Seed of all random streams.
    pub seed: u64,
    /// The generations whose checkpoints are kept; `None` means thinned.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub keep: Option<Keep>,
    /// How the run was started.
    pub started: Invocation,
    /// How it was resumed, once for each time.
    pub resumed: Vec<Invocation>,
}

impl Manifest {
    /// Returns the command lines that determine the result, quoted for a shell: the one that
    /// started the run, and those that changed its generation limit.
    #[must_use]
    pub fn commands(&self) -> Vec<String> {
        let further = |resumed: &&Invocation| {
            let words = &resumed.command_line;
            words.iter().any(|word| word.starts_with("--generations"))
        };
        let further = self.resumed.iter().filter(further);
        let all = std::iter::once(&self.started).chain(further);
        all.map(Invocation::command).collect()
    }
}

/// One start of the program on a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Invocation {
    /// Version of the program.
    pub version: String,
    /// Commit that the program was built from.
    pub commit: String,
    /// Name of the machine.
    pub host: String,
    /// The command line.
    pub command_line: Vec<String>,
    /// The time, in UTC.
    pub time: String,
    /// Computing threads.
    pub threads: usize,
}

impl Invocation {
    /// Returns the present start of the program.
    #[must_use]
    pub fn now(threads: usize) -> Self {
        let lossy = |text: std::ffi::OsString| text.to_string_lossy().into_owned();
        let mut command_line: Vec<_> = std::env::args_os().map(lossy).collect();
        // The path of the program says nothing about the run.
        if let Some(program) = command_line.first_mut() {
            let name = Path::new(program)
                .file_name()
                .map(|name| name.to_string_lossy().into_owned());
            *program = name.unwrap_or_default();
        }
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: env!("MAXQ_LAB_COMMIT").to_owned(),
            host: host_name(),
            command_line,
            time: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
            threads,
        }
    }

    /// Returns the command line, quoted for a shell.
    #[must_use]
    pub fn command(&self) -> String {
        let words = self.command_line.iter().map(|word| shell_word(word));
        words.collect::<Vec<_>>().join(" ")
    }
}

/// The name of this machine.
pub(super) fn host_name() -> String {
    let system = rustix::system::uname();
    system.nodename().to_string_lossy().into_owned()
}
