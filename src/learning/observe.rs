//! What can be watched while an agent acts and learns.

use crate::worlds::StateType;

/// One update of C~(i, s, a) and C(i, s, a) (Thesis Eq. 3.4, 3.5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Update {
    /// The composite node i.
    pub node: usize,
    /// Its child a.
    pub child: usize,
    /// Type of the updated state s.
    pub state_type: StateType,
    /// Time steps N from s to the child's termination.
    pub steps: usize,
    /// Target minus value of C~.
    pub error_inside: f32,
    /// Target minus value of C.
    pub error_outside: f32,
}

/// Watches an agent; what it does never changes what the agent does.
///
/// The default watcher `()` sees nothing and costs nothing.
pub trait Observer<W: crate::worlds::World> {
    /// A composite node chose a child.
    fn chose(&mut self, _node: usize, _child: usize) {}
    /// A primitive node executed an action, for this reward, and led to this state.
    fn acted(&mut self, _node: usize, _action: usize, _reward: f32, _state: &W::State) {}
    /// A composite node learned.
    fn updated(&mut self, _update: Update) {}
    /// A composite node terminated, at its goal or not.
    fn terminated(&mut self, _node: usize, _at_goal: bool) {}
}

impl<W: crate::worlds::World> Observer<W> for () {}
