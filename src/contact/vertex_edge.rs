//! One contact between a boundary node and an edge: its data in a step (`VertexEdge`) and between steps
//! (`ContactHistory`). The narrow phase makes it, the solver finds its forces.

use crate::cover::{self, BlockId, CoverId, Weights};
use crate::geometry::Vector;

use super::{
    Boundary, Closure, EdgeId, Frames, Hold, JointLaw, LawId, LiftLoad, Limits, NodeId, Pair, SectionId, SideId,
};

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
    /// Age and stiffness since its faces met.
    pub meeting: Meeting,
    /// Normal force at the end of the last step (N/m), compression positive.
    pub normal_force: f64,
    /// Shear force at the end of the last step (N/m), on the node along the edge.
    pub shear_force: f64,
    /// Normal force that friction feels (N/m): that of the last milliseconds (Eq. 84).
    pub filtered_normal: f64,
    /// Change of both forces in the last step (N/m), 0 of one that turned back in a static stage.
    pub trend: [f64; 2],
    /// Elastic shear of the spring (m), independent of the length of the contact.
    pub sheared: f64,
    /// Where its normal spring is unloaded.
    pub unloaded: Unloaded,
    /// Accumulated slip (m).
    pub slip: f64,
    /// Way up the asperities (m), to either side: what dilation follows (Eq. 21).
    pub way: f64,
    /// Share of the strength in the last step, by the overlap at the ends of the side.
    pub share: f64,
    /// Open, slip or lock.
    pub state: ContactState,
    /// Whether the joint has its peak strength.
    pub intact: bool,
}

/// Age and stiffness of a contact since its faces met: those of the node's block and the side.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Meeting {
    /// Time (s) since they last parted. Infinite where a static stage has held the contact.
    pub age: f32,
    /// Normal stiffness (N/m per metre) that an impact keeps; 0 without one.
    pub kept_stiffness: f32,
}

/// Where the normal spring of a contact is unloaded: both lengths count from a gap of zero.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Unloaded {
    /// Initial penetration without force (m); it fades.
    pub offset: f64,
    /// Closure without force: from pre-stress and dilation (m).
    pub rest: f64,
}

impl Unloaded {
    /// Gap (m) at which the spring is unloaded.
    pub fn gap(&self) -> f64 {
        self.rest - self.offset
    }

    /// Ends what a node at a gap (m) has left of its initial penetration: deeper than it is now it meets the spring.
    pub fn leave(&mut self, gap: f64) {
        self.offset -= (gap - self.gap()).clamp(0.0, self.offset.max(0.0));
    }
}

impl ContactHistory {
    /// Gap (m) at which the spring is unloaded; infinite where a bonded joint pulls, which no gap ends.
    pub(super) fn unloaded_gap(&self) -> f64 {
        let is_pulled = self.intact && self.normal_force < 0.0;
        if is_pulled { f64::INFINITY } else { self.unloaded.gap() }
    }
}

/// What a contact keeps of its bond from step to step, beside its history.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct BondHistory {
    /// Share of the strength that is lost.
    pub damage: f64,
    /// Tributary length at first sight, and the bonded part of it (m): a bond is as long as it was until it breaks,
    /// however its nodes move against each other.
    pub lengths: [f64; 2],
    /// Its law: that of the bonded part, where the faces of a contact lie on joints of two laws.
    pub law: LawId,
    /// The section with which it breaks; none where it breaks by itself.
    pub section: Option<SectionId>,
}

impl BondHistory {
    /// What a contact keeps of it as its past.
    pub(crate) fn past(&self) -> f64 {
        self.section.map_or(self.damage, |section| -1.0 - f64::from(section.number()))
    }
}

/// A contact during one step: geometry, springs and forces. What it shares with others, the boundary that it lies on
/// and the law of its joint, is in the `ContactSetting`.
#[doc(alias = "contact")]
#[doc(alias = "corner-edge contact")]
#[doc(alias = "contact constraint")]
#[derive(Debug, Clone, Copy, Default)]
pub struct VertexEdge {
    /// Data that pass to the next step; the sweeps update the forces.
    pub history: ContactHistory,
    /// Boundary point of the node.
    pub point: EdgeId,
    /// Covers at the position on the edge that the node faces.
    pub covers: [CoverId; 3],
    /// Their weights there.
    pub weights: Weights,
    /// Outward unit normal of the edge.
    pub normal: Vector,
    /// Springs normal (initial stiffness) and shear (N/m per metre).
    pub stiffness: [f64; 2],
    /// Gap of the springs along the normal (m); negative in penetration.
    pub gap: f64,
    /// Tributary length (m).
    pub length: f64,
    /// Part of it on which cohesion and tension act (m).
    pub bonded: f64,
    /// The past that its law knows: of a rough joint the mean normal stress (Pa) that friction feels on its faces, 0 in
    /// their first step; of one that softens the damage of its bond; less than zero on a section, whose number it is,
    /// counted from -1 down.
    pub past: f64,
    /// Law of the joint.
    pub law: LawId,
    /// Whether the contact failed in tension in this step.
    pub torn: bool,
    /// Whether the contact is new in this step.
    pub fresh: bool,
    /// Whether its friction follows the pressure of the last milliseconds.
    pub delayed: bool,
}

// Large slopes have a million of them and more.
const _: () = assert!(size_of::<VertexEdge>() <= 224);

/// What a contact loses where the rock crushes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Crushed {
    /// Closure (m) that has no force any more.
    pub closes: f64,
    /// Energy (J/m) of its spring.
    pub loss: f64,
    /// Whether it did not crush in the last step.
    pub begins: bool,
}

/// Data that the contacts of a step share.
#[derive(Clone, Copy)]
pub struct ContactSetting<'a> {
    /// Boundary of the blocks.
    pub boundary: &'a Boundary,
    /// Its edges and nodes at their current positions.
    pub frames: &'a Frames,
    /// Joint laws.
    pub laws: &'a [JointLaw],
    /// Law of each joint trace, after switches.
    pub trace_law: &'a [LawId],
    /// Factor on the strength of all joints.
    pub strength: f64,
    /// Shares of tension and of shear beyond the residual one that the bonds of each section may carry.
    pub section_share: &'a [[f64; 2]],
    /// Share of the normal force of this step in that which delayed friction feels.
    pub filter_share: f64,
    /// Least length (m) over which rock crushes.
    pub crush_length: f64,
}

/// Share of the last change of the forces that the warm start adds.
const EXPECTED: f64 = 0.5;

impl VertexEdge {
    /// Unit tangent of the edge.
    #[inline(always)]
    pub fn tangent(&self) -> Vector {
        Vector::new(-self.normal.y, self.normal.x)
    }

    /// Blocks of the node and of the edge.
    #[inline(always)]
    pub fn blocks(&self, boundary: &Boundary) -> [BlockId; 2] {
        [self.point, self.history.edge].map(|point| boundary.block[point])
    }

    /// The node and the position on the edge that it faces.
    #[inline(always)]
    pub fn pair(&self, boundary: &Boundary) -> Pair {
        Pair {
            blocks: self.blocks(boundary),
            covers: [boundary.covers[self.point], self.covers],
            weights: [boundary.weights[self.point], self.weights],
        }
    }

    /// Limits of the joint law for the length of the contact.
    #[inline(always)]
    pub fn limits(&self, setting: &ContactSetting) -> Limits {
        let law = &setting.laws[self.law];
        let is_bond = law.softening.is_some() && self.history.intact;
        if is_bond && self.section().is_some() {
            return Limits::UNLIMITED;
        }
        let limits = if is_bond {
            self.law_of_bond(setting).limits(self.bonded, true)
        } else {
            law.limits(self.bonded, self.history.intact)
        };
        let limits = limits.times(setting.strength);
        let limits = if self.past > 0.0 { limits.under(self.past) } else { limits };
        if self.delayed { limits.delayed(setting.filter_share, self.history.filtered_normal) } else { limits }
    }

    /// Its bond, if its joint softens and holds.
    #[inline(always)]
    pub fn bond(&self, setting: &ContactSetting) -> Option<Hold> {
        let law = &setting.laws[self.law];
        if law.softening.is_none() || !self.history.intact {
            return None;
        }
        let (law, length, strength) = (self.law_of_bond(setting), self.bonded, setting.strength);
        if let Some(section) = self.section() {
            let share = setting.section_share[section];
            return Some(Hold::InSection(section, law.section_bond(self.stiffness, length, strength, share)));
        }
        law.bond(self.stiffness, length, strength, [self.past, self.history.slip]).map(Hold::Alone)
    }

    /// The section with which its bond breaks, if it has one.
    #[inline(always)]
    pub fn section(&self) -> Option<SectionId> {
        (self.past < 0.0).then(|| SectionId::new((-1.0 - self.past) as usize))
    }

    /// The law of a bond. Where part of the contact lies on another joint, the friction is that of both by length.
    fn law_of_bond(&self, setting: &ContactSetting) -> JointLaw {
        let law = setting.laws[self.law];
        if self.bonded >= self.length {
            return law;
        }
        let boundary = setting.boundary;
        let traces = boundary.edges_about(self.history.node).filter_map(|edge| boundary.trace[edge]);
        let beside = traces.map(|trace| setting.trace_law[trace]).find(|&other| other != self.law);
        beside.map_or(law, |other| law.beside(&setting.laws[other], self.bonded / self.length))
    }

    /// Greatest shear force (N/m) under a normal force (N/m, compression positive).
    #[inline(always)]
    pub fn shear_limit(&self, normal: f64, setting: &ContactSetting) -> f64 {
        self.limits(setting).shear(normal, self.length)
    }

    /// Normal force (N/m) at the end of a step that leaves the joint open by `opening` (m): a spring of the joint's own
    /// that `bounces` has in the step the force of its start.
    #[inline(always)]
    pub fn normal_after(&self, opening: f64, bounces: bool, setting: &ContactSetting) -> f64 {
        let is_late = bounces && !setting.laws[self.law].penalty[0];
        // A curve has no finite force where a blow closes it altogether.
        if is_late { self.closure(setting).solve(-opening, 0.0).min(f64::MAX) } else { self.history.normal_force }
    }

    /// Greatest shear force (N/m) in the state of the end of the step, under its normal force (N/m).
    #[inline(always)]
    fn shear_limit_after(&self, normal: f64, setting: &ContactSetting) -> f64 {
        let (limits, ContactHistory { shear_force, state, .. }) = (self.limits(setting), self.history);
        // Of an open contact the pull is not kept: its force shows how much cohesion was left.
        let open = limits.shear_open(f64::NEG_INFINITY).max(shear_force.abs());
        if state == ContactState::Open { open } else { limits.shear(normal, self.length) }
    }

    /// Normal force (N/m) that friction feels after the step.
    #[inline(always)]
    pub fn filtered_normal(&self, setting: &ContactSetting) -> f64 {
        let (normal, before) = (self.history.normal_force, self.history.filtered_normal);
        if !self.delayed {
            return normal;
        }
        let filtered = before + (normal - before) * setting.filter_share;
        // It fades to zero instead of to numbers that computers are slow with.
        if filtered.abs() < f64::MIN_POSITIVE { 0.0 } else { filtered }
    }

    /// The normal spring.
    #[inline(always)]
    pub fn closure(&self, setting: &ContactSetting) -> Closure {
        Closure { stiffness: self.stiffness[0], most: setting.laws[self.law].closure_max }
    }

    /// Whether its joint dilates.
    #[inline(always)]
    pub fn dilates(&self, setting: &ContactSetting) -> bool {
        setting.laws[self.law].dilation > 0.0
    }

    /// The load that the asperities have lifted after a step that opens the contact by `opened` (m).
    #[inline(always)]
    pub fn lift_load(&self, opened: f64) -> LiftLoad {
        let normal = self.history.normal_force.max(0.0);
        LiftLoad { normal, spring: self.stiffness[0], closed: [-self.gap, -self.gap - opened] }
    }

    /// What the contact loses because the rock carries no more than its strength over the length (Eq. 87).
    #[inline(always)]
    pub fn crush(&self, setting: &ContactSetting) -> Crushed {
        let strength = setting.laws[self.law].crush;
        let (force, most) = (self.history.normal_force, strength * self.length.max(setting.crush_length));
        if force <= most {
            return Crushed::default();
        }
        let closure = self.closure(setting);
        let [before, after] = [force, most].map(|force| closure.under(force));
        Crushed {
            closes: before - after,
            loss: closure.energy(before) - closure.energy(after),
            begins: force - self.history.trend[0] <= most,
        }
    }

    /// Energy (J/m) that the springs store at the step's start.
    pub fn stored_energy(&self, setting: &ContactSetting) -> f64 {
        let sheared = 0.5 * self.stiffness[1] * self.history.sheared.powi(2);
        if let Some(bond) = self.bond(setting) {
            return bond.stored(self.gap) + sheared;
        }
        let closure = if self.gap < 0.0 || self.history.state != ContactState::Open { -self.gap } else { 0.0 };
        self.closure(setting).energy(closure) + sheared
    }

    /// Shear force (N/m) that the spring has stored.
    #[inline(always)]
    pub fn shear_stored(&self) -> f64 {
        self.stiffness[1] * self.history.sheared
    }

    /// Penetration of the node (m): that of the springs plus the initial offset.
    #[inline(always)]
    pub fn penetration(&self) -> f64 {
        self.loaded_penetration() + self.history.unloaded.offset
    }

    /// Penetration (m) that the springs resist: without the initial offset.
    #[inline(always)]
    pub fn loaded_penetration(&self) -> f64 {
        -self.gap - self.history.unloaded.rest
    }

    /// Normal and shear component of a cover field at the node relative to the edge.
    #[inline(always)]
    pub fn relative(&self, boundary: &Boundary, field: &[Vector]) -> [f64; 2] {
        let relative = boundary.sample(self.point, field) - cover::sample(&self.covers, &self.weights, field);
        [relative.dot(&self.normal), relative.dot(&self.tangent())]
    }

    /// Shear force (N/m) that the spring stores after moving by `shear` (m) in a step that leaves the joint open by
    /// `opening` (m) under a normal force (N/m), and the slip (m) of the node along it (Eq. 15).
    #[inline(always)]
    pub fn shear_after(&self, shear: f64, (opening, normal): (f64, f64), setting: &ContactSetting) -> (f64, f64) {
        if self.history.state == ContactState::Open && !self.delayed && self.history.shear_force == 0.0 {
            return (0.0, 0.0);
        }
        let trial = self.shear_stored() - self.stiffness[1] * shear;
        let limit = match self.bond(setting) {
            Some(bond) => {
                let ease = 1.0 / self.stiffness[1];
                bond.shear(self.history.normal_force, trial.abs(), ease, opening)
            }
            None => self.shear_limit_after(normal, setting),
        };
        self.clamped(trial, limit)
    }

    /// Shear force (N/m) that the spring stores of a `trial` one within its limit, and the slip (m) that takes off the
    /// rest.
    #[inline(always)]
    pub(super) fn clamped(&self, trial: f64, limit: f64) -> (f64, f64) {
        let stored = trial.clamp(-limit, limit);
        (stored, (stored - trial) / self.stiffness[1])
    }

    /// Warm start: a contact that stays closed begins with its last force plus a share of its last change, within its
    /// `limits`.
    #[inline(always)]
    pub fn expected(&self, limits: &Limits) -> [f64; 2] {
        let ContactHistory { normal_force, shear_force, trend, .. } = self.history;
        let normal = normal_force + EXPECTED * trend[0];
        if normal > 0.0 && normal_force > trend[0].max(0.0) {
            let limit = limits.shear(normal, self.length);
            return [normal, (shear_force + EXPECTED * trend[1]).min(limit).max(-limit)];
        }
        [normal_force, shear_force]
    }

    /// Stores the forces (N/m) at the end of an explicit step and their change. In a stage that `rests` a change that
    /// turned back foretells nothing: to go on with it would keep contacts in oscillation.
    #[inline(always)]
    pub fn end(&mut self, forces: [f64; 2], bears: bool, torn: bool, rests: bool, setting: &ContactSetting) {
        let ContactHistory { normal_force, shear_force, trend, .. } = self.history;
        self.bear(forces, bears, torn, self.shear_limit(forces[0], setting));
        let change = [self.history.normal_force - normal_force, self.history.shear_force - shear_force];
        self.history.trend = [0, 1].map(|k| if rests && change[k] * trend[k] < 0.0 { 0.0 } else { change[k] });
    }

    /// Stores the forces (N/m) of the joint, of which no normal one is left unless it `bears`, under a limit of shear
    /// (N/m); `torn` after a failure in tension. No branch depends on their values, which are hard to predict.
    #[inline(always)]
    fn bear(&mut self, [normal, shear]: [f64; 2], bears: bool, torn: bool, limit: f64) {
        let slips = shear.abs() >= limit;
        let states = [ContactState::Open, ContactState::Open, ContactState::Lock, ContactState::Slip];
        self.history.state = states[2 * usize::from(bears) + usize::from(slips)];
        // The sum turns a zero from below into zero.
        (self.history.normal_force, self.history.shear_force) = (normal + 0.0, shear + 0.0);
        self.torn = torn;
    }

    /// Clamps the forces of the springs to the limits of the joint.
    #[inline(always)]
    pub fn decide(&mut self, normal: f64, shear: f64, setting: &ContactSetting) {
        if self.bond(setting).is_some() {
            let limit = self.shear_limit(normal, setting);
            return self.bear([normal, shear], true, false, limit);
        }
        let limits = self.limits(setting);
        let torn = normal < -limits.tension();
        let bears = !torn && (normal > 0.0 || limits.tension() > 0.0);
        let limit = limits.shear(normal, self.length);
        let hops = limits.shear_open(normal);
        let force = if bears { [normal, shear.clamp(-limit, limit)] } else { [0.0, shear.clamp(-hops, hops)] };
        self.bear(force, bears, torn, limit);
    }
}
