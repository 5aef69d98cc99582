//! Four rooms as a finite MDP.

use super::catalogue::{CELL, DOWN, LEFT, RIGHT, UP};
use super::house::CELLS;
use super::{FourRoomsWorld, Percept, direction};
use crate::worlds::mdp::{Mdp, MdpState, Outcome};
use crate::worlds::{SubtaskId, World};

const ACTIONS: [SubtaskId; 4] = [UP, DOWN, RIGHT, LEFT];

impl FourRoomsWorld {
    /// All cells with what can come of every action.
    pub(super) fn as_mdp(&self) -> Mdp<Percept> {
        let states = (0..CELLS).map(|cell| {
            let exists = self.house.is_free(cell);
            exists.then(|| self.finite_state(cell))
        });
        Mdp {
            table: CELL,
            gaussian: None,
            actions: ACTIONS.map(|primitive| (primitive, 0)).into(),
            states: states.collect(),
        }
    }

    fn finite_state(&self, cell: usize) -> MdpState<Percept> {
        let at_goal = cell == self.goal;
        MdpState {
            state_type: self.state_type(&cell),
            percept: self.percept(&cell),
            start: match at_goal {
                true => 0.0,
                false => 1.0 / self.starts().count() as f64,
            },
            outcomes: match at_goal {
                true => Vec::new(),
                false => ACTIONS
                    .map(|primitive| self.outcomes(cell, primitive))
                    .into(),
            },
        }
    }

    fn outcomes(&self, cell: usize, primitive: SubtaskId) -> Vec<Outcome> {
        let meant = direction(primitive);
        let slips = meant
            .others()
            .map(|other| (self.settings.slip / 3.0, other));
        let straight = std::iter::once((1.0 - self.settings.slip, meant));
        let all = straight.chain(slips).filter(|&(chance, _)| chance > 0.0);
        all.map(|(probability, direction)| {
            let (next, reward) = self.walk(cell, direction);
            Outcome {
                probability,
                reward,
                next,
            }
        })
        .collect()
    }
}
