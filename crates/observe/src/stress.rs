//! Numbers of the stress in the plane.

use enmm::model::Quantity;
pub use enmm::model::stress::{Stress, max_shear, mean, principal};

/// Numbers of a stress as outputs show them.
pub const STRESS_QUANTITIES: [Quantity<Stress>; 7] = [
    stress("stress_xx", "Stress xx", |&[xx, _, _]| xx),
    stress("stress_yy", "Stress yy", |&[_, yy, _]| yy),
    stress("stress_xy", "Stress xy", |&[_, _, xy]| xy),
    stress("principal_max", "Greatest principal stress in the plane", |stress| principal(stress)[0]),
    stress("principal_min", "Least principal stress in the plane: the greatest compression", |stress| {
        principal(stress)[1]
    }),
    stress("mean_stress", "Mean of xx and yy", mean),
    stress("max_shear", "Greatest shear stress in the plane", max_shear),
];

const fn stress(name: &'static str, text: &'static str, get: fn(&Stress) -> f64) -> Quantity<Stress> {
    Quantity::plain(name, "Pa", text, get)
}
