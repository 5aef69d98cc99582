//! Commands to a run.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crossbeam_channel::{Receiver, Sender, bounded};
use serde::{Deserialize, Serialize};

use super::event::Event;
use super::feed::Feed;
use crate::evolution::EvolutionState;
use crate::learning::Gate;

/// What a run is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Activity {
    /// It computes.
    Running,
    /// It computes to the end of the generation, then pauses.
    Stepping,
    /// It is paused.
    Paused,
    /// It was told to stop.
    Stopped,
}

/// Commands to a run. Clones command the same run.
///
/// A command takes effect within a few hundred control steps, well under a millisecond.
#[derive(Clone, Debug)]
pub struct Controls {
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    gate: Gate,
    activity: Mutex<Activity>,
    checkpoint_requests: (Sender<()>, Receiver<()>),
    feed: Feed,
}

impl Controls {
    /// Returns the controls of a new run and the receiver of its events.
    pub(super) fn new() -> (Self, Receiver<Event>) {
        let (feed, receiver) = Feed::new();
        let shared = Shared {
            gate: Gate::default(),
            activity: Mutex::new(Activity::Running),
            checkpoint_requests: bounded(1),
            feed,
        };
        let shared = Arc::new(shared);
        (Self { shared }, receiver)
    }

    /// Returns what the run is doing.
    #[must_use]
    pub fn activity(&self) -> Activity {
        *self.lock()
    }

    /// Pauses the run.
    pub fn pause(&self) {
        self.change(Activity::Paused);
    }

    /// Resumes a paused run.
    pub fn resume(&self) {
        self.change(Activity::Running);
    }

    /// Lets the run compute to the end of the generation and pauses it there.
    pub fn step(&self) {
        self.change(Activity::Stepping);
    }

    /// Requests that the latest state be saved now.
    pub fn checkpoint(&self) {
        // A full channel holds the same request already.
        let _requested = self.shared.checkpoint_requests.0.try_send(());
    }

    /// Stops the run for good.
    ///
    /// The unfinished generation is dropped; resuming computes it again, bit for bit.
    pub fn stop(&self) {
        self.change(Activity::Stopped);
    }

    /// Returns the number of control steps that this process has computed.
    #[must_use]
    pub fn control_steps(&self) -> u64 {
        self.shared.gate.control_steps()
    }

    /// Returns the latest state of the evolution; `None` while primitive subtasks are trained.
    #[must_use]
    pub fn latest(&self) -> Option<Arc<EvolutionState>> {
        self.feed().latest()
    }

    pub(super) fn feed(&self) -> &Feed {
        &self.shared.feed
    }

    pub(super) fn gate(&self) -> &Gate {
        &self.shared.gate
    }

    pub(super) fn checkpoint_requests(&self) -> Receiver<()> {
        self.shared.checkpoint_requests.1.clone()
    }

    /// Pauses a stepping run: its generation is over.
    pub(super) fn generation_over(&self) {
        self.change_from(|from| from == Activity::Stepping, Activity::Paused);
    }

    fn lock(&self) -> MutexGuard<'_, Activity> {
        let activity = &self.shared.activity;
        activity.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn change(&self, to: Activity) {
        self.change_from(|_| true, to);
    }

    /// Changes the activity if `applies` to the present one and the run was not stopped.
    fn change_from(&self, applies: impl Fn(Activity) -> bool, to: Activity) {
        let mut activity = self.lock();
        let from = *activity;
        if from == Activity::Stopped || from == to || !applies(from) {
            return;
        }
        *activity = to;
        match to {
            Activity::Running | Activity::Stepping => self.gate().open(),
            Activity::Paused => self.gate().close(),
            Activity::Stopped => self.gate().stop(),
        }
        match (from, to) {
            (_, Activity::Paused) => self.feed().send(Event::Paused),
            (Activity::Paused, Activity::Running | Activity::Stepping) => {
                self.feed().send(Event::Resumed);
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let events: Vec<_> = events.try_iter().collect();
        assert_eq!(events, [Event::Paused, Event::Resumed, Event::Paused]);
    }
}
