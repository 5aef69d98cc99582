//! Draws the learning curves of `maxq-lab evaluate --curve`.

use clap::ValueEnum;

use super::evaluation::Report;
use crate::lab::{CurvePoint, with_changes};
use crate::report::figures::{Chart, Figure, Panel, Series};
use crate::report::{Table, short};

/// Columns of a chart of characters.
const COLUMNS: usize = 100;

/// How a learning curve is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum CurveForm {
    /// A chart of characters.
    Text,
    /// A table: one row for each line and stretch of trials.
    Csv,
    /// A picture.
    Svg,
}

/// Returns the curves in the form asked for.
pub(super) fn drawn(reports: &[Report], form: CurveForm) -> String {
    match form {
        CurveForm::Text => figure(reports).text(COLUMNS) + &ends(reports),
        CurveForm::Csv => table(reports).csv(),
        CurveForm::Svg => match figure(reports).svg() {
            Ok(svg) => svg,
            Err(error) => error.to_string(),
        },
    }
}

/// Returns the name of each line: what tells it from the others.
fn names(reports: &[Report]) -> Vec<String> {
    let first = reports.first().map(tree);
    let one_tree = reports.iter().all(|report| Some(tree(report)) == first);
    let place = |report: &Report| {
        let trees = reports
            .iter()
            .take_while(|other| tree(other) != tree(report));
        format!("tree {}", trees.count() + 1)
    };
    let name = |report: &Report| match (&report.against, one_tree) {
        (None, true) => String::from("as it is"),
        (None, false) => place(report),
        (Some(setting), true) => setting.clone(),
        (Some(setting), false) => format!("{}, {setting}", place(report)),
    };
    reports.iter().map(name).collect()
}

fn tree(report: &Report) -> &str {
    &report.scored.evaluation.tree
}

fn figure(reports: &[Report]) -> Figure {
    let lines = names(reports).into_iter().zip(reports).enumerate();
    let series = lines.map(|(mark, (name, report))| {
        let points = report.curve.iter();
        Series {
            name,
            points: points
                .clone()
                .map(|point| (point.middle(), point.mean))
                .collect(),
            band: points
                .filter_map(|point| {
                    let error = point.standard_error?;
                    Some((point.middle(), point.mean - error, point.mean + error))
                })
                .collect(),
            mark,
        }
    });
    let chart = Chart {
        title: String::from("mean of all repeats, and its standard error"),
        x: String::from("trials lived"),
        y: String::from("time steps per trial"),
        y_range: None,
        series: series.collect(),
    };
    Figure {
        number: "",
        title: String::from("Learning curve"),
        provenance: provenance(reports),
        panels: vec![Panel::Chart(chart)],
    }
}

/// Says what the curves were made from.
fn provenance(reports: &[Report]) -> String {
    let Some(first) = reports.first() else {
        return String::new();
    };
    let mut trees: Vec<&str> = Vec::new();
    for report in reports {
        if !trees.contains(&tree(report)) {
            trees.push(tree(report));
        }
    }
    let trees = trees.iter().enumerate();
    let trees: Vec<_> = trees
        .map(|(i, tree)| format!("tree {}: {tree}", i + 1))
        .collect();
    format!(
        "{}, seed {}, {} repeats, {} primitive sets; maxq-lab {}; {}",
        with_changes(&first.scenario, first.changed.as_deref()),
        first.seed,
        first.scored.evaluation.repeats.len(),
        first.primitive_sets,
        env!("CARGO_PKG_VERSION"),
        trees.join("; ")
    )
}

/// Tells where each curve ends: the scored trials.
fn ends(reports: &[Report]) -> String {
    let line = |(name, report): (String, &Report)| {
        let evaluation = &report.scored.evaluation;
        let error = evaluation.standard_error;
        let error = error.map_or_else(String::new, |error| format!(" +- {}", short(error)));
        format!(
            "{name}: {}{error} time steps per trial in the {} scored trials, {:.1} % delivered\n",
            short(evaluation.mean),
            report.trials,
            100.0 * evaluation.delivered_share
        )
    };
    names(reports).into_iter().zip(reports).map(line).collect()
}

fn table(reports: &[Report]) -> Table {
    let mut table = Table::new(&[
        "line",
        "tree",
        "first_trial",
        "last_trial",
        "mean_steps",
        "standard_error",
        "delivered_share",
    ]);
    table.provenance = provenance(reports);
    for (name, report) in names(reports).into_iter().zip(reports) {
        let row = |point: &CurvePoint| {
            let error = point.standard_error.map(|error| error.to_string());
            vec![
                name.clone(),
                tree(report).to_owned(),
                point.first.to_string(),
                point.last.to_string(),
                point.mean.to_string(),
                error.unwrap_or_default(),
                point.delivered_share.to_string(),
            ]
        };
        table.rows.extend(report.curve.iter().map(row));
    }
    table
}
