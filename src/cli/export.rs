//! `maxq-lab export`: tables, figures and hierarchies of runs and studies.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::ValueEnum;

use super::output::{self, CommandResult, Failure};
use crate::files::write_atomically;
use crate::report::figures::{Figure, FigureNumber, RunSource, study_figure};
use crate::report::{Study, read_facts, run_export, study_export};

/// Export a run or a study: tables, figures, hierarchies.
///
/// Of a run: its individuals as a table (csv, json), a summary (markdown), its best
/// hierarchy (dot), a figure (svg, text). Of a study: its runs as a table (csv), all
/// findings (json), the report (markdown), the most frequent final hierarchies (dot), a
/// figure (svg, text). With --figure, csv and json are the numbers of the figure.
///
/// Figures are numbered as in the thesis: 4.3 action values over the angle, 4.5 hierarchies
/// obtained, 4.7 structural difference, 4.8 performance, 4.9 the best of selected
/// generations, 4.10 selection probabilities.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab export runs/environment-2-seed1 --format svg --figure 4.8 > figure-4.8.svg
  maxq-lab export runs/environment-2-seed1 --format text --figure 4.10
  maxq-lab export studies/thesis --format csv > runs.csv")]
pub(super) struct Args {
    /// The folder of a run or of a study.
    dir: PathBuf,

    /// As what.
    #[arg(long, value_enum)]
    format: ExportFormat,

    /// A figure of the thesis: 4.3, 4.5, 4.7, 4.8, 4.9 or 4.10.
    #[arg(long, value_name = "NUMBER")]
    figure: Option<FigureNumber>,

    /// A file to write to [default: standard output].
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ExportFormat {
    /// A tidy table: one header, units in the names of columns.
    Csv,
    /// For programs.
    Json,
    /// For people.
    Markdown,
    /// Hierarchies for Graphviz.
    Dot,
    /// A figure.
    Svg,
    /// A figure in the terminal.
    Text,
}

/// Columns of a figure in text where there is no terminal that says.
const COLUMNS: usize = 80;

/// Carries out the command.
pub(super) fn main(args: &Args) -> CommandResult {
    let text = match args.dir.join("study.json").is_file() {
        true => of_study(args)?,
        false => of_run(args)?,
    };
    match &args.out {
        None => output::text(&text)?,
        Some(path) => write_atomically(path, text.as_bytes())
            .map_err(|error| format!("{}: {error}", path.display()))?,
    }
    Ok(ExitCode::SUCCESS)
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
        ExportFormat::Markdown => run_export::markdown(&run)?,
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

/// The figure asked for; formats that are figures need one.
fn wanted_figure(args: &Args) -> Result<Option<FigureNumber>, Failure> {
    let draws = matches!(args.format, ExportFormat::Svg | ExportFormat::Text);
    if draws && args.figure.is_none() {
        let allowed = FigureNumber::ALL.map(FigureNumber::name).join(", ");
        return Err(format!("--figure: found none; allowed with svg and text: {allowed}").into());
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
                "--format: found dot; allowed with --figure: svg, text, csv, markdown, json";
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
