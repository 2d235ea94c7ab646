//! Fisher's distribution of directions: f(θ) = κ/(4π·sinh κ)·e^(κ·cos θ) about a mean (R. A. Fisher, Dispersion on a
//! sphere, 1953).

use crate::axis::{Axis, cosine, principal};

/// Share of means that lie outside the cone of confidence.
const OUTSIDE: f64 = 0.05;
/// Greatest concentration: parallel poles, as a table in whole degrees can have, have no scatter to be measured.
const KAPPA_MAX: f64 = 1e6;

/// Mean and scatter of poles that count as directions once they point to one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fisher {
    /// Mean pole.
    pub mean: Axis,
    /// Number of poles.
    pub count: usize,
    /// Sum of the weights.
    pub weight: f64,
    /// Concentration κ = (n − 1)/(n − R), at most 1e6.
    pub kappa: f64,
    /// Half the angle (degrees) of the cone about the mean in which the true mean is with 95 % confidence; 180 where
    /// the poles are too few for a cone.
    pub cone_deg: f64,
}

impl Fisher {
    /// Mean and scatter of weighted poles: the mean is along the resultant R of the poles once each points to the side
    /// of the principal axis of them all. Weights count for R in proportion; n is their number for κ, and for the cone
    /// the number (Σw)²/Σw² of equal ones with as much information. None without poles.
    pub fn of(poles: &[(Axis, f64)]) -> Option<Self> {
        let weight: f64 = poles.iter().map(|(_, weight)| weight).sum();
        if poles.is_empty() || weight <= 0.0 {
            return None;
        }
        let axis = principal(poles.iter().map(|(pole, weight)| (pole, *weight)));
        let mut sum = [0.0; 3];
        for (pole, weight) in poles {
            let sign = if cosine(pole, &axis) < 0.0 { -weight } else { *weight };
            (0..3).for_each(|k| sum[k] += sign * pole[k]);
        }
        let length = cosine(&sum, &sum).sqrt();
        let mean = if length > 0.0 { sum.map(|part| part / length) } else { axis };
        let share = (length / weight).min(1.0);
        let squares: f64 = poles.iter().map(|(_, weight)| weight * weight).sum();
        let (count, effective) = (poles.len() as f64, weight * weight / squares);
        let kappa = if count > 1.0 { ((count - 1.0) / (count * (1.0 - share))).min(KAPPA_MAX) } else { 0.0 };
        Some(Self { mean, count: poles.len(), weight, kappa, cone_deg: cone(effective, share) })
    }

    /// Half the angle (degrees) of the cone about the mean that holds a share of all poles.
    pub fn cone_of(&self, share: f64) -> f64 {
        // 1 − cos θ = −ln(1 − share·(1 − e^(−2κ)))/κ.
        let versine = -libm::log1p(share * libm::expm1(-2.0 * self.kappa)) / self.kappa;
        libm::acos((1.0 - versine).clamp(-1.0, 1.0)).to_degrees()
    }

    /// Logarithm of the density of an axis (per steradian of a hemisphere) at a cosine from the mean.
    pub fn log_density(&self, cosine: f64) -> f64 {
        let kappa = self.kappa.max(f64::MIN_POSITIVE);
        // Both directions of the axis: 2·κ/(4π·sinh κ)·cosh(κ·cos θ), written so that nothing overflows.
        let both = libm::log1p(libm::exp(-2.0 * kappa * cosine.abs()));
        let rest = -libm::log(-libm::expm1(-2.0 * kappa));
        libm::log(kappa / (2.0 * std::f64::consts::PI)) + kappa * (cosine.abs() - 1.0) + both + rest
    }
}

/// Half the angle of the cone of confidence (degrees): cos α = 1 − (n − R)/R·((1/0.05)^(1/(n − 1)) − 1), by Fisher.
fn cone(count: f64, share: f64) -> f64 {
    if count <= 1.0 || share <= 0.0 {
        return 180.0;
    }
    let grows = libm::pow(1.0 / OUTSIDE, 1.0 / (count - 1.0)) - 1.0;
    let cosine = 1.0 - (1.0 - share) / share * grows;
    libm::acos(cosine.clamp(-1.0, 1.0)).to_degrees()
}
