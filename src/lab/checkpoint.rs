//! `checkpoint.json`: all that resuming a run needs.
//!
//! The file is one JSON object: the format, the CRC-32 of the bytes of `state`, and `state`.
//! Numbers have the fewest digits that read back to the same bits, so loading and saving gives
//! the same bytes.

use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Serializer;
use serde_json::ser::{CompactFormatter, Formatter};
use serde_json::value::RawValue;

use super::checkpoint_error::{CHECKPOINT_FORMAT, CheckpointError};
use super::population_file::{IndividualFile, PrimitiveFile, primitives};
use crate::evolution::EvolutionState;
use crate::files::{Limits, parse_json, read_text};
use crate::learning::{PrimitiveSet, PrimitiveValues};
use crate::scenario::Scenario;
use crate::worlds::Catalogue;

/// Limits of checkpoints. A large population of complete hierarchies takes a tenth of them.
pub const CHECKPOINT_LIMITS: Limits = Limits {
    bytes: 1 << 30,
    depth: 32,
    values: 1 << 28,
};

/// Largest value of a counter; 10 million control steps a second take 28 years to reach it.
const MAX_COUNT: u64 = 1 << 53;

/// The part of `events.jsonl` that belongs to a checkpoint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LogPosition {
    /// Number of lines.
    pub lines: u64,
    /// Number of bytes.
    pub bytes: u64,
    /// CRC-32 of these bytes.
    pub crc32: u32,
}

/// The content of a checkpoint file. [`Checkpoint::state`] reads the population from it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint {
    /// The complete scenario.
    pub scenario: Scenario,
    /// Seed of all random streams. There is no other random state: each stream begins anew with
    /// a generation.
    pub seed: u64,
    /// Number of generations.
    pub generation: u64,
    /// Whether evolution has converged.
    pub converged: bool,
    /// Control steps of the run, training of the primitive subtasks included.
    pub control_steps: u64,
    /// Id of the next new individual.
    pub next_id: u64,
    /// The events before the checkpoint.
    pub events: LogPosition,
    primitives: Vec<PrimitiveFile>,
    individuals: Vec<IndividualFile>,
}

/// The part of a checkpoint that says of which run it is, and which events came before it.
#[derive(Debug, Deserialize)]
pub(super) struct CheckpointHead {
    scenario: Scenario,
    seed: u64,
    /// The events before the checkpoint.
    pub(super) events: LogPosition,
}

/// JSON without spaces. A number equal to the one before it is copied and not formatted again:
/// many parameters still have their initial value.
#[derive(Default)]
struct Compact {
    bits: Option<u32>,
    text: Vec<u8>,
}

impl Formatter for Compact {
    fn write_f32<W: ?Sized + io::Write>(&mut self, writer: &mut W, value: f32) -> io::Result<()> {
        if self.bits != Some(value.to_bits()) {
            self.bits = Some(value.to_bits());
            self.text.clear();
            CompactFormatter.write_f32(&mut self.text, value)?;
        }
        writer.write_all(&self.text)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Envelope<'t> {
    #[serde(rename = "format")]
    _format: u32,
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
    /// Returns the checkpoint of a state.
    ///
    /// # Errors
    /// When a learned value is not finite.
    pub fn of(
        scenario: &Scenario,
        catalogue: &Catalogue,
        seed: u64,
        state: &EvolutionState,
        events: LogPosition,
    ) -> Result<Self, CheckpointError> {
        check_finite(state)?;
        let individuals = state.individuals.iter();
        Ok(Self {
            scenario: scenario.clone(),
            seed,
            generation: state.generation,
            converged: state.converged,
            control_steps: state.control_steps,
            next_id: state.next_id,
            events,
            primitives: state
                .primitives
                .all()
                .iter()
                .map(|primitive| PrimitiveFile::of(primitive, catalogue))
                .collect(),
            individuals: individuals
                .map(|individual| IndividualFile::of(individual, catalogue))
                .collect(),
        })
    }

    /// Returns the bytes of the file.
    ///
    /// # Errors
    /// When serialisation fails.
    pub fn to_bytes(&self) -> Result<Vec<u8>, serde_json::Error> {
        let head = |crc32: &str| {
            format!("{{\"format\":{CHECKPOINT_FORMAT},\"crc32\":\"{crc32}\",\"state\":")
        };
        let mut bytes = head(&checksum(b"")).into_bytes();
        let start = bytes.len();
        self.serialize(&mut Serializer::with_formatter(
            &mut bytes,
            Compact::default(),
        ))?;
        let crc32 = checksum(&bytes[start..]);
        bytes[..start].copy_from_slice(head(&crc32).as_bytes());
        bytes.extend_from_slice(b"}\n");
        Ok(bytes)
    }

    /// Reads a checkpoint file; returns `None` if there is no file.
    ///
    /// # Errors
    /// When it cannot be read or is not a checkpoint of this format.
    pub fn read(path: &Path) -> Result<Option<Self>, CheckpointError> {
        text_of(path)?
            .map(|text| Self::from_text(&text))
            .transpose()
    }

    /// Reads the text of a checkpoint file. Format and checksum are checked first.
    ///
    /// # Errors
    /// When the text is not a checkpoint of this format, was changed, or holds an invalid scenario.
    pub fn from_text(text: &str) -> Result<Self, CheckpointError> {
        let mut checkpoint: Self = parse_state(text)?;
        checkpoint.scenario = checkpoint.scenario.checked("the checkpoint's scenario")?;
        Ok(checkpoint)
    }

    /// Checks that the checkpoint is of a run with this scenario and seed. The generation limit
    /// may differ.
    ///
    /// # Errors
    /// With what differs, what was found and what is allowed.
    pub fn check_origin(&self, scenario: &Scenario, seed: u64) -> Result<(), String> {
        check_origin((&self.scenario, self.seed), (scenario, seed))
    }

    /// Returns the state in the checkpoint; `catalogue` is that of the scenario's world.
    ///
    /// # Errors
    /// When hierarchies or learned values do not fit the scenario.
    pub fn state(
        &self,
        scenario: &Scenario,
        catalogue: &Catalogue,
    ) -> Result<EvolutionState, CheckpointError> {
        let evolution = &scenario.evolution;
        if self.individuals.len() != evolution.population_size {
            return Err(CheckpointError::misfit(
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
            file.individual(&place, catalogue, scenario)
        });
        Ok(EvolutionState {
            generation: self.generation,
            individuals: individuals.collect::<Result<_, _>>()?,
            primitives: primitives(&self.primitives, "state.primitives", catalogue)?,
            next_id: self.next_id,
            control_steps: self.control_steps,
            converged: self.converged,
        })
    }

    /// Checks that the counters cannot overflow.
    fn check_counters(&self) -> Result<(), CheckpointError> {
        for (name, found) in [
            ("generation", self.generation),
            ("next_id", self.next_id),
            ("control_steps", self.control_steps),
        ] {
            if found > MAX_COUNT {
                let message = format!("found {found}; allowed: 0 to {MAX_COUNT}");
                return Err(CheckpointError::misfit(&format!("state.{name}"), message));
            }
        }
        Ok(())
    }
}

impl CheckpointHead {
    /// Reads the head of a checkpoint file; returns `None` if there is no file. The checksum of the
    /// whole state is checked.
    pub(super) fn read(path: &Path) -> Result<Option<Self>, CheckpointError> {
        text_of(path)?.map(|text| parse_state(&text)).transpose()
    }

    /// As [`Checkpoint::check_origin`].
    pub(super) fn check_origin(&self, scenario: &Scenario, seed: u64) -> Result<(), String> {
        check_origin((&self.scenario, self.seed), (scenario, seed))
    }
}

fn text_of(path: &Path) -> Result<Option<String>, CheckpointError> {
    if !path.exists() {
        return Ok(None);
    }
    let text = read_text(path, CHECKPOINT_LIMITS.bytes).map_err(|error| error.source)?;
    CHECKPOINT_LIMITS.check(&text)?;
    Ok(Some(text))
}

/// Reads the state in the text of a checkpoint file. Format and checksum are checked first.
fn parse_state<'t, T: Deserialize<'t>>(text: &'t str) -> Result<T, CheckpointError> {
    let any: AnyFormat = parse_json(text)?;
    if any.format != CHECKPOINT_FORMAT {
        return Err(CheckpointError::Format { found: any.format });
    }
    let envelope: Envelope<'_> = parse_json(text)?;
    let state = envelope.state.get();
    let actual = checksum(state.as_bytes());
    if actual != envelope.crc32 {
        return Err(CheckpointError::Checksum {
            actual,
            stated: envelope.crc32,
        });
    }
    Ok(parse_json(state).map_err(|error| error.within("state"))?)
}

/// Checks that a checkpoint of `own` belongs to the run of `allowed`, except for the generation
/// limit and for what happens after evolution.
fn check_origin(own: (&Scenario, u64), run: (&Scenario, u64)) -> Result<(), String> {
    let ((mine, seed), (scenario, found)) = (own, run);
    if found != seed {
        return Err(format!(
            "seed: found {found}; allowed: {seed}, as in checkpoint.json"
        ));
    }
    let mut mine = mine.clone();
    mine.evolution.generation_limit = scenario.evolution.generation_limit;
    mine.evolution.then = scenario.evolution.then;
    if mine != *scenario {
        return Err(String::from(
            "scenario: found another; allowed: that of checkpoint.json, except for \
             generation_limit and then",
        ));
    }
    Ok(())
}

/// Checks that learning has not diverged: such a state can neither be resumed nor written as JSON.
///
/// # Errors
/// When a learned value is not finite.
pub(super) fn check_finite(state: &EvolutionState) -> Result<(), CheckpointError> {
    let diverged = |place| Err(CheckpointError::Diverged { place });
    let finite =
        |primitives: &PrimitiveSet| primitives.all().iter().all(PrimitiveValues::is_finite);
    if !finite(&state.primitives) {
        return diverged(String::from("the primitive subtasks"));
    }
    let found = state.individuals.iter().find(|individual| {
        !individual.hierarchy.is_finite() || !individual.primitives.as_ref().is_none_or(finite)
    });
    match found {
        Some(individual) => diverged(format!("individual {}", individual.id)),
        None => Ok(()),
    }
}

fn checksum(bytes: &[u8]) -> String {
    format!("{:08x}", crc32fast::hash(bytes))
}
