//! Joints at one instant: the pieces between two faces that lay on each other at the start, with what has become of
//! them, and the pieces of boundary that blocks have come to touch since.

use std::collections::BTreeMap;

use enmm::geometry::{Point, Vector};
use enmm::model::tables::{BlockId, Boundary, EdgeId, Faces, Facing, NodeId, VertexEdge};
use enmm::model::{ContactState, Quantity, Simulation};

use crate::bonds::{BondState, bond_states};
use crate::edges::EdgeStates;

/// A straight piece of joint now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointPiece {
    /// Ends (m) on the face of the first block.
    pub ends: [Point; 2],
    /// Unit normal out of the first block.
    pub normal: Vector,
    /// Numbers of both blocks; equal where a joint ends inside a block.
    pub blocks: [u32; 2],
    /// Index of the joint law in the case.
    pub law: u32,
    /// Distance (m) of the second face from the first along the normal since the start; below zero when they overlap.
    pub opening: f64,
    /// Distance (m) of the two faces along the joint since the start.
    pub slip: f64,
    /// Force (N/m) on the first block; the sum over the pieces of a face is the force on the face.
    pub force: Vector,
    /// Normal stress (Pa, tension positive): the force on the face over the length of it that is closed.
    pub normal_stress: f64,
    /// Shear stress (Pa), as the normal stress; positive when it drives the first block forward with rock on its left.
    pub shear_stress: f64,
    /// Open, slip or lock.
    pub state: ContactState,
    /// Whether it is a bond, such as a rock bridge, and whether that holds.
    pub bond: BondState,
    /// Whether the two faces lay on each other at the start.
    pub is_joint: bool,
}

/// Numbers of a piece of joint as outputs show them.
pub const JOINT_QUANTITIES: [Quantity<JointPiece>; 4] = [
    Quantity::plain("opening", "m", "Opening since the start, apart positive", |joint| joint.opening),
    Quantity::plain("slip", "m", "Slip along the joint since the start", |joint| joint.slip),
    Quantity::plain("normal_stress", "Pa", "Normal stress, tension positive", |joint| joint.normal_stress),
    Quantity::plain("shear_stress", "Pa", "Shear stress", |joint| joint.shear_stress),
];

/// The joints of a model as it was built: which edges of the boundary face each other.
#[derive(Debug, Clone)]
pub struct Joints(Faces);

/// Slip of a piece of joint in a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlipSince {
    /// Number of the joint trace.
    pub trace: usize,
    /// Index of its law in the case.
    pub law: u32,
    /// Distance (m) by which one face has moved along the other.
    pub slip: f64,
    /// Middle of the piece now (m).
    pub place: Point,
}

/// Forces (N/m) on the first block of a face: their sum, and their parts across (tension positive) and along it.
#[derive(Debug, Clone, Copy, Default)]
struct Load {
    force: Vector,
    normal: f64,
    shear: f64,
}

/// Forces on all faces, and those between edges that did not face each other, by the node at or before the edge and the
/// other block.
struct Forces {
    faces: Vec<Load>,
    touched: BTreeMap<(NodeId, BlockId), Touch>,
}

impl Joints {
    /// Finds the faces that lie on each other.
    pub fn of(simulation: &Simulation) -> Self {
        Self(Faces::of(&simulation.model().boundary, &simulation.built().traces))
    }

    /// Pieces of joint from the point of a node to the next node, of those that are on the first of their two faces.
    pub fn along(&self, boundary: &Boundary, point: EdgeId) -> Vec<u32> {
        let end = boundary.nodes.point[boundary.nodes.next[boundary.node_before[point]]];
        let edges = std::iter::successors(Some(point), |&edge| Some(boundary.after(edge)).filter(|&next| next != end));
        let Self(faces) = self;
        let first = |edge: EdgeId| faces.on(edge).iter().filter(move |&&k| faces.pieces[k as usize].edges[0] == edge);
        edges.flat_map(first).copied().collect()
    }

    /// Opening and slip (m) of all pieces since the start, in their order; 0 of those of excavated blocks.
    pub fn moved(&self, simulation: &Simulation) -> Vec<[f64; 2]> {
        let (boundary, removed) = (&simulation.model().boundary, &simulation.state().removed);
        let positions = simulation.positions();
        let moved = |piece: &Facing| {
            if piece.edges.into_iter().any(|edge| removed[boundary.block[edge]]) {
                return [0.0; 2];
            }
            let JointPiece { opening, slip, .. } = seen(simulation, &positions, piece);
            [opening, slip]
        };
        self.0.pieces.iter().map(moved).collect()
    }

    /// The joints now; those of excavated blocks are left out.
    pub fn now(&self, simulation: &Simulation) -> Vec<JointPiece> {
        let (model, removed) = (simulation.model(), &simulation.state().removed);
        let boundary = &model.boundary;
        let positions = simulation.positions();
        let mut states = EdgeStates::new(boundary, &positions);
        let mut forces = Forces { faces: vec![Load::default(); self.0.count], touched: BTreeMap::new() };
        simulation.each_contact(|contact| {
            states.see(contact);
            self.add(boundary, contact, &mut forces);
        });
        let (states, Forces { faces: loads, touched }) = (states.found, forces);
        let state = |piece: &Facing| strongest(piece.edges.map(|edge| states[edge].unwrap_or_default()));
        let length = |piece: &Facing| {
            let [a, b] = ends(boundary, &positions, piece.edges[0], piece.spans[0]);
            (b - a).norm()
        };
        let mut closed = vec![[0.0; 2]; self.0.count];
        for piece in &self.0.pieces {
            closed[piece.face][usize::from(state(piece) == ContactState::Open)] += length(piece);
        }
        let bonds = bond_states(simulation);
        let there = |edge: EdgeId| !removed[boundary.block[edge]];
        let mut found: Vec<JointPiece> = Vec::with_capacity(self.0.pieces.len());
        for piece in self.0.pieces.iter().filter(|piece| piece.edges.into_iter().all(there)) {
            let mut seen = seen(simulation, &positions, piece);
            seen.state = state(piece);
            seen.bond = piece.edges.map(|edge| bonds[edge.index()]).into_iter().max().unwrap_or_default();
            // A loaded face without a closed piece is taken as loaded over its whole length.
            let [closed, open] = closed[piece.face];
            let (over, bears) = if closed > 0.0 { (closed, seen.state != ContactState::Open) } else { (open, true) };
            if bears && over > 0.0 {
                let load = loads[piece.face];
                seen.force = load.force * (length(piece) / over);
                (seen.normal_stress, seen.shear_stress) = (load.normal / over, load.shear / over);
            }
            found.push(seen);
        }
        found.extend(touched.into_iter().map(|(key, load)| touch(simulation, &positions, key, load)));
        found
    }

    /// How far the faces have slipped (m) along each piece since the covers had other displacements (m), with the
    /// middle of the piece; those of excavated blocks are left out.
    pub fn slips_since(&self, simulation: &Simulation, began: &[Vector]) -> Vec<SlipSince> {
        let (boundary, state) = (&simulation.model().boundary, simulation.state());
        let positions = simulation.positions();
        let there = |edge: EdgeId| !state.removed[boundary.block[edge]];
        let moved = |point: EdgeId| boundary.sample(point, &state.displacement) - boundary.sample(point, began);
        let slip = |piece: &Facing| {
            let [own, other] = [0, 1].map(|k| {
                let (edge, span) = (piece.edges[k], piece.spans[k]);
                let share = 0.5 * (span[0] + span[1]);
                moved(edge) * (1.0 - share) + moved(boundary.after(edge)) * share
            });
            let ends = ends(boundary, &positions, piece.edges[0], piece.spans[0]);
            let trace = boundary.trace[piece.edges[0]]?;
            let law = state.law_switch[simulation.model().trace_law[trace]].number();
            let slip = (own - other).perp(&outward(ends)).abs();
            Some(SlipSince { trace: trace.index(), law, slip, place: (ends[0] + ends[1]) * 0.5 })
        };
        self.0.pieces.iter().filter(|piece| piece.edges.into_iter().all(there)).filter_map(slip).collect()
    }

    /// Adds the forces of a contact to its face, or else to those between edges that did not face each other.
    fn add(&self, boundary: &Boundary, contact: &VertexEdge, forces: &mut Forces) {
        let history = &contact.history;
        if history.state == ContactState::Open {
            return;
        }
        let force = contact.normal * history.normal_force + contact.tangent() * history.shear_force;
        let add = |load: &mut Load, sign: f64| {
            load.force += force * sign;
            load.normal -= history.normal_force;
            load.shear += history.shear_force;
        };
        match self.0.between(boundary, history.edge, history.node) {
            Some((face, is_first)) => add(&mut forces.faces[face], if is_first { -1.0 } else { 1.0 }),
            None => {
                let other = boundary.block[boundary.nodes.point[history.node]];
                let key = (boundary.node_before[history.edge], other);
                let touch = forces.touched.entry(key).or_default();
                add(&mut touch.load, -1.0);
                touch.law = contact.law.number();
                touch.state = strongest([touch.state, history.state]);
            }
        }
    }
}

/// Contacts on a stretch between two nodes of a block that did not face the other block at the start.
#[derive(Debug, Clone, Copy, Default)]
struct Touch {
    load: Load,
    law: u32,
    state: ContactState,
}

/// Slip before lock before open.
fn strongest([a, b]: [ContactState; 2]) -> ContactState {
    let rank = |state| [ContactState::Open, ContactState::Lock, ContactState::Slip].iter().position(|s| *s == state);
    if rank(a) >= rank(b) { a } else { b }
}

/// Both ends of a part of an edge now (m).
fn ends(boundary: &Boundary, positions: &[Point], edge: EdgeId, span: [f64; 2]) -> [Point; 2] {
    let [a, b] = [positions[edge], positions[boundary.after(edge)]];
    span.map(|share| a + (b - a) * share)
}

/// Unit normal to the right of the way from one point to another.
fn outward([a, b]: [Point; 2]) -> Vector {
    let along = (b - a) / (b - a).norm().max(f64::MIN_POSITIVE);
    Vector::new(along.y, -along.x)
}

/// Where a piece of joint is and how far it is open; without forces.
fn seen(simulation: &Simulation, positions: &[Point], piece: &Facing) -> JointPiece {
    let (model, switch) = (simulation.model(), &simulation.state().law_switch);
    let boundary = &model.boundary;
    let [own, other] = [0, 1].map(|k| ends(boundary, positions, piece.edges[k], piece.spans[k]));
    let normal = outward(own);
    let apart = (other[0] + other[1] - own[0] - own[1]) * 0.5;
    let law = boundary.trace[piece.edges[0]].map_or(model.default_law, |trace| model.trace_law[trace]);
    JointPiece {
        ends: own,
        normal,
        blocks: piece.edges.map(|edge| model.labels[boundary.block[edge]]),
        law: switch[law].number(),
        opening: apart.dot(&normal),
        slip: apart.perp(&normal).abs(),
        force: Vector::zeros(),
        normal_stress: 0.0,
        shear_stress: 0.0,
        state: ContactState::Open,
        bond: BondState::None,
        is_joint: true,
    }
}

/// The stretch between two nodes that another block touches.
fn touch(simulation: &Simulation, positions: &[Point], (node, other): (NodeId, BlockId), touch: Touch) -> JointPiece {
    let model = simulation.model();
    let boundary = &model.boundary;
    let [from, to] = [node, boundary.nodes.next[node]].map(|node| boundary.nodes.point[node]);
    let ends = [positions[from], positions[to]];
    let length = (ends[1] - ends[0]).norm().max(f64::MIN_POSITIVE);
    JointPiece {
        ends,
        normal: outward(ends),
        blocks: [boundary.block[from], other].map(|block| model.labels[block]),
        law: touch.law,
        opening: 0.0,
        slip: 0.0,
        force: touch.load.force,
        normal_stress: touch.load.normal / length,
        shear_stress: touch.load.shear / length,
        state: touch.state,
        bond: BondState::None,
        is_joint: false,
    }
}
