//! Corotated forces of eight elements at once (Eqs. 6, 7): the inner loop of a step in a continuum.

use enmm_lanes::{LANES, Lanes, Table};

use crate::geometry::Vector;

use super::chunk::{Group, PreStresses, Row, SomeEights, YieldPlaces};
use super::{Deformation, Elasticity};

/// Eight elements: how their displacements are read and their forces are added.
pub trait Elements: Sized {
    /// Cut areas (m²).
    fn area(&self) -> &[f64; LANES];

    /// Displacements (m) of the second and of the third covers less those of the first.
    fn gather<L: Lanes>(&self, lanes: L, displacement: &Table) -> [[L::F; 2]; 2];

    /// Adds forces x, y on the second and x, y on the third covers (N/m); the first covers get the forces that balance
    /// them. Returns the part that [`Elements::settle`] adds later.
    fn add<L: Lanes>(&self, lanes: L, forces: [L::F; 4], force: &mut Table) -> Vector;

    /// Adds the forces that were left for later.
    fn settle(some: &[Self], waiting: &[Vector; TOGETHER], force: &mut Table);
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
    fn add<L: Lanes>(&self, lanes: L, [x2, y2, x3, y3]: [L::F; 4], force: &mut Table) -> Vector {
        lanes.scatter_add(force, &self.slots[0], [-(x2 + x3), -(y2 + y3)]);
        lanes.scatter_add(force, &self.slots[1], [x2, y2]);
        lanes.scatter_add(force, &self.slots[2], [x3, y3]);
        Vector::zeros()
    }

    #[inline(always)]
    fn settle(_: &[Self], _: &[Vector; TOGETHER], _: &mut Table) {}
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
    fn add<L: Lanes>(&self, lanes: L, [x2, y2, x3, y3]: [L::F; 4], force: &mut Table) -> Vector {
        lanes.scatter_triangles(force, self.first, [x2, y2], [x3, y3])
    }

    #[inline(always)]
    fn settle(some: &[Self], waiting: &[Vector; TOGETHER], force: &mut Table) {
        for (row, pair) in some.iter().zip(waiting) {
            force.add_beside(row.first[0], *pair);
        }
    }
}

/// Stress that rock takes off the elastic one of eight elements.
pub trait Relief: Copy {
    /// First Piola–Kirchhoff stress (Pa), row by row; none where the rock is elastic.
    fn taken_off<L: Lanes>(&self, lanes: L, of: Option<&YieldPlaces>, at: &Deformation<L::F>) -> Option<[L::F; 4]>;
}

/// Rock that never yields.
#[derive(Clone, Copy)]
pub struct Elastic;

impl Relief for Elastic {
    #[inline(always)]
    fn taken_off<L: Lanes>(&self, _: L, _: Option<&YieldPlaces>, _: &Deformation<L::F>) -> Option<[L::F; 4]> {
        None
    }
}

/// Constants that the elements of a batch share.
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

/// Number of groups whose forces are added before those that were left for later.
pub const TOGETHER: usize = 8;
/// Delays of the pipeline, in groups: stresses are computed after deformations, and forces are added after stresses.
/// The stages of one group depend on each other; those of different groups overlap in the processor.
const BEHIND: [usize; 2] = [4, 3];
/// Deformations and forces that are kept: more than the delays.
const KEPT: [usize; 2] = [8, 4];
const _: () = assert!(BEHIND[0] < KEPT[0] && BEHIND[1] < KEPT[1]);

/// Adds the forces (N/m) of elements of one rock and these gradients of the second and the third weight (1/m).
/// `meanwhile` is called after every few groups.
#[inline(always)]
pub fn push_forces<L: Lanes, E: Elements, R: Relief>(
    lanes: L,
    SomeEights { list: elements, pre_stress, yielding }: SomeEights<E>,
    (rock, g, relief): (&Elasticity, [Vector; 2], R),
    [displacement, force]: &mut [Table; 2],
    mut meanwhile: impl FnMut(),
) {
    if elements.is_empty() {
        return;
    }
    let (constants, count) = (Constants::new(lanes, rock, g), elements.len());
    let mut deformed = [[constants.one; 4]; KEPT[0]];
    let mut stressed = [[constants.one; 4]; KEPT[1]];
    let mut waiting = [Vector::zeros(); TOGETHER];
    for k in 0..count + BEHIND[0] + BEHIND[1] {
        if let Some(eight) = elements.get(k) {
            deformed[k % KEPT[0]] = deformation(lanes, &constants, eight, displacement);
        }
        let k = k.wrapping_sub(BEHIND[0]);
        if let Some(eight) = elements.get(k) {
            let values = deformed[k % KEPT[0]];
            let eight = (eight.area(), pre_stress.get(k), yielding.get(k));
            stressed[k % KEPT[1]] = corner_forces(lanes, &constants, eight, values, relief);
        }
        let k = k.wrapping_sub(BEHIND[1]);
        let Some(eight) = elements.get(k) else { continue };
        waiting[k % TOGETHER] = eight.add(lanes, stressed[k % KEPT[1]], force);
        if k % TOGETHER == TOGETHER - 1 || k == count - 1 {
            E::settle(&elements[k - k % TOGETHER..=k], &waiting, force);
            meanwhile();
        }
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

/// Forces x, y on the second and x, y on the third cover; the first cover gets the force that balances them.
#[inline(always)]
fn corner_forces<L: Lanes, R: Relief>(
    lanes: L,
    constants: &Constants<L::F>,
    (area, pre, places): (&[f64; LANES], Option<&PreStresses>, Option<&YieldPlaces>),
    f: [L::F; 4],
    relief: R,
) -> [L::F; 4] {
    let ([g, h], [f11, f12, f21, f22]) = (constants.g, f);
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
    if let Some(off) = relief.taken_off(lanes, places, &Deformation::split(f, [c, s], trace)) {
        p = [p[0] - area * off[0], p[1] - area * off[1], p[2] - area * off[2], p[3] - area * off[3]];
    }
    [p[0] * g[0] + p[1] * g[1], p[2] * g[0] + p[3] * g[1], p[0] * h[0] + p[1] * h[1], p[2] * h[0] + p[3] * h[1]]
}
