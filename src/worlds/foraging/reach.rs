//! Whether the robot can do its task: from where it captures batteries, and from where it reaches
//! the nest.
//!
//! Headings do not matter, because the robot can turn wherever it fits.

use nalgebra::Point2;

use super::arena::Arena;
use super::free_space::FreeSpace;
use crate::rules::Problem;

/// Pockets with a smaller share of the free places are not worth a warning: one start in a
/// thousand.
const SMALLEST_SHARE: f64 = 0.001;
/// Share of the free places above which a task that needs no movement is worth a warning.
const LARGEST_IDLE_SHARE: f64 = 0.5;
/// Batteries closer than this are in one place, in millimetres.
const ONE_PLACE_MM: f64 = 1.0;
/// A target as close to a wall is in it, in millimetres.
const IN_WALL_MM: f64 = 1e-6;

/// The part of a robot that matters to its reach, in millimetres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Body {
    /// Radius.
    pub(super) radius: f64,
    /// Distance within which it captures a battery that it sees.
    pub(super) capture: f64,
    /// Distance within which it reaches the nest if it sees it.
    pub(super) delivery: f64,
}

/// What a robot can reach in an arena.
#[derive(Debug)]
pub(super) struct Survey<'a> {
    arena: &'a Arena,
    body: Body,
    space: FreeSpace<'a>,
    /// For each target, the batteries and then the nest: from which regions it is reached.
    reached: Vec<Vec<bool>>,
}

impl<'a> Survey<'a> {
    /// Surveys an arena. Fails if the robot is too small for that; the problem is no more than a
    /// warning.
    pub(super) fn new(arena: &'a Arena, body: Body) -> Result<Self, Problem> {
        let space = FreeSpace::new(arena, body.radius).ok_or_else(|| {
            let found = format!("{}, so small that ways are not checked", body.radius);
            Problem::new("robot.radius_mm", found, "larger, or a smaller arena")
        })?;
        let mut survey = Self {
            arena,
            body,
            space,
            reached: Vec::new(),
        };
        let targets = 0..=arena.nest_index();
        survey.reached = targets.map(|target| survey.regions_of(target)).collect();
        Ok(survey)
    }

    /// Returns why no robot can do its task, wherever it starts.
    pub(super) fn refusal(&self) -> Option<Problem> {
        let regions = self.space.regions.len();
        if (0..regions).any(|region| self.is_solvable(region)) {
            return None;
        }
        let Body { radius, .. } = self.body;
        if regions == 0 {
            let found = format!("no free place for a robot of radius {radius} mm");
            let allowed = "an arena with room to start in";
            return Some(Problem::new("arena", found, allowed));
        }
        let nest = self.arena.nest_index();
        let battery = (0..nest).find(|&battery| self.is_reached(battery));
        let Some(battery) = battery else {
            let found = format!("no battery in reach: {}", self.unreached(0));
            let allowed = format!("at least one {}", self.allowed(0));
            return Some(Problem::new("arena.batteries_mm", found, allowed));
        };
        if !self.is_reached(nest) {
            let allowed = format!("a nest {}", self.allowed(nest));
            return Some(Problem::new("arena.nest_mm", self.unreached(nest), allowed));
        }
        let at = words(self.arena.batteries[battery]);
        let found = format!(
            "no way to the nest from any battery in reach, such as batteries_mm[{battery}] at {at}"
        );
        let allowed = format!("a way at least {} mm wide", 2.0 * radius);
        Some(Problem::new("arena", found, allowed))
    }

    /// Returns what is odd about an arena in which a robot can do its task.
    pub(super) fn warnings(&self) -> Vec<Problem> {
        let batteries = 0..self.arena.batteries.len();
        let odd = batteries.filter_map(|battery| self.odd_battery(battery));
        odd.chain(self.pockets()).chain(self.crowding()).collect()
    }

    fn regions_of(&self, target: usize) -> Vec<bool> {
        let regions = self.space.regions.len();
        let mut reached = vec![false; regions];
        if self.wall_through(target).is_some() {
            return reached;
        }
        let mut open = regions;
        let (centre, distance) = (self.arena.target(target), self.distance(target));
        for (region, place) in self.space.places_around(centre, distance) {
            if open == 0 {
                break;
            }
            if !reached[region] && self.arena.in_sight(place, target) {
                reached[region] = true;
                open -= 1;
            }
        }
        reached
    }

    fn distance(&self, target: usize) -> f64 {
        if target == self.arena.nest_index() {
            self.body.delivery
        } else {
            self.body.capture
        }
    }

    /// Returns the index of a wall in which a target lies: no robot sees it.
    fn wall_through(&self, target: usize) -> Option<usize> {
        let centre = self.arena.target(target);
        let mut walls = self.arena.walls.iter();
        walls.position(|wall| {
            !wall.transparent && (centre - wall.nearest(centre)).norm() <= IN_WALL_MM
        })
    }

    fn is_reached(&self, target: usize) -> bool {
        self.reached[target].contains(&true)
    }

    /// Returns whether a robot in this region can capture a battery and bring it to the nest.
    fn is_solvable(&self, region: usize) -> bool {
        let nest = self.arena.nest_index();
        self.reached[nest][region] && self.captures(region)
    }

    fn captures(&self, region: usize) -> bool {
        let mut batteries = self.reached[..self.arena.nest_index()].iter();
        batteries.any(|regions| regions[region])
    }

    fn odd_battery(&self, battery: usize) -> Option<Problem> {
        let batteries = &self.arena.batteries;
        let centre = batteries[battery];
        let is_near = |other: &Point2<f64>, limit| (centre - other).norm() < limit;
        let twin = batteries[..battery]
            .iter()
            .position(|other| is_near(other, ONE_PLACE_MM));
        let radius = self.body.radius;
        let (found, allowed) = if !self.is_of_use(battery) {
            (
                self.unreached(battery),
                format!("a battery {}", self.allowed(battery)),
            )
        } else if let Some(twin) = twin {
            let found = format!("{}, where batteries_mm[{twin}] is", words(centre));
            (found, String::from("a place of its own"))
        } else if is_near(&self.arena.nest, radius) {
            let found = format!("{}, on the nest", words(centre));
            (found, format!("at least {radius} mm from the nest"))
        } else {
            return None;
        };
        Some(Problem::new(
            format!("arena.batteries_mm[{battery}]"),
            found,
            allowed,
        ))
    }

    /// Returns whether a robot can capture this battery and then reach the nest.
    fn is_of_use(&self, battery: usize) -> bool {
        let nest = &self.reached[self.arena.nest_index()];
        let mut regions = self.reached[battery].iter().zip(nest);
        regions.any(|(&captured, &delivered)| captured && delivered)
    }

    /// Describes the free places from which no robot can do its task.
    fn pockets(&self) -> Option<Problem> {
        let regions = self.space.regions.iter().enumerate();
        let pockets = regions.filter(|&(region, _)| !self.is_solvable(region));
        let cells: usize = pockets.clone().map(|(_, pocket)| pocket.cells).sum();
        let share = cells as f64 / self.space.cells() as f64;
        let (region, largest) = pockets.max_by_key(|(_, pocket)| pocket.cells)?;
        let lacking = if self.captures(region) {
            "the nest"
        } else {
            "any battery"
        };
        let found = format!(
            "{:.1} % of the free places without a way to battery and nest, such as {}, from where \
             the robot cannot reach {lacking}",
            100.0 * share,
            words(largest.place)
        );
        let allowed = format!("ways at least {} mm wide", 2.0 * self.body.radius);
        (share >= SMALLEST_SHARE).then(|| Problem::new("arena", found, allowed))
    }

    /// Describes an arena where the robot need not move.
    fn crowding(&self) -> Option<Problem> {
        let (arena, nest) = (self.arena, self.arena.nest_index());
        let captures = |place: Point2<f64>| {
            (0..nest).any(|battery| {
                let near = (place - arena.target(battery)).norm() <= self.body.capture;
                near && arena.in_sight(place, battery)
            })
        };
        let idle = self
            .space
            .places_around(arena.nest, self.body.delivery)
            .filter(|&(_, place)| captures(place) && arena.in_sight(place, nest))
            .count();
        let share = idle as f64 / self.space.cells() as f64;
        let found = format!(
            "{}, where the robot captures and delivers without moving at {:.0} % of its places",
            words(arena.size.into()),
            (100.0 * share).min(100.0)
        );
        (share > LARGEST_IDLE_SHARE).then(|| Problem::new("arena.size_mm", found, "a larger arena"))
    }

    /// Describes a target that is out of reach.
    fn unreached(&self, target: usize) -> String {
        let at = words(self.arena.target(target));
        if self.wall_through(target).is_some() {
            format!("{at}, in a wall")
        } else if self.is_reached(target) {
            format!("{at}, from where there is no way to the nest")
        } else {
            format!("{at}, out of the robot's reach")
        }
    }

    /// Describes where a target may be.
    fn allowed(&self, target: usize) -> String {
        format!(
            "within {} mm and in sight of a place where a robot of radius {} mm fits",
            self.distance(target),
            self.body.radius
        )
    }
}

fn words(place: Point2<f64>) -> String {
    format!("[{:.0}, {:.0}]", place.x, place.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, Stream, stream};
    use crate::worlds::foraging::arena::{Reach, Wall};
    use crate::worlds::foraging::{ArenaSettings, settings::tests::environment};
    use rand::RngExt;

    const BODY: Body = Body {
        radius: 40.0,
        capture: 70.0,
        delivery: 90.0,
    };
    /// How far the direct check is from the survey, in millimetres: more than its pitch.
    const MARGIN: f64 = 8.0;
    const PITCH: f64 = 5.0;
    const CELLS: [usize; 2] = [100, 80];

    /// Walls, batteries and a nest at random, 0.5 by 0.4 m.
    fn random_arena(rng: &mut Stream) -> ArenaSettings {
        let mut point = || [500.0, 400.0].map(|side| (rng.random::<f64>() * side).round());
        let [a, b, nest_mm] = [point(), point(), point()];
        let walls = (0..4).map(|_| {
            let [[x1, y1], [x2, y2]] = [point(), point()];
            [x1, y1, x2, y2]
        });
        ArenaSettings {
            size_mm: [500.0, 400.0],
            walls_mm: walls.collect(),
            batteries_mm: vec![a, b],
            nest_mm,
            ..environment(1).arena
        }
    }

    /// A direct check: a grid of places, each tested against all walls.
    ///
    /// A cautious one (`margin` above 0) finds less than there is, a bold one finds more.
    struct Direct<'a> {
        arena: &'a Arena,
        margin: f64,
    }

    impl Direct<'_> {
        fn fits(&self, place: Point2<f64>) -> bool {
            let least = BODY.radius + self.margin;
            let mut walls = self.arena.walls.iter();
            walls.all(|wall| (place - wall.nearest(place)).norm() >= least)
        }

        /// Sight past walls that are longer or shorter by the margin.
        fn sees(&self, place: Point2<f64>, target: Point2<f64>) -> bool {
            let mut walls = self.arena.walls.iter();
            walls.all(|wall| {
                let along = wall.span.normalize() * self.margin;
                if wall.span.norm() + 2.0 * self.margin <= 0.0 {
                    return true;
                }
                let [start, end] = [wall.start - along, wall.end() + along];
                let longer = Wall::new([start.x, start.y, end.x, end.y]);
                let in_wall = (target - wall.nearest(target)).norm() <= self.margin.max(0.0);
                !longer.crosses(place, target) && !in_wall
            })
        }

        fn reaches(&self, places: &[Point2<f64>], target: Point2<f64>, distance: f64) -> bool {
            places.iter().any(|&place| {
                let near = (place - target).norm() <= distance - self.margin;
                near && self.sees(place, target)
            })
        }

        fn is_solvable(&self) -> bool {
            let [columns, rows] = CELLS;
            let place = |cell: usize| {
                let [x, y] = [cell % columns, cell / columns].map(|i| (i as f64 + 0.5) * PITCH);
                Point2::new(x, y)
            };
            let mut free: Vec<_> = (0..columns * rows).map(|c| self.fits(place(c))).collect();
            while let Some(first) = free.iter().position(|&is_free| is_free) {
                free[first] = false;
                let (mut region, mut next) = (vec![first], 0);
                while next < region.len() {
                    let cell = region[next];
                    next += 1;
                    // The outer walls keep free cells away from the edges of the grid.
                    for near in [cell - 1, cell + 1, cell - columns, cell + columns] {
                        if std::mem::replace(&mut free[near], false) {
                            region.push(near);
                        }
                    }
                }
                let places: Vec<_> = region.into_iter().map(place).collect();
                let mut batteries = self.arena.batteries.iter();
                if batteries.any(|&battery| self.reaches(&places, battery, BODY.capture))
                    && self.reaches(&places, self.arena.nest, BODY.delivery)
                {
                    return true;
                }
            }
            false
        }
    }

    #[test]
    fn the_survey_lies_between_a_cautious_and_a_bold_direct_check() {
        let mut rng = stream(7, 0, 0, Purpose::StartPoses);
        let arenas = 150;
        let (mut solvable, mut unsolvable) = (0, 0);
        for _ in 0..arenas {
            let settings = random_arena(&mut rng);
            let reach = Reach {
                touch: BODY.radius,
                proximity: BODY.radius,
            };
            let arena = Arena::new(&settings, reach);
            let direct = |margin| {
                Direct {
                    arena: &arena,
                    margin,
                }
                .is_solvable()
            };
            match Survey::new(&arena, BODY).unwrap().refusal() {
                None => {
                    solvable += 1;
                    assert!(direct(-MARGIN), "solvable: {settings:?}");
                }
                Some(problem) => {
                    unsolvable += 1;
                    assert!(!direct(MARGIN), "{problem}: {settings:?}");
                }
            }
        }
        assert!(
            solvable.min(unsolvable) > arenas / 10,
            "{solvable}, {unsolvable}"
        );
    }
}
