//! The dashboard as the command line asks for it.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use clap::Args;
use signal_hook::consts::SIGHUP;

use super::names;
use super::output::{CommandResult, Failure};
use super::signals::SignalWatcher;
use crate::dashboard::keys::KeyMap;
use crate::dashboard::look::{Look, Signs, Theme};
use crate::dashboard::session::{Exit, Session, Source};
use crate::dashboard::terminal::{Abilities, Background, Terminal, is_terminal};
use crate::dashboard::{App, Config, Mode, RunsTable, ViewContext};
use crate::hierarchy::Glyphs;
use crate::lab::AnyExperiment;
use crate::lab::inspection::{Archive, Start};
use crate::words::shell_path;

/// Colours, characters and keys of the dashboard.
#[derive(Clone, Debug, Args)]
pub(super) struct AppearanceArgs {
    /// Colour theme: dark, light, high-contrast, mono, or one from the configuration file
    /// [default: from the configuration file; mono if NO_COLOR is set or the terminal has no
    /// colours; otherwise light or dark, as the terminal's background is].
    #[arg(long, value_name = "NAME", value_parser = names::themes(), hide_possible_values = true)]
    theme: Option<String>,

    /// Draw with ASCII characters only [default: if the locale is not UTF-8, or on the Linux
    /// console].
    #[arg(long)]
    ascii: bool,

    /// Configuration file (TOML) with key bindings and colours [default:
    /// $XDG_CONFIG_HOME/maxq-lab/config.toml or ~/.config/maxq-lab/config.toml, if it exists].
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
}

impl AppearanceArgs {
    /// Reads the configuration file and the environment, for a terminal with these abilities.
    pub(super) fn load(&self, abilities: Abilities) -> Result<Appearance, Failure> {
        let default = || Config::default_path().filter(|path| path.exists());
        let config = match self.config.clone().or_else(default) {
            Some(path) => Config::load(&path)?,
            None => Config::default(),
        };
        let glyphs = if self.ascii || !abilities.braille {
            Glyphs::Ascii
        } else {
            Glyphs::of_locale()
        };
        let no_colour = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let mono = no_colour || !abilities.colour;
        let named = self.theme.clone().or(config.theme);
        let (themes, named) = match (&self.theme, mono) {
            (None, true) => (vec![Theme::mono()], Some(String::from("mono"))),
            _ => (config.themes, named),
        };
        let is_named = named.is_some();
        let first = named.unwrap_or_else(|| String::from(DARK));
        if !themes.iter().any(|theme| theme.name == first) {
            let names: Vec<_> = themes.iter().map(|theme| theme.name.as_str()).collect();
            let message = format!("--theme: found {first:?}; allowed: {}", names.join(", "));
            return Err(Failure::Message(message));
        }
        Ok(Appearance {
            look: Look::new(themes, &first, Signs::of(glyphs)),
            keys: config.keys,
            is_named,
        })
    }
}

/// The theme for a dark background, and for a terminal that does not tell.
const DARK: &str = "dark";
/// The theme for a light background.
const LIGHT: &str = "light";

/// The look and the keys that the user has chosen.
pub(super) struct Appearance {
    /// The look.
    pub(super) look: Look,
    /// The keys.
    pub(super) keys: KeyMap,
    /// Whether the user or the kind of terminal has named the theme.
    is_named: bool,
}

/// The options of commands that show a dashboard.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Dashboard")]
pub(super) struct DashboardArgs {
    #[command(flatten)]
    appearance: AppearanceArgs,

    /// Maximum frames per second; 2 is enough over a slow connection.
    ///
    /// Keys act at once at any rate, and nothing is sent while nothing changes.
    #[arg(long, value_name = "N", default_value_t = 10.0, value_parser = frames)]
    fps: f64,

    /// Select, open and scroll with the mouse (hold Shift to select text in the terminal).
    #[arg(long)]
    mouse: bool,
}

fn frames(text: &str) -> Result<f64, String> {
    let allowed = |frames: &f64| (0.2..=60.0).contains(frames);
    let frames = text.parse().ok().filter(allowed);
    frames.ok_or_else(|| String::from("allowed: 0.2 to 60"))
}

/// Whether the program has a terminal that can show a dashboard.
fn is_possible() -> bool {
    is_terminal() && terminal_type() != "dumb"
}

/// The name of the type of the terminal.
fn terminal_type() -> String {
    std::env::var("TERM").unwrap_or_default()
}

impl DashboardArgs {
    /// The settings, and the signals from now on, for a command that is nothing without a
    /// dashboard.
    ///
    /// Without a terminal this fails and names a command that works there: `instead`.
    pub(super) fn require(
        &self,
        instead: &str,
    ) -> Result<(DashboardSettings, SignalWatcher), Failure> {
        if !is_possible() {
            let message = format!(
                "the dashboard needs a terminal on standard input and output; allowed here: \
                 {instead}"
            );
            return Err(message.into());
        }
        let signals = SignalWatcher::start()?;
        Ok((self.load()?, signals))
    }

    /// As [`Self::require`], for the run in `folder`.
    pub(super) fn require_for_run(
        &self,
        folder: &Path,
    ) -> Result<(DashboardSettings, SignalWatcher), Failure> {
        self.require(&format!("maxq-lab frame {}", shell_path(folder)))
    }

    /// The settings, or `None` if the command runs `headless` or there is no terminal.
    pub(super) fn unless(&self, headless: bool) -> Result<Option<DashboardSettings>, Failure> {
        if headless || !is_possible() {
            return Ok(None);
        }
        self.load().map(Some)
    }

    /// Reads the settings, so that mistakes are reported before anything is computed.
    fn load(&self) -> Result<DashboardSettings, Failure> {
        let appearance = self.appearance.load(Abilities::of_type(&terminal_type()))?;
        Ok(DashboardSettings {
            look: appearance.look,
            keys: appearance.keys,
            suits_terminal: !appearance.is_named,
            fps: self.fps,
            mouse: self.mouse,
            start: None,
        })
    }
}

/// The settings of a dashboard, read and valid.
#[derive(Debug)]
pub(super) struct DashboardSettings {
    pub(super) look: Look,
    keys: KeyMap,
    /// Whether the theme follows the terminal's background.
    suits_terminal: bool,
    fps: f64,
    mouse: bool,
    /// The state in which rollouts start, if one was given.
    start: Option<Start>,
}

impl DashboardSettings {
    /// The same settings with a state in which rollouts start.
    pub(super) fn starting_at(self, start: Option<Start>) -> Self {
        Self { start, ..self }
    }

    /// Shows the dashboard of a run until the user leaves it or something ends it.
    pub(super) fn show(
        mut self,
        experiment: &'static dyn AnyExperiment,
        folder: &Path,
        source: Source<'_>,
        signals: &SignalWatcher,
    ) -> Result<Exit, Failure> {
        let mut terminal = self.terminal()?;
        let session = self.session(experiment, folder, source, &mut terminal)?;
        Ok(session.run(&signals.received)?)
    }

    /// Takes the terminal for a dashboard, and chooses the theme by its background if nobody has
    /// named one.
    pub(super) fn terminal(&mut self) -> Result<Terminal, Failure> {
        // The Linux console prints the question, and its background is dark.
        let asks = self.suits_terminal && !terminal_type().starts_with("linux");
        let terminal = Terminal::open(self.mouse, asks);
        let terminal = terminal.map_err(|error| format!("terminal: {error}"))?;
        if self.suits_terminal {
            let hint = std::env::var("COLORFGBG").unwrap_or_default();
            let background = terminal.background.or(Background::of_hint(&hint));
            let theme = match background {
                Some(Background::Light) => LIGHT,
                Some(Background::Dark) | None => DARK,
            };
            self.look.use_theme(theme);
        }
        Ok(terminal)
    }

    /// A dashboard of a run on a terminal.
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

    /// The table of the runs of the study called `name`.
    pub(super) fn table(&self, name: String, folder: String) -> RunsTable {
        RunsTable::new(name, folder, self.look.clone(), self.keys.clone())
    }

    /// The time between two frames.
    pub(super) fn period(&self) -> Duration {
        Duration::from_secs_f64(1.0 / self.fps)
    }
}

/// The exit code of a command that only shows a dashboard.
pub(super) fn exit_code(exit: Exit) -> CommandResult {
    let code = |signal: i32| u8::try_from(128 + signal).map_or(ExitCode::FAILURE, ExitCode::from);
    Ok(match exit {
        Exit::Left | Exit::Detached => ExitCode::SUCCESS,
        Exit::HungUp => code(SIGHUP),
        Exit::Signal(signal) => code(signal),
        Exit::Panicked | Exit::Failed => ExitCode::FAILURE,
    })
}
