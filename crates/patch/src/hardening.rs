//! The law of closing faces, over their stiffness: what a depth costs, presses and stiffens.

/// Penetration at which the stiffness of closing faces has doubled. All is over that stiffness (Pa/m): a pressure in
/// m, an energy in m² per area of the face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hardening {
    /// That penetration (m); infinite for faces that do not harden.
    pub depth: f64,
}

impl Hardening {
    /// Faces that do not harden.
    pub const NONE: Self = Self { depth: f64::INFINITY };

    fn square(self, depth: f64) -> f64 {
        let ratio = depth / self.depth;
        ratio * ratio
    }

    /// Pressure at a depth: that on a face there, and the energy that an area of the overlap has.
    #[inline]
    pub fn pressure(self, depth: f64) -> f64 {
        depth * (1.0 + self.square(depth))
    }

    /// Change of the pressure with depth: the force that an area of the overlap gives along the normal.
    #[inline]
    pub fn rate(self, depth: f64) -> f64 {
        1.0 + 3.0 * self.square(depth)
    }

    /// Energy of a column of a depth; of a corner spring, over its length.
    #[inline]
    pub fn energy(self, depth: f64) -> f64 {
        depth * depth * (0.5 + 0.25 * self.square(depth))
    }

    /// Depth times rate, summed over a column of a depth.
    #[inline]
    pub fn lever(self, depth: f64) -> f64 {
        depth * depth * (0.5 + 0.75 * self.square(depth))
    }
}
