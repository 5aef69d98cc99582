//! Commands to a run, and the way of its events to a reader.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded};
use serde::{Deserialize, Serialize};

use super::event::Event;
use crate::evolution::EvolutionState;
use crate::learning::Gate;

/// Events that wait for the reader before progress is coalesced.
const CHANNEL_CAPACITY: usize = 256;

/// What a run does at the moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Activity {
    /// It computes.
    Running,
    /// It computes until the end of the generation.
    Stepping,
    /// It waits.
    Paused,
    /// It was told to stop.
    Stopped,
}

/// Commands to a run; every reader may hold a copy.
///
/// Commands act within a few hundred control steps, well under a millisecond of
/// computation, whatever is going on.
#[derive(Clone, Debug)]
pub struct Controls {
    desk: Arc<Desk>,
}

#[derive(Debug)]
struct Desk {
    gate: Gate,
    activity: Mutex<Activity>,
    sink: Sink,
    requests: (Sender<()>, Receiver<()>),
    latest: Mutex<Option<Arc<EvolutionState>>>,
}

impl Controls {
    /// Controls for a new run, and the receiver of its events.
    pub(super) fn new() -> (Self, Receiver<Event>) {
        let (sender, receiver) = bounded(CHANNEL_CAPACITY);
        let desk = Desk {
            gate: Gate::default(),
            activity: Mutex::new(Activity::Running),
            sink: Sink::new(sender),
            requests: bounded(1),
            latest: Mutex::new(None),
        };
        let desk = Arc::new(desk);
        (Self { desk }, receiver)
    }

    /// What the run does.
    #[must_use]
    pub fn activity(&self) -> Activity {
        *self.lock()
    }

    /// Makes the run wait.
    pub fn pause(&self) {
        self.change(Activity::Paused);
    }

    /// Lets the run go on.
    pub fn resume(&self) {
        self.change(Activity::Running);
    }

    /// Lets the run go on to the end of the generation, and wait there.
    pub fn step(&self) {
        self.change(Activity::Stepping);
    }

    /// Asks for the latest state to be saved now.
    pub fn checkpoint(&self) {
        // A full channel means that the same is asked for already.
        let _asked = self.desk.requests.0.try_send(());
    }

    /// Stops the run for good. The generation under way is given up; resuming computes
    /// it again, bit for bit.
    pub fn stop(&self) {
        self.change(Activity::Stopped);
    }

    /// Control steps computed by this process so far.
    #[must_use]
    pub fn control_steps(&self) -> u64 {
        self.desk.gate.control_steps()
    }

    /// The latest state of the evolution; `None` while primitive subtasks are trained.
    #[must_use]
    pub fn latest(&self) -> Option<Arc<EvolutionState>> {
        self.lock_latest().clone()
    }

    pub(super) fn set_latest(&self, state: &Arc<EvolutionState>) {
        *self.lock_latest() = Some(Arc::clone(state));
    }

    fn lock_latest(&self) -> MutexGuard<'_, Option<Arc<EvolutionState>>> {
        let latest = &self.desk.latest;
        latest.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn gate(&self) -> &Gate {
        &self.desk.gate
    }

    pub(super) fn requests(&self) -> Receiver<()> {
        self.desk.requests.1.clone()
    }

    /// The latest progress told.
    pub(super) fn progress(&self) -> Option<Event> {
        self.desk.sink.lock().progress.clone()
    }

    /// Tells readers a fact.
    pub(super) fn tell(&self, event: Event) {
        self.desk.sink.send(event);
    }

    /// Hands over what readers have not taken yet, until they have it or are gone.
    pub(super) fn close(&self) {
        self.desk.sink.close();
    }

    /// A generation is over: a run that was stepping waits.
    pub(super) fn generation_over(&self) {
        self.change_from(|from| from == Activity::Stepping, Activity::Paused);
    }

    fn lock(&self) -> MutexGuard<'_, Activity> {
        self.desk
            .activity
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    fn change(&self, to: Activity) {
        self.change_from(|_| true, to);
    }

    /// Changes what the run does, where `applies` to what it does now.
    fn change_from(&self, applies: impl Fn(Activity) -> bool, to: Activity) {
        let mut activity = self.lock();
        let from = *activity;
        if from == Activity::Stopped || from == to || !applies(from) {
            return;
        }
        *activity = to;
        match to {
            Activity::Running | Activity::Stepping => self.desk.gate.open(),
            Activity::Paused => self.desk.gate.close(),
            Activity::Stopped => self.desk.gate.stop(),
        }
        match (from, to) {
            (_, Activity::Paused) => self.tell(Event::Paused),
            (Activity::Paused, Activity::Running | Activity::Stepping) => self.tell(Event::Resumed),
            _ => {}
        }
    }
}

/// The sender's end of the events. Progress is dropped when the channel is full,
/// milestones wait in a backlog; sending never blocks, so that a slow or dead reader
/// never slows evolution.
#[derive(Debug)]
struct Sink {
    state: Mutex<SinkState>,
}

#[derive(Debug)]
struct SinkState {
    sender: Option<Sender<Event>>,
    backlog: VecDeque<Event>,
    /// The latest progress, whether it was taken or not.
    progress: Option<Event>,
}

impl Sink {
    fn new(sender: Sender<Event>) -> Self {
        let state = SinkState {
            sender: Some(sender),
            backlog: VecDeque::new(),
            progress: None,
        };
        Self {
            state: Mutex::new(state),
        }
    }

    fn lock(&self) -> MutexGuard<'_, SinkState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn send(&self, event: Event) {
        let mut state = self.lock();
        if event.is_progress() {
            state.progress = Some(event.clone());
            if !state.backlog.is_empty() {
                return;
            }
        }
        state.backlog.push_back(event);
        state.flush();
    }

    fn close(&self) {
        let (sender, backlog) = {
            let mut state = self.lock();
            (state.sender.take(), std::mem::take(&mut state.backlog))
        };
        if let Some(sender) = sender {
            for event in backlog {
                if sender.send(event).is_err() {
                    return;
                }
            }
        }
    }
}

impl SinkState {
    fn flush(&mut self) {
        let Some(sender) = &self.sender else {
            self.backlog.clear();
            return;
        };
        while let Some(event) = self.backlog.pop_front() {
            match sender.try_send(event) {
                Ok(()) => {}
                Err(TrySendError::Disconnected(_)) => {
                    self.backlog.clear();
                    return;
                }
                Err(TrySendError::Full(event)) => {
                    if !event.is_progress() {
                        self.backlog.push_front(event);
                    }
                    return;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_reader_loses_progress_but_no_milestone() {
        let (controls, events) = Controls::new();
        for generation in 0..1000 {
            controls.tell(Event::CheckpointSaved { generation });
            controls.tell(Event::Progress {
                generation,
                lived: 0,
                population: 1,
                control_steps: 0,
            });
        }
        std::thread::scope(|scope| {
            scope.spawn(|| controls.close());
            let saved = events.iter().filter(|event| !event.is_progress()).count();
            assert_eq!(saved, 1000);
        });
    }

    #[test]
    fn a_reader_that_went_away_blocks_nothing() {
        let (controls, events) = Controls::new();
        drop(events);
        for generation in 0..1000 {
            controls.tell(Event::CheckpointSaved { generation });
        }
        controls.close();
    }

    #[test]
    fn stopping_is_final() {
        let (controls, events) = Controls::new();
        controls.pause();
        controls.pause();
        controls.step();
        controls.generation_over();
        assert_eq!(controls.activity(), Activity::Paused);
        controls.stop();
        controls.resume();
        assert_eq!(controls.activity(), Activity::Stopped);
        let told: Vec<_> = events.try_iter().collect();
        assert_eq!(told, [Event::Paused, Event::Resumed, Event::Paused]);
    }
}
