//! The spring of a corner: of a fixed length, closed by the depth of the corner under the nearest open face.
//!
//! Faces that meet in a point overlap over a small area: alone, they would be soft where load is concentrated. A corner
//! has a spring besides, of the stiffness of a fixed length of faces. Its energy is a function of the depth under the
//! face whose cell the corner is in, so that its force too is a gradient. Cells, and what of them is open, are those
//! of patches.
//!
//! A corner that is *level* with a third body, whose face goes on beyond it, is the lip of a mouth. It acts along the
//! normal of its free side alone, or else a corner that is pressed over the mouth would be pushed along.

use crate::cover::{Access, OpenBand, View, level_face};
use crate::{Body, Covers, Rule, Vector};

/// Where a corner lies in another body: the depth is under a face that is open to it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Depth {
    /// Way along the face and depth (m).
    pub at: Vector,
    /// Share with which it counts beside a closed joint: the body on the other side has the rest.
    pub share: f64,
}

impl View<'_> {
    /// Where a point of the viewer lies under the face, if it is in the open part of its cell. Beside a closed side the
    /// body behind that takes over within a ledge on both sides of it.
    pub fn depth(&self, point: Vector, access: &Access) -> Option<Depth> {
        let body = &self.bodies[self.viewed];
        let axes = body.faces[self.face];
        let at = axes.local(point);
        if !(at.y > 0.0 && at.y <= self.rule.reach) {
            return None;
        }
        let mut share = 0.0f64;
        access.each_band(&body.cells[self.face], axes.length, at.y, |open| {
            share = share.max(share_in(&open, at, self.rule.ledge));
        });
        (share > 0.0).then_some(Depth { at, share })
    }
}

/// Share with which a point counts in a part of a cell.
fn share_in(open: &OpenBand, at: Vector, ledge: f64) -> f64 {
    let within = |[low, high]: [f64; 2], value: f64| low <= value && value <= high;
    // A cover reaches a ledge farther to corners: that of a third body may lie in the same place.
    let stretch = [open.stretch[0] + ledge, open.stretch[1] - ledge];
    if !(within(open.band.depths, at.y) && within(stretch, at.x)) {
        return 0.0;
    }
    let bound = |end: usize| if open.closed[end] { open.band.bounds[end] } else { open.bare[end] };
    let [start, end] = [0, 1].map(|end| bound(end).position(at.y));
    let shares = [(at.x - start, open.closed[0]), (end - at.x, open.closed[1])].map(|(inside, is_closed)| {
        if is_closed { (0.5 + 0.5 * inside / ledge).clamp(0.0, 1.0) } else { f64::from(u8::from(inside >= 0.0)) }
    });
    shares[0] * shares[1]
}

/// Share with which a corner acts along a normal, by whether it is level with third bodies; `from` is the body in which
/// it lies.
pub fn share_of_level(
    bodies: &[Body],
    covers: &Covers,
    rule: &Rule,
    [owner, corner, from]: [usize; 3],
    normal: Vector,
) -> f64 {
    let body = &bodies[owner];
    let before = body.outline.previous(corner);
    let normals = [before, corner].map(|face| body.faces[face].normal());
    let reaches = |face: usize, stretch: [f64; 2]| {
        if face == before { body.faces[face].length - stretch[1] <= rule.ledge } else { stretch[0] <= rule.ledge }
    };
    let is_level = |face: usize, free: Vector| {
        let third = covers.of(owner, face).iter().filter(|cover| cover.body != from && reaches(face, cover.stretch));
        let point = body.outline.points[corner];
        third.into_iter().any(|cover| level_face(&bodies[cover.body], point, free, rule).is_some())
    };
    let levels = [is_level(before, normals[1]), is_level(corner, normals[0])];
    let free = match levels {
        [false, false] => return 1.0,
        [true, true] => return 0.0,
        [true, false] => normals[1],
        [false, true] => normals[0],
    };
    let (sine, cosine) = (free.cross(-normal).abs(), free.dot(-normal));
    if cosine <= 0.0 {
        return 0.0;
    }
    let way = ((sine - rule.fade[0]) / (rule.fade[1] - rule.fade[0])).clamp(0.0, 1.0);
    1.0 - way * way * (3.0 - 2.0 * way)
}
