//! Stress of a case before its first stage.

use serde::{Deserialize, Serialize};

/// Stress before the first stage (Pa, tension positive): value + gradient·(y − y_reference), or `k0`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct InSitu {
    /// Horizontal over vertical stress, at least 0 and at most 20. The vertical stress is then that of the rock above,
    /// −density·9.81·(y_reference − y) with the gravity of the case, and `sxx`, `syy`, `sxy`, `gradient` are left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub k0: Option<f64>,
    /// With `k0`: density (kg/m³) of the rock above, at least 0.001 and at most 1e6; default: that of the only rock, or
    /// of the rock without `region` and `blocks`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
    /// Horizontal normal stress (Pa).
    #[serde(default)]
    pub sxx: Option<f64>,
    /// Vertical normal stress (Pa).
    #[serde(default)]
    pub syy: Option<f64>,
    /// Shear stress (Pa).
    #[serde(default)]
    pub sxy: f64,
    /// Change of the three with height (Pa/m).
    #[serde(default)]
    pub gradient: [f64; 3],
    /// Height (m) at which the values hold; with `k0` that of the ground surface, without stress, and by default the
    /// highest point of the outline.
    #[serde(default)]
    pub y_reference: Option<f64>,
    /// Normal stress out of the plane (Pa) at that height, for rock that yields in plane strain; default: Poisson's
    /// ratio times (sxx + syy), whatever the height.
    #[serde(default)]
    pub szz: Option<f64>,
    /// Change of `szz` with height (Pa/m).
    #[serde(default)]
    pub szz_gradient: f64,
}
