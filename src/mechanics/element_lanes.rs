//! Corotated forces of elements, eight side by side (Eqs. 6, 7).

use enmm_lanes::{Eight, LANES, Lanes, Table};

use crate::geometry::Vector;

use super::Elasticity;
use super::patch::{Group, PreStresses, Row};

/// Eight elements: where their displacements come from and their forces go to.
pub trait Elements: Sized {
    /// Cut areas (m²).
    fn area(&self) -> &[f64; LANES];

    /// Displacements (m) of the second and of the third covers less those of the first.
    fn gather<L: Lanes>(&self, lanes: L, displacement: &Table) -> [[L::F; 2]; 2];

    /// Adds forces x, y on the second and x, y on the third covers (N/m); the first bear what holds them in balance.
    fn add<L: Lanes>(lanes: L, some: &[Self], forces: &[[L::F; 4]; AHEAD], force: &mut Table);
}

/// The force on the first cover.
#[inline(always)]
fn balance<F: Eight>([x2, y2, x3, y3]: [F; 4]) -> [F; 2] {
    [-(x2 + x3), -(y2 + y3)]
}

impl Elements for Group {
    #[inline(always)]
    fn area(&self) -> &[f64; LANES] {
        &self.area
    }

    #[inline(always)]
    fn gather<L: Lanes>(&self, lanes: L, displacement: &Table) -> [[L::F; 2]; 2] {
        let u0 = lanes.gather(displacement, &self.slots[0]);
        let u1 = lanes.gather(displacement, &self.slots[1]);
        let u2 = lanes.gather(displacement, &self.slots[2]);
        [[u1[0] - u0[0], u1[1] - u0[1]], [u2[0] - u0[0], u2[1] - u0[1]]]
    }

    #[inline(always)]
    fn add<L: Lanes>(lanes: L, some: &[Self], forces: &[[L::F; 4]; AHEAD], force: &mut Table) {
        for (group, &values) in some.iter().zip(forces) {
            let [x2, y2, x3, y3] = values;
            lanes.scatter_add(force, &group.slots[0], balance(values));
            lanes.scatter_add(force, &group.slots[1], [x2, y2]);
            lanes.scatter_add(force, &group.slots[2], [x3, y3]);
        }
    }
}

impl Elements for Row {
    #[inline(always)]
    fn area(&self) -> &[f64; LANES] {
        &self.area
    }

    #[inline(always)]
    fn gather<L: Lanes>(&self, lanes: L, displacement: &Table) -> [[L::F; 2]; 2] {
        lanes.gather_triangles(displacement, self.first)
    }

    #[inline(always)]
    fn add<L: Lanes>(lanes: L, some: &[Self], forces: &[[L::F; 4]; AHEAD], force: &mut Table) {
        for (row, &[x2, y2, x3, y3]) in some.iter().zip(forces) {
            lanes.scatter_triangles(force, row.first, [x2, y2], [x3, y3]);
        }
        for (row, &[x2, y2, ..]) in some.iter().zip(forces) {
            lanes.scatter_last(force, row.first[0], [x2, y2]);
        }
    }
}

/// What the elements of a batch share.
#[derive(Clone, Copy)]
struct Constants<F> {
    one: F,
    two: F,
    least: F,
    two_mu: F,
    lambda: F,
    /// Gradients of the second and the third weight.
    g: [[F; 2]; 2],
}

impl<F: Copy> Constants<F> {
    #[inline(always)]
    fn new<L: Lanes<F = F>>(lanes: L, rock: &Elasticity, [g, h]: [Vector; 2]) -> Self {
        Self {
            one: lanes.splat(1.0),
            two: lanes.splat(2.0),
            least: lanes.splat(f64::MIN_POSITIVE),
            two_mu: lanes.splat(2.0 * rock.mu),
            lambda: lanes.splat(rock.lambda),
            g: [[lanes.splat(g.x), lanes.splat(g.y)], [lanes.splat(h.x), lanes.splat(h.y)]],
        }
    }
}

/// Groups in hand at once: the stages of one wait for each other, those of several side by side do not.
pub const AHEAD: usize = 8;

/// Adds the forces (N/m) of elements of one rock and these gradients of the second and the third weight (1/m);
/// `pre_stress` holds that of each eight or nothing. `meanwhile` is called after every few.
#[inline(always)]
pub fn push_forces<L: Lanes, E: Elements>(
    lanes: L,
    (elements, pre_stress): (&[E], &[PreStresses]),
    (rock, g): (&Elasticity, [Vector; 2]),
    [displacement, force]: &mut [Table; 2],
    mut meanwhile: impl FnMut(),
) {
    let constants = Constants::new(lanes, rock, g);
    let mut in_hand = [[constants.one; 4]; AHEAD];
    let mut pre_stress = pre_stress.chunks(AHEAD);
    for some in elements.chunks(AHEAD) {
        for (eight, values) in some.iter().zip(&mut in_hand) {
            *values = deformation(lanes, &constants, eight, displacement);
        }
        match pre_stress.next() {
            None => {
                for (eight, values) in some.iter().zip(&mut in_hand) {
                    *values = corner_forces(lanes, &constants, eight.area(), *values, None);
                }
            }
            Some(pre_stress) => {
                for ((eight, pre), values) in some.iter().zip(pre_stress).zip(&mut in_hand) {
                    *values = corner_forces(lanes, &constants, eight.area(), *values, Some(pre));
                }
            }
        }
        E::add(lanes, some, &in_hand, force);
        meanwhile();
    }
}

/// Deformation gradients 11, 12, 21, 22.
#[inline(always)]
fn deformation<L: Lanes, E: Elements>(
    lanes: L,
    constants: &Constants<L::F>,
    eight: &E,
    displacement: &Table,
) -> [L::F; 4] {
    let [a, b] = eight.gather(lanes, displacement);
    let [g, h] = constants.g;
    [
        constants.one + (a[0] * g[0] + b[0] * h[0]),
        a[0] * g[1] + b[0] * h[1],
        a[1] * g[0] + b[1] * h[0],
        constants.one + (a[1] * g[1] + b[1] * h[1]),
    ]
}

/// Forces x, y on the second and x, y on the third cover; the first bears what holds them in balance.
#[inline(always)]
fn corner_forces<L: Lanes>(
    lanes: L,
    constants: &Constants<L::F>,
    area: &[f64; LANES],
    [f11, f12, f21, f22]: [L::F; 4],
    pre: Option<&PreStresses>,
) -> [L::F; 4] {
    let [g, h] = constants.g;
    let (c, s) = (f11 + f22, f21 - f12);
    // A missing element takes displacements of any covers: its forces must be zero, never 0 times infinity.
    let trace = lanes.max(constants.least, lanes.sqrt(c * c + s * s));
    let inverse = constants.one / trace;
    let (c, s) = (c * inverse, s * inverse);
    let area = -lanes.load(area);
    let shear = constants.two_mu * area;
    let volume = constants.lambda * area * (trace - constants.two);
    let (vc, vs) = (volume * c, volume * s);
    let mut p = [shear * (f11 - c) + vc, shear * (f12 + s) - vs, shear * (f21 - s) + vs, shear * (f22 - c) + vc];
    if let Some(pre) = pre {
        let xx = lanes.load(&pre[0]) * area;
        let yy = lanes.load(&pre[1]) * area;
        let xy = lanes.load(&pre[2]) * area;
        p[0] = p[0] + (f11 * xx + f12 * xy);
        p[1] = p[1] + (f11 * xy + f12 * yy);
        p[2] = p[2] + (f21 * xx + f22 * xy);
        p[3] = p[3] + (f21 * xy + f22 * yy);
    }
    [p[0] * g[0] + p[1] * g[1], p[2] * g[0] + p[3] * g[1], p[0] * h[0] + p[1] * h[1], p[2] * h[0] + p[3] * h[1]]
}
