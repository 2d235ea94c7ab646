//! The contacts of some bodies: all rows, and the energy that they hold.

use crate::clip::Polygon;
use crate::corner::share_of_level;
use crate::cover::{Access, View};
use crate::history::Key;
use crate::interval::{Patch, keep_in_band, pieces};
use crate::{Body, Covers, Hardening, Piece, Rule, Vector};

/// Which part of the viewer a row belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// All of it that lies in the cell.
    Patch,
    /// One of its corners.
    Corner(usize),
}

/// A spring between two bodies: it presses the viewer along the normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Its name from step to step.
    pub key: Key,
    /// Which of the two points of a patch.
    pub point_of_two: usize,
    /// Where it acts (m).
    pub point: Vector,
    /// Unit normal of the face that is viewed, outwards.
    pub normal: Vector,
    /// Length (m): its stiffness over that of the faces.
    pub weight: f64,
    /// Closure (m), hardened: the force over stiffness and weight.
    pub closure: f64,
    /// Depth (m).
    pub depth: f64,
    /// Whether the force changes with the closure in a step.
    pub is_live: bool,
}

/// The contacts of some bodies at their places.
#[derive(Debug, Clone, Default)]
pub struct Contacts {
    /// All rows, in the order of the bodies.
    pub rows: Vec<Row>,
    /// Energy over the stiffness of the faces (m³).
    pub energy: f64,
    /// Greatest depth of a corner or of a patch (m).
    pub deepest: f64,
    /// The covers.
    pub covers: Covers,
    polygon: Polygon,
    access: Access,
}

impl Contacts {
    /// Finds all rows.
    pub fn find(&mut self, bodies: &[Body], rule: &Rule, hardening: Hardening) {
        self.rows.clear();
        (self.energy, self.deepest) = (0.0, 0.0);
        self.covers.find(bodies, rule);
        for (viewed, body) in bodies.iter().enumerate() {
            for (viewer, other) in bodies.iter().enumerate() {
                let is_pair = viewed != viewer && !(body.is_held && other.is_held);
                if is_pair && body.is_near(other, rule.ledge) {
                    self.find_pair(bodies, [viewed, viewer], rule, hardening);
                }
            }
        }
    }

    fn find_pair(&mut self, bodies: &[Body], pair: [usize; 2], rule: &Rule, hardening: Hardening) {
        let (covers, mut access) = (std::mem::take(&mut self.covers), std::mem::take(&mut self.access));
        let [viewed, viewer] = pair;
        let share = if viewed < viewer { rule.view } else { 1.0 - rule.view };
        for face in 0..bodies[viewed].outline.len() {
            let view = View { bodies, covers: &covers, rule, viewed, face, viewer };
            if !is_beside(&view) {
                continue;
            }
            view.access(&mut access);
            if share > 0.0 {
                self.add_patch(&view, &access, share, hardening);
            }
            if rule.corner > 0.0 {
                self.add_corners(&view, &access, hardening);
            }
        }
        (self.covers, self.access) = (covers, access);
    }

    fn add_patch(&mut self, view: &View, access: &Access, share: f64, hardening: Hardening) {
        let patch = patch(view, access, hardening, &mut self.polygon, |_| ());
        if patch.force <= 0.0 {
            return;
        }
        self.energy += share * patch.energy;
        let axes = view.bodies[view.viewed].faces[view.face];
        let key = Key { viewed: view.viewed, face: view.face, viewer: view.viewer, part: Part::Patch };
        if view.rule.corner == 0.0 {
            self.deepest = self.deepest.max(patch.deepest);
        }
        self.rows.extend(patch.bearings(share).into_iter().enumerate().map(|(point_of_two, bearing)| Row {
            key,
            point_of_two,
            point: axes.global(bearing.at),
            normal: axes.normal(),
            weight: bearing.weight,
            closure: bearing.closure,
            depth: bearing.at.y,
            is_live: bearing.is_live,
        }));
    }

    fn add_corners(&mut self, view: &View, access: &Access, hardening: Hardening) {
        let View { bodies, rule, viewed, face, viewer, .. } = *view;
        let (under, body) = (&bodies[viewed], &bodies[viewer]);
        let normal = under.faces[face].normal();
        for (corner, &point) in body.outline.points.iter().enumerate() {
            if !under.is_about(point, rule.ledge) || !body.is_corner(corner, rule) {
                continue;
            }
            let Some(depth) = view.depth(point, access) else { continue };
            let level = share_of_level(bodies, view.covers, rule, [viewer, corner, viewed], normal);
            let weight = rule.corner * depth.share * level;
            if weight > 0.0 {
                self.energy += weight * hardening.energy(depth.at.y);
                self.deepest = self.deepest.max(depth.at.y);
                let key = Key { viewed, face, viewer, part: Part::Corner(corner) };
                let closure = hardening.pressure(depth.at.y);
                let depth = depth.at.y;
                self.rows.push(Row { key, point_of_two: 0, point, normal, weight, closure, depth, is_live: true });
            }
        }
    }
}

/// Whether the viewer has a part near the face and under it.
fn is_beside(view: &View) -> bool {
    let axes = view.bodies[view.viewed].faces[view.face];
    let mut along = [f64::INFINITY, f64::NEG_INFINITY];
    let mut deep = along;
    for &point in &view.bodies[view.viewer].outline.points {
        let at = axes.local(point);
        along = [along[0].min(at.x), along[1].max(at.x)];
        deep = [deep[0].min(at.y), deep[1].max(at.y)];
    }
    let bands = view.bodies[view.viewed].cells[view.face].bands.iter();
    let lower = bands.map(|band| band.depths[1]).fold(0.0, f64::max);
    let beyond = lower.min(deep[1]).max(view.rule.ledge) * BEYOND;
    deep[1] > 0.0 && deep[0] < lower && along[0] < axes.length + beyond && along[1] > -beyond
}

/// How far a cell may reach beyond its face, over its depth: cells of reflex kinks widen, by half the turn.
const BEYOND: f64 = 10.0;

/// The part of the viewer in the open part of a cell; hands on the parts of its faces there.
pub(crate) fn patch(
    view: &View,
    access: &Access,
    hardening: Hardening,
    polygon: &mut Polygon,
    mut with: impl FnMut(Piece),
) -> Patch {
    let body = &view.bodies[view.viewed];
    let axes = body.faces[view.face];
    let points = &view.bodies[view.viewer].outline.points;
    let deepest = points.iter().map(|&point| axes.local(point).y).fold(0.0, f64::max);
    let mut patch = Patch::default();
    access.each_band(&body.cells[view.face], axes.length, deepest, |open| {
        polygon.set(points.iter().map(|&point| axes.local(point)));
        keep_in_band(polygon, &open.band);
        let [from, to] = open.stretch;
        if from.is_finite() {
            polygon.keep(Vector::new(-1.0, 0.0), -from);
        }
        if to.is_finite() {
            polygon.keep(Vector::new(1.0, 0.0), to);
        }
        patch.add(polygon, hardening);
        pieces(polygon).for_each(&mut with);
    });
    patch
}
