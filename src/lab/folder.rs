//! The run folder: what lies in it, who may write it, how it comes to be.

use std::fmt;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::Duration;

use tempfile::TempDir;

use super::folder_error::{FolderError, Occupied};
use super::manifest::{MANIFEST_FORMAT, Manifest};
use crate::files::{
    FileError, WRITING, clean, parse_json, read_text, stated_format, sync_folder, without_path,
    write_atomically,
};
use crate::scenario::MAX_FILE_BYTES;

/// How the names of run folders begin that are being made.
const NEW_RUN: &str = ".new-run-";

/// Making a run folder takes milliseconds: one that was begun so long ago was left by a
/// process that died.
const ABANDONED: Duration = Duration::from_secs(3600);

/// Which generations' checkpoints are kept for time travel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Keep {
    /// Every generation's.
    #[default]
    All,
    /// Every n-th generation's.
    Every(u64),
    /// None but the latest, `checkpoint.json`.
    None,
}

impl Keep {
    /// Whether the checkpoint of a generation is kept.
    #[must_use]
    pub fn keeps(self, generation: u64) -> bool {
        match self {
            Self::All => true,
            Self::Every(n) => generation.is_multiple_of(n),
            Self::None => false,
        }
    }
}

impl fmt::Display for Keep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All => f.write_str("all"),
            Self::Every(n) => write!(f, "{n}"),
            Self::None => f.write_str("none"),
        }
    }
}

impl FromStr for Keep {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match (text, text.parse()) {
            ("all", _) => Ok(Self::All),
            ("none", _) => Ok(Self::None),
            (_, Ok(n)) if n > 0 => Ok(Self::Every(n)),
            _ => Err(format!(
                "found {text:?}; allowed: all, none, or a number n for every n-th"
            )),
        }
    }
}

/// A run folder that this process may write: it holds the folder's lock.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    _lock: Lock,
}

/// The lock of a run folder. It is given up by name: closing the file would leave it to
/// a child that another thread of the process is about to start, for a moment.
#[derive(Debug)]
struct Lock(File);

impl Drop for Lock {
    fn drop(&mut self) {
        // A lock that cannot be given up goes with its file.
        let _ = self.0.unlock();
    }
}

impl RunFolder {
    /// Makes a new run folder. It appears with its `run.json` and lock in one step, so
    /// that whatever is found later is a whole run folder.
    ///
    /// # Errors
    /// When something is there already - with `force`, something that is no run folder
    /// or that another process works on -, or the operating system refuses.
    pub fn create(path: &Path, manifest: &Manifest, force: bool) -> Result<Self, FolderError> {
        let parent = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        fs::create_dir_all(parent).map_err(|error| io_error(parent, error))?;
        clean(parent, NEW_RUN, ABANDONED).map_err(|error| io_error(parent, error))?;
        let replaced = Self::make_room(path, parent, manifest, force)?;
        let fresh = temporary(parent)?;
        let folder = Self {
            path: fresh.path().to_owned(),
            _lock: lock(fresh.path())?,
        };
        folder.write_manifest(manifest)?;
        let generations = folder.generations();
        fs::create_dir(&generations).map_err(|error| io_error(&generations, error))?;
        drop(replaced);
        fs::rename(fresh.path(), path).map_err(|error| match error.kind() {
            io::ErrorKind::DirectoryNotEmpty | io::ErrorKind::NotADirectory => {
                occupied(path, manifest)
            }
            _ => io_error(path, error),
        })?;
        // The folder is no longer under its temporary name, so there is nothing to delete.
        let _moved = fresh.keep();
        sync_folder(parent).map_err(|error| io_error(parent, error))?;
        Ok(Self {
            path: path.to_owned(),
            ..folder
        })
    }

    /// Clears the place of a new run folder; an empty folder is no obstacle. Returns the
    /// lock of the run that was replaced.
    fn make_room(
        path: &Path,
        parent: &Path,
        manifest: &Manifest,
        force: bool,
    ) -> Result<Option<Self>, FolderError> {
        let mut entries = match fs::read_dir(path) {
            Ok(entries) => entries,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(_) => return Err(occupied(path, manifest)),
        };
        if entries.next().is_none() {
            return Ok(None);
        }
        if !force || !path.join("run.json").is_file() {
            return Err(occupied(path, manifest));
        }
        let old = Self::open(path)?;
        // It goes in one step: a process killed here leaves no half of a run in its place.
        let aside = temporary(parent)?;
        fs::rename(path, aside.path().join("replaced")).map_err(|error| io_error(path, error))?;
        aside.close().map_err(|error| io_error(path, error))?;
        Ok(Some(old))
    }

    /// Opens an existing run folder for writing.
    ///
    /// # Errors
    /// When it is no run folder, or another process works on it.
    pub fn open(path: &Path) -> Result<Self, FolderError> {
        if !path.join("run.json").is_file() {
            return Err(FolderError::NotARun {
                path: path.display().to_string(),
            });
        }
        let folder = Self {
            path: path.to_owned(),
            _lock: lock(path)?,
        };
        for place in [folder.path.clone(), folder.generations()] {
            clean(&place, WRITING, Duration::ZERO).map_err(|error| io_error(&place, error))?;
        }
        Ok(folder)
    }

    /// The folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// `run.json`.
    #[must_use]
    pub fn manifest(&self) -> PathBuf {
        self.path.join("run.json")
    }

    /// `checkpoint.json`.
    #[must_use]
    pub fn checkpoint(&self) -> PathBuf {
        self.path.join("checkpoint.json")
    }

    /// `events.jsonl`.
    #[must_use]
    pub fn events(&self) -> PathBuf {
        self.path.join("events.jsonl")
    }

    /// `summary.json`.
    #[must_use]
    pub fn summary(&self) -> PathBuf {
        self.path.join("summary.json")
    }

    /// The folder of kept checkpoints.
    #[must_use]
    pub fn generations(&self) -> PathBuf {
        self.path.join("generations")
    }

    /// The kept checkpoint of a generation.
    #[must_use]
    pub fn generation(&self, generation: u64) -> PathBuf {
        self.generations().join(format!("{generation:06}.json"))
    }

    /// Writes `run.json`.
    ///
    /// # Errors
    /// When the operating system refuses.
    pub fn write_manifest(&self, manifest: &Manifest) -> Result<(), FolderError> {
        let path = self.manifest();
        let written = serde_json::to_vec_pretty(manifest)
            .map_err(io::Error::from)
            .and_then(|bytes| write_atomically(&path, &bytes));
        written.map_err(|error| io_error(&path, error))
    }

    /// Reads the `run.json` of a run folder.
    ///
    /// # Errors
    /// When it is missing or is not the `run.json` of a valid run.
    pub fn read_manifest(folder: &Path) -> Result<Manifest, FolderError> {
        let file = folder.join("run.json");
        if !file.is_file() {
            return Err(FolderError::NotARun {
                path: folder.display().to_string(),
            });
        }
        let text = read_text(&file, 4 * MAX_FILE_BYTES)?;
        let wrong = |message: String| FileError::new(&file, message);
        if let Some(found) = stated_format(&text).filter(|&format| format != MANIFEST_FORMAT) {
            let message = format!("format: found {found}; allowed: {MANIFEST_FORMAT}");
            return Err(wrong(message).into());
        }
        let mut manifest: Manifest =
            parse_json(&text).map_err(|error| FileError::new(&file, error))?;
        manifest.scenario = manifest
            .scenario
            .checked("scenario")
            .map_err(|error| wrong(error.to_string()))?;
        Ok(manifest)
    }
}

/// A new folder with a name of its own, deleted if it is not kept.
fn temporary(parent: &Path) -> Result<TempDir, FolderError> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(NEW_RUN);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
    let made = builder.tempdir_in(parent);
    made.map_err(|error| io_error(parent, without_path(error)))
}

fn lock(folder: &Path) -> Result<Lock, FolderError> {
    let path = folder.join("lock");
    let file = OpenOptions::new()
        .create(true)
        .truncate(false)
        .write(true)
        .open(&path)
        .map_err(|error| io_error(&path, error))?;
    match file.try_lock() {
        Ok(()) => Ok(Lock(file)),
        Err(TryLockError::WouldBlock) => Err(FolderError::InUse {
            path: folder.display().to_string(),
        }),
        Err(TryLockError::Error(error)) => Err(io_error(&path, error)),
    }
}

/// There is something where the run of `wanted` was to be.
fn occupied(path: &Path, wanted: &Manifest) -> FolderError {
    let by = match RunFolder::read_manifest(path) {
        Ok(found) => Occupied::by(&found, wanted),
        Err(FolderError::NotARun { .. }) => Occupied::NoRun,
        Err(_) => Occupied::Unreadable,
    };
    FolderError::Exists {
        path: path.display().to_string(),
        by,
    }
}

fn io_error(path: &Path, error: io::Error) -> FolderError {
    FileError::new(path, error).into()
}
