//! Stress of a case before its first stage.

use crate::keys::shared::{HEIGHT, ROCK_DENSITY, STRESS};
use crate::keys::unit::{NUMBER, PASCAL_PER_METRE};
use crate::keys::{Range, Rule, keys};

/// Normal stress in the rock.
const ROCK_STRESS: Rule =
    STRESS.hint("tension is positive, compression negative").usual([1e3, 1e9], "100 m of rock press with 2.6e6 Pa");
/// Change of stress with height.
const SLOPE: Rule = Range::within(1e9)
    .of(PASCAL_PER_METRE)
    .hint("density times gravity is usual")
    .usual([50.0, 1e6], "the weight of rock makes 2.6e4 Pa/m");

keys! {
    /// Stress before the first stage (Pa, tension positive): value + gradient·(y − y_reference), or `k0`.
    pub default struct InSitu {
        /// Horizontal over vertical stress. The vertical stress is then that of the rock above,
        /// −density·9.81·(y_reference − y) with the gravity of the case, and `sxx`, `syy`, `sxy`, `gradient` are left
        /// out.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub k0: Option<f64> =>
            Range::from(0.0).to(20.0).of(NUMBER).hint("horizontal over vertical stress, 0.3 to 3 is usual")
                .label("Horizontal over vertical stress"),
        /// With `k0`: density (kg/m³) of the rock above; default: that of the only rock, or of the rock without
        /// `region` and `blocks`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub density: Option<f64> => ROCK_DENSITY.hint("rock has 1500 to 3500"),
        /// Horizontal normal stress (Pa).
        pub sxx: Option<f64> => ROCK_STRESS.label("Horizontal stress"),
        /// Vertical normal stress (Pa).
        pub syy: Option<f64> => ROCK_STRESS.label("Vertical stress"),
        /// Shear stress (Pa).
        pub sxy: f64 => STRESS.hint("tension is positive, compression negative"),
        /// Change of the three with height (Pa/m).
        pub gradient: [f64; 3] => SLOPE,
        /// Height (m) at which the values hold; with `k0` that of the ground surface, without stress, and by default
        /// the highest point of the outline.
        pub y_reference: Option<f64> => HEIGHT.hint("a height of the model").label("Height of reference"),
        /// Normal stress out of the plane (Pa) at that height, for rock that yields in plane strain; default: Poisson's
        /// ratio times (sxx + syy), whatever the height.
        pub szz: Option<f64> => ROCK_STRESS,
        /// Change of `szz` with height (Pa/m).
        pub szz_gradient: f64 => SLOPE,
    }
}
