//! Monitors and outputs of a case.

use crate::Pictures;
use crate::keys::shared::{LENGTH, PLACE};
use crate::keys::unit::{NUMBER, SECOND};
use crate::keys::{Range, Rule, keys};

/// Points of a line that names no number of them.
const POINTS: u32 = 21;
/// Most points of a line.
const POINTS_MAX: u32 = 1000;

/// Intervals of outputs.
const INTERVAL: Rule = Range::above(0.0).to(1e12).of(SECOND).hint("leave it out for the default");

keys! {
    /// A material point whose motion goes into the history.
    pub struct Monitor {
        /// Name; heads the columns.
        pub name: String,
        /// Place in the reference configuration (m).
        pub point: [f64; 2] => PLACE,
        /// Whether the stress there goes into the history too: its parts, the principal stresses and their direction.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        pub stress: bool,
    }
}

keys! {
    /// A gauge across a joint, whose opening, slip and stress go into the history.
    pub struct JointMonitor {
        /// Name; heads the columns.
        pub name: String,
        /// Place in the reference configuration (m); the gauge is at the nearest place of a joint, within a mesh size.
        pub point: [f64; 2] => PLACE,
        /// The joint that is meant: the name of its set, or its place in the case, as `joint[2]`; default: the nearest.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub joint: Option<String>,
        /// Length (m) of joint about the place over which the stress is a mean; default: the face of the two blocks
        /// that meet there.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub length: Option<f64> => LENGTH.hint("two or three mesh sizes are usual"),
    }
}

keys! {
    /// A row of points, as of an inclinometer or a profile, whose motion and stress go into `lines.csv`.
    pub struct Line {
        /// Name.
        pub name: String,
        /// First point in the reference configuration (m).
        pub from: [f64; 2] => PLACE,
        /// Last point (m).
        pub to: [f64; 2] => PLACE,
        /// Number of points, the same way apart; default 21.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub points: Option<u32> => Range::from(2.0).to(POINTS_MAX as f64).of(NUMBER).hint("21 is the default"),
    }
}

impl Line {
    /// Its points (m), from the first to the last.
    pub fn points(&self) -> Vec<[f64; 2]> {
        let count = self.points.unwrap_or(POINTS);
        let at = |k: u32| {
            let share = f64::from(k) / f64::from(count - 1);
            [0, 1].map(|axis| self.from[axis] + share * (self.to[axis] - self.from[axis]))
        };
        (0..count).map(at).collect()
    }

    /// Unit vector from the first point to the last.
    pub fn direction(&self) -> [f64; 2] {
        let way = [0, 1].map(|axis| self.to[axis] - self.from[axis]);
        let length = libm::hypot(way[0], way[1]);
        way.map(|part| part / length)
    }
}

keys! {
    /// Files to write and their intervals.
    pub default struct Output {
        /// Simulated time between frames (s); default: a twentieth of the duration of a dynamic stage; in a static
        /// stage, two to four each time that its number of steps doubles.
        pub frame_interval: Option<f64> => INTERVAL,
        /// Simulated time between rows of the history (s); default: a five-hundredth of the duration of a dynamic
        /// stage, and at most 0.005 s where a ground motion shakes it; in a static stage, 32 to 64 each time that its
        /// number of steps doubles.
        pub history_interval: Option<f64> => INTERVAL,
        /// Simulated time between checkpoints (s); default: one at the end.
        pub checkpoint_interval: Option<f64> => INTERVAL,
        /// Whether to write VTU frames.
        pub frames: bool = true,
        /// Which pictures to draw: `true` for the usual ones (`model`, `deformed`, `history`, and at the end of each
        /// stage `displacement_contours`, `joints`, `mean_stress_contours`, `strength` of rock that can break,
        /// `flow` of water in joints, and `lines`; `spectra` of ground motions), `false` for none, or a list of exactly
        /// those to draw.
        pub pictures: Pictures = Pictures::Usual(true),
        /// Name of a stage: displacements of monitors, lines, frames and pictures, and opening and slip of monitors of
        /// joints, count from its end on; default: from the start.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub since: Option<String>,
    }
}
