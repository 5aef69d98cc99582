//! Provenance: what a figure or table was made from. Each carries its own.

use std::collections::BTreeSet;
use std::path::Path;

use serde::Serialize;

use super::facts::Facts;
use super::plan::Plan;
use super::study::Study;
use crate::scenario::{EMBEDDED_PLANS, Embedded};

/// What a figure or table of a study was made from.
///
/// It names no machine and no time, so the same runs give the same bytes anywhere.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Provenance {
    /// Name of the study.
    pub study: String,
    /// CRC-32 of its `study.json`.
    pub plan_crc32: String,
    /// Number of finished runs.
    pub runs: usize,
    /// Number of runs in the plan.
    pub of: usize,
    /// Seeds of the plan.
    pub seeds: String,
    /// Versions and commits of the program that did the runs.
    pub versions: Vec<String>,
    /// Commands that repeat the study, in a folder with the study's name.
    pub command: String,
}

impl Provenance {
    /// Returns the provenance of these runs of a study.
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
            command: commands(&study.plan),
        }
    }

    /// Returns the provenance as one line for people.
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
        let versions = match self.versions.as_slice() {
            [] => String::new(),
            versions => format!(", maxq-lab {}", versions.join(", ")),
        };
        format!(
            "Study {study} (CRC-32 of study.json {plan_crc32}): {runs} of {of} runs, seeds {seeds}{versions}; {command}"
        )
    }
}

/// Returns the commands that repeat a study and report it. The user's own folder names do not
/// appear in them, because the same runs must give the same bytes anywhere.
fn commands(plan: &Plan) -> String {
    let name = &plan.name;
    let embedded = EMBEDDED_PLANS.iter().find(|embedded| embedded.name == name);
    let parse = |embedded: &Embedded| Plan::parse(embedded.json, name, Path::new("")).ok();
    let embedded = embedded.and_then(parse);
    let is_embedded = embedded.is_some_and(|embedded| embedded == *plan);
    let file = if is_embedded { name } else { "study.json" };
    format!("maxq-lab study {file} --out {name}; maxq-lab study report {name}")
}
