//! `error.json`, why the process that worked on a run failed, and the last sign of a process that
//! is gone.
//!
//! A process without a terminal has nobody to tell its error to, so it leaves it in the run folder.
//! The most likely error is a full disk. Therefore the place for the file is taken when the work
//! begins, and the error is written into it. A file system that copies on write may have no room
//! even for that.

use std::fmt;
use std::fs::{self, File};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use super::pulse::{Beat, PULSE_FILE};
use super::run_error::RunError;
use crate::files::{WRITING, read_bytes, synced, write_in_one_step};

/// Name of the file with the error of the last process.
pub(super) const ERROR: &str = "error.json";

/// Size of `error.json` at most, in bytes; so much is reserved.
const ERROR_BYTES: usize = 8192;

/// Longest error that is written, in bytes; escaped, it still has room.
const LONGEST: usize = 2000;

/// Largest `pulse.json` that is read, in bytes.
pub(super) const MAX_PULSE_BYTES: u64 = 1 << 16;

/// The last sign of a process that worked on a run and is gone.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LastSign {
    /// When it was last alive, in UTC.
    pub time: String,
    /// Why it failed; `None` if it died without a word.
    pub error: Option<String>,
}

impl fmt::Display for LastSign {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.error {
            Some(error) => write!(f, "failed at {}: {error}", self.time),
            None => write!(f, "last alive at {}", self.time),
        }
    }
}

impl LastSign {
    /// Reads the last sign of the process that worked on the run in `folder`; returns `None` after a
    /// process that ended as it should.
    #[must_use]
    pub fn read(folder: &Path) -> Option<Self> {
        let bytes = read_bytes(&folder.join(ERROR), ERROR_BYTES as u64).ok();
        let failed = bytes.and_then(|bytes| serde_json::from_slice(&bytes).ok());
        failed.or_else(|| {
            let bytes = read_bytes(&folder.join(PULSE_FILE), MAX_PULSE_BYTES).ok()?;
            let beat: Beat = serde_json::from_slice(&bytes).ok()?;
            Some(Self {
                time: beat.time?,
                error: None,
            })
        })
    }
}

/// Writes `error` to the `error.json` of the run in `folder`, if there is room.
pub(super) fn write_error(folder: &Path, error: &str) -> io::Result<()> {
    write_in_one_step(&folder.join(ERROR), &contents(error)?)
}

/// Removes the `error.json` of the run in `folder`: it is no longer true.
pub(super) fn forget_error(folder: &Path) {
    let _absent = fs::remove_file(folder.join(ERROR));
}

fn contents(error: &str) -> io::Result<Vec<u8>> {
    let longest = (0..=LONGEST.min(error.len())).rev();
    let end = longest.into_iter().find(|&end| error.is_char_boundary(end));
    let failed = LastSign {
        time: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
        error: Some(error[..end.unwrap_or(0)].to_owned()),
    };
    let mut bytes = serde_json::to_vec_pretty(&failed)?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// The place for the error of a process that works on a run. It is given up when this is dropped,
/// and used if the thread panics.
#[derive(Debug)]
pub(super) struct ErrorPlace {
    folder: PathBuf,
    /// `None` if nothing could be reserved.
    reserved: Option<File>,
}

impl ErrorPlace {
    /// Reserves the place in the run folder.
    pub(super) fn reserve(folder: &Path) -> Self {
        let reserve = || -> io::Result<File> {
            let mut file = File::create(hidden(folder))?;
            file.write_all(&[b'\n'; ERROR_BYTES])?;
            synced(file.sync_all())?;
            Ok(file)
        };
        Self {
            folder: folder.to_owned(),
            reserved: reserve().ok(),
        }
    }

    /// Writes the error. A failure is ignored: there is nowhere left to report it.
    pub(super) fn write(&mut self, error: &RunError) {
        let error = error.to_string();
        let Some(file) = self.reserved.take() else {
            let _ignored = write_error(&self.folder, &error);
            return;
        };
        let written = contents(&error).and_then(|bytes| overwrite(file, &bytes));
        let _ignored =
            written.and_then(|()| fs::rename(hidden(&self.folder), self.folder.join(ERROR)));
    }
}

impl Drop for ErrorPlace {
    fn drop(&mut self) {
        if thread::panicking() {
            self.write(&RunError::Panicked);
        }
        let _absent = fs::remove_file(hidden(&self.folder));
    }
}

/// Returns the path of the reserved place. A process that opens the folder removes what a dead one
/// has left there.
fn hidden(folder: &Path) -> PathBuf {
    folder.join(format!("{WRITING}error"))
}

/// Replaces the content of a file by less, in its own place on the disk.
fn overwrite(mut file: File, bytes: &[u8]) -> io::Result<()> {
    file.seek(SeekFrom::Start(0))?;
    file.write_all(bytes)?;
    file.set_len(bytes.len() as u64)?;
    synced(file.sync_all())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_is_used_for_an_error_and_given_up_without_one() {
        let folder = tempfile::tempdir().unwrap();
        let names = || {
            let entries = fs::read_dir(folder.path()).unwrap();
            let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
            names.collect::<Vec<_>>()
        };
        drop(ErrorPlace::reserve(folder.path()));
        assert!(names().is_empty());
        assert_eq!(LastSign::read(folder.path()), None);

        let mut place = ErrorPlace::reserve(folder.path());
        assert_eq!(LastSign::read(folder.path()), None);
        place.write(&RunError::Threads(
            String::from("\u{1b}\u{e4}").repeat(2000),
        ));
        drop(place);
        assert_eq!(names(), [ERROR]);
        let said = LastSign::read(folder.path()).unwrap().to_string();
        assert!(said.starts_with("failed at 2") && said.contains("cannot start threads: "));
        forget_error(folder.path());
        assert!(names().is_empty());
    }

    #[test]
    fn a_panic_leaves_its_reason() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().to_owned();
        let thread = thread::spawn(move || {
            let _place = ErrorPlace::reserve(&path);
            panic!("on purpose");
        });
        assert!(thread.join().is_err());
        let said = LastSign::read(folder.path()).unwrap().error.unwrap();
        assert!(said.contains("panicked"), "{said}");
    }
}
