//! Gravity, loads and velocities at the start.

use crate::TimeTable;
use crate::keys::shared::{FORCE, PLACE, PRESSURE, ROWS};
use crate::keys::unit::{ACCELERATION, MOMENT, SPEED, TURN};
use crate::keys::{Range, Rule, keys, words};

/// Acceleration of gravity.
const GRAVITY: Rule = Range::within(1e4)
    .of(ACCELERATION)
    .hint("the standard is x = 0 and y = -9.81")
    .usual([1e-2, 100.0], "down is -9.81 m/s²");

keys! {
    /// Acceleration of gravity.
    pub default struct Gravity {
        /// Horizontal part (m/s²).
        pub x: f64 => GRAVITY.label("Gravity, horizontal").none_at_zero(),
        /// Vertical part (m/s²), up positive.
        pub y: f64 = -9.81 => GRAVITY.label("Gravity, vertical"),
    }
}

words! {
    /// Target of a load.
    pub enum LoadKind {
        /// `force` (N/m) at the material point `point`.
        Point = "point",
        /// `traction` (Pa, global axes) on the boundary parts along `edge`.
        Traction = "traction",
        /// `pressure` (Pa, pushing into the rock) on the boundary parts along `edge`; follows the surface.
        Pressure = "pressure",
        /// `acceleration` (m/s²) of all rock, added to gravity.
        Body = "body",
        /// `force` (N/m) and `moment` (N·m/m, counter-clockwise) about the centroid of the block that holds `point`.
        Block = "block",
        /// Fluid `pressure` (Pa) on both faces of the joints along `edge`, linear to `pressure_end` at its second
        /// point.
        Joint = "joint",
    }
}

keys! {
    /// A load with an optional time table.
    pub struct Load {
        /// Name.
        pub name: Option<String>,
        /// Target of the load.
        pub kind: LoadKind,
        /// Material point (m), for `point` and `block`.
        pub point: Option<[f64; 2]> => PLACE,
        /// Segment (m), for `traction`, `pressure` and `joint`.
        pub edge: Option<[[f64; 2]; 2]> => PLACE,
        /// Force (N per metre of depth).
        pub force: Option<[f64; 2]> => FORCE.hint("up and right are positive"),
        /// Moment (N·m per metre of depth), counter-clockwise.
        pub moment: Option<f64> =>
            Range::within(1e18).of(MOMENT).hint("counter-clockwise is positive").label("Moment").none_at_zero(),
        /// Traction (Pa) in global axes.
        pub traction: Option<[f64; 2]> => PRESSURE.hint("up and right are positive"),
        /// Pressure (Pa), pushing into the rock.
        pub pressure: Option<f64> => PRESSURE.hint("into the rock is positive").label("Pressure"),
        /// Pressure (Pa) at the second point of `edge`, for `joint`; default: `pressure`.
        pub pressure_end: Option<f64> => PRESSURE.hint("leave it out for `pressure`").label("Pressure at the end"),
        /// Acceleration (m/s²).
        pub acceleration: Option<[f64; 2]> =>
            Range::within(1e6).of(ACCELERATION).hint("up and right are positive")
                .usual([1e-3, 100.0], "a tenth of gravity is 0.981 m/s²"),
        /// Factor over time; default 1 always.
        pub table: Option<TimeTable> => ROWS,
    }
}

keys! {
    /// Velocity at the start of the first stage.
    pub default struct InitialVelocity {
        /// The block that holds this point (m); default: all blocks.
        pub block: Option<[f64; 2]> => PLACE,
        /// Velocity of the centroid (m/s).
        pub velocity: [f64; 2] => Range::within(1e5).of(SPEED).hint("rock falls at 1 to 100"),
        /// Angular velocity about the centroid (rad/s), counter-clockwise.
        pub angular_velocity: f64 => Range::within(1e5).of(TURN).hint("0 for no rotation"),
    }
}
