//! Taking individuals apart: what they do, step by step, what they have learned, what
//! they would do elsewhere, where they come from.
//!
//! A [`Bench`] is a scenario made ready for looking, whatever its world; on it lie
//! [`Specimen`]s, individuals of any generation of a run, fetched from an [`Archive`].
//! Whatever is done with them happens on copies and with random streams of their own:
//! looking never touches a run.

mod archive;
mod bench;
mod lineage;
mod policy_map;
mod profile;
mod rollout;
mod start;

pub use archive::{Archive, ArchiveError};
pub use bench::bench;
pub use lineage::{Ancestor, Lineage, lineage};
pub use policy_map::{MapView, PolicyCell, PolicyMap};
pub use profile::{Curve, Profile, Quantity};
pub use rollout::{Rollout, RolloutStatus, StepTrace};
pub use start::{Start, StartError};

use super::checkpoint::Checkpoint;
use super::checkpoint_error::CheckpointError;
use crate::evolution::{EvolutionState, Individual};
use crate::learning::{PrimitiveSet, SelectionProbabilities};
use crate::scenario::Scenario;
use crate::worlds::Catalogue;
use crate::worlds::scene::Scenery;

/// An individual with the primitive subtasks of its generation.
#[derive(Clone, Copy, Debug)]
pub struct Specimen<'s> {
    /// The individual.
    pub individual: &'s Individual,
    /// The primitive subtasks that it acts with.
    pub primitives: &'s PrimitiveSet,
}

impl<'s> Specimen<'s> {
    /// The individual at an index of a state, 0 being the best.
    #[must_use]
    pub fn at(state: &'s EvolutionState, index: usize) -> Option<Self> {
        let individual = state.individuals.get(index)?;
        Some(Self {
            individual,
            primitives: individual.primitives.as_ref().unwrap_or(&state.primitives),
        })
    }

    /// The individual with this id.
    #[must_use]
    pub fn with_id(state: &'s EvolutionState, id: u64) -> Option<Self> {
        let mut individuals = state.individuals.iter();
        Self::at(
            state,
            individuals.position(|individual| individual.id == id)?,
        )
    }
}

/// A scenario made ready for looking at individuals, whatever its world.
pub trait Bench: Send + Sync {
    /// The scenario.
    fn scenario(&self) -> &Scenario;

    /// The seed of the run.
    fn seed(&self) -> u64;

    /// The world's subtasks.
    fn catalogue(&self) -> &Catalogue;

    /// What does not change in the world.
    fn scenery(&self) -> &Scenery;

    /// What can be the case besides place and heading; at least one.
    fn variants(&self) -> &[String];

    /// A copy of an individual that acts and learns for somebody to watch. `number`
    /// tells its random stream from those of other rollouts of the same individual. All
    /// trials begin at `start`, if it is given and can be; else where chance puts them.
    fn rollout(
        &'static self,
        specimen: Specimen<'_>,
        number: u64,
        start: Option<Start>,
    ) -> Box<dyn Rollout>;

    /// Whether the agent can be there, and its task is not done there.
    fn can_begin(&self, start: Start) -> bool;

    /// The learned values of a node, over the inputs that it looks at.
    fn profiles(&self, specimen: Specimen<'_>, node: usize) -> Vec<Profile>;

    /// What an individual would do all over the arena. The same individual and view
    /// always give the same map.
    fn policy_map(&self, specimen: Specimen<'_>, view: MapView) -> PolicyMap;

    /// For each state type the probability of ending in each primitive subtask, in the
    /// catalogue's order (Thesis 4.5.4), over the states that the run samples too.
    fn selection(&self, specimen: Specimen<'_>) -> SelectionProbabilities;

    /// The population that a checkpoint holds.
    ///
    /// # Errors
    /// When it does not fit the scenario.
    fn population(&self, checkpoint: &Checkpoint) -> Result<EvolutionState, CheckpointError>;
}
