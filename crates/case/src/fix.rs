//! Fixities of a case.

use crate::keys::shared::PLACE;
use crate::keys::unit::{SPEED, SUPPORT};
use crate::keys::{Range, keys, words};
use crate::limits::VELOCITY_MAX;

words! {
    /// Axes that a fixity holds.
    #[derive(Default)]
    pub enum Axes {
        /// Horizontal.
        X = "x",
        /// Vertical.
        Y = "y",
        /// Both.
        #[default]
        Xy = "xy",
    }
}

keys! {
    /// Holds a part of the rock; exactly one of `point`, `edge`, `box`, `block`.
    pub default struct Fix {
        /// Name, for stages that free or fix.
        pub name: Option<String>,
        /// A material point (m).
        pub point: Option<[f64; 2]> => PLACE,
        /// The parts of the rock boundary on this segment (m).
        pub edge: Option<[[f64; 2]; 2]> => PLACE,
        /// `[xmin, ymin, xmax, ymax]` (m): the physical covers whose area centroid lies inside.
        #[serde(rename = "box")]
        pub region: Option<[f64; 4]> => PLACE.written("box"),
        /// The whole block that holds this point (m).
        pub block: Option<[f64; 2]> => PLACE,
        /// Directions that are held.
        pub axes: Axes,
        /// Support stiffness of points (N/m per metre) and edges (Pa/m); default: 1000 and 100 times the contact's.
        pub stiffness: Option<f64> => Range::above(0.0).to(1e20).of(SUPPORT).hint("leave it out for the default"),
        /// Velocity (m/s) with which a held point or edge moves in dynamic stages.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub velocity: Option<[f64; 2]> => Range::within(VELOCITY_MAX).of(SPEED).hint("plates move at mm/s"),
        /// Whether it holds from the start.
        pub active: bool = true,
    }
}
