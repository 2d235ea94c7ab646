//! Velocities of one block: the explicit kick by forces, damping, energy and momentum in the block's metric.

use crate::geometry::{Point, Vector};

use super::Metric;

/// J90·v: turned by +90°.
fn turned(v: Vector) -> Vector {
    Vector::new(-v.y, v.x)
}

/// How velocities decay in a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    /// Velocity relative to the block's rigid motion is multiplied by the factor, theory Eq. (11).
    Deformation(f64),
    /// The whole velocity is multiplied by the factor, theory Eq. (12).
    Mass(f64),
}

/// Rigid motion of a block and what one kick took from it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BlockMotion {
    /// Centroid (m).
    pub centre: Point,
    /// Kinetic energy taken by damping in this step (J/m).
    pub damped: f64,
}

/// Sums over the covers of a block that describe its motion.
struct Sums {
    velocity: Vector,
    spin: f64,
    moment: f64,
    square: f64,
}

/// One block's slices of the cover arrays, and the block's place in the metric.
pub struct Kick<'a> {
    /// Masses of all covers and blocks.
    pub metric: &'a Metric,
    /// Block.
    pub block: usize,
    /// Covers of the block in the arrays of the metric.
    pub covers: std::ops::Range<usize>,
    /// Star positions (m), all covers.
    pub star: &'a [Point],
    /// Displacements (m), all covers.
    pub displacement: &'a [Vector],
    /// Velocities before the step (m/s), all covers.
    pub velocity: &'a [Vector],
    /// Gravity and body loads (m/s²).
    pub acceleration: Vector,
    /// Damping of this step.
    pub damping: Damping,
    /// Step by which forces act (s).
    pub dt: f64,
}

impl Kick<'_> {
    fn place(&self, i: usize) -> Point {
        self.star[i] + self.displacement[i]
    }

    /// Centroid of the block in its metric.
    fn centre(&self) -> Point {
        let first: Point = self.covers.clone().map(|i| self.place(i) * self.metric.inertial[i]).sum();
        first / self.metric.total[self.block]
    }

    /// Rigid velocity, spin and the sums of the deformation, theory Eq. (5).
    fn sums(&self, centre: Point) -> Sums {
        let metric = self.metric;
        let total = metric.total[self.block];
        let velocity =
            self.covers.clone().map(|i| self.velocity[i] * metric.inertial[i]).sum::<Vector>() / total;
        let (mut moment, mut square) = (0.0, 0.0);
        let (mut first, mut linear) = (Vector::zeros(), Vector::zeros());
        for i in self.covers.clone() {
            let (m, d, u) = (metric.mass[i], self.place(i) - centre, self.velocity[i] - velocity);
            first += d * m;
            linear += u * m;
            moment += m * d.perp(&u);
            square += m * u.norm_squared();
        }
        moment -= first.perp(&linear) / total;
        square -= linear.norm_squared() / total;
        Sums { velocity, spin: moment / metric.polar_lumped[self.block], moment, square }
    }
}

/// Kinetic energy (J/m) of a block in its metric, theory Eq. (5).
pub fn kinetic_energy(kick: &Kick) -> f64 {
    let (metric, block) = (kick.metric, kick.block);
    if !metric.is_free(block) {
        return kick.covers.clone().map(|i| 0.5 * metric.mass[i] * kick.velocity[i].norm_squared()).sum();
    }
    let sums = kick.sums(kick.centre());
    let (polar, lumped) = (metric.polar[block], metric.polar_lumped[block]);
    0.5 * metric.total[block] * sums.velocity.norm_squared()
        + 0.5 * sums.square
        + 0.5 * (polar - lumped) / (lumped * lumped) * sums.moment * sums.moment
}

/// Rigid motion of a block in its metric: centroid (m), its velocity (m/s) and the spin (rad/s).
pub fn rigid_motion(kick: &Kick) -> (Point, Vector, f64) {
    let centre = kick.centre();
    let sums = kick.sums(centre);
    (centre, sums.velocity, sums.spin)
}

/// Writes the velocity (m/s) of a block's covers that is a translation (m/s) plus a spin (rad/s) about the centroid.
pub fn rigid_velocity(kick: &Kick, velocity: Vector, spin: f64, out: &mut [Vector]) {
    let centre = kick.centre();
    for (k, i) in kick.covers.clone().enumerate() {
        out[k] = velocity + turned(kick.place(i) - centre) * spin;
    }
}

/// Damps the block's velocity and kicks it by `force` (N/m, this block's covers only); writes the `damped` and the
/// `predicted` velocities and returns centroid and damped energy, theory Eqs. (3), (10)–(12).
pub fn kick(kick: &Kick, force: &[Vector], predicted: &mut [Vector], damped: &mut [Vector]) -> BlockMotion {
    let centre = kick.centre();
    let loss = damp(kick, centre, predicted);
    damped.copy_from_slice(predicted);
    if kick.metric.is_free(kick.block) {
        push_free(kick, centre, force, predicted);
    } else {
        for (k, i) in kick.covers.clone().enumerate() {
            let force = force[k] + kick.acceleration * kick.metric.row_sum[i];
            predicted[k] += force.component_mul(&kick.metric.inverse[i]) * kick.dt;
        }
    }
    BlockMotion { centre, damped: loss }
}

fn damp(kick: &Kick, centre: Point, predicted: &mut [Vector]) -> f64 {
    let own = &kick.velocity[kick.covers.clone()];
    match kick.damping {
        Damping::Deformation(factor) if factor < 1.0 => {
            let sums = kick.sums(centre);
            for (k, i) in kick.covers.clone().enumerate() {
                let rigid = sums.velocity + turned(kick.place(i) - centre) * sums.spin;
                let held = kick.metric.inverse[i].map(|v| f64::from(u8::from(v > 0.0)));
                predicted[k] = (rigid + (own[k] - rigid) * factor).component_mul(&held);
            }
            let deforming = 0.5 * (sums.square - sums.moment * sums.moment / kick.metric.polar_lumped[kick.block]);
            (1.0 - factor * factor) * deforming
        }
        Damping::Deformation(_) => {
            predicted.copy_from_slice(own);
            0.0
        }
        Damping::Mass(factor) => {
            for (new, old) in predicted.iter_mut().zip(own) {
                *new = old * factor;
            }
            (1.0 - factor * factor) * kinetic_energy(kick)
        }
    }
}

/// Adds dt·a of a free block, theory Eq. (3).
fn push_free(kick: &Kick, centre: Point, force: &[Vector], predicted: &mut [Vector]) {
    let metric = kick.metric;
    let share = metric.inverse_total[kick.block];
    let total: Vector = force.iter().sum();
    let (mut torque, mut mean) = (0.0, Vector::zeros());
    for (k, i) in kick.covers.clone().enumerate() {
        torque += (kick.place(i) - centre).perp(&force[k]);
        let own = (force[k] - total * (metric.inertial[i] * share)) / metric.mass[i];
        mean += own * (metric.inertial[i] * share);
    }
    let common = total * share - mean + kick.acceleration;
    let spin = metric.spin[kick.block] * torque;
    for (k, i) in kick.covers.clone().enumerate() {
        let own = (force[k] - total * (metric.inertial[i] * share)) / metric.mass[i];
        predicted[k] += (own + common + turned(kick.place(i) - centre) * spin) * kick.dt;
    }
}
