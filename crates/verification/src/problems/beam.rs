//! Beams of the problems B1 and B2: case text, exact deflections, stresses and frequencies of the plane problem.

use std::f64::consts::PI;

/// Plane stress or plane strain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plane {
    /// No stress across.
    Stress,
    /// No strain across.
    Strain,
}

impl Plane {
    /// Name in a case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stress => "stress",
            Self::Strain => "strain",
        }
    }
}

/// A beam of length L and depth H about the x axis, from x = 0.
#[derive(Debug, Clone, Copy)]
pub struct Beam {
    /// Length (m).
    pub length: f64,
    /// Depth (m).
    pub depth: f64,
    /// Young's modulus (Pa).
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Density (kg/m³).
    pub density: f64,
    /// Plane stress or strain.
    pub plane: Plane,
}

impl Beam {
    /// Head of a case: outline, mesh of `rows` elements over the depth, rock, and gravity (m/s²).
    pub fn text(&self, rows: f64, gravity: f64) -> String {
        let (l, c, h) = (self.length, 0.5 * self.depth, self.depth / rows);
        format!(
            "title = \"Beam\"\n[domain]\noutline = [[0.0, {:e}], [{l:e}, {:e}], [{l:e}, {c:e}], [0.0, {c:e}]]\n[mesh]\n\
             size = {h:e}\norigin = [{:e}, {:e}]\n[rock.rock]\ndensity = {:e}\nyoung = {:e}\npoisson = {:e}\n\
             plane = \"{}\"\n[gravity]\ny = {:e}\n",
            -c,
            -c,
            0.013 * self.depth,
            -0.007 * self.depth,
            self.density,
            self.young,
            self.poisson,
            self.plane.name(),
            // Not −0 without gravity.
            0.0 - gravity,
        )
    }

    /// Young's modulus and Poisson's ratio of the plane-stress problem with the same answer.
    pub fn plane_stress(&self) -> (f64, f64) {
        match self.plane {
            Plane::Strain => (self.young / (1.0 - self.poisson.powi(2)), self.poisson / (1.0 - self.poisson)),
            Plane::Stress => (self.young, self.poisson),
        }
    }

    /// Second moment of area (m³).
    pub fn inertia(&self) -> f64 {
        self.depth.powi(3) / 12.0
    }

    /// Shear modulus (Pa).
    pub fn shear(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }

    /// Deflection (m) of the axis under a uniform load q (Pa) at x (m) from the middle, by Timoshenko and Goodier
    /// (Theory of Elasticity, bending of a beam by uniform load): half span l, half depth c.
    pub fn uniform(&self, q: f64, x: f64) -> f64 {
        self.axis(q, x, 0.8 + 0.5 * self.plane_stress().1)
    }

    /// Deflection (m) of the axis under the own weight q (Pa), x (m) from the middle.
    ///
    /// The weight has the stresses xx and xy of a load on the top, and a stress yy that is q/2·(1 + y/c) higher, so
    /// that both faces are free. The strain −ν/E times that, linear over the depth, bends the axis by νq/2cE: ν/3 more
    /// in the bracket.
    pub fn weight(&self, q: f64, x: f64) -> f64 {
        self.axis(q, x, 0.8 + 5.0 / 6.0 * self.plane_stress().1)
    }

    /// Deflection (m) of the axis under q (Pa) along the beam, x (m) from the middle, with the coefficient of c²/l².
    fn axis(&self, q: f64, x: f64, shear: f64) -> f64 {
        let (young, _) = self.plane_stress();
        let (l, c, i) = (0.5 * self.length, 0.5 * self.depth, self.inertia());
        let middle = 5.0 * q * l.powi(4) / (24.0 * young * i) * (1.0 + 2.4 * c * c / (l * l) * shear);
        middle - q / (2.0 * young * i) * (0.5 * l * l * x * x - x.powi(4) / 12.0 + shear * c * c * x * x)
    }

    /// Stress xx (Pa) under a uniform load q (Pa) on the top, x (m) from the middle and y (m) up from the axis.
    pub fn uniform_stress(&self, q: f64, x: f64, y: f64) -> f64 {
        let (l, c) = (0.5 * self.length, 0.5 * self.depth);
        -q / (2.0 * self.inertia()) * ((l * l - x * x) * y + 2.0 / 3.0 * y.powi(3) - 0.4 * c * c * y)
    }

    /// Deflection (m) of a beam with shear under a force P (N/m) in its middle, x ≤ L/2 (m) from the support.
    pub fn point(&self, p: f64, x: f64) -> f64 {
        let (young, _) = self.plane_stress();
        let bending = p * x / (48.0 * young * self.inertia()) * (3.0 * self.length.powi(2) - 4.0 * x * x);
        bending + 1.2 * p * x / (2.0 * self.shear() * self.depth)
    }

    /// First frequency (Hz) of the slender simply supported beam.
    pub fn slender_supported(&self) -> f64 {
        let (young, _) = self.plane_stress();
        0.5 * PI * (young * self.inertia() / (self.density * self.depth)).sqrt() / self.length.powi(2)
    }

    /// First frequency (Hz) of the exact plane problem of a beam whose ends slide along x: the antisymmetric
    /// Rayleigh–Lamb equation (b² + k²)²·tanh(ad) = 4k²ab·tanh(bd) for the wavelength 2L, by bisection.
    pub fn supported(&self) -> f64 {
        let mu = self.shear();
        let (young, poisson) = self.plane_stress();
        let confined = young / (1.0 - poisson * poisson);
        let (k, d) = (PI / self.length, 0.5 * self.depth);
        let equation = |f: f64| {
            let w = 2.0 * PI * f;
            let a = (k * k - w * w * self.density / confined).sqrt();
            let b = (k * k - w * w * self.density / mu).sqrt();
            (b * b + k * k).powi(2) * (a * d).tanh() - 4.0 * k * k * a * b * (b * d).tanh()
        };
        let (mut low, mut high) = (0.3 * self.slender_supported(), 1.02 * self.slender_supported());
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if equation(low) * equation(middle) <= 0.0 { high = middle } else { low = middle }
        }
        0.5 * (low + high)
    }

    /// First frequency (Hz) of the cantilever, slender, and with the shares of shear and rotary inertia by Rayleigh's
    /// quotient (3.6EI/GAL² and 4.65I/AL², half of each).
    pub fn cantilever(&self) -> [f64; 2] {
        let (young, _) = self.plane_stress();
        let (i, a, l) = (self.inertia(), self.depth, self.length);
        let slender = 1.875104f64.powi(2) / (2.0 * PI) * (young * i / (self.density * a)).sqrt() / (l * l);
        let shear = 0.5 * 3.6 * young * i / (self.shear() * a * l * l);
        [slender, slender * (1.0 - shear - 0.5 * 4.65 * i / (a * l * l))]
    }

    /// First axial frequency (Hz) of the free bar: slender, and with its lateral inertia.
    pub fn axial(&self) -> [f64; 2] {
        let (young, poisson) = self.plane_stress();
        let slender = (young / self.density).sqrt() / (2.0 * self.length);
        let k = PI / self.length;
        [slender, slender * (1.0 - 0.5 * (poisson * k).powi(2) * self.inertia() / self.depth)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_give_the_published_numbers() {
        let mut beam =
            Beam { length: 10.0, depth: 1.0, young: 1e9, poisson: 0.25, density: 2500.0, plane: Plane::Stress };
        assert!((beam.uniform(1e4, 0.0) - 15.97188e-3).abs() < 1e-8);
        assert!((beam.point(1e5, 5.0) - 25.75e-3).abs() < 1e-9);
        assert!((beam.slender_supported() - 2.867869).abs() < 1e-6);
        assert!((beam.cantilever()[0] - 1.021669).abs() < 1e-6);
        assert!((beam.axial()[0] - 31.6228).abs() < 1e-4);
        assert!((beam.supported() / beam.slender_supported() - 0.984).abs() < 2e-3);
        beam.plane = Plane::Strain;
        assert!((beam.uniform(1e4, 0.0) - 14.98828e-3).abs() < 1e-8);
        beam.young = 1e10;
        assert!((beam.weight(2500.0 * 9.81, 0.0) - 3.685456e-3).abs() < 1e-9);
    }
}
