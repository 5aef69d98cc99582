//! The source of a session's news, and the destination of its commands.

use crossbeam_channel::{Receiver, TryRecvError};

use crate::dashboard::context::Effect;
use crate::lab::{Activity, Controls, Event, Liveness, News, Recording, Watch};

/// Most news read at once; the rest follows with the next tick.
const MOST: usize = 4096;

/// The source of news.
#[derive(Debug)]
pub enum Source<'s> {
    /// A run of this process.
    Live(Live<'s>),
    /// A run of another process.
    Watched(&'s Watch),
    /// A run that is not being computed: all its news, which are delivered once.
    Recorded(Vec<News>),
}

/// A run of this process.
#[derive(Debug)]
pub struct Live<'s> {
    events: &'s Receiver<Event>,
    controls: &'s Controls,
    over: bool,
    closed: bool,
}

impl<'s> Source<'s> {
    /// A run of this process.
    #[must_use]
    pub fn live(events: &'s Receiver<Event>, controls: &'s Controls) -> Self {
        Self::Live(Live {
            events,
            controls,
            over: false,
            closed: false,
        })
    }

    /// Creates the source of a recorded run.
    #[must_use]
    pub fn recorded(recording: Recording) -> Self {
        let events = recording.events.into_iter().map(News::Event);
        let last_sign = recording.last_sign.map(News::LastSign);
        let end = std::iter::once(News::Liveness(recording.liveness)).chain(last_sign);
        Self::Recorded(events.chain(end).collect())
    }

    /// Returns the news since the last call.
    pub(super) fn news(&mut self) -> Vec<News> {
        match self {
            Self::Live(live) => live.news(),
            Self::Watched(watch) => watch.news.try_iter().take(MOST).collect(),
            Self::Recorded(news) => std::mem::take(news),
        }
    }

    /// Sends a command to a live run; does nothing for other runs.
    pub(super) fn steer(&self, effect: &Effect) {
        let Self::Live(Live { controls, .. }) = self else {
            return;
        };
        match effect {
            Effect::Pause => controls.pause(),
            Effect::Resume => controls.resume(),
            Effect::Step => controls.step(),
            Effect::Checkpoint => controls.checkpoint(),
            Effect::Stop => controls.stop(),
            _ => {}
        }
    }
}

impl Live<'_> {
    /// Returns the controls of the run.
    #[must_use]
    pub fn controls(&self) -> &Controls {
        self.controls
    }

    fn news(&mut self) -> Vec<News> {
        let mut news = Vec::new();
        while news.len() < MOST && !self.closed {
            match self.events.try_recv() {
                Ok(event) => {
                    self.over = matches!(event, Event::Ended { .. }) || self.over;
                    news.push(News::Event(event));
                }
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => {
                    self.closed = true;
                    news.push(News::Liveness(self.life()));
                }
            }
        }
        news
    }

    /// Returns the state of a run that emits no more events.
    fn life(&self) -> Liveness {
        match self.controls.activity() {
            _ if self.over => Liveness::Over,
            Activity::Stopped => Liveness::Stopped,
            // The run could not be recorded; joining it returns the error.
            _ => Liveness::Silent,
        }
    }
}
