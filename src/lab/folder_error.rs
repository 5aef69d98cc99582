//! Why a run folder cannot be used.

use std::path::{Path, PathBuf};

use thiserror::Error;

use super::difference::{Difference, differences, told};
use super::manifest::{Invocation, Manifest};
use crate::files::FileError;
use crate::words::shell_word;

/// Why a run folder cannot be used.
#[derive(Debug, Error)]
pub enum FolderError {
    /// The path of a new run folder exists already.
    #[error("{path}: exists already {}{}", by.and_what_to_do(path), to_keep_both(.instead.as_deref()))]
    Exists {
        /// The path.
        path: String,
        /// What it holds.
        by: Occupied,
        /// The command of the new run with a path that is free.
        instead: Option<String>,
    },
    /// The path of a new run folder is a symbolic link, which could lead to somebody else's files.
    #[error("{path}: found a symbolic link; allowed: a folder, or a path that does not exist yet")]
    Link {
        /// The path.
        path: String,
    },
    /// It is not a run folder.
    #[error("{path}: holds no run.json; allowed: a run folder")]
    NotARun {
        /// The folder.
        path: String,
    },
    /// Another process works on the run.
    #[error("{path}: another process works on this run; wait for it, or stop it")]
    InUse {
        /// The folder.
        path: String,
    },
    /// The operating system refuses, or `run.json` is not what it should be.
    #[error(transparent)]
    File(#[from] FileError),
}

/// What the path of a new run holds already.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Occupied {
    /// A run of the same scenario and seed.
    Same,
    /// Another run, and its differences from the new one.
    Another(Vec<Difference>),
    /// A run folder whose `run.json` cannot be read.
    Unreadable,
    /// Something other than a run folder.
    NoRun,
}

impl Occupied {
    /// Returns what the run `found` means to the new run `wanted`.
    pub(super) fn by(found: &Manifest, wanted: &Manifest) -> Self {
        let mut all = Vec::new();
        let mut differ = |key: &str, one: String, other: String| {
            if one != other {
                let key = key.to_owned();
                all.push(Difference { key, one, other });
            }
        };
        let (one, other) = (&found.scenario, &wanted.scenario);
        differ("scenario", one.name.clone(), other.name.clone());
        differ("seed", found.seed.to_string(), wanted.seed.to_string());
        all.extend(differences(one, other));
        if all.is_empty() {
            Self::Same
        } else {
            Self::Another(all)
        }
    }

    fn and_what_to_do(&self, path: &str) -> String {
        match self {
            Self::Same => format!(
                "and holds this run; allowed: another --out, or --force to replace it; to resume \
                 it: maxq-lab resume {}",
                shell_word(path)
            ),
            Self::Another(differences) => format!(
                "and holds another run: {}; allowed: another --out, or --force to replace it",
                told(differences)
            ),
            Self::Unreadable => String::from(
                "and holds a run.json that cannot be read; allowed: another --out, or --force to \
                 replace it",
            ),
            Self::NoRun => String::from("and is no run folder; allowed: another --out"),
        }
    }
}

fn to_keep_both(instead: Option<&str>) -> String {
    instead.map_or_else(String::new, |command| format!("; to keep both: {command}"))
}

/// Returns the command that started `wanted` with another, free path; `None` if the run was not
/// started by the command `run`.
pub(super) fn with_free_path(wanted: &Invocation, taken: &Path) -> Option<String> {
    let mut words = wanted.command_line.clone();
    if words.get(1).map(String::as_str) != Some("run") {
        return None;
    }
    if let Some(out) = words.iter().position(|word| word == "--out") {
        words.drain(out..words.len().min(out + 2));
    }
    words.retain(|word| !word.starts_with("--out=") && word != "--force");
    let free = free_path(taken)?.display().to_string();
    // What follows this word is no option.
    let end = words.iter().position(|word| word == "--");
    let end = end.unwrap_or(words.len());
    words.splice(end..end, [String::from("--out"), free]);
    let words = words.iter().map(|word| shell_word(word));
    Some(words.collect::<Vec<_>>().join(" "))
}

/// Returns the first of `PATH-2`, `PATH-3` and so on that does not exist.
fn free_path(taken: &Path) -> Option<PathBuf> {
    let name = taken.file_name()?.to_string_lossy().into_owned();
    let mut numbered = (2..1000).map(|number| taken.with_file_name(format!("{name}-{number}")));
    numbered.find(|path| !path.exists())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::manifest::MANIFEST_FORMAT;
    use crate::scenario::Scenario;

    fn manifest(seed: u64, settings: &[&str]) -> Manifest {
        let settings: Vec<_> = settings.iter().map(|&setting| setting.into()).collect();
        let smoke = Scenario::load("smoke").unwrap();
        Manifest {
            format: MANIFEST_FORMAT,
            scenario: smoke.with_settings(&settings).unwrap(),
            seed,
            keep: None,
            started: Invocation::now(1),
            resumed: Vec::new(),
        }
    }

    #[test]
    fn what_is_in_the_way_is_told_by_what_sets_it_apart() {
        let wanted = manifest(1, &[]);
        assert_eq!(Occupied::by(&wanted, &wanted), Occupied::Same);
        let found = manifest(
            7,
            &[
                "evolution.selection=random",
                "learning.discount=0.5",
                "learning.epsilon=0.5",
            ],
        );
        let error = FolderError::Exists {
            path: String::from("runs/smoke-seed1"),
            by: Occupied::by(&found, &wanted),
            instead: None,
        };
        assert_eq!(
            error.to_string(),
            "runs/smoke-seed1: exists already and holds another run: seed is 7 there, 1 here; \
             evolution.selection is random there, fitness here; learning.discount is 0.5 there, \
             0.9 here; learning.epsilon is 0.5 there, 0.02 here; allowed: another --out, or --force \
             to replace it"
        );
    }

    #[test]
    fn the_command_for_a_free_path_is_ready_to_copy() {
        let folder = tempfile::tempdir().unwrap();
        let taken = folder.path().join("my runs");
        std::fs::create_dir(folder.path().join("my runs-2")).unwrap();
        let command = |line: &[&str]| {
            let mut started = Invocation::now(1);
            started.command_line = line.iter().map(|&word| word.to_owned()).collect();
            with_free_path(&started, &taken)
        };
        let free = shell_word(&folder.path().join("my runs-3").display().to_string());
        assert_eq!(
            command(&[
                "maxq-lab", "run", "a b.json", "--out", "my runs", "--seed", "2"
            ]),
            Some(format!("maxq-lab run 'a b.json' --seed 2 --out {free}"))
        );
        assert_eq!(
            command(&["maxq-lab", "run", "--out=x", "--", "-a.json"]),
            Some(format!("maxq-lab run --out {free} -- -a.json"))
        );
        assert_eq!(command(&["maxq-lab", "study", "a"]), None);
    }
}
