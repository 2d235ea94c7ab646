//! One contact between a boundary node and an edge: its data in a step (`VertexEdge`) and between steps
//! (`ContactHistory`). The narrow phase makes it, the solver finds its forces.

use crate::geometry::{Point, Vector};

use super::{Closure, EdgeId, LawId, Limits, NodeId, Pair, SideId};

/// State of a contact at the end of a step.
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

/// Data of a contact that pass from step to step, identified by node and side.
#[doc(alias = "warm start")]
#[doc(alias = "contact memory")]
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ContactHistory {
    /// Boundary node that may enter.
    pub node: NodeId,
    /// Side of the other block (or of a partial cut) that it may enter.
    pub side: SideId,
    /// Edge of that side in the last step.
    pub edge: EdgeId,
    /// Normal force at the end of the last step (N/m), compression positive.
    pub normal_force: f64,
    /// Shear force at the end of the last step (N/m), on the node along the edge.
    pub shear_force: f64,
    /// Change of both forces in the last step (N/m).
    pub trend: [f64; 2],
    /// Elastic shear of the spring (m), independent of the length of the contact.
    pub sheared: f64,
    /// Initial penetration without force (m); it fades.
    pub offset: f64,
    /// Closure without force: from pre-stress and dilation (m).
    pub rest: f64,
    /// Accumulated slip (m).
    pub slip: f64,
    /// Share of the strength in the last step, by the overlap at the ends of the side.
    pub share: f64,
    /// Open, slip or lock.
    pub state: ContactState,
    /// Whether the joint has its peak strength.
    pub intact: bool,
}

/// A contact during one step: geometry, springs and forces.
#[doc(alias = "contact")]
#[doc(alias = "corner-edge contact")]
#[doc(alias = "contact constraint")]
#[derive(Debug, Clone, Copy, Default)]
pub struct VertexEdge {
    /// The node and the position on the edge that it faces.
    pub pair: Pair,
    /// Position of the node.
    pub point: Point,
    /// Outward unit normal of the edge.
    pub normal: Vector,
    /// Limits of the joint law for this length.
    pub limits: Limits,
    /// Greatest closure of the normal spring (m); infinite for a linear one.
    pub closure_max: f64,
    /// Data that pass to the next step; the sweeps update the forces.
    pub history: ContactHistory,
    /// Springs normal (initial stiffness) and shear (N/m per metre).
    pub stiffness: [f64; 2],
    /// Gap of the springs along the normal (m); negative in penetration.
    pub gap: f64,
    /// Tributary length (m).
    pub length: f64,
    /// Law of the joint.
    pub law: LawId,
    /// Whether the contact failed in tension in this step.
    pub torn: bool,
    /// Whether the contact is new in this step.
    pub fresh: bool,
}

// Large slopes have a million of them and more.
const _: () = assert!(size_of::<VertexEdge>() <= 288);

/// Share of the last change of the forces that the warm start adds: with 0.7 or more, contacts at rest oscillate.
const EXPECTED: f64 = 0.5;

impl VertexEdge {
    /// Unit tangent of the edge.
    #[inline(always)]
    pub fn tangent(&self) -> Vector {
        Vector::new(-self.normal.y, self.normal.x)
    }

    /// Whether the normal spring follows a curve.
    #[inline(always)]
    pub fn closes_on_a_curve(&self) -> bool {
        self.closure_max.is_finite()
    }

    /// Whether spring or strength follow a curve.
    #[inline(always)]
    pub fn is_curved(&self) -> bool {
        self.closes_on_a_curve() || self.limits.is_curved()
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

    /// Penetration of the node (m): that of the springs plus the initial offset.
    #[inline(always)]
    pub fn penetration(&self) -> f64 {
        self.loaded_penetration() + self.history.offset
    }

    /// Penetration (m) that the springs resist: without the initial offset.
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

    /// Warm start: a contact that stays closed begins with its last force plus half of its last change, within its
    /// limit.
    #[inline(always)]
    pub fn expected(&self) -> [f64; 2] {
        let ContactHistory { normal_force, shear_force, trend, .. } = self.history;
        let normal = normal_force + EXPECTED * trend[0];
        if normal > 0.0 && normal_force > trend[0].max(0.0) {
            let limit = self.shear_limit(normal);
            return [normal, (shear_force + EXPECTED * trend[1]).min(limit).max(-limit)];
        }
        [normal_force, shear_force]
    }

    /// Stores the forces (N/m) at the end of an explicit step, as [`Self::bear`] does, and their change.
    #[inline(always)]
    pub fn end(&mut self, forces: [f64; 2], bears: bool, torn: bool) {
        let ContactHistory { normal_force, shear_force, .. } = self.history;
        self.bear(forces, bears, torn);
        self.history.trend = [self.history.normal_force - normal_force, self.history.shear_force - shear_force];
    }

    /// Stores the forces (N/m) of the joint, which are 0 unless it `bears`; `torn` after a failure in tension. No
    /// branch depends on their values, which are hard to predict.
    #[inline(always)]
    pub fn bear(&mut self, [normal, shear]: [f64; 2], bears: bool, torn: bool) {
        let slips = shear.abs() >= self.shear_limit(normal);
        let states = [ContactState::Open, ContactState::Open, ContactState::Lock, ContactState::Slip];
        self.history.state = states[2 * usize::from(bears) + usize::from(slips)];
        // The sum turns a zero from below into zero.
        (self.history.normal_force, self.history.shear_force) = (normal + 0.0, shear + 0.0);
        self.torn = torn;
    }

    /// Clamps the forces of the springs to the limits of the joint.
    #[inline(always)]
    pub fn decide(&mut self, normal: f64, shear: f64) {
        let torn = normal < -self.limits.tension();
        let bears = !torn && (normal > 0.0 || self.limits.tension() > 0.0);
        let limit = self.shear_limit(normal);
        let force = if bears { [normal, shear.clamp(-limit, limit)] } else { [0.0; 2] };
        self.bear(force, bears, torn);
    }
}
