//! Contract 4: no input makes the program panic. Whatever is wrong with a scenario, a
//! checkpoint, an event log, a run.json, a hierarchy or an argument, the program says
//! which file, where in it, what was found and what is allowed, and exits with 1 (2 for
//! the usage of the command line).
//!
//! Why it matters: files come from other people, other versions and full disks. A panic
//! tells nothing about the file, and a control character that is passed on steers the
//! terminal of whoever looks at the message.
//!
//! The fixtures in `tests/fixtures/scenarios` are `valid.json` with one thing changed each.

#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../common/mod.rs"]
mod common;

mod anything;
mod arguments;
mod control_characters;
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

/// Runs a command that must refuse with an exit code, without a panic and without raw
/// control characters; returns what it says.
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

/// Neither output has a control character but the ends of lines.
fn assert_no_controls(output: &Output) {
    for text in [common::stdout(output), stderr(output)] {
        let control = text.chars().find(|&c| c.is_control() && c != '\n');
        assert_eq!(control, None, "{text:?}");
    }
}

/// Everything of `parts` is said.
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
