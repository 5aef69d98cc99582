//! The events of a trial, recorded through the library's `Observer`, and taken in order.

use maxq_lab::learning::{Observer, Update};
use maxq_lab::worlds::World;
use maxq_lab::worlds::foraging::FeatureSettings;
use maxq_lab::worlds::foraging::{ForagingState, ForagingWorld};

use super::{MaxqQ, State};

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
    /// The updates of the trial are repeated from here on.
    Replays,
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

    fn replays(&mut self) {
        self.events.push(Event::Replays);
    }
}

/// The recorded events of the agent, in order.
impl MaxqQ<'_> {
    pub(super) fn take(&mut self) -> Event {
        let event = self.replayed.get(self.next).cloned();
        self.next += 1;
        event.expect("the agent did less")
    }

    /// 10: the child that the agent chose, which must be able to act.
    pub(super) fn chosen(&mut self, i: usize, s: &State) -> usize {
        let event = self.take();
        let Event::Chose { node, child } = event else {
            panic!("node {i} chooses, the agent did {event:?}")
        };
        assert_eq!(node, i);
        let choices = self.choices(i, s);
        assert!(choices.iter().any(|&(choice, _)| choice == child));
        child
    }

    pub(super) fn executed(&mut self, i: usize) -> (usize, f64, State) {
        let event = self.take();
        let Event::Acted {
            node,
            action,
            reward,
            state,
        } = event
        else {
            panic!("node {i} acts, the agent did {event:?}")
        };
        assert_eq!(node, i);
        (action, f64::from(reward), state.into_inner())
    }

    /// The node terminated in s: whether at its goal.
    pub(super) fn terminated(&mut self, i: usize, s: &State) -> bool {
        let at_goal = self.rows[i].goal.contains(&s.state_type);
        assert_eq!(self.take(), Event::Terminated { node: i, at_goal });
        at_goal
    }

    pub(super) fn peek_update(&self) -> Update {
        match &self.replayed[self.next] {
            Event::Updated(update) => *update,
            event => panic!("an update is due, the agent did {event:?}"),
        }
    }

    /// Compares what was learned from the last state, and both errors.
    pub(super) fn compare(&mut self, i: usize, a: usize, s: &State, n: i32, found: [f64; 3]) {
        let update = self.peek_update();
        self.next += 1;
        let place = (update.node, update.child, update.state_type.number());
        assert_eq!(place, (i, a, s.state_type));
        assert_eq!(update.steps, n as usize, "N of node {i}, child {a}");
        let agents = [update.exit, update.error_inside, update.error_outside];
        for (number, agents) in found.iter().zip(agents) {
            let difference = (number - f64::from(agents)).abs();
            assert!(!difference.is_nan());
            self.seen.worst_error = self.seen.worst_error.max(difference);
        }
        self.seen.updates += 1;
        self.seen.distant_updates += usize::from(n > 1);
    }
}
