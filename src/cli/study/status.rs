//! `study status` and `study report`.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

use crate::cli::output::{self, Done, Format};
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

    /// How to report.
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

    /// How to print it.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Carries out `study report`.
pub(super) fn report(args: &ReportArgs) -> Done {
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
pub(super) fn show(args: &StatusArgs) -> Done {
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
