//! Corotated forces of elements, eight side by side (Eqs. 6, 7).

use enmm_lanes::{LANES, Lanes, Table};

use crate::geometry::Vector;

use super::Elasticity;
use super::patch::Group;

/// What the elements of a batch share.
#[derive(Clone, Copy)]
struct Constants<F> {
    one: F,
    two: F,
    two_mu: F,
    lambda: F,
    /// Gradients of the second and the third weight.
    g: [[F; 2]; 2],
}

impl<F: Copy> Constants<F> {
    #[inline(always)]
    fn new<L: Lanes<F = F>>(lanes: L, rock: &Elasticity, g: &[Vector; 3]) -> Self {
        Self {
            one: lanes.splat(1.0),
            two: lanes.splat(2.0),
            two_mu: lanes.splat(2.0 * rock.mu),
            lambda: lanes.splat(rock.lambda),
            g: [[lanes.splat(g[1].x), lanes.splat(g[1].y)], [lanes.splat(g[2].x), lanes.splat(g[2].y)]],
        }
    }
}

/// Groups in hand at once: the stages of one wait for each other, those of several side by side do not.
const AHEAD: usize = 8;

/// Adds the forces (N/m) of the elements of a batch; `pre_stress` holds xx, yy, xy (Pa) of each group or nothing.
#[inline(always)]
pub fn push_forces<L: Lanes>(
    lanes: L,
    (groups, pre_stress): (&[Group], &[[[f64; LANES]; 3]]),
    (rock, g): (&Elasticity, &[Vector; 3]),
    displacement: &Table,
    force: &mut Table,
) {
    let constants = Constants::new(lanes, rock, g);
    let mut in_hand = [[constants.one; 4]; AHEAD];
    let mut pre_stress = pre_stress.chunks(AHEAD);
    for some in groups.chunks(AHEAD) {
        for (group, values) in some.iter().zip(&mut in_hand) {
            *values = deformation(lanes, &constants, group, displacement);
        }
        match pre_stress.next() {
            None => {
                for (group, values) in some.iter().zip(&mut in_hand) {
                    *values = corner_forces(lanes, &constants, &group.area, *values, None);
                }
            }
            Some(pre_stress) => {
                for ((group, pre), values) in some.iter().zip(pre_stress).zip(&mut in_hand) {
                    *values = corner_forces(lanes, &constants, &group.area, *values, Some(pre));
                }
            }
        }
        for (group, &[x2, y2, x3, y3]) in some.iter().zip(&in_hand) {
            lanes.scatter_add(force, &group.slots[0], [-(x2 + x3), -(y2 + y3)]);
            lanes.scatter_add(force, &group.slots[1], [x2, y2]);
            lanes.scatter_add(force, &group.slots[2], [x3, y3]);
        }
    }
}

/// Deformation gradients 11, 12, 21, 22.
#[inline(always)]
fn deformation<L: Lanes>(lanes: L, constants: &Constants<L::F>, group: &Group, displacement: &Table) -> [L::F; 4] {
    let u0 = lanes.gather(displacement, &group.slots[0]);
    let u1 = lanes.gather(displacement, &group.slots[1]);
    let u2 = lanes.gather(displacement, &group.slots[2]);
    let [a, b] = [[u1[0] - u0[0], u1[1] - u0[1]], [u2[0] - u0[0], u2[1] - u0[1]]];
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
    pre: Option<&[[f64; LANES]; 3]>,
) -> [L::F; 4] {
    let [g, h] = constants.g;
    let (c, s) = (f11 + f22, f21 - f12);
    let trace = lanes.sqrt(c * c + s * s);
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
