//! Worlds of equal square cells: where these are, for who looks at them.
//!
//! Cells are numbered row by row from the upper left; lengths are in cells, y upwards.

use std::f64::consts::FRAC_PI_2;

use super::SubtaskId;
use super::scene::{Move, Reading, Scale};

/// The cells of a rectangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cells {
    pub(super) columns: usize,
    pub(super) rows: usize,
}

impl Cells {
    pub(super) fn extent(self) -> [f64; 2] {
        [self.columns as f64, self.rows as f64]
    }

    pub(super) fn centre(self, cell: usize) -> [f64; 2] {
        let (row, column) = (cell / self.columns, cell % self.columns);
        [column as f64 + 0.5, (self.rows - row) as f64 - 0.5]
    }

    /// The cell that a point lies in; `None` outside.
    pub(super) fn cell_at(self, [x, y]: [f64; 2]) -> Option<usize> {
        let [width, height] = self.extent();
        let inside = (0.0..width).contains(&x) && (0.0..height).contains(&y);
        inside.then(|| (self.rows - 1 - y as usize) * self.columns + x as usize)
    }

    /// The cells row by row from the lower left, as a [`Sweep`](super::scene::Sweep) has
    /// them, whose scales ascend.
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

    /// Where an agent in a cell is.
    pub(super) fn readings(self, cell: usize) -> Vec<Reading> {
        let names = ["x_cells", "y_cells"].into_iter();
        let readings = names.zip(self.centre(cell)).map(|(name, value)| Reading {
            name: String::from(name),
            value: Some(value),
        });
        readings.collect()
    }
}

fn scale(name: &str, count: usize) -> Scale {
    Scale::Quantity {
        name: String::from(name),
        values: (0..count).map(|i| i as f64 + 0.5).collect(),
    }
}

/// The walls around the whole.
pub(super) fn outer_walls(cells: Cells) -> [[[f64; 2]; 2]; 4] {
    let [width, height] = cells.extent();
    let corners = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
    std::array::from_fn(|i| [corners[i], corners[(i + 1) % 4]])
}

/// The subtasks that move an agent east, north, west, south.
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
}
