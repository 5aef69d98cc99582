//! The facts of finished runs, read from their folders.

use serde::Serialize;

use super::arm::{Arm, Base};
use super::results::{PlannedRun, StudyRunError, check_evaluation, evaluation};
use super::study::{RunId, Study};
use super::winner::Winner;
use crate::evolution::GenerationRecord;
use crate::files::FileError;
use crate::lab::{EVENTS, Event, LaterSummary, Outcome, Recording, experiment};

/// The facts of a finished run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Facts {
    /// The run.
    #[serde(skip)]
    pub run: RunId,
    /// Version and commit of the program that did it.
    pub version: String,
    /// Number of generations.
    pub generations: u64,
    /// Whether evolution converged; `false` if it ended at its generation limit.
    pub converged: bool,
    /// Number of control steps, including the training of the primitive subtasks.
    pub control_steps: u64,
    /// The best individual of the last generation.
    pub winner: Winner,
    /// Numbers of each generation.
    pub course: Vec<GenerationFacts>,
    /// Results of the winner's structure on fresh trials.
    pub fresh: FreshFacts,
    /// What the best hierarchy learned after evolution, if the scenario asks for it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub later: Option<LaterSummary>,
}

/// Numbers of one generation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct GenerationFacts {
    /// Mean time steps of a scored trial of the individual with the best fitness.
    pub best_steps: f64,
    /// Mean time steps of a scored trial of the middle individual by fitness: the eighth of 16.
    pub middle_steps: f64,
    /// Mean structural difference of the better half of the population to the best individual
    /// (Thesis 4.5.2); 0 if they are equal, and negative otherwise.
    pub difference: f64,
    /// Total variation distance of the selection probabilities from those of the generation
    /// before, averaged over state types; 0 in the first generation.
    pub policy_change: f64,
}

/// Results of the winner's structure on fresh trials, with new hierarchies.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FreshFacts {
    /// Mean time steps of a trial.
    pub steps: f64,
    /// Standard error of the mean.
    pub standard_error: Option<f64>,
    /// Proportion of the trials that delivered.
    pub delivered_share: f64,
}

impl Facts {
    /// Reads the facts of a run; `None` if it is not done.
    ///
    /// # Errors
    /// When its folder holds another run, or a file cannot be read.
    pub fn read(study: &Study, run: &RunId) -> Result<Option<Self>, StudyRunError> {
        let folder = study.run_folder(run);
        let planned = PlannedRun::of(study, run)?;
        let (Some(outcome), Some(found)) = (Outcome::read(&folder)?, evaluation(&folder)?) else {
            return Ok(None);
        };
        check_evaluation(study, run, &outcome, &found)?;
        let manifest = planned.manifest()?;
        let (events, file) = (Recording::read(&folder)?.events, folder.join(EVENTS));
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
        let experiment = experiment(planned.scenario, run.seed)?;
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
                steps: found.evaluation.mean,
                standard_error: found.evaluation.standard_error,
                delivered_share: found.evaluation.delivered_share,
            },
            later: outcome.later,
        }))
    }

    /// Returns a number of the generation at a point of the run, from 0 for the first generation
    /// to 1 for the last.
    #[must_use]
    pub fn at(&self, share: f64, of: impl Fn(&GenerationFacts) -> f64) -> Option<f64> {
        let last = self.course.len().checked_sub(1)?;
        self.course
            .get((last as f64 * share).round() as usize)
            .map(of)
    }

    /// Returns the mean of a number over the generations between two points of the run, given as
    /// for [`Facts::at`]. The part has at least one generation.
    #[must_use]
    pub fn over(&self, from: f64, to: f64, of: impl Fn(&GenerationFacts) -> f64) -> f64 {
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

fn course(records: &[Box<GenerationRecord>]) -> Vec<GenerationFacts> {
    let mut before: Option<&GenerationRecord> = None;
    let mut course = Vec::with_capacity(records.len());
    for record in records {
        // Sorted by fitness, because ranks are random under random selection.
        let mut means: Vec<_> = (1..=record.individuals.len())
            .filter_map(|rank| record.mean_trial_steps(rank))
            .collect();
        means.sort_unstable_by(f64::total_cmp);
        let at = |index: usize| means.get(index).copied().unwrap_or(f64::NAN);
        course.push(GenerationFacts {
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
