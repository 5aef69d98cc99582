//! `maxq-lab export`: writes tables, figures and hierarchies of runs and studies.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::ValueEnum;

use super::output::{self, CommandResult, Failure};
use crate::files::write_atomically;
use crate::lab::is_record;
use crate::report::figures::{Figure, FigureNumber, RunSource, study_figure};
use crate::report::{PLAN_FILE, Study, read_facts, run_export, study_export};

/// Export tables, figures and hierarchies of a run or a study.
///
/// For a run: a table of its individuals (csv, json), a summary (markdown), its best hierarchy
/// (dot), or a figure (svg, text). For a study: a table of its runs (csv), all findings (json),
/// the report (markdown), the most frequent final hierarchies (dot), or a figure (svg, text).
/// With --figure, csv, json and markdown contain the data of that figure.
///
/// Figures have their numbers from the thesis: 4.3 action values over the angle, 4.5 evolved
/// hierarchies, 4.7 structural difference, 4.8 performance, 4.9 the best hierarchies of selected
/// generations, 4.10 selection probabilities.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab export runs/environment-2-seed1 --format svg --figure 4.8 > figure-4.8.svg
  maxq-lab export runs/environment-2-seed1 --format text --figure 4.10
  maxq-lab export studies/thesis --format csv > runs.csv")]
pub(super) struct Args {
    /// Run folder or study folder.
    dir: PathBuf,

    /// Output format.
    #[arg(long, value_enum)]
    format: ExportFormat,

    /// Figure of the thesis: 4.3, 4.5, 4.7, 4.8, 4.9 or 4.10.
    #[arg(long, value_name = "NUMBER")]
    figure: Option<FigureNumber>,

    /// Output file [default: standard output].
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ExportFormat {
    /// Table with one header line and units in the column names.
    Csv,
    /// JSON for programs.
    Json,
    /// Markdown to read.
    Markdown,
    /// Hierarchies for Graphviz.
    Dot,
    /// Figure as an SVG image.
    Svg,
    /// Figure as text for the terminal.
    Text,
}

/// Width of a text figure where neither $COLUMNS nor a terminal tells, in columns.
const COLUMNS: usize = 80;

/// Runs `maxq-lab export`.
pub(super) fn main(args: &Args) -> CommandResult {
    if let Some(path) = args
        .out
        .as_ref()
        .filter(|path| is_record(path) || is_plan(path))
    {
        let path = path.display();
        let message =
            format!("--out: found {path}, a file of a run or study; allowed: another file");
        return Err(message.into());
    }
    let text = if is_plan(&args.dir.join(PLAN_FILE)) {
        of_study(args)?
    } else {
        of_run(args)?
    };
    match &args.out {
        None => output::text(&text)?,
        Some(path) => write_atomically(path, text.as_bytes())
            .map_err(|error| format!("{}: {error}", path.display()))?,
    }
    Ok(ExitCode::SUCCESS)
}

/// Returns whether `path` is the plan of a study.
fn is_plan(path: &Path) -> bool {
    path.ends_with(PLAN_FILE) && path.is_file()
}

fn of_run(args: &Args) -> Result<String, Failure> {
    let run = RunSource::read(&args.dir)?;
    if let Some(number) = wanted_figure(args)? {
        let format = args.format.to_possible_value();
        let name = format.as_ref().map_or("svg", |value| value.get_name());
        return in_format(&run.figure(number, name)?, args.format);
    }
    Ok(match args.format {
        ExportFormat::Csv => run_export::individuals(&run).csv(),
        ExportFormat::Json => run_export::json(&run)?,
        ExportFormat::Markdown => run_export::markdown(&run),
        _ => run_export::dot(&run)?,
    })
}

fn of_study(args: &Args) -> Result<String, Failure> {
    let study = Study::open(&args.dir)?;
    let all = read_facts(&study)?;
    if let Some(number) = wanted_figure(args)? {
        return in_format(&study_figure(&study, &all, number)?, args.format);
    }
    Ok(match args.format {
        ExportFormat::Csv => study_export::runs(&study, &all).csv(),
        ExportFormat::Json => study_export::json(&study, &all)?,
        ExportFormat::Markdown => study_export::markdown(&study, &all),
        _ => study_export::dot(&study, &all)?,
    })
}

/// The figure asked for; svg and text require one.
fn wanted_figure(args: &Args) -> Result<Option<FigureNumber>, Failure> {
    let draws = matches!(args.format, ExportFormat::Svg | ExportFormat::Text);
    if draws && args.figure.is_none() {
        let allowed = FigureNumber::ALL.map(FigureNumber::name).join(", ");
        return Err(
            format!("--figure: found none with --format svg or text; allowed: {allowed}").into(),
        );
    }
    Ok(args.figure)
}

fn in_format(figure: &Figure, format: ExportFormat) -> Result<String, Failure> {
    Ok(match format {
        ExportFormat::Svg => figure.svg()?,
        ExportFormat::Text => figure.text(columns()),
        ExportFormat::Csv => figure.table().csv(),
        ExportFormat::Markdown => figure.table().markdown(),
        ExportFormat::Json => serde_json::to_string_pretty(figure)? + "\n",
        ExportFormat::Dot => {
            let message =
                "--format: found dot with --figure; allowed: svg, text, csv, markdown, json";
            return Err(message.into());
        }
    })
}

fn columns() -> usize {
    let said = std::env::var("COLUMNS")
        .ok()
        .and_then(|text| text.parse().ok());
    let window = || rustix::termios::tcgetwinsize(std::io::stdout()).ok();
    let wide = || window().map(|window| usize::from(window.ws_col));
    said.or_else(wide)
        .filter(|columns| *columns > 0)
        .unwrap_or(COLUMNS)
}
