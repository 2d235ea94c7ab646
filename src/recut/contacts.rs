//! Contacts after a cut: those that it leaves alone go on as they were, others bear what was there before, and new
//! faces bear the stress of the rock.

use std::collections::BTreeMap;

use crate::contact::{
    BondHistory, Boundary, Closure, ContactHistory, ContactState, EdgeId, Meeting, NodeId, SectionId, SideId, Unloaded,
    VertexEdge,
};
use crate::cover::BlockId;
use crate::geometry::{Point, TraceId, Vector, segment};
use crate::mechanics::Resultants;
use crate::state::{Cut, Model, State};
use crate::step::{self, Regime};

use super::lineage::Lineage;

/// Cosine above which the normals of two contacts are those of one face.
const ONE_FACE: f64 = 0.9;

/// What contacts share that one can go on for another: blocks before the cut of node and side, and joint.
type Face = ([BlockId; 2], Option<TraceId>);

/// A contact before the cut.
struct Bearing {
    contact: VertexEdge,
    bond: BondHistory,
    /// Where its node was in the reference configuration (m).
    at: Point,
}

/// A contact after the cut that has forces (N/m) normal and shear of its own.
struct Loaded {
    history: ContactHistory,
    bond: BondHistory,
    /// Face whose whole force is kept, where it takes the place of others.
    shares: Option<Face>,
}

/// Carries contacts and bonds over into a state whose displacements are there, after a cut of a stage or a section that
/// has broken.
pub fn carry_contacts(
    lineage: &Lineage,
    (old, was): (&Model, &State),
    new: &Model,
    broken: Option<&Cut>,
    state: &mut State,
) {
    state.contacts.clear();
    state.bonds.clear();
    if was.step == 0 {
        // The first step finds them in rock that has not moved.
        return;
    }
    let carry = Carry { lineage, old, was, new, before: Before::new(old, was) };
    let softens = step::has_bonds(new, state);
    let mut seeds = carry.kept();
    seeds.extend(carry.touching(state));
    seeds.sort_by_key(|(history, _)| key(history));
    state.contacts = seeds.iter().map(|(history, _)| *history).collect();
    if softens {
        state.bonds = seeds.iter().map(|(_, bond)| *bond).collect();
    }
    let (_, ahead) = step::look_ahead(new, Regime::AT_REST, state, true);
    let load = |contact: &VertexEdge| Some((*contact, carry.load(contact, &seeds)?));
    let mut loaded: Vec<(VertexEdge, Loaded)> = ahead.contacts.iter().filter_map(load).collect();
    carry.hand_over(&mut loaded);
    if let Some(broken) = broken {
        carry.balance(broken, &mut loaded);
    }
    state.contacts = loaded.iter().map(|(_, loaded)| loaded.history).collect();
    if softens {
        state.bonds = loaded.iter().map(|(_, loaded)| loaded.bond).collect();
    }
}

/// What tells a contact from others.
fn key(history: &ContactHistory) -> (NodeId, SideId) {
    (history.node, history.side)
}

/// All contacts before the cut.
struct Before {
    faces: BTreeMap<Face, Vec<Bearing>>,
    /// Gap (m) and stiffnesses (N/m per metre) of each.
    springs: BTreeMap<(NodeId, SideId), (f64, [f64; 2])>,
}

impl Before {
    fn new(old: &Model, was: &State) -> Self {
        let mut state = was.clone();
        state.neighbours.forget();
        state.found.forget();
        // Forces that damp a stage find no contacts.
        state.stage_displacement.clear();
        state.stage_force.clear();
        let (_, ahead) = step::look_ahead(old, Regime::AT_REST, &state, true);
        let springs = ahead.contacts.iter().map(|c| (key(&c.history), (c.gap, c.stiffness)));
        let springs = springs.collect();
        let mut faces: BTreeMap<Face, Vec<Bearing>> = BTreeMap::new();
        for contact in ahead.contacts.into_iter().filter(|contact| !contact.fresh) {
            let Ok(k) = was.contacts.binary_search_by_key(&key(&contact.history), key) else { continue };
            let bond = was.bonds.get(k).copied().unwrap_or_default();
            let face = (contact.blocks(&old.boundary), trace(&old.boundary, &contact));
            let at = old.boundary.reference[contact.point];
            faces.entry(face).or_default().push(Bearing { contact, bond, at });
        }
        Self { faces, springs }
    }
}

/// Joint of a contact: that of the edge, or else of the node.
fn trace(boundary: &Boundary, contact: &VertexEdge) -> Option<TraceId> {
    boundary.trace[contact.history.edge].or_else(|| boundary.node_trace(contact.history.node))
}

struct Carry<'a> {
    lineage: &'a Lineage,
    old: &'a Model,
    was: &'a State,
    new: &'a Model,
    before: Before,
}

impl Carry<'_> {
    /// Contacts whose node and side the cut has left as they were, under their new numbers.
    fn kept(&self) -> Vec<(ContactHistory, BondHistory)> {
        let nodes = inverse(&self.lineage.nodes, self.old.boundary.node_count(), NodeId::index);
        let sides = inverse(&self.lineage.sides, self.old.boundary.sides.ends.len(), SideId::index);
        let mut kept = Vec::new();
        for (k, history) in self.was.contacts.iter().enumerate() {
            let (node, side) = (nodes[history.node.index()], sides[history.side.index()]);
            let Some((node, side)) = node.zip(side).map(|(n, s)| (NodeId::new(n), SideId::new(s))) else { continue };
            let edge = self.edge_like(side, history.edge);
            let bond = self.was.bonds.get(k).copied().unwrap_or_default();
            kept.push((ContactHistory { node, side, edge, ..*history }, self.bond_of(bond, edge)));
        }
        kept
    }

    /// Contacts of new nodes and sides on faces that touch: those of the rock before it moved, with what they bear now.
    /// A bond may have opened since, and no new contact would be found across it, but one that pulls is kept.
    fn touching(&self, state: &State) -> Vec<(ContactHistory, BondHistory)> {
        let mut unmoved = state.clone();
        unmoved.displacement.fill(Vector::zeros());
        unmoved.velocity.fill(Vector::zeros());
        let (_, ahead) = step::look_ahead(self.new, Regime::AT_REST, &unmoved, true);
        let is_new = |contact: &&VertexEdge| !self.is_known(&contact.history) && self.touches(contact);
        let loaded = ahead.contacts.iter().filter(is_new).filter_map(|contact| self.bears(contact));
        loaded.map(|loaded| (loaded.history, loaded.bond)).collect()
    }

    /// Whether the cut has left node and side of a contact as they were.
    fn is_known(&self, history: &ContactHistory) -> bool {
        self.lineage.nodes[history.node].is_some() && self.lineage.sides[history.side].is_some()
    }

    /// Whether a contact lies on a face of the cut, or on one that has borne within a mesh size of it.
    fn touches(&self, contact: &VertexEdge) -> bool {
        let face = self.face(contact);
        let at = self.new.boundary.reference[contact.point];
        let is_near = |was: &Bearing| (was.at - at).norm() <= self.new.covers.mesh.size;
        self.is_of_cut(face) || self.before.faces.get(&face).into_iter().flatten().any(is_near)
    }

    /// The face of a contact after the cut as it was before.
    fn face(&self, contact: &VertexEdge) -> Face {
        let boundary = &self.new.boundary;
        (contact.blocks(boundary).map(|block| self.lineage.parents.blocks[block]), trace(boundary, contact))
    }

    /// Whether the cut has made a face.
    fn is_of_cut(&self, (_, joint): Face) -> bool {
        joint.is_some_and(|joint| joint.index() >= self.lineage.traces)
    }

    /// The edge of a side on which the middle of an edge before the cut lies.
    fn edge_like(&self, side: SideId, edge: EdgeId) -> EdgeId {
        let (old, new) = (&self.old.boundary, &self.new.boundary);
        let middle = (old.reference[edge] + old.reference[old.after(edge)]) * 0.5;
        let [first, last] = new.sides.ends[side].map(|end| end.edge);
        let all = std::iter::successors(Some(first), |&edge| (edge != last).then(|| new.after(edge)));
        let distance = |edge: &EdgeId| segment::distance(middle, new.reference[*edge], new.reference[new.after(*edge)]);
        all.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(first)
    }

    /// A bond on an edge after the cut: it breaks with the part of its section that has the edge.
    fn bond_of(&self, bond: BondHistory, edge: EdgeId) -> BondHistory {
        let is_part = |id: &SectionId| self.lineage.sections[id.index()] == bond.section.map(|section| section.index());
        let section = bond.section.and_then(|_| self.new.sections.of(edge)).filter(is_part);
        BondHistory { section, ..bond }
    }

    /// A contact after the cut with what it bears; none where the next step is to find it by itself.
    fn load(&self, contact: &VertexEdge, seeds: &[(ContactHistory, BondHistory)]) -> Option<Loaded> {
        if self.is_known(&contact.history) {
            let k = seeds.binary_search_by_key(&key(&contact.history), |(history, _)| key(history)).ok()?;
            let (mut history, bond) = seeds[k];
            if history.normal_force != 0.0 {
                self.go_on(contact, &mut history);
            }
            return Some(Loaded { history, bond, shares: None });
        }
        self.bears(contact)
    }

    /// What a contact of a new node or side bears.
    fn bears(&self, contact: &VertexEdge) -> Option<Loaded> {
        let face = self.face(contact);
        if self.is_of_cut(face) { Some(self.on_new_face(contact, face)) } else { self.on_old_face(contact, face) }
    }

    /// Node and side of a contact before the cut, if the cut has left both as they were.
    fn was(&self, contact: &VertexEdge) -> Option<(NodeId, SideId)> {
        self.lineage.nodes[contact.history.node].zip(self.lineage.sides[contact.history.side])
    }

    /// Gives a contact that goes on with another gap or stiffness, beside a node that the cut has made, the rest length
    /// at which its spring is closed as far as it was.
    fn go_on(&self, contact: &VertexEdge, history: &mut ContactHistory) {
        let was = self.was(contact).and_then(|was| self.before.springs.get(&was));
        if let Some(&(gap_before, _)) = was.filter(|was| **was != (contact.gap, contact.stiffness)) {
            history.unloaded = Unloaded { offset: 0.0, rest: gap(contact) - gap_before };
        }
    }

    /// A contact on a face that the cut has made bears the stress that the rock has there.
    fn on_new_face(&self, contact: &VertexEdge, ([block, _], _): Face) -> Loaded {
        let [xx, yy, xy] = self.stress_about(contact, block);
        let normal = contact.normal;
        let traction = Vector::new(xx * normal.x + xy * normal.y, xy * normal.x + yy * normal.y) * contact.length;
        let mut history = ContactHistory {
            normal_force: -traction.dot(&normal),
            shear_force: -traction.dot(&contact.tangent()),
            filtered_normal: (-traction.dot(&normal)).max(0.0),
            meeting: Meeting { age: f32::INFINITY, ..Meeting::default() },
            state: ContactState::Lock,
            intact: true,
            ..contact.history
        };
        settle(contact, self.new, &mut history);
        Loaded { history, bond: self.new_bond(contact), shares: None }
    }

    /// The bond of a contact on a face that the cut has made, which lets go with the section that has broken there.
    fn new_bond(&self, contact: &VertexEdge) -> BondHistory {
        let edges = [contact.history.edge].into_iter().chain(self.new.boundary.edges_about(contact.history.node));
        let section = edges.filter_map(|edge| self.new.sections.of(edge)).find(|&section| self.is_new(section));
        let bond =
            |_| BondHistory { damage: 0.0, lengths: [contact.length, contact.bonded], law: contact.law, section };
        section.map_or_else(BondHistory::default, bond)
    }

    /// Whether the cut has made a section.
    fn is_new(&self, section: SectionId) -> bool {
        self.lineage.sections[section.index()].is_none()
    }

    /// Changes the forces on a section that has just broken, linearly along it, so that they are in balance with what
    /// it has carried: the stress of single elements is not.
    fn balance(&self, broken: &Cut, loaded: &mut [(VertexEdge, Loaded)]) {
        let [from, to] = broken.ends;
        let (middle, along) = ((from + to) * 0.5, (to - from).normalize());
        let is_on = |loaded: &Loaded| loaded.bond.section.is_some_and(|section| self.is_new(section));
        let place = |contact: &VertexEdge| (self.new.boundary.reference[contact.point] - middle).dot(&along);
        let Resultants { normal, shear, moment } = broken.carried;
        // Compression is positive in contacts, and their shear acts on nodes along their edges.
        let (mut missing, mut lengths) = ([-normal, -shear, moment], [0.0; 3]);
        for (contact, loaded) in loaded.iter().filter(|(_, loaded)| is_on(loaded)) {
            let (length, at, history) = (contact.length, place(contact), &loaded.history);
            missing[0] -= history.normal_force;
            missing[1] -= history.shear_force;
            missing[2] -= history.normal_force * at;
            lengths = [lengths[0] + length, lengths[1] + length * at, lengths[2] + length * at * at];
        }
        let [all, first, second] = lengths;
        let both = all * second - first * first;
        if both <= 0.0 {
            return;
        }
        let even = (missing[0] * second - missing[2] * first) / both;
        let rising = (missing[2] * all - missing[0] * first) / both;
        for (contact, loaded) in loaded.iter_mut().filter(|(_, loaded)| is_on(loaded)) {
            let (length, at) = (contact.length, place(contact));
            let history = &mut loaded.history;
            history.normal_force += length * (even + rising * at);
            history.shear_force += length * (missing[1] / all);
            history.filtered_normal = history.normal_force.max(0.0);
            settle(contact, self.new, history);
        }
    }

    /// Mean stress (Pa) of the rock before the cut on both sides of a node, along the face.
    fn stress_about(&self, contact: &VertexEdge, block: BlockId) -> [f64; 3] {
        let (boundary, covers) = (&self.new.boundary, &self.old.covers);
        let edge = contact.history.edge;
        let along = (boundary.reference[boundary.after(edge)] - boundary.reference[edge]).normalize();
        let at = boundary.reference[contact.point];
        let places = [-0.5, 0.5].map(|share| at + along * (share * contact.length));
        let found = places.into_iter().chain([at]).filter_map(|p| covers.element_at(p));
        let stresses: Vec<[f64; 3]> =
            found.filter(|&e| covers.element_block[e] == block).map(|e| self.old.stress(self.was, e)).collect();
        let count = stresses.len().max(1) as f64;
        [0, 1, 2].map(|k| stresses.iter().map(|stress| stress[k]).sum::<f64>() / count)
    }

    /// A contact on a face that was there, which is to take its part of what the contacts about it have borne.
    fn on_old_face(&self, contact: &VertexEdge, face: Face) -> Option<Loaded> {
        let at = self.new.boundary.reference[contact.point];
        let is_of_face = |was: &&Bearing| was.contact.normal.dot(&contact.normal) > ONE_FACE;
        let mut near: Vec<&Bearing> = self.before.faces.get(&face).into_iter().flatten().filter(is_of_face).collect();
        near.sort_by(|a, b| (a.at - at).norm().total_cmp(&(b.at - at).norm()));
        let first = near.first()?;
        let beyond = near.iter().find(|other| (other.at - at).dot(&(first.at - at)) < 0.0);
        let share = beyond.map_or(0.0, |other| {
            let [near, far] = [first.at, other.at].map(|place| (place - at).norm());
            near / (near + far)
        });
        let ContactHistory { node, side, edge, share: strength, .. } = contact.history;
        let mut history = ContactHistory {
            node,
            side,
            edge,
            share: strength,
            normal_force: 0.0,
            shear_force: 0.0,
            filtered_normal: 0.0,
            trend: [0.0; 2],
            ..first.contact.history
        };
        let lengths = [contact.length, contact.bonded];
        let bond = self.bond_of(BondHistory { lengths, ..first.bond }, edge);
        let law = &self.new.laws[contact.law];
        let is_spring = !law.penalty[0] && law.closure_max.is_infinite() && law.softening.is_none();
        if is_spring {
            let rest = |of: &Bearing| of.contact.history.unloaded.gap();
            let rest = rest(first) * (1.0 - share) + beyond.map_or(0.0, |other| rest(other) * share);
            let pull = if history.normal_force < 0.0 { f64::NEG_INFINITY } else { 0.0 };
            let traction = |of: fn(&ContactHistory) -> f64| {
                let at = |was: &Bearing| of(&was.contact.history) / was.contact.length;
                at(first) * (1.0 - share) + beyond.map_or(0.0, |other| at(other) * share)
            };
            history.normal_force = (contact.stiffness[0] * (rest - gap(contact))).max(pull);
            history.shear_force = traction(|history| history.shear_force) * contact.length;
            history.filtered_normal = traction(|history| history.filtered_normal) * contact.length;
            history.unloaded = Unloaded { offset: 0.0, rest };
            history.sheared = history.shear_force / contact.stiffness[1];
        } else {
            // As far closed as those that it takes the place of, whose forces and lengths may just have had a peak.
            let before = first.contact.gap * (1.0 - share) + beyond.map_or(0.0, |other| other.contact.gap * share);
            history.unloaded = Unloaded { offset: 0.0, rest: gap(contact) - before };
        }
        Some(Loaded { history, bond, shares: (!is_spring).then_some(face) })
    }

    /// Hands the forces of contacts that have gone, and the part that those give away which have become shorter beside
    /// a node that the cut has made, to the contacts that take their place on the same face: to the nearest ones on
    /// both sides, as a beam on two supports does. So each face carries what it did, about where it did, and none of
    /// its contacts pulls that has not pulled before.
    fn hand_over(&self, loaded: &mut [(VertexEdge, Loaded)]) {
        let mut takers: BTreeMap<Face, Vec<usize>> = BTreeMap::new();
        let mut kept: BTreeMap<(NodeId, SideId), usize> = BTreeMap::new();
        for (k, (contact, loaded)) in loaded.iter().enumerate() {
            if let Some(face) = loaded.shares {
                takers.entry(face).or_default().push(k);
            }
            kept.extend(self.was(contact).map(|was| (was, k)));
        }
        for (face, takers) in &takers {
            for was in &self.before.faces[face] {
                let own = kept.get(&key(&was.contact.history)).copied();
                let stays = own.map_or(0.0, |k| (loaded[k].0.stiffness[0] / was.contact.stiffness[0]).min(1.0));
                if let Some(k) = own {
                    add_share(&mut loaded[k].1.history, &was.contact.history, stays - 1.0);
                }
                for (k, share) in self.takers_of(was, takers, loaded).into_iter().flatten() {
                    add_share(&mut loaded[k].1.history, &was.contact.history, share * (1.0 - stays));
                }
            }
        }
    }

    /// The contacts that take the force of one before the cut, with their shares of it.
    fn takers_of(&self, was: &Bearing, takers: &[usize], loaded: &[(VertexEdge, Loaded)]) -> [Option<(usize, f64)>; 2] {
        let way = |k: usize| self.new.boundary.reference[loaded[k].0.point] - was.at;
        let is_of_face = |k: &usize| loaded[*k].0.normal.dot(&was.contact.normal) > ONE_FACE;
        let nearest = |among: &mut dyn Iterator<Item = usize>| {
            among.min_by(|&a, &b| way(a).norm().total_cmp(&way(b).norm()).then(a.cmp(&b)))
        };
        let first = nearest(&mut takers.iter().copied().filter(is_of_face)).or(nearest(&mut takers.iter().copied()));
        let Some(first) = first else { return [None; 2] };
        let is_beyond = |k: &usize| way(*k).dot(&way(first)) < 0.0;
        let Some(beyond) = nearest(&mut takers.iter().copied().filter(is_of_face).filter(is_beyond)) else {
            return [Some((first, 1.0)), None];
        };
        let [near, far] = [first, beyond].map(|k| way(k).norm());
        [Some((first, far / (near + far))), Some((beyond, near / (near + far)))]
    }
}

/// Adds a share of the forces of one contact to another.
fn add_share(history: &mut ContactHistory, of: &ContactHistory, share: f64) {
    history.normal_force += of.normal_force * share;
    history.shear_force += of.shear_force * share;
    history.filtered_normal += of.filtered_normal * share;
}

/// Gap between node and edge of a contact (m), wherever its spring is unloaded.
fn gap(contact: &VertexEdge) -> f64 {
    contact.gap + contact.history.unloaded.gap()
}

/// Gives the springs of a contact the rest lengths at which they carry its forces where it is.
fn settle(contact: &VertexEdge, model: &Model, history: &mut ContactHistory) {
    let closure = Closure { stiffness: contact.stiffness[0], most: model.laws[contact.law].closure_max };
    history.unloaded = Unloaded { offset: 0.0, rest: gap(contact) + closure.under(history.normal_force) };
    history.sheared = history.shear_force / contact.stiffness[1];
}

/// For each of `count` parts before the part that it is now.
fn inverse<I: Copy>(parents: &[Option<I>], count: usize, index: impl Fn(I) -> usize) -> Vec<Option<usize>> {
    let mut own = vec![None; count];
    for (k, parent) in parents.iter().enumerate() {
        if let Some(parent) = parent {
            own[index(*parent)] = Some(k);
        }
    }
    own
}
