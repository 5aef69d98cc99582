//! Why a run folder cannot be used.

use std::fmt;

use thiserror::Error;

use super::difference::{Difference, differences};
use super::manifest::Manifest;
use crate::files::FileError;

/// Why a run folder cannot be used.
#[derive(Debug, Error)]
pub enum FolderError {
    /// The path of a new run folder exists already.
    #[error("{path}: exists already {}", by.and_what_to_do(path))]
    Exists {
        /// The path.
        path: String,
        /// What it holds.
        by: Occupied,
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

/// Differences that are listed.
const TOLD: usize = 3;

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
                "and holds this run; allowed: 'maxq-lab resume {path}' to resume it, --force \
                 to replace it, or another --out"
            ),
            Self::Another(differences) => format!(
                "and holds another run, with {}; allowed: another --out, or --force to replace it",
                Told(differences)
            ),
            Self::Unreadable => String::from(
                "and holds a run.json that cannot be read; allowed: another --out, or --force to \
                 replace it",
            ),
            Self::NoRun => String::from("and is no run folder; allowed: another --out"),
        }
    }
}

/// Writes the first differences and the number of the others.
struct Told<'d>(&'d [Difference]);

impl fmt::Display for Told<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, difference) in self.0.iter().take(TOLD).enumerate() {
            let Difference { key, one, other } = difference;
            let separator = if index == 0 { "" } else { ", " };
            write!(f, "{separator}{key} {one} in the place of {other}")?;
        }
        match self.0.len().saturating_sub(TOLD) {
            0 => Ok(()),
            more => write!(f, " and {more} more"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::Invocation;
    use crate::lab::manifest::MANIFEST_FORMAT;
    use crate::scenario::Scenario;

    fn manifest(seed: u64, settings: &[&str]) -> Manifest {
        let settings: Vec<_> = settings.iter().map(|&setting| setting.into()).collect();
        let smoke = Scenario::load("smoke").unwrap();
        Manifest {
            format: MANIFEST_FORMAT,
            scenario: smoke.with_settings(&settings).unwrap(),
            seed,
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
        };
        assert_eq!(
            error.to_string(),
            "runs/smoke-seed1: exists already and holds another run, with seed 7 in the place of 1, \
             evolution.selection random in the place of fitness, learning.discount 0.5 in the \
             place of 0.9 and 1 more; allowed: another --out, or --force to replace it"
        );
    }
}
