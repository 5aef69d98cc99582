//! A thread that loads the populations of a run, so that keys need not wait for a file on a
//! slow share.

use std::io;
use std::sync::Arc;
use std::thread;

use crossbeam_channel::{Receiver, Sender, unbounded};

use crate::evolution::EvolutionState;
use crate::lab::inspection::Archive;

/// The population after a generation, or why it could not be loaded.
#[derive(Debug)]
pub(super) struct Loaded {
    pub(super) generation: u64,
    pub(super) state: Result<Arc<EvolutionState>, String>,
}

/// Loads populations until it is dropped.
pub(super) struct Loader {
    /// The loaded populations.
    pub(super) loaded: Receiver<Loaded>,
    wanted: Sender<u64>,
}

impl Loader {
    pub(super) fn start(mut archive: Archive) -> io::Result<Self> {
        let (wanted, asked) = unbounded::<u64>();
        let (sender, loaded) = unbounded();
        thread::Builder::new()
            .name(String::from("populations"))
            .spawn(move || {
                for generation in &asked {
                    // Only the last request counts: the user has already moved past the earlier
                    // ones.
                    let generation = asked.try_iter().last().unwrap_or(generation);
                    let state = archive.generation(generation);
                    let state = state.map_err(|error| error.to_string());
                    if sender.send(Loaded { generation, state }).is_err() {
                        return;
                    }
                }
            })?;
        Ok(Self { loaded, wanted })
    }

    /// Requests the population after a generation.
    pub(super) fn load(&self, generation: u64) {
        // The thread cannot end before `self`, so sending cannot fail.
        let _sent = self.wanted.send(generation);
    }
}
