//! The section: outline, mesh, joints drawn one by one.

use std::path::PathBuf;

use crate::PointList;
use crate::keys::shared::{DIRECTION, PLACE};
use crate::keys::unit::{METRE, SQUARE_METRE};
use crate::keys::{Range, Rule, keys};

/// Distances of ends of traces from what they almost meet.
const ENDS: Rule = Range::from(0.0).to(1e3).of(METRE);

keys! {
    /// Rock outline, holes, islands, and a file that may hold them.
    pub default struct Domain {
        /// Outer loop of the rock (m), either sense; this or `geometry_file` with an outline.
        pub outline: PointList => PLACE,
        /// Loops cut out of the outline (m).
        pub holes: Vec<PointList> => PLACE,
        /// Loops of rock inside holes or beside the outline (m).
        pub islands: Vec<PointList> => PLACE,
        /// JSON (`outline`, `joints`), GeoJSON, DXF, WKT or CSV, relative to the case file.
        pub geometry_file: Option<PathBuf>,
        /// Greatest distance (m) of arcs and splines of a DXF drawing from the polylines that they become; default 0.02
        /// mesh sizes.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub curve_tolerance: Option<f64> => Range::from(1e-6).to(1e3).of(METRE).hint("0.02 mesh sizes is usual"),
        /// Law of traces that name none.
        pub joint_law: Option<String>,
        /// Distance (m) within which points and edges become one; default 1e-6 of the bounding-box diagonal.
        pub snap_tolerance: Option<f64> => Range::above(0.0).to(1e3).of(METRE).hint("1e-6 of the model's size"),
        /// Distance (m) within which an end of a trace that almost meets the outline or another trace is extended or
        /// trimmed to it; default 0.0023 of the bounding-box diagonal, 0 keeps what is drawn.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub extend_ends: Option<f64> => ENDS.hint("0.0023 of the model's size"),
        /// Distance (m) within which an end that stops in the rock before the outline or another trace is named in a
        /// note, tried joined beside the bounds of `fos` and `bound`, and bridged by `bridge_law`; default 0.02 of the
        /// bounding-box diagonal, at least `extend_ends`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub near_ends: Option<f64> => ENDS.hint("0.02 of the model's size"),
        /// Joint law of rock bridges between ends that stop in the rock, nearer than `near_ends` to the outline or
        /// another trace, and that line; default: the rock there is elastic and never breaks.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub bridge_law: Option<String>,
    }
}

keys! {
    /// Equilateral lattice: node(i, j) = origin + i·a1 + j·a2, a1 = size·(cos, sin)(angle), a2 = a1 turned by +60°.
    pub struct Mesh {
        /// Side of a triangle (m).
        pub size: f64 => Range::above(0.0).to(1e6).of(METRE).hint("about a fifth of the smallest block is usual"),
        /// Direction of a1 from the x axis (degrees).
        #[serde(default)]
        pub angle_deg: f64 => DIRECTION.hint("0 to 60 gives every lattice"),
        /// Node (0, 0) (m).
        #[serde(default)]
        pub origin: [f64; 2] => PLACE,
        /// Area (m²) below which a block joins the neighbour across its shortest joint; default (size/20)², 0
        /// keeps all blocks.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub least_block: Option<f64> => Range::from(0.0).to(1e6).of(SQUARE_METRE).hint("(size/20)² is the default"),
    }
}

/// Side over the mesh size of the square that has the default least area of a block.
const LEAST_RATIO: f64 = 0.05;

impl Mesh {
    /// Area (m²) below which a block joins a neighbour.
    pub fn least_block(&self) -> f64 {
        self.least_block.unwrap_or((LEAST_RATIO * self.size).powi(2))
    }

    /// A lattice of another size that leaves the same blocks.
    pub fn of_size(&self, size: f64) -> Self {
        Self { size, least_block: Some(self.least_block()), ..self.clone() }
    }
}

keys! {
    /// One joint: a polyline in the reference configuration.
    pub struct JointTrace {
        /// At least two points (m).
        pub points: PointList => PLACE,
        /// Joint law by name; default `domain.joint_law`.
        pub law: Option<String>,
    }
}
