//! The dashboard as the command line asks for it.

use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;

use signal_hook::consts::SIGHUP;

use super::appearance::Appearance;
use super::output::{Done, Failure};
use super::signals::Caught;
use crate::dashboard::keys::KeyMap;
use crate::dashboard::look::Look;
use crate::dashboard::session::{Exit, Session, Source};
use crate::dashboard::terminal::{Terminal, is_terminal};
use crate::dashboard::{App, Desk, Mode, RunsTable};
use crate::lab::specimen::{Archive, Bench, Start};

/// How the dashboard looks.
#[derive(Clone, Debug, clap::Args)]
#[command(next_help_heading = "Dashboard")]
pub(super) struct Show {
    #[command(flatten)]
    appearance: Appearance,

    /// Frames a second at most; 2 is enough to follow a run over a slow line.
    ///
    /// Keys act at once all the same, and nothing is sent when nothing has changed.
    #[arg(long, value_name = "N", default_value_t = 10.0, value_parser = frames)]
    fps: f64,

    /// Let the mouse select, open and scroll; the terminal then selects text with Shift alone.
    #[arg(long)]
    mouse: bool,
}

fn frames(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(frames) if (0.2..=60.0).contains(&frames) => Ok(frames),
        _ => Err(String::from("allowed: 0.2 to 60")),
    }
}

impl Show {
    /// Whether there is a terminal that can show a dashboard.
    pub(super) fn is_possible() -> bool {
        let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        is_terminal() && !dumb
    }

    /// What a command needs that is nothing without a dashboard: keys and looks, and the
    /// signals from now on. Where there is no terminal it fails, and names a command that
    /// does `instead`.
    pub(super) fn require(&self, instead: &str) -> Result<(Outfit, Caught), Failure> {
        if !Self::is_possible() {
            let message = format!(
                "standard input or output is no terminal that a dashboard could be shown on; \
                 allowed here: {instead}"
            );
            return Err(message.into());
        }
        let signals = Caught::now()?;
        Ok((self.outfit()?, signals))
    }

    /// As above, for a dashboard over the run in a folder.
    pub(super) fn require_for_run(&self, folder: &Path) -> Result<(Outfit, Caught), Failure> {
        self.require(&format!("maxq-lab frame {}", folder.display()))
    }

    /// The person's keys and looks. What is wrong with them is told before anything is
    /// computed.
    pub(super) fn outfit(&self) -> Result<Outfit, Failure> {
        let (look, keys) = self.appearance.load()?;
        Ok(Outfit {
            look,
            keys,
            fps: self.fps,
            mouse: self.mouse,
            start: None,
        })
    }
}

/// A person's keys and looks, read and found good.
#[derive(Debug)]
pub(super) struct Outfit {
    look: Look,
    keys: KeyMap,
    fps: f64,
    mouse: bool,
    /// Where the trials that are watched begin, if the person has said so.
    start: Option<Start>,
}

impl Outfit {
    /// The same, with trials that begin there.
    pub(super) fn beginning_at(self, start: Option<Start>) -> Self {
        Self { start, ..self }
    }

    /// Shows a dashboard over a run until somebody or something ends it.
    pub(super) fn show(
        self,
        what: &'static dyn Bench,
        folder: &Path,
        source: Source<'_>,
        signals: &Caught,
    ) -> Result<Exit, Failure> {
        let mut terminal = self.terminal()?;
        let session = self.session(what, folder, source, &mut terminal)?;
        Ok(session.run(&signals.heard)?)
    }

    /// The terminal, taken for a dashboard.
    pub(super) fn terminal(&self) -> Result<Terminal, Failure> {
        let terminal = Terminal::open(self.mouse);
        Ok(terminal.map_err(|error| format!("terminal: {error}"))?)
    }

    /// A dashboard over a run on a terminal.
    pub(super) fn session<'s>(
        &self,
        what: &'static dyn Bench,
        folder: &'s Path,
        source: Source<'s>,
        terminal: &'s mut Terminal,
    ) -> Result<Session<'s>, Failure> {
        let (mode, controls) = match &source {
            Source::Live(live) => (Mode::Live, Some(live.controls().clone())),
            Source::Watched(_) => (Mode::Watch, None),
            Source::Recorded(_) => (Mode::Replay, None),
        };
        let name = folder.display().to_string();
        let (look, keys) = (self.look.clone(), self.keys.clone());
        let app = App::new(Desk::new(what, name, mode, look, keys)).beginning_at(self.start);
        let archive = Archive::new(what, folder, controls);
        let session = Session::new(app, archive, source, folder, terminal, self.fps)?;
        Ok(session)
    }

    /// A table of the runs of the study with this name.
    pub(super) fn table(&self, name: String, folder: String) -> RunsTable {
        RunsTable::new(name, folder, self.look.clone(), self.keys.clone())
    }

    /// Time between two frames.
    pub(super) fn period(&self) -> Duration {
        Duration::from_secs_f64(1.0 / self.fps)
    }

    /// Looks like this from now on.
    pub(super) fn wear(&mut self, look: Look) {
        self.look = look;
    }
}

/// The exit code of a session that left nothing behind to be done.
pub(super) fn exit_code(exit: Exit) -> Done {
    let code = |signal: i32| u8::try_from(128 + signal).map_or(ExitCode::FAILURE, ExitCode::from);
    match exit {
        Exit::Left | Exit::Detached => Ok(ExitCode::SUCCESS),
        Exit::HungUp => Ok(code(SIGHUP)),
        Exit::Signal(signal) => Ok(code(signal)),
        Exit::Panicked | Exit::Failed => Ok(ExitCode::FAILURE),
    }
}
