//! Distances along the proximity rays, computed for all rays at once.

use nalgebra::{Point2, Vector2};
use pulp::{Arch, Simd, WithSimd};

use super::arena::Wall;
use super::catalogue::PROXIMITY_SENSORS;

/// Number of rays in whole vectors. Rays beyond the sensors have no direction and hit nothing.
const LANES: usize = PROXIMITY_SENSORS.next_multiple_of(4);

/// The directions of the proximity rays.
pub(super) struct Rays {
    x: [f64; LANES],
    y: [f64; LANES],
}

impl Rays {
    pub(super) fn new(directions: [Vector2<f64>; PROXIMITY_SENSORS]) -> Self {
        let mut rays = Self {
            x: [0.0; LANES],
            y: [0.0; LANES],
        };
        for (lane, direction) in directions.iter().enumerate() {
            rays.x[lane] = direction.x;
            rays.y[lane] = direction.y;
        }
        rays
    }

    /// Returns the distance from `origin` along each ray to the first wall, or infinity.
    pub(super) fn cast<'w>(
        &self,
        origin: Point2<f64>,
        walls: impl Iterator<Item = &'w Wall>,
    ) -> [f64; PROXIMITY_SENSORS] {
        Arch::new().dispatch(Cast {
            rays: self,
            origin,
            walls,
        })
    }
}

struct Cast<'r, I> {
    rays: &'r Rays,
    origin: Point2<f64>,
    walls: I,
}

impl<'w, I: Iterator<Item = &'w Wall>> WithSimd for Cast<'_, I> {
    type Output = [f64; PROXIMITY_SENSORS];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let nothing = simd.splat_f64s(f64::INFINITY);
        let zero = simd.splat_f64s(0.0);
        let (x, y) = (
            S::as_simd_f64s(&self.rays.x).0,
            S::as_simd_f64s(&self.rays.y).0,
        );
        let mut nearest = [nothing; LANES];
        for wall in self.walls {
            let start = wall.start - self.origin;
            let to_line = simd.splat_f64s(start.perp(&wall.span));
            let start = [start.x, start.y].map(|number| simd.splat_f64s(number));
            let span = [wall.span.x, wall.span.y].map(|number| simd.splat_f64s(number));
            let perp = |x, y, [other_x, other_y]: [S::f64s; 2]| {
                simd.sub_f64s(simd.mul_f64s(x, other_y), simd.mul_f64s(y, other_x))
            };
            for ((&x, &y), nearest) in x.iter().zip(y).zip(&mut nearest) {
                // origin + t ray = start + s span, solved by Cramer's rule; s lies
                // between 0 and 1 where s (1 - s) is not negative.
                let determinant = perp(x, y, span);
                let along = simd.neg_f64s(perp(x, y, start));
                let beyond = simd.sub_f64s(determinant, along);
                let t = simd.div_f64s(to_line, determinant);
                let hit = simd.and_m64s(
                    simd.greater_than_or_equal_f64s(simd.mul_f64s(along, beyond), zero),
                    simd.greater_than_or_equal_f64s(t, zero),
                );
                *nearest = simd.min_f64s(*nearest, simd.select_f64s(hit, t, nothing));
            }
        }
        let mut distances = [0.0; PROXIMITY_SENSORS];
        let lanes: &[f64] = pulp::bytemuck::cast_slice(&nearest);
        distances.copy_from_slice(&lanes[..PROXIMITY_SENSORS]);
        distances
    }
}
