//! The strength of rock as straight lines in the plane of normal and shear stress, all of which hold: one of
//! Mohr–Coulomb; along the envelope of Hoek–Brown rock chords, which hold less than it, or tangents, which hold more.

use enmm::model::case::{Envelope, Rock, Tangent};

use super::ground::Strength;
use super::search::Proof;

/// Lines along an envelope, the horizontal one at the end of the chords not counted.
const LINES: i32 = 8;
/// Distance of a point of the envelope from its tensile strength over that of the point before.
const RATIO: f64 = 2.0;
/// Halvings that find a point of an envelope to rounding.
const HALVINGS: usize = 200;

/// Strengths of a rock in a unit of stress (Pa), none when it never yields. For equilibrium they are no more than the
/// rock has, for a mechanism no less; between the tensile strength and `greatest` (Pa) they are close to it.
pub fn strengths(rock: &Rock, proof: Proof, greatest: f64, unit: f64) -> Vec<Strength> {
    if !rock.yields() {
        return Vec::new();
    }
    let lines = match &rock.hoek_brown {
        Some(mass) => along(&mass.envelope(), proof, greatest),
        None => {
            let friction = libm::tan(rock.friction_deg.unwrap_or_default().to_radians());
            vec![(friction, rock.cohesion.unwrap_or_default())]
        }
    };
    // The first line has the tensile strength: it reaches farthest into tension.
    let tension = |k| rock.tension.filter(|_| k == 0).map(|tension| tension / unit);
    let strength = |(k, (friction, cohesion))| Strength { friction, cohesion: cohesion / unit, tension: tension(k) };
    lines.into_iter().enumerate().map(strength).collect()
}

/// Tangent of the friction angle and cohesion (Pa) of lines along an envelope.
fn along(envelope: &Envelope, proof: Proof, greatest: f64) -> Vec<(f64, f64)> {
    let end = envelope.tension();
    let distance = |k: i32| (greatest + end) * libm::pow(RATIO, f64::from(k - LINES + 1));
    let points: Vec<Tangent> = (0..LINES).map(|k| point(envelope, distance(k) - end)).collect();
    let line = |at: &Tangent, friction: f64| (friction, at.shear - at.normal * friction);
    if proof == Proof::Mechanism {
        return points.iter().map(|at| line(at, at.friction)).collect();
    }
    let mut before = envelope.tangent(0.0);
    let mut chords = Vec::new();
    for at in points {
        chords.push(line(&at, (at.shear - before.shear) / (at.normal - before.normal)));
        before = at;
    }
    chords.push(line(&before, 0.0));
    chords
}

/// The point of an envelope at a normal stress (Pa), compression positive, above its tensile strength.
fn point(envelope: &Envelope, normal: f64) -> Tangent {
    let (mut low, mut high) = (0.0, 1.0);
    while envelope.tangent(high).normal < normal {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if envelope.tangent(middle).normal < normal { low = middle } else { high = middle }
    }
    envelope.tangent(high)
}

#[cfg(test)]
mod tests {
    use enmm::model::case::HoekBrown;

    use super::*;

    /// Chords lie within the envelope and tangents outside, wherever the normal stress, and both are within 4 % of it
    /// up to the greatest stress from its 128th part on.
    #[test]
    fn chords_hold_less_and_tangents_more() {
        for gsi in [5.0, 30.0, 75.0, 100.0] {
            for greatest in [1e4, 1e6, 1e8] {
                let envelope = HoekBrown { sigma_ci: 30e6, mi: 8.0, gsi, d: 0.0, associated: false }.envelope();
                let least = |lines: &[(f64, f64)], at: f64| {
                    lines.iter().map(|(friction, cohesion)| cohesion + friction * at).fold(f64::INFINITY, f64::min)
                };
                let [inner, outer] = [Proof::Equilibrium, Proof::Mechanism].map(|p| along(&envelope, p, greatest));
                for k in 0..400 {
                    let normal = (greatest + envelope.tension()) * 1e-4 * 1.03f64.powi(k) - envelope.tension();
                    let shear = point(&envelope, normal).shear;
                    let [low, high] = [&inner, &outer].map(|lines| least(lines, normal) / shear);
                    assert!(low <= 1.0 + 1e-9 && high >= 1.0 - 1e-9, "{gsi} {greatest} {normal}: {low} {high}");
                    if normal < greatest && normal + envelope.tension() > (greatest + envelope.tension()) / 128.0 {
                        assert!(low > 0.96 && high < 1.04, "{gsi} {greatest} {normal}: {low} {high}");
                    }
                }
            }
        }
    }
}
