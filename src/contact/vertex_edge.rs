//! One contact between a boundary node and the edge that it may enter.

use crate::geometry::Vector;

use super::{Closure, Limits, Pair};

/// What a contact does at the end of a step.
#[doc(alias = "sliding")]
#[doc(alias = "locked")]
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum ContactState {
    /// No force.
    #[default]
    Open,
    /// Shear at the limit.
    Slip,
    /// Shear below the limit.
    Lock,
}

/// What a contact remembers from step to step; identified by node and side.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ContactHistory {
    /// Boundary node that may enter.
    pub node: u32,
    /// Side of the other block (or of a partial cut) that it may enter.
    pub side: u32,
    /// Edge of that side in the last step.
    pub edge: u32,
    /// Normal force at the end of the last step (N/m), compression positive.
    pub normal_force: f64,
    /// Shear force at the end of the last step (N/m), on the node along the edge.
    pub shear_force: f64,
    /// How both forces have changed in the last step (N/m).
    pub trend: [f64; 2],
    /// Shear force that the spring has stored (N/m).
    pub shear_stored: f64,
    /// Penetration at first sight that carries no force (m); it fades.
    pub offset: f64,
    /// Closure that is at rest: from pre-stress and dilation (m).
    pub rest: f64,
    /// Accumulated slip (m).
    pub slip: f64,
    /// Open, slip or lock.
    pub state: ContactState,
    /// Whether the joint has its peak strength.
    pub intact: bool,
}

/// A contact during one step: geometry, compliance and forces.
#[derive(Debug, Clone, Copy, Default)]
pub struct VertexEdge {
    /// What it remembers; forces are updated by the sweeps.
    pub history: ContactHistory,
    /// The node and the place on the edge that it faces.
    pub pair: Pair,
    /// Outward unit normal of the edge.
    pub normal: Vector,
    /// Gap along the normal that the springs see (m); negative in penetration.
    pub gap: f64,
    /// Penetration of the node (m), with no allowance.
    pub penetration: f64,
    /// Tributary length (m).
    pub length: f64,
    /// Springs normal (initial stiffness) and shear (N/m per metre).
    pub stiffness: [f64; 2],
    /// Greatest closure of the normal spring (m); infinite for a linear one.
    pub closure_max: f64,
    /// Inverse effective masses normal and shear (m/kg).
    pub compliance: [f64; 2],
    /// Limits of the joint law for this length.
    pub limits: Limits,
    /// Law of the joint.
    pub law: u32,
    /// Predicted relative velocity normal and shear without contact forces (m/s).
    pub approach: [f64; 2],
    /// Share of the step's motion, normal and shear, that the springs feel ahead: θ, or that of a joint's own spring.
    pub forward: [f64; 2],
    /// Motion (m) normal and shear that is added to what the springs feel: minus a share of that of the last step.
    pub lag: [f64; 2],
    /// Whether the normal force asked for more tension than the joint has.
    pub torn: bool,
    /// Whether the contact is seen for the first time.
    pub fresh: bool,
}

impl VertexEdge {
    /// Unit tangent of the edge.
    #[inline(always)]
    pub fn tangent(&self) -> Vector {
        Vector::new(-self.normal.y, self.normal.x)
    }
}

/// Share of their last change by which forces are expected to change again: from 0.7 on resting contacts swing.
const EXPECTED: f64 = 0.5;
/// β of the centred spring of a joint's own stiffness: the least that is stable at any step.
const CENTRED: f64 = 0.25;

impl VertexEdge {
    /// Centres the springs whose stiffness is a `physical` property of the joint (Eqs. 52, 53).
    ///
    /// The force belongs to the time at which it acts, so that a spring that the step resolves keeps its energy; a
    /// stiffer one gets a dashpot that grows towards that of θ. The step is `dt` and the force acts for `kick` (s);
    /// `last` is the motion (m) normal and shear in the last step, and `damping` 2ξ·√M of the two blocks against each
    /// other (kg½/m½): what a spring takes of their bouncing.
    pub fn centre(&mut self, physical: [bool; 2], dt: f64, kick: f64, last: [f64; 2], damping: f64) {
        for k in (0..2).filter(|k| physical[*k]) {
            let stiff = self.stiffness[k] * self.compliance[k] * dt * kick;
            let dashpot = if stiff > 1.0 { self.forward[k] * (1.0 - 1.0 / stiff) } else { 0.0 };
            self.forward[k] = CENTRED + dashpot + damping / (self.stiffness[k].sqrt() * dt);
            self.lag[k] = -CENTRED * last[k];
        }
    }

    /// The normal spring.
    pub fn closure(&self) -> Closure {
        Closure { stiffness: self.stiffness[0], most: self.closure_max }
    }

    /// Energy (J/m) that the springs store at the step's start.
    pub fn stored_energy(&self) -> f64 {
        let closure = if self.gap < 0.0 || self.history.state != ContactState::Open { -self.gap } else { 0.0 };
        self.closure().energy(closure) + 0.5 * self.history.shear_stored.powi(2) / self.stiffness[1]
    }

    /// Penetration (m) that the springs resist: without what was there at first sight.
    #[inline(always)]
    pub fn loaded_penetration(&self) -> f64 {
        self.penetration - self.history.offset
    }

    /// Normal and shear component of a cover field at the node relative to the edge.
    #[inline(always)]
    pub fn relative(&self, field: &[Vector]) -> [f64; 2] {
        let relative = self.pair.difference(field);
        [relative.dot(&self.normal), relative.dot(&self.tangent())]
    }

    /// Shear force (N/m) that the spring stores after moving by `shear` (m), and the slip (m) (Eq. 15).
    #[inline(always)]
    pub fn shear_after(&self, shear: f64) -> (f64, f64) {
        if self.history.state == ContactState::Open {
            return (0.0, 0.0);
        }
        let limit = self.limits.shear(self.history.normal_force);
        let trial = self.history.shear_stored - self.stiffness[1] * shear;
        let stored = trial.clamp(-limit, limit);
        (stored, (trial - stored).abs() / self.stiffness[1])
    }

    /// Forces (N/m), normal and shear, that a step starts from: a contact that stays closed goes on half as it has
    /// changed, within its limit.
    #[inline(always)]
    pub fn expected(&self) -> [f64; 2] {
        let ContactHistory { normal_force, shear_force, trend, .. } = self.history;
        let normal = normal_force + EXPECTED * trend[0];
        if normal <= 0.0 || normal_force <= trend[0].max(0.0) {
            return [normal_force, shear_force];
        }
        let limit = self.limits.shear(normal);
        [normal, (shear_force + EXPECTED * trend[1]).min(limit).max(-limit)]
    }

    /// Takes the forces (N/m) at the end of an explicit step, as [`Self::bear`] does, and notes how they have changed.
    #[inline(always)]
    pub fn end(&mut self, forces: [f64; 2], bears: bool, torn: bool) {
        let ContactHistory { normal_force, shear_force, .. } = self.history;
        self.bear(forces, bears, torn);
        self.history.trend = [self.history.normal_force - normal_force, self.history.shear_force - shear_force];
    }

    /// Takes forces (N/m) that the joint carries, none unless it `bears`; `torn` when it was asked for more tension
    /// than it has. No branch depends on what they are: that is hard to foresee.
    #[inline(always)]
    pub fn bear(&mut self, [normal, shear]: [f64; 2], bears: bool, torn: bool) {
        let slips = shear.abs() >= self.limits.shear(normal);
        let states = [ContactState::Open, ContactState::Open, ContactState::Lock, ContactState::Slip];
        self.history.state = states[2 * usize::from(bears) + usize::from(slips)];
        // The sum turns a zero from below into zero.
        (self.history.normal_force, self.history.shear_force) = (normal + 0.0, shear + 0.0);
        self.torn = torn;
    }

    /// Clamps the forces that the springs ask for to what the joint can carry.
    #[inline(always)]
    pub fn decide(&mut self, normal: f64, shear: f64) {
        let torn = normal < -self.limits.tension;
        let bears = !torn && (normal > 0.0 || self.limits.tension > 0.0);
        let limit = self.limits.shear(normal);
        let force = if bears { [normal, shear.clamp(-limit, limit)] } else { [0.0; 2] };
        self.bear(force, bears, torn);
    }
}
