//! The way of a run's facts to its reader: events, and the latest state.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded};

use super::event::Event;
use crate::evolution::EvolutionState;

/// Events that the channel to the reader holds.
const CHANNEL_CAPACITY: usize = 256;

/// The sending end of a run's events, and the latest state.
///
/// Sending never blocks, so a slow or absent reader never slows evolution. Events that the
/// channel has no room for wait in a backlog; progress is dropped while others wait.
#[derive(Debug)]
pub(super) struct Feed {
    events: Mutex<Events>,
    latest: Mutex<Option<Arc<EvolutionState>>>,
}

#[derive(Debug)]
struct Events {
    sender: Option<Sender<Event>>,
    backlog: VecDeque<Event>,
    /// The latest progress, taken by the reader or not.
    progress: Option<Event>,
}

impl Feed {
    /// Returns a feed and the receiver of its events.
    pub(super) fn new() -> (Self, Receiver<Event>) {
        let (sender, receiver) = bounded(CHANNEL_CAPACITY);
        let events = Events {
            sender: Some(sender),
            backlog: VecDeque::new(),
            progress: None,
        };
        let feed = Self {
            events: Mutex::new(events),
            latest: Mutex::new(None),
        };
        (feed, receiver)
    }

    /// Sends an event to the reader.
    pub(super) fn send(&self, event: Event) {
        let mut events = lock(&self.events);
        if event.is_progress() {
            events.progress = Some(event.clone());
            if !events.backlog.is_empty() {
                return;
            }
        }
        events.backlog.push_back(event);
        events.flush();
    }

    /// Closes the feed: waits until the reader has the backlog or is gone.
    pub(super) fn close(&self) {
        let (sender, backlog) = {
            let mut events = lock(&self.events);
            (events.sender.take(), std::mem::take(&mut events.backlog))
        };
        if let Some(sender) = sender {
            for event in backlog {
                if sender.send(event).is_err() {
                    return;
                }
            }
        }
    }

    /// Returns the latest progress that was sent.
    pub(super) fn progress(&self) -> Option<Event> {
        lock(&self.events).progress.clone()
    }

    /// Returns the latest state of the evolution.
    pub(super) fn latest(&self) -> Option<Arc<EvolutionState>> {
        lock(&self.latest).clone()
    }

    /// Replaces the latest state.
    pub(super) fn set_latest(&self, state: &Arc<EvolutionState>) {
        *lock(&self.latest) = Some(Arc::clone(state));
    }
}

impl Events {
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

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_reader_misses_progress_but_no_other_event() {
        let (feed, events) = Feed::new();
        for generation in 0..1000 {
            feed.send(Event::CheckpointSaved { generation });
            feed.send(Event::Progress {
                generation,
                lived: 0,
                population: 1,
                control_steps: 0,
            });
        }
        std::thread::scope(|scope| {
            scope.spawn(|| feed.close());
            let saved = events.iter().filter(|event| !event.is_progress()).count();
            assert_eq!(saved, 1000);
        });
    }

    #[test]
    fn a_reader_that_is_gone_blocks_nothing() {
        let (feed, events) = Feed::new();
        drop(events);
        for generation in 0..1000 {
            feed.send(Event::CheckpointSaved { generation });
        }
        feed.close();
    }
}
