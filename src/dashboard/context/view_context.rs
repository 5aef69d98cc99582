//! What the person has chosen to look at, over what there is to see.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use super::history::RunHistory;
use super::pace::Pace;
use super::rollout_player::{RolloutPlayer, Subject};
use crate::dashboard::keys::KeyMap;
use crate::dashboard::look::{Look, Paint};
use crate::dashboard::view_id::ViewId;
use crate::evolution::{GenerationRecord, RankedRecord};
use crate::hierarchy::{Tree, parse};
use crate::lab::{AnyExperiment, overrides};
use crate::scenario::Scenario;
use crate::worlds::Catalogue;
use crate::worlds::scene::Scenery;

/// Generations a second while time runs through them.
const PLAYED_PER_SECOND: u32 = 4;

/// How long a message is new.
const MESSAGE_TIME: Duration = Duration::from_secs(5);
/// Messages that are kept.
const LOG: usize = 100;

/// How the dashboard stands to its run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// The run is this process's.
    Live,
    /// The run is another process's; it is followed and cannot be steered.
    Watch,
    /// The run is not going on.
    Replay,
}

/// The generation that is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShownGeneration {
    /// The latest.
    Latest,
    /// The one with this number.
    At(u64),
}

/// The individual that is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chosen {
    /// The best of the generation shown.
    Best,
    /// The one with this id.
    Id(u64),
}

/// What evolution is doing, as far as the events tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activity {
    /// The primitive subtasks are trained.
    Training,
    /// Generations live.
    Running,
    /// The generation under way lives on, then evolution waits.
    Stepping,
    /// It waits.
    Paused,
    /// It was told to stop and saves its state.
    Stopping,
    /// It was stopped, or died, before it was over.
    Stopped,
    /// It is over.
    Finished,
}

/// What every view reads: the run, and what the person has chosen to see of it.
pub struct ViewContext {
    /// The scenario and its world.
    pub experiment: &'static dyn AnyExperiment,
    /// The run folder, for people.
    pub folder: String,
    /// The settings in which the scenario departs from the embedded one of its name.
    pub changed: Vec<String>,
    /// The rollout of the individual that is looked at.
    pub player: RolloutPlayer,
    /// How the dashboard stands to its run.
    pub mode: Mode,
    /// Themes and signs.
    pub look: Look,
    /// Which key does what.
    pub keys: KeyMap,
    /// Columns and rows of the terminal.
    pub size: (u16, u16),
    /// The individual that is shown.
    pub chosen: Chosen,
    /// The node of the hierarchy that is selected, if the hierarchy has as many.
    pub node: usize,
    /// The individual that others are compared with, if the person has named one.
    pub marked: Option<u64>,
    /// The panel of the overview that keys act on.
    pub focus: ViewId,
    /// Time that has gone by, the sum of all ticks.
    pub clock: Duration,
    /// How fast the run goes.
    pub pace: Pace,
    /// Whether time runs through the generations.
    pub playing: bool,
    /// Whether the dashboard was opened from somewhere that going back leads to.
    pub within: bool,
    pub(in crate::dashboard) stepping: bool,
    pub(in crate::dashboard) stopping: bool,
    pub(in crate::dashboard) closed: bool,
    time: ShownGeneration,
    live: RunHistory,
    held: Option<RunHistory>,
    played: Duration,
    log: VecDeque<(String, Duration)>,
}

impl ViewContext {
    /// A context at the beginning of a run.
    #[must_use]
    pub fn new(
        experiment: &'static dyn AnyExperiment,
        folder: String,
        mode: Mode,
        look: Look,
        keys: KeyMap,
    ) -> Self {
        let changed = overrides(experiment.scenario());
        Self {
            experiment,
            folder,
            changed: changed.iter().map(ToString::to_string).collect(),
            player: RolloutPlayer::new(experiment),
            mode,
            look,
            keys,
            size: (80, 24),
            chosen: Chosen::Best,
            node: 0,
            marked: None,
            focus: ViewId::Arena,
            clock: Duration::ZERO,
            pace: Pace::default(),
            playing: false,
            within: false,
            stepping: false,
            stopping: false,
            closed: mode == Mode::Replay,
            time: ShownGeneration::Latest,
            live: RunHistory::default(),
            held: None,
            played: Duration::ZERO,
            log: VecDeque::new(),
        }
    }

    /// The scenario.
    #[must_use]
    pub fn scenario(&self) -> &'static Scenario {
        self.experiment.scenario()
    }

    /// The world's subtasks.
    #[must_use]
    pub fn catalogue(&self) -> &'static Catalogue {
        self.experiment.catalogue()
    }

    /// What there is to see of the world.
    #[must_use]
    pub fn scenery(&self) -> &'static Scenery {
        self.experiment.scenery()
    }

    /// The run as it is, whatever is shown.
    #[must_use]
    pub fn live_history(&self) -> &RunHistory {
        &self.live
    }

    /// The run as it is shown: as it is, or as it was when the view was frozen.
    #[must_use]
    pub fn history(&self) -> &RunHistory {
        self.held.as_ref().unwrap_or(&self.live)
    }

    pub(in crate::dashboard) fn live_history_mut(&mut self) -> &mut RunHistory {
        &mut self.live
    }

    /// Whether the view is frozen.
    #[must_use]
    pub fn frozen(&self) -> bool {
        self.held.is_some()
    }

    /// Freezes the view or lets it go.
    pub fn toggle_freeze(&mut self) {
        self.held = match self.held {
            Some(_) => None,
            None => Some(self.live.clone()),
        };
    }

    /// What evolution is doing.
    #[must_use]
    pub fn activity(&self) -> Activity {
        let live = &self.live;
        match live.progress() {
            _ if live.ending().is_some() => Activity::Finished,
            _ if self.closed => Activity::Stopped,
            _ if self.stopping => Activity::Stopping,
            _ if live.paused() => Activity::Paused,
            Some(progress) if progress.generation == 0 => Activity::Training,
            None if live.latest().is_none() => Activity::Training,
            _ if self.stepping => Activity::Stepping,
            _ => Activity::Running,
        }
    }

    /// Sign, word and paint of what evolution is doing.
    pub(in crate::dashboard) fn activity_mark(&self) -> (&'static str, &'static str, Paint) {
        let signs = self.look.signs;
        match self.activity() {
            Activity::Training => (signs.running, "TRAINING", Paint::Good),
            Activity::Running => (signs.running, "RUNNING", Paint::Good),
            Activity::Stepping => (signs.stepping, "STEPPING", Paint::Notice),
            Activity::Paused => (signs.paused, "PAUSED", Paint::Notice),
            Activity::Stopping => (signs.stopped, "STOPPING", Paint::Bad),
            Activity::Stopped if self.mode == Mode::Replay => {
                (signs.stopped, "UNFINISHED", Paint::Notice)
            }
            Activity::Stopped => (signs.stopped, "STOPPED", Paint::Bad),
            Activity::Finished => (signs.finished, "FINISHED", Paint::Good),
        }
    }

    /// The generation that the person travelled to.
    #[must_use]
    pub fn time(&self) -> ShownGeneration {
        self.time
    }

    /// The generation that is shown; `None` before the first has lived.
    #[must_use]
    pub fn shown(&self) -> Option<&Arc<GenerationRecord>> {
        let model = self.history();
        match self.time {
            ShownGeneration::Latest => model.latest(),
            ShownGeneration::At(number) => model.generation(number).or_else(|| model.latest()),
        }
    }

    /// Whether what is shown is not the latest generation there is.
    #[must_use]
    pub fn is_in_the_past(&self) -> bool {
        let number = |record: Option<&Arc<GenerationRecord>>| record.map(|r| r.generation);
        number(self.shown()) != number(self.live.latest())
    }

    /// Travels to the generation with this number, or the nearest that there is; the
    /// last one is followed as evolution goes on.
    pub fn travel_to(&mut self, number: u64) {
        let generations = self.history().generations();
        let (Some(first), Some(last)) = (generations.first(), generations.last()) else {
            return;
        };
        let (first, last) = (first.generation, last.generation);
        self.time = match number {
            number if number >= last => ShownGeneration::Latest,
            number => ShownGeneration::At(number.max(first)),
        };
    }

    /// Travels some generations on, or back.
    pub fn travel_by(&mut self, by: isize) {
        let generations = self.history().generations();
        let shown = self.shown().map(|record| record.generation);
        let here = generations
            .iter()
            .position(|record| Some(record.generation) == shown);
        let there = here.unwrap_or(0).saturating_add_signed(by);
        let there = there.min(generations.len().saturating_sub(1));
        if let Some(number) = generations.get(there).map(|record| record.generation) {
            self.travel_to(number);
        }
    }

    /// Starts or ends running through the generations; from the latest it begins anew.
    pub fn toggle_play(&mut self) {
        self.playing = !self.playing;
        self.played = Duration::ZERO;
        if self.playing && self.time == ShownGeneration::Latest {
            self.travel_to(0);
        }
    }

    /// Lets time go by. Whether anything but the clock has changed.
    pub(in crate::dashboard) fn tick(&mut self, elapsed: Duration) -> bool {
        self.clock += elapsed;
        if matches!(self.activity(), Activity::Running | Activity::Stepping) {
            self.pace.tick(elapsed);
        }
        if !self.playing {
            return false;
        }
        self.played += elapsed;
        let period = Duration::from_secs(1) / PLAYED_PER_SECOND;
        let before = self.time;
        while self.played >= period && self.playing {
            self.played -= period;
            self.travel_by(1);
            self.playing = self.time != ShownGeneration::Latest;
        }
        before != self.time
    }

    /// The selected individual of the generation shown; the best where the chosen one
    /// did not live in it.
    #[must_use]
    pub fn selected(&self) -> Option<&RankedRecord> {
        let individuals = &self.shown()?.individuals;
        let chosen = match self.chosen {
            Chosen::Best => None,
            Chosen::Id(id) => individuals.iter().find(|individual| individual.id == id),
        };
        chosen.or_else(|| individuals.first())
    }

    /// Keeps the selected individual to compare others with.
    pub fn mark(&mut self) {
        if let Some(id) = self.selected().map(|individual| individual.id) {
            self.marked = Some(id);
            self.show_message(format!(
                "individual {id} is marked: others are compared with it"
            ));
        }
    }

    /// The individual that is looked at, and the one of its generation that it is compared
    /// with: the marked one, else the best, else the second.
    #[must_use]
    pub fn rivals(&self) -> Option<[&RankedRecord; 2]> {
        let (generation, selected) = self.inspected()?;
        let individuals = &self.live.generation(generation)?.individuals;
        let mut others = individuals.iter().filter(|other| other.id != selected.id);
        let marked = others.clone().find(|other| Some(other.id) == self.marked);
        Some([selected, marked.or_else(|| others.next())?])
    }

    /// The hierarchy of an individual; `None` where its text is none of this world.
    #[must_use]
    pub fn tree(&self, individual: &RankedRecord) -> Option<Tree> {
        parse(&individual.tree, self.catalogue()).ok()
    }

    /// The individual on the player as it was in the generation that it was taken from, else
    /// the selected one of the generation shown; with the number of the generation.
    #[must_use]
    pub fn inspected(&self) -> Option<(u64, &RankedRecord)> {
        let staged = self.player.subject().and_then(|subject| {
            let record = self.live.generation(subject.generation)?;
            let mut individuals = record.individuals.iter();
            let staged = individuals.find(|individual| individual.id == subject.id)?;
            Some((record.generation, staged))
        });
        staged.or_else(|| Some((self.shown()?.generation, self.selected()?)))
    }

    /// The hierarchy of that individual.
    #[must_use]
    pub fn inspected_tree(&self) -> Option<Tree> {
        self.tree(self.inspected()?.1)
    }

    /// The node of a hierarchy that is selected: the last where it has not so many.
    #[must_use]
    pub fn node_in(&self, tree: &Tree) -> usize {
        self.node.min(tree.nodes().len().saturating_sub(1))
    }

    /// The individual that should be on the player.
    pub(in crate::dashboard) fn wanted(&self) -> Option<Subject> {
        Some(Subject {
            generation: self.shown()?.generation,
            id: self.selected()?.id,
        })
    }

    /// Whether evolution chooses what is on the player.
    pub(in crate::dashboard) fn follows(&self) -> bool {
        self.mode != Mode::Replay
            && self.chosen == Chosen::Best
            && self.time == ShownGeneration::Latest
            && !self.frozen()
    }

    /// Says something to the person.
    pub fn show_message(&mut self, text: impl Into<String>) {
        if self.log.len() == LOG {
            self.log.pop_front();
        }
        self.log.push_back((text.into(), self.clock));
    }

    /// What was said and when, the latest last.
    #[must_use]
    pub fn log(&self) -> &VecDeque<(String, Duration)> {
        &self.log
    }

    /// What was said last, while it is new.
    #[must_use]
    pub fn message(&self) -> Option<&str> {
        let (text, since) = self.log.back()?;
        let new = self.clock.saturating_sub(*since) <= MESSAGE_TIME;
        (new).then_some(text)
    }
}
