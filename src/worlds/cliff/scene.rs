//! What the cliff walk looks like.

use super::catalogue::{DOWN, LEFT, RIGHT, UP};
use super::{CliffWorld, Percept};
use crate::random::Stream;
use crate::worlds::grid::{moves, outer_walls};
use crate::worlds::scene::{Mark, Role, Scenery, Scenic, Snapshot, Sweep};
use crate::worlds::{StateType, SubtaskId, World};

impl Scenic for CliffWorld {
    fn scenery(&self) -> Scenery {
        let mark = |role, label: &str, cell| Mark {
            role,
            label: String::from(label),
            at: self.cells.centre(cell),
        };
        let mut places = vec![
            mark(Role::Landmark, "S", self.start()),
            mark(Role::Goal, "G", self.goal()),
        ];
        let cliff = (0..self.cells.count()).filter(|&cell| self.is_cliff(cell));
        places.extend(cliff.map(|cell| mark(Role::Hazard, "cliff", cell)));
        Scenery {
            extent: self.cells.extent(),
            unit: String::from("cells"),
            grid: Some([self.cells.columns, self.cells.rows]),
            walls: outer_walls(self.cells).into(),
            places,
            transparent_walls: Vec::new(),
            moves: moves([RIGHT, UP, LEFT, DOWN]),
            time_step_s: None,
        }
    }

    fn snapshot(&self, state: &usize) -> Snapshot {
        self.cells.snapshot(*state, self.state_type(state))
    }

    fn position(&self, state: &usize) -> [f64; 2] {
        self.cells.centre(*state)
    }

    fn variants(&self) -> Vec<String> {
        vec![String::from("on the way")]
    }

    fn state_at(&self, at: [f64; 2], _: f64, variant: usize, _: &mut Stream) -> Option<usize> {
        let cell = self.cells.cell_at(at)?;
        (variant == 0 && !self.is_cliff(cell)).then_some(cell)
    }

    fn sweeps(&self, _: SubtaskId, _: StateType) -> Vec<Sweep<Percept>> {
        vec![self.cells.sweep(|cell| self.percept(&cell))]
    }
}
