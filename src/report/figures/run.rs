//! The figures of one run.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::primitives::action_values;
use super::{Chart, Figure, FigureNumber, Panel, Series, Sketch};
use crate::evolution::GenerationRecord;
use crate::lab::{
    Event, Recording, RunError, SetupError, experiment, overrides, summarise, with_changes,
};
use crate::scenario::Scenario;
use crate::words::shell_path;

/// Number of hierarchies in Figure 4.9.
const SELECTED_GENERATIONS: usize = 8;

/// A run, read from its folder.
#[derive(Clone, Debug)]
pub struct RunSource {
    /// Its folder.
    pub folder: PathBuf,
    /// Its scenario.
    pub scenario: Scenario,
    /// Its seed.
    pub seed: u64,
    /// Version and commit of the program that did it.
    pub version: String,
    /// The command lines that started and resumed it.
    pub commands: Vec<String>,
    /// Its generations.
    pub records: Vec<GenerationRecord>,
}

/// Why a figure cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum SourceError {
    /// The run cannot be read.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The experiment of its scenario cannot be built.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// The run has no finished generation yet.
    #[error("{folder}: found no finished generation; allowed: a run with at least one")]
    Empty {
        /// The folder.
        folder: String,
    },
    /// A part of the run cannot be used.
    #[error("{folder}: {message}")]
    Misfit {
        /// The folder.
        folder: String,
        /// What is wrong.
        message: String,
    },
}

impl RunSource {
    /// Reads the run in a folder.
    ///
    /// # Errors
    /// When it holds no run, or the run has no finished generation.
    pub fn read(folder: &Path) -> Result<Self, SourceError> {
        let recording = Recording::read(folder)?;
        let started = &recording.manifest.started;
        let source = Self {
            folder: folder.to_owned(),
            version: format!("{} ({})", started.version, started.commit),
            commands: recording.manifest.commands(),
            seed: recording.manifest.seed,
            scenario: recording.manifest.scenario,
            records: recording
                .events
                .into_iter()
                .filter_map(|event| match event {
                    Event::Generation(record) => Some(*record),
                    _ => None,
                })
                .collect(),
        };
        if source.records.is_empty() {
            return Err(SourceError::Empty {
                folder: folder.display().to_string(),
            });
        }
        Ok(source)
    }

    /// Returns the command that exports the run with these arguments.
    fn command(&self, arguments: &str) -> String {
        let folder = shell_path(&self.folder);
        format!("maxq-lab export {folder} {arguments}")
    }

    /// Returns the provenance of an export of the run with these arguments: the run, its changes
    /// of the built-in scenario with its name, and all commands.
    #[must_use]
    pub fn provenance(&self, arguments: &str) -> String {
        let generations = self.records.len();
        let changed = summarise(&overrides(&self.scenario));
        format!(
            "Run of {}, seed {}, {generations} generations, maxq-lab {}: {}; {}",
            with_changes(&self.scenario.name, changed.as_deref()),
            self.seed,
            self.version,
            self.commands.join("; "),
            self.command(arguments)
        )
    }

    /// Returns a figure of the run. `format` is that of the export, for the provenance.
    ///
    /// # Errors
    /// When the run does not hold what the figure needs.
    pub fn figure(&self, number: FigureNumber, format: &str) -> Result<Figure, SourceError> {
        let arguments = format!("--format {format} --figure {}", number.name());
        let (title, panels) = match number {
            FigureNumber::F4_3 => (
                String::from("Action values of the primitive subtasks"),
                self.action_values()?,
            ),
            FigureNumber::F4_5 => (
                String::from("Hierarchy obtained"),
                self.hierarchies(&[self.last()])?,
            ),
            FigureNumber::F4_7 => (
                String::from("Structural difference to the best hierarchy"),
                vec![Panel::Chart(self.differences())],
            ),
            FigureNumber::F4_8 => (
                String::from("Performance of the better half of the population"),
                vec![Panel::Chart(self.performance())],
            ),
            FigureNumber::F4_9 => (
                String::from("The best hierarchy of selected generations"),
                self.hierarchies(&self.selected())?,
            ),
            FigureNumber::F4_10 => (
                String::from("Selection probabilities of the primitive subtasks"),
                self.probabilities(),
            ),
        };
        Ok(Figure {
            number: number.name(),
            title: format!("{title}, {}", self.scenario.name),
            provenance: self.provenance(&arguments),
            panels,
        })
    }

    fn last(&self) -> usize {
        self.records.len() - 1
    }

    /// Returns the indices of evenly spaced generations, from the first to the last.
    fn selected(&self) -> Vec<usize> {
        let count = SELECTED_GENERATIONS.min(self.records.len());
        let at = |index: usize| index * self.last() / (count - 1).max(1);
        (0..count).map(at).collect()
    }

    fn differences(&self) -> Chart {
        let points = self
            .records
            .iter()
            .map(|r| (r.generation as f64, r.mean_difference));
        Chart {
            title: String::from("Mean difference of the better half to the best"),
            x: String::from("generation"),
            y: String::from("structural difference (points)"),
            y_range: None,
            series: vec![Series {
                name: String::from("mean difference"),
                points: points.collect(),
                band: Vec::new(),
                mark: 0,
            }],
        }
    }

    fn performance(&self) -> Chart {
        let ranks = self
            .records
            .first()
            .map_or(0, |record| record.individuals.len() / 2);
        let series = (1..=ranks.max(1)).map(|rank| Series {
            name: format!("rank {rank}"),
            points: self
                .records
                .iter()
                .filter_map(|r| Some((r.generation as f64, r.mean_trial_steps(rank)?)))
                .collect(),
            band: Vec::new(),
            mark: rank - 1,
        });
        Chart {
            title: String::from("Fitness by rank"),
            x: String::from("generation"),
            y: String::from("mean trial length (time steps)"),
            y_range: None,
            series: series.collect(),
        }
    }

    fn probabilities(&self) -> Vec<Panel> {
        let first = self.records.first();
        let of_types = first.map_or(&[][..], |record| &record.selection_probabilities);
        // A primitive subtask has the same mark in all charts.
        let names = of_types.iter().flatten().flat_map(|of_type| of_type.keys());
        let marks: BTreeSet<_> = names.collect();
        let marks: Vec<_> = marks.into_iter().collect();
        (0..of_types.len())
            .map(|index| Panel::Chart(self.probabilities_in(index, &marks)))
            .collect()
    }

    fn probabilities_in(&self, state_type: usize, marks: &[&String]) -> Chart {
        let at = |record: &GenerationRecord, name: &String| {
            let of_type = record.selection_probabilities.get(state_type)?.as_ref()?;
            Some((record.generation as f64, *of_type.get(name)?))
        };
        // A primitive subtask that is never selected has no line.
        let series = marks.iter().enumerate().map(|(mark, name)| Series {
            name: (*name).clone(),
            points: self.records.iter().filter_map(|r| at(r, name)).collect(),
            band: Vec::new(),
            mark,
        });
        Chart {
            title: format!("State type {}", state_type + 1),
            x: String::from("generation"),
            y: String::from("probability of selection"),
            y_range: Some([0.0, 1.0]),
            series: series
                .filter(|s| s.points.iter().any(|(_, p)| *p > 0.0))
                .collect(),
        }
    }

    fn hierarchies(&self, generations: &[usize]) -> Result<Vec<Panel>, SourceError> {
        let best = |index: &usize| {
            let record = self.records.get(*index)?;
            let best = record.individuals.first()?;
            let steps = record.mean_trial_steps(1)?;
            let caption = format!(
                "Generation {}: {steps:.0} time steps a trial",
                record.generation
            );
            Some((caption, best.tree.clone()))
        };
        let trees = generations.iter().filter_map(best).collect();
        let sketches = sketches(&self.scenario, trees)?;
        let sketches = sketches.map_err(|message| self.misfit(message))?;
        Ok(sketches.into_iter().map(Panel::Tree).collect())
    }

    fn action_values(&self) -> Result<Vec<Panel>, SourceError> {
        let charts = action_values(&self.scenario, &self.folder)?;
        let charts = charts.map_err(|message| self.misfit(message))?;
        Ok(charts.into_iter().map(Panel::Chart).collect())
    }

    fn misfit(&self, message: String) -> SourceError {
        SourceError::Misfit {
            folder: self.folder.display().to_string(),
            message,
        }
    }
}

/// Lays out hierarchies, given as captions and texts.
///
/// # Errors
/// When the experiment of the scenario cannot be built; the inner error when a text is not a
/// hierarchy.
pub(super) fn sketches(
    scenario: &Scenario,
    trees: Vec<(String, String)>,
) -> Result<Result<Vec<Sketch>, String>, SetupError> {
    let experiment = experiment(scenario.clone(), 0)?;
    let sketches = trees.into_iter().map(|(caption, text)| {
        let tree = experiment.read_tree(&text);
        let tree = tree.map_err(|error| error.to_string())?;
        Ok(Sketch::of(caption, &tree, experiment.catalogue()))
    });
    Ok(sketches.collect())
}
