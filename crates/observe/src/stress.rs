//! Numbers of the stress in the plane.

use enmm::model::Quantity;

/// Stress xx, yy, xy (Pa, tension positive) of an element.
pub type Stress = [f64; 3];

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

/// Mean of the stresses xx and yy (Pa).
pub fn mean(&[xx, yy, _]: &Stress) -> f64 {
    0.5 * (xx + yy)
}

/// Greatest shear stress in the plane (Pa): √(((xx − yy)/2)² + xy²).
pub fn max_shear(&[xx, yy, xy]: &Stress) -> f64 {
    libm::hypot(0.5 * (xx - yy), xy)
}

/// The greatest and the least principal stress in the plane (Pa).
pub fn principal(stress: &Stress) -> [f64; 2] {
    let (mean, radius) = (mean(stress), max_shear(stress));
    [mean + radius, mean - radius]
}
