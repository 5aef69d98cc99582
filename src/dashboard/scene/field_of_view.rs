//! The part of a world that an agent sees.

use crate::worlds::scene::{Scenery, Snapshot};

/// Number of directions in which the range is measured.
const DIRECTIONS: usize = 181;

/// The field of view of an agent: its range in each direction, up to the nearest wall.
#[derive(Debug)]
pub(super) struct FieldOfView {
    at: [f64; 2],
    heading: f64,
    half_angle: f64,
    reach: Vec<f64>,
}

impl FieldOfView {
    /// Returns the field of view of an agent, if it has a heading and a view.
    pub(super) fn of(snapshot: &Snapshot, scenery: &Scenery) -> Option<Self> {
        let (view, heading) = (snapshot.view?, snapshot.heading?);
        let reach = (0..DIRECTIONS).map(|index| {
            let share = index as f64 / (DIRECTIONS - 1) as f64;
            let (sin, cos) = libm::sincos(heading + view.half_angle * (2.0 * share - 1.0));
            let walls = scenery.walls.iter();
            let nearest = walls.filter_map(|wall| distance(snapshot.at, [cos, sin], wall));
            nearest.fold(view.range, f64::min)
        });
        Some(Self {
            at: snapshot.at,
            heading,
            half_angle: view.half_angle,
            reach: reach.collect(),
        })
    }

    /// Returns whether a place is seen.
    pub(super) fn sees(&self, place: [f64; 2]) -> bool {
        let (dx, dy) = (place[0] - self.at[0], place[1] - self.at[1]);
        let turn = libm::atan2(dy, dx) - self.heading;
        let turn = libm::remainder(turn, std::f64::consts::TAU);
        if turn.abs() > self.half_angle {
            return false;
        }
        let share = (turn / self.half_angle + 1.0) / 2.0;
        let index = (share * (DIRECTIONS - 1) as f64).round() as usize;
        let reach = self.reach.get(index).copied().unwrap_or(0.0);
        libm::hypot(dx, dy) <= reach
    }
}

/// Returns the distance to a wall from a place in a direction of length 1, if the ray meets the
/// wall.
fn distance(from: [f64; 2], direction: [f64; 2], [start, end]: &[[f64; 2]; 2]) -> Option<f64> {
    let span = [end[0] - start[0], end[1] - start[1]];
    let offset = [start[0] - from[0], start[1] - from[1]];
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let determinant = cross(direction, span);
    let along = cross(offset, span) / determinant;
    let on_wall = cross(offset, direction) / determinant;
    let met = along >= 0.0 && (0.0..=1.0).contains(&on_wall);
    (determinant != 0.0 && met).then_some(along)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_is_met_where_it_is() {
        let wall = [[2.0, -1.0], [2.0, 1.0]];
        assert_eq!(distance([0.0, 0.0], [1.0, 0.0], &wall), Some(2.0));
        assert_eq!(distance([0.0, 0.0], [-1.0, 0.0], &wall), None);
        assert_eq!(distance([0.0, 3.0], [1.0, 0.0], &wall), None);
        assert_eq!(distance([0.0, 0.0], [0.0, 1.0], &wall), None);
    }
}
