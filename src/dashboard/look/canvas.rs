//! A canvas for lines, drawn in braille dots where the signs have them, else in whole cells.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::Look;
use super::paint::Paint;

/// The kind of a line, which selects its sign where cells have no dots. In a cell, a later
/// layer hides an earlier one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Layer {
    /// The path of the agent.
    Trail,
    /// Proximity rays.
    Ray,
    /// Walls that the agent sees through, drawn dotted.
    TransparentWall,
    /// Walls.
    Wall,
    /// A curve of a chart, by number.
    Curve(u8),
}

/// A canvas for lines in world coordinates on an area of the terminal; y points upwards.
#[derive(Debug)]
pub struct Canvas<'l> {
    look: &'l Look,
    area: Rect,
    /// Lower left corner and size of the visible part, in world units.
    origin: [f64; 2],
    extent: [f64; 2],
    cells: Vec<(u8, Option<(Layer, Paint)>)>,
}

/// Most points of a line: more than any screen has dots.
const MAX_POINTS: f64 = 10_000.0;

impl<'l> Canvas<'l> {
    /// Creates a canvas that fills `area` with the part of the world from `origin` of size
    /// `extent`.
    #[must_use]
    pub fn new(look: &'l Look, area: Rect, origin: [f64; 2], extent: [f64; 2]) -> Self {
        let cells = usize::from(area.width) * usize::from(area.height);
        Self {
            look,
            area,
            origin,
            extent,
            cells: vec![(0, None); cells],
        }
    }

    /// Returns the number of dots in a cell, across and down.
    fn dots(&self) -> [f64; 2] {
        if self.look.signs.dots {
            [2.0, 4.0]
        } else {
            [1.0, 1.0]
        }
    }

    /// Converts a place to dots from the upper left; the far edges belong to the last dots.
    fn in_dots(&self, at: [f64; 2]) -> [f64; 2] {
        let dots = self.dots();
        let columns = f64::from(self.area.width) * dots[0];
        let rows = f64::from(self.area.height) * dots[1];
        let share = |axis: usize| (at[axis] - self.origin[axis]) / self.extent[axis];
        [share(0) * (columns - 1.0), (1.0 - share(1)) * (rows - 1.0)]
    }

    /// Returns column and row of the cell of a place, or `None` outside the area.
    #[must_use]
    pub fn cell(&self, at: [f64; 2]) -> Option<(u16, u16)> {
        let (dots, [x, y]) = (self.dots(), self.in_dots(at));
        let column = (x.round() / dots[0]).floor();
        let row = (y.round() / dots[1]).floor();
        let inside = column >= 0.0
            && row >= 0.0
            && column < f64::from(self.area.width)
            && row < f64::from(self.area.height);
        inside.then_some((column as u16, row as u16))
    }

    /// Returns the place at the centre of a cell.
    #[must_use]
    pub fn place(&self, column: u16, row: u16) -> [f64; 2] {
        let share = |index: u16, count: u16| (f64::from(index) + 0.5) / f64::from(count.max(1));
        [
            self.origin[0] + share(column, self.area.width) * self.extent[0],
            self.origin[1] + (1.0 - share(row, self.area.height)) * self.extent[1],
        ]
    }

    /// Draws a point.
    pub fn point(&mut self, at: [f64; 2], layer: Layer, paint: Paint) {
        let [x, y] = self.in_dots(at).map(f64::round);
        self.dot(x, y, layer, paint);
    }

    fn dot(&mut self, x: f64, y: f64, layer: Layer, paint: Paint) {
        let dots = self.dots();
        let columns = f64::from(self.area.width) * dots[0];
        let rows = f64::from(self.area.height) * dots[1];
        if !(x >= 0.0 && y >= 0.0 && x < columns && y < rows) {
            return;
        }
        let (x, y) = (x as usize, y as usize);
        let [across, down] = dots.map(|count| count as usize);
        let index = y / down * usize::from(self.area.width) + x / across;
        /// The bits of a braille pattern, row by row.
        const BITS: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
        if let Some((bits, top)) = self.cells.get_mut(index) {
            *bits |= BITS[y % down][x % across];
            if top.is_none_or(|(hidden, _)| hidden <= layer) {
                *top = Some((layer, paint));
            }
        }
    }

    /// Draws a straight line.
    pub fn line(&mut self, from: [f64; 2], to: [f64; 2], layer: Layer, paint: Paint) {
        let [from, to] = [self.in_dots(from), self.in_dots(to)];
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let points = dx.abs().max(dy.abs()).ceil().min(MAX_POINTS);
        if !points.is_finite() {
            return;
        }
        // A whole cell cannot be dotted; its sign tells.
        let dotted = layer == Layer::TransparentWall && self.look.signs.dots;
        for point in (0..=points as usize).step_by(if dotted { 2 } else { 1 }) {
            let share = point as f64 / points.max(1.0);
            let (x, y) = (from[0] + share * dx, from[1] + share * dy);
            self.dot(x.round(), y.round(), layer, paint);
        }
    }

    /// Copies the canvas to the buffer; cells without dots keep their contents.
    pub fn finish(&self, buffer: &mut Buffer) {
        let width = usize::from(self.area.width).max(1);
        for (index, (bits, top)) in self.cells.iter().enumerate() {
            let Some((layer, paint)) = top else { continue };
            let column = self.area.x + (index % width) as u16;
            let row = self.area.y + (index / width) as u16;
            let Some(cell) = buffer.cell_mut((column, row)) else {
                continue;
            };
            cell.set_style(self.look.style(*paint));
            if self.look.signs.dots {
                let pattern = char::from_u32(0x2800 + u32::from(*bits));
                cell.set_char(pattern.unwrap_or(' '));
            } else {
                cell.set_symbol(self.sign(*layer));
            }
        }
    }

    fn sign(&self, layer: Layer) -> &'static str {
        let signs = self.look.signs;
        match layer {
            Layer::Trail => signs.trail,
            Layer::Ray => signs.ray,
            Layer::TransparentWall => signs.transparent_wall,
            Layer::Wall => signs.wall,
            Layer::Curve(which) => signs.series[usize::from(which + 2) % signs.series.len()],
        }
    }
}
