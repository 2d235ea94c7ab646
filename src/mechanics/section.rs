//! Sections through blocks: what rock carries across them, by the forces on its covers, and the share of its strength
//! that this is (theory §13).

use crate::geometry::{Point, Vector};

use super::Elasticity;

/// Strength in bending of a beam over its tensile strength, less 1: 1/(0.85 + 2.3 l/l_ch) (Eq. 22g).
const BENDING: [f64; 2] = [0.85, 2.3];
/// Speed of a crack over that of Rayleigh waves.
const CRACK_SPEED: f64 = 0.4;

/// Strength in bending over tensile strength of a section of a length (m), in rock of a characteristic length (m); 0
/// of brittle rock (Eq. 22g).
pub fn bending_strength(length: f64, characteristic: f64) -> f64 {
    if characteristic > 0.0 { 1.0 + 1.0 / (BENDING[0] + BENDING[1] * length / characteristic) } else { 1.0 }
}

/// Time (s) that a crack takes across a section of a length (m) (Eq. 22h).
pub fn crack_time(length: f64, rock: &Elasticity) -> f64 {
    length / (CRACK_SPEED * rayleigh(rock))
}

/// Speed (m/s) of Rayleigh waves, within 0.5 % (Viktorov 1967).
fn rayleigh(rock: &Elasticity) -> f64 {
    let poisson = 0.5 * rock.lambda / (rock.lambda + rock.mu);
    rock.shear_wave_speed() * (0.87 + 1.12 * poisson) / (1.0 + poisson)
}

/// Strength of intact rock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RockStrength {
    /// Tensile strength (Pa).
    pub tension: f64,
    /// Cohesion (Pa).
    pub cohesion: f64,
    /// tan φ.
    pub friction: f64,
    /// Characteristic length E'·G_I/σt² (m); 0 of brittle rock.
    pub characteristic: f64,
}

/// How a section fails.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum SectionFailure {
    /// Its outermost fibre has the tensile strength, by tension more than by bending.
    #[default]
    Opens,
    /// It has its strength in shear.
    Slides,
    /// Its outermost fibre has the tensile strength, by bending more than by tension.
    Bends,
    /// A core of its block has the tensile strength.
    Splits,
}

/// What rock carries across a section.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Resultants {
    /// Normal force (N/m), tension positive.
    pub normal: f64,
    /// Shear force (N/m).
    pub shear: f64,
    /// Bending moment about the middle (N).
    pub moment: f64,
}

impl Resultants {
    /// The share of its strength that a section of a length (m) has, and how it fails at 1 (Eq. 32c).
    pub fn share(&self, length: f64, rock: &RockStrength) -> (f64, SectionFailure) {
        let RockStrength { tension, cohesion, friction, characteristic } = *rock;
        let bending = 6.0 * self.moment.abs() / (bending_strength(length, characteristic) * length * length);
        let stretch = self.normal / length;
        let opens = (stretch + bending) / tension;
        // The shear strength ends where the tensile strength does, so that what has none left opens first.
        let pressure = if self.normal <= 0.0 { -self.normal * friction } else { -self.normal * cohesion / tension };
        let strength = cohesion * length + pressure;
        let slides = if strength > 0.0 { self.shear.abs() / strength } else { 0.0 };
        if slides > opens {
            (slides, SectionFailure::Slides)
        } else {
            (opens, if bending > stretch { SectionFailure::Bends } else { SectionFailure::Opens })
        }
    }
}

/// A cover of which a share of the mass lies on one side of a section.
#[derive(Debug, Clone, Copy)]
pub struct CoverPart {
    /// The share.
    pub share: f64,
    /// Place of the star (m).
    pub star: Point,
    /// That share of the way (m) from the star to the centroid of this mass.
    pub arm: Vector,
    /// Force (N/m) on the cover, without what acts by mass.
    pub force: Vector,
}

/// A section at its current place.
#[derive(Debug, Clone, Copy)]
pub struct SectionCut {
    /// Its ends (m).
    pub ends: [Point; 2],
}

impl SectionCut {
    /// What it carries (Eq. 32b), from the part of a block to its left: its covers, and places (m) and forces (N/m) of
    /// what acts on it at points.
    pub fn resultants(
        &self,
        covers: impl Iterator<Item = CoverPart>,
        points: impl Iterator<Item = (Point, Vector)>,
    ) -> Resultants {
        let [from, to] = self.ends;
        let middle = (from + to) * 0.5;
        let (mut force, mut moment) = (Vector::zeros(), 0.0);
        for CoverPart { share, star, arm, force: on_cover } in covers {
            force += on_cover * share;
            moment += ((star - middle) * share + arm).perp(&on_cover);
        }
        for (at, of_point) in points {
            force -= of_point;
            moment -= (at - middle).perp(&of_point);
        }
        let along = (to - from).normalize();
        let across = Vector::new(-along.y, along.x);
        Resultants { normal: -force.dot(&across), shear: force.dot(&along), moment }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROCK: RockStrength = RockStrength { tension: 5e6, cohesion: 15e6, friction: 1.0, characteristic: 0.0 };

    #[test]
    fn a_section_fails_at_its_tensile_and_shear_strength() {
        let of = |normal, shear, moment| Resultants { normal, shear, moment }.share(2.0, &ROCK);
        assert_eq!(of(1e7, 0.0, 0.0), (1.0, SectionFailure::Opens));
        assert_eq!(of(-2e6, 0.0, 4e6), (1.0, SectionFailure::Bends));
        assert_eq!(of(-2e6, -32e6, 0.0), (1.0, SectionFailure::Slides));
        assert_eq!(of(0.0, 30e6, 0.0), (1.0, SectionFailure::Slides));
        assert!(of(1e7 + 1.0, 1e9, 0.0).0 > 1.0);
    }

    #[test]
    fn tough_rock_is_stronger_in_bending_by_the_formula_for_beams() {
        let strengths = [0.84, 4.4].map(|ratio| bending_strength(1.0, ratio));
        assert!((strengths[0] - 1.2787).abs() < 1e-3 && (strengths[1] - 1.7285).abs() < 2e-3, "{strengths:?}");
        assert_eq!(bending_strength(1.0, 0.0), 1.0);
    }

    #[test]
    fn a_part_in_balance_gives_its_weight_to_the_section() {
        // Two covers, of which one and a half weigh 3 N/m; a force of 5 N/m presses down on the part.
        let cut = SectionCut { ends: [Point::new(1.0, 1.0), Point::new(-1.0, 1.0)] };
        let force = Vector::new(0.0, 2.0);
        let part = |share, x, arm| CoverPart { share, star: Point::new(x, 0.0), arm: Vector::new(arm, 0.0), force };
        let covers = [part(1.0, 0.5, 0.0), part(0.5, -0.5, 0.125)];
        let point = (Point::new(0.25, 0.0), Vector::new(0.0, -5.0));
        let found = cut.resultants(covers.into_iter(), [point].into_iter());
        assert_eq!(found, Resultants { normal: 8.0, shear: 0.0, moment: 0.5 * 2.0 - 0.25 * 1.0 + 0.25 * 5.0 });
    }
}
