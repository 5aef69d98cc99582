//! Populations of a run, read by a thread of its own: a file on a slow share takes its
//! time, and keys do not wait for it.

use std::io;
use std::sync::Arc;
use std::thread;

use crossbeam_channel::{Receiver, Sender, unbounded};

use crate::evolution::EvolutionState;
use crate::lab::inspection::Archive;

/// The population after a generation, or why it cannot be had.
#[derive(Debug)]
pub(super) struct Loaded {
    pub(super) generation: u64,
    pub(super) state: Result<Arc<EvolutionState>, String>,
}

/// Reads populations until it is dropped.
pub(super) struct Loader {
    /// What was asked for.
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
                    // Who travels on has no more use for the generations on the way.
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

    /// Asks for the population after a generation.
    pub(super) fn load(&self, generation: u64) {
        // The thread ends when this does, not before.
        let _sent = self.wanted.send(generation);
    }
}
