//! Results on standard output, as text or JSON; messages on standard error.

use std::fmt::Display;
use std::io::{self, Write};

use clap::ValueEnum;
use serde::Serialize;

use crate::words::visible;

/// Why a command failed.
#[derive(Debug)]
pub(super) enum Failure {
    /// The reader of standard output has closed it; nothing is reported.
    BrokenPipe,
    /// A message for standard error.
    Message(String),
}

impl<E: Display> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Message(error.to_string())
    }
}

/// The exit code of a command, or why it failed.
pub(super) type CommandResult = Result<std::process::ExitCode, Failure>;

/// The format of a result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// Text to read.
    #[default]
    Text,
    /// JSON for programs.
    Json,
}

impl Format {
    /// Prints a result as JSON, or as the text of `describe`.
    pub(super) fn print<T: Serialize + ?Sized>(
        self,
        result: &T,
        describe: impl FnOnce(&T) -> String,
    ) -> Result<(), Failure> {
        match self {
            Self::Json => json(result),
            Self::Text => text(&describe(result)),
        }
    }
}

/// A number with its noun: `1 repeat`, `2 repeats`.
pub(super) fn counted(number: u64, thing: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{number} {thing}{plural}")
}

/// Writes text to standard output, with control characters escaped.
pub(super) fn text(text: &str) -> Result<(), Failure> {
    raw(visible(text).as_bytes())
}

/// Writes a value to standard output as JSON.
pub(super) fn json(value: &(impl Serialize + ?Sized)) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value)?;
    raw((ascii_controls(&text) + "\n").as_bytes())
}

/// Writes a message to standard error, with control characters escaped.
pub(super) fn message(text: &str) {
    // There is nowhere left to report an error.
    let _ = writeln!(io::stderr(), "{}", visible(text));
}

/// Writes what is odd to standard error; each warning begins with its place.
pub(super) fn warnings(warnings: &[impl Display]) {
    for warning in warnings {
        message(&format!("warning: {warning}"));
    }
}

/// Writes notes to standard error.
pub(super) fn notes(notes: &[impl Display]) {
    for note in notes {
        message(&format!("note: {note}"));
    }
}

/// Writes bytes to standard output as they are; they must not quote input.
pub(super) fn raw(bytes: &[u8]) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    let written = stdout.write_all(bytes).and_then(|()| stdout.flush());
    written.map_err(|error| match error.kind() {
        io::ErrorKind::BrokenPipe => Failure::BrokenPipe,
        _ => Failure::Message(format!("standard output: {error}")),
    })
}

/// Escapes the control characters that JSON leaves as they are (U+007F to U+009F).
fn ascii_controls(json: &str) -> String {
    let escaped = |c: char| match c {
        '\u{7f}'..='\u{9f}' => format!("\\u{:04x}", u32::from(c)).chars().collect(),
        c => vec![c],
    };
    json.chars().flat_map(escaped).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_escaped() {
        assert_eq!(
            visible("a\u{1b}[31mb\nc\u{9b}2J"),
            "a\\u{1b}[31mb\nc\\u{9b}2J"
        );
        let json = ascii_controls(&serde_json::to_string("x\u{1b}\u{9b}").unwrap());
        assert_eq!(json, "\"x\\u001b\\u009b\"");
        assert_eq!(
            serde_json::from_str::<String>(&json).unwrap(),
            "x\u{1b}\u{9b}"
        );
    }
}
