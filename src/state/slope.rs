//! The built model: nothing in it changes in time.

use crate::contact::{Boundary, JointLaw, Support};
use crate::cover::Covers;
use crate::geometry::{Point, Vector};
use crate::mechanics::{Elasticity, Load, Metric, PreStress, StressField};

use super::Implicit;

/// What one fixity of the case holds.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Fixity {
    /// Name.
    pub name: Option<String>,
    /// Covers that it holds, and along which axes.
    pub covers: Vec<(u32, [bool; 2])>,
    /// Whether it holds from the start.
    pub active: bool,
}

/// What a port gives access to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PortKind {
    /// A block: force and moment in, motion and contact force out.
    Block,
    /// A part of the outer boundary: traction and pressure in, motion and stress out.
    Boundary,
    /// Joint faces: fluid pressure in, contact forces and slip out.
    Joint,
}

/// A named place where hosts exchange values with the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Port {
    /// Name.
    pub name: String,
    /// Kind.
    pub kind: PortKind,
    /// The block, or the block of the first edge.
    pub block: u32,
    /// Boundary edges; none for a block.
    pub edges: Vec<u32>,
    /// Force on the block (N/m) or traction on the boundary (Pa) at the start.
    pub force: Vector,
    /// Moment on the block (N·m/m) or pressure on the faces (Pa) at the start.
    pub scalar: f64,
}

/// Water with a level surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Water {
    /// Density (kg/m³).
    pub density: f64,
    /// Height y of the surface at the start (m).
    pub level: f64,
    /// Boundary edges that it reaches.
    pub edges: Vec<u32>,
}

/// Covers, rocks, boundary, laws, loads and numerical choices of one model.
#[derive(Debug, Clone)]
pub struct Slope {
    /// Covers, elements and blocks.
    pub covers: Covers,
    /// Rocks.
    pub rocks: Vec<Elasticity>,
    /// Rock of each element.
    pub element_rock: Vec<u16>,
    /// In-situ stress of each element (Pa); empty when there is none.
    pub pre_stress: Vec<PreStress>,
    /// Masses of all blocks as if free.
    pub metric: Metric,
    /// 2π·cs/max(√A, h) of each block (1/s): what the damping ratio multiplies.
    pub block_frequency: Vec<f64>,
    /// Boundary as contact sees it.
    pub boundary: Boundary,
    /// Joint laws at the start.
    pub laws: Vec<JointLaw>,
    /// Law of each joint trace.
    pub trace_law: Vec<u32>,
    /// Law of contacts between faces that were no joints.
    pub default_law: u32,
    /// Fixities.
    pub fixities: Vec<Fixity>,
    /// Supports of all fixities.
    pub supports: Vec<Support>,
    /// Loads.
    pub loads: Vec<Load>,
    /// Ports.
    pub ports: Vec<Port>,
    /// Water, if any.
    pub water: Option<Water>,
    /// Gravity (m/s²).
    pub gravity: Vector,
    /// In-situ stress, if any.
    pub in_situ: Option<StressField>,
    /// Internal step (s).
    pub dt: f64,
    /// Stability limit (s).
    pub critical_dt: f64,
    /// θ of the contact springs.
    pub theta: f64,
    /// Relative change of force at which the open–close iteration has settled.
    pub tolerance: f64,
    /// Most sweeps of the open–close iteration.
    pub sweeps_max: u32,
    /// What the implicit integrator needs; none for the explicit one.
    pub implicit: Option<Implicit>,
    /// Penetration (m) at which the run fails.
    pub penetration_limit: f64,
    /// Displacement (m) beyond which a block counts as failed.
    pub failure_displacement: f64,
}

impl Slope {
    /// Material point: sum of a cover field over an element's covers at reference point `p`.
    pub fn sample(&self, element: usize, p: Point, field: &[Vector]) -> Vector {
        let weights = self.covers.weights(element, p);
        self.covers.element_covers[element].iter().zip(weights).map(|(&i, w)| field[i as usize] * w).sum()
    }
}
