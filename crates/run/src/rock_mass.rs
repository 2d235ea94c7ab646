//! Strength of rock that yields by Hoek–Brown, as `enmm check` and reports state it.

use serde::Serialize;

use enmm::geometry::{Point, polygon};
use enmm::model::case::{Case, Envelope, Equivalent, Rock};

/// Strength of a rock mass, and Mohr–Coulomb strength for the stresses of the slope (E. Hoek, C. Carranza-Torres and B.
/// Corkum 2002).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RockMass {
    /// Name of the rock.
    pub rock: String,
    /// Constant mb.
    pub mb: f64,
    /// Constant s.
    pub s: f64,
    /// Exponent.
    pub a: f64,
    /// Uniaxial compressive strength (Pa).
    pub compression: f64,
    /// Tensile strength (Pa): the end of the envelope, or `tension` of the case if that is less.
    pub tension: f64,
    /// Height of the slope (m) for the equivalent strength: from the lowest to the highest ground, or that of a model
    /// with level ground.
    pub height: f64,
    /// Greatest of the least principal stresses (Pa, compression) that the equivalent strength is for; without gravity
    /// a quarter of σci.
    pub minor_max: f64,
    /// Cohesion (Pa) and friction angle (degrees) that fit the envelope from the tensile strength to that stress.
    pub cohesion: f64,
    /// Its friction angle (degrees).
    pub friction_deg: f64,
}

/// Difference in height of level ground, relative to the height of the model.
const LEVEL: f64 = 1e-3;
/// Share of σci up to which an envelope is fitted where no slope gives a stress.
const MINOR_MAX: f64 = 0.25;

/// From the lowest to the highest ground of an outline (m), or its whole height where the ground is level.
fn slope_height(outline: &[Point]) -> f64 {
    let sides = || (0..outline.len()).map(|k| [outline[k], outline[(k + 1) % outline.len()]]);
    let at = |x: f64, [a, b]: [Point; 2]| {
        let within = a.x.min(b.x) <= x && x <= a.x.max(b.x);
        let y = if a.x == b.x { a.y.max(b.y) } else { a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x) };
        within.then_some(y)
    };
    let ground = |x: f64| sides().filter_map(|side| at(x, side)).fold(f64::NEG_INFINITY, f64::max);
    let tops = outline.iter().map(|p| ground(p.x));
    let [low, high] = tops.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| [low.min(y), high.max(y)]);
    let (bottom, top) = polygon::bounds(outline);
    let is_level = high - low <= LEVEL * (top - bottom).y;
    if is_level { (top - bottom).y } else { high - low }
}

/// The rock masses of a case.
pub fn rock_masses(case: &Case) -> Vec<RockMass> {
    let outline: Vec<Point> = case.domain.outline.iter().copied().map(Point::from).collect();
    let height = slope_height(&outline);
    let gravity = libm::hypot(case.gravity.x, case.gravity.y);
    let mass = |(name, rock): (&String, &Rock)| {
        let envelope = rock.hoek_brown?.envelope();
        let weight = rock.density * gravity;
        let minor_max = match weight * height > 0.0 {
            true => envelope.greatest_minor(weight, height),
            false => MINOR_MAX * envelope.sigma_ci,
        };
        let Envelope { mb, s, a, .. } = envelope;
        let Equivalent { cohesion, sin_friction } = envelope.equivalent(minor_max);
        Some(RockMass {
            rock: name.clone(),
            mb,
            s,
            a,
            compression: envelope.compression(),
            tension: rock.tension.unwrap_or(envelope.tension()),
            height,
            minor_max,
            cohesion,
            friction_deg: libm::asin(sin_friction).to_degrees(),
        })
    };
    case.rocks.iter().filter_map(mass).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn height(points: &[[f64; 2]]) -> f64 {
        slope_height(&points.iter().copied().map(Point::from).collect::<Vec<_>>())
    }

    /// The ground decides, not the depth of the model: a slope on its foot, on a foundation, a pit, level ground.
    #[test]
    fn the_height_is_that_of_the_ground() {
        assert_eq!(height(&[[0.0, 0.0], [32.0, 0.0], [12.0, 10.0], [0.0, 10.0]]), 10.0);
        assert_eq!(height(&[[0.0, 0.0], [40.0, 0.0], [40.0, 10.0], [30.0, 10.0], [20.0, 20.0], [0.0, 20.0]]), 10.0);
        assert_eq!(height(&[[0.0, 0.0], [9.0, 0.0], [9.0, 8.0], [6.0, 8.0], [5.0, 3.0], [4.0, 7.0], [0.0, 7.0]]), 5.0);
        assert_eq!(height(&[[0.0, 0.0], [9.0, 0.0], [9.0, 8.0], [0.0, 8.0]]), 8.0);
    }
}
