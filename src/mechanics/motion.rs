//! Motion of one block: rigid velocity, damping, kinetic energy and momentum by its mass matrix.

use crate::cover::BlockId;
use crate::geometry::{Point, Vector};

use super::MassMatrix;
use super::block_lanes::{BlockSums, Reference, RigidVelocity, WorkSums};

/// J90·v: turned by +90°.
pub(super) fn turned(v: Vector) -> Vector {
    Vector::new(-v.y, v.x)
}

/// How velocities decay in a step.
#[doc(alias = "dynamic relaxation")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    /// Velocity relative to the block's rigid motion is multiplied by the factor (Eq. 11).
    Deformation(f64),
    /// The whole velocity is multiplied by the factor (Eq. 12).
    Mass(f64),
}

/// Current centroid of a block and its inertia correction.
#[doc(alias = "rigid body")]
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BlockMotion {
    /// Centroid (m).
    pub centre: Point,
    /// C = (J_D/J − 1)/J_D' of a free block, J_D' being J_D at the current positions; 0 of a fixed one.
    pub spin: f64,
}

/// A velocity field of a block, split into its rigid part and sums over the rest.
pub(super) struct Sums {
    pub velocity: Vector,
    linear: Vector,
    pub moment: f64,
    /// Half the rate at which the polar inertia grows (kg·m²/(m·s)).
    pub radial: f64,
    /// Polar inertia of the lumped masses about their own centroid at the current positions (kg·m²/m).
    pub polar: f64,
}

/// One block's slices of the cover arrays and its index in the mass matrix.
pub struct BlockCovers<'a> {
    /// Masses of all covers and blocks.
    pub mass_matrix: &'a MassMatrix,
    /// Block.
    pub block: BlockId,
    /// Covers of the block in the arrays of the metric.
    pub range: std::ops::Range<usize>,
    /// Star positions (m), all covers.
    pub star: &'a [Point],
    /// Displacements (m), all covers.
    pub displacement: &'a [Vector],
    /// Velocities before the step (m/s), all covers.
    pub velocity: &'a [Vector],
}

impl BlockCovers<'_> {
    fn position(&self, i: usize) -> Point {
        self.star[i] + self.displacement[i]
    }

    /// Centroid of the block in its metric.
    pub(super) fn centre(&self) -> Point {
        let first: Point = self.range.clone().map(|i| self.position(i) * self.mass_matrix.inertial[i]).sum();
        first / self.mass_matrix.total[self.block]
    }

    /// Rigid velocity of a field and the sums over the rest (Eq. 5).
    pub(super) fn sums(&self, field: &[Vector], centre: Point) -> Sums {
        let mass_matrix = self.mass_matrix;
        let total = mass_matrix.total[self.block];
        let velocity = self.range.clone().map(|i| field[i] * mass_matrix.inertial[i]).sum::<Vector>() / total;
        let (mut moment, mut radial, mut polar) = (0.0, 0.0, 0.0);
        let (mut first, mut linear) = (Vector::zeros(), Vector::zeros());
        for i in self.range.clone() {
            let (m, d, u) = (mass_matrix.mass[i], self.position(i) - centre, field[i] - velocity);
            first += d * m;
            linear += u * m;
            moment += m * d.perp(&u);
            radial += m * d.dot(&u);
            polar += m * d.norm_squared();
        }
        moment -= first.perp(&linear) / total;
        radial -= first.dot(&linear) / total;
        polar -= first.norm_squared() / total;
        Sums { velocity, linear, moment, radial, polar }
    }

    /// Σm(a−va)·(b−vb) of two fields less their mean: the part of their product that is not translation.
    pub(super) fn product(&self, a: &[Vector], b: &[Vector], of: &Sums, with: &Sums) -> f64 {
        let sum: f64 = self
            .range
            .clone()
            .map(|i| self.mass_matrix.mass[i] * (a[i] - of.velocity).dot(&(b[i] - with.velocity)))
            .sum();
        sum - of.linear.dot(&with.linear) / self.mass_matrix.total[self.block]
    }

    fn spin(&self, sums: &Sums) -> f64 {
        sums.moment / self.mass_matrix.polar_lumped[self.block]
    }
}

/// Kinetic energy (J/m) of a block in its metric (Eq. 5).
pub fn kinetic_energy(covers: &BlockCovers) -> f64 {
    energy_of(covers, &covers.sums(covers.velocity, covers.centre()))
}

fn energy_of(covers: &BlockCovers, sums: &Sums) -> f64 {
    let (mass_matrix, block) = (covers.mass_matrix, covers.block);
    let (polar, lumped) = (mass_matrix.polar[block], mass_matrix.polar_lumped[block]);
    0.5 * mass_matrix.rigid_mass(block) * sums.velocity.norm_squared()
        + 0.5 * covers.product(covers.velocity, covers.velocity, sums, sums)
        + 0.5 * (polar - lumped) / (lumped * sums.polar) * sums.moment * sums.moment
}

/// Rigid motion of a block in its metric: centroid (m), its velocity (m/s) and the spin (rad/s).
pub fn rigid_motion(covers: &BlockCovers) -> (Point, Vector, f64) {
    let centre = covers.centre();
    let sums = covers.sums(covers.velocity, centre);
    (centre, sums.velocity, covers.spin(&sums))
}

/// The rigid motion of a block with its kinetic energy (J/m).
pub fn motion_with_energy(covers: &BlockCovers) -> ((Point, Vector, f64), f64) {
    let centre = covers.centre();
    let sums = covers.sums(covers.velocity, centre);
    ((centre, sums.velocity, covers.spin(&sums)), energy_of(covers, &sums))
}

/// Angular velocity (rad/s) with which a step turns a block: 0 of a fixed one.
pub fn turning(covers: &BlockCovers) -> f64 {
    if !covers.mass_matrix.is_free(covers.block) {
        return 0.0;
    }
    let sums = covers.sums(covers.velocity, covers.centre());
    sums.moment / sums.polar
}

/// Writes the velocity (m/s) of a block's covers that is a translation (m/s) plus a spin (rad/s) about the centroid.
pub fn rigid_velocity(covers: &BlockCovers, velocity: Vector, spin: f64, out: &mut [Vector]) {
    let centre = covers.centre();
    for (k, i) in covers.range.clone().enumerate() {
        out[k] = velocity + turned(covers.position(i) - centre) * spin;
    }
}

/// Writes the velocities (m/s) after damping (Eqs. 11, 12).
pub fn damp(covers: &BlockCovers, damping: Damping, damped: &mut [Vector]) {
    let own = &covers.velocity[covers.range.clone()];
    match damping {
        Damping::Deformation(factor) if factor < 1.0 => {
            let centre = covers.centre();
            let sums = covers.sums(covers.velocity, centre);
            let spin = sums.moment / sums.polar;
            for (k, i) in covers.range.clone().enumerate() {
                let rigid = sums.velocity + turned(covers.position(i) - centre) * spin;
                let held = covers.mass_matrix.inverse[i].map(|v| f64::from(u8::from(v > 0.0)));
                damped[k] = (rigid + (own[k] - rigid) * factor).component_mul(&held);
            }
        }
        Damping::Deformation(_) => damped.copy_from_slice(own),
        Damping::Mass(factor) => {
            for (new, old) in damped.iter_mut().zip(own) {
                *new = old * factor;
            }
        }
    }
}

/// Rigid motion of a block at the start of a step; positions and velocities are relative to a reference.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BlockStart {
    /// Reference of the other fields.
    pub from: Reference,
    /// Centroid (m).
    centre: Vector,
    /// Velocity of the centroid (m/s).
    velocity: Vector,
    /// Σmq (kg).
    first: Vector,
    /// Σmw (kg/s).
    momentum: Vector,
    /// Moment of momentum (kg·m/s) and polar inertia (kg·m) of the lumped masses about their own centroid.
    moment: f64,
    polar: f64,
}

impl BlockStart {
    /// The start of a block from its sums.
    pub fn new(mass_matrix: &MassMatrix, block: BlockId, from: Reference, sums: &BlockSums) -> Self {
        let total = mass_matrix.total[block];
        Self {
            from,
            centre: sums.inertial_place / total,
            velocity: sums.inertial_velocity / total,
            first: sums.first,
            momentum: sums.momentum,
            moment: sums.moment - sums.first.perp(&sums.momentum) / total,
            polar: sums.polar - sums.first.norm_squared() / total,
        }
    }

    /// Angular velocity (rad/s).
    pub fn spin(&self) -> f64 {
        self.moment / self.polar
    }

    /// Centroid and inertia correction for contacts: C·J_D' is constant, so that J·L/J_D is kept to round-off in every
    /// kick and drift.
    pub fn motion(&self, mass_matrix: &MassMatrix, block: BlockId) -> BlockMotion {
        let centre = self.from.position + self.centre;
        if !mass_matrix.is_free(block) {
            return BlockMotion { centre, spin: 0.0 };
        }
        BlockMotion { centre, spin: (mass_matrix.polar_lumped[block] / mass_matrix.polar[block] - 1.0) / self.polar }
    }

    /// Common velocity that damping and the forces on a block give to all its covers (Eqs. 3, 11, 83).
    pub fn common(&self, mass_matrix: &MassMatrix, block: BlockId, sums: &BlockSums, step: &KickStep) -> RigidVelocity {
        let mut common = RigidVelocity::default();
        if let Damping::Deformation(factor) = step.damping
            && factor < 1.0
        {
            let share = 1.0 - factor;
            let rigid = self.from.velocity + self.velocity;
            common = RigidVelocity::about(rigid * share, self.spin() * share, self.centre);
        }
        if mass_matrix.is_free(block) {
            let share = mass_matrix.inverse_total[block];
            let torque = sums.torque - self.centre.perp(&sums.force);
            let mean = (sums.weighted - sums.force * (mass_matrix.square[block] * share)) * share;
            let pushed = sums.force * share - mean + step.acceleration * mass_matrix.lightness;
            let spin = self.motion(mass_matrix, block).spin * torque;
            let by_force = RigidVelocity::about(pushed * step.kick, spin * step.kick, self.centre);
            common.velocity += by_force.velocity;
            common.spin += by_force.spin;
            common.weighted = sums.force * (-share * step.kick);
            let own = mass_matrix.polar[block] / mass_matrix.polar_lumped[block];
            common.widening = own * self.spin().powi(2) * step.kick;
            common.velocity -= self.centre * common.widening;
        }
        common
    }

    /// Work (J/m) that damping took in the step: the lost momentum times the mean of the velocities before and after
    /// it (Eq. 18).
    pub fn damping_work(&self, mass_matrix: &MassMatrix, block: BlockId, sums: &WorkSums, damping: Damping) -> f64 {
        let (factor, whole) = match damping {
            Damping::Deformation(factor) => (factor, 0.0),
            Damping::Mass(factor) => (factor, 1.0),
        };
        let total = mass_matrix.total[block];
        let moment = sums.moment - self.first.perp(&sums.momentum) / total;
        let turning = self.moment * moment / self.polar;
        let deforming = sums.product - self.momentum.dot(&sums.momentum) / total - turning;
        let own = self.from.velocity + self.velocity;
        let both = self.from.velocity * 2.0 + sums.inertial / total;
        let share = mass_matrix.polar[block] / mass_matrix.polar_lumped[block];
        let rigid = mass_matrix.rigid_mass(block) * own.dot(&both) + share * turning;
        0.5 * (1.0 - factor) * (deforming + whole * rigid)
    }
}

/// Values of a kick that are the same for every block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KickStep {
    /// Gravity and body loads (m/s²).
    pub acceleration: Vector,
    /// Damping; that of deformation is the block's own.
    pub damping: Damping,
    /// Time (s) for which forces act.
    pub kick: f64,
}
