//! Following a run that another process computes, and reading one that nobody does.
//!
//! A follower only reads: it takes no lock and leaves no trace, so that it may follow a run
//! of another machine in a shared folder. It polls, because that is what works over
//! every kind of share.

use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};

use super::follower::Follower;
use super::news::News;
use super::run_error::RunError;

/// News that wait for the reader before the follower waits too.
const CHANNEL_CAPACITY: usize = 256;

/// A run folder that is being followed, until this is dropped.
#[derive(Debug)]
pub struct Watch {
    /// What is told, from the very first event of the run on.
    pub news: Receiver<News>,
    _stop: Sender<()>,
}

impl Watch {
    /// Follows the run in a folder, which need not be there yet, and looks every `interval`.
    ///
    /// # Errors
    /// When there can be no thread.
    pub fn start(folder: &Path, interval: Duration) -> Result<Self, RunError> {
        let (sender, news) = bounded(CHANNEL_CAPACITY);
        let (stop, stopped) = bounded::<()>(0);
        let folder: PathBuf = folder.to_owned();
        thread::Builder::new()
            .name(String::from("follower"))
            .spawn(move || {
                let mut follower = Follower::of(&folder);
                loop {
                    for news in follower.look(Instant::now()) {
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
