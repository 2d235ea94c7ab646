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
    /// Height of the slope (m), that of the model, for the equivalent strength.
    pub height: f64,
    /// Greatest of the least principal stresses (Pa, compression) that the equivalent strength is for; without gravity
    /// a quarter of σci.
    pub minor_max: f64,
    /// Cohesion (Pa) and friction angle (degrees) that fit the envelope from the tensile strength to that stress.
    pub cohesion: f64,
    /// Its friction angle (degrees).
    pub friction_deg: f64,
}

/// Share of σci up to which an envelope is fitted where no slope gives a stress.
const MINOR_MAX: f64 = 0.25;

/// The rock masses of a case.
pub fn rock_masses(case: &Case) -> Vec<RockMass> {
    let outline: Vec<Point> = case.domain.outline.iter().copied().map(Point::from).collect();
    let (low, high) = polygon::bounds(&outline);
    let height = (high - low).y;
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
