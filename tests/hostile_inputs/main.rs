//! Contract 4: no input makes the program panic. If a scenario, a checkpoint, an event log, a
//! run.json, a hierarchy or an argument is invalid, the error names the file, the place in it,
//! what was found and what is allowed. The exit code is 1, or 2 for invalid arguments.
//!
//! Why it matters: files come from other people, other versions and full disks. A panic says
//! nothing about the file, and a control character in a message controls the terminal of its
//! reader.
//!
//! Each fixture in `tests/fixtures/scenarios` is `valid.json` with one change.

#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../common/mod.rs"]
mod common;

mod anything;
mod arenas;
mod arguments;
mod control_characters;
mod damaged_logs;
mod rules;
mod run_folders;
mod scenario_files;

use std::path::PathBuf;
use std::process::{Command, Output};

use common::{output, program, stderr};

/// A scenario fixture.
fn fixture(name: &str) -> PathBuf {
    let fixtures = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/scenarios");
    fixtures.join(name)
}

/// Runs a command that must fail with an exit code, without a panic and without raw control
/// characters; returns its standard error.
fn refused_with(code: i32, command: &mut Command) -> String {
    let output = output(command);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{command:?}: {said}");
    assert!(!said.contains("panicked"), "{command:?}: {said}");
    assert!(said.starts_with("error: "), "{command:?}: {said}");
    assert_no_controls(&output);
    said
}

fn refused(command: &mut Command) -> String {
    refused_with(1, command)
}

/// Asserts that line ends are the only control characters in both outputs.
fn assert_no_controls(output: &Output) {
    for text in [common::stdout(output), stderr(output)] {
        let control = text.chars().find(|&c| c.is_control() && c != '\n');
        assert_eq!(control, None, "{text:?}");
    }
}

/// Asserts that a message contains all of `parts`.
fn assert_says(said: &str, parts: &[&str]) {
    for part in parts {
        assert!(said.contains(part), "{part:?} is missing in: {said}");
    }
}

fn check(scenario: &PathBuf) -> Command {
    let mut command = program();
    command.arg("check").arg(scenario);
    command
}
