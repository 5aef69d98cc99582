//! Where figures and tables come from: they carry it.

use std::collections::BTreeSet;

use serde::Serialize;

use super::facts::Facts;
use super::study::Study;

/// What a figure or table of a study was made from. It names no machine and no time, so
/// that the same runs give the same bytes anywhere.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Provenance {
    /// Name of the study.
    pub study: String,
    /// CRC-32 of its `study.json`.
    pub plan_crc32: String,
    /// Runs that are done.
    pub runs: usize,
    /// Runs that the plan has.
    pub of: usize,
    /// The seeds of the plan.
    pub seeds: String,
    /// Versions and commits of the program that did the runs.
    pub versions: Vec<String>,
    /// The command that makes it.
    pub command: String,
}

impl Provenance {
    /// Of these runs of a study.
    #[must_use]
    pub fn of(study: &Study, all: &[Facts]) -> Self {
        let plan = study.plan.to_file().unwrap_or_default();
        let versions: BTreeSet<_> = all.iter().map(|facts| facts.version.clone()).collect();
        Self {
            study: study.plan.name.clone(),
            plan_crc32: format!("{:08x}", crc32fast::hash(&plan)),
            runs: all.len(),
            of: study.runs().len(),
            seeds: study.plan.seeds.to_string(),
            versions: versions.into_iter().collect(),
            command: String::from("maxq-lab study report DIR"),
        }
    }

    /// In one line, for people.
    #[must_use]
    pub fn line(&self) -> String {
        let Self {
            study,
            plan_crc32,
            runs,
            of,
            seeds,
            command,
            ..
        } = self;
        let versions = self.versions.join(", ");
        format!(
            "Study {study} (plan {plan_crc32}): {runs} of {of} runs, seeds {seeds}, maxq-lab {versions}; \
             {command}"
        )
    }
}
