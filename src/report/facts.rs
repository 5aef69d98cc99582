//! What a report needs to know of a run, read from its folder.

use serde::Serialize;

use super::arm::{Arm, Base};
use super::single::{SingleError, check_evaluation, check_origin, fresh, summary};
use super::study::{RunId, Study};
use crate::evolution::{GenerationRecord, RankedRecord, TreeError};
use crate::files::FileError;
use crate::hierarchy::{canonical, without_repeats};
use crate::lab::{AnyExperiment, Event, RunError, experiment, read_events};

/// A run that is done.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Facts {
    /// The run.
    #[serde(skip)]
    pub run: RunId,
    /// Version and commit of the program that did it.
    pub version: String,
    /// Generations to termination.
    pub generations: u64,
    /// Whether evolution converged; else it ended at its limit.
    pub converged: bool,
    /// Control steps, training of the primitive subtasks included.
    pub control_steps: u64,
    /// The best individual of the last generation.
    pub winner: Winner,
    /// Generation by generation.
    pub course: Vec<Moment>,
    /// How good the winner's structure is.
    pub fresh: FreshFacts,
}

/// The structure that a run ended with.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Winner {
    /// Its text.
    pub tree: String,
    /// Its structure: children sorted, repeated primitive children left out.
    pub structure: String,
    /// Its composite subtasks, the root counted.
    pub composites: Vec<String>,
    /// Its distinct primitive subtasks.
    pub primitives: Vec<String>,
    /// For each state type the primitive subtasks that can be selected.
    pub selectable: Vec<Vec<String>>,
}

/// One generation, in numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Moment {
    /// Mean time steps of a scored trial of the individual with the best fitness.
    pub best_steps: f64,
    /// The same of the individual in the middle of the population by fitness: of 16 the
    /// eighth.
    pub middle_steps: f64,
    /// Mean structural difference of the better half to the best (Thesis 4.5.2).
    pub difference: f64,
    /// How much selection probabilities have changed since the generation before: total
    /// variation distance, averaged over state types; 0 in the first.
    pub policy_change: f64,
}

/// How good the winner's structure is, by fresh hierarchies on fresh trials.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FreshFacts {
    /// Mean time steps of a trial.
    pub steps: f64,
    /// Its standard error.
    pub standard_error: Option<f64>,
    /// Share of the trials that delivered.
    pub delivered_share: f64,
}

impl Facts {
    /// The facts of a run; none while it is not done.
    ///
    /// # Errors
    /// When its folder holds another run, or a file that cannot be read.
    pub fn read(study: &Study, run: &RunId) -> Result<Option<Self>, SingleError> {
        let folder = study.run_folder(run);
        let (Some(outcome), Some(fresh)) = (summary(&folder)?, fresh(&folder)?) else {
            return Ok(None);
        };
        check_evaluation(study, run, &outcome, &fresh)?;
        let scenario = study.arm(run).apply(study.scenario(run))?;
        let manifest = check_origin(study, run, &scenario)?;
        let file = folder.join("events.jsonl");
        let events = read_events(&file).map_err(|source| RunError::Log {
            file: file.display().to_string(),
            source,
        })?;
        let records: Vec<_> = events
            .into_iter()
            .filter_map(|event| match event {
                Event::Generation(record) => Some(record),
                _ => None,
            })
            .collect();
        let best = records.last().and_then(|record| record.individuals.first());
        let best =
            best.ok_or_else(|| FileError::new(&file, String::from("holds no generation")))?;
        let experiment = experiment(scenario, run.seed)?;
        let winner = Winner::of(best, &*experiment).map_err(|error| {
            let message = format!("the best hierarchy: {error}");
            FileError::new(&file, message)
        })?;
        Ok(Some(Self {
            run: *run,
            version: format!("{} ({})", manifest.started.version, manifest.started.commit),
            generations: outcome.generations,
            converged: outcome.converged,
            control_steps: outcome.control_steps,
            winner,
            course: course(&records),
            fresh: FreshFacts {
                steps: fresh.evaluation.mean,
                standard_error: fresh.evaluation.standard_error,
                delivered_share: fresh.evaluation.delivered_share,
            },
        }))
    }

    /// A number of the course at a share of the generations: 0 the first, 1 the last.
    #[must_use]
    pub fn at(&self, share: f64, of: impl Fn(&Moment) -> f64) -> Option<f64> {
        let last = self.course.len().checked_sub(1)?;
        self.course
            .get((last as f64 * share).round() as usize)
            .map(of)
    }

    /// The mean of a number over a part of the course, from one share of the generations
    /// to another; at least one generation.
    #[must_use]
    pub fn over(&self, from: f64, to: f64, of: impl Fn(&Moment) -> f64) -> f64 {
        let n = self.course.len();
        let first = ((n as f64 * from).floor() as usize).min(n.saturating_sub(1));
        let end = ((n as f64 * to).ceil() as usize).clamp(first + 1, n.max(first + 1));
        let part = self.course.get(first..end.min(n)).unwrap_or_default();
        part.iter().map(of).sum::<f64>() / part.len() as f64
    }
}

/// The finished runs of a study.
#[derive(Clone, Copy, Debug)]
pub(super) struct StudyRuns<'s> {
    /// The study.
    pub(super) study: &'s Study,
    /// Its finished runs.
    pub(super) all: &'s [Facts],
}

impl<'s> StudyRuns<'s> {
    /// Returns the runs of a scenario and arm in the order of their seeds.
    pub(super) fn of(self, scenario: usize, arm: usize) -> Vec<&'s Facts> {
        let of = |facts: &&Facts| (facts.run.scenario, facts.run.arm) == (scenario, arm);
        let mut runs: Vec<_> = self.all.iter().filter(of).collect();
        runs.sort_by_key(|facts| facts.run.seed);
        runs
    }

    /// Returns the index of the first arm that `is` holds for.
    pub(super) fn arm(self, is: impl Fn(&Arm) -> bool) -> Option<usize> {
        self.study.plan.arms.iter().position(is)
    }

    /// Returns the index of the tested arm: the first arm that evolves as the scenario says.
    pub(super) fn tested_arm(self) -> Option<usize> {
        self.arm(|arm| arm.base == Base::Evolved)
    }
}

fn course(records: &[Box<GenerationRecord>]) -> Vec<Moment> {
    let mut before: Option<&GenerationRecord> = None;
    let mut course = Vec::with_capacity(records.len());
    for record in records {
        // By fitness, not by rank: under random selection the ranks say nothing.
        let mut means: Vec<_> = (1..=record.individuals.len())
            .filter_map(|rank| record.mean_trial_steps(rank))
            .collect();
        means.sort_unstable_by(f64::total_cmp);
        let at = |index: usize| means.get(index).copied().unwrap_or(f64::NAN);
        course.push(Moment {
            best_steps: at(0),
            middle_steps: at((means.len() / 2).saturating_sub(1)),
            difference: record.mean_difference,
            policy_change: before.map_or(0.0, |before| policy_change(before, record)),
        });
        before = Some(record);
    }
    course
}

fn policy_change(before: &GenerationRecord, after: &GenerationRecord) -> f64 {
    let types = before
        .selection_probabilities
        .iter()
        .zip(&after.selection_probabilities);
    let distances: Vec<f64> = types
        .filter_map(|(before, after)| before.as_ref().zip(after.as_ref()))
        .map(|(before, after)| {
            let moved = before.iter().map(|(name, p)| {
                let q = after.get(name).copied().unwrap_or_default();
                (p - q).abs()
            });
            moved.sum::<f64>() / 2.0
        })
        .collect();
    distances.iter().sum::<f64>() / distances.len().max(1) as f64
}

impl Winner {
    /// Reads the tree of the best individual.
    fn of(record: &RankedRecord, experiment: &dyn AnyExperiment) -> Result<Self, TreeError> {
        let catalogue = experiment.catalogue();
        let tree = experiment.read_tree(&record.tree)?;
        let composites = tree.nodes().iter().filter_map(|node| {
            let subtask = catalogue.subtask(node.subtask);
            subtask.is_composite().then(|| subtask.name.to_owned())
        });
        Ok(Self {
            composites: composites.collect(),
            structure: canonical(&without_repeats(&tree, catalogue), catalogue),
            tree: record.tree.clone(),
            primitives: record.primitives.clone(),
            selectable: record.primitives_by_state_type.clone(),
        })
    }
}
