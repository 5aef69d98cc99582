//! `study status`, `study watch` and `study report`.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

use super::progress::Own;
use super::table;
use crate::cli::dashboard::{DashboardArgs, exit_code};
use crate::cli::output::{self, CommandResult, Format};
use crate::report::{RunState, RunStatus, Study, status, write_report};

/// Tell how far the runs of a study are.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab study status studies/thesis
  maxq-lab study status studies/thesis --format json | jq -r '.[] | select(.stage != \"done\").name'")]
pub(super) struct StatusArgs {
    /// The folder of the study.
    dir: PathBuf,

    /// ExecutionArgs to report.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Say what comes out: statistics, claims with verdicts, figures.
///
/// Writes DIR/report: report.md, report.json, tables as CSV, figures as SVG; prints the
/// report. It is made of the runs that are done, at any time.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab study report studies/thesis | less
  maxq-lab study report studies/thesis --format json | jq '.claims[] | {claim, verdict}'")]
pub(super) struct ReportArgs {
    /// The folder of the study.
    dir: PathBuf,

    /// ExecutionArgs to print it.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Carries out `study report`.
pub(super) fn report(args: &ReportArgs) -> CommandResult {
    let written = write_report(&Study::open(&args.dir)?)?;
    match args.format {
        Format::Json => output::json(&written.findings)?,
        Format::Text => output::text(&written.text)?,
    }
    let folder = args.dir.join("report");
    output::message(&format!(
        "{} files in {}",
        written.files.len(),
        folder.display()
    ));
    Ok(ExitCode::SUCCESS)
}

/// Carries out `study status`.
pub(super) fn show(args: &StatusArgs) -> CommandResult {
    let study = Study::open(&args.dir)?;
    let runs = status(&study);
    match args.format {
        Format::Json => output::json(&runs)?,
        Format::Text => output::text(&describe(&study, &runs))?,
    }
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
        )
    };
    for status in runs.iter().filter(under_way) {
        let (name, word) = (&status.name, status.stage.word());
        let detail = status.trouble.clone().unwrap_or_else(|| {
            let best = status.best_steps.last();
            let best = best.map(|best| format!(", best {best:.0} steps a trial"));
            format!(
                "generation {}{}",
                status.generations,
                best.unwrap_or_default()
            )
        });
        lines.push(format!("  {name}: {word}, {detail}"));
    }
    lines.join("\n") + "\n"
}

/// Follow the runs of a study, and open any of them.
///
/// A table of the runs: how each stands, its generation, the best fitness and its course.
/// Enter opens a run in the dashboard, as a replay if it is over or broken off, watched if it
/// goes on; q comes back. Folders are read once a second, never written or locked: the study
/// may be done by this machine or by others. Press ? for the keys.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab study watch studies/thesis
  maxq-lab study watch /shared/studies/thesis --fps 0.2    look every 5 seconds")]
pub(super) struct WatchArgs {
    /// The folder of the study.
    dir: PathBuf,

    #[command(flatten)]
    dashboard: DashboardArgs,
}

/// Carries out `study watch`.
pub(super) fn watch(args: &WatchArgs) -> CommandResult {
    let study = Study::open(&args.dir)?;
    let instead = format!("maxq-lab study status {}", args.dir.display());
    let (dashboard, signals) = args.dashboard.require(&instead)?;
    exit_code(table::show(&study, dashboard, &signals, Own::default)?)
}
