//! A monitor of a joint: how far its faces are apart at a place, and the stress between them.

use crate::contact::{Boundary, ContactState, EdgeId, Facing, VertexEdge};
use crate::cover::CoverId;
use crate::geometry::{Point, TraceId, Vector, segment};
use crate::state::{Model, Quantity, State};

use super::faces::Faces;

/// Numbers of a monitor of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointMonitorState {
    /// Distance (m) of the two faces across the joint; below zero where they overlap.
    pub opening: f64,
    /// Distance (m) of the two faces along the joint, positive where the far one has moved to the right.
    pub slip: f64,
    /// Normal stress (Pa, tension positive) between the faces, 0 where they do not touch.
    pub normal_stress: f64,
    /// Shear stress (Pa), positive where the far face pushes the near one to the right.
    pub shear_stress: f64,
}

/// Numbers of a monitor of a joint as outputs show them.
pub const JOINT_MONITOR_QUANTITIES: [Quantity<JointMonitorState>; 4] = [
    Quantity::plain("opening", "m", "Opening at the place, apart positive", |joint| joint.opening),
    Quantity::plain("slip", "m", "Slip along the joint, far side to the right positive", |joint| joint.slip),
    Quantity::plain("normal_stress", "Pa", "Normal stress between the faces, tension positive", |joint| {
        joint.normal_stress
    }),
    Quantity::plain("shear_stress", "Pa", "Shear stress between the faces, as the slip", |joint| joint.shear_stress),
];

impl JointMonitorState {
    /// That of a joint of which a side has been excavated.
    const GONE: Self = Self { opening: f64::NAN, slip: f64::NAN, normal_stress: f64::NAN, shear_stress: f64::NAN };
}

/// A place on a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointPlace {
    /// Reference point (m).
    pub place: Point,
    /// Its distance (m) from the point that was sought.
    pub distance: f64,
    /// Number of the piece of joint.
    piece: usize,
}

impl JointPlace {
    /// The place nearest to a point on the joints of some traces; the first of several.
    pub fn nearest(boundary: &Boundary, faces: &Faces, point: Point, on: &dyn Fn(TraceId) -> bool) -> Option<Self> {
        let of = |(piece, facing): (usize, &Facing)| {
            boundary.trace[facing.edges[0]].filter(|&trace| on(trace))?;
            let [a, b] = reference_ends(boundary, facing);
            let place = segment::foot(point, a, b);
            Some(Self { place, distance: (place - point).norm(), piece })
        };
        let places = faces.pieces.iter().enumerate().filter_map(of);
        places.min_by(|a, b| a.distance.total_cmp(&b.distance))
    }
}

/// A monitor of a joint: a gauge with an anchor on either face, and the faces whose contacts give the stress.
#[derive(Debug, Clone)]
pub struct JointMonitor {
    /// Reference point (m) on the joint.
    pub place: Point,
    /// Edges on which the anchors are, and how far along them.
    anchors: [(EdgeId, f64); 2],
    /// Faces whose contacts count, in order.
    faces: Vec<usize>,
    /// Greatest distance (m) along the joint at which they count.
    reach: f64,
    /// Length (m) of the face, over which their forces act; none where those near count, over their own lengths.
    face_length: Option<f64>,
}

impl JointMonitor {
    /// That at a place: over a length (m) of its joint, or else over the face of the two blocks there.
    pub fn new(boundary: &Boundary, faces: &Faces, place: JointPlace, length: Option<f64>) -> Self {
        let own = &faces.pieces[place.piece];
        let [a, b] = reference_ends(boundary, own);
        let along = (b - a).norm();
        let share = if along > 0.0 { (place.place - a).norm() / along } else { 0.0 };
        let anchors = [0, 1].map(|k| (own.edges[k], own.spans[k][0] + share * (own.spans[k][1] - own.spans[k][0])));
        let reach = length.map_or(f64::INFINITY, |length| 0.5 * length);
        let trace = boundary.trace[own.edges[0]];
        let is_near = |piece: &&Facing| {
            let [a, b] = reference_ends(boundary, piece);
            boundary.trace[piece.edges[0]] == trace && segment::distance(place.place, a, b) <= reach
        };
        let mut counted: Vec<usize> = match length {
            Some(_) => faces.pieces.iter().filter(is_near).map(|piece| piece.face).collect(),
            None => vec![own.face],
        };
        counted.sort_unstable();
        counted.dedup();
        let of_face = faces.pieces.iter().filter(|piece| piece.face == own.face);
        let length_of = |piece: &Facing| {
            let [a, b] = reference_ends(boundary, piece);
            (b - a).norm()
        };
        let face_length = length.is_none().then(|| of_face.map(length_of).sum());
        Self { place: place.place, anchors, faces: counted, reach, face_length }
    }

    /// The joint now, by the contacts of now.
    pub fn read(&self, (model, faces): (&Model, &Faces), state: &State, contacts: &[VertexEdge]) -> JointMonitorState {
        let boundary = &model.boundary;
        if self.anchors.iter().any(|(edge, _)| state.removed[boundary.block[*edge]]) {
            return JointMonitorState::GONE;
        }
        let [opening, slip] = self.apart(model, &state.displacement);
        let [opening_before, slip_before] = state.counted_from().map_or([0.0; 2], |from| self.apart(model, from));
        let [normal_stress, shear_stress] = self.stress(model, faces, &state.displacement, contacts);
        JointMonitorState { opening: opening - opening_before, slip: slip - slip_before, normal_stress, shear_stress }
    }

    /// Distance (m) of the second anchor from the first across and along the face of the first, with displacements of
    /// the covers (m).
    fn apart(&self, model: &Model, displacement: &[Vector]) -> [f64; 2] {
        let [first, second] = self.anchors.map(|anchor| moved(model, displacement, anchor));
        let along = direction(model, displacement, self.anchors[0].0);
        let normal = Vector::new(along.y, -along.x);
        let apart = second - first;
        [apart.dot(&normal), apart.perp(&normal)]
    }

    /// Normal and shear stress (Pa): forces of the contacts that are closed, over the length of the face, or of those
    /// that are near over their lengths. Contacts at corners stand for less than half of the way to the next node, so
    /// that the lengths of all do not add up to that of the face.
    fn stress(&self, model: &Model, faces: &Faces, displacement: &[Vector], contacts: &[VertexEdge]) -> [f64; 2] {
        let boundary = &model.boundary;
        let [first, second] = self.anchors.map(|anchor| self.place + moved(model, displacement, anchor));
        let (middle, along) = ((first + second) * 0.5, direction(model, displacement, self.anchors[0].0));
        let counts = |contact: &&VertexEdge| {
            let face = faces.between(boundary, contact.history.edge, contact.history.node);
            contact.history.state != ContactState::Open
                && face.is_some_and(|(face, _)| self.faces.binary_search(&face).is_ok())
        };
        let near: Vec<(f64, &VertexEdge)> = contacts
            .iter()
            .filter(counts)
            .map(|contact| {
                let node = boundary.nodes.point[contact.history.node];
                ((boundary_point(model, displacement, node) - middle).dot(&along).abs(), contact)
            })
            .collect();
        // Where no contact is so near, those count that are nearest.
        let nearest = near.iter().map(|(distance, _)| *distance).fold(f64::INFINITY, f64::min);
        let reach = self.reach.max(nearest + model.covers.mesh.size * TOGETHER);
        let mut sums = [0.0; 3];
        for (_, contact) in near.iter().filter(|(distance, _)| *distance <= reach) {
            let history = &contact.history;
            let of = [-history.normal_force, history.shear_force, contact.length];
            sums = [0, 1, 2].map(|k| sums[k] + of[k]);
        }
        let [normal, shear, length] = sums;
        let length = self.face_length.unwrap_or(length);
        if length > 0.0 { [normal / length, shear / length] } else { [0.0; 2] }
    }
}

/// Distance over the mesh size within which nodes of both faces are at one place.
const TOGETHER: f64 = 1e-6;

/// Ends (m) of a piece of joint on its first face in the reference configuration.
fn reference_ends(boundary: &Boundary, piece: &Facing) -> [Point; 2] {
    let edge = piece.edges[0];
    let [a, b] = [boundary.reference[edge], boundary.reference[boundary.after(edge)]];
    piece.spans[0].map(|share| a + (b - a) * share)
}

/// Place (m) of a point of the boundary with displacements of the covers (m).
fn boundary_point(model: &Model, displacement: &[Vector], point: EdgeId) -> Point {
    let boundary = &model.boundary;
    let position = |i: CoverId| model.covers.star_position[i] + displacement[i];
    boundary.covers[point].iter().zip(&boundary.weights[point]).map(|(&i, weight)| position(i) * *weight).sum()
}

/// Displacement (m) of an anchor; from displacements alone, so that it is accurate far from the origin.
fn moved(model: &Model, displacement: &[Vector], (edge, share): (EdgeId, f64)) -> Vector {
    let [a, b] = [edge, model.boundary.after(edge)].map(|point| model.boundary.sample(point, displacement));
    a + (b - a) * share
}

/// Unit vector along an edge.
fn direction(model: &Model, displacement: &[Vector], edge: EdgeId) -> Vector {
    let [a, b] = [edge, model.boundary.after(edge)].map(|point| boundary_point(model, displacement, point));
    (b - a) / (b - a).norm().max(f64::MIN_POSITIVE)
}
