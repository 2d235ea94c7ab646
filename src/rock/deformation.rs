//! Corotated linear elasticity of one element: deformation, stress, forces and energy from its total displacements
//! (Eqs. 6–8).

use enmm_lanes::{Arithmetic, First, Values};

use crate::geometry::Vector;

use super::Elasticity;

/// Stress xx, yy, xy (Pa) in the reference axes of an element before any displacement.
pub type PreStress = [f64; 3];

/// Stress before any displacement that varies with height alone.
#[doc(alias = "in-situ stress")]
#[doc(alias = "geostatic stress")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StressField {
    /// Stress xx, yy, xy (Pa) at the reference height.
    pub value: PreStress,
    /// Change of the three with height (Pa/m).
    pub gradient: [f64; 3],
    /// Reference height (m).
    pub y_reference: f64,
}

impl StressField {
    /// Stress (Pa) at a position.
    pub fn at(&self, p: Vector) -> PreStress {
        [0, 1, 2].map(|k| self.value[k] + self.gradient[k] * (p.y - self.y_reference))
    }
}

/// Deformation gradient of an element, or of eight in lanes, split into rotation and stretch (Eq. 6).
#[doc(alias = "deformation gradient")]
#[doc(alias = "polar decomposition")]
#[doc(alias = "corotational")]
#[derive(Debug, Clone, Copy)]
pub struct Deformation<F = f64> {
    f: [F; 4],
    cos: F,
    sin: F,
    trace: F,
}

/// Σ u⊗G of three covers, row by row, and `unit` times I.
#[inline(always)]
fn gradient<F: Arithmetic>(unit: F, u: &[[F; 2]; 3], g: &[[F; 2]; 3]) -> [F; 4] {
    [
        unit + u[0][0] * g[0][0] + u[1][0] * g[1][0] + u[2][0] * g[2][0],
        u[0][0] * g[0][1] + u[1][0] * g[1][1] + u[2][0] * g[2][1],
        u[0][1] * g[0][0] + u[1][1] * g[1][0] + u[2][1] * g[2][0],
        unit + u[0][1] * g[0][1] + u[1][1] * g[1][1] + u[2][1] * g[2][1],
    ]
}

#[inline(always)]
fn pairs(vectors: &[Vector; 3]) -> [[f64; 2]; 3] {
    vectors.map(|v| [v.x, v.y])
}

impl<F: Arithmetic> Deformation<F> {
    /// F = I + Σ u⊗G with the displacements of the three covers.
    #[inline(always)]
    pub fn of_covers<V: Values<F = F>>(values: V, u: &[[F; 2]; 3], g: &[[F; 2]; 3]) -> Self {
        Self::of(values, gradient(values.splat(1.0), u, g))
    }

    /// A deformation whose gradient 11, 12, 21, 22 has been split into a rotation and a stretch of this trace.
    #[inline(always)]
    pub fn split(f: [F; 4], [cos, sin]: [F; 2], trace: F) -> Self {
        Self { f, cos, sin, trace }
    }

    #[inline(always)]
    fn of<V: Values<F = F>>(values: V, f: [F; 4]) -> Self {
        let (a, b) = (f[0] + f[3], f[2] - f[1]);
        let trace = values.sqrt(a * a + b * b);
        Self { f, cos: a / trace, sin: b / trace, trace }
    }

    /// F − R.
    #[inline(always)]
    fn stretch(&self) -> [F; 4] {
        let [f11, f12, f21, f22] = self.f;
        [f11 - self.cos, f12 + self.sin, f21 - self.sin, f22 - self.cos]
    }

    /// Volume change tr(RᵀF − I) (Eq. 58a).
    #[inline(always)]
    pub fn dilatation(&self) -> F {
        self.trace - self.trace.splat(2.0)
    }

    /// Change of the volume change, to first order, while the three covers moved by `moved` (m): R:ΔF. A turn of the
    /// whole block has no part in it.
    #[inline(always)]
    pub fn dilatation_by(&self, moved: &[[F; 2]; 3], g: &[[F; 2]; 3]) -> F {
        let [d11, d12, d21, d22] = gradient(self.cos.splat(0.0), moved, g);
        self.cos * (d11 + d22) + self.sin * (d21 - d12)
    }

    /// Strain RᵀF − I as xx, yy, xy in the axes that rotate with the element (Eq. 54).
    #[inline(always)]
    pub fn strain(&self) -> [F; 3] {
        let d = self.stretch();
        let (c, s) = (self.cos, self.sin);
        [c * d[0] + s * d[2], c * d[3] - s * d[1], c.splat(0.5) * (c * (d[1] + d[2]) + s * (d[3] - d[0]))]
    }

    /// Stress (Pa) by a pre-stress xx, yy, xy in the axes that rotate with the element: RᵀFσ₀FᵀR/det F.
    #[inline(always)]
    pub fn carried_in_turned_axes(&self, [xx, yy, xy]: [F; 3]) -> [F; 3] {
        let [f11, f12, f21, f22] = self.f;
        let (c, s) = (self.cos, self.sin);
        let u = [c * f11 + s * f21, c * f12 + s * f22, c * f21 - s * f11, c * f22 - s * f12];
        let volume = f11 * f22 - f12 * f21;
        let q = [u[0] * xx + u[1] * xy, u[0] * xy + u[1] * yy, u[2] * xx + u[3] * xy, u[2] * xy + u[3] * yy];
        let carried = [q[0] * u[0] + q[1] * u[1], q[2] * u[2] + q[3] * u[3], q[0] * u[2] + q[1] * u[3]];
        [carried[0] / volume, carried[1] / volume, carried[2] / volume]
    }

    /// (t₁₂(U₁₁ − U₂₂) − U₁₂(t₁₁ − t₂₂))/tr U of the stretch U = RᵀF and a tensor xx, yy, xy in its axes: zero when
    /// both have the same axes.
    #[inline(always)]
    pub fn skew(&self, [xx, yy, xy]: [F; 3]) -> F {
        let strain = self.strain();
        (xy * (strain[0] - strain[1]) - strain[2] * (xx - yy)) / self.trace
    }

    /// First Piola–Kirchhoff stress (Pa) without the pre-stress (Eq. 7), row by row, of rock with Lamé's constants λ
    /// and μ (Pa).
    #[inline(always)]
    fn piola(&self, [lambda, mu]: &[F; 2]) -> [F; 4] {
        let (d, two) = (self.stretch(), self.trace.splat(2.0));
        let (two_mu, volume) = (two * *mu, *lambda * (self.trace - two));
        let (c, s) = (self.cos, self.sin);
        [two_mu * d[0] + volume * c, two_mu * d[1] - volume * s, two_mu * d[2] + volume * s, two_mu * d[3] + volume * c]
    }

    /// F·σ₀: the pre-stress as a second Piola–Kirchhoff stress that rotates with the rock (Eq. 26).
    #[inline(always)]
    fn carried(&self, pre: &[F; 3]) -> [F; 4] {
        let [f11, f12, f21, f22] = self.f;
        let [xx, yy, xy] = *pre;
        [f11 * xx + f12 * xy, f11 * xy + f12 * yy, f21 * xx + f22 * xy, f21 * xy + f22 * yy]
    }

    /// Stress xx, yy, xy (Pa, tension positive) in global axes: P·Rᵀ, and F·σ₀·Fᵀ/det F of the pre-stress.
    #[inline(always)]
    pub fn stress(&self, constants: &[F; 2], pre: &[F; 3]) -> [F; 3] {
        let (p, q) = (self.piola(constants), self.carried(pre));
        let (c, s) = (self.cos, self.sin);
        let [f11, f12, f21, f22] = self.f;
        let volume = f11 * f22 - f12 * f21;
        [
            p[0] * c - p[1] * s + (q[0] * f11 + q[1] * f12) / volume,
            p[2] * s + p[3] * c + (q[2] * f21 + q[3] * f22) / volume,
            p[0] * s + p[1] * c + (q[0] * f21 + q[1] * f22) / volume,
        ]
    }

    /// Strain energy (J per m² of reference area; Eq. 8), with the work of the pre-stress.
    #[inline(always)]
    pub fn energy(&self, [lambda, mu]: &[F; 2], pre: &[F; 3]) -> F {
        let d = self.stretch();
        let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] + d[3] * d[3];
        let [f11, f12, f21, f22] = self.f;
        let [half, one] = [0.5, 1.0].map(|value| self.trace.splat(value));
        let green = [f11 * f11 + f21 * f21 - one, f12 * f12 + f22 * f22 - one, f11 * f12 + f21 * f22];
        let pre_work = half * (pre[0] * green[0] + pre[1] * green[1]) + pre[2] * green[2];
        let dilatation = self.dilatation();
        *mu * square + half * *lambda * (dilatation * dilatation) + pre_work
    }

    /// R·t of a tensor, row by row.
    #[inline(always)]
    pub fn turn_rows(&self, t: [F; 4]) -> [F; 4] {
        let (c, s) = (self.cos, self.sin);
        [c * t[0] - s * t[2], c * t[1] - s * t[3], s * t[0] + c * t[2], s * t[1] + c * t[3]]
    }
}

impl Deformation {
    /// The deformation with the displacements of the three covers of an element.
    #[inline]
    pub fn new(u: [Vector; 3], g: &[Vector; 3]) -> Self {
        Self::of_covers(First, &pairs(&u), &pairs(g))
    }

    /// The deformation before the three covers moved by `moved` (m), in the frame of a block that has turned by `turn`
    /// (rad) since: F − ΔF + θJF (Eqs. 81, 82).
    pub fn before(&self, moved: [Vector; 3], turn: f64, g: &[Vector; 3]) -> Self {
        let [f11, f12, f21, f22] = self.f;
        let [d11, d12, d21, d22] = gradient(0.0, &pairs(&moved), &pairs(g));
        let before = [f11 - d11 - turn * f21, f12 - d12 - turn * f22, f21 - d21 + turn * f11, f22 - d22 + turn * f12];
        Self::of(First, before)
    }

    /// Forces (N/m) on the three covers of an element of cut area `area` (m²) (Eq. 7).
    pub fn forces(&self, g: &[Vector; 3], area: f64, rock: &Elasticity, pre: &PreStress) -> [Vector; 3] {
        let (own, carried) = (self.piola(&rock.constants()), self.carried(pre));
        let p = [0, 1, 2, 3].map(|k| -area * (own[k] + carried[k]));
        g.map(|g| Vector::new(p[0] * g.x + p[1] * g.y, p[2] * g.x + p[3] * g.y))
    }

    /// R·t·Rᵀ of a symmetric tensor xx, yy, xy: from the axes that rotate with the element to global ones.
    pub fn turn(&self, [xx, yy, xy]: [f64; 3]) -> [f64; 3] {
        let (c, s) = (self.cos, self.sin);
        let p = self.turn_rows([xx, xy, xy, yy]);
        [p[0] * c - p[1] * s, p[2] * s + p[3] * c, p[0] * s + p[1] * c]
    }

    /// A vector of the reference turned with the element: R·v.
    pub fn turn_vector(&self, v: Vector) -> Vector {
        Vector::new(self.cos * v.x - self.sin * v.y, self.sin * v.x + self.cos * v.y)
    }

    /// A gradient or a normal of the reference times its length, carried along: det(F)·F⁻ᵀ·g.
    pub fn carry_normal(&self, g: Vector) -> Vector {
        let [f11, f12, f21, f22] = self.f;
        Vector::new(f22 * g.x - f21 * g.y, f11 * g.y - f12 * g.x)
    }

    /// Rotation (rad), counter-clockwise.
    pub fn rotation(&self) -> f64 {
        libm::atan2(self.sin, self.cos)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: [Vector; 3] = [Vector::new(-1.0, -1.0), Vector::new(1.0, 0.0), Vector::new(0.0, 1.0)];
    const ROCK: Elasticity = Elasticity { lambda: 0.7, mu: 0.4, density: 1.0 };

    #[test]
    fn a_rigid_turn_carries_the_pre_stress_and_no_energy() {
        let (s, c) = 0.5f64.sin_cos();
        let corners = [Vector::zeros(), Vector::new(1.0, 0.0), Vector::new(0.0, 1.0)];
        let u = corners.map(|x| Vector::new(c * x.x - s * x.y, s * x.x + c * x.y) - x);
        let turned = Deformation::new(u, &UP);
        assert!(turned.stress(&ROCK.constants(), &[0.0; 3]).iter().all(|v| v.abs() < 1e-15));
        assert!(turned.energy(&ROCK.constants(), &[1.0, 2.0, 3.0]).abs() < 1e-15);
        let carried = turned.stress(&ROCK.constants(), &[1.0, 0.0, 0.0]);
        assert!((carried[0] - c * c).abs() < 1e-15 && (carried[2] - s * c).abs() < 1e-15);
        assert!((turned.rotation() - 0.5).abs() < 1e-15);
    }

    #[test]
    fn forces_are_minus_the_gradient_of_the_energy() {
        let pre = [0.3, -0.2, 0.1];
        let u = [Vector::new(0.1, -0.2), Vector::new(-0.05, 0.3), Vector::new(0.2, 0.15)];
        let forces = Deformation::new(u, &UP).forces(&UP, 1.0, &ROCK, &pre);
        for k in 0..3 {
            for axis in 0..2 {
                let energy = |d: f64| {
                    let mut moved = u;
                    moved[k][axis] += d;
                    Deformation::new(moved, &UP).energy(&ROCK.constants(), &pre)
                };
                let model = (energy(1e-6) - energy(-1e-6)) / 2e-6;
                assert!((model + forces[k][axis]).abs() < 1e-8, "{model} {}", forces[k][axis]);
            }
        }
    }
}
