//! `study status`, `study watch` and `study report`.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

use super::progress::OwnProgress;
use super::table;
use crate::cli::dashboard::{DashboardArgs, exit_code};
use crate::cli::output::{self, CommandResult, Format};
use crate::report::{RunState, RunStatus, Study, status, write_report};
use crate::words::shell_path;

/// Show the progress of a study.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab study status studies/thesis
  maxq-lab study status studies/thesis --format json | jq -r '.[] | select(.stage != \"done\").name'")]
pub(super) struct StatusArgs {
    /// Study folder.
    dir: PathBuf,

    /// Output format.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Write and print the report: statistics, claims with verdicts, figures.
///
/// Writes DIR/report (report.md, report.json, tables as CSV, figures as SVG) and prints the
/// report. It covers the runs that are done so far, so it can be written at any time.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab study report studies/thesis | less
  maxq-lab study report studies/thesis --format json | jq '.claims[] | {claim, verdict}'")]
pub(super) struct ReportArgs {
    /// Study folder.
    dir: PathBuf,

    /// Output format.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Runs `study report`.
pub(super) fn report(args: &ReportArgs) -> CommandResult {
    let written = write_report(&Study::open(&args.dir)?)?;
    args.format.print(&written.findings, |_| written.text)?;
    let folder = args.dir.join("report");
    output::message(&format!(
        "wrote {} files to {}",
        written.files.len(),
        folder.display()
    ));
    Ok(ExitCode::SUCCESS)
}

/// Runs `study status`.
pub(super) fn show(args: &StatusArgs) -> CommandResult {
    let study = Study::open(&args.dir)?;
    let runs = status(&study);
    args.format
        .print(&runs[..], |runs| describe(&study, runs))?;
    Ok(ExitCode::SUCCESS)
}

fn describe(study: &Study, runs: &[RunStatus]) -> String {
    let count = |of: &[&RunStatus]| {
        let stages = RunState::ALL.iter().map(|&stage| {
            let count = of.iter().filter(|status| status.stage == stage).count();
            (count, stage.word())
        });
        let some: Vec<_> = stages
            .filter(|(count, _)| *count > 0)
            .map(|(count, word)| format!("{count} {word}"))
            .collect();
        some.join(", ")
    };
    let all: Vec<_> = runs.iter().collect();
    let mut lines = vec![format!(
        "{}: {} runs, {}",
        study.plan.name,
        runs.len(),
        count(&all)
    )];
    let mut kinds: BTreeMap<(usize, usize), Vec<&RunStatus>> = BTreeMap::new();
    for status in runs {
        kinds
            .entry((status.run.scenario, status.run.arm))
            .or_default()
            .push(status);
    }
    for members in kinds.values() {
        if let Some(first) = members.first() {
            let name = format!(
                "{}/{}",
                study.scenario(&first.run).name,
                study.arm(&first.run).name
            );
            lines.push(format!("  {name:40} {}", count(members)));
        }
    }
    let under_way = |status: &&RunStatus| {
        matches!(
            status.stage,
            RunState::Running | RunState::Interrupted | RunState::Unreadable
        ) || status.last_sign.is_some()
    };
    for status in runs.iter().filter(under_way) {
        let (name, word) = (&status.name, status.stage.word());
        let detail = status.trouble.clone().unwrap_or_else(|| {
            let best = status.best_steps.last();
            let best = best.map(|best| format!(", best {best:.0} steps per trial"));
            let sign = status.last_sign.as_ref();
            let sign = sign.map(|sign| format!(", {sign}"));
            format!(
                "generation {}{}{}",
                status.generations,
                best.unwrap_or_default(),
                sign.unwrap_or_default()
            )
        });
        lines.push(format!("  {name}: {word}, {detail}"));
    }
    lines.join("\n") + "\n"
}

/// Watch the runs of a study in a table, and open any of them.
///
/// The table shows the state of every run, its generation, its best fitness and a sparkline.
/// Enter opens a run in the dashboard, live if it is running and as a replay otherwise; q
/// returns to the table. Study folders are only read, once per second, and never locked: the
/// study may run on this machine or on others. Press ? for the keys.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab study watch studies/thesis
  maxq-lab study watch /shared/studies/thesis --fps 0.2    read every 5 seconds")]
pub(super) struct WatchArgs {
    /// Study folder.
    dir: PathBuf,

    #[command(flatten)]
    dashboard: DashboardArgs,
}

/// Runs `study watch`.
pub(super) fn watch(args: &WatchArgs) -> CommandResult {
    let study = Study::open(&args.dir)?;
    let instead = format!("maxq-lab study status {}", shell_path(&args.dir));
    let (dashboard, signals) = args.dashboard.require(&instead)?;
    exit_code(table::show(
        &study,
        dashboard,
        &signals,
        OwnProgress::default,
    )?)
}
