//! Studies that were done in parts are put together.

use std::cmp::Reverse;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::single::{FRESH, SingleError, fresh, summary};
use super::study::{RunId, Study, StudyError};
use crate::files::{FileError, sync_folder};
use crate::lab::{FolderError, RunFolder};

/// Files of a run that follow from the plan alone.
const DETERMINED: [&str; 3] = ["events.jsonl", "checkpoint.json", FRESH];

/// Files that belong to a process at work on a run.
const LEFT_BEHIND: [&str; 2] = ["lock", "pulse.json"];

/// Why studies cannot be put together.
#[derive(Debug, Error)]
pub enum MergeError {
    /// A part, or the study to be made, cannot be used.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A part is of another plan than the first.
    #[error("{path}: is a study of another plan than {first}; allowed: parts of one study")]
    Another {
        /// The part.
        path: String,
        /// The first part.
        first: String,
    },
    /// A run cannot be read.
    #[error(transparent)]
    Run(#[from] SingleError),
    /// A run cannot be copied: somebody works on it.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// Two parts have done a run and do not agree.
    #[error(
        "{one} and {other}: {file} is not the same; were they done by different versions of the \
         program?"
    )]
    Differ {
        /// A run folder.
        one: String,
        /// Another.
        other: String,
        /// The file.
        file: &'static str,
    },
    /// The operating system refused.
    #[error(transparent)]
    File(#[from] FileError),
}

/// A folder that holds some of a run.
struct Candidate {
    folder: PathBuf,
    done: bool,
    /// Whether evolution is over.
    over: bool,
    /// Bytes of events.
    length: u64,
    manifest: Vec<u8>,
}

/// Puts the parts of a study together in the folder `out`, which may be a part itself.
///
/// Of every run the folder that is furthest is taken. Where several have done it, what
/// follows from the plan must be the same bytes in all; `run.json` and `summary.json`, which
/// say where and when a run was done, are those that come first as bytes. So the order of
/// the parts does not matter, and all else is as if one machine had done the study.
/// Returns how many runs there are.
///
/// # Errors
/// When parts are of different plans, disagree, or are worked on.
pub fn merge(parts: &[PathBuf], out: &Path) -> Result<usize, MergeError> {
    let mut studies = Vec::new();
    for part in parts {
        studies.push(Study::open(part)?);
    }
    let Some(first) = studies.first() else {
        return Ok(0);
    };
    if let Some(other) = studies.iter().find(|study| study.plan != first.plan) {
        return Err(MergeError::Another {
            path: other.folder.display().to_string(),
            first: first.folder.display().to_string(),
        });
    }
    let merged = Study::create(first.plan.clone(), out)?;
    let mut runs = 0;
    for run in merged.runs() {
        let sources = studies.iter().chain([&merged]);
        let folders = sources.map(|study| study.run_folder(&run));
        runs += usize::from(merge_run(&merged, &run, folders)?);
    }
    Ok(runs)
}

fn merge_run(
    merged: &Study,
    run: &RunId,
    folders: impl Iterator<Item = PathBuf>,
) -> Result<bool, MergeError> {
    let mut candidates = Vec::new();
    for folder in folders {
        candidates.extend(Candidate::of(folder)?);
    }
    let done: Vec<_> = candidates
        .iter()
        .filter(|candidate| candidate.done)
        .collect();
    if let Some((first, others)) = done.split_first() {
        for other in others {
            check_same(&first.folder, &other.folder)?;
        }
    }
    candidates.sort_by(|a, b| a.key().cmp(&b.key()));
    let Some(best) = candidates.first() else {
        return Ok(false);
    };
    let target = merged.run_folder(run);
    if best.folder != target {
        // A run that is not done may be gone on with at this moment.
        let _held = match best.done {
            true => None,
            false => Some(RunFolder::open(&best.folder)?),
        };
        replace(&best.folder, &target)?;
    }
    Ok(true)
}

impl Candidate {
    fn of(folder: PathBuf) -> Result<Option<Self>, MergeError> {
        let manifest = match fs::read(folder.join("run.json")) {
            Ok(manifest) => manifest,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(refused(&folder.join("run.json"), error)),
        };
        let over = summary(&folder)?.is_some();
        let length = fs::metadata(folder.join("events.jsonl")).map_or(0, |data| data.len());
        Ok(Some(Self {
            done: over && fresh(&folder)?.is_some(),
            over,
            length,
            manifest,
            folder,
        }))
    }

    /// Sorts what is furthest first.
    fn key(&self) -> (Reverse<bool>, Reverse<bool>, Reverse<u64>, &[u8]) {
        (
            Reverse(self.done),
            Reverse(self.over),
            Reverse(self.length),
            &self.manifest,
        )
    }
}

fn check_same(one: &Path, other: &Path) -> Result<(), MergeError> {
    for file in DETERMINED {
        let read = |folder: &Path| {
            let path = folder.join(file);
            fs::read(&path).map_err(|error| refused(&path, error))
        };
        if read(one)? != read(other)? {
            return Err(MergeError::Differ {
                one: one.display().to_string(),
                other: other.display().to_string(),
                file,
            });
        }
    }
    Ok(())
}

/// Puts a copy of a run folder in the place of another; it appears in one step.
fn replace(from: &Path, to: &Path) -> Result<(), MergeError> {
    let parent = to.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(parent).map_err(|error| refused(parent, error))?;
    let fresh = tempfile::Builder::new()
        .prefix(".merging-")
        .tempdir_in(parent);
    let fresh = fresh.map_err(|error| refused(parent, error))?;
    let copy_to = fresh.path().join("run");
    copy(from, &copy_to)?;
    let old = fresh.path().join("old");
    match fs::rename(to, &old) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(refused(to, error)),
        _ => {}
    }
    fs::rename(&copy_to, to).map_err(|error| refused(to, error))?;
    sync_folder(parent).map_err(|error| refused(parent, error))
}

fn copy(from: &Path, to: &Path) -> Result<(), MergeError> {
    fs::create_dir(to).map_err(|error| refused(to, error))?;
    let entries = fs::read_dir(from).map_err(|error| refused(from, error))?;
    for entry in entries {
        let entry = entry.map_err(|error| refused(from, error))?;
        let name = entry.file_name();
        let shown = name.to_string_lossy();
        if LEFT_BEHIND.contains(&&*shown) || shown.starts_with('.') {
            continue;
        }
        let (path, target) = (entry.path(), to.join(&name));
        if path.is_dir() {
            copy(&path, &target)?;
        } else {
            fs::copy(&path, &target).map_err(|error| refused(&path, error))?;
        }
    }
    Ok(())
}

fn refused(path: &Path, error: io::Error) -> MergeError {
    FileError::new(path, error).into()
}
