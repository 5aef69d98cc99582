//! The events of a trial, recorded through the library's `Observer`.

use maxq_lab::learning::{Observer, Update};
use maxq_lab::worlds::World;
use maxq_lab::worlds::foraging::FeatureSettings;
use maxq_lab::worlds::foraging::{ForagingState, ForagingWorld};

use super::State;

/// The state after an action. Comparisons of events look at its type only.
#[derive(Clone, Debug)]
pub struct Led(Box<State>);

impl Led {
    /// The state.
    pub fn into_inner(self) -> State {
        *self.0
    }
}

impl PartialEq for Led {
    fn eq(&self, other: &Self) -> bool {
        self.0.state_type == other.0.state_type
    }
}

/// An event of an agent.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// A composite node chose a child.
    Chose { node: usize, child: usize },
    /// A primitive node acted.
    Acted {
        node: usize,
        action: usize,
        reward: f32,
        state: Led,
    },
    /// A composite node learned.
    Updated(Update),
    /// A composite node terminated.
    Terminated { node: usize, at_goal: bool },
}

/// Records the events of an agent.
pub struct Recorder<'w> {
    /// The world, which computes what the agent perceives.
    pub world: &'w ForagingWorld,
    /// The settings of the features.
    pub features: FeatureSettings,
    /// The recorded events.
    pub events: Vec<Event>,
}

impl Recorder<'_> {
    /// A state of the world as the agent perceives it.
    pub fn state(&self, state: &ForagingState) -> State {
        let state_type = self.world.state_type(state).number();
        State::new(state_type, &self.world.percept(state), &self.features)
    }
}

impl Observer<ForagingWorld> for Recorder<'_> {
    fn chose(&mut self, node: usize, child: usize) {
        self.events.push(Event::Chose { node, child });
    }

    fn acted(&mut self, node: usize, action: usize, reward: f32, state: &ForagingState) {
        let state = Led(Box::new(self.state(state)));
        self.events.push(Event::Acted {
            node,
            action,
            reward,
            state,
        });
    }

    fn updated(&mut self, update: Update) {
        self.events.push(Event::Updated(update));
    }

    fn terminated(&mut self, node: usize, at_goal: bool) {
        self.events.push(Event::Terminated { node, at_goal });
    }
}
