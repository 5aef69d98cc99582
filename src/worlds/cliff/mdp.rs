//! The cliff walk as a finite MDP.

use super::catalogue::{AT_GOAL, CELL, DOWN, LEFT, PLACE, RIGHT, UP};
use super::{CliffWorld, Percept};
use crate::worlds::mdp::{Mdp, MdpState, Outcome};
use crate::worlds::{SubtaskId, World};

const ACTIONS: [SubtaskId; 4] = [UP, DOWN, RIGHT, LEFT];

impl CliffWorld {
    /// All cells with what comes of every action; nobody is ever in the cliff.
    pub(super) fn as_mdp(&self) -> Mdp<Percept> {
        let states = (0..self.count()).map(|cell| {
            let exists = !self.is_cliff(cell);
            exists.then(|| self.finite_state(cell))
        });
        Mdp {
            table: CELL,
            gaussian: Some(PLACE),
            actions: ACTIONS.map(|primitive| (primitive, 0)).into(),
            states: states.collect(),
        }
    }

    fn finite_state(&self, cell: usize) -> MdpState<Percept> {
        let state_type = self.state_type(&cell);
        let outcome = |primitive| {
            let (next, reward) = self.act(cell, primitive);
            vec![Outcome {
                probability: 1.0,
                reward,
                next,
            }]
        };
        let starts = self.beginnings();
        let share = 1.0 / (starts.end() - starts.start() + 1) as f64;
        MdpState {
            state_type,
            percept: self.percept(&cell),
            start: if starts.contains(&cell) { share } else { 0.0 },
            outcomes: match state_type {
                AT_GOAL => Vec::new(),
                _ => ACTIONS.map(outcome).into(),
            },
        }
    }
}
