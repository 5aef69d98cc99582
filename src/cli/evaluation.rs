//! The answer of `maxq-lab evaluate`.

use serde::Serialize;

use super::output::counted;
use crate::lab::{CurvePoint, Scored, with_changes};

/// The evaluation of a structure.
#[derive(Serialize)]
pub(super) struct Report {
    pub(super) scenario: String,
    /// Settings that differ from the built-in scenario of this name.
    pub(super) changed: Option<String>,
    pub(super) seed: u64,
    pub(super) warmup: usize,
    pub(super) trials: usize,
    #[serde(rename = "banks")]
    pub(super) primitive_sets: usize,
    #[serde(flatten)]
    pub(super) scored: Scored,
    pub(super) control_steps_per_second: f64,
    /// The setting of `--against`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) against: Option<String>,
    /// The learning curve, if it was asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) curve: Vec<CurvePoint>,
}

/// Returns the evaluation as text.
pub(super) fn describe(report: &Report) -> String {
    let scored = &report.scored;
    let evaluation = &scored.evaluation;
    let error = |error: Option<f64>, digits: usize| match error {
        Some(error) => format!(" +- {error:.digits$} (standard error)"),
        None => String::new(),
    };
    let single = if evaluation.standard_error.is_none() {
        " (no standard error from a single repeat)"
    } else {
        ""
    };
    format!(
        "{}\n{}, seed {}: {} of {} after {}, {}{single}\n\
         {:.1}{} time steps per trial\n\
         {:.2}{} return per trial (sum of rewards)\n\
         {:.2} % of trials delivered\n\
         {} control steps, {:.0} per second including the training of the primitive subtasks\n",
        evaluation.tree,
        with_changes(&report.scenario, report.changed.as_deref()),
        report.seed,
        counted(evaluation.repeats.len() as u64, "repeat"),
        counted(report.trials as u64, "scored trial"),
        counted(report.warmup as u64, "warm-up trial"),
        counted(report.primitive_sets as u64, "primitive set"),
        evaluation.mean,
        error(evaluation.standard_error, 1),
        scored.mean_return,
        error(scored.return_standard_error, 2),
        100.0 * evaluation.delivered_share,
        evaluation.control_steps,
        report.control_steps_per_second,
    )
}
