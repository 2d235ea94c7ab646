//! Rock bolts: elastic–plastic bars between two material points, solved in the open–close iteration (Eqs. 40–44).

use crate::cover::{BlockId, CoverId, Weights};
use crate::geometry::{Point, Vector};
use crate::mechanics::MassMatrix;

use super::Pair;
use super::grout::Grout;

/// A free length of a bar between two material points; forces per metre of depth.
#[doc(alias = "anchor")]
#[doc(alias = "cable")]
#[doc(alias = "truss")]
#[derive(Debug, Clone, PartialEq)]
pub struct BoltSegment {
    /// Bolt of the case that it belongs to.
    pub bolt: u32,
    /// Blocks of both points.
    pub blocks: [BlockId; 2],
    /// Covers of both points.
    pub covers: [[CoverId; 3]; 2],
    /// Weights of those covers at the points.
    pub weights: [Weights; 2],
    /// Reference positions of both points (m).
    pub points: [Point; 2],
    /// Stiffness EA over free length and spacing (N/m per metre).
    pub stiffness: f64,
    /// Tension at which the bar yields (N/m); infinite for never.
    pub yield_force: f64,
    /// Elongation at which the bar breaks (m); infinite for never.
    pub rupture: f64,
    /// Tension when it is installed (N/m).
    pub pretension: f64,
    /// Whether it is there from the start.
    pub active: bool,
    /// The ties of both points of the bar to those of the rock; none where both are one.
    pub grout: Option<[Grout; 2]>,
    /// Whether its first point is the second one of the segment before.
    pub follows: bool,
}

/// State of a bar segment between two steps.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct BoltState {
    /// Whether it is installed.
    pub active: bool,
    /// Whether it has broken.
    pub broken: bool,
    /// Length (m) without force: grows when the bar yields.
    pub rest: f64,
    /// The same when it was installed (m).
    pub natural: f64,
    /// Tension at the end of the last step (N/m).
    pub force: f64,
    /// Slip (m) of a grouted bar at both points, along the rock towards its far end.
    pub slip: [f64; 2],
    /// The part of it that lasts without force (m).
    pub slid: [f64; 2],
}

impl BoltState {
    /// The condition now. A bar that has yielded or broken and lost its rock is absent.
    pub fn condition(&self) -> BoltCondition {
        match self {
            now if !now.active => BoltCondition::Absent,
            now if now.broken => BoltCondition::Broken,
            now if now.rest > now.natural => BoltCondition::Yielded,
            now if now.force > 0.0 => BoltCondition::Elastic,
            _ => BoltCondition::Slack,
        }
    }
}

/// Condition of a bar segment at one instant.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BoltCondition {
    /// A stage installs it later, or a block that held it is gone, whatever the bar did before.
    #[default]
    Absent,
    /// It carries no force and has never yielded.
    Slack,
    /// It is in tension and has never yielded.
    Elastic,
    /// It has yielded.
    Yielded,
    /// It has broken.
    Broken,
}

impl BoltCondition {
    /// Names of the numbers in files.
    pub const NAMES: [&str; 4] = ["absent", "whole", "yielded", "broken"];

    /// Number in files of bolts and in films, where a slack bar and one in tension count as whole.
    pub fn number(self) -> u8 {
        match self {
            Self::Absent => 0,
            Self::Slack | Self::Elastic => 1,
            Self::Yielded => 2,
            Self::Broken => 3,
        }
    }
}

/// A bar segment during one step.
#[derive(Debug, Clone, Copy)]
pub struct BoltRow {
    /// Index of the segment.
    pub segment: u32,
    /// Its two points.
    pub pair: Pair,
    /// Arms from the centroids of the blocks to them (m).
    pub arms: [Vector; 2],
    /// Unit vector from the second point to the first.
    pub direction: Vector,
    /// Length at the step's start (m).
    pub length: f64,
    /// Length without force (m).
    pub rest: f64,
    /// Stiffness (N/m per metre).
    pub stiffness: f64,
    /// Tension at which the bar yields (N/m).
    pub yield_force: f64,
    /// Inverse effective mass along the direction (m/kg).
    pub compliance: f64,
    /// Predicted rate of the length (m/s).
    pub approach: f64,
    /// Tension (N/m).
    pub force: f64,
    /// Whether that stays through the step, as of a grouted bar in balance at its start.
    pub stays: bool,
}

impl BoltSegment {
    /// From the second point to the first (m), for stars at `star` that are displaced by `displacement`.
    pub fn span(&self, star: &[Point], displacement: &[Vector]) -> Vector {
        let [a, b] = [0, 1].map(|k| self.position(k, star, displacement));
        a - b
    }

    fn position(&self, k: usize, star: &[Point], displacement: &[Vector]) -> Point {
        let position = |i: CoverId| star[i] + displacement[i];
        self.covers[k].iter().zip(self.weights[k]).map(|(&i, w)| position(i) * w).sum()
    }

    /// The state of a segment that is installed at its current length (m), with its pretension (Eq. 40).
    pub fn install(&self, length: f64) -> BoltState {
        let rest = length - self.pretension / self.stiffness;
        BoltState { active: true, rest, natural: rest, force: self.pretension, ..BoltState::default() }
    }

    /// Energy (J/m) that the bar stores at a length (m), with that of its grout.
    pub fn energy(&self, state: &BoltState, length: f64) -> f64 {
        let stretch = (length + (state.slip[1] - state.slip[0]) - state.rest).max(0.0);
        let own = if state.active && !state.broken { 0.5 * self.stiffness * stretch * stretch } else { 0.0 };
        // The first point is the second one of the segment before.
        let points = usize::from(self.follows)..2;
        let tied = |grout: [Grout; 2]| points.map(|k| grout[k].energy(state.slip[k], state.slid[k])).sum::<f64>();
        own + self.grout.filter(|_| state.active).map_or(0.0, tied)
    }

    /// The segment at the start of a step: `centres` are those of the blocks, `predicted` the velocities without
    /// forces.
    pub fn row(&self, index: u32, state: &BoltState, view: &BoltView) -> BoltRow {
        let positions = [0, 1].map(|k| self.position(k, view.star, view.displacement));
        let span = positions[0] - positions[1];
        let length = span.norm();
        let direction = if length > 0.0 { span / length } else { (self.points[0] - self.points[1]).normalize() };
        let arms = [0, 1].map(|k| positions[k] - view.motion[self.blocks[k]].centre);
        let pair = Pair { blocks: self.blocks, covers: self.covers, weights: self.weights };
        let compliance = pair.compliance(view.mass_matrix, &arms, direction);
        BoltRow {
            segment: index,
            approach: pair.difference(view.predicted).dot(&direction),
            pair,
            arms,
            direction,
            length,
            rest: state.rest,
            stiffness: self.stiffness,
            yield_force: self.yield_force,
            compliance,
            force: state.force,
            stays: self.grout.is_some(),
        }
    }

    /// The state after a step at whose end the bar is `length` (m) long: it yields and breaks by that (Eqs. 42, 43).
    pub fn after(&self, state: &BoltState, length: f64, force: f64) -> BoltState {
        let broken = length - state.natural > self.rupture;
        let rest = state.rest.max(length - self.yield_force / self.stiffness);
        BoltState { broken, rest, force: if broken { 0.0 } else { force }, ..*state }
    }
}

/// Inputs of a segment in a step.
pub struct BoltView<'a> {
    /// Star positions (m).
    pub star: &'a [Point],
    /// Displacements (m).
    pub displacement: &'a [Vector],
    /// Velocities without contact forces (m/s).
    pub predicted: &'a [Vector],
    /// Masses.
    pub mass_matrix: &'a MassMatrix,
    /// Centroids of the blocks.
    pub motion: &'a [crate::mechanics::BlockMotion],
}

impl BoltRow {
    /// Tension (N/m) from the rate of the length (m/s) under all impulses so far, its own `force` included: the
    /// implicit spring of contacts, between slack and yield (Eq. 41). The stiffness of a bar is physical: θ grows from
    /// 0 for a bar that the step resolves to that of contacts for a stiff one (large κ = k·W·dt²), so that a soft bar
    /// loses no energy to the scheme.
    pub fn answer(&self, rate: f64, dt: f64, kick: f64, theta: f64) -> f64 {
        if self.stays {
            return self.force;
        }
        let wa = self.compliance * kick;
        let kappa = self.stiffness * wa * dt;
        let a = self.stiffness * dt * (theta * kappa / (1.0 + kappa));
        let trial = (self.stiffness * (self.length - self.rest) + a * (rate + wa * self.force)) / (1.0 + a * wa);
        trial.clamp(0.0, self.yield_force)
    }
}
