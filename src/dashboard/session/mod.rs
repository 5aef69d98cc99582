//! A dashboard on a terminal: who is asked what, and when a frame is drawn.
//!
//! Events of the run are taken in a few times a second, however many there are, so that
//! showing a run costs the same at any speed of evolution. Keys act, and are answered, when
//! they are pressed. A frame is drawn when something has changed and the terminal has taken
//! the last one.

mod exit;
mod loader;
mod runs;
mod save;
mod source;
mod wait;

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, after};
use crossterm::event::Event as Typed;

pub use exit::Exit;
pub use runs::{RunsExit, RunsSession};
pub use source::{Live, Source};

use super::app::App;
use super::context::{Effect, Input, Mouse, ViewContext};
use super::keys::Key;
use super::terminal::{Job, Terminal};
use crate::lab::inspection::Archive;
use crate::lab::{Liveness, Manifest, News, lasting_experiment};
use loader::{Loaded, Loader};
use wait::{WakeUp, wait};

/// Time between two looks whether the program is in the foreground again.
const BACKGROUND: Duration = Duration::from_millis(250);

/// Time between two looks for news of the run: generations that follow each other faster are
/// read by nobody, and every number that changes costs bytes.
const NEWS: Duration = Duration::from_millis(200);

/// Shortest time between two frames: a key that repeats draws no more often.
const GAP: Duration = Duration::from_millis(25);

/// A dashboard on a terminal.
pub struct Session<'s> {
    app: App,
    loader: Loader,
    terminal: &'s mut Terminal,
    source: Source<'s>,
    /// Whether it was opened from somewhere that a person may want to go back to.
    within: bool,
    /// Time between two frames.
    period: Duration,
    /// The run folder.
    folder: &'s Path,
    ticked: Instant,
    /// When the news were taken in last, and when a frame was drawn.
    heard: Option<Instant>,
    drawn: Option<Instant>,
    /// Whether something may have changed that was not drawn.
    due: bool,
}

impl<'s> Session<'s> {
    /// A session of so many frames a second over the run in a folder, with the run's
    /// populations.
    ///
    /// # Errors
    /// When there can be no thread.
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
            within: false,
            period: Duration::from_secs_f64(1.0 / frames_per_second.clamp(0.1, 60.0)),
            folder,
            ticked: Instant::now(),
            heard: None,
            drawn: None,
            due: true,
        })
    }

    /// A session that was opened from somewhere: going back from the overview leaves it.
    #[must_use]
    pub fn within(mut self) -> Self {
        self.within = true;
        self.app = self.app.within(true);
        self
    }

    /// Shows the run until somebody or something ends it. The run is as it was left then.
    /// The screen is kept: dropping the terminal gives it back.
    ///
    /// # Errors
    /// When a frame cannot be made.
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
        match self.terminal.is_shown() {
            true => self.period,
            false => self.period.max(BACKGROUND),
        }
    }

    /// Takes in the time, once a frame, and the news of the run.
    fn tick(&mut self) -> Option<Exit> {
        let elapsed = self.ticked.elapsed();
        let first = self.app.context().clock.is_zero();
        if elapsed < self.period() && !first {
            return None;
        }
        self.ticked = Instant::now();
        self.due = true;
        if self.heard.is_none_or(|heard| heard.elapsed() >= NEWS)
            && let Some(exit) = self.hear()
        {
            return Some(exit);
        }
        let effects = self.app.update(Input::Tick(elapsed));
        if let Some(exit) = self.run_effects(effects) {
            return Some(exit);
        }
        let hidden = !self.terminal.is_shown();
        (hidden && self.appear().is_err()).then_some(Exit::HungUp)
    }

    /// Takes in all that is new of the run.
    fn hear(&mut self) -> Option<Exit> {
        self.heard = Some(Instant::now());
        let mut news = self.source.news().into_iter();
        news.find_map(|news| self.take_in(news))
    }

    /// Takes in what is new of the run.
    fn take_in(&mut self, news: News) -> Option<Exit> {
        let effects = match news {
            News::Event(event) => self.app.update(Input::Event(Box::new(event))),
            News::Trouble(message) => self.app.update(Input::Message(message)),
            News::Run(manifest) => {
                self.turn_to(*manifest);
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

    /// Turns to another run that took the place of the one before. One that is told again
    /// is taken in again.
    fn turn_to(&mut self, manifest: Manifest) {
        let context = self.app.context();
        if (&manifest.scenario, manifest.seed)
            == (context.experiment.scenario(), context.experiment.seed())
        {
            return;
        }
        let (look, keys) = (context.look.clone(), context.keys.clone());
        let (mode, folder, within) = (context.mode, context.folder.clone(), context.within);
        let turned = lasting_experiment(manifest.scenario, manifest.seed)
            .map_err(|error| error.to_string())
            .and_then(|experiment| {
                let archive = Archive::new(experiment, self.folder, None);
                self.loader = Loader::start(archive).map_err(|error| error.to_string())?;
                Ok(App::new(ViewContext::new(experiment, folder, mode, look, keys)).within(within))
            });
        match turned {
            Ok(app) => {
                self.app = app;
                self.resize();
                self.show_message("another run took the place of the one before");
            }
            Err(error) => self.show_message(&error),
        }
    }

    /// Draws if there is something to draw and the terminal takes it; otherwise it is drawn
    /// when the terminal has taken the frame before.
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

    /// Time until the next frame may be drawn.
    fn gap(&self) -> Duration {
        let since = self.drawn.map_or(GAP, |drawn| drawn.elapsed());
        GAP.min(self.period).saturating_sub(since)
    }

    fn wait(&self, signals: &Receiver<i32>) -> WakeUp<Loaded> {
        let mut left = self.period().saturating_sub(self.ticked.elapsed());
        // A terminal that is not ready tells when it is.
        if self.due && self.terminal.is_ready() {
            left = left.min(self.gap());
        }
        wait(self.terminal, signals, &self.loader.loaded, &after(left))
    }

    fn act(&mut self, woken: WakeUp<Loaded>) -> Option<Exit> {
        match woken {
            WakeUp::Time | WakeUp::Drawn | WakeUp::Silence => None,
            WakeUp::End(exit) => Some(exit),
            WakeUp::Typed(typed) => self.typed(typed),
            WakeUp::News(Loaded { generation, state }) => {
                // What a person chose is shown at once, what evolution did in its time.
                self.due |= !self.app.context().follows();
                let effects = self.app.update(Input::Population { generation, state });
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

    /// Acts on a key and on all that were pressed since, and hears what the run says to it.
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
        self.hear()
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
                Effect::Back if self.within => return Some(Exit::Left),
                Effect::Back => {}
                Effect::Detach => return Some(Exit::Detached),
                Effect::Suspend => {
                    if !self.terminal.ask_to_suspend() {
                        self.show_message("no shell waits that could continue the program");
                    }
                }
                Effect::Redraw => {
                    if self.appear().is_err() {
                        return Some(Exit::HungUp);
                    }
                }
                Effect::Load { generation } => self.loader.load(generation),
                Effect::Export(export) => match save::save(Path::new("."), &export) {
                    Ok(path) => self.show_message(&format!("written: {}", path.display())),
                    Err(error) => self.show_message(&format!("{}: {error}", export.name)),
                },
                steer => self.source.steer(&steer),
            }
        }
        None
    }

    fn show_message(&mut self, text: &str) {
        self.due = true;
        // What is said leads to nothing but its being read.
        let _none = self.app.update(Input::Message(text.to_owned()));
    }
}

/// What is said of a run that is not being computed.
fn describe(life: Liveness) -> Option<&'static str> {
    match life {
        Liveness::Computing | Liveness::Over => None,
        Liveness::Absent => Some("the run folder is gone; waiting for it"),
        Liveness::Silent => {
            Some("no sign of life: the run died or froze, or its folder is out of reach")
        }
        Liveness::Stopped => Some("nobody computes this run; it can be resumed"),
    }
}

/// What was done at the terminal, if it is of any account.
fn input(typed: &Typed) -> Option<Input> {
    match typed {
        Typed::Key(event) => Key::of(*event).map(Input::Key),
        Typed::Mouse(event) => Mouse::of(*event).map(Input::Mouse),
        _ => None,
    }
}
