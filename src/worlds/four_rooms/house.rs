//! The house: cells, walls, rooms, hallways.

use crate::rules::Problem;
use crate::worlds::StateType;
use crate::worlds::grid::{Cells, Direction};

/// The house within its outer walls (Sutton, Precup and Singh 1999, Figure 2): one letter for each
/// cell. `#` is a wall; rooms are lower-case, hallways upper-case letters.
const PLAN: [&str; 11] = [
    "aaaaa#bbbbb",
    "aaaaa#bbbbb",
    "aaaaaNbbbbb",
    "aaaaa#bbbbb",
    "aaaaa#bbbbb",
    "#W####bbbbb",
    "ccccc###E##",
    "ccccc#ddddd",
    "ccccc#ddddd",
    "cccccSddddd",
    "ccccc#ddddd",
];

/// Columns and rows.
pub(super) const SHAPE: Cells = Cells {
    columns: 11,
    rows: 11,
};

/// Number of cells, walls included.
pub(super) const CELLS: usize = SHAPE.count();

/// A room or a hallway.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    NorthWest,
    NorthEast,
    SouthWest,
    SouthEast,
    North,
    West,
    East,
    South,
}

impl Place {
    /// All places in the order of their state types.
    pub(super) const ALL: [Self; 8] = [
        Self::NorthWest,
        Self::NorthEast,
        Self::SouthWest,
        Self::SouthEast,
        Self::North,
        Self::West,
        Self::East,
        Self::South,
    ];

    /// Returns the type of states in the place.
    pub(super) const fn state_type(self) -> StateType {
        StateType(self as u8)
    }

    /// Returns the two adjacent places: the hallways of a room, the rooms of a hallway.
    pub(super) const fn neighbours(self) -> [Self; 2] {
        match self {
            Self::NorthWest => [Self::North, Self::West],
            Self::NorthEast => [Self::North, Self::East],
            Self::SouthWest => [Self::West, Self::South],
            Self::SouthEast => [Self::East, Self::South],
            Self::North => [Self::NorthWest, Self::NorthEast],
            Self::West => [Self::NorthWest, Self::SouthWest],
            Self::East => [Self::NorthEast, Self::SouthEast],
            Self::South => [Self::SouthWest, Self::SouthEast],
        }
    }

    fn of(letter: u8) -> Option<Self> {
        b"abcdNWES"
            .iter()
            .zip(Self::ALL)
            .find(|&(&known, _)| known == letter)
            .map(|(_, place)| place)
    }
}

/// The house cell by cell.
#[derive(Clone, Debug)]
pub(super) struct House {
    /// The place of each cell; `None` for a wall.
    places: Vec<Option<Place>>,
}

impl House {
    pub(super) fn new() -> Self {
        let letters = PLAN.iter().flat_map(|row| row.bytes());
        Self {
            places: letters.map(Place::of).collect(),
        }
    }

    /// Returns the number of the goal's cell.
    pub(super) fn goal(&self, [column, row]: [usize; 2]) -> Result<usize, Problem> {
        let inside = column < SHAPE.columns && row < SHAPE.rows;
        let cell = inside.then(|| row * SHAPE.columns + column);
        cell.filter(|&cell| self.is_free(cell)).ok_or_else(|| {
            let allowed = "column and row of a cell that is not a wall, 0 to 10 each";
            Problem::new("goal_cell", format!("[{column}, {row}]"), allowed)
        })
    }

    /// Returns whether the cell is not a wall.
    pub(super) fn is_free(&self, cell: usize) -> bool {
        self.places[cell].is_some()
    }

    /// Returns the cells that are not walls.
    pub(super) fn cells(&self) -> impl Iterator<Item = usize> {
        (0..CELLS).filter(|&cell| self.is_free(cell))
    }

    /// Returns the place of a free cell.
    pub(super) fn place(&self, cell: usize) -> Place {
        self.places[cell].unwrap_or(Place::NorthWest)
    }

    /// Returns the cell that a move leads to.
    pub(super) fn to(&self, cell: usize, direction: Direction) -> usize {
        let to = SHAPE.neighbour(cell, direction);
        to.filter(|&to| self.is_free(to)).unwrap_or(cell)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_house_is_that_of_the_paper() {
        let house = House::new();
        assert_eq!(house.cells().count(), 104);
        let sizes = Place::ALL.map(|place| {
            let cells = house.cells().filter(|&cell| house.place(cell) == place);
            cells.count()
        });
        assert_eq!(sizes, [25, 30, 25, 20, 1, 1, 1, 1]);
    }

    #[test]
    fn a_move_stays_in_its_place_or_leads_to_a_neighbour() {
        let house = House::new();
        for cell in house.cells() {
            for direction in Direction::ALL {
                let to = house.to(cell, direction);
                let (from, to) = (house.place(cell), house.place(to));
                assert!(from == to || from.neighbours().contains(&to));
            }
        }
        for place in Place::ALL {
            for neighbour in place.neighbours() {
                assert!(neighbour.neighbours().contains(&place));
            }
        }
    }

    #[test]
    fn a_goal_in_a_wall_or_outside_is_refused() {
        let house = House::new();
        assert_eq!(house.goal([8, 6]), Ok(74));
        for cell in [[5, 0], [11, 0], [0, 11], [usize::MAX, 0]] {
            assert_eq!(house.goal(cell).unwrap_err().place, "goal_cell");
        }
    }
}
