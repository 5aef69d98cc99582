//! Contract 5, for the real program in a real terminal: the terminal is restored on every way
//! out, and whatever happens to it, the run is not lost, not slowed and not changed.
//!
//! Why it matters: the dashboard stays open all day over connections that are lost, in shells
//! that stop and continue it, in windows that are resized. A terminal left in raw mode, a run
//! lost with its connection, or a process that spins without its terminal costs a user's work.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../common/mod.rs"]
mod common;
mod jobs;
mod life;
mod others;
mod panics;
mod pty;
mod signals;
mod storms;
mod studies;

use std::fs;
use std::path::{Path, PathBuf};

use maxq_lab::lab::Checkpoint;
use tempfile::TempDir;

use common::{SHORT, lines, wait_until};
use pty::{Pty, program};

/// Settings with which evolution continues until it is stopped: the structures never change, so
/// the population does not converge.
const ENDLESS: &[&str] = &[
    "evolution.variation=none",
    "evolution.generation_limit=100000",
    "evolution.trials_per_generation=64",
];

/// The folder of the run of one test.
struct Place {
    _parent: TempDir,
    folder: PathBuf,
}

impl Place {
    fn new() -> Self {
        let parent = TempDir::new().unwrap();
        let folder = parent.path().join("run");
        Self {
            _parent: parent,
            folder,
        }
    }

    /// Arguments that run a short `smoke` with settings.
    fn run(&self, settings: &[&str]) -> Vec<String> {
        let mut arguments = vec!["run", "smoke", "--threads", "1", "--keep", "none", "--out"];
        arguments.push(self.text());
        for setting in SHORT.iter().chain(settings) {
            arguments.extend(["--set", setting]);
        }
        arguments.into_iter().map(String::from).collect()
    }

    fn text(&self) -> &str {
        self.folder.to_str().unwrap()
    }

    /// The dashboard of an endless run, with more arguments.
    fn start(&self, more: &[&str]) -> Pty {
        let arguments = self.run(ENDLESS);
        let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
        let pty = Pty::start(120, 40, program(&[&arguments, more].concat()));
        pty.wait_for("RUNNING");
        assert!(pty.is_taken());
        pty
    }

    /// Another command for the run folder.
    fn on(&self, command: &str) -> Pty {
        Pty::start(120, 40, program(&[command, self.text()]))
    }

    /// The number of lines in the event log.
    fn lines(&self) -> usize {
        lines(&self.folder.join("events.jsonl"))
    }

    /// Waits for more generations.
    fn wait_for_evolution(&self) {
        let before = self.lines();
        wait_until("evolution", || self.lines() > before + 2);
    }

    /// Asserts that the latest state is saved; the log has a line for the start and for each
    /// generation.
    fn assert_saved(&self) {
        let text = fs::read_to_string(self.folder.join("checkpoint.json")).unwrap();
        let saved = Checkpoint::from_text(&text).unwrap();
        assert_eq!(saved.generation, self.lines() as u64 - 1);
        assert!(!self.folder.join("summary.json").exists());
    }

    /// The generation on the screen.
    fn generation(pty: &Pty) -> Option<u64> {
        let screen = pty.screen();
        let after = screen.lines().next()?.split("generation ").nth(1)?;
        after.split_whitespace().next()?.parse().ok()
    }
}

/// The exit code of work that the user stopped before it was done.
const USER_STOP: u32 = 130;

/// Waits for the end of a program whose terminal may be lost.
fn wait_for_end(pty: &mut Pty, code: u32) {
    let status = pty.ended();
    assert_eq!(status.exit_code(), code, "{}", pty.screen());
}

/// Waits for the end of a program, and for its terminal to be restored.
fn wait_for_good_end(pty: &mut Pty, code: u32) {
    wait_for_end(pty, code);
    pty.wait_given_back();
}

/// Quits and confirms.
fn leave(pty: &mut Pty) {
    pty.press("qy");
    wait_for_good_end(pty, USER_STOP);
}

fn exists(folder: &Path, name: &str) -> bool {
    folder.join(name).exists()
}
