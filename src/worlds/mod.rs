#![doc = include_str!("README.md")]

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
    Axis, Blocks, Catalogue, FeatureKind, FeatureMap, Imitation, Index, Kind, MapId, StateType,
    StateTypeInfo, StateTypes, Subtask, SubtaskId,
};
pub use settings::{Settings, WorldFn};
pub use training::{Exploration, TrainingSettings};

use self::mdp::Mdp;
use crate::random::Stream;
use crate::rules::{Check, Problem};

// A new world is a folder, a line here and a line below: see README.md.
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

/// A typical input of a primitive subtask, which shows what the subtask has learned.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe<P> {
    /// The input in a few characters.
    pub label: String,
    /// The readings with their names; a name ends with the unit.
    pub readings: Vec<(String, f64)>,
    /// What the agent perceives.
    pub percept: P,
}

/// A world: its subtasks, and the simulation of one agent.
///
/// A world does not change while a run lasts. Everything that changes is in
/// [`World::State`]; every individual has its own.
pub trait World: Send + Sync {
    /// The start of a trial.
    type Start: Clone + Send + Sync;
    /// The changing state of one agent and its surroundings.
    type State: Clone + Send;
    /// What the agent perceives: inputs in [0, 1], to which [`Axis::input`] refers, and whole
    /// numbers, to which [`Index::input`] refers.
    type Percept: Copy + AsRef<[f32]> + Send + Sync;

    /// Returns the subtasks that hierarchies are made of.
    fn catalogue(&self) -> &Catalogue;

    /// What is odd about the world, though a task can be done in it. The places are below the
    /// settings of the world.
    fn warnings(&self) -> &[Problem] {
        &[]
    }

    /// Draws the start of a trial.
    fn draw_start(&self, rng: &mut Stream) -> Self::Start;

    /// Returns the state at the start of a trial.
    fn begin(&self, start: &Self::Start, rng: &mut Stream) -> Self::State;

    /// Executes one action of a primitive subtask for one time step, and returns the reward.
    fn step(
        &self,
        state: &mut Self::State,
        primitive: SubtaskId,
        action: usize,
        rng: &mut Stream,
    ) -> f32;

    /// Returns the type of a state: [`Catalogue::terminal`] if the task is done.
    fn state_type(&self, state: &Self::State) -> StateType;

    /// Returns what the agent perceives in a state.
    fn percept(&self, state: &Self::State) -> Self::Percept;

    /// Returns what the agent perceives in a random state of the given type.
    ///
    /// `None` if rejection sampling finds no such state.
    fn sample(&self, state_type: StateType, rng: &mut Stream) -> Option<Self::Percept>;

    /// Returns typical inputs of a primitive subtask.
    fn probes(&self, primitive: SubtaskId) -> Vec<Probe<Self::Percept>> {
        let _ = primitive;
        Vec::new()
    }

    /// Returns how a primitive subtask is trained before evolution starts.
    ///
    /// `None` if it is not trained: each individual then learns it.
    fn training(&self, primitive: SubtaskId) -> Option<&TrainingSettings> {
        let _ = primitive;
        None
    }

    /// Returns the first state of a training episode.
    ///
    /// `None` if the world has no state in which this subtask can be trained.
    fn begin_training(&self, primitive: SubtaskId, rng: &mut Stream) -> Option<Self::State> {
        let _ = (primitive, rng);
        None
    }

    /// Returns whether a training episode continues after a step from `before` to `after`. It
    /// may change `after` for the next step.
    fn training_goes_on(
        &self,
        primitive: SubtaskId,
        before: &Self::State,
        after: &mut Self::State,
    ) -> bool {
        let _ = (primitive, before, after);
        false
    }

    /// Returns a hierarchy that a person would make, as text.
    fn hand_made(&self) -> Option<&str> {
        None
    }

    /// Returns the Markov decision process of the whole world.
    ///
    /// `None` if the world has too many states.
    fn mdp(&self) -> Option<Mdp<Self::Percept>> {
        None
    }
}
