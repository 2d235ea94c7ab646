//! Turn of a free block in one step: what turns a drift along straight lines into one along circles about the moving
//! centroid (Eqs. 81, 82).

use crate::geometry::{Point, Vector};

use super::BlockCovers;
use super::motion::turned;

/// Turn of a block at the end of a step in which its covers have moved along straight lines.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Turn {
    /// Centroid (m).
    centre: Point,
    /// Its velocity (m/s).
    velocity: Vector,
    /// Time (s) for which the covers moved.
    dt: f64,
    /// Angle θ (rad), sin θ and 1 − cos θ.
    angle: f64,
    sin: f64,
    versed: f64,
    /// Angular velocity (rad/s) before, and by how much it grows at the same angular momentum.
    spin: f64,
    growth: f64,
}

impl Turn {
    /// Square of an angle (rad²) up to which circle and tangent are the same in double precision.
    pub const NONE: f64 = f64::EPSILON;

    /// Turn of a block whose covers have moved for `dt` (s) with their velocities. The straight drift has kept the
    /// angular momentum, and the polar inertia before it follows from the sums after it.
    pub fn new(covers: &BlockCovers, dt: f64) -> Self {
        let centre = covers.centre();
        let sums = covers.sums(covers.velocity, centre);
        let square = covers.product(covers.velocity, covers.velocity, &sums, &sums);
        let radial = sums.radial - dt * square;
        let polar = sums.polar - dt * (sums.radial + radial);
        let spin = sums.moment / polar;
        let widened = dt * (2.0 * radial + dt * (square - spin * sums.moment));
        let (angle, growth) = (spin * dt, -spin * widened / (polar + widened));
        let half = libm::sin(0.5 * angle);
        Self {
            centre,
            velocity: sums.velocity,
            dt,
            angle,
            sin: libm::sin(angle),
            versed: 2.0 * half * half,
            spin,
            growth,
        }
    }

    /// Turns a cover.
    #[inline]
    pub fn apply(&self, star: Point, displacement: &mut Vector, velocity: &mut Vector) {
        let (along, own) = (star - self.centre + *displacement, *velocity - self.velocity);
        let before = along - own * self.dt;
        let back = turned(before) * self.angle;
        let shift = self.turn(along - back) - back;
        let straining = own - turned(before) * self.spin;
        let carried = turned(straining + self.turn(straining)) * self.angle;
        *displacement += shift;
        *velocity += self.turn(own) + carried + turned(along + shift) * self.growth;
    }

    /// Change of a vector by the turn.
    #[inline(always)]
    fn turn(&self, v: Vector) -> Vector {
        turned(v) * self.sin - v * self.versed
    }
}
