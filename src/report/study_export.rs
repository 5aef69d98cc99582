//! A study as tables and text.

use super::arm::Base;
use super::document;
use super::facts::Facts;
use super::findings::Findings;
use super::provenance::Provenance;
use super::run_export::tree_dot;
use super::study::Study;
use super::study_tables::runs_table;
use super::table::Table;
use crate::lab::SetupError;

/// One row a run.
#[must_use]
pub fn runs(study: &Study, all: &[Facts]) -> Table {
    runs_table(study, all, &Provenance::of(study, all))
}

/// All findings.
///
/// # Errors
/// When serialisation fails.
pub fn json(study: &Study, all: &[Facts]) -> Result<String, serde_json::Error> {
    Ok(serde_json::to_string_pretty(&Findings::from_facts(study, all))? + "\n")
}

/// The report.
#[must_use]
pub fn markdown(study: &Study, all: &[Facts]) -> String {
    document::markdown(&Findings::from_facts(study, all))
}

/// The most frequent final hierarchy of every scenario under the evolving arms, a graph
/// each.
///
/// # Errors
/// When a scenario cannot be made ready.
pub fn dot(study: &Study, all: &[Facts]) -> Result<String, SetupError> {
    let findings = Findings::from_facts(study, all);
    let mut text = format!("// {}\n", findings.provenance.line());
    for kind in &findings.groups {
        let arm = study.plan.arms.iter().find(|arm| arm.name == kind.arm);
        let scenario = study
            .plan
            .scenarios
            .iter()
            .find(|s| s.name == kind.scenario);
        let (Some(scenario), Some((structure, times))) = (scenario, kind.structures.first()) else {
            continue;
        };
        if arm.is_some_and(|arm| arm.base == Base::Evolved) {
            let dot = tree_dot(scenario, structure)?;
            text += &format!(
                "// {}, {}: {times} of {} runs\n{dot}",
                kind.scenario, kind.arm, kind.n
            );
        }
    }
    Ok(text)
}
