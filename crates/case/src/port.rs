//! Ports of a case.

use crate::Case;
use crate::keys::shared::{FORCE, PLACE, PRESSURE};
use crate::keys::unit::MOMENT;
use crate::keys::{Range, Rule, keys};
use crate::limits::VALUE_MAX;

/// Remedy for values of a port.
const START: &str = "what acts from the start";
/// Traction and pressure.
const PRESSURE_AT_PORT: Rule = PRESSURE.in_range(Range::within(VALUE_MAX)).hint(START);

keys! {
    /// A named place where hosts exchange values with the model; exactly one of `block`, `boundary`, `joint`, `quiet`,
    /// `fix`.
    #[derive(Default)]
    pub struct Port {
        /// Name: letters, digits and underscores.
        pub name: String,
        /// The block that holds this point (m): force and moment in, motion and contact force out.
        pub block: Option<[f64; 2]> => PLACE,
        /// The parts of the outer boundary on this segment (m): traction and pressure in, motion and stress out.
        pub boundary: Option<[[f64; 2]; 2]> => PLACE,
        /// The joint faces on this segment (m): fluid pressure in, contact forces and slip out.
        pub joint: Option<[[f64; 2]; 2]> => PLACE,
        /// The `[[quiet]]` boundary with this edge (m): particle velocity of the incoming wave in, velocity and
        /// traction out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub quiet: Option<[[f64; 2]; 2]> => PLACE,
        /// The `[[fix]]` of this name, of a point or an edge: its velocity or displacement in, its reaction out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub fix: Option<String>,
        /// Force (N per metre of depth) on the block from the start until a host sets another.
        #[serde(default)]
        pub force: [f64; 2] => FORCE.hint(START),
        /// Moment (N·m per metre of depth, counter-clockwise) on the block from the start.
        #[serde(default)]
        pub moment: f64 => Range::within(VALUE_MAX).of(MOMENT).hint(START),
        /// Traction (Pa, global axes) on the boundary from the start.
        #[serde(default)]
        pub traction: [f64; 2] => PRESSURE_AT_PORT,
        /// Pressure (Pa) on the boundary, or in the joints, from the start.
        #[serde(default)]
        pub pressure: f64 => PRESSURE_AT_PORT,
    }
}

impl Case {
    /// Index of the quiet boundary with an edge (m), in either direction.
    pub fn quiet_of(&self, [a, b]: [[f64; 2]; 2]) -> Option<usize> {
        self.quiets.iter().position(|quiet| quiet.edge == [a, b] || quiet.edge == [b, a])
    }
}
