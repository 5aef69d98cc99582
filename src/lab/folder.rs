//! The run folder: its files, its lock, and how it is created.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::Serialize;
use tempfile::TempDir;

use super::folder_error::{FolderError, Occupied, with_free_path};
use super::last_sign::{ERROR, forget_error, write_error};
use super::lock::{LOCK, OWNER, RunLock};
use super::manifest::{MANIFEST_FORMAT, Manifest};
use super::pulse::PULSE_FILE;
use crate::files::{
    FileError, Limits, WRITING, clean, parse_json, read_text, stated_format, sync_folder,
    without_path, write_atomically,
};
use crate::scenario;

/// Name of the file that says what was run.
pub const MANIFEST: &str = "run.json";
/// Name of the file with the latest state.
pub const CHECKPOINT: &str = "checkpoint.json";
/// Name of the file with the recorded events.
pub const EVENTS: &str = "events.jsonl";
/// Name of the file with the result.
pub const SUMMARY: &str = "summary.json";

/// Name of the file with the evaluation of the winner, which studies write.
pub const EVALUATION: &str = "evaluation.json";
/// Name of the file with the trials that the best hierarchy lived after evolution.
pub const LEARNING: &str = "learning.json";
/// Name of the folder of kept checkpoints.
pub(super) const GENERATIONS: &str = "generations";

/// The files and folders of a run, apart from `run.json` and the lock.
const OWN: [&str; 8] = [
    SUMMARY,
    LEARNING,
    ERROR,
    EVALUATION,
    CHECKPOINT,
    EVENTS,
    PULSE_FILE,
    GENERATIONS,
];

/// Limits of `run.json`: it has a scenario and the starts of the program.
const LIMITS: Limits = Limits {
    bytes: 4 * scenario::LIMITS.bytes,
    depth: scenario::LIMITS.depth + 1,
    values: 2 * scenario::LIMITS.values,
};

/// Prefix of the names of run folders under construction.
const NEW_RUN: &str = ".new-run-";

/// Age at which a folder under construction counts as abandoned. Creating one takes milliseconds,
/// so an older one was left by a process that died.
const ABANDONED: Duration = Duration::from_secs(3600);

/// A run folder whose lock this process holds, so that it may write to it.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    lock: RunLock,
}

impl RunFolder {
    /// Creates a run folder.
    ///
    /// It appears together with its `run.json` and its lock in one step, so a folder that is
    /// found later is complete.
    ///
    /// # Errors
    /// When `path` exists already, or the operating system refuses. With `force`, the run in an
    /// existing folder is replaced unless another process works on it; files that are not the run's
    /// own stay.
    pub fn create(path: &Path, manifest: &Manifest, force: bool) -> Result<Self, FolderError> {
        let parent = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        fs::create_dir_all(parent).map_err(|error| io_error(parent, error))?;
        clean(parent, NEW_RUN, ABANDONED).map_err(|error| io_error(parent, error))?;
        if let Some(replaced) = Self::replace(path, manifest, force)? {
            return Ok(replaced);
        }
        let fresh = temporary(parent)?;
        // Nobody knows the folder by its temporary name: errors name the one that was asked for.
        let in_new = |error: io::Error| io_error(path, error);
        let mut lock = RunLock::take(fresh.path(), path)?;
        write_pretty(&fresh.path().join(MANIFEST), manifest).map_err(in_new)?;
        fs::create_dir(fresh.path().join(GENERATIONS)).map_err(in_new)?;
        fs::rename(fresh.path(), path).map_err(|error| match error.kind() {
            io::ErrorKind::DirectoryNotEmpty | io::ErrorKind::NotADirectory => {
                occupied(path, manifest)
            }
            _ => io_error(path, error),
        })?;
        // The folder has been renamed, so there is nothing to delete under the temporary name.
        let _moved = fresh.keep();
        lock.moved_to(path);
        sync_folder(parent).map_err(|error| io_error(parent, error))?;
        Ok(Self {
            path: path.to_owned(),
            lock,
        })
    }

    /// Replaces the run in an existing folder; returns `None` if the folder does not exist or is
    /// empty. Files that are not the run's own stay.
    fn replace(path: &Path, manifest: &Manifest, force: bool) -> Result<Option<Self>, FolderError> {
        // With a slash at its end, the path of a link would be that of the folder it leads to.
        if path.components().as_path().is_symlink() {
            return Err(FolderError::Link {
                path: path.display().to_string(),
            });
        }
        let mut entries = match fs::read_dir(path) {
            Ok(entries) => entries,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(_) => return Err(occupied(path, manifest)),
        };
        if entries.next().is_none() {
            return Ok(None);
        }
        if !force || !path.join(MANIFEST).is_file() {
            return Err(occupied(path, manifest));
        }
        let folder = Self::open(path)?;
        for name in OWN {
            let own = path.join(name);
            let removed = if own.is_dir() && !own.is_symlink() {
                remove_generations(&own)
            } else {
                fs::remove_file(&own)
            };
            match removed {
                Err(error) if error.kind() != io::ErrorKind::NotFound => {
                    return Err(io_error(&own, error));
                }
                _ => {}
            }
        }
        let generations = folder.generations();
        fs::create_dir_all(&generations).map_err(|error| io_error(&generations, error))?;
        // Written last: until then the folder is found as the old run, without its results.
        folder.write_manifest(manifest)?;
        Ok(Some(folder))
    }

    /// Returns the names of files in a run folder that do not belong to the run, in order.
    #[must_use]
    pub fn foreign_files(path: &Path) -> Vec<String> {
        let entries = fs::read_dir(path).into_iter().flatten().flatten();
        let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
        let own = |name: &str| [MANIFEST, LOCK, OWNER].contains(&name) || OWN.contains(&name);
        let mut foreign: Vec<_> = names
            .filter(|name| !own(name) && !name.starts_with(WRITING))
            .collect();
        foreign.sort();
        foreign
    }

    /// Opens an existing run folder for writing.
    ///
    /// # Errors
    /// When it is not a run folder, or another process works on it.
    pub fn open(path: &Path) -> Result<Self, FolderError> {
        if !path.join(MANIFEST).is_file() {
            return Err(FolderError::NotARun {
                path: path.display().to_string(),
            });
        }
        let folder = Self {
            path: path.to_owned(),
            lock: RunLock::take(path, path)?,
        };
        for place in [folder.path.clone(), folder.generations()] {
            clean(&place, WRITING, Duration::ZERO).map_err(|error| io_error(&place, error))?;
        }
        Ok(folder)
    }

    /// Returns the path of the folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns how the folder is guarded where the file system cannot lock files, as a warning.
    #[must_use]
    pub fn warning(&self) -> Option<String> {
        self.lock.warning()
    }

    /// Leaves `error` in the folder as the reason why work on the run failed; `None` removes it.
    /// A failure is ignored.
    pub fn leave_error(&self, error: Option<&str>) {
        match error {
            Some(error) => drop(write_error(&self.path, error)),
            None => forget_error(&self.path),
        }
    }

    /// Checks that no other process has taken this one for dead and works on the run now.
    ///
    /// # Errors
    /// When one has.
    pub(super) fn check_ours(&self) -> io::Result<()> {
        self.lock.check_ours()
    }

    /// Returns the path of `run.json`.
    #[must_use]
    pub fn manifest(&self) -> PathBuf {
        self.path.join(MANIFEST)
    }

    /// Returns the path of `checkpoint.json`.
    #[must_use]
    pub fn checkpoint(&self) -> PathBuf {
        self.path.join(CHECKPOINT)
    }

    /// Returns the path of `events.jsonl`.
    #[must_use]
    pub fn events(&self) -> PathBuf {
        self.path.join(EVENTS)
    }

    /// Returns the path of `summary.json`.
    #[must_use]
    pub fn summary(&self) -> PathBuf {
        self.path.join(SUMMARY)
    }

    /// Returns the path of the folder of kept checkpoints.
    #[must_use]
    pub fn generations(&self) -> PathBuf {
        self.path.join(GENERATIONS)
    }

    /// Returns the path of the kept checkpoint of a generation.
    #[must_use]
    pub fn generation(&self, generation: u64) -> PathBuf {
        kept_path(&self.path, generation)
    }

    /// Writes `run.json`.
    ///
    /// # Errors
    /// When the operating system refuses.
    pub fn write_manifest(&self, manifest: &Manifest) -> Result<(), FolderError> {
        let path = self.manifest();
        write_pretty(&path, manifest).map_err(|error| io_error(&path, error))
    }

    /// Reads the `run.json` of a run folder.
    ///
    /// # Errors
    /// When it is missing or is not a valid `run.json`.
    pub fn read_manifest(folder: &Path) -> Result<Manifest, FolderError> {
        let file = folder.join(MANIFEST);
        if !file.is_file() {
            return Err(FolderError::NotARun {
                path: folder.display().to_string(),
            });
        }
        let text = read_text(&file, LIMITS.bytes)?;
        let wrong = |message: String| FileError::new(&file, message);
        let json = |error| FileError::new(&file, error);
        LIMITS.check(&text).map_err(json)?;
        if let Some(found) = stated_format(&text).filter(|&format| format != MANIFEST_FORMAT) {
            let message = format!("format: found {found}; allowed: {MANIFEST_FORMAT}");
            return Err(wrong(message).into());
        }
        let mut manifest: Manifest = parse_json(&text).map_err(json)?;
        manifest.scenario = manifest
            .scenario
            .checked("scenario")
            .map_err(|error| wrong(error.to_string()))?;
        Ok(manifest)
    }
}

/// Returns the path of the kept checkpoint of a generation of the run in `folder`.
pub(super) fn kept_path(folder: &Path, generation: u64) -> PathBuf {
    folder
        .join(GENERATIONS)
        .join(format!("{generation:06}.json"))
}

/// Replaces the file at `path` by a value as JSON that is easy to read.
fn write_pretty(path: &Path, value: &impl Serialize) -> io::Result<()> {
    write_atomically(path, &serde_json::to_vec_pretty(value)?)
}

/// Removes the kept checkpoints of a run, and their folder if nothing else is in it.
fn remove_generations(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if is_kept_checkpoint(&path) {
            fs::remove_file(path)?;
        }
    }
    match fs::remove_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::DirectoryNotEmpty => Ok(()),
        removed => removed,
    }
}

/// Returns whether a path ends as those of [`RunFolder::generation`] do.
fn is_kept_checkpoint(path: &Path) -> bool {
    let stem = path.file_stem().and_then(|stem| stem.to_str());
    let is_number = |stem: &str| stem.len() >= 6 && stem.bytes().all(|byte| byte.is_ascii_digit());
    path.extension()
        .is_some_and(|extension| extension == "json")
        && stem.is_some_and(is_number)
}

/// Returns whether `path` is a file of a run, which only the process working on the run may write.
#[must_use]
pub fn is_record(path: &Path) -> bool {
    let (Some(name), Some(parent)) = (path.file_name(), path.parent()) else {
        return false;
    };
    // An empty parent is the present folder.
    let Ok(parent) = Path::new(".").join(parent).canonicalize() else {
        return false;
    };
    let of_run = |folder: &Path| folder.join(MANIFEST).is_file();
    let always = [MANIFEST, LOCK, OWNER];
    let own = always.iter().chain(&OWN).any(|&own| name == own);
    let is_kept = parent.ends_with(GENERATIONS) && is_kept_checkpoint(Path::new(name));
    (own && of_run(&parent)) || (is_kept && parent.parent().is_some_and(of_run))
}

/// Creates a folder with a unique name, which is deleted unless it is kept.
fn temporary(parent: &Path) -> Result<TempDir, FolderError> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(NEW_RUN);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
    let made = builder.tempdir_in(parent);
    made.map_err(|error| io_error(parent, without_path(error)))
}

/// Returns the error for an existing `path` where the run of `wanted` was to be created.
fn occupied(path: &Path, wanted: &Manifest) -> FolderError {
    let by = match RunFolder::read_manifest(path) {
        Ok(found) => Occupied::by(&found, wanted),
        Err(FolderError::NotARun { .. }) => Occupied::NoRun,
        Err(_) => Occupied::Unreadable,
    };
    FolderError::Exists {
        path: path.display().to_string(),
        instead: match by {
            // The command would do the same run again.
            Occupied::Same => None,
            _ => with_free_path(&wanted.started, path),
        },
        by,
    }
}

fn io_error(path: &Path, error: io::Error) -> FolderError {
    FileError::new(path, error).into()
}
