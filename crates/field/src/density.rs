//! Densities of poles in the net, and strikes in sectors.

use crate::axis::{Axis, cosine};

/// Share of the hemisphere of the counting circle.
pub const CIRCLE: f64 = 0.01;

/// Density of weighted poles at an axis, as the share (%) of all poles in a counting circle of 1 % of the hemisphere:
/// each pole counts with e^(κ·(cos θ − 1)), κ = 100, a Fisher influence that has the content of that circle. Its mean
/// over the hemisphere is 1 %, which poles without any preference have everywhere.
pub fn density(poles: &[(Axis, f64)], at: &Axis) -> f64 {
    let influence = |pole: &Axis| libm::exp((cosine(pole, at).abs() - 1.0) / CIRCLE);
    let (sum, all) =
        poles.iter().fold((0.0, 0.0), |(sum, all), (pole, weight)| (sum + weight * influence(pole), all + weight));
    if all > 0.0 { 100.0 * sum / all } else { 0.0 }
}

/// Shares (of 1) of weighted strikes in sectors of equal angle, from north over east to south: the strike of a plane is
/// the level line in it. Level planes have none and are left out.
pub fn rosette(poles: &[(Axis, f64)], sectors: usize) -> Vec<f64> {
    let mut sums = vec![0.0; sectors];
    for ([east, north, _], weight) in poles {
        if sectors > 0 && libm::hypot(*east, *north) > f64::EPSILON {
            // The strike is a right angle from the horizontal part of the pole.
            let strike = libm::atan2(*north, -*east).to_degrees().rem_euclid(180.0);
            let sector = (strike / 180.0 * sectors as f64) as usize;
            sums[sector % sectors] += weight;
        }
    }
    let all: f64 = sums.iter().sum();
    sums.iter().map(|sum| if all > 0.0 { sum / all } else { 0.0 }).collect()
}
