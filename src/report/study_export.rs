//! Exports a study as text, and writes its report to files.

use std::fs;
use std::path::{Path, PathBuf};

use super::arm::Base;
use super::document;
use super::facts::Facts;
use super::figures::{FigureError, FigureNumber, SourceError, study_figure};
use super::findings::Findings;
use super::provenance::Provenance;
use super::results::StudyRunError;
use super::run_export::tree_dot;
use super::study::Study;
use super::study_tables::{
    claims_table, comparisons_table, generations_table, metrics_table, runs_table,
};
use super::table::Table;
use crate::files::{FileError, write_atomically};
use crate::lab::SetupError;

/// A report that was written.
#[derive(Clone, Debug)]
pub struct WrittenReport {
    /// Its findings.
    pub findings: Findings,
    /// Its text, as Markdown.
    pub text: String,
    /// Its files.
    pub files: Vec<PathBuf>,
}

/// Why a report cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A run cannot be read.
    #[error(transparent)]
    Run(#[from] StudyRunError),
    /// A file cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A figure cannot be made.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// A figure cannot be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
}

/// Reads the facts of all finished runs, in the order of the study.
///
/// # Errors
/// When a folder holds another run, or a file cannot be read.
pub fn read_facts(study: &Study) -> Result<Vec<Facts>, StudyRunError> {
    let mut all = Vec::new();
    for run in study.runs() {
        all.extend(Facts::read(study, &run)?);
    }
    Ok(all)
}

/// Writes the report of the finished runs to `report/` in the study's folder: `report.md`,
/// `report.json`, tables as CSV, and figures as SVG and CSV. The same runs give the same bytes.
///
/// # Errors
/// When a run cannot be read, or a file cannot be written.
pub fn write_report(study: &Study) -> Result<WrittenReport, ReportError> {
    let all = read_facts(study)?;
    let findings = Findings::from_facts(study, &all);
    let text = document::markdown(&findings);
    let json = serde_json::to_string_pretty(&findings).unwrap_or_default() + "\n";
    let provenance = &findings.provenance;
    let generations = generations_table(study, &all, provenance);
    let tables = [
        ("runs.csv", runs_table(study, &all, provenance)),
        ("generations.csv", generations),
        ("metrics.csv", metrics_table(&findings)),
        ("comparisons.csv", comparisons_table(&findings)),
        ("claims.csv", claims_table(&findings)),
    ];
    let mut contents = vec![
        (String::from("report.md"), text.clone()),
        (String::from("report.json"), json),
    ];
    contents.extend(tables.map(|(name, table)| (name.to_owned(), table.csv())));
    for number in FigureNumber::ALL.into_iter().filter(|_| !all.is_empty()) {
        let figure = study_figure(study, &all, number)?;
        if figure.panels.is_empty() {
            // Figure 4.3 needs primitive subtasks that read a single sensor, which not every world
            // has.
            continue;
        }
        let name = number.name();
        contents.push((format!("figure-{name}.svg"), figure.svg()?));
        contents.push((format!("figure-{name}.csv"), figure.table().csv()));
    }
    let folder = study.folder.join("report");
    let files = contents
        .iter()
        .map(|(name, text)| write(&folder, name, text));
    let files = files.collect::<Result<_, _>>()?;
    Ok(WrittenReport {
        findings,
        text,
        files,
    })
}

fn write(folder: &Path, name: &str, text: &str) -> Result<PathBuf, FileError> {
    let path = folder.join(name);
    let written =
        fs::create_dir_all(folder).and_then(|()| write_atomically(&path, text.as_bytes()));
    written.map_err(|error| FileError::new(&path, error))?;
    Ok(path)
}

/// Returns a table with one row for each run.
#[must_use]
pub fn runs(study: &Study, all: &[Facts]) -> Table {
    runs_table(study, all, &Provenance::of(study, all))
}

/// Returns all findings as JSON.
///
/// # Errors
/// When serialisation fails.
pub fn json(study: &Study, all: &[Facts]) -> Result<String, serde_json::Error> {
    Ok(serde_json::to_string_pretty(&Findings::from_facts(study, all))? + "\n")
}

/// Returns the report as Markdown.
#[must_use]
pub fn markdown(study: &Study, all: &[Facts]) -> String {
    document::markdown(&Findings::from_facts(study, all))
}

/// Returns graphs of the most frequent final hierarchy of every scenario and evolving arm.
///
/// # Errors
/// When the experiment of a scenario cannot be built.
pub fn dot(study: &Study, all: &[Facts]) -> Result<String, SetupError> {
    let findings = Findings::from_facts(study, all);
    let mut text = format!("// {}\n", findings.provenance.line());
    for group in &findings.groups {
        let arm = study.plan.arms.iter().find(|arm| arm.name == group.arm);
        let mut scenarios = study.plan.scenarios.iter();
        let scenario = scenarios.find(|scenario| scenario.name == group.scenario);
        let (Some(scenario), Some((structure, times))) = (scenario, group.structures.first())
        else {
            continue;
        };
        if arm.is_some_and(|arm| arm.base == Base::Evolved) {
            let dot = tree_dot(scenario, structure)?;
            text += &format!(
                "// {}, {}: {times} of {} runs\n{dot}",
                group.scenario, group.arm, group.n
            );
        }
    }
    Ok(text)
}
