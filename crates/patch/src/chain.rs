//! Forces on the points of outlines that bend: the gradient of the energy of patches and corners with respect to all
//! of them.
//!
//! The points of a face that is viewed take the force of its cell, by its moment. Those of a face that has come in take
//! the pressure on it, which is the depth under the owner of the cell and linear on each piece. Both have the same sum
//! and the same moment, although their normals differ: the theorem of Gauss on the overlap.

use crate::clip::Polygon;
use crate::contacts::patch;
use crate::corner::share_of_level;
use crate::cover::{Access, View};
use crate::{Body, Covers, Face, Hardening, Piece, Rule, Vector};

/// Places and weights of the rule of Gauss with three points on (0, 1): exact for a hardened pressure and its moment.
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 0.277_777_777_777_777_8),
    (0.5, 0.444_444_444_444_444_4),
    (0.887_298_334_620_741_7, 0.277_777_777_777_777_8),
];

/// Energy of the contacts of some bodies, and the forces on the points of their outlines, over the stiffness of faces.
#[derive(Debug, Clone, Default)]
pub struct Loads {
    /// Energy (m³).
    pub energy: f64,
    /// Force on each point of each body (m²).
    pub forces: Vec<Vec<Vector>>,
}

impl Loads {
    /// The loads on bodies whose cells are those of their present outlines. A corner that is level with a third body
    /// counts by the same share as in rows.
    pub fn of(bodies: &[Body], covers: &Covers, rule: &Rule, hardening: Hardening) -> Self {
        let forces = bodies.iter().map(|body| vec![Vector::default(); body.outline.len()]).collect();
        let mut loads = Self { energy: 0.0, forces };
        let (mut access, mut polygon) = (Access::default(), Polygon::default());
        for viewed in 0..bodies.len() {
            for viewer in (0..bodies.len()).filter(|&viewer| viewer != viewed) {
                for face in 0..bodies[viewed].outline.len() {
                    let view = View { bodies, covers, rule, viewed, face, viewer };
                    view.access(&mut access);
                    loads.add_patch(&view, &access, hardening, &mut polygon);
                    loads.add_corners(&view, &access, hardening);
                }
            }
        }
        loads
    }

    fn add_patch(&mut self, view: &View, access: &Access, hardening: Hardening, polygon: &mut Polygon) {
        let share = if view.viewed < view.viewer { view.rule.view } else { 1.0 - view.rule.view };
        let body = &view.bodies[view.viewed];
        let (axes, next) = (body.faces[view.face], body.outline.next(view.face));
        let mut found: Vec<Piece> = Vec::new();
        let patch = patch(view, access, hardening, polygon, |piece| found.push(piece));
        self.energy += share * patch.energy;
        let far = patch.moment / axes.length;
        let own = &mut self.forces[view.viewed];
        own[view.face] -= axes.normal() * (share * (patch.force - far));
        own[next] -= axes.normal() * (share * far);
        for piece in found {
            self.press(view, &axes, &piece, share, hardening);
        }
    }

    /// The points of a face of the viewer take the pressure on a piece of it.
    fn press(&mut self, view: &View, axes: &Face, piece: &Piece, share: f64, hardening: Hardening) {
        let body = &view.bodies[view.viewer];
        let face = body.faces[piece.face];
        let along = piece.ends[1] - piece.ends[0];
        let length = along.norm();
        for (place, weight) in GAUSS {
            let at = piece.ends[0] + along * place;
            let force = face.normal() * (-share * weight * length * hardening.pressure(at.y));
            let way = face.local(axes.global(at)).x / face.length;
            let own = &mut self.forces[view.viewer];
            own[piece.face] += force * (1.0 - way);
            own[body.outline.next(piece.face)] += force * way;
        }
    }

    fn add_corners(&mut self, view: &View, access: &Access, hardening: Hardening) {
        let View { bodies, rule, viewed, face, viewer, .. } = *view;
        let (under, body) = (&bodies[viewed], &bodies[viewer]);
        let axes = under.faces[face];
        for (corner, &point) in body.outline.points.iter().enumerate() {
            if rule.corner <= 0.0 || !body.is_corner(corner, rule) {
                continue;
            }
            let Some(depth) = view.depth(point, access) else { continue };
            let level = share_of_level(bodies, view.covers, rule, [viewer, corner, viewed], axes.normal());
            let weight = rule.corner * depth.share * level;
            self.energy += weight * hardening.energy(depth.at.y);
            let force = axes.normal() * (weight * hardening.pressure(depth.at.y));
            let way = depth.at.x / axes.length;
            self.forces[viewer][corner] += force;
            self.forces[viewed][face] -= force * (1.0 - way);
            self.forces[viewed][under.outline.next(face)] -= force * way;
        }
    }
}
