//! Inspection of individuals: what they do step by step, what they have learned, what they would
//! do elsewhere in the arena, and which ancestors they have.
//!
//! An [`Archive`] holds the individuals of any generation of a run that was kept; an
//! [`AnyExperiment`](super::AnyExperiment) inspects them. Rollouts act on copies and have
//! random streams of their own, so inspection never changes a run.

mod archive;
mod lineage;
mod policy_map;
mod profile;
mod rollout;
mod start;
mod trial_lengths;
mod untaught;

pub use archive::{Archive, ArchiveError};
pub use lineage::{Ancestor, Lineage, lineage};
pub use policy_map::{MapView, PolicyCell, PolicyMap};
pub use profile::{Curve, Profile, Quantity};
pub use rollout::{Rollout, RolloutStatus, StepTrace};
pub use start::{Start, StartError};
pub use trial_lengths::TrialLengths;

pub(super) use policy_map::policy_map;
pub(super) use profile::profiles;
pub(super) use rollout::WorldRollout;
pub(super) use untaught::nothing_learned;

use crate::evolution::{EvolutionState, Individual};
use crate::learning::PrimitiveSet;

/// An individual with the primitive subtasks of its generation.
#[derive(Clone, Copy, Debug)]
pub struct InspectedIndividual<'s> {
    /// The individual.
    pub individual: &'s Individual,
    /// The primitive subtasks that it acts with.
    pub primitives: &'s PrimitiveSet,
}

impl<'s> InspectedIndividual<'s> {
    /// Returns the individual at an index of a state; 0 is the best.
    #[must_use]
    pub fn at(state: &'s EvolutionState, index: usize) -> Option<Self> {
        let individual = state.individuals.get(index)?;
        Some(Self {
            individual,
            primitives: individual.primitives.as_ref().unwrap_or(&state.primitives),
        })
    }

    /// Returns the individual with this id.
    #[must_use]
    pub fn with_id(state: &'s EvolutionState, id: u64) -> Option<Self> {
        let mut individuals = state.individuals.iter();
        Self::at(
            state,
            individuals.position(|individual| individual.id == id)?,
        )
    }
}
