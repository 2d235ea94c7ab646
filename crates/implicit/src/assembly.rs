//! The system matrix: c·M of the elements, their corotated stiffness, the springs of contacts and supports.

use enmm::geometry::Vector;
use enmm::internals::contact::{Boundary, ContactState, Pair, VertexEdge};
use enmm::internals::cover::CoverId;
use enmm::internals::mechanics::Deformation;

use super::consistent::{PAIRS, stiffness_block};
use super::cover_matrix::{NotPositive, UNCOUPLED};
use super::step::{ImplicitStep, Inertia};

impl ImplicitStep<'_> {
    /// The pattern, when the near pairs are new, and the slots of this sub-step's contacts in it.
    ///
    /// The pattern holds all near pairs, so that it is a function of the state and lasts until the next search.
    pub(super) fn implicit_places(&mut self) {
        if self.buffers.matrix.is_empty() {
            self.set_pattern();
        }
        let (boundary, workspace) = (&self.model.boundary, &mut *self.workspace);
        let buffers = &mut *self.buffers;
        let matrix = &buffers.matrix;
        buffers.slots.contacts.clear();
        buffers.slots.contacts.extend(workspace.contacts.iter().map(|contact| {
            let ids = six(&contact.pair(boundary));
            std::array::from_fn(|k| {
                let (row, column) = (ids[k / 6], ids[k % 6]);
                if row < column { UNCOUPLED } else { matrix.slot(row, column) }
            })
        }));
    }

    fn set_pattern(&mut self) {
        let covers = &self.model.covers;
        let boundary = &self.model.boundary;
        let buffers = &mut self.buffers;
        let free = |i: CoverId| !(buffers.held[2 * i.index()] && buffers.held[2 * i.index() + 1]);
        let pairs = &mut buffers.slots.pairs;
        pairs.clear();
        let mut couple = |a: CoverId, b: CoverId| {
            if a != b && free(a) && free(b) {
                pairs.push([a.min(b), a.max(b)]);
            }
        };
        for ids in &covers.element_covers {
            PAIRS[3..].iter().for_each(|&[a, b]| couple(ids[a], ids[b]));
        }
        for near in &self.state.neighbours.pairs {
            let node = boundary.covers[boundary.nodes.point[near.node]];
            for a in node {
                boundary.covers_on(near.edge).for_each(|b| couple(a, b));
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        buffers.matrix.set_pattern(covers.cover_count(), pairs);
        let matrix = &buffers.matrix;
        buffers.slots.elements.clear();
        buffers.slots.elements.extend(
            covers
                .element_covers
                .iter()
                .map(|ids| PAIRS.map(|[a, b]| matrix.slot(ids[a].max(ids[b]), ids[a].min(ids[b])))),
        );
    }

    /// Assembles the matrix at the positions reached and the states of the contacts, and factorises it.
    pub(super) fn implicit_factorise(&mut self, inertia: &Inertia) -> Result<(), NotPositive> {
        self.buffers.matrix.zero();
        self.add_elements(inertia.element_mass, inertia.factor, 1.0);
        self.add_contacts();
        self.add_supports();
        self.finish_matrix()
    }

    /// Holds what is held and factorises.
    pub(super) fn finish_matrix(&mut self) -> Result<(), NotPositive> {
        let buffers = &mut self.buffers;
        if buffers.any_held {
            buffers.matrix.hold(&buffers.held);
        }
        self.state.counters.factorisations += 1;
        buffers.matrix.factorise()
    }

    /// Adds `mass` times the consistent mass and `stiffness` times R·K·Rᵀ of every element (Eq. 69).
    pub(super) fn add_elements(&mut self, element_mass: &[[f64; 6]], mass: f64, stiffness: f64) {
        let (model, state) = (self.model, &*self.state);
        let (covers, buffers) = (&model.covers, &mut self.buffers);
        for (e, slots) in buffers.slots.elements.iter().enumerate() {
            let ids = covers.element_covers[e];
            let gradients = &covers.gradients[covers.element_triangle[e].set as usize];
            let rock = &model.rocks[model.element_rock[e] as usize];
            let u = ids.map(|i| state.displacement[i] + buffers.moved[i]);
            let deformation = Deformation::new(u, gradients);
            let turned = gradients.map(|g| deformation.turn_vector(g));
            let area = covers.element_area[e] * stiffness;
            for (k, [a, b]) in PAIRS.into_iter().enumerate() {
                let (row, column) = if ids[a] >= ids[b] { (a, b) } else { (b, a) };
                let mut block = stiffness_block(area, rock, turned[row], turned[column]);
                block[0] += mass * element_mass[e][k];
                block[3] += mass * element_mass[e][k];
                buffers.matrix.add(slots[k], ids[column], block, a == b);
            }
        }
    }

    /// Adds the springs of all contacts that are not open; the shear spring of those that do not slip.
    fn add_contacts(&mut self) {
        let (boundary, workspace) = (&self.model.boundary, &mut *self.workspace);
        let buffers = &mut *self.buffers;
        buffers.factored.clear();
        for (contact, slots) in workspace.contacts.iter().zip(&buffers.slots.contacts) {
            buffers.factored.push(contact.history.state);
            let shear = match contact.history.state {
                ContactState::Open => continue,
                ContactState::Slip if buffers.cautious => secant(contact, boundary, &buffers.moved),
                ContactState::Slip => 0.0,
                ContactState::Lock => contact.stiffness[1],
            };
            let spring = spring(contact, shear);
            let pair = contact.pair(boundary);
            let (ids, weights) = (six(&pair), six_weights(&pair));
            for (k, &slot) in slots.iter().enumerate().filter(|(_, slot)| **slot != UNCOUPLED) {
                let (a, b) = (k / 6, k % 6);
                let block = spring.map(|v| v * weights[a] * weights[b]);
                buffers.matrix.add(slot, ids[b], block, ids[a] == ids[b]);
            }
        }
    }

    fn add_supports(&mut self) {
        let model = self.model;
        let matrix = &mut self.buffers.matrix;
        for row in &self.workspace.supports.rows {
            let support = &model.supports[row.support as usize];
            let d = support.direction;
            let spring = [d.x * d.x, d.x * d.y, d.x * d.y, d.y * d.y].map(|v| v * support.stiffness);
            for k in 0..9 {
                let (a, b) = (k / 3, k % 3);
                let (i, j) = (support.covers[a], support.covers[b]);
                if i >= j {
                    let block = spring.map(|v| v * support.weights[a] * support.weights[b]);
                    matrix.add(matrix.slot(i, j), j, block, i == j);
                }
            }
        }
    }
}

/// Covers of the node and of the edge.
fn six(pair: &Pair) -> [CoverId; 6] {
    std::array::from_fn(|k| pair.covers[k / 3][k % 3])
}

/// Their weights, those of the edge negative.
fn six_weights(pair: &Pair) -> [f64; 6] {
    std::array::from_fn(|k| pair.weights[k / 3][k % 3] * if k < 3 { 1.0 } else { -1.0 })
}

/// Shear force over the way that its spring alone would have taken (N/m per m): between no spring, which lets a block
/// go in one iteration that is held in the next, and the spring of a contact that does not slip.
fn secant(contact: &VertexEdge, boundary: &Boundary, moved: &[Vector]) -> f64 {
    let asked = (contact.shear_stored() - contact.stiffness[1] * contact.relative(boundary, moved)[1]).abs();
    contact.stiffness[1] * (contact.history.shear_force.abs() / asked.max(f64::MIN_POSITIVE)).min(1.0)
}

/// k_n·n⊗n + k_t·t⊗t of a contact, row by row.
fn spring(contact: &VertexEdge, shear: f64) -> [f64; 4] {
    let (n, t, normal) = (contact.normal, contact.tangent(), contact.stiffness[0]);
    let off = normal * n.x * n.y + shear * t.x * t.y;
    [normal * n.x * n.x + shear * t.x * t.x, off, off, normal * n.y * n.y + shear * t.y * t.y]
}
