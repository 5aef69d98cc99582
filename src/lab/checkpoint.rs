//! `checkpoint.json`: a state of a run, everything needed to go on.
//!
//! The file is one JSON object: the format, a CRC-32 of the bytes of `state`, and
//! `state`. Numbers are written with as few digits as read back to the same bits, so
//! loading and saving again gives the same bytes.

use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;
use thiserror::Error;

use crate::evolution::{Experiment, Individual, Origin, State, TreeError, read_tree};
use crate::hierarchy::to_text;
use crate::learning::{CompositeValues, Hierarchy, Skill, Skills};
use crate::scenario::{LearningModel, Scenario, ScenarioError};
use crate::worlds::{Catalogue, World};

/// Version of the checkpoint format.
pub const CHECKPOINT_FORMAT: u32 = 1;

/// Largest checkpoint that is read, in bytes; a large population of complete
/// hierarchies takes a tenth of it.
pub const MAX_CHECKPOINT_BYTES: u64 = 1 << 30;

/// Largest value of a counter: 10 million control steps a second for 28 years.
const MAX_COUNT: u64 = 1 << 53;

/// Why a checkpoint cannot be used.
#[derive(Debug, Error)]
pub enum CheckpointError {
    /// It is not the JSON of a checkpoint.
    #[error("line {}, column {}, at {place}: {source}", .source.line(), .source.column())]
    Syntax {
        /// Where in the file.
        place: String,
        /// What is wrong there.
        source: serde_json::Error,
    },
    /// It was written by another version of the program.
    #[error("format: found {found}; allowed: {CHECKPOINT_FORMAT}")]
    Format {
        /// The format found.
        found: u32,
    },
    /// Something was changed after it was written.
    #[error(
        "crc32: the state has {actual}, the file says {stated}: the file was changed or damaged"
    )]
    Checksum {
        /// Of the state as it is.
        actual: String,
        /// As the file states it.
        stated: String,
    },
    /// Its scenario is not valid.
    #[error("state.scenario: {0}")]
    Scenario(#[from] ScenarioError),
    /// A part of it does not fit its scenario.
    #[error("{place}: {message}")]
    Misfit {
        /// Where in the file.
        place: String,
        /// What was found and what is allowed.
        message: String,
    },
    /// A learned value is not a number; such a state is not written.
    #[error(
        "individual {id}: learning has diverged, a learned value is not finite; allowed: settings \
         with a smaller learning rate or smaller initial values"
    )]
    Diverged {
        /// The individual.
        id: u64,
    },
}

/// How much of `events.jsonl` belongs to a checkpoint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LogPosition {
    /// Lines.
    pub lines: u64,
    /// Bytes.
    pub bytes: u64,
    /// CRC-32 of these bytes.
    pub crc32: u32,
}

/// A checkpoint as it is in the file; what it means is read with its experiment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint {
    /// The complete scenario.
    pub scenario: Scenario,
    /// Seed of all random streams; with the generation, the whole random state.
    pub seed: u64,
    /// Generations lived.
    pub generation: u64,
    /// Whether the better half has one structure.
    pub converged: bool,
    /// Control steps of the run, training of the primitive subtasks included.
    pub control_steps: u64,
    /// Id of the next new individual.
    pub next_id: u64,
    /// The events so far.
    pub events: LogPosition,
    primitives: Vec<PrimitiveFile>,
    individuals: Vec<IndividualFile>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PrimitiveFile {
    subtask: String,
    /// Parameters of Q_prim, one vector an action.
    actions: Vec<Vec<f32>>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct IndividualFile {
    id: u64,
    origin: Origin,
    tree: String,
    /// In preorder.
    composites: Vec<CompositeFile>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CompositeFile {
    subtask: String,
    temperature: f32,
    children: Vec<ChildFile>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ChildFile {
    subtask: String,
    /// Parameters of C~, one block of features per active state type.
    c_tilde: Vec<f32>,
    /// Parameters of C.
    c: Vec<f32>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Envelope<'t> {
    format: u32,
    crc32: String,
    #[serde(borrow)]
    state: &'t RawValue,
}

/// The part of an envelope that every version has.
#[derive(Deserialize)]
struct AnyFormat {
    format: u32,
}

impl Checkpoint {
    /// The checkpoint of a state.
    ///
    /// # Errors
    /// When a learned value is not finite.
    pub fn of<W: World>(
        experiment: &Experiment<W>,
        seed: u64,
        state: &State,
        events: LogPosition,
    ) -> Result<Self, CheckpointError> {
        let catalogue = experiment.catalogue();
        let individuals = state.individuals.iter();
        Ok(Self {
            scenario: experiment.scenario.clone(),
            seed,
            generation: state.generation,
            converged: state.converged,
            control_steps: state.control_steps,
            next_id: state.next_id,
            events,
            primitives: state
                .skills
                .all()
                .iter()
                .map(|skill| PrimitiveFile {
                    subtask: skill.subtask.name(catalogue).to_owned(),
                    actions: skill.vectors().map(<[f32]>::to_vec).collect(),
                })
                .collect(),
            individuals: individuals
                .map(|individual| IndividualFile::of(individual, catalogue))
                .collect::<Result<_, _>>()?,
        })
    }

    /// The bytes of the file.
    ///
    /// # Errors
    /// When serialisation fails.
    pub fn to_bytes(&self) -> Result<Vec<u8>, serde_json::Error> {
        let state = serde_json::to_string(self)?;
        let crc32 = checksum(state.as_bytes());
        let mut bytes = Vec::with_capacity(state.len() + 64);
        bytes.extend_from_slice(
            format!("{{\"format\":{CHECKPOINT_FORMAT},\"crc32\":\"{crc32}\",\"state\":").as_bytes(),
        );
        bytes.extend_from_slice(state.as_bytes());
        bytes.extend_from_slice(b"}\n");
        Ok(bytes)
    }

    /// Reads the text of a file. Version and checksum are checked before anything else.
    ///
    /// # Errors
    /// When the text is not a checkpoint of this version, was changed, or holds a
    /// scenario that breaks a rule.
    pub fn from_text(text: &str) -> Result<Self, CheckpointError> {
        let any: AnyFormat = parse(text, "")?;
        if any.format != CHECKPOINT_FORMAT {
            return Err(CheckpointError::Format { found: any.format });
        }
        let envelope: Envelope<'_> = parse(text, "")?;
        let state = envelope.state.get();
        let actual = checksum(state.as_bytes());
        if actual != envelope.crc32 {
            return Err(CheckpointError::Checksum {
                actual,
                stated: envelope.crc32,
            });
        }
        let mut checkpoint: Self = parse(state, "state.")?;
        checkpoint.scenario = checkpoint.scenario.checked("the checkpoint's scenario")?;
        Ok(checkpoint)
    }

    /// Whether the checkpoint was taken of a run of this scenario and seed. The
    /// generation limit may have been changed since.
    ///
    /// # Errors
    /// With the place of what differs, what was found and what is allowed.
    pub fn check_origin(&self, scenario: &Scenario, seed: u64) -> Result<(), String> {
        if seed != self.seed {
            let allowed = self.seed;
            return Err(format!(
                "seed: found {seed}; allowed: {allowed}, as in checkpoint.json"
            ));
        }
        let mut own = self.scenario.clone();
        own.evolution.generation_limit = scenario.evolution.generation_limit;
        if own != *scenario {
            return Err(String::from(
                "scenario: found another; allowed: that of checkpoint.json, but for the \
                 generation_limit",
            ));
        }
        Ok(())
    }

    /// The state that the checkpoint holds, for the experiment of its scenario.
    ///
    /// # Errors
    /// When hierarchies or learned values do not fit the scenario.
    pub fn state<W: World>(&self, experiment: &Experiment<W>) -> Result<State, CheckpointError> {
        let catalogue = experiment.catalogue();
        let evolution = &experiment.scenario.evolution;
        if self.individuals.len() != evolution.population_size {
            return Err(misfit(
                "state.individuals",
                format!(
                    "found {}; allowed: {}, the population_size",
                    self.individuals.len(),
                    evolution.population_size
                ),
            ));
        }
        self.check_counters()?;
        let individuals = self.individuals.iter().enumerate().map(|(index, file)| {
            let place = format!("state.individuals[{index}]");
            file.individual(&place, catalogue, &experiment.scenario)
        });
        Ok(State {
            generation: self.generation,
            individuals: individuals.collect::<Result<_, _>>()?,
            skills: self.skills(catalogue)?,
            next_id: self.next_id,
            control_steps: self.control_steps,
            converged: self.converged,
        })
    }

    /// The counters leave room to count on.
    fn check_counters(&self) -> Result<(), CheckpointError> {
        for (name, found) in [
            ("generation", self.generation),
            ("next_id", self.next_id),
            ("control_steps", self.control_steps),
        ] {
            if found > MAX_COUNT {
                let message = format!("found {found}; allowed: 0 to {MAX_COUNT}");
                return Err(misfit(&format!("state.{name}"), message));
            }
        }
        Ok(())
    }

    fn skills(&self, catalogue: &Catalogue) -> Result<Skills, CheckpointError> {
        let skills = self.primitives.iter().enumerate().map(|(index, file)| {
            let place = format!("state.primitives[{index}]");
            let subtask = catalogue
                .find(&file.subtask)
                .ok_or_else(|| misfit(&place, format!("found subtask {:?}", file.subtask)))?;
            Skill::from_vectors(subtask, catalogue, &file.actions).ok_or_else(|| {
                let width = catalogue.width(subtask);
                let actions = catalogue.subtask(subtask).actions();
                misfit(
                    &place,
                    format!("allowed: {actions} vectors of {width} numbers"),
                )
            })
        });
        Skills::new(skills.collect::<Result<_, _>>()?, catalogue).ok_or_else(|| {
            misfit(
                "state.primitives",
                String::from("allowed: each primitive subtask once, in order"),
            )
        })
    }
}

impl IndividualFile {
    fn of(individual: &Individual, catalogue: &Catalogue) -> Result<Self, CheckpointError> {
        let tree = individual.hierarchy.tree();
        let nodes = individual.hierarchy.values().iter().enumerate();
        let composites: Vec<_> = nodes
            .filter_map(|(node, values)| values.as_ref().map(|values| (node, values)))
            .map(|(node, values)| CompositeFile {
                subtask: tree.subtask(node).name(catalogue).to_owned(),
                temperature: values.temperature,
                children: tree
                    .children(node)
                    .zip(values.vectors())
                    .map(|(child, [c_tilde, c])| ChildFile {
                        subtask: tree.subtask(child).name(catalogue).to_owned(),
                        c_tilde,
                        c,
                    })
                    .collect(),
            })
            .collect();
        let finite = composites
            .iter()
            .flat_map(|composite| &composite.children)
            .all(|child| {
                child
                    .c_tilde
                    .iter()
                    .chain(&child.c)
                    .all(|value| value.is_finite())
            });
        if !finite {
            return Err(CheckpointError::Diverged { id: individual.id });
        }
        Ok(Self {
            id: individual.id,
            origin: individual.origin.clone(),
            tree: to_text(tree, catalogue),
            composites,
        })
    }

    fn individual(
        &self,
        place: &str,
        catalogue: &Catalogue,
        scenario: &Scenario,
    ) -> Result<Individual, CheckpointError> {
        let tree = read_tree(&self.tree, catalogue, scenario.evolution.maximum_depth)
            .map_err(|error: TreeError| misfit(&format!("{place}.tree"), error.to_string()))?;
        let mut files = self.composites.iter();
        let mut values = Vec::with_capacity(tree.nodes().len());
        for node in 0..tree.nodes().len() {
            let subtask = tree.subtask(node);
            if !catalogue.subtask(subtask).is_composite() {
                values.push(None);
                continue;
            }
            let name = subtask.name(catalogue);
            let children = tree
                .children(node)
                .map(|child| tree.subtask(child).name(catalogue));
            let file = files.next().filter(|file| {
                let listed = file.children.iter().map(|child| child.subtask.as_str());
                file.subtask == name && listed.eq(children)
            });
            let place = format!("{place}.composites ({name})");
            let file = file.ok_or_else(|| {
                misfit(
                    &place,
                    String::from(
                        "allowed: the composites of the tree and their children, in order",
                    ),
                )
            })?;
            check_temperature(&place, file.temperature, &scenario.learning)?;
            values.push(Some(file.values(subtask, catalogue).ok_or_else(|| {
                let width = catalogue.width(subtask);
                misfit(
                    &place,
                    format!("allowed: {width} numbers in c_tilde and in c"),
                )
            })?));
        }
        let extra = files.next().is_some();
        let hierarchy = Hierarchy::from_parts(tree, values).filter(|_| !extra);
        let hierarchy = hierarchy.ok_or_else(|| {
            misfit(
                place,
                String::from("allowed: one entry in composites for each composite of the tree"),
            )
        })?;
        Ok(Individual {
            id: self.id,
            origin: self.origin.clone(),
            hierarchy,
        })
    }
}

impl CompositeFile {
    fn values(
        &self,
        subtask: crate::worlds::SubtaskId,
        catalogue: &Catalogue,
    ) -> Option<CompositeValues> {
        let vectors: Vec<_> = self
            .children
            .iter()
            .map(|child| [child.c_tilde.clone(), child.c.clone()])
            .collect();
        CompositeValues::from_vectors(subtask, catalogue, self.temperature, &vectors)
    }
}

/// A temperature falls from its initial value to its limit.
fn check_temperature(
    place: &str,
    found: f32,
    learning: &LearningModel,
) -> Result<(), CheckpointError> {
    let (limit, initial) = (
        learning.temperature_limit as f32,
        learning.initial_temperature as f32,
    );
    match (limit..=initial).contains(&found) {
        true => Ok(()),
        false => Err(misfit(
            place,
            format!("temperature: found {found}; allowed: {limit} to {initial}"),
        )),
    }
}

fn misfit(place: &str, message: String) -> CheckpointError {
    CheckpointError::Misfit {
        place: place.to_owned(),
        message,
    }
}

fn checksum(bytes: &[u8]) -> String {
    format!("{:08x}", crc32fast::hash(bytes))
}

fn parse<'t, T: Deserialize<'t>>(text: &'t str, prefix: &str) -> Result<T, CheckpointError> {
    let mut json = serde_json::Deserializer::from_str(text);
    let value =
        serde_path_to_error::deserialize(&mut json).map_err(|error| CheckpointError::Syntax {
            place: format!("{prefix}{}", error.path()),
            source: error.into_inner(),
        })?;
    json.end().map_err(|source| CheckpointError::Syntax {
        place: String::from("the end of the file"),
        source,
    })?;
    Ok(value)
}
