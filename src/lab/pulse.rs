//! `pulse.json`: the sign of life of the process that works on a run.
//!
//! Every second the process replaces it by how far it is; it is gone when the process
//! gives the run up in order. Whoever follows the run learns from it what the log does not
//! say, and that the process died when it stays the same. Followers compare one pulse
//! with the next, never with a clock: theirs may differ. It decides nothing; who may
//! write to a run is what `lock` says.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use crossbeam_channel::{RecvTimeoutError, Sender, bounded};
use serde::{Deserialize, Serialize};

use super::controls::{Activity, Controls};
use super::event::Event;
use super::manifest::host_name;

/// Name of the file in the run folder.
pub(super) const PULSE_FILE: &str = "pulse.json";

/// Time between two beats.
pub(super) const BEAT: Duration = Duration::from_secs(1);

/// What a process that works on a run says of itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Beat {
    /// Name of the machine.
    pub(super) host: String,
    /// Id of the process there.
    pub(super) process: u32,
    /// Beats so far: no two beats of a process are the same.
    pub(super) beat: u64,
    /// What the run does.
    pub(super) activity: Activity,
    /// How far the generation under way is; none before anything has been computed.
    pub(super) progress: Option<Event>,
}

/// Beats until it is dropped; then the file is gone.
#[derive(Debug)]
pub(super) struct Pulse {
    path: PathBuf,
    beating: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Pulse {
    /// Begins to beat in a run folder that this process has locked. A pulse that cannot
    /// be written is missed by followers alone, so that is no error.
    pub(super) fn start(folder: &Path, controls: &Controls) -> Self {
        let path = folder.join(PULSE_FILE);
        let (stop, stopped) = bounded(0);
        let (file, controls) = (path.clone(), controls.clone());
        let beating = thread::Builder::new()
            .name(String::from("pulse"))
            .spawn(move || {
                for number in 0.. {
                    let _missed = write(&file, &beat(number, &controls));
                    if stopped.recv_timeout(BEAT) != Err(RecvTimeoutError::Timeout) {
                        return;
                    }
                }
            });
        Self {
            path,
            beating: beating.ok().map(|thread| (stop, thread)),
        }
    }
}

impl Drop for Pulse {
    fn drop(&mut self) {
        if let Some((stop, thread)) = self.beating.take() {
            drop(stop);
            // A pulse that panicked has stopped beating, which is all that is wanted.
            let _ = thread.join();
        }
        let _ = fs::remove_file(&self.path);
    }
}

fn beat(number: u64, controls: &Controls) -> Beat {
    let progress = controls.feed().progress().map(|mut event| {
        // The count goes on between two events.
        if let Event::Progress { control_steps, .. } = &mut event {
            *control_steps = controls.control_steps();
        }
        event
    });
    Beat {
        host: host_name(),
        process: std::process::id(),
        beat: number,
        activity: controls.activity(),
        progress,
    }
}

/// Replaces the file in one step, so that nobody reads half of it. It is not synced:
/// after a crash of the machine there is no life to tell of.
fn write(path: &Path, beat: &Beat) -> io::Result<()> {
    let fresh = path.with_extension("json.new");
    fs::write(&fresh, serde_json::to_vec(beat)?)?;
    fs::rename(&fresh, path)
}
