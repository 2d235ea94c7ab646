//! Barton–Bandis joints: friction that grows as the normal stress falls, and hyperbolic closure (Eqs. 33–37).

/// Greatest friction angle (rad), which low normal stress does not exceed: 70°.
pub const ANGLE_MAX: f64 = 70.0 * std::f64::consts::PI / 180.0;

/// Rough joint faces.
#[doc(alias = "Barton-Bandis")]
#[doc(alias = "JRC")]
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Roughness {
    /// Residual friction angle φr (rad).
    pub angle: f64,
    /// Joint roughness coefficient JRC (degrees per decade of JCS/σn).
    pub jrc: f64,
    /// Joint wall compressive strength JCS (Pa).
    pub jcs: f64,
}

impl Roughness {
    /// tan(min(φr + JRC·log10(JCS/σn), 70°)) under the normal stress σn > 0 (Pa); above JCS it is tan φr (Eq. 33).
    pub fn friction(&self, stress: f64) -> f64 {
        let dilation = (self.jrc * libm::log10(self.jcs / stress)).max(0.0).to_radians();
        libm::tan((self.angle + dilation).min(ANGLE_MAX))
    }
}

/// Normal spring whose force grows without bound as the closure v nears a greatest one: N = k·v/(1 − v/v_max). Loading
/// and unloading run along the same curve. A greatest closure of infinity is the linear spring.
#[doc(alias = "hyperbolic closure")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closure {
    /// Initial stiffness k (N/m per metre).
    pub stiffness: f64,
    /// Greatest closure v_max (m).
    pub most: f64,
}

impl Closure {
    /// Whether it is not the linear spring.
    #[inline(always)]
    pub fn is_curved(&self) -> bool {
        self.most.is_finite()
    }

    /// Closure (m) under a normal force (N/m): v = N/(k + N/v_max).
    pub fn under(&self, force: f64) -> f64 {
        force / (self.stiffness + force.max(0.0) / self.most)
    }

    /// Force (N/m) from what the spring of a step answers: the force itself, or, of a curve, the closure b (m) that
    /// determines it (Eq. 35).
    #[inline(always)]
    pub fn force(&self, answer: f64, c: f64) -> f64 {
        if self.is_curved() { self.solve(answer, c) } else { answer }
    }

    /// Force (N/m) after a step in which it reduces the closure that it meets: solves v(N) + c·N = b, where b (m) is
    /// the closure that would be there without the force and c (m²/N) what a unit of force takes from it (Eq. 35).
    pub fn solve(&self, b: f64, c: f64) -> f64 {
        let linear = self.stiffness * b / (1.0 + c * self.stiffness);
        if b <= 0.0 || self.most.is_infinite() {
            return linear;
        }
        let (k, most) = (self.stiffness, self.most);
        let half = 0.5 * (most + c * k * most - b);
        let root = (half * half + c * k * most * b).sqrt();
        if half >= 0.0 { k * most * b / (half + root) } else { (root - half) / c }
    }

    /// Energy (J/m) stored at closure v (m): k·v_max²·(−ln(1 − v/v_max) − v/v_max) (Eq. 36); of the linear spring for
    /// tension. At v_max, which no finite force reaches, it is that of the last number below.
    pub fn energy(&self, closure: f64) -> f64 {
        if closure <= 0.0 || self.most.is_infinite() {
            return 0.5 * self.stiffness * closure * closure;
        }
        let share = (closure / self.most).min(1.0 - f64::EPSILON);
        // −ln(1 − x) − x loses its digits where x is small.
        let series = share * share * (0.5 + share * (1.0 / 3.0 + share * (0.25 + share * 0.2)));
        let term = if share < 1e-3 { series } else { -libm::log1p(-share) - share };
        self.stiffness * self.most * self.most * term
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn friction_is_that_of_the_published_numbers_and_has_both_ends() {
        // D3: JRC 10, JCS 100 MPa, φr 28°: τ = 1.110613 MPa at 1 MPa and 0.160033 MPa at 0.1 MPa.
        let rough = Roughness { angle: 28f64.to_radians(), jrc: 10.0, jcs: 100e6 };
        assert!((rough.friction(1e6) - 1.110613).abs() < 1e-6);
        assert!((0.1 * rough.friction(0.1e6) - 0.160033).abs() < 1e-6);
        assert_eq!(rough.friction(200e6), 28f64.to_radians().tan());
        assert_eq!(rough.friction(1e-3), ANGLE_MAX.tan());
    }
}
