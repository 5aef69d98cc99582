//! Where agents act.
//!
//! A [`World`] tells what its subtasks are ([`Catalogue`]) and simulates one time
//! step at a time. It knows nothing of learning: it hands out *inputs* scaled to
//! [0, 1], and says which of them each subtask looks at ([`FeatureMap`]). Learning
//! and evolution are generic over the world and compiled for each one, so the
//! interface costs nothing at run time.

mod catalogue;
pub mod foraging;
pub mod scene;

pub use catalogue::{
    Axis, Catalogue, FeatureMap, Kind, MapId, StateType, StateTypeInfo, StateTypes, Subtask,
    SubtaskId,
};

use crate::random::Stream;
use crate::scenario::TrainingModel;

/// A typical input of a primitive subtask, for looking at what it has learned.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe<P> {
    /// The input in a few characters, for people.
    pub label: String,
    /// The readings with their names, which end in their units.
    pub readings: Vec<(String, f64)>,
    /// What the agent perceives.
    pub percept: P,
}

/// A world: its subtasks, and the simulation of one agent in it.
///
/// Implementations are immutable while a run lasts; everything that changes is in
/// [`World::State`], of which every individual has its own.
pub trait World: Send + Sync {
    /// Where a trial starts.
    type Start: Clone + Send + Sync;
    /// The changing state of one agent and its surroundings.
    type State: Clone + Send;
    /// What the agent perceives: input values scaled to [0, 1], addressed by
    /// [`Axis::input`].
    type Percept: Copy + AsRef<[f32]> + Send + Sync;

    /// The subtasks that hierarchies are made of.
    fn catalogue(&self) -> &Catalogue;

    /// Draws the start of a trial.
    fn draw_start(&self, rng: &mut Stream) -> Self::Start;

    /// The state at the beginning of a trial.
    fn begin(&self, start: &Self::Start, rng: &mut Stream) -> Self::State;

    /// Executes one action of a primitive subtask for one time step and returns
    /// the subtask's reward for it.
    fn step(
        &self,
        state: &mut Self::State,
        primitive: SubtaskId,
        action: usize,
        rng: &mut Stream,
    ) -> f32;

    /// The type of a state; [`Catalogue::terminal`] when the task is done.
    fn state_type(&self, state: &Self::State) -> StateType;

    /// What the agent perceives in a state.
    fn percept(&self, state: &Self::State) -> Self::Percept;

    /// A random state of the given type, as the agent perceives it; `None` where
    /// none is found in reasonable time.
    fn sample(&self, state_type: StateType, rng: &mut Stream) -> Option<Self::Percept>;

    /// Typical inputs of a primitive subtask.
    fn probes(&self, primitive: SubtaskId) -> Vec<Probe<Self::Percept>>;

    /// How a primitive subtask is trained before evolution starts.
    fn training(&self, primitive: SubtaskId) -> &TrainingModel;

    /// The first state of a training episode; `None` where the world has no state
    /// that the subtask could be trained from.
    fn begin_training(&self, primitive: SubtaskId, rng: &mut Stream) -> Option<Self::State>;

    /// Whether a training episode goes on after the step that led from `before` to
    /// `after`; `after` may be prepared for it.
    fn training_goes_on(
        &self,
        primitive: SubtaskId,
        before: &Self::State,
        after: &mut Self::State,
    ) -> bool;
}
