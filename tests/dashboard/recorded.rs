//! Recorded runs, and dashboards over them.

use std::path::PathBuf;
use std::sync::OnceLock;
use std::time::Duration;

use maxq_lab::dashboard::keys::KeyMap;
use maxq_lab::dashboard::look::{Look, Signs, Theme};
use maxq_lab::dashboard::{App, Effect, Input, Mode, OffscreenDashboard, ViewContext};
use maxq_lab::hierarchy::Glyphs;
use maxq_lab::lab::inspection::{Archive, Start};
use maxq_lab::lab::{AnyExperiment, Event, Keep, Recording, RunOptions, lasting_experiment};
use maxq_lab::scenario::Scenario;
use tempfile::TempDir;

use super::common;

/// A recorded run.
pub struct Recorded {
    pub experiment: &'static dyn AnyExperiment,
    pub events: Vec<Event>,
    pub folder: PathBuf,
    _parent: TempDir,
}

impl Recorded {
    /// Records a run of this scenario with seed 1.
    pub fn new(scenario: &Scenario) -> Self {
        Self::keeping(scenario, Keep::All)
    }

    /// Records such a run that keeps the individuals of some generations only.
    pub fn keeping(scenario: &Scenario, keep: Keep) -> Self {
        let parent = tempfile::tempdir().unwrap();
        let folder = parent.path().join("run");
        let options = RunOptions {
            keep: Some(keep),
            ..common::threads(1)
        };
        common::run_in(&folder, scenario, 1, &options);
        Self {
            experiment: lasting_experiment(scenario.clone(), 1).unwrap(),
            events: Recording::read(&folder).unwrap().events,
            folder,
            _parent: parent,
        }
    }

    /// Returns a dashboard without events.
    pub fn blank(&self, mode: Mode, theme: &str, glyphs: Glyphs) -> Screen {
        self.blank_from(None, mode, theme, glyphs)
    }

    /// Returns the same, opened from a list of runs.
    pub fn blank_with_back(&self) -> Screen {
        let app = self.app(Mode::Replay, "dark", Glyphs::Unicode);
        self.offscreen(app.with_back(true))
    }

    fn blank_from(&self, start: Option<Start>, mode: Mode, theme: &str, glyphs: Glyphs) -> Screen {
        self.offscreen(self.app(mode, theme, glyphs).starting_at(start))
    }

    fn app(&self, mode: Mode, theme: &str, glyphs: Glyphs) -> App {
        let look = Look::new(Theme::all(), theme, Signs::of(glyphs));
        let folder = format!("runs/{}-seed1", self.experiment.scenario().name);
        App::new(ViewContext::new(
            self.experiment,
            folder,
            mode,
            look,
            KeyMap::default(),
        ))
    }

    fn offscreen(&self, app: App) -> Screen {
        Screen(OffscreenDashboard::new(
            app,
            Archive::new(self.experiment, &self.folder, None),
        ))
    }

    /// Returns a dashboard over the whole run.
    pub fn screen(&self, theme: &str, glyphs: Glyphs, size: (u16, u16)) -> Screen {
        self.screen_from(None, theme, glyphs, size)
    }

    /// Returns the same, with trials that start in one state.
    pub fn screen_from(
        &self,
        start: Option<Start>,
        theme: &str,
        glyphs: Glyphs,
        (columns, rows): (u16, u16),
    ) -> Screen {
        let mut screen = self.blank_from(start, Mode::Replay, theme, glyphs);
        screen.0.update(Input::Resize(columns, rows));
        for event in &self.events {
            screen.send(event.clone());
        }
        screen.wait(0.1);
        screen
    }
}

/// Returns a short run of the foraging task: six generations of eight individuals.
pub fn foraging() -> &'static Recorded {
    static RUN: OnceLock<Recorded> = OnceLock::new();
    RUN.get_or_init(|| Recorded::new(&common::short(&[])))
}

/// Returns a short run in a world of cells.
pub fn cells(name: &str) -> Recorded {
    let settings = [
        "evolution.generation_limit=2",
        "evolution.trial_step_limit=100",
        "evolution.policy_samples=20",
    ];
    let settings = settings.map(String::from);
    let scenario = Scenario::load(name).unwrap();
    Recorded::new(&scenario.with_settings(&settings).unwrap())
}

/// A dashboard on a screen.
pub struct Screen(pub OffscreenDashboard);

impl Screen {
    /// Sends an event of the run.
    pub fn send(&mut self, event: Event) -> Vec<Effect> {
        self.0.update(Input::Event(Box::new(event)))
    }

    /// Presses keys, given by name.
    pub fn press(&mut self, keys: &str) -> Vec<Effect> {
        let keys = keys.split_whitespace().map(|key| key.parse().unwrap());
        keys.flat_map(|key| self.0.update(Input::Key(key)))
            .collect()
    }

    /// Lets seconds pass, a tenth at a time.
    pub fn wait(&mut self, seconds: f64) {
        for _ in 0..(seconds * 10.0).round() as u32 {
            self.0.update(Input::Tick(Duration::from_millis(100)));
        }
    }

    /// Returns the text on the screen.
    pub fn text(&self) -> String {
        let frame = self.0.app().frame();
        maxq_lab::dashboard::render(&frame, maxq_lab::dashboard::FrameFormat::Text)
    }
}
