//! The report of a study as files.

use std::fs;
use std::path::{Path, PathBuf};

use super::document::markdown;
use super::facts::Facts;
use super::figures::{FigureError, FigureNumber, SourceError, study_figure};
use super::findings::Findings;
use super::single::SingleError;
use super::study::{Study, StudyError};
use super::tables::{
    claims_table, comparisons_table, generations_table, metrics_table, runs_table,
};
use crate::files::{FileError, write_atomically};

/// A report that was written.
#[derive(Clone, Debug)]
pub struct Written {
    /// What it says.
    pub findings: Findings,
    /// Its text, Markdown.
    pub text: String,
    /// Its files.
    pub files: Vec<PathBuf>,
}

/// Why a report could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A run cannot be read.
    #[error(transparent)]
    Run(#[from] SingleError),
    /// A file cannot be written.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A figure cannot be made.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// A figure cannot be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
}

/// The facts of all runs that are done.
///
/// # Errors
/// When a folder holds another run, or a file that cannot be read.
pub fn read_facts(study: &Study) -> Result<Vec<Facts>, SingleError> {
    let mut all = Vec::new();
    for run in study.runs() {
        all.extend(Facts::read(study, &run)?);
    }
    Ok(all)
}

/// Writes the report of the runs that are done to `report/` in the study's folder:
/// `report.md`, `report.json`, tables as CSV, figures as SVG. The same runs give the same
/// bytes.
///
/// # Errors
/// When a run cannot be read, or a file cannot be written.
pub fn write_report(study: &Study) -> Result<Written, ReportError> {
    let all = read_facts(study)?;
    let findings = Findings::from_facts(study, &all);
    let text = markdown(&findings);
    let mut json = serde_json::to_vec_pretty(&findings).unwrap_or_default();
    json.push(b'\n');
    let tables = [
        ("runs.csv", runs_table(study, &all, &findings.provenance)),
        ("generations.csv", generations_table(study, &all)),
        ("metrics.csv", metrics_table(&findings)),
        ("comparisons.csv", comparisons_table(&findings)),
        ("claims.csv", claims_table(&findings)),
    ];
    let mut contents = vec![
        ("report.md", text.clone().into_bytes()),
        ("report.json", json),
    ];
    contents.extend(tables.map(|(name, table)| (name, table.csv().into_bytes())));
    let mut contents: Vec<_> = contents
        .into_iter()
        .map(|(name, bytes)| (name.to_owned(), bytes))
        .collect();
    for number in FigureNumber::ALL.into_iter().filter(|_| !all.is_empty()) {
        let figure = study_figure(study, &all, number)?;
        if figure.panels.is_empty() {
            // Not every world has primitive subtasks that look at a single reading.
            continue;
        }
        let name = number.name();
        contents.push((format!("figure-{name}.svg"), figure.svg()?.into_bytes()));
        contents.push((
            format!("figure-{name}.csv"),
            figure.table().csv().into_bytes(),
        ));
    }
    let folder = study.folder.join("report");
    let files = contents
        .iter()
        .map(|(name, bytes)| write(&folder, name, bytes));
    let files = files.collect::<Result<_, _>>()?;
    Ok(Written {
        findings,
        text,
        files,
    })
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<PathBuf, StudyError> {
    let path = folder.join(name);
    let written = fs::create_dir_all(folder).and_then(|()| write_atomically(&path, bytes));
    written.map_err(|error| FileError::new(&path, error))?;
    Ok(path)
}
