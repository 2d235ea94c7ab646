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
    /// Velocity relative to the block's rigid motion is multiplied by the factor (Eq. 11).
    Deformation(f64),
    /// The whole velocity is multiplied by the factor (Eq. 12).
    Mass(f64),
}

/// Where a block is.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BlockMotion {
    /// Centroid (m).
    pub centre: Point,
    /// C = (J_D/J − 1)/J_D' of a free block, J_D' being J_D at the current places; 0 of a held one.
    pub spin: f64,
}

/// A velocity field of a block, split into its rigid part and sums over the rest.
struct Sums {
    velocity: Vector,
    linear: Vector,
    moment: f64,
    /// Polar inertia of the lumped masses about their own centroid at the current places (kg·m²/m).
    polar: f64,
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

    /// Rigid velocity of a field and the sums of what is left (Eq. 5).
    fn sums(&self, field: &[Vector], centre: Point) -> Sums {
        let metric = self.metric;
        let total = metric.total[self.block];
        let velocity = self.covers.clone().map(|i| field[i] * metric.inertial[i]).sum::<Vector>() / total;
        let (mut moment, mut polar, mut first, mut linear) = (0.0, 0.0, Vector::zeros(), Vector::zeros());
        for i in self.covers.clone() {
            let (m, d, u) = (metric.mass[i], self.place(i) - centre, field[i] - velocity);
            first += d * m;
            linear += u * m;
            moment += m * d.perp(&u);
            polar += m * d.norm_squared();
        }
        moment -= first.perp(&linear) / total;
        polar -= first.norm_squared() / total;
        Sums { velocity, linear, moment, polar }
    }

    /// C at the current places: C·J_D' is constant, so that J·L/J_D keeps to round-off in every kick and drift.
    fn correction(&self, centre: Point) -> f64 {
        let (metric, block) = (self.metric, self.block);
        let (mut first, mut polar) = (Vector::zeros(), 0.0);
        for i in self.covers.clone() {
            let d = self.place(i) - centre;
            first += d * metric.mass[i];
            polar += metric.mass[i] * d.norm_squared();
        }
        polar -= first.norm_squared() / metric.total[block];
        (metric.polar_lumped[block] / metric.polar[block] - 1.0) / polar
    }

    /// Σm(a−va)·(b−vb) of two fields less their mean: the part of their product that is not translation.
    fn product(&self, a: &[Vector], b: &[Vector], of: &Sums, with: &Sums) -> f64 {
        let sum: f64 =
            self.covers.clone().map(|i| self.metric.mass[i] * (a[i] - of.velocity).dot(&(b[i] - with.velocity))).sum();
        sum - of.linear.dot(&with.linear) / self.metric.total[self.block]
    }

    fn spin(&self, sums: &Sums) -> f64 {
        sums.moment / self.metric.polar_lumped[self.block]
    }
}

/// Kinetic energy (J/m) of a block in its metric (Eq. 5).
pub fn kinetic_energy(kick: &Kick) -> f64 {
    let (metric, block) = (kick.metric, kick.block);
    let sums = kick.sums(kick.velocity, kick.centre());
    let (polar, lumped) = (metric.polar[block], metric.polar_lumped[block]);
    0.5 * metric.rigid_mass(block) * sums.velocity.norm_squared()
        + 0.5 * kick.product(kick.velocity, kick.velocity, &sums, &sums)
        + 0.5 * (polar - lumped) / (lumped * sums.polar) * sums.moment * sums.moment
}

/// Work (J/m) that damping took in a step that ended with velocities `after`: the lost momentum times the mean of the
/// velocities before and after (Eq. 18).
pub fn damping_work(kick: &Kick, after: &[Vector]) -> f64 {
    let (factor, whole) = match kick.damping {
        Damping::Deformation(factor) => (factor, 0.0),
        Damping::Mass(factor) => (factor, 1.0),
    };
    if factor >= 1.0 {
        return 0.0;
    }
    let (metric, block, centre) = (kick.metric, kick.block, kick.centre());
    let [old, new] = [kick.velocity, after].map(|field| kick.sums(field, centre));
    let turning = |with: &Sums| old.moment * with.moment / old.polar;
    let share = metric.polar[block] / metric.polar_lumped[block];
    let rigid = |with: &Sums| metric.rigid_mass(block) * old.velocity.dot(&with.velocity) + share * turning(with);
    let deforming = |field: &[Vector], with: &Sums| kick.product(kick.velocity, field, &old, with) - turning(with);
    let both = deforming(kick.velocity, &old) + deforming(after, &new) + whole * (rigid(&old) + rigid(&new));
    0.5 * (1.0 - factor) * both
}

/// Rigid motion of a block in its metric: centroid (m), its velocity (m/s) and the spin (rad/s).
pub fn rigid_motion(kick: &Kick) -> (Point, Vector, f64) {
    let centre = kick.centre();
    let sums = kick.sums(kick.velocity, centre);
    (centre, sums.velocity, kick.spin(&sums))
}

/// Writes the velocity (m/s) of a block's covers that is a translation (m/s) plus a spin (rad/s) about the centroid.
pub fn rigid_velocity(kick: &Kick, velocity: Vector, spin: f64, out: &mut [Vector]) {
    let centre = kick.centre();
    for (k, i) in kick.covers.clone().enumerate() {
        out[k] = velocity + turned(kick.place(i) - centre) * spin;
    }
}

/// Damps the block's velocity and kicks it by `force` (N/m, this block's covers only); writes the `damped` and the
/// `predicted` velocities (Eqs. 3, 10–12).
pub fn kick(kick: &Kick, force: &[Vector], predicted: &mut [Vector], damped: &mut [Vector]) -> BlockMotion {
    let centre = kick.centre();
    damp(kick, centre, predicted);
    damped.copy_from_slice(predicted);
    let mut spin = 0.0;
    if kick.metric.is_free(kick.block) {
        spin = kick.correction(centre);
        push_free(kick, centre, spin, force, predicted);
    } else {
        for (k, i) in kick.covers.clone().enumerate() {
            let force = force[k] + kick.acceleration * kick.metric.row_sum[i];
            predicted[k] += force.component_mul(&kick.metric.inverse[i]) * kick.dt;
        }
    }
    BlockMotion { centre, spin }
}

fn damp(kick: &Kick, centre: Point, predicted: &mut [Vector]) {
    let own = &kick.velocity[kick.covers.clone()];
    match kick.damping {
        Damping::Deformation(factor) if factor < 1.0 => {
            let sums = kick.sums(kick.velocity, centre);
            let spin = sums.moment / sums.polar;
            for (k, i) in kick.covers.clone().enumerate() {
                let rigid = sums.velocity + turned(kick.place(i) - centre) * spin;
                let held = kick.metric.inverse[i].map(|v| f64::from(u8::from(v > 0.0)));
                predicted[k] = (rigid + (own[k] - rigid) * factor).component_mul(&held);
            }
        }
        Damping::Deformation(_) => predicted.copy_from_slice(own),
        Damping::Mass(factor) => {
            for (new, old) in predicted.iter_mut().zip(own) {
                *new = old * factor;
            }
        }
    }
}

/// Adds dt·a of a free block (Eq. 3).
fn push_free(kick: &Kick, centre: Point, spin: f64, force: &[Vector], predicted: &mut [Vector]) {
    let metric = kick.metric;
    let share = metric.inverse_total[kick.block];
    let total: Vector = force.iter().sum();
    let (mut torque, mut mean) = (0.0, Vector::zeros());
    for (k, i) in kick.covers.clone().enumerate() {
        torque += (kick.place(i) - centre).perp(&force[k]);
        let own = (force[k] - total * (metric.inertial[i] * share)) / metric.mass[i];
        mean += own * (metric.inertial[i] * share);
    }
    let common = (total * share + kick.acceleration) * metric.lightness - mean;
    let spin = spin * torque;
    for (k, i) in kick.covers.clone().enumerate() {
        let own = (force[k] - total * (metric.inertial[i] * share)) / metric.mass[i];
        predicted[k] += (own + common + turned(kick.place(i) - centre) * spin) * kick.dt;
    }
}
