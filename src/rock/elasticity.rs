//! Linear elastic constants in the plane, wave speeds, and the critical time step (Eq. 9).

/// Elastic constants and density of one rock in the plane.
#[doc(alias = "Hooke")]
#[doc(alias = "Lame constants")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elasticity {
    /// First Lamé constant of the plane problem (Pa).
    pub lambda: f64,
    /// Shear modulus (Pa).
    pub mu: f64,
    /// Density (kg/m³).
    pub density: f64,
}

impl Elasticity {
    /// Plane strain from Young's modulus (Pa) and Poisson's ratio.
    pub fn plane_strain(young: f64, poisson: f64, density: f64) -> Self {
        let lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
        Self { lambda, mu: young / (2.0 * (1.0 + poisson)), density }
    }

    /// Plane stress from Young's modulus (Pa) and Poisson's ratio.
    pub fn plane_stress(young: f64, poisson: f64, density: f64) -> Self {
        let lambda = young * poisson / (1.0 - poisson * poisson);
        Self { lambda, mu: young / (2.0 * (1.0 + poisson)), density }
    }

    /// Lamé's constants λ and μ (Pa).
    pub fn constants(&self) -> [f64; 2] {
        [self.lambda, self.mu]
    }

    /// Confined modulus λ + 2μ (Pa).
    pub fn confined_modulus(&self) -> f64 {
        self.lambda + 2.0 * self.mu
    }

    /// Modulus E/(1 − ν²) (Pa) of plane strain, or E of plane stress.
    pub fn plane_modulus(&self) -> f64 {
        4.0 * self.mu * (self.lambda + self.mu) / (self.lambda + 2.0 * self.mu)
    }

    /// ρ·cp and ρ·cs (Pa·s/m): stress of a plane wave over its particle velocity.
    pub fn impedances(&self) -> [f64; 2] {
        [self.confined_modulus(), self.mu].map(|modulus| (modulus * self.density).sqrt())
    }

    /// Speed of shear waves (m/s).
    pub fn shear_wave_speed(&self) -> f64 {
        (self.mu / self.density).sqrt()
    }
}

/// Stable step (s) of an equilateral mesh of side `size` (m) with equal-thirds mass (Eq. 9).
pub fn critical_dt(size: f64, rock: &Elasticity) -> f64 {
    size * (rock.density / (3.0 * (rock.lambda + rock.mu).max(rock.mu))).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_follow_from_young_and_poisson() {
        let strain = Elasticity::plane_strain(1e9, 0.25, 2500.0);
        assert!((strain.lambda - 0.4e9).abs() < 1.0 && (strain.mu - 0.4e9).abs() < 1.0);
        let stress = Elasticity::plane_stress(1e9, 0.25, 2500.0);
        assert!((stress.confined_modulus() - 1e9 / (1.0 - 0.0625)).abs() < 1.0);
        assert!((critical_dt(1.0, &strain) - (2500.0f64 / 2.4e9).sqrt()).abs() < 1e-12);
    }
}
