//! Checks that the log of a run is whole and belongs to the run.
//!
//! `run.json` says whose events they must be, `checkpoint.json` holds the length and the CRC-32 of the
//! events before it, and `summary.json` says where they end.

use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

use super::checkpoint::{CheckpointHead, LogPosition};
use super::event::Event;
use super::folder::{CHECKPOINT, EVENTS, SUMMARY};
use super::kept::with_way_out;
use super::log::{LogError, check_prefix, read_event};
use super::manifest::Manifest;
use super::outcome::{BestIndividual, Outcome};
use super::pulse::PULSE_FILE;
use crate::evolution::GenerationRecord;
use crate::files::FileError;
use crate::scenario::Selection;

/// The order in which the events of a run follow one another: `started`, the generations from 1
/// without a gap, `ended`.
#[derive(Clone, Debug)]
pub(super) struct EventOrder {
    scenario: String,
    seed: u64,
    population: usize,
    is_ranked: bool,
    /// Generations so far; `None` before the first event.
    generations: Option<u64>,
    over: bool,
}

impl EventOrder {
    /// Returns the order of the events of the run in `manifest`, before its first event.
    pub(super) fn of(manifest: &Manifest) -> Self {
        let evolution = &manifest.scenario.evolution;
        Self {
            scenario: manifest.scenario.name.clone(),
            seed: manifest.seed,
            population: evolution.population_size,
            is_ranked: evolution.selection == Selection::Fitness,
            generations: None,
            over: false,
        }
    }

    /// Returns whether the last event was `ended`.
    pub(super) fn is_over(&self) -> bool {
        self.over
    }

    /// Checks the next event.
    ///
    /// # Errors
    /// When it cannot follow those before it; says what was found and what is allowed.
    pub(super) fn check(&mut self, event: &Event) -> Result<(), String> {
        if self.over {
            return Err(String::from("found an event after the end; allowed: none"));
        }
        match (event, self.generations) {
            (Event::Started { scenario, seed, .. }, None) => {
                if *scenario != self.scenario || *seed != self.seed {
                    return Err(format!(
                        "found the events of {scenario} with seed {seed}; allowed: those of {} \
                         with seed {}, as in run.json",
                        self.scenario, self.seed
                    ));
                }
                self.generations = Some(0);
            }
            (Event::Generation(record), Some(so_far)) if record.generation == so_far + 1 => {
                self.check_record(record)?;
                self.generations = Some(record.generation);
            }
            (Event::Ended { generations, .. }, Some(so_far)) if *generations == so_far => {
                self.over = true;
            }
            (found, _) => {
                return Err(format!(
                    "found {}; allowed: {}",
                    described(found),
                    self.next()
                ));
            }
        }
        Ok(())
    }

    /// Describes the events that may come next.
    fn next(&self) -> String {
        match self.generations {
            None => String::from("the start of the run"),
            Some(0) => String::from("generation 1"),
            Some(n) => format!("generation {}, or the end after {n} generations", n + 1),
        }
    }

    /// Checks that the individuals of a generation are complete, ranked, and scored by their trials.
    fn check_record(&self, record: &GenerationRecord) -> Result<(), String> {
        let individuals = &record.individuals;
        if individuals.len() != self.population {
            return Err(format!(
                "individuals: found {}; allowed: {}, the population_size",
                individuals.len(),
                self.population
            ));
        }
        let mut better = 0;
        for (index, individual) in individuals.iter().enumerate() {
            let wrong = |field: &str, found: u64, allowed: u64| {
                Err(format!(
                    "individuals[{index}].{field}: found {found}; allowed: {allowed}"
                ))
            };
            let (rank, fitness) = (individual.rank as u64, individual.fitness_steps);
            if rank != index as u64 + 1 {
                return wrong("rank", rank, index as u64 + 1);
            }
            let steps = individual.trials.iter().map(|trial| u64::from(trial.steps));
            let unlisted = individual.unlisted.map_or(0, |unlisted| unlisted.steps);
            let steps = steps.sum::<u64>().saturating_add(unlisted);
            if fitness != steps {
                return wrong("fitness_steps", fitness, steps);
            }
            if self.is_ranked && fitness < better {
                return Err(format!(
                    "individuals[{index}].fitness_steps: found {fitness}; allowed: {better} or \
                     more, as at the rank before"
                ));
            }
            better = fitness;
        }
        Ok(())
    }
}

fn described(event: &Event) -> String {
    match event {
        Event::Started { .. } => String::from("the start of a run"),
        Event::Generation(record) => format!("generation {}", record.generation),
        Event::Ended { generations, .. } => format!("the end after {generations} generations"),
        _ => String::from("an event that is not recorded"),
    }
}

/// Checks the log of a run in `folder` against `checkpoint.json` and `summary.json`, where they
/// exist. Takes about a second for a gigabyte.
///
/// It does not look at the order of the events: a reader does that, event by event.
///
/// # Errors
/// When the log does not begin with the events that the checkpoint was taken after, when a
/// run that is over lacks its end, or when a file is of another run.
pub fn check_log(folder: &Path, manifest: &Manifest) -> Result<(), FileError> {
    let (checkpoint, events) = (folder.join(CHECKPOINT), folder.join(EVENTS));
    let head = CheckpointHead::read(&checkpoint);
    let way_out = |error| with_way_out(folder, manifest, error);
    let head = head.map_err(|error| way_out(FileError::new(&checkpoint, error)))?;
    if let Some(head) = &head {
        let origin = head.check_origin(&manifest.scenario, manifest.seed);
        origin.map_err(|message| FileError::new(&checkpoint, message))?;
    }
    let outcome = Outcome::read(folder)?;
    if head.is_none() && outcome.is_none() {
        return Ok(());
    }
    let position = head
        .as_ref()
        .map_or(LogPosition::default(), |head| head.events);
    let tail = Tail::read(&events, position).map_err(|error| match error {
        LogError::NotOfCheckpoint { .. } => way_out(FileError::new(&events, error)),
        error => FileError::new(&events, error),
    })?;
    // A process that resumes a run that was over writes the end of the log anew.
    let Some(outcome) = outcome.filter(|_| !folder.join(PULSE_FILE).exists()) else {
        return Ok(());
    };
    let end = tail.check_end(&outcome, head.is_some());
    end.map_err(|error| FileError::new(&events, error))?;
    let is_best = tail.best.is_none() || tail.best == outcome.best;
    if outcome.scenario != manifest.scenario.name || outcome.seed != manifest.seed || !is_best {
        let message = String::from("is not the result of this run; allowed: that of events.jsonl");
        return Err(FileError::new(folder.join(SUMMARY), message));
    }
    Ok(())
}

/// The end of a log, from the last generation before its checkpoint.
struct Tail {
    /// The best individual of the last generation; `None` if there is none.
    best: Option<BestIndividual>,
    /// Number of the last complete line, from 1.
    line: usize,
    /// The last event.
    last: Option<Event>,
    /// Events after the checkpoint.
    later: usize,
    /// Bytes after the last complete line.
    incomplete: u64,
}

impl Tail {
    /// Checks the CRC-32 of the events before `position` and reads those after it.
    fn read(path: &Path, position: LogPosition) -> Result<Self, LogError> {
        let file = match File::open(path) {
            // The process died before it wrote the first event.
            Err(error) if error.kind() == io::ErrorKind::NotFound && position.lines == 0 => {
                return Ok(Self::empty());
            }
            file => file?,
        };
        let length = file.metadata()?.len();
        let mut reader = BufReader::new(file);
        let before = check_prefix(&mut reader, position)?;
        let mut tail = Self {
            line: usize::try_from(position.lines).unwrap_or(usize::MAX),
            ..Self::empty()
        };
        let mut bytes = position.bytes;
        tail.note(read_event(
            &mut before.as_slice(),
            &mut Vec::new(),
            tail.line,
        )?);
        let mut line = Vec::new();
        while let Some(event) = read_event(&mut reader, &mut line, tail.line + 1)? {
            bytes += line.len() as u64;
            tail.line += 1;
            tail.later += 1;
            tail.note(Some(event));
        }
        // A process that still writes may have added a line since the length was read.
        tail.incomplete = length.saturating_sub(bytes);
        Ok(tail)
    }

    fn empty() -> Self {
        Self {
            best: None,
            line: 0,
            last: None,
            later: 0,
            incomplete: 0,
        }
    }

    fn note(&mut self, event: Option<Event>) {
        if let Some(Event::Generation(record)) = &event {
            self.best = BestIndividual::of(record);
        }
        self.last = event.or(self.last.take());
    }

    /// Checks that the log of a run that is over ends as its result says.
    fn check_end(&self, outcome: &Outcome, has_checkpoint: bool) -> Result<(), LogError> {
        let allowed = outcome.generations;
        let message = match &self.last {
            _ if self.incomplete > 0 => {
                format!("found {} bytes without a line end", self.incomplete)
            }
            Some(Event::Ended { generations, .. }) if *generations != allowed => {
                format!("found the end after {generations} generations")
            }
            Some(Event::Ended { .. }) if has_checkpoint && self.later != 1 => {
                format!("found {} events after the checkpoint", self.later)
            }
            Some(Event::Ended { .. }) => return Ok(()),
            Some(found) => format!("found {} as the last event", described(found)),
            None => String::from("found no event"),
        };
        Err(LogError::Line {
            line: self.line,
            message: format!(
                "{message}; allowed: one last line with the end after {allowed} generations, as in \
                 summary.json"
            ),
        })
    }
}
