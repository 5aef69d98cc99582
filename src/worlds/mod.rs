//! Where agents act.
//!
//! A [`World`] tells what its subtasks are ([`Catalogue`]) and simulates one time
//! step at a time. It knows nothing of learning: it hands out *inputs*, and says which of
//! them each subtask looks at, and how ([`FeatureMap`]). Learning and evolution are
//! generic over the world and compiled for each one, so the interface costs nothing at
//! run time.

#[macro_use]
mod builder;
#[macro_use]
mod settings;
mod catalogue;
mod grid;
pub mod mdp;
pub mod scene;
mod training;

pub use catalogue::{
    Axis, Blocks, Catalogue, FeatureKind, FeatureMap, Index, Kind, MapId, StateType, StateTypeInfo,
    StateTypes, Subtask, SubtaskId,
};
pub use settings::{Settings, WorldFn};
pub use training::{Exploration, TrainingSettings};

use self::mdp::Mdp;
use crate::random::Stream;
use crate::rules::{Check, Problem};

// A new world is a folder, a line here, and a line below.
pub mod cliff;
pub mod foraging;
pub mod four_rooms;
pub mod taxi;

worlds! {
    /// The cliff walk (Thesis 2.1.3, Figures 2.2 and 2.3).
    Cliff: "cliff", cliff::CliffSettings;
    /// The foraging task (Thesis 4.1 to 4.3): find a battery, capture it, bring it home.
    Foraging: "foraging", foraging::ForagingSettings;
    /// Four rooms (Sutton, Precup and Singh 1999, *Between MDPs and semi-MDPs*, section 3).
    FourRooms: "four_rooms", four_rooms::FourRoomsSettings;
    /// The taxi problem (Dietterich 2000, section 3.1; Thesis 2.2.2, Figures 2.6 to 2.8).
    Taxi: "taxi", taxi::TaxiSettings;
}

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
    /// What the agent perceives: input values, addressed by [`Axis::input`] where they
    /// are scaled to [0, 1], by [`Index::input`] where they are whole numbers.
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
    fn probes(&self, primitive: SubtaskId) -> Vec<Probe<Self::Percept>> {
        let _ = primitive;
        Vec::new()
    }

    /// How a primitive subtask is trained before evolution starts; `None` where it is
    /// not, and learns with each individual.
    fn training(&self, primitive: SubtaskId) -> Option<&TrainingSettings> {
        let _ = primitive;
        None
    }

    /// The first state of a training episode; `None` where the world has no state
    /// that the subtask could be trained from.
    fn begin_training(&self, primitive: SubtaskId, rng: &mut Stream) -> Option<Self::State> {
        let _ = (primitive, rng);
        None
    }

    /// Whether a training episode goes on after the step that led from `before` to
    /// `after`; `after` may be prepared for it.
    fn training_goes_on(
        &self,
        primitive: SubtaskId,
        before: &Self::State,
        after: &mut Self::State,
    ) -> bool {
        let _ = (primitive, before, after);
        false
    }

    /// A hierarchy that a person would make, as text.
    fn hand_made(&self) -> Option<&str> {
        None
    }

    /// The whole world, exactly; `None` where it has too many states for that.
    fn mdp(&self) -> Option<Mdp<Self::Percept>> {
        None
    }
}
