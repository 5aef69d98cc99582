//! The tables of a study. They are tidy: one row for each observation, and units in the names
//! of columns.

use super::claims::Verdict;
use super::facts::Facts;
use super::findings::Findings;
use super::metrics::{metrics, traits};
use super::provenance::Provenance;
use super::statistics::{Estimate, Interval};
use super::study::Study;
use super::table::Table;

/// Columns that identify a run.
const RUN_COLUMNS: [&str; 4] = ["study", "scenario", "arm", "seed"];

/// Returns a table with one row for each run.
#[must_use]
pub fn runs_table(study: &Study, all: &[Facts], provenance: &Provenance) -> Table {
    let types = all.iter().map(|facts| facts.winner.selectable.len());
    let types = types.max().unwrap_or(0);
    let (metrics, traits) = (metrics(types), traits(types));
    let mut table = new_table(&RUN_COLUMNS, provenance);
    let header = &mut table.header;
    header.extend(metrics.iter().map(|metric| metric.name.clone()));
    header.extend(traits.iter().map(|of| of.name.replace(' ', "_")));
    let more = [
        "fresh_trial_steps_standard_error",
        "tree",
        "structure",
        "version",
    ];
    header.extend(more.map(str::to_owned));
    for facts in all {
        let mut row = run_cells(study, facts);
        row.extend(metrics.iter().map(|metric| optional((metric.of)(facts))));
        row.extend(traits.iter().map(|of| optional((of.of)(facts))));
        row.extend([
            optional(facts.fresh.standard_error),
            facts.winner.tree.clone(),
            facts.winner.structure.clone(),
            facts.version.clone(),
        ]);
        table.rows.push(row);
    }
    table
}

/// Returns a table with one row for each generation of each run.
#[must_use]
pub fn generations_table(study: &Study, all: &[Facts], provenance: &Provenance) -> Table {
    let mut table = new_table(&RUN_COLUMNS, provenance);
    let more = [
        "generation",
        "best_fitness_trial_steps",
        "middle_fitness_trial_steps",
        "structural_difference",
        "policy_change",
    ];
    table.header.extend(more.map(str::to_owned));
    for facts in all {
        for (index, generation) in facts.course.iter().enumerate() {
            let mut row = run_cells(study, facts);
            row.extend([
                (index + 1).to_string(),
                generation.best_steps.to_string(),
                generation.middle_steps.to_string(),
                generation.difference.to_string(),
                generation.policy_change.to_string(),
            ]);
            table.rows.push(row);
        }
    }
    table
}

/// Returns a table with one row for each metric of each scenario and arm, summarised over
/// seeds.
#[must_use]
pub fn metrics_table(findings: &Findings) -> Table {
    let columns = [
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
    ];
    let mut table = new_table(&columns, &findings.provenance);
    for group in &findings.groups {
        for summary in &group.metrics {
            let mut row = vec![
                findings.provenance.study.clone(),
                group.scenario.clone(),
                group.arm.clone(),
                summary.metric.clone(),
                summary.mean.n.to_string(),
            ];
            row.extend(estimate_cells(Some(summary.iqm)));
            row.extend(estimate_cells(Some(summary.mean)));
            table.rows.push(row);
        }
    }
    table
}

/// Returns a table with one row for each comparison of two arms.
#[must_use]
pub fn comparisons_table(findings: &Findings) -> Table {
    let columns = [
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
    ];
    let mut table = new_table(&columns, &findings.provenance);
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
        table.rows.push(row);
    }
    table
}

/// Returns a table with one row for each claim and arm.
#[must_use]
pub fn claims_table(findings: &Findings) -> Table {
    let columns = [
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
    ];
    let mut table = new_table(&columns, &findings.provenance);
    for judged in &findings.claims {
        // The p-value and the verdict belong to the tested arm: the first with its count.
        let tested = judged
            .arms
            .iter()
            .position(|(_, count)| *count == judged.tested);
        for (index, (arm, count)) in judged.arms.iter().enumerate() {
            let Interval { low, high } = count.interval();
            let is_tested = tested == Some(index);
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
                optional(verdict.map(Verdict::words)),
            ]);
        }
    }
    table
}

fn new_table(columns: &[&str], provenance: &Provenance) -> Table {
    Table {
        provenance: provenance.line(),
        ..Table::new(columns)
    }
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
