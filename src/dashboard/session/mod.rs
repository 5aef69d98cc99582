//! Dashboards on a terminal: the loop between events, keys, signals and frames.
//!
//! Events of the run are read a few times per second, however many there are, so that the
//! dashboard costs the same at any speed of evolution. Keys act at once. A frame is drawn when
//! something has changed and the terminal has taken the previous frame.

mod loader;
mod runs;
mod save;
mod source;
mod wait;

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, after};
use ratatui::crossterm::event::Event as Typed;

pub use runs::{RunsExit, RunsSession};
pub use save::Exports;
pub use source::{Live, Source};
pub use wait::Exit;

use super::app::App;
use super::context::{Effect, Input, Mouse, ViewContext};
use super::keys::Key;
use super::terminal::{Job, Terminal};
use crate::lab::inspection::Archive;
use crate::lab::{Liveness, Manifest, News, lasting_experiment};
use loader::Loader;
use wait::{WakeUp, wait};

/// Interval at which a background program checks whether it is in the foreground again.
const BACKGROUND: Duration = Duration::from_millis(250);

/// Interval at which news of the run is read. Nobody can read faster generations, and every
/// changed number costs bytes.
const NEWS: Duration = Duration::from_millis(200);

/// Interval at which the run folder is measured.
const MEASURE: Duration = Duration::from_secs(10);

/// Shortest time between two frames, which limits redraws for a repeating key.
const GAP: Duration = Duration::from_millis(25);

/// The dashboard of one run on a terminal.
pub struct Session<'s> {
    app: App,
    loader: Loader,
    terminal: &'s mut Terminal,
    source: Source<'s>,
    /// Whether the dashboard was opened from a list of runs.
    has_back: bool,
    /// Time between two ticks.
    period: Duration,
    /// The run folder.
    folder: &'s Path,
    exports: Exports,
    ticked: Instant,
    /// When news was last read, when the folder was last measured, and when a frame was last drawn.
    read: Option<Instant>,
    measured: Option<Instant>,
    drawn: Option<Instant>,
    /// Whether a change may not have been drawn yet.
    due: bool,
}

impl<'s> Session<'s> {
    /// Creates a session over the run in `folder`, whose populations come from `archive`.
    ///
    /// # Errors
    /// When the loader thread cannot be started.
    pub fn new(
        app: App,
        archive: Archive,
        source: Source<'s>,
        folder: &'s Path,
        terminal: &'s mut Terminal,
        frames_per_second: f64,
    ) -> io::Result<Self> {
        Ok(Self {
            app,
            loader: Loader::start(archive)?,
            terminal,
            source,
            has_back: false,
            period: Duration::from_secs_f64(1.0 / frames_per_second.clamp(0.1, 60.0)),
            folder,
            exports: Exports::default(),
            ticked: Instant::now(),
            read: None,
            measured: None,
            drawn: None,
            due: true,
        })
    }

    /// Lets the back key end the session from the overview, for a session opened from a list of
    /// runs.
    #[must_use]
    pub fn with_back(mut self) -> Self {
        self.has_back = true;
        self.app = self.app.with_back(true);
        self
    }

    /// Shows the run until the session ends.
    ///
    /// The screen is kept; it is restored when the terminal is dropped.
    ///
    /// # Errors
    /// When a frame cannot be drawn.
    pub fn run(mut self, signals: &Receiver<i32>) -> io::Result<Exit> {
        if self.appear().is_err() {
            return Ok(Exit::HungUp);
        }
        loop {
            if let Some(exit) = self.tick() {
                return Ok(exit);
            }
            self.draw()?;
            let woken = self.wait(signals);
            if let Some(exit) = self.act(woken) {
                return Ok(exit);
            }
            if self.terminal.is_closed() {
                return Ok(Exit::Panicked);
            }
        }
    }

    /// Takes the screen, unless the program is in the background.
    fn appear(&mut self) -> io::Result<()> {
        self.terminal.go_on()?;
        self.resize();
        Ok(())
    }

    fn period(&self) -> Duration {
        if self.terminal.is_shown() {
            self.period
        } else {
            self.period.max(BACKGROUND)
        }
    }

    /// Passes the elapsed time to the dashboard once per period, and reads news of the run.
    fn tick(&mut self) -> Option<Exit> {
        let elapsed = self.ticked.elapsed();
        let first = self.app.context().clock.is_zero();
        if elapsed < self.period() && !first {
            return None;
        }
        self.ticked = Instant::now();
        self.due = true;
        if self.read.is_none_or(|read| read.elapsed() >= NEWS)
            && let Some(exit) = self.read_news()
        {
            return Some(exit);
        }
        if self
            .measured
            .is_none_or(|measured| measured.elapsed() >= MEASURE)
        {
            self.measured = Some(Instant::now());
            self.loader.measure();
        }
        let effects = self.app.update(Input::Tick(elapsed));
        if let Some(exit) = self.run_effects(effects) {
            return Some(exit);
        }
        let hidden = !self.terminal.is_shown();
        (hidden && self.appear().is_err()).then_some(Exit::HungUp)
    }

    /// Reads all news of the run.
    fn read_news(&mut self) -> Option<Exit> {
        self.read = Some(Instant::now());
        let mut news = self.source.news().into_iter();
        news.find_map(|news| self.handle(news))
    }

    /// Handles one piece of news.
    fn handle(&mut self, news: News) -> Option<Exit> {
        let effects = match news {
            News::Event(event) => self.app.update(Input::Event(Box::new(event))),
            News::Trouble(message) => self.app.update(Input::Message(message)),
            News::LastSign(sign) => self.app.update(Input::LastSign(sign)),
            News::Run(manifest) => {
                self.switch_to(*manifest);
                Vec::new()
            }
            News::Liveness(Liveness::Computing) => Vec::new(),
            News::Liveness(life) => {
                if matches!((&self.source, life), (Source::Live(_), Liveness::Silent)) {
                    return Some(Exit::Failed);
                }
                if let Some(text) = describe(life) {
                    self.show_message(text);
                }
                self.app.update(Input::Closed)
            }
        };
        self.run_effects(effects)
    }

    /// Switches to another run that has replaced this one in the folder. The same run is left
    /// as it is.
    fn switch_to(&mut self, manifest: Manifest) {
        let context = self.app.context();
        if (&manifest.scenario, manifest.seed)
            == (context.experiment.scenario(), context.experiment.seed())
        {
            return;
        }
        let (look, keys) = (context.look.clone(), context.keys.clone());
        let (mode, folder, has_back) = (context.mode, context.folder.clone(), context.has_back);
        let switched = lasting_experiment(manifest.scenario, manifest.seed)
            .map_err(|error| error.to_string())
            .and_then(|experiment| {
                let archive = Archive::new(experiment, self.folder, None);
                self.loader = Loader::start(archive).map_err(|error| error.to_string())?;
                Ok(
                    App::new(ViewContext::new(experiment, folder, mode, look, keys))
                        .with_back(has_back),
                )
            });
        match switched {
            Ok(app) => {
                self.app = app;
                self.resize();
                self.show_message("another run has taken the place of this one");
            }
            Err(error) => self.show_message(&error),
        }
    }

    /// Draws if something has changed and the terminal is ready; otherwise the frame is drawn
    /// as soon as the terminal has taken the previous one.
    fn draw(&mut self) -> io::Result<()> {
        if self.due && self.terminal.is_ready() && self.gap().is_zero() {
            self.due = false;
            if self.app.take_dirty() {
                let app = &self.app;
                self.terminal.draw(|frame| app.draw(frame))?;
                self.drawn = Some(Instant::now());
            }
        }
        Ok(())
    }

    /// Returns the time until the next frame may be drawn.
    fn gap(&self) -> Duration {
        let since = self.drawn.map_or(GAP, |drawn| drawn.elapsed());
        GAP.min(self.period).saturating_sub(since)
    }

    fn wait(&self, signals: &Receiver<i32>) -> WakeUp<Input> {
        let mut left = self.period().saturating_sub(self.ticked.elapsed());
        // A terminal that is not ready wakes the session when it is.
        if self.due && self.terminal.is_ready() {
            left = left.min(self.gap());
        }
        wait(self.terminal, signals, &self.loader.loaded, &after(left))
    }

    fn act(&mut self, woken: WakeUp<Input>) -> Option<Exit> {
        match woken {
            WakeUp::Time | WakeUp::Drawn | WakeUp::Silence => None,
            WakeUp::End(exit) => Some(exit),
            WakeUp::Typed(typed) => self.typed(typed),
            WakeUp::News(loaded) => {
                // A choice of the user is shown at once, news of evolution with the next tick.
                self.due |= !self.app.context().follows();
                let effects = self.app.update(loaded);
                self.run_effects(effects)
            }
            WakeUp::Job(Job::Resize) => {
                self.resize();
                None
            }
            WakeUp::Job(Job::Suspend) => {
                self.terminal.suspend();
                None
            }
            WakeUp::Job(Job::Continue) => self.appear().is_err().then_some(Exit::HungUp),
        }
    }

    /// Handles a key and all keys pressed since, then reads the run's reply.
    fn typed(&mut self, typed: Typed) -> Option<Exit> {
        let mut typed = Some(typed);
        while let Some(event) = typed {
            if let Some(input) = input(&event) {
                self.due = true;
                let effects = self.app.update(input);
                if let Some(exit) = self.run_effects(effects) {
                    return Some(exit);
                }
            }
            typed = self.terminal.keys.try_recv().ok();
        }
        self.read_news()
    }

    fn resize(&mut self) -> Option<Exit> {
        let size = self.terminal.resize();
        self.due = true;
        let effects = self.app.update(Input::Resize(size.width, size.height));
        self.run_effects(effects)
    }

    fn run_effects(&mut self, effects: Vec<Effect>) -> Option<Exit> {
        for effect in effects {
            match effect {
                Effect::Quit => return Some(Exit::Left),
                Effect::Back if self.has_back => return Some(Exit::Left),
                Effect::Back => {}
                Effect::Detach => return Some(Exit::Detached),
                Effect::Suspend => {
                    if !self.terminal.ask_to_suspend() {
                        self.show_message(
                            "cannot suspend: no shell is there to resume the program",
                        );
                    }
                }
                Effect::Redraw => {
                    if self.appear().is_err() {
                        return Some(Exit::HungUp);
                    }
                }
                Effect::Load { generation } => self.loader.load(generation),
                Effect::Export(export) => {
                    let keys = &self.app.context().keys;
                    let said = self.exports.write(&export, Path::new("."), keys);
                    let said = said.unwrap_or_else(|error| format!("{}: {error}", export.name));
                    self.show_message(&said);
                }
                Effect::RemoveExport => {
                    let said = self.exports.remove_last();
                    self.show_message(&said);
                }
                steer => self.source.steer(&steer),
            }
        }
        None
    }

    fn show_message(&mut self, text: &str) {
        self.due = true;
        // A message has no effects.
        let _none = self.app.update(Input::Message(text.to_owned()));
    }
}

/// Returns the message about a run that is not being computed.
fn describe(life: Liveness) -> Option<&'static str> {
    match life {
        Liveness::Computing | Liveness::Over => None,
        Liveness::Absent => Some("the run folder is gone; waiting for it to come back"),
        Liveness::Silent => {
            Some("no sign of life: the run has crashed or hangs, or its folder cannot be reached")
        }
        Liveness::Stopped => Some("no process computes this run; it can be resumed"),
    }
}

/// Returns the input of a terminal event, or `None` for events that the dashboard ignores.
fn input(typed: &Typed) -> Option<Input> {
    match typed {
        Typed::Key(event) => Key::of(*event).map(Input::Key),
        Typed::Mouse(event) => Mouse::of(*event).map(Input::Mouse),
        _ => None,
    }
}
