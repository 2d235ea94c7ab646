//! The open–close iteration as `docs/theory.md` §5 has it. **This is the file in which to read the method.**
//!
//! Plain Gauss–Seidel: contact after contact, in the order of the list, until no force changes any more. There are no
//! eight lanes, no groups and no threads, no contact is skipped, and each equation stands once. No step calls it, but
//! [`OpenClose`](super::OpenClose), which solves the same equations fast, and which `tests/contact_reference.rs` holds
//! to this. Supports and bolts, which answer between its sweeps, are not repeated here.

use crate::contact::{Pair, SoftSpring, VertexEdge};
use crate::cover;
use crate::geometry::Vector;
use crate::mechanics::MassMatrix;

use super::{BlockImpulse, LIGHT, SolverOptions, SolverReport};

/// What the impulses of all contacts so far have done to covers and blocks.
#[derive(Debug, Clone)]
pub struct Impulses<'a> {
    mass_matrix: &'a MassMatrix,
    /// p/m of each cover (m/s), 0 along an axis that is held.
    pub increment: Vec<Vector>,
    /// P, Z and L of each block, 0 of a held one.
    pub block_impulse: Vec<BlockImpulse>,
}

impl<'a> Impulses<'a> {
    /// Nothing has pushed.
    fn none(mass_matrix: &'a MassMatrix) -> Self {
        Self {
            mass_matrix,
            increment: vec![Vector::zeros(); mass_matrix.mass.len()],
            block_impulse: vec![BlockImpulse::default(); mass_matrix.total.len()],
        }
    }

    /// Velocity (m/s) that they give to point `k` of a pair: all of Eq. 17 but v* of the start, which the springs know.
    fn velocity(&self, pair: &Pair, k: usize) -> Vector {
        let own = cover::sample(&pair.covers[k], &pair.weights[k], &self.increment);
        let (block, masses) = (pair.blocks[k], self.mass_matrix);
        if !masses.is_free(block) {
            return own;
        }
        let BlockImpulse { impulse, weighted, moment } = self.block_impulse[block];
        let (mass, square) = (masses.total[block], masses.square[block]);
        let shift = impulse / mass - impulse * (pair.z[k] / mass) - (weighted - impulse * (square / mass)) / mass;
        own + shift + turned(pair.arms[k]) * (masses.spin[block] * moment)
    }

    /// Point `k` of a pair takes an impulse (N·s/m).
    fn push(&mut self, pair: &Pair, k: usize, impulse: Vector) {
        for (&i, weight) in pair.covers[k].iter().zip(pair.weights[k]) {
            self.increment[i] += self.mass_matrix.inverse[i].component_mul(&impulse) * weight;
        }
        let block = pair.blocks[k];
        if self.mass_matrix.is_free(block) {
            let sums = &mut self.block_impulse[block];
            sums.impulse += impulse;
            sums.weighted += impulse * pair.z[k];
            sums.moment += pair.arms[k].perp(&impulse);
        }
    }

    /// Both bodies of a contact take the impulses of forces (N/m) normal and shear that act for `kick` (s).
    fn push_both(&mut self, contact: &VertexEdge, [normal, shear]: [f64; 2], kick: f64) {
        let impulse = (contact.normal * normal + contact.tangent() * shear) * kick;
        self.push(&contact.pair, 0, impulse);
        self.push(&contact.pair, 1, -impulse);
    }
}

/// Sweeps over contacts until their forces settle (Eq. 16), from those that are expected; leaves forces and states in
/// the contacts.
pub fn solve<'a>(
    mass_matrix: &'a MassMatrix,
    options: &SolverOptions,
    contacts: &mut [VertexEdge],
) -> (Impulses<'a>, SolverReport) {
    let mut impulses = Impulses::none(mass_matrix);
    for contact in &mut *contacts {
        [contact.history.normal_force, contact.history.shear_force] = contact.expected;
        impulses.push_both(contact, contact.expected, options.kick);
    }
    let mut report = SolverReport::default();
    let mut changes = vec![0.0; contacts.len()];
    while report.sweeps < options.sweeps_max {
        for (contact, change) in contacts.iter_mut().zip(&mut changes) {
            *change = solve_contact(contact, &mut impulses, options.kick);
        }
        report.sweeps += 1;
        report.contacts_solved += contacts.len() as u64;
        report.unsettled = unsettled(contacts, &changes);
        if report.unsettled <= options.tolerance {
            break;
        }
    }
    (impulses, report)
}

/// One contact takes its new forces: open, slip or lock; returns the larger of their changes (N/m).
fn solve_contact(contact: &mut VertexEdge, impulses: &mut Impulses, kick: f64) -> f64 {
    let velocity = impulses.velocity(&contact.pair, 0) - impulses.velocity(&contact.pair, 1);
    let before = forces(contact);
    let [normal, shear] = asked(contact, velocity);
    contact.decide(normal, shear);
    let after = forces(contact);
    let change = [after[0] - before[0], after[1] - before[1]];
    impulses.push_both(contact, change, kick);
    change[0].abs().max(change[1].abs())
}

/// Forces (N/m) that the springs ask for at the end of the step, before any limit (Eqs. 14, 15), where all impulses so
/// far have given the points the relative velocity u (m/s).
///
/// Of each spring [`SoftSpring`] holds what no sweep changes: `rest` = −k(g + θΔt·u*), or T_hist − kθΔt·u* along the
/// edge, u* being the velocity without contact forces; `rate` = kθΔt; `kept` = kθΔt·W times the kick.
fn asked(contact: &VertexEdge, u: Vector) -> [f64; 2] {
    let along = [u.dot(&contact.normal), u.dot(&contact.tangent())];
    let force = forces(contact);
    let [normal, shear] = [0, 1].map(|axis| {
        let SoftSpring { rest, rate, kept } = contact.answers[axis];
        rest - rate * along[axis] + kept * force[axis]
    });
    let [kept_normal, kept_shear] = [contact.answers[0].kept, contact.answers[1].kept];
    // Of a joint that closes on a curve the sum above is the closure from which the force follows (Eq. 35).
    let curve = contact.closure();
    let normal =
        if contact.closes_on_a_curve() { curve.solve(normal, kept_normal) } else { normal / (1.0 + kept_normal) };
    [normal, shear / (1.0 + kept_shear)]
}

/// Largest change of a force over the force of its contact, or over a share of the largest one of all (Eq. 16).
fn unsettled(contacts: &[VertexEdge], changes: &[f64]) -> f64 {
    let normal = |contact: &VertexEdge| contact.history.normal_force;
    let floor = LIGHT * contacts.iter().map(normal).fold(f64::MIN_POSITIVE, f64::max);
    contacts.iter().zip(changes).map(|(contact, change)| change / normal(contact).max(floor)).fold(0.0, f64::max)
}

fn forces(contact: &VertexEdge) -> [f64; 2] {
    [contact.history.normal_force, contact.history.shear_force]
}

/// An arm turned by 90°: the velocity of its end at a spin of 1 rad/s.
fn turned(arm: Vector) -> Vector {
    Vector::new(-arm.y, arm.x)
}
