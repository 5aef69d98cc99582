//! Where the body of the robot fits, and which of these places hang together.
//!
//! A grid of cells covers the arena. A cell is free if the disc fits at its centre or within a
//! cell's half diagonal of it: a passage as wide as the robot is found wherever it lies in the
//! grid. Neighbouring free places are a quarter of the radius apart at most, so the disc fits
//! between them too, but for a hundredth of its radius.

use nalgebra::Point2;

use super::arena::Arena;

/// Cells along the radius of the robot.
const CELLS_PER_RADIUS: f64 = 10.0;
/// Largest number of cells. It bounds the memory and work of a small robot in a large arena.
const MAX_CELLS: usize = 8_000_000;
/// How far a place is moved away from walls, in cells. Half a diagonal is 0.71.
const LARGEST_SHIFT: f64 = 0.75;
/// Number of walls that a place is moved away from, one after the other.
const MAX_MOVES: usize = 8;
/// Distance in millimetres by which a disc that fits may enter a wall: rounding error.
const TOLERANCE_MM: f64 = 1e-6;

const BLOCKED: u32 = u32::MAX;
const UNVISITED: u32 = u32::MAX - 1;

/// Free places that hang together.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    /// Number of its cells.
    pub(super) cells: usize,
    /// One of its places.
    pub(super) place: Point2<f64>,
}

/// The free places of an arena for a disc.
#[derive(Debug)]
pub(super) struct FreeSpace<'a> {
    arena: &'a Arena,
    radius: f64,
    pitch: f64,
    columns: usize,
    rows: usize,
    /// The index of each cell's region, or `BLOCKED`.
    labels: Vec<u32>,
    /// The regions by index.
    pub(super) regions: Vec<Region>,
}

impl<'a> FreeSpace<'a> {
    /// Finds the free places. `None` if the disc is too small for a grid of this arena.
    pub(super) fn new(arena: &'a Arena, radius: f64) -> Option<Self> {
        let pitch = radius / CELLS_PER_RADIUS;
        let [columns, rows] = [arena.size.x, arena.size.y].map(|side| (side / pitch).ceil());
        if columns * rows > MAX_CELLS as f64 {
            return None;
        }
        let mut space = Self {
            arena,
            radius,
            pitch,
            columns: columns as usize,
            rows: rows as usize,
            labels: Vec::new(),
            regions: Vec::new(),
        };
        let label = |cell| match space.place(cell) {
            Some(_) => UNVISITED,
            None => BLOCKED,
        };
        space.labels = (0..space.columns * space.rows).map(label).collect();
        space.label_regions();
        Some(space)
    }

    /// Returns the number of free cells.
    pub(super) fn cells(&self) -> usize {
        self.regions.iter().map(|region| region.cells).sum()
    }

    /// Returns free places within `distance` of `centre` with the indices of their regions.
    pub(super) fn places_around(
        &self,
        centre: Point2<f64>,
        distance: f64,
    ) -> impl Iterator<Item = (usize, Point2<f64>)> + '_ {
        let span = |at: f64, cells: usize| {
            let cell = |coordinate: f64| ((coordinate / self.pitch) as usize).min(cells - 1);
            cell(at - distance)..=cell(at + distance)
        };
        let columns = span(centre.x, self.columns);
        let rows = span(centre.y, self.rows);
        let cells = rows.flat_map(move |row| {
            let columns = columns.clone();
            columns.map(move |column| row * self.columns + column)
        });
        let places = cells.filter_map(|cell| Some((self.region(cell)?, self.place(cell)?)));
        // Cells can be larger than the distance, so the nearest place is one of its own.
        let nearest = self.fit(centre).into_iter();
        nearest
            .filter_map(|place| Some((self.region(self.cell(place))?, place)))
            .chain(places)
            .filter(move |(_, place)| (place - centre).norm() <= distance)
    }

    fn cell(&self, place: Point2<f64>) -> usize {
        let index = |coordinate: f64, cells| ((coordinate / self.pitch) as usize).min(cells - 1);
        index(place.y, self.rows) * self.columns + index(place.x, self.columns)
    }

    fn region(&self, cell: usize) -> Option<usize> {
        let label = self.labels[cell];
        (label != BLOCKED).then_some(label as usize)
    }

    /// Returns the free place of a cell.
    fn place(&self, cell: usize) -> Option<Point2<f64>> {
        let [column, row] = [cell % self.columns, cell / self.columns];
        let [x, y] = [column, row].map(|index| (index as f64 + 0.5) * self.pitch);
        self.fit(Point2::new(x, y))
    }

    /// Returns the free place that `start` becomes when it is moved away from walls a little.
    fn fit(&self, start: Point2<f64>) -> Option<Point2<f64>> {
        let shift = LARGEST_SHIFT * self.pitch;
        let mut place = start;
        for _ in 0..MAX_MOVES {
            let offsets = self
                .arena
                .touchable(place)
                .map(|wall| place - wall.nearest(place));
            let nearest = offsets.min_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
            let Some(offset) = nearest else {
                return Some(place);
            };
            let distance = offset.norm();
            let missing = self.radius - distance;
            if missing <= TOLERANCE_MM {
                return Some(place);
            }
            if missing > 2.0 * shift {
                return None;
            }
            place += offset * (missing / distance);
            if (place - start).norm() > shift {
                return None;
            }
        }
        None
    }

    fn label_regions(&mut self) {
        for first in 0..self.labels.len() {
            if self.labels[first] != UNVISITED {
                continue;
            }
            let cells = self.fill(first, self.regions.len() as u32);
            if let Some(place) = self.place(first) {
                self.regions.push(Region { cells, place });
            }
        }
    }

    /// Labels all cells that hang together with `first`, and returns their number.
    fn fill(&mut self, first: usize, label: u32) -> usize {
        self.labels[first] = label;
        let mut open = vec![first];
        let mut cells = 0;
        while let Some(cell) = open.pop() {
            cells += 1;
            for next in self.neighbours(cell).into_iter().flatten() {
                if self.labels[next] == UNVISITED {
                    self.labels[next] = label;
                    open.push(next);
                }
            }
        }
        cells
    }

    fn neighbours(&self, cell: usize) -> [Option<usize>; 4] {
        let [column, row] = [cell % self.columns, cell / self.columns];
        [
            (column > 0).then(|| cell - 1),
            (column + 1 < self.columns).then(|| cell + 1),
            (row > 0).then(|| cell - self.columns),
            (row + 1 < self.rows).then(|| cell + self.columns),
        ]
    }
}
