//! The layout of a world of cells, in which each cell has the same whole number of columns and
//! rows.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::dashboard::look::{Look, Paint, put};

/// Least columns of a cell that has room for a number.
const READABLE: u16 = 7;

/// The places of the cells on the terminal. There are lines around all cells, and between cells
/// where there is room.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    area: Rect,
    columns: Axis,
    rows: Axis,
}

/// One direction of the lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Axis {
    count: u16,
    /// Distance from cell to cell.
    step: u16,
    /// Whether there are lines between cells; a line is the first column or row of a step.
    lined: bool,
}

impl Axis {
    /// Returns the largest cells that fit, with lines between them if a step is at least
    /// `least`.
    fn fitting(room: u16, count: usize, least: u16) -> Option<Self> {
        let count = u16::try_from(count).ok().filter(|count| *count > 0)?;
        let lined = room.saturating_sub(1) / count;
        let bare = room.saturating_sub(2) / count;
        let (step, lined) = if lined >= least {
            (lined, true)
        } else {
            (bare, false)
        };
        (step > 0).then_some(Self { count, step, lined })
    }

    fn at_most(self, step: u16) -> Self {
        Self {
            step: self.step.min(step),
            ..self
        }
    }

    /// Returns the size of all cells and lines.
    fn total(self) -> u16 {
        self.count * self.step + if self.lined { 1 } else { 2 }
    }

    /// Returns the size of a cell without its line.
    fn inside(self) -> u16 {
        self.step - u16::from(self.lined)
    }

    /// Returns the position of the line before a cell, if there is one.
    fn line(self, index: u16) -> Option<u16> {
        match (self.lined, index) {
            (true, _) => Some(index * self.step),
            (false, 0) => Some(0),
            (false, index) => (index == self.count).then_some(self.total() - 1),
        }
    }
}

impl Lattice {
    /// The largest cells, about as high as wide, that fit; `None` where not even the
    /// smallest do.
    pub(super) fn fitting(area: Rect, [columns, rows]: [usize; 2]) -> Option<Self> {
        let columns = Axis::fitting(area.width, columns, 3)?;
        let rows = Axis::fitting(area.height, rows, 2)?;
        // Characters are about twice as high as wide.
        let columns = columns.at_most((2 * rows.step).max(READABLE));
        let rows = rows.at_most((columns.step.div_ceil(2)).max(2));
        let left = (area.width - columns.total()) / 2;
        let top = (area.height - rows.total()) / 2;
        let area = Rect::new(area.x + left, area.y + top, columns.total(), rows.total());
        Some(Self {
            area,
            columns,
            rows,
        })
    }

    /// Returns column and row of every cell, from the upper left.
    pub(super) fn cells(self) -> impl Iterator<Item = (usize, usize)> {
        let columns = usize::from(self.columns.count);
        let rows = 0..usize::from(self.rows.count);
        rows.flat_map(move |row| (0..columns).map(move |column| (column, row)))
    }

    /// Returns the area of a cell without the lines.
    pub(super) fn inside(self, column: usize, row: usize) -> Rect {
        Rect {
            x: self.area.x + 1 + column as u16 * self.columns.step,
            y: self.area.y + 1 + row as u16 * self.rows.step,
            width: self.columns.inside(),
            height: self.rows.inside(),
        }
    }

    /// Returns the centre of a cell in world coordinates, y upwards.
    pub(super) fn centre(self, column: usize, row: usize) -> [f64; 2] {
        let below = f64::from(self.rows.count) - row as f64;
        [column as f64 + 0.5, below - 0.5]
    }

    /// Draws walls along the edges of cells, and dots at the corners of cells.
    pub(super) fn draw_walls(self, look: &Look, walls: &[[[f64; 2]; 2]], buffer: &mut Buffer) {
        let style = look.style(Paint::Wall);
        let top = f64::from(self.rows.count);
        // Whether there are walls from a corner: up, down, left, right.
        let leads = |column: u16, row: u16| {
            let [x, y] = [f64::from(column), top - f64::from(row)];
            let middles = [[x, y + 0.5], [x, y - 0.5], [x - 0.5, y], [x + 0.5, y]];
            middles.map(|middle| walls.iter().any(|wall| is_on(middle, wall)))
        };
        let corners = (0..=self.rows.count).flat_map(|row| {
            let columns = 0..=self.columns.count;
            columns.map(move |column| (column, row))
        });
        for (column, row) in corners {
            let [up, down, left, right] = leads(column, row);
            let (x, y) = (self.columns.line(column), self.rows.line(row));
            if let (Some(x), Some(y)) = (x, y) {
                let sum = [(up, 1), (down, 2), (left, 4), (right, 8)].into_iter();
                let sum: usize = sum.filter(|(leads, _)| *leads).map(|(_, bit)| bit).sum();
                let (sign, style) = match sum {
                    0 => (look.signs.trail, look.style(Paint::Border)),
                    sum => (look.signs.lines[sum], style),
                };
                put(buffer, self.area, (x, y), sign, style);
            }
            let (column, row) = (column * self.columns.step, row * self.rows.step);
            if let (Some(x), true) = (x, down) {
                for y in row + 1..=row + self.rows.inside() {
                    put(buffer, self.area, (x, y), look.signs.lines[3], style);
                }
            }
            if let (Some(y), true) = (y, right) {
                for x in column + 1..=column + self.columns.inside() {
                    put(buffer, self.area, (x, y), look.signs.lines[12], style);
                }
            }
        }
    }

    /// Marks the edges that the agent crossed, where there are lines.
    pub(super) fn draw_trail(self, look: &Look, trail: &[[f64; 2]], buffer: &mut Buffer) {
        let style = look.style(Paint::Trail);
        for (from, to) in trail.iter().zip(trail.iter().skip(1)) {
            let [x, y] = [0, 1].map(|axis| (from[axis] + to[axis]) / 2.0);
            let y = f64::from(self.rows.count) - y;
            let across = self.columns.along(x).zip(self.rows.along(y));
            if let Some(at) = across.filter(|_| from != to) {
                put(buffer, self.area, at, look.signs.ray, style);
            }
        }
    }
}

impl Axis {
    /// Returns the position of a place: on the line between cells, or in the middle of a cell;
    /// `None` where there is no line.
    fn along(self, place: f64) -> Option<u16> {
        let cell = place.floor();
        if place == cell {
            self.line(cell as u16).filter(|_| self.lined)
        } else {
            Some(1 + cell as u16 * self.step + self.inside() / 2)
        }
    }
}

/// Returns whether a place is on a wall.
fn is_on([x, y]: [f64; 2], [from, to]: &[[f64; 2]; 2]) -> bool {
    let span = [to[0] - from[0], to[1] - from[1]];
    let way = [x - from[0], y - from[1]];
    let cross = span[0] * way[1] - span[1] * way[0];
    let along = span[0] * way[0] + span[1] * way[1];
    cross.abs() < 1e-9 && (0.0..=span[0].powi(2) + span[1].powi(2)).contains(&along)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_fill_what_there_is_and_never_more() {
        for (width, height) in [(7, 7), (11, 7), (22, 8), (38, 12), (78, 18), (300, 100)] {
            let area = Rect::new(3, 5, width, height);
            let lattice = Lattice::fitting(area, [5, 5]).unwrap();
            assert_eq!(area.intersection(lattice.area), lattice.area);
            for (column, row) in lattice.cells() {
                let cell = lattice.inside(column, row);
                assert!(!cell.is_empty());
                assert_eq!(lattice.area.intersection(cell), cell);
            }
        }
        assert!(Lattice::fitting(Rect::new(0, 0, 6, 20), [5, 5]).is_none());
    }

    #[test]
    fn an_edge_is_on_the_wall_that_it_is_part_of() {
        let wall = [[2.0, 1.0], [2.0, 4.0]];
        assert!(is_on([2.0, 1.5], &wall) && is_on([2.0, 3.5], &wall));
        assert!(!is_on([2.0, 4.5], &wall) && !is_on([1.5, 2.0], &wall));
    }
}
