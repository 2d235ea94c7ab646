//! Planes of weakness in rock that yields.

use crate::Side;
use crate::joint_set::DIP;
use crate::keys::shared::{ANGLE, DILATION, DIRECTION, STRENGTH};
use crate::keys::{Range, keys};

keys! {
    /// Parallel planes that run through all points of a rock that yields, such as bedding or foliation: the rock slides
    /// or parts along them before it yields elsewhere. They turn with the rock.
    #[derive(Copy, Default)]
    pub struct PlaneOfWeakness {
        /// Direction of the traces, counter-clockwise from the x axis (degrees); this, or `dip_deg` with `dips`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub angle_deg: Option<f64> => DIRECTION.hint("counter-clockwise from the x axis").label("Weak plane"),
        /// Dip below the horizontal (degrees), with `dips`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub dip_deg: Option<f64> => DIRECTION.in_range(Range::from(0.0).to(90.0)).hint(DIP).label("Weak plane dips"),
        /// Side towards which traces with `dip_deg` descend.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub dips: Option<Side>,
        /// Friction angle along the planes (degrees).
        pub friction_deg: f64 =>
            ANGLE.hint("planes of weakness have 10 to 40").usual([5.0, 60.0], "planes of weakness have 10 to 40°")
                .example(25.0).label("Its friction"),
        /// Cohesion along the planes (Pa).
        #[serde(default)]
        pub cohesion: f64 => STRENGTH.hint("0 for planes without cohesion").label("Its cohesion"),
        /// Tensile strength across the planes (Pa); default: the apex `cohesion`/tan(`friction_deg`).
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub tension: Option<f64> => STRENGTH.hint("leave it out for the apex").label("Its tension"),
        /// Dilation angle along the planes (degrees), at most `friction_deg`.
        #[serde(default)]
        pub dilation_deg: f64 => DILATION.hint("0 is usual").label("Its dilation").none_at_zero(),
    }
}
