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
    if pre_stress.is_empty() {
        for group in groups {
            push_group(lanes, &constants, group, displacement, force, None);
        }
    } else {
        for (group, pre) in groups.iter().zip(pre_stress) {
            push_group(lanes, &constants, group, displacement, force, Some(pre));
        }
    }
}

#[inline(always)]
fn push_group<L: Lanes>(
    lanes: L,
    constants: &Constants<L::F>,
    group: &Group,
    displacement: &Table,
    force: &mut Table,
    pre: Option<&[[f64; LANES]; 3]>,
) {
    let u0 = lanes.gather(displacement, &group.slots[0]);
    let u1 = lanes.gather(displacement, &group.slots[1]);
    let u2 = lanes.gather(displacement, &group.slots[2]);
    let [a, b] = [[u1[0] - u0[0], u1[1] - u0[1]], [u2[0] - u0[0], u2[1] - u0[1]]];
    let [g, h] = constants.g;
    let f11 = constants.one + (a[0] * g[0] + b[0] * h[0]);
    let f12 = a[0] * g[1] + b[0] * h[1];
    let f21 = a[1] * g[0] + b[1] * h[0];
    let f22 = constants.one + (a[1] * g[1] + b[1] * h[1]);
    let (c, s) = (f11 + f22, f21 - f12);
    let trace = lanes.sqrt(c * c + s * s);
    let inverse = constants.one / trace;
    let (c, s) = (c * inverse, s * inverse);
    let area = -lanes.load(&group.area);
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
    let second = [p[0] * g[0] + p[1] * g[1], p[2] * g[0] + p[3] * g[1]];
    let third = [p[0] * h[0] + p[1] * h[1], p[2] * h[0] + p[3] * h[1]];
    let first = [-(second[0] + third[0]), -(second[1] + third[1])];
    lanes.scatter_add(force, &group.slots[0], first);
    lanes.scatter_add(force, &group.slots[1], second);
    lanes.scatter_add(force, &group.slots[2], third);
}
