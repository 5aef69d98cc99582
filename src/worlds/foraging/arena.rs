//! The arena: walls, batteries, nest, and which walls matter where.
//!
//! The arena is divided into cells. Each cell has lists of the walls that a robot in it can touch
//! in one step, that its proximity sensors can reach, and that can stand between it and each
//! target. A time step looks at these few walls instead of all.
//!
//! The lists are supersets, so no wall is missed. The bits of a run depend on them nevertheless:
//! a ray that hits a listed wall beyond the range of its sensor draws a number for its noise.

use std::ops::Range;

use nalgebra::{Point2, Vector2};

use super::ArenaSettings;

/// Cells along the longer side. More cells give shorter lists and a longer start. Another number
/// changes the bits of every run.
const CELLS: usize = 50;

/// A straight wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// One end, in millimetres.
    pub start: Point2<f64>,
    /// From one end to the other, in millimetres.
    pub span: Vector2<f64>,
    /// Whether the robot sees through it.
    pub transparent: bool,
    /// Length in millimetres.
    pub(super) length: f64,
    /// The span over its squared length.
    shares: Vector2<f64>,
}

impl Wall {
    /// Makes the wall `[x1, y1, x2, y2]`.
    pub(super) fn new([x1, y1, x2, y2]: [f64; 4]) -> Self {
        Self::between(Point2::new(x1, y1), Point2::new(x2, y2))
    }

    fn between(start: Point2<f64>, end: Point2<f64>) -> Self {
        let span = end - start;
        Self {
            start,
            span,
            transparent: false,
            length: span.norm(),
            shares: span / span.norm_squared(),
        }
    }

    /// Returns the other end.
    #[must_use]
    pub fn end(&self) -> Point2<f64> {
        self.start + self.span
    }

    /// Returns the point of the wall nearest to `point`.
    pub(super) fn nearest(&self, point: Point2<f64>) -> Point2<f64> {
        let along = (point - self.start).dot(&self.shares);
        self.start + self.span * along.clamp(0.0, 1.0)
    }

    /// Returns whether the line from `a` to `b` meets the wall.
    pub(super) fn crosses(&self, a: Point2<f64>, b: Point2<f64>) -> bool {
        let (line, offset) = (b - a, self.start - a);
        let determinant = line.perp(&self.span);
        let (on_line, on_wall) = (offset.perp(&self.span), offset.perp(&line));
        let inside = |share: f64| {
            let share = share * determinant.signum();
            0.0 <= share && share <= determinant.abs()
        };
        determinant != 0.0 && inside(on_line) && inside(on_wall)
    }

    /// Returns the distance between the wall and the line from `a` to `b`.
    fn distance_to_line(&self, a: Point2<f64>, b: Point2<f64>) -> f64 {
        if self.crosses(a, b) {
            return 0.0;
        }
        let line = Self::between(a, b);
        let mut distance = (a - self.nearest(a))
            .norm()
            .min((b - self.nearest(b)).norm());
        if line.length > 0.0 {
            for end in [self.start, self.end()] {
                distance = distance.min((end - line.nearest(end)).norm());
            }
        }
        distance
    }
}

/// Distances in millimetres from the centre of the robot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// The farthest wall that it can touch in one time step.
    pub(super) touch: f64,
    /// The farthest wall that can change a proximity reading.
    pub(super) proximity: f64,
}

/// Walls, batteries and nest.
#[derive(Clone, Debug)]
pub struct Arena {
    /// Extent along x and y in millimetres.
    pub size: Vector2<f64>,
    /// All walls, the four outer ones first.
    pub walls: Vec<Wall>,
    /// Centres of the batteries.
    pub batteries: Vec<Point2<f64>>,
    /// Centre of the nest.
    pub nest: Point2<f64>,
    columns: usize,
    rows: usize,
    cell_side: f64,
    cells_per_mm: f64,
    /// Indices of walls: the lists of all cells one after the other.
    listed: Vec<u16>,
    /// The ends of the lists of each cell: touch, proximity, each target.
    list_ends: Vec<u32>,
}

impl Arena {
    pub(super) fn new(settings: &ArenaSettings, reach: Reach) -> Self {
        let [width, height] = settings.size_mm;
        let outer = [
            [0.0, 0.0, width, 0.0],
            [width, 0.0, width, height],
            [width, height, 0.0, height],
            [0.0, height, 0.0, 0.0],
        ];
        let fences = settings.fences.iter().flat_map(|fence| fence.pieces());
        let opaque = outer
            .into_iter()
            .chain(settings.walls_mm.iter().copied())
            .chain(fences)
            .map(Wall::new);
        let transparent = settings.transparent_walls_mm.iter().map(|&wall| Wall {
            transparent: true,
            ..Wall::new(wall)
        });
        let walls = opaque.chain(transparent).collect();
        let cell_side = width.max(height) / CELLS as f64;
        let mut arena = Self {
            size: Vector2::new(width, height),
            walls,
            batteries: settings
                .batteries_mm
                .iter()
                .copied()
                .map(Point2::from)
                .collect(),
            nest: Point2::from(settings.nest_mm),
            columns: (width / cell_side).ceil() as usize,
            rows: (height / cell_side).ceil() as usize,
            cell_side,
            cells_per_mm: 1.0 / cell_side,
            listed: Vec::new(),
            list_ends: vec![0],
        };
        arena.list_walls(reach);
        arena
    }

    /// Returns the centre of a target: the batteries by index, then the nest.
    #[must_use]
    pub fn target(&self, target: usize) -> Point2<f64> {
        self.batteries.get(target).copied().unwrap_or(self.nest)
    }

    /// Returns the index of the nest among the targets.
    #[must_use]
    pub fn nest_index(&self) -> usize {
        self.batteries.len()
    }

    /// Returns the walls that a robot at `position` can touch in one time step.
    pub(super) fn touchable(&self, position: Point2<f64>) -> impl Iterator<Item = &Wall> + Clone {
        self.list(position, 0)
    }

    /// Returns the walls that can change a proximity reading of a robot at `position`.
    pub(super) fn near(&self, position: Point2<f64>) -> impl Iterator<Item = &Wall> + Clone {
        self.list(position, 1)
    }

    /// Returns whether no opaque wall stands between `position` and a target.
    pub(super) fn in_sight(&self, position: Point2<f64>, target: usize) -> bool {
        let centre = self.target(target);
        !self
            .list(position, 2 + target)
            .any(|wall| wall.crosses(position, centre))
    }

    /// Returns whether a disc of this radius fits at `position`.
    pub(super) fn is_free(&self, position: Point2<f64>, radius: f64) -> bool {
        self.touchable(position)
            .all(|wall| (position - wall.nearest(position)).norm() >= radius)
    }

    fn lists_per_cell(&self) -> usize {
        2 + self.batteries.len() + 1
    }

    fn list(&self, position: Point2<f64>, list: usize) -> impl Iterator<Item = &Wall> + Clone {
        let index = |coordinate: f64, cells: usize| {
            ((coordinate * self.cells_per_mm) as usize).min(cells - 1)
        };
        let cell = index(position.y, self.rows) * self.columns + index(position.x, self.columns);
        let at = cell * self.lists_per_cell() + list;
        let range = Range {
            start: self.list_ends[at] as usize,
            end: self.list_ends[at + 1] as usize,
        };
        self.listed[range]
            .iter()
            .map(|&wall| &self.walls[usize::from(wall)])
    }

    fn list_walls(&mut self, reach: Reach) {
        let half_diagonal = self.cell_side * std::f64::consts::FRAC_1_SQRT_2 + 1.0;
        for row in 0..self.rows {
            for column in 0..self.columns {
                let corner = Vector2::new(column as f64 + 0.5, row as f64 + 0.5);
                let centre = Point2::from(corner * self.cell_side);
                for radius in [reach.touch, reach.proximity] {
                    let within = radius + half_diagonal;
                    self.list_where(|wall| (centre - wall.nearest(centre)).norm() <= within);
                }
                for target in 0..=self.batteries.len() {
                    let target = self.target(target);
                    self.list_where(|wall| {
                        !wall.transparent && wall.distance_to_line(centre, target) <= half_diagonal
                    });
                }
            }
        }
    }

    fn list_where(&mut self, matters: impl Fn(&Wall) -> bool) {
        let walls = self.walls.iter().enumerate();
        let chosen = walls
            .filter(|(_, wall)| matters(wall))
            .map(|(index, _)| index as u16);
        self.listed.extend(chosen);
        self.list_ends.push(self.listed.len() as u32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::worlds::foraging::settings::tests::environment;
    use proptest::prelude::*;

    fn arena() -> Arena {
        let reach = Reach {
            touch: 135.0,
            proximity: 464.0,
        };
        Arena::new(&environment(3).arena, reach)
    }

    #[test]
    fn a_fence_blocks_sight_except_at_its_slits() {
        let arena = arena();
        // Battery 1 at (2050, 600) behind the fence x = 1700, a slit at y = 600.
        assert!(arena.in_sight(Point2::new(1500.0, 600.0), 0));
        assert!(!arena.in_sight(Point2::new(1650.0, 650.0), 0));
        assert!(!arena.is_free(Point2::new(1700.0, 600.0), 75.0));
    }

    proptest! {
        #[test]
        fn lists_contain_every_wall_that_matters(x in 0.0..3000.0_f64, y in 0.0..3000.0_f64) {
            let arena = arena();
            let position = Point2::new(x, y);
            let listed: Vec<_> = arena.near(position).copied().collect();
            for wall in &arena.walls {
                if (position - wall.nearest(position)).norm() <= 464.0 {
                    prop_assert!(listed.contains(wall));
                }
            }
            for target in 0..=arena.nest_index() {
                let blocked = arena.walls.iter().any(|wall| wall.crosses(position, arena.target(target)));
                prop_assert_eq!(arena.in_sight(position, target), !blocked);
            }
        }
    }
}
