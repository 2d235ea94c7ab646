//! Makes a contact from an accepted candidate: geometry, law, stiffness and history.

use std::f64::consts::TAU;

use enmm_lanes::{Kernel, Lanes, dispatch};

use crate::contact::frame::right_of;
use crate::contact::{
    BondHistory, Closure, ContactHistory, ContactState, EdgeId, FoundContact, LawId, NearPair, NodeId, Pair, VertexEdge,
};
use crate::cover::{CoverId, Weights};
use crate::geometry::{Point, Vector};

use super::tributary_length::Tributary;
use super::{Accepted, ContactCandidate, NarrowPhase, Run};

/// Makes the contacts of a run: compiled for every kind of lanes.
struct Make<'a> {
    narrow: &'a NarrowPhase<'a>,
    run: &'a Run,
    found: &'a mut [FoundContact],
    contacts: &'a mut [VertexEdge],
}

impl Kernel for Make<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, _: L) {
        let Self { narrow, run, found, contacts } = self;
        for ((contact, found), accepted) in contacts.iter_mut().zip(found).zip(&run.accepted) {
            match *accepted {
                Accepted::Stays(known) => narrow.make_staying(known as usize, found, contact),
                Accepted::Found(k) => narrow.make_found(&run.candidates[k as usize], found, contact),
            }
        }
    }
}

impl NarrowPhase<'_> {
    /// Makes the contacts of some runs in place.
    pub(super) fn make(&self, runs: &[Run], found: &mut [FoundContact], contacts: &mut [VertexEdge]) {
        if let [run] = runs {
            return dispatch(Make { narrow: self, run, found, contacts });
        }
        let (first, rest) = runs.split_at(runs.len() / 2);
        let count = first.iter().map(|run| run.accepted.len()).sum();
        let (found, contacts) = (found.split_at_mut(count), contacts.split_at_mut(count));
        rayon::join(|| self.make(first, found.0, contacts.0), || self.make(rest, found.1, contacts.1));
    }

    /// Makes a contact of the last step that stays as it was found.
    #[inline(always)]
    fn make_staying(&self, known: usize, found: &mut FoundContact, contact: &mut VertexEdge) {
        let ContactHistory { node, side, edge, .. } = self.rule.history[known];
        *found = self.last[known];
        let candidate = self.rule.candidate(&NearPair { node, side, edge }, found.near_side, Some(known as u32));
        self.make_one(&candidate, (found, 0.0, self.law(node, edge)), contact);
    }

    /// Makes a contact that the vertex rule has accepted.
    #[inline(always)]
    fn make_found(&self, candidate: &ContactCandidate, found: &mut FoundContact, contact: &mut VertexEdge) {
        let Tributary { length, bonded, penalty, share, keeps } = self.tributary(candidate.node, candidate);
        let law = self.law(candidate.node, candidate.edge);
        let mut bond = BondHistory { damage: 0.0, lengths: [length, bonded], law, section: None };
        if self.softens {
            bond = self.bond(candidate, bond);
        }
        let [length, bonded] = bond.lengths;
        *found = FoundContact { near_side: candidate.near_side, length, bonded, penalty, share, keeps };
        self.make_one(candidate, (found, bond.past(), bond.law), contact);
    }

    /// Makes a contact as it was found, with the past of its bond and its law.
    #[inline(always)]
    fn make_one(
        &self,
        candidate: &ContactCandidate,
        (found, past, law): (&FoundContact, f64, LawId),
        contact: &mut VertexEdge,
    ) {
        let (boundary, node) = (self.rule.boundary, candidate.node);
        let (point, edge) = (boundary.nodes.point[node], candidate.edge);
        let p = self.rule.position(node);
        let normal = right_of(candidate.tangent);
        let covers = [boundary.covers[point], self.covers_under(candidate)];
        let weights = [boundary.weights[point], self.weights_at(&covers[1], p)];
        let FoundContact { length, bonded, penalty, share, keeps, .. } = *found;
        let mut stiffness = self.laws[law].stiffness(length, penalty);
        let closure_max = self.laws[law].closure_max;
        let closure = Closure { stiffness: stiffness[0], most: closure_max };
        let history = match candidate.held {
            Some(known) => self.rule.history[known as usize],
            None => self.first_sight(candidate, length, (closure, stiffness[1]), normal),
        };
        let mut history = ContactHistory { edge: candidate.edge, share, ..history };
        if let Some(masses) = self.impacts {
            let blocks = [point, edge].map(|point| boundary.block[point]);
            let mass = 1.0 / (masses[blocks[0].index()] + masses[blocks[1].index()]);
            let kept = self.keep_stiffness(candidate.gap, (stiffness[0], keeps), mass, &mut history);
            stiffness = stiffness.map(|k| k * kept);
        }
        history.unloaded.leave(candidate.gap);
        let gap = candidate.gap + history.unloaded.offset;
        if self.laws[law].penalty[0] {
            let blocks = [point, edge].map(|point| boundary.block[point]);
            let opens = Pair { blocks, covers, weights }.difference(self.velocity);
            stiffness[0] *= self.hardening(gap, opens.dot(&normal));
        }
        let gap = gap - history.unloaded.rest;
        *contact = VertexEdge {
            history,
            point,
            covers: covers[1],
            weights: weights[1],
            normal,
            stiffness,
            gap,
            length,
            bonded,
            past,
            law,
            torn: false,
            fresh: candidate.held.is_none(),
            delayed: false,
        };
    }

    /// The bond of a contact that would have a law and lengths (m), tributary and bonded: a bond that holds is as long
    /// as it was. Of a contact without one the bonded length is what the law gives it.
    #[cold]
    #[inline(never)]
    fn bond(&self, candidate: &ContactCandidate, new: BondHistory) -> BondHistory {
        let held = candidate.held.map(|known| known as usize).filter(|&k| self.rule.history[k].intact);
        if let Some(bond) = held.and_then(|k| self.bonds.get(k)).filter(|bond| bond.lengths[0] > 0.0) {
            return *bond;
        }
        if self.first { self.first_bond(candidate, new) } else { new }
    }

    /// The bond of a contact in the first step: where its faces lie on joints of several laws, the part of its length
    /// that lies on the bond is bonded, and the bond is that of the least cohesion. Without such a part it has the law
    /// of its faces. Faces at an angle to the edge have no part in it. Of the sections on which the node lies with that
    /// law it breaks with the one that has most of it.
    fn first_bond(&self, candidate: &ContactCandidate, new: BondHistory) -> BondHistory {
        let (boundary, node) = (self.rule.boundary, candidate.node);
        let along = |point: EdgeId| self.rule.frames.position(point).dot(&candidate.tangent);
        let [from, to] = self.faced(candidate, along);
        let (mut all, mut soft, mut bond, mut plain) = (0.0, 0.0, None::<LawId>, None);
        let mut section = (0.0, None);
        for edge in boundary.edges_about(node) {
            let ends = [edge, boundary.after(edge)];
            let [start, end] = ends.map(|point| self.rule.frames.position(point));
            let over = along(ends[0]).min(to) - along(ends[1]).max(from);
            let is_flush = (start - end).dot(&candidate.tangent) > self.rule.flush_cosine * (start - end).norm();
            if over <= 0.0 || !is_flush {
                continue;
            }
            let own = boundary.trace[edge].map_or(new.law, |trace| self.trace_law[trace]);
            all += over;
            if self.laws[own].softening.is_some() {
                soft += over;
                if over > section.0 {
                    section = (over, self.sections.of(edge));
                }
                bond = bond.filter(|&law| self.laws[law].cohesion <= self.laws[own].cohesion).or(Some(own));
            } else {
                plain = plain.or(Some(own));
            }
        }
        match bond {
            Some(law) => {
                let section = section.1.filter(|&section| self.sections.list[section].law == law);
                BondHistory { lengths: [new.lengths[0], new.lengths[1] * (soft / all)], law, section, ..new }
            }
            None if self.laws[new.law].softening.is_some() => BondHistory { law: plain.unwrap_or(new.law), ..new },
            None => new,
        }
    }

    /// Ends of what a node faces along the candidate's edge: the node segment under it, and at a node of the other side
    /// both segments that end there, since round-off decides which of them is nearer.
    fn faced(&self, candidate: &ContactCandidate, along: impl Fn(EdgeId) -> f64) -> [f64; 2] {
        let (nodes, band) = (&self.rule.boundary.nodes, self.rule.constants.corner_tolerance * self.rule.size);
        let at = |node: NodeId| along(nodes.point[node]);
        let start = self.rule.boundary.node_before[candidate.edge];
        let end = nodes.next[start];
        let ([from, to], place) = ([start, end].map(at), at(candidate.node));
        if (place - from).abs() < band {
            return [from.min(at(nodes.previous[start])), to];
        }
        if (to - place).abs() < band { [from, to.max(at(nodes.next[end]))] } else { [from, to] }
    }

    /// Factor on the stiffness (N/m per metre) of a contact at a geometric gap (m): it keeps that of its first touch
    /// for the time in which a mass (kg/m) swings on it once, so that an impact has a potential, and lets it go in as
    /// much time again, or at once where a corner begins to share its length with another one (Eq. 86). The force does
    /// not grow by that, for which it gets an allowance.
    #[inline(always)]
    fn keep_stiffness(&self, gap: f64, (now, keeps): (f64, bool), mass: f64, history: &mut ContactHistory) -> f64 {
        let (age, kept) = (f64::from(history.meeting.age), f64::from(history.meeting.kept_stiffness));
        let closed = gap + history.unloaded.offset - history.unloaded.rest;
        let swing = TAU * (mass / if kept > 0.0 { kept } else { now }).sqrt();
        if age >= 2.0 * swing {
            history.meeting.kept_stiffness = 0.0;
            return 1.0;
        }
        if kept == 0.0 {
            if closed < 0.0 && age < swing && keeps && history.share == 1.0 {
                history.meeting.kept_stiffness = now as f32;
            }
            return 1.0;
        }
        if age < swing && keeps {
            history.share = 1.0;
            return kept / now;
        }
        let share = if keeps { (self.dt / (2.0 * swing - age)).min(1.0) } else { 1.0 };
        let next = kept + (now - kept) * share;
        history.share = history.share.max((next / kept).min(1.0));
        history.meeting.kept_stiffness = if keeps { next as f32 } else { 0.0 };
        history.unloaded.offset += closed * ((kept / next).min(1.0) - 1.0);
        next / now
    }

    /// Factor on the default stiffness at the penetration that a step would reach from a gap (m) that opens at some
    /// rate (m/s).
    #[inline(always)]
    fn hardening(&self, gap: f64, rate: f64) -> f64 {
        let reached = gap + rate * self.dt;
        1.0 + (reached.min(0.0) / (self.rule.constants.hardens * self.rule.size)).powi(2)
    }

    /// Covers that carry the position on an edge under a node.
    #[inline(always)]
    fn covers_under(&self, candidate: &ContactCandidate) -> [CoverId; 3] {
        let (boundary, edge) = (self.rule.boundary, candidate.edge);
        boundary.covers[if 2.0 * candidate.along > candidate.length { boundary.beyond[edge] } else { edge }]
    }

    /// Weights of an element's covers at a current position, by barycentric coordinates of its stars.
    #[inline(always)]
    pub(super) fn weights_at(&self, covers: &[CoverId; 3], p: Point) -> Weights {
        let x = |k: usize| self.star[covers[k]] + self.displacement[covers[k]];
        let (x0, x1, x2) = (x(0), x(1), x(2));
        let (d1, d2, d) = (x1 - x0, x2 - x0, p - x0);
        let area = d1.perp(&d2);
        let (w1, w2) = (d.perp(&d2) / area, d1.perp(&d) / area);
        [1.0 - w1 - w2, w1, w2]
    }

    /// Law of the joint between a node and an edge: that of the edge, of the node's own face, or the default.
    #[inline(always)]
    fn law(&self, node: NodeId, edge: EdgeId) -> LawId {
        let trace = self.rule.boundary.trace[edge].or_else(|| self.rule.boundary.node_trace(node));
        trace.map_or(self.default_law, |trace| self.trace_law[trace])
    }

    #[cold]
    #[inline(never)]
    fn first_sight(
        &self,
        candidate: &ContactCandidate,
        length: f64,
        (closure, shear_stiffness): (Closure, f64),
        normal: Vector,
    ) -> ContactHistory {
        let ContactCandidate { node, side, edge, .. } = *candidate;
        let mut history = ContactHistory { node, side, edge, intact: self.first, ..ContactHistory::default() };
        if self.rule.is_deep(candidate) {
            history.unloaded.offset = -candidate.gap;
        }
        if let (true, Some(stress)) = (self.first, self.in_situ) {
            let [xx, yy, xy] = stress.at(self.rule.boundary.reference[self.rule.boundary.nodes.point[node]]);
            let traction = Vector::new(xx * normal.x + xy * normal.y, xy * normal.x + yy * normal.y) * length;
            history.normal_force = -traction.dot(&normal);
            history.unloaded.rest = closure.under(history.normal_force);
            history.shear_force = -traction.dot(&candidate.tangent);
            history.sheared = history.shear_force / shear_stiffness;
            history.state = ContactState::Lock;
            // It has rested under this stress.
            (history.meeting.age, history.filtered_normal) = (f32::INFINITY, history.normal_force.max(0.0));
        }
        history
    }
}
