//! Generalized Hoek–Brown strength of a rock mass: E. Hoek, C. Carranza-Torres and B. Corkum (2002), with the same
//! constants in E. Hoek and E. T. Brown (2019).

use crate::keys::unit::{NUMBER, PASCAL};
use crate::keys::{Range, keys};

keys! {
    /// Generalized Hoek–Brown strength of a rock mass.
    #[derive(Copy)]
    pub struct HoekBrown {
        /// Uniaxial compressive strength of intact rock (Pa).
        pub sigma_ci: f64 =>
            Range::from(1e4).to(1e10).of(PASCAL).hint("intact rock has 5e6 to 3e8")
                .usual([5e5, 5e8], "rock has 5e6 to 3e8 Pa").example(50e6).label("Hoek–Brown σci"),
        /// Constant of intact rock.
        pub mi: f64 => Range::from(1.0).to(50.0).of(NUMBER).hint("intact rock has 4 to 35").example(10.0).label("mi"),
        /// Geological strength index.
        pub gsi: f64 =>
            Range::from(1.0).to(100.0).of(NUMBER).hint("rock masses have 10 to 90").example(45.0).label("GSI"),
        /// Disturbance by blasting and stress relief.
        #[serde(default)]
        pub d: f64 =>
            Range::from(0.0).to(1.0).of(NUMBER).hint("0 for undisturbed rock, 1 for heavy blasting").label("D"),
        /// Whether the rock dilates by its friction angle at each stress (associated flow), instead of `dilation_deg`.
        #[serde(default)]
        pub associated: bool,
    }
}

/// Strength of a rock mass between its principal stresses, compression positive:
/// σ₁ = σ₃ + σci·(mb·σ₃/σci + s)^a.
///
/// Points of it are found by v = (σ₁ − σ₃)/σci, which is 0 at the tensile strength and grows with σ₃ without end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Envelope {
    /// Uniaxial compressive strength of intact rock (Pa).
    pub sigma_ci: f64,
    /// Constant mb of the rock mass.
    pub mb: f64,
    /// Constant s of the rock mass.
    pub s: f64,
    /// Exponent.
    pub a: f64,
}

/// Shear strength on the plane that fails, and how it changes with the normal stress: a point of the envelope of the
/// circles of Mohr with its tangent.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tangent {
    /// Normal stress (Pa), compression positive.
    pub normal: f64,
    /// Shear strength (Pa).
    pub shear: f64,
    /// Tangent of the friction angle there; infinite at the tensile strength.
    pub friction: f64,
}

/// Mohr–Coulomb strength in place of an envelope, for a range of σ₃.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equivalent {
    /// Cohesion (Pa).
    pub cohesion: f64,
    /// Sine of the friction angle.
    pub sin_friction: f64,
}

impl HoekBrown {
    /// The strength of the rock mass.
    pub fn envelope(&self) -> Envelope {
        let off = self.gsi - 100.0;
        Envelope {
            sigma_ci: self.sigma_ci,
            mb: self.mi * libm::exp(off / (28.0 - 14.0 * self.d)),
            s: libm::exp(off / (9.0 - 3.0 * self.d)),
            a: 0.5 + (libm::exp(-self.gsi / 15.0) - libm::exp(-20.0 / 3.0)) / 6.0,
        }
    }
}

impl Envelope {
    /// Tensile strength (Pa), where the envelope ends.
    pub fn tension(&self) -> f64 {
        self.s * self.sigma_ci / self.mb
    }

    /// Uniaxial compressive strength of the rock mass (Pa).
    pub fn compression(&self) -> f64 {
        self.sigma_ci * libm::pow(self.s, self.a)
    }

    /// σ₁ (Pa) at σ₃ (Pa), compression positive; none below the tensile strength.
    pub fn major(&self, minor: f64) -> Option<f64> {
        let base = self.mb * minor / self.sigma_ci + self.s;
        (base >= 0.0).then(|| minor + self.sigma_ci * libm::pow(base, self.a))
    }

    /// The v at σ₃ (Pa); 0 below the tensile strength.
    pub fn place(&self, minor: f64) -> f64 {
        libm::pow((self.mb * minor / self.sigma_ci + self.s).max(0.0), self.a)
    }

    /// Shear strength and its tangent at a v (G. Balmer 1952).
    pub fn tangent(&self, v: f64) -> Tangent {
        if v <= 0.0 {
            return Tangent { normal: -self.tension(), shear: 0.0, friction: f64::INFINITY };
        }
        let base = libm::pow(v, 1.0 / self.a);
        let minor = (base - self.s) / self.mb * self.sigma_ci;
        // dσ₁/dσ₃ less 1, and σ₁ − σ₃.
        let (steep, difference) = (self.a * self.mb * v / base, v * self.sigma_ci);
        let root = (1.0 + steep).sqrt();
        Tangent {
            normal: minor + difference / (2.0 + steep),
            shear: difference * root / (2.0 + steep),
            friction: 0.5 * steep / root,
        }
    }

    /// Shear strength and its tangent without confining pressure.
    pub fn unconfined(&self) -> Tangent {
        self.tangent(self.place(0.0))
    }

    /// Global strength of the rock mass (Pa), by which the stress range of slopes goes.
    pub fn global_strength(&self) -> f64 {
        let Self { sigma_ci, mb, s, a } = *self;
        let mean = (mb + 4.0 * s - a * (mb - 8.0 * s)) * libm::pow(0.25 * mb + s, a - 1.0);
        sigma_ci * mean / (2.0 * (1.0 + a) * (2.0 + a))
    }

    /// Greatest σ₃ (Pa) in a slope of a height (m) and a unit weight (N/m³).
    pub fn greatest_minor(&self, weight: f64, height: f64) -> f64 {
        let global = self.global_strength();
        0.72 * global * libm::pow(global / (weight * height), -0.91)
    }

    /// Mohr–Coulomb strength that fits the envelope from the tensile strength to a greatest σ₃ (Pa).
    pub fn equivalent(&self, greatest: f64) -> Equivalent {
        let Self { sigma_ci, mb, s, a } = *self;
        let pressed = mb * greatest / sigma_ci;
        let (areas, power) = ((1.0 + a) * (2.0 + a), libm::pow(s + pressed, a - 1.0));
        let rise = 6.0 * a * mb * power;
        Equivalent {
            cohesion: sigma_ci * ((1.0 + 2.0 * a) * s + (1.0 - a) * pressed) * power
                / (areas * (1.0 + rise / areas).sqrt()),
            sin_friction: rise / (2.0 * areas + rise),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn masses() -> impl Iterator<Item = Envelope> {
        let gsi = [1.0, 5.0, 10.0, 30.0, 50.0, 75.0, 100.0];
        gsi.into_iter().flat_map(|gsi| {
            [1.0, 2.0, 10.0, 35.0, 50.0].into_iter().flat_map(move |mi| {
                let of = move |d| HoekBrown { sigma_ci: 30e6, mi, gsi, d, associated: false }.envelope();
                [0.0, 0.5, 1.0].map(of)
            })
        })
    }

    /// mb = 10·e^(−55/28), s = e^(−55/9) and a = ½ + (e^−3 − e^(−20/3))/6 for mi 10, GSI 45 and D 0.
    #[test]
    fn constants_are_those_of_the_formulas() {
        let mass = HoekBrown { sigma_ci: 50e6, mi: 10.0, gsi: 45.0, d: 0.0, associated: false }.envelope();
        let (mb, s, a) = (1.402_561, 2.218_085e-3, 0.508_086);
        assert!((mass.mb / mb - 1.0).abs() < 1e-4 && (mass.s / s - 1.0).abs() < 1e-4, "{mass:?}");
        assert!((mass.a - a).abs() < 1e-6, "{mass:?}");
        assert!((mass.compression() / mass.major(0.0).unwrap() - 1.0).abs() < 1e-14);
        assert!(mass.major(-1.001 * mass.tension()).is_none());
    }

    /// The circle of a point touches the envelope there: shear and normal stress of the tangent lie on the circle, and
    /// the tangent is that of neighbouring points.
    #[test]
    fn tangents_touch_the_circles() {
        for mass in masses() {
            for k in 0..60 {
                let v = 1e-4 * 1.3f64.powi(k);
                let at = mass.tangent(v);
                let minor = (libm::pow(v, 1.0 / mass.a) - mass.s) / mass.mb * mass.sigma_ci;
                let major = mass.major(minor).unwrap_or(f64::NAN);
                let (centre, radius) = (0.5 * (minor + major), 0.5 * (major - minor));
                let distance = (at.normal - centre).hypot(at.shear);
                assert!((distance / radius - 1.0).abs() < 1e-9, "{mass:?} {v}");
                let (below, above) = (mass.tangent(v * (1.0 - 1e-5)), mass.tangent(v * (1.0 + 1e-5)));
                let slope = (above.shear - below.shear) / (above.normal - below.normal);
                assert!((slope / at.friction - 1.0).abs() < 1e-3, "{mass:?} {v}: {slope} {}", at.friction);
            }
        }
    }

    /// Whatever the factor on the shear strength, the circles that touch the envelope move on with v, so that one
    /// circle belongs to each centre.
    #[test]
    fn centres_of_circles_grow_with_v() {
        for mass in masses() {
            for factor in [1e-3, 0.1, 0.5, 1.0, 2.0, 10.0, 1e3] {
                let centre = |v: f64| {
                    let at = mass.tangent(v);
                    at.normal + mass.tension() + factor * factor * at.shear * at.friction
                };
                let mut last = 0.0;
                for k in 0..400 {
                    let now = centre(1e-5 * 1.04f64.powi(k));
                    assert!(now > last, "{mass:?} {factor} {k}");
                    last = now;
                }
            }
        }
    }

    /// The equivalent strength balances the areas between the straight line and the curve over its range.
    #[test]
    fn the_equivalent_line_leaves_as_much_above_as_below() {
        for mass in masses() {
            let (low, high) = (-mass.tension(), mass.greatest_minor(26e3, 50.0));
            let Equivalent { cohesion, sin_friction } = mass.equivalent(high);
            let cosine = (1.0 - sin_friction * sin_friction).sqrt();
            let line = |x: f64| (2.0 * cohesion * cosine + x * (1.0 + sin_friction)) / (1.0 - sin_friction);
            let count = 20_000;
            let step = (high - low) / f64::from(count);
            let points = (0..count).map(|k| low + (f64::from(k) + 0.5) * step);
            let [line, curve] =
                points.fold([0.0; 2], |sum, x| [sum[0] + line(x) - x, sum[1] + mass.major(x).unwrap_or(f64::NAN) - x]);
            assert!((line / curve - 1.0).abs() < 1e-3, "{mass:?} {line} {curve}");
        }
    }
}
