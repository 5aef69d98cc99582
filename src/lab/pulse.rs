//! `pulse.json`: the sign of life of the process that works on a run.
//!
//! The process replaces the file every second and removes it at the end. Followers read from it
//! what the log does not hold, such as progress and pauses; when it stays the same, the process
//! has died. Followers compare a pulse with the one before, never with a clock, since clocks of
//! machines differ. The pulse decides nothing: `lock` decides who may write to a run.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::thread::{self, JoinHandle};
use std::time::{Duration, SystemTime};

use crossbeam_channel::{RecvTimeoutError, Sender, bounded};
use serde::{Deserialize, Serialize};

use super::controls::{Activity, Controls};
use super::event::Event;
use super::manifest::host_name;
use crate::files::WRITING;

/// Name of the file in the run folder.
pub(super) const PULSE_FILE: &str = "pulse.json";

/// Time between two writes.
pub(super) const BEAT: Duration = Duration::from_secs(1);

/// The content of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Beat {
    /// Name of the machine.
    pub(super) host: String,
    /// Process id on that machine.
    pub(super) process: u32,
    /// Number of the beat, so that no two beats of a process are equal.
    pub(super) beat: u64,
    /// The time, in UTC; for people, who compare it with nothing.
    #[serde(default)]
    pub(super) time: Option<String>,
    /// What the run is doing.
    pub(super) activity: Activity,
    /// How far the present generation is; `None` before anything was computed.
    pub(super) progress: Option<Event>,
}

/// A thread that writes the file; dropping it stops the thread and removes the file.
#[derive(Debug)]
pub(super) struct Pulse {
    path: PathBuf,
    beating: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Pulse {
    /// Starts writing in a run folder that this process has locked. A failure is ignored: only
    /// followers need the pulse.
    pub(super) fn start(folder: &Path, controls: &Controls) -> Self {
        let path = folder.join(PULSE_FILE);
        let (stop, stopped) = bounded(0);
        let (file, controls) = (path.clone(), controls.clone());
        let beating = thread::Builder::new()
            .name(String::from("pulse"))
            .spawn(move || {
                for number in 0.. {
                    let _ignored = write(&file, &beat(number, &controls));
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
            // A panicked thread has stopped too.
            let _ = thread.join();
        }
        let _ = fs::remove_file(fresh(&self.path));
        let _ = fs::remove_file(&self.path);
    }
}

fn beat(number: u64, controls: &Controls) -> Beat {
    let progress = controls.feed().progress().map(|mut event| {
        // Control steps are counted between two events too.
        if let Event::Progress { control_steps, .. } = &mut event {
            *control_steps = controls.control_steps();
        }
        event
    });
    Beat {
        host: host_name(),
        process: std::process::id(),
        beat: number,
        time: Some(humantime::format_rfc3339_seconds(SystemTime::now()).to_string()),
        activity: controls.activity(),
        progress,
    }
}

/// Replaces the file in one step, so that nobody reads half of it. It is not synced: after a crash
/// of the machine it is worthless.
fn write(path: &Path, beat: &Beat) -> io::Result<()> {
    let fresh = fresh(path);
    fs::write(&fresh, serde_json::to_vec(beat)?)?;
    fs::rename(&fresh, path)
}

/// Returns the path under which the next beat is written.
fn fresh(path: &Path) -> PathBuf {
    path.with_file_name(format!("{WRITING}pulse"))
}
