//! What the four rooms look like.

use super::catalogue::{DOWN, LEFT, RIGHT, UP};
use super::house::{CELLS, SHAPE};
use super::{FourRoomsWorld, Percept};
use crate::random::Stream;
use crate::worlds::grid::{Direction, moves, outer_walls};
use crate::worlds::scene::{Mark, Role, Scenery, Scenic, Snapshot, Sweep};
use crate::worlds::{StateType, SubtaskId, World};

impl Scenic for FourRoomsWorld {
    fn scenery(&self) -> Scenery {
        let inner = (0..CELLS).filter(|&cell| !self.house.is_free(cell));
        Scenery {
            extent: SHAPE.extent(),
            unit: String::from("cells"),
            grid: Some([SHAPE.columns, SHAPE.rows]),
            walls: outer_walls(SHAPE)
                .into_iter()
                .chain(inner.flat_map(|cell| self.faces(cell)))
                .collect(),
            places: vec![Mark {
                role: Role::Goal,
                label: String::from("G"),
                at: SHAPE.centre(self.goal),
            }],
            transparent_walls: Vec::new(),
            moves: moves([RIGHT, UP, LEFT, DOWN]),
            time_step_s: None,
        }
    }

    fn snapshot(&self, state: &usize) -> Snapshot {
        SHAPE.snapshot(*state, self.state_type(state))
    }

    fn position(&self, state: &usize) -> [f64; 2] {
        SHAPE.centre(*state)
    }

    fn variants(&self) -> Vec<String> {
        vec![String::from("on the way")]
    }

    fn state_at(&self, at: [f64; 2], _: f64, variant: usize, _: &mut Stream) -> Option<usize> {
        let cell = SHAPE.cell_at(at)?;
        (variant == 0 && self.house.is_free(cell)).then_some(cell)
    }

    fn sweeps(&self, _: SubtaskId, _: StateType) -> Vec<Sweep<Percept>> {
        vec![SHAPE.sweep(|cell| self.percept(&cell))]
    }
}

impl FourRoomsWorld {
    /// Returns the sides of a wall cell that face free cells.
    fn faces(&self, wall: usize) -> impl Iterator<Item = [[f64; 2]; 2]> {
        let [x, y] = SHAPE.centre(wall);
        let side = move |direction| match direction {
            Direction::Up => [[x - 0.5, y + 0.5], [x + 0.5, y + 0.5]],
            Direction::Down => [[x - 0.5, y - 0.5], [x + 0.5, y - 0.5]],
            Direction::Right => [[x + 0.5, y - 0.5], [x + 0.5, y + 0.5]],
            Direction::Left => [[x - 0.5, y - 0.5], [x - 0.5, y + 0.5]],
        };
        let shown = move |&direction: &Direction| {
            let next = SHAPE.neighbour(wall, direction);
            next.is_some_and(|next| self.house.is_free(next))
        };
        Direction::ALL.into_iter().filter(shown).map(side)
    }
}
