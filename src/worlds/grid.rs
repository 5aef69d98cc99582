//! Worlds of equal square cells.
//!
//! Cells are numbered row by row from the upper left. Lengths are in cells, with y upwards.

use std::f64::consts::FRAC_PI_2;

use rand::RngExt;

use super::builder::CatalogueBuilder;
use super::scene::{Move, Reading, Scale, Snapshot, Sweep};
use super::{MapId, Probe, StateType, StateTypes, SubtaskId};
use crate::random::Stream;

/// Radius of an agent in cells.
pub(super) const RADIUS: f64 = 0.35;

/// A direction to walk in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Direction {
    Up,
    Down,
    Right,
    Left,
}

impl Direction {
    pub(super) const ALL: [Self; 4] = [Self::Up, Self::Down, Self::Right, Self::Left];

    /// Returns the direction of a primitive subtask: its place in `moves`, which have the order of
    /// [`Self::ALL`].
    pub(super) fn of(moved: SubtaskId, moves: [SubtaskId; 4]) -> Self {
        let place = moves.iter().position(|&known| known == moved);
        Self::ALL[place.unwrap_or(0)]
    }

    /// Returns the direction a quarter turn to the right.
    pub(super) fn clockwise(self) -> Self {
        match self {
            Self::Up => Self::Right,
            Self::Right => Self::Down,
            Self::Down => Self::Left,
            Self::Left => Self::Up,
        }
    }

    /// Returns the other three directions.
    pub(super) fn others(self) -> [Self; 3] {
        std::array::from_fn(|i| Self::ALL[(self as usize + 1 + i) % 4])
    }
}

/// The cells of a rectangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cells {
    pub(super) columns: usize,
    pub(super) rows: usize,
}

impl Cells {
    pub(super) const fn count(self) -> usize {
        self.columns * self.rows
    }

    pub(super) fn extent(self) -> [f64; 2] {
        [self.columns as f64, self.rows as f64]
    }

    pub(super) fn centre(self, cell: usize) -> [f64; 2] {
        let (row, column) = (cell / self.columns, cell % self.columns);
        [column as f64 + 0.5, (self.rows - row) as f64 - 0.5]
    }

    /// Returns the next cell in a direction; `None` at the edge.
    pub(super) fn neighbour(self, cell: usize, direction: Direction) -> Option<usize> {
        let column = cell % self.columns;
        match direction {
            Direction::Up => cell.checked_sub(self.columns),
            Direction::Down => Some(cell + self.columns).filter(|&to| to < self.count()),
            Direction::Right => (column + 1 < self.columns).then_some(cell + 1),
            Direction::Left => (column > 0).then(|| cell - 1),
        }
    }

    /// Returns the cell of a point; `None` outside.
    pub(super) fn cell_at(self, [x, y]: [f64; 2]) -> Option<usize> {
        let [width, height] = self.extent();
        let inside = (0.0..width).contains(&x) && (0.0..height).contains(&y);
        inside.then(|| (self.rows - 1 - y as usize) * self.columns + x as usize)
    }

    /// Returns the cells row by row from the lower left: the scales of a [`Sweep`] ascend.
    pub(super) fn upwards(self) -> impl Iterator<Item = usize> {
        let columns = self.columns;
        (0..self.rows)
            .rev()
            .flat_map(move |row| row * columns..(row + 1) * columns)
    }

    pub(super) fn across(self) -> Scale {
        scale("x_cells", self.columns)
    }

    pub(super) fn down(self) -> Scale {
        scale("y_cells", self.rows)
    }

    /// Returns the position of an agent in a cell.
    pub(super) fn readings(self, cell: usize) -> Vec<Reading> {
        let names = ["x_cells", "y_cells"].into_iter();
        let readings = names.zip(self.centre(cell)).map(|(name, value)| Reading {
            name: String::from(name),
            value: Some(value),
        });
        readings.collect()
    }

    /// Returns the snapshot of an agent in a cell without any objects.
    pub(super) fn snapshot(self, cell: usize, state_type: StateType) -> Snapshot {
        Snapshot {
            at: self.centre(cell),
            radius: RADIUS,
            heading: None,
            carries: None,
            marks: Vec::new(),
            view: None,
            sees: None,
            remembers: None,
            rays: Vec::new(),
            readings: self.readings(cell),
            state_type,
            variant: 0,
        }
    }

    /// Returns what agents perceive from cell to cell.
    pub(super) fn sweep<P>(self, percept: impl Fn(usize) -> P) -> Sweep<P> {
        let probe = |cell| Probe {
            label: format!("cell {cell}"),
            readings: (self.readings(cell).into_iter())
                .filter_map(|reading| Some((reading.name, reading.value?)))
                .collect(),
            percept: percept(cell),
        };
        Sweep {
            across: self.across(),
            down: Some(self.down()),
            probes: self.upwards().map(probe).collect(),
        }
    }
}

/// Returns one of the cells, each equally likely; `None` if there are none.
pub(super) fn any_of(cells: impl Iterator<Item = usize>, rng: &mut Stream) -> Option<usize> {
    let cells: Vec<_> = cells.collect();
    let last = cells.len().checked_sub(1)?;
    Some(cells[rng.random_range(0..=last)])
}

fn scale(name: &str, count: usize) -> Scale {
    Scale::Quantity {
        name: String::from(name),
        values: (0..count).map(|i| i as f64 + 0.5).collect(),
    }
}

/// Returns the walls around all cells.
pub(super) fn outer_walls(cells: Cells) -> [[[f64; 2]; 2]; 4] {
    let [width, height] = cells.extent();
    let corners = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
    std::array::from_fn(|i| [corners[i], corners[(i + 1) % 4]])
}

/// Describes the primitive subtasks that walk up, down, right and left.
pub(super) fn add_moves(
    builder: &mut CatalogueBuilder,
    moves: [SubtaskId; 4],
    map: MapId,
    active: impl Into<StateTypes>,
) {
    let active = active.into();
    for (id, to) in moves
        .into_iter()
        .zip(["up", "down", "to the right", "to the left"])
    {
        builder.primitive(id, &format!("walk one cell {to}"), map, active);
    }
}

/// Returns the moves of subtasks that move the agent east, north, west and south.
pub(super) fn moves(subtasks: [SubtaskId; 4]) -> Vec<Move> {
    let quarters = subtasks.into_iter().zip(0_u8..);
    let moves = quarters.map(|(subtask, quarter)| Move {
        subtask,
        heading: f64::from(quarter) * FRAC_PI_2,
    });
    moves.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_is_where_its_centre_is() {
        let cells = Cells {
            columns: 12,
            rows: 4,
        };
        assert_eq!(cells.centre(0), [0.5, 3.5]);
        for cell in 0..48 {
            assert_eq!(cells.cell_at(cells.centre(cell)), Some(cell));
        }
        for outside in [[12.0, 1.0], [-0.1, 1.0], [1.0, 4.0], [f64::NAN, 1.0]] {
            assert_eq!(cells.cell_at(outside), None);
        }
        assert_eq!(cells.upwards().next(), Some(36));
    }

    #[test]
    fn neighbours_are_next_to_each_other() {
        let cells = Cells {
            columns: 3,
            rows: 2,
        };
        let around = |cell| Direction::ALL.map(|direction| cells.neighbour(cell, direction));
        assert_eq!(around(0), [None, Some(3), Some(1), None]);
        assert_eq!(around(5), [Some(2), None, None, Some(4)]);
        let others = Direction::Right.others();
        assert_eq!(others, [Direction::Left, Direction::Up, Direction::Down]);
    }
}
