//! The view context: the run, and what the user has chosen to see of it.

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
use crate::lab::{AnyExperiment, LastSign, overrides};
use crate::scenario::Scenario;
use crate::worlds::Catalogue;
use crate::worlds::scene::Scenery;

/// Generations per second while the generations are played.
const PLAYED_PER_SECOND: u32 = 4;

/// Time for which a message is shown.
const MESSAGE_TIME: Duration = Duration::from_secs(5);
/// Number of messages kept in the log.
const LOG: usize = 100;

/// The relation between the dashboard and its run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// This process computes the run.
    Live,
    /// Another process computes the run; the dashboard follows it and cannot steer it.
    Watch,
    /// No process computes the run.
    Replay,
}

/// The generation that the user has chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShownGeneration {
    /// The latest generation.
    Latest,
    /// The generation with this number.
    At(u64),
}

/// The individual that the user has chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chosen {
    /// The best individual of the shown generation.
    Best,
    /// The individual with this id.
    Id(u64),
}

/// The activity of the run, as known from its events.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activity {
    /// Primitive subtasks are being trained.
    Training,
    /// Generations are being evaluated.
    Running,
    /// The current generation is being completed, then evolution pauses.
    Stepping,
    /// Evolution is paused.
    Paused,
    /// Evolution has been told to stop and is saving its state.
    Stopping,
    /// Evolution was interrupted before its end.
    Stopped,
    /// Evolution has finished.
    Finished,
}

/// What every view reads: the run, and what the user has chosen to see of it.
pub struct ViewContext {
    /// The scenario and its world.
    pub experiment: &'static dyn AnyExperiment,
    /// The run folder, as shown to the user.
    pub folder: String,
    /// The size of the run folder in bytes, once it was measured.
    pub folder_bytes: Option<u64>,
    /// The settings in which the scenario differs from the built-in scenario of the same name.
    pub changed: Vec<String>,
    /// The rollout of the inspected individual.
    pub player: RolloutPlayer,
    /// The relation between the dashboard and its run.
    pub mode: Mode,
    /// Themes and signs.
    pub look: Look,
    /// The key map.
    pub keys: KeyMap,
    /// Columns and rows of the terminal.
    pub size: (u16, u16),
    /// The individual that the user has chosen.
    pub chosen: Chosen,
    /// Index of the selected node of the hierarchy; see [`ViewContext::node_in`].
    pub node: usize,
    /// Id of the individual that others are compared with, if the user has marked one.
    pub marked: Option<u64>,
    /// The focused panel of the overview.
    pub focus: ViewId,
    /// Time since the start of the dashboard: the sum of all ticks.
    pub clock: Duration,
    /// The speed of the run.
    pub pace: Pace,
    /// The last sign of the process that computed the run, if it is gone before the end.
    pub last_sign: Option<LastSign>,
    /// Whether the generations are being played.
    pub playing: bool,
    /// Whether the dashboard was opened from a list of runs to which the user can return.
    pub has_back: bool,
    pub(in crate::dashboard) stepping: bool,
    pub(in crate::dashboard) stopping: bool,
    pub(in crate::dashboard) closed: bool,
    time: ShownGeneration,
    live: RunHistory,
    frozen_history: Option<RunHistory>,
    play_time: Duration,
    log: VecDeque<(String, Duration)>,
}

impl ViewContext {
    /// Creates the context of a run without events.
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
            folder_bytes: None,
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
            last_sign: None,
            playing: false,
            has_back: false,
            stepping: false,
            stopping: false,
            closed: mode == Mode::Replay,
            time: ShownGeneration::Latest,
            live: RunHistory::default(),
            frozen_history: None,
            play_time: Duration::ZERO,
            log: VecDeque::new(),
        }
    }

    /// Returns the scenario.
    #[must_use]
    pub fn scenario(&self) -> &'static Scenario {
        self.experiment.scenario()
    }

    /// Returns the world's catalogue of subtasks.
    #[must_use]
    pub fn catalogue(&self) -> &'static Catalogue {
        self.experiment.catalogue()
    }

    /// Returns the scenery of the world.
    #[must_use]
    pub fn scenery(&self) -> &'static Scenery {
        self.experiment.scenery()
    }

    /// Returns the history up to now, whether or not the display is frozen.
    #[must_use]
    pub fn live_history(&self) -> &RunHistory {
        &self.live
    }

    /// Returns the history to be shown: up to now, or up to the moment when the display was
    /// frozen.
    #[must_use]
    pub fn history(&self) -> &RunHistory {
        self.frozen_history.as_ref().unwrap_or(&self.live)
    }

    pub(in crate::dashboard) fn live_history_mut(&mut self) -> &mut RunHistory {
        &mut self.live
    }

    /// Returns whether the display is frozen.
    #[must_use]
    pub fn frozen(&self) -> bool {
        self.frozen_history.is_some()
    }

    /// Freezes or unfreezes the display.
    pub fn toggle_freeze(&mut self) {
        self.frozen_history = match self.frozen_history {
            Some(_) => None,
            None => Some(self.live.clone()),
        };
    }

    /// Returns the activity of the run.
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

    /// Returns sign, word and paint of the activity.
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

    /// Returns the generation that the user has chosen.
    #[must_use]
    pub fn time(&self) -> ShownGeneration {
        self.time
    }

    /// Returns the shown generation, or `None` before the first is complete.
    #[must_use]
    pub fn shown(&self) -> Option<&Arc<GenerationRecord>> {
        let history = self.history();
        match self.time {
            ShownGeneration::Latest => history.latest(),
            ShownGeneration::At(number) => history.generation(number).or_else(|| history.latest()),
        }
    }

    /// Returns whether an earlier generation than the latest is shown.
    #[must_use]
    pub fn is_in_the_past(&self) -> bool {
        let number = |record: Option<&Arc<GenerationRecord>>| record.map(|r| r.generation);
        number(self.shown()) != number(self.live.latest())
    }

    /// Shows the generation with this number, or the nearest one.
    ///
    /// The last generation means that the latest is followed as evolution continues.
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

    /// Moves some generations forward, or back.
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

    /// Starts or stops playing through the generations; from the latest it starts over with the
    /// first.
    pub fn toggle_play(&mut self) {
        self.playing = !self.playing;
        self.play_time = Duration::ZERO;
        if self.playing && self.time == ShownGeneration::Latest {
            self.travel_to(0);
        }
    }

    /// Lets time pass; returns whether anything but the clock has changed.
    pub(in crate::dashboard) fn tick(&mut self, elapsed: Duration) -> bool {
        self.clock += elapsed;
        if matches!(self.activity(), Activity::Running | Activity::Stepping) {
            self.pace.tick(elapsed);
        }
        if !self.playing {
            return false;
        }
        self.play_time += elapsed;
        let period = Duration::from_secs(1) / PLAYED_PER_SECOND;
        let before = self.time;
        while self.play_time >= period && self.playing {
            self.play_time -= period;
            self.travel_by(1);
            self.playing = self.time != ShownGeneration::Latest;
        }
        before != self.time
    }

    /// Returns the selected individual of the shown generation; the best if the chosen one is
    /// not in it.
    #[must_use]
    pub fn selected(&self) -> Option<&RankedRecord> {
        let individuals = &self.shown()?.individuals;
        let chosen = match self.chosen {
            Chosen::Best => None,
            Chosen::Id(id) => individuals.iter().find(|individual| individual.id == id),
        };
        chosen.or_else(|| individuals.first())
    }

    /// Marks the selected individual as the one to compare others with.
    pub fn mark(&mut self) {
        if let Some(id) = self.selected().map(|individual| individual.id) {
            self.marked = Some(id);
            self.show_message(format!(
                "individual {id} is marked; others are compared with it"
            ));
        }
    }

    /// Returns the inspected individual and the one that it is compared with.
    ///
    /// That is the marked individual if it is of the same generation, else the best, else the
    /// second best.
    #[must_use]
    pub fn rivals(&self) -> Option<[&RankedRecord; 2]> {
        let (generation, selected) = self.inspected()?;
        let individuals = &self.live.generation(generation)?.individuals;
        let mut others = individuals.iter().filter(|other| other.id != selected.id);
        let marked = others.clone().find(|other| Some(other.id) == self.marked);
        Some([selected, marked.or_else(|| others.next())?])
    }

    /// Returns the hierarchy of an individual, or `None` if its text is not a hierarchy of this
    /// world.
    #[must_use]
    pub fn tree(&self, individual: &RankedRecord) -> Option<Tree> {
        parse(&individual.tree, self.catalogue()).ok()
    }

    /// Returns the inspected individual and the number of its generation.
    ///
    /// That is the individual of the rollout in the generation that it was taken from, else the
    /// selected one of the shown generation.
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

    /// Returns the hierarchy of the inspected individual.
    #[must_use]
    pub fn inspected_tree(&self) -> Option<Tree> {
        self.tree(self.inspected()?.1)
    }

    /// Returns the index of the selected node in `tree`, the last node if `tree` has fewer.
    #[must_use]
    pub fn node_in(&self, tree: &Tree) -> usize {
        self.node.min(tree.nodes().len().saturating_sub(1))
    }

    /// Returns the individual that the player should switch to.
    pub(in crate::dashboard) fn wanted(&self) -> Option<Subject> {
        Some(Subject {
            generation: self.shown()?.generation,
            id: self.selected()?.id,
        })
    }

    /// Returns whether the player follows the best individual of evolution.
    pub(in crate::dashboard) fn follows(&self) -> bool {
        self.mode != Mode::Replay
            && self.chosen == Chosen::Best
            && self.time == ShownGeneration::Latest
            && !self.frozen()
    }

    /// Tells the user if the individuals of `generation` were not kept, and those of another stand
    /// in for them.
    pub(in crate::dashboard) fn note_stand_in(&mut self, generation: u64, found: u64) {
        if generation != found {
            self.show_message(format!(
                "the individuals of generation {generation} were not kept; shown: the nearest \
                 kept, of generation {found}"
            ));
        }
    }

    /// Shows a message to the user and adds it to the log.
    pub fn show_message(&mut self, text: impl Into<String>) {
        if self.log.len() == LOG {
            self.log.pop_front();
        }
        self.log.push_back((text.into(), self.clock));
    }

    /// Returns the messages with their times, the latest last.
    #[must_use]
    pub fn log(&self) -> &VecDeque<(String, Duration)> {
        &self.log
    }

    /// Returns the latest message, while it is new.
    #[must_use]
    pub fn message(&self) -> Option<&str> {
        let (text, since) = self.log.back()?;
        let new = self.clock.saturating_sub(*since) <= MESSAGE_TIME;
        new.then_some(text)
    }
}
