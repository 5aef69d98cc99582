//! A thread that loads the populations of a run and measures its folder, so that keys need not wait
//! for a file on a slow share.

use std::io;
use std::thread;

use crossbeam_channel::{Receiver, Sender, unbounded};

use crate::dashboard::context::Input;
use crate::lab::inspection::Archive;

/// What the loader is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wanted {
    /// The population after this generation.
    Population(u64),
    /// The size of the run folder.
    FolderSize,
}

/// Loads populations until it is dropped.
pub(super) struct Loader {
    /// What was loaded.
    pub(super) loaded: Receiver<Input>,
    wanted: Sender<Wanted>,
}

impl Loader {
    pub(super) fn start(mut archive: Archive) -> io::Result<Self> {
        let (wanted, asked) = unbounded();
        let (sender, loaded) = unbounded();
        thread::Builder::new()
            .name(String::from("populations"))
            .spawn(move || {
                for first in &asked {
                    let all: Vec<_> = std::iter::once(first).chain(asked.try_iter()).collect();
                    for input in answers(&all, &mut archive) {
                        if sender.send(input).is_err() {
                            return;
                        }
                    }
                }
            })?;
        Ok(Self { loaded, wanted })
    }

    /// Requests the population after a generation.
    pub(super) fn load(&self, generation: u64) {
        self.ask(Wanted::Population(generation));
    }

    /// Requests the size of the run folder.
    pub(super) fn measure(&self) {
        self.ask(Wanted::FolderSize);
    }

    fn ask(&self, wanted: Wanted) {
        // The thread cannot end before `self`, so sending cannot fail.
        let _sent = self.wanted.send(wanted);
    }
}

/// Answers requests. Of several populations only the last counts: the user has already moved past
/// the earlier ones.
fn answers(wanted: &[Wanted], archive: &mut Archive) -> Vec<Input> {
    let population = wanted.iter().rev().find_map(|wanted| match wanted {
        Wanted::Population(generation) => Some(*generation),
        Wanted::FolderSize => None,
    });
    let population = population.map(|generation| Input::Population {
        generation,
        state: archive
            .nearest(generation)
            .map_err(|error| error.to_string()),
    });
    let size = wanted
        .contains(&Wanted::FolderSize)
        .then(|| Input::FolderBytes(archive.folder_bytes()));
    population.into_iter().chain(size).collect()
}
