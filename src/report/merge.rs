//! Merges the parts of a study that was done in several folders.

use std::cmp::Reverse;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::arm::ArmError;
use super::results::{PlannedRun, StudyRunError, evaluation};
use super::study::{RunId, Study, StudyError};
use crate::files::{FileError, sync_folder};
use crate::lab::{
    CHECKPOINT, Difference, EVALUATION, EVENTS, FolderError, MANIFEST, RunFolder, told,
};

/// Files of a run that depend on the plan alone.
const DETERMINED: [&str; 3] = [EVENTS, CHECKPOINT, EVALUATION];

/// Files of the process that works on a run; they are not copied.
const LEFT_BEHIND: [&str; 2] = ["lock", "pulse.json"];

/// Why studies cannot be merged.
#[derive(Debug, Error)]
pub enum MergeError {
    /// A part, or the merged study, cannot be used.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A part has another plan than the first.
    #[error(
        "{path}: found another plan than in {first}: {}; allowed: parts of one study, whose plans \
         differ in seeds only",
        told(.differences)
    )]
    Another {
        /// The part.
        path: String,
        /// The first part.
        first: String,
        /// How its plan differs from that of the first part, apart from the seeds.
        differences: Vec<Difference>,
    },
    /// A run cannot be read.
    #[error(transparent)]
    Run(#[from] StudyRunError),
    /// A run cannot be copied because a process is working on it.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// Two parts hold different results of a finished run.
    #[error(
        "{one} and {other}: {file} is not the same; different versions of the program may have \
         made them"
    )]
    Differ {
        /// A run folder.
        one: String,
        /// Another.
        other: String,
        /// The file.
        file: &'static str,
    },
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
}

/// A folder that holds at least the beginning of a run.
struct Candidate {
    folder: PathBuf,
    done: bool,
    /// Whether evolution has ended.
    over: bool,
    /// Size of `events.jsonl` in bytes.
    length: u64,
    manifest: Vec<u8>,
}

/// Merges the parts of a study in the folder `out`, which may itself be a part. Returns the number
/// of runs that have been started.
///
/// If the parts have different seeds, the merged study has the seeds of all.
///
/// Of every run, the part that is furthest is copied. If several parts have finished it, the files
/// that depend on the plan alone must be the same bytes in all of them. `run.json` and
/// `summary.json` also say where and when the run was done; of these the bytewise smallest is
/// copied. The order of the parts therefore does not matter, and the result is the study that one
/// machine would have done.
///
/// # Errors
/// When the plans of parts differ in more than seeds, or parts disagree, or are being worked on.
pub fn merge(parts: &[PathBuf], out: &Path) -> Result<usize, MergeError> {
    let mut studies = Vec::new();
    for part in parts {
        studies.push(Study::open(part)?);
    }
    let merged = merged_study(&studies, out)?;
    let mut runs = 0;
    for run in merged.runs() {
        let sources = studies.iter().chain([&merged]);
        let planned = sources.map(|study| PlannedRun::of(study, &run));
        runs += usize::from(merge_run(&merged, &run, planned)?);
    }
    Ok(runs)
}

/// Returns the study in the folder `out`, with the plan of all parts. If they have different seeds,
/// it has those of all, in order.
fn merged_study(parts: &[Study], out: &Path) -> Result<Study, MergeError> {
    let present = Study::is_in(out).then(|| Study::open(out)).transpose()?;
    let mut all = parts.iter().chain(&present);
    let Some(first) = all.next() else {
        return Ok(Study::open(out)?);
    };
    let mut plan = first.plan.clone();
    for other in all {
        if !plan.differs_in_seeds_only(&other.plan) {
            let mut differences = other.plan.differences(&plan);
            differences.retain(|difference| difference.key != "seeds");
            return Err(MergeError::Another {
                path: other.folder.display().to_string(),
                first: first.folder.display().to_string(),
                differences,
            });
        }
        if other.plan.seeds != plan.seeds {
            let more = plan.with_more(Some(&other.plan.seeds), Vec::new());
            plan = more.map_err(StudyError::from)?;
            plan.seeds = plan.seeds.sorted();
        }
    }
    let Some(mut merged) = present else {
        return Ok(Study::create(plan, out)?);
    };
    if merged.plan != plan {
        merged.grow(plan)?;
    }
    Ok(merged)
}

fn merge_run(
    merged: &Study,
    run: &RunId,
    planned: impl Iterator<Item = Result<PlannedRun, ArmError>>,
) -> Result<bool, MergeError> {
    let mut candidates = Vec::new();
    for planned in planned {
        let planned = planned.map_err(StudyRunError::from)?;
        candidates.extend(Candidate::of(&planned)?);
    }
    let mut done = candidates.iter().filter(|candidate| candidate.done);
    if let Some(first) = done.next() {
        for other in done {
            check_same(&first.folder, &other.folder)?;
        }
    }
    candidates.sort_by(|a, b| a.key().cmp(&b.key()));
    let Some(best) = candidates.first() else {
        return Ok(false);
    };
    let target = merged.run_folder(run);
    if best.folder != target {
        // The lock keeps other processes from resuming an unfinished run meanwhile.
        let _lock = if best.done {
            None
        } else {
            Some(RunFolder::open(&best.folder)?)
        };
        replace(&best.folder, &target)?;
    }
    Ok(true)
}

impl Candidate {
    fn of(planned: &PlannedRun) -> Result<Option<Self>, MergeError> {
        let folder = planned.folder.clone();
        let manifest = match fs::read(folder.join(MANIFEST)) {
            Ok(manifest) => manifest,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(refused(&folder.join(MANIFEST), error)),
        };
        planned.manifest()?;
        let over = planned.outcome()?.is_some();
        let length = fs::metadata(folder.join(EVENTS)).map_or(0, |data| data.len());
        Ok(Some(Self {
            done: over && evaluation(&folder)?.is_some(),
            over,
            length,
            manifest,
            folder,
        }))
    }

    /// Returns the sort key that puts the candidate that is furthest first.
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

/// Replaces the run folder `to` by a copy of `from`, in one step.
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
