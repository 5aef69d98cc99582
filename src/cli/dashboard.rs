//! The dashboard as the command line asks for it.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use clap::Args;
use signal_hook::consts::SIGHUP;

use super::output::{CommandResult, Failure};
use super::signals::SignalWatcher;
use crate::dashboard::keys::KeyMap;
use crate::dashboard::look::{Look, Signs, Theme};
use crate::dashboard::session::{Exit, Session, Source};
use crate::dashboard::terminal::{Terminal, is_terminal};
use crate::dashboard::{App, Config, Mode, RunsTable, ViewContext};
use crate::hierarchy::Glyphs;
use crate::lab::AnyExperiment;
use crate::lab::inspection::{Archive, Start};

/// How the dashboard looks.
#[derive(Clone, Debug, clap::Args)]
#[command(next_help_heading = "Dashboard")]
pub(super) struct DashboardArgs {
    #[command(flatten)]
    appearance: AppearanceArgs,

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

impl DashboardArgs {
    /// Whether there is a terminal that can show a dashboard.
    pub(super) fn is_possible() -> bool {
        let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
        is_terminal() && !dumb
    }

    /// What a command needs that is nothing without a dashboard: keys and looks, and the
    /// signals from now on. Where there is no terminal it fails, and names a command that
    /// does `instead`.
    pub(super) fn require(
        &self,
        instead: &str,
    ) -> Result<(DashboardSettings, SignalWatcher), Failure> {
        if !Self::is_possible() {
            let message = format!(
                "standard input or output is no terminal that a dashboard could be shown on; \
                 allowed here: {instead}"
            );
            return Err(message.into());
        }
        let signals = SignalWatcher::now()?;
        Ok((self.settings()?, signals))
    }

    /// As above, for a dashboard over the run in a folder.
    pub(super) fn require_for_run(
        &self,
        folder: &Path,
    ) -> Result<(DashboardSettings, SignalWatcher), Failure> {
        self.require(&format!("maxq-lab frame {}", folder.display()))
    }

    /// The person's keys and looks. What is wrong with them is told before anything is
    /// computed.
    pub(super) fn settings(&self) -> Result<DashboardSettings, Failure> {
        let (look, keys) = self.appearance.load()?;
        Ok(DashboardSettings {
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
pub(super) struct DashboardSettings {
    look: Look,
    keys: KeyMap,
    fps: f64,
    mouse: bool,
    /// Where the trials that are watched begin, if the person has said so.
    start: Option<Start>,
}

impl DashboardSettings {
    /// The same, with trials that begin there.
    pub(super) fn starting_at(self, start: Option<Start>) -> Self {
        Self { start, ..self }
    }

    /// Shows a dashboard over a run until somebody or something ends it.
    pub(super) fn show(
        self,
        experiment: &'static dyn AnyExperiment,
        folder: &Path,
        source: Source<'_>,
        signals: &SignalWatcher,
    ) -> Result<Exit, Failure> {
        let mut terminal = self.terminal()?;
        let session = self.session(experiment, folder, source, &mut terminal)?;
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
        experiment: &'static dyn AnyExperiment,
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
        let app =
            App::new(ViewContext::new(experiment, name, mode, look, keys)).starting_at(self.start);
        let archive = Archive::new(experiment, folder, controls);
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
pub(super) fn exit_code(exit: Exit) -> CommandResult {
    let code = |signal: i32| u8::try_from(128 + signal).map_or(ExitCode::FAILURE, ExitCode::from);
    match exit {
        Exit::Left | Exit::Detached => Ok(ExitCode::SUCCESS),
        Exit::HungUp => Ok(code(SIGHUP)),
        Exit::Signal(signal) => Ok(code(signal)),
        Exit::Panicked | Exit::Failed => Ok(ExitCode::FAILURE),
    }
}

/// How the dashboard looks and which keys it has.
#[derive(Clone, Debug, Args)]
pub(super) struct AppearanceArgs {
    /// Colours: dark, light, high-contrast, mono [default: the file's, mono where NO_COLOR
    /// is set, else dark].
    #[arg(long)]
    theme: Option<String>,

    /// Draw with plain ASCII characters [default: where the locale is not UTF-8].
    #[arg(long)]
    ascii: bool,

    /// Keys and colours, a TOML file [default: maxq-lab/config.toml in $XDG_CONFIG_HOME or
    /// ~/.config, if it is there].
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
}

impl AppearanceArgs {
    /// Reads the person's file and the environment.
    pub(super) fn load(&self) -> Result<(Look, KeyMap), Failure> {
        let default = || Config::default_path().filter(|path| path.exists());
        let config = match self.config.clone().or_else(default) {
            Some(path) => Config::load(&path)?,
            None => Config::default(),
        };
        let glyphs = match self.ascii {
            true => Glyphs::Ascii,
            false => Glyphs::of_locale(),
        };
        let no_colour = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let (themes, first) = match &self.theme {
            Some(theme) => (config.themes, theme.clone()),
            None if no_colour => (vec![Theme::mono()], String::from("mono")),
            None => (config.themes, config.theme),
        };
        if !themes.iter().any(|theme| theme.name == first) {
            let names: Vec<_> = themes.iter().map(|theme| theme.name.as_str()).collect();
            let message = format!("--theme: found {first:?}; allowed: {}", names.join(", "));
            return Err(Failure::Message(message));
        }
        Ok((Look::new(themes, &first, Signs::of(glyphs)), config.keys))
    }
}
