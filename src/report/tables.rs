//! The tables of a study: tidy, one row an observation, units in the names of columns.

use super::facts::Facts;
use super::findings::Findings;
use super::metrics::{metrics, traits};
use super::provenance::Provenance;
use super::statistics::{Estimate, Interval};
use super::study::Study;
use super::table::Table;

/// Columns that say what a row is of.
const RUN_COLUMNS: [&str; 4] = ["study", "scenario", "arm", "seed"];

/// One row a run.
#[must_use]
pub fn runs_table(study: &Study, all: &[Facts], provenance: &Provenance) -> Table {
    let types = all
        .iter()
        .map(|facts| facts.winner.selectable.len())
        .max()
        .unwrap_or(0);
    let mut table = Table::new(&RUN_COLUMNS);
    table
        .header
        .extend(metrics(types).into_iter().map(|metric| metric.name));
    table.header.extend(
        traits(types)
            .into_iter()
            .map(|of| of.name.replace(' ', "_")),
    );
    let more = [
        "fresh_trial_steps_standard_error",
        "tree",
        "structure",
        "version",
        "command",
    ];
    table.header.extend(more.map(str::to_owned));
    for facts in all {
        let mut row = run_cells(study, facts);
        row.extend(
            metrics(types)
                .iter()
                .map(|metric| optional((metric.of)(facts))),
        );
        row.extend(traits(types).iter().map(|of| optional((of.of)(facts))));
        row.extend([
            optional(facts.fresh.standard_error),
            facts.winner.tree.clone(),
            facts.winner.structure.clone(),
            facts.version.clone(),
            provenance.command.clone(),
        ]);
        table.rows.push(row);
    }
    table
}

/// One row a generation of a run.
#[must_use]
pub fn generations_table(study: &Study, all: &[Facts]) -> Table {
    let mut table = Table::new(&RUN_COLUMNS);
    let more = [
        "generation",
        "best_fitness_trial_steps",
        "middle_fitness_trial_steps",
        "structural_difference",
        "policy_change",
        "version",
    ];
    table.header.extend(more.map(str::to_owned));
    for facts in all {
        for (index, moment) in facts.course.iter().enumerate() {
            let mut row = run_cells(study, facts);
            row.push((index + 1).to_string());
            row.extend([
                moment.best_steps.to_string(),
                moment.middle_steps.to_string(),
                moment.difference.to_string(),
                moment.policy_change.to_string(),
                facts.version.clone(),
            ]);
            table.rows.push(row);
        }
    }
    table
}

/// One row a number of a scenario and arm, over seeds.
#[must_use]
pub fn metrics_table(findings: &Findings) -> Table {
    let mut table = Table::new(&[
        "study",
        "scenario",
        "arm",
        "metric",
        "n",
        "iqm",
        "iqm_low_95",
        "iqm_high_95",
        "mean",
        "mean_low_95",
        "mean_high_95",
        "versions",
    ]);
    for kind in &findings.kinds {
        for summary in &kind.metrics {
            let mut row = vec![
                findings.provenance.study.clone(),
                kind.scenario.clone(),
                kind.arm.clone(),
                summary.metric.clone(),
                summary.mean.n.to_string(),
            ];
            row.extend(estimate_cells(Some(summary.iqm)));
            row.extend(estimate_cells(Some(summary.mean)));
            row.push(findings.provenance.versions.join("; "));
            table.rows.push(row);
        }
    }
    table
}

/// One row a comparison of two arms.
#[must_use]
pub fn comparisons_table(findings: &Findings) -> Table {
    let mut table = Table::new(&[
        "study",
        "scenario",
        "arm",
        "against",
        "n",
        "difference_iqm_steps",
        "difference_iqm_low_95_steps",
        "difference_iqm_high_95_steps",
        "difference_mean_steps",
        "difference_mean_low_95_steps",
        "difference_mean_high_95_steps",
        "probability_of_improvement",
        "probability_low_95",
        "probability_high_95",
        "p_mann_whitney",
        "versions",
    ]);
    for comparison in &findings.comparisons {
        let mut row = vec![
            findings.provenance.study.clone(),
            comparison.scenario.clone(),
            comparison.arm.clone(),
            comparison.against.clone(),
            comparison.improvement.n.to_string(),
        ];
        row.extend(estimate_cells(comparison.difference_iqm));
        row.extend(estimate_cells(comparison.difference_mean));
        row.extend(estimate_cells(Some(comparison.improvement)));
        row.push(optional(comparison.p));
        row.push(findings.provenance.versions.join("; "));
        table.rows.push(row);
    }
    table
}

/// One row a claim and arm.
#[must_use]
pub fn claims_table(findings: &Findings) -> Table {
    let mut table = Table::new(&[
        "study",
        "claim",
        "thesis_section",
        "scenarios",
        "statement",
        "arm",
        "shown",
        "n",
        "share_low_95",
        "share_high_95",
        "p_fisher_against_control",
        "verdict",
        "versions",
    ]);
    for judged in &findings.claims {
        for (index, (arm, count)) in judged.arms.iter().enumerate() {
            let Interval { low, high } = count.interval();
            // The verdict is on the tested arm, the one whose count it was made from.
            let is_tested = *count == judged.tested
                && judged
                    .arms
                    .iter()
                    .position(|(_, other)| *other == judged.tested)
                    == Some(index);
            let verdict = judged.verdict.filter(|_| is_tested);
            table.rows.push(vec![
                findings.provenance.study.clone(),
                judged.claim.to_owned(),
                judged.source.to_owned(),
                judged.scenario.clone(),
                judged.statement.to_owned(),
                arm.clone(),
                count.shown.to_string(),
                count.n.to_string(),
                low.to_string(),
                high.to_string(),
                optional(judged.p.filter(|_| is_tested)),
                verdict.map_or_else(String::new, |verdict| verdict.words().to_owned()),
                findings.provenance.versions.join("; "),
            ]);
        }
    }
    table
}

fn run_cells(study: &Study, facts: &Facts) -> Vec<String> {
    vec![
        study.plan.name.clone(),
        study.scenario(&facts.run).name.clone(),
        study.arm(&facts.run).name.clone(),
        facts.run.seed.to_string(),
    ]
}

fn estimate_cells(estimate: Option<Estimate>) -> [String; 3] {
    let interval = estimate.and_then(|estimate| estimate.interval);
    [
        optional(estimate.map(|estimate| estimate.value)),
        optional(interval.map(|interval| interval.low)),
        optional(interval.map(|interval| interval.high)),
    ]
}

fn optional<T: ToString>(value: Option<T>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}
