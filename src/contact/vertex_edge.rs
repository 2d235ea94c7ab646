//! One contact between a boundary node and the edge that it may enter.

use crate::geometry::Vector;

use super::{Closure, Limits, Pair, SoftSpring};

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
#[doc(alias = "warm start")]
#[doc(alias = "contact memory")]
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
    /// Elastic shear of the spring (m): what it has stored, whatever length the contact will have.
    pub sheared: f64,
    /// Penetration at first sight that carries no force (m); it fades.
    pub offset: f64,
    /// Closure that is at rest: from pre-stress and dilation (m).
    pub rest: f64,
    /// Accumulated slip (m).
    pub slip: f64,
    /// Share of its strength that the overlap at the ends of the side gave it in the last step.
    pub share: f64,
    /// Open, slip or lock.
    pub state: ContactState,
    /// Whether the joint has its peak strength.
    pub intact: bool,
}

/// A contact during one step: geometry, how it answers, and forces. What the sweeps read comes first.
#[doc(alias = "contact")]
#[doc(alias = "corner-edge contact")]
#[doc(alias = "contact constraint")]
#[derive(Debug, Clone, Copy, Default)]
#[repr(C, align(64))]
pub struct VertexEdge {
    /// The node and the position on the edge that it faces.
    pub pair: Pair,
    /// Outward unit normal of the edge.
    pub normal: Vector,
    /// How the springs normal and shear answer in an explicit step.
    pub answers: [SoftSpring; 2],
    /// Forces (N/m), normal and shear, that an explicit step starts from.
    pub expected: [f64; 2],
    /// Limits of the joint law for this length.
    pub limits: Limits,
    /// Greatest closure of the normal spring (m); infinite for a linear one.
    pub closure_max: f64,
    /// What it remembers; forces are updated by the sweeps.
    pub history: ContactHistory,
    /// Springs normal (initial stiffness) and shear (N/m per metre).
    pub stiffness: [f64; 2],
    /// Gap along the normal that the springs see (m); negative in penetration.
    pub gap: f64,
    /// Tributary length (m).
    pub length: f64,
    /// Law of the joint.
    pub law: u32,
    /// Whether the normal force asked for more tension than the joint has.
    pub torn: bool,
    /// Whether the contact is seen for the first time.
    pub fresh: bool,
}

// Six lines of the cache; sweeps read four.
const _: () = assert!(size_of::<VertexEdge>() == 384 && std::mem::offset_of!(VertexEdge, history) == 256);

impl VertexEdge {
    /// Unit tangent of the edge.
    #[inline(always)]
    pub fn tangent(&self) -> Vector {
        Vector::new(-self.normal.y, self.normal.x)
    }
}

/// Share of their last change by which forces are expected to change again: from 0.7 on resting contacts swing.
const EXPECTED: f64 = 0.5;

impl VertexEdge {
    /// Whether the normal spring follows a curve.
    #[inline(always)]
    pub fn closes_on_a_curve(&self) -> bool {
        self.closure_max.is_finite()
    }

    /// Whether spring or strength follow a curve.
    #[inline(always)]
    pub fn is_curved(&self) -> bool {
        self.closes_on_a_curve() || matches!(self.limits, Limits::BartonBandis { .. })
    }

    /// Greatest shear force (N/m) under a normal force (N/m, compression positive).
    #[inline(always)]
    pub fn shear_limit(&self, normal: f64) -> f64 {
        self.limits.shear(normal, self.length)
    }

    /// The normal spring.
    pub fn closure(&self) -> Closure {
        Closure { stiffness: self.stiffness[0], most: self.closure_max }
    }

    /// Energy (J/m) that the springs store at the step's start.
    pub fn stored_energy(&self) -> f64 {
        let closure = if self.gap < 0.0 || self.history.state != ContactState::Open { -self.gap } else { 0.0 };
        self.closure().energy(closure) + 0.5 * self.stiffness[1] * self.history.sheared.powi(2)
    }

    /// Shear force (N/m) that the spring has stored.
    #[inline(always)]
    pub fn shear_stored(&self) -> f64 {
        self.stiffness[1] * self.history.sheared
    }

    /// Penetration of the node (m), with no allowance.
    #[inline(always)]
    pub fn penetration(&self) -> f64 {
        self.loaded_penetration() + self.history.offset
    }

    /// Penetration (m) that the springs resist: without what was there at first sight.
    #[inline(always)]
    pub fn loaded_penetration(&self) -> f64 {
        -self.gap - self.history.rest
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
        let limit = self.shear_limit(self.history.normal_force);
        let trial = self.shear_stored() - self.stiffness[1] * shear;
        let stored = trial.clamp(-limit, limit);
        (stored, (trial - stored).abs() / self.stiffness[1])
    }

    /// Expects forces: a contact that stays closed goes on half as it has changed, within its limit.
    #[inline(always)]
    pub fn expect(&mut self) {
        let ContactHistory { normal_force, shear_force, trend, .. } = self.history;
        let normal = normal_force + EXPECTED * trend[0];
        self.expected = [normal_force, shear_force];
        if normal > 0.0 && normal_force > trend[0].max(0.0) {
            let limit = self.shear_limit(normal);
            self.expected = [normal, (shear_force + EXPECTED * trend[1]).min(limit).max(-limit)];
        }
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
        let slips = shear.abs() >= self.shear_limit(normal);
        let states = [ContactState::Open, ContactState::Open, ContactState::Lock, ContactState::Slip];
        self.history.state = states[2 * usize::from(bears) + usize::from(slips)];
        // The sum turns a zero from below into zero.
        (self.history.normal_force, self.history.shear_force) = (normal + 0.0, shear + 0.0);
        self.torn = torn;
    }

    /// Clamps the forces that the springs ask for to what the joint can carry.
    #[inline(always)]
    pub fn decide(&mut self, normal: f64, shear: f64) {
        let torn = normal < -self.limits.tension();
        let bears = !torn && (normal > 0.0 || self.limits.tension() > 0.0);
        let limit = self.shear_limit(normal);
        let force = if bears { [normal, shear.clamp(-limit, limit)] } else { [0.0; 2] };
        self.bear(force, bears, torn);
    }
}
