//! Grout between a bar and the rock: a spring that slips at its strength (Eqs. 44a, 44c).

/// Share of the elastic stiffness that what yields or slips has in a round of Newton's method.
pub const SOFT: f64 = 1e-8;

/// The tie of a point of a bar to the rock: a spring that slips.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Grout {
    /// Stiffness against slip (N/m per metre).
    pub stiffness: f64,
    /// Force at which it slips (N/m); infinite for a plate.
    pub strength: f64,
}

impl Grout {
    /// Force (N/m) of an elastic slip (m).
    pub fn force(&self, elastic: f64) -> f64 {
        (self.stiffness * elastic).clamp(-self.strength, self.strength)
    }

    /// The same summed up over the slip (J/m).
    pub fn potential(&self, elastic: f64) -> f64 {
        potential(self.stiffness, self.strength, elastic.abs())
    }

    /// Its stiffness (N/m per metre) in a round of Newton's method.
    pub fn tangent(&self, elastic: f64) -> f64 {
        let slips = (self.stiffness * elastic).abs() >= self.strength;
        self.stiffness * if slips { SOFT } else { 1.0 }
    }

    /// Slip (m) without force after a slip.
    pub fn slid(&self, slip: f64, slid: f64) -> f64 {
        let most = self.strength / self.stiffness;
        if most.is_finite() { slid.clamp(slip - most, slip + most) } else { slid }
    }

    /// Energy (J/m) that it stores.
    pub fn energy(&self, slip: f64, slid: f64) -> f64 {
        0.5 * self.stiffness * (slip - slid) * (slip - slid)
    }
}

/// Force of a spring that gives way at a limit, summed up over its stretch.
pub fn potential(stiffness: f64, limit: f64, stretch: f64) -> f64 {
    let elastic = stretch.min(limit / stiffness);
    let beyond = stretch - elastic;
    0.5 * stiffness * elastic * elastic + if beyond > 0.0 { limit * beyond } else { 0.0 }
}
