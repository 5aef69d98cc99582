//! Watches a run folder from a thread of its own.
//!
//! Watching only reads and takes no lock, so it works for a run on another machine in a shared
//! folder. It polls, because that works on every kind of network file system.

use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};

use super::follower::Follower;
use super::news::News;
use super::run_error::RunError;

/// News that the channel to the reader holds before the follower waits.
const CHANNEL_CAPACITY: usize = 256;

/// A watched run folder; watching ends when this is dropped.
#[derive(Debug)]
pub struct Watch {
    /// The news, from the first event of the run on.
    pub news: Receiver<News>,
    _stop: Sender<()>,
}

impl Watch {
    /// Watches the run in a folder, which need not exist yet, and reads it every `interval`.
    ///
    /// # Errors
    /// When the operating system refuses to start a thread.
    pub fn start(folder: &Path, interval: Duration) -> Result<Self, RunError> {
        let (sender, news) = bounded(CHANNEL_CAPACITY);
        let (stop, stopped) = bounded::<()>(0);
        let folder: PathBuf = folder.to_owned();
        thread::Builder::new()
            .name(String::from("follower"))
            .spawn(move || {
                let mut follower = Follower::of(&folder);
                loop {
                    for news in follower.news(Instant::now()) {
                        if sender.send(news).is_err() {
                            return;
                        }
                    }
                    if stopped.recv_timeout(interval) != Err(RecvTimeoutError::Timeout) {
                        return;
                    }
                }
            })
            .map_err(|error| RunError::Threads(error.to_string()))?;
        Ok(Self { news, _stop: stop })
    }
}
