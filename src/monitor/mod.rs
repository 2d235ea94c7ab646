//! Monitors: where they are in a model, and what they read from it and its state. Steps know nothing of them.

mod faces;
mod joint;
pub mod stress;

pub use faces::Faces;
pub use joint::{JOINT_MONITOR_QUANTITIES, JointMonitor, JointMonitorState, JointPlace};
pub use stress::{MONITOR_STRESS_QUANTITIES, Stress, StressFit};

use crate::cover::ElementId;
use crate::geometry::{Point, Vector};
use crate::state::{Model, State};

/// The monitors of a case in one of its models.
#[derive(Debug, Clone, Default)]
pub struct Monitors {
    /// Element and reference point (m) of each monitor.
    pub points: Vec<(ElementId, Point)>,
    /// How each of them reads the stress; none for one that does not.
    pub stresses: Vec<Option<StressFit>>,
    /// Monitors of joints.
    pub joints: Vec<JointMonitor>,
    /// Faces that lay on each other; empty without monitors of joints.
    pub faces: Faces,
    /// The points of each line.
    pub lines: Vec<Vec<LinePlace>>,
}

/// A point of a line.
#[derive(Debug, Clone)]
pub struct LinePlace {
    /// Its element.
    pub element: ElementId,
    /// Reference point (m).
    pub point: Point,
    /// How it reads the stress.
    pub stress: StressFit,
}

/// A point of a line now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinePoint {
    /// Reference point (m).
    pub place: Point,
    /// Displacement (m), NaN in rock that has been excavated.
    pub displacement: Vector,
    /// Stress xx, yy, xy (Pa, tension positive), NaN in rock that has been excavated.
    pub stress: Stress,
}

impl LinePlace {
    /// The point now.
    pub fn read(&self, model: &Model, state: &State) -> LinePoint {
        let stress = self.stress.read(model, state);
        let removed = state.removed[model.covers.element_block[self.element]];
        let displacement =
            if removed { Vector::repeat(f64::NAN) } else { displacement(model, state, (self.element, self.point)) };
        LinePoint { place: self.point, displacement, stress }
    }
}

/// Displacement (m) of a material point as outputs count it.
pub fn displacement(model: &Model, state: &State, (element, point): (ElementId, Point)) -> Vector {
    let moved = model.sample(element, point, &state.displacement);
    state.counted_from().map_or(moved, |from| moved - model.sample(element, point, from))
}
