//! Forces out of balance: inertia, elements, contacts and supports at the places reached.

use crate::contact::{ContactState, VertexEdge};
use crate::geometry::Vector;
use crate::mechanics::{self, Deformation, push_mass};

use super::super::blocks::pre_stress;
use super::{Inertia, Step};

/// Penetration, relative to the mesh size, from which an open contact closes.
const CLOSING: f64 = 1e-10;

impl Step<'_> {
    /// Internal forces at the places reached (Eq. 7).
    pub(super) fn implicit_internal(&mut self) {
        let (slope, state) = (self.slope, &*self.state);
        let (covers, buffers) = (&slope.covers, &mut self.scratch.implicit);
        buffers.internal.fill(Vector::zeros());
        for e in 0..covers.element_count() {
            let ids = covers.element_covers[e];
            let gradients = &covers.gradients[covers.element_triangle[e].set as usize];
            let rock = &slope.rocks[slope.element_rock[e] as usize];
            let u = ids.map(|i| state.displacement[i as usize] + buffers.moved[i as usize]);
            let deformation = Deformation::new(u, gradients);
            let forces = deformation.forces(gradients, covers.element_area[e], rock, &pre_stress(slope, e));
            for (i, f) in ids.into_iter().zip(forces) {
                buffers.internal[i as usize] += f;
            }
        }
    }

    /// Judges all contacts at the places reached; returns whether one is not as the factor holds it.
    pub(super) fn implicit_judge(&mut self) -> bool {
        let least = CLOSING * self.slope.covers.mesh.size;
        let scratch = &mut *self.scratch;
        let buffers = &scratch.implicit;
        let mut changed = buffers.factored.len() != scratch.contacts.len();
        for (k, contact) in scratch.contacts.iter_mut().enumerate() {
            judge(contact, &buffers.moved, least);
            changed |= buffers.factored.get(k) != Some(&contact.history.state);
        }
        for row in &mut scratch.rows {
            let support = &self.slope.supports[row.support as usize];
            row.force = support.preload - support.stiffness * (row.displacement + support.sample(&buffers.moved));
        }
        changed
    }

    /// Forces out of balance (Eq. I1) at the places reached; returns their norm and the norm of the largest part.
    pub(super) fn implicit_residual(&mut self, inertia: &Inertia) -> [f64; 2] {
        let slope = self.slope;
        self.push_bearing();
        let buffers = &mut self.scratch.implicit;
        let mut scale = norm(&buffers.residual).max(norm(&buffers.applied));
        for (i, acceleration) in buffers.field.iter_mut().enumerate() {
            *acceleration = buffers.moved[i] * -inertia.factor - buffers.offset[i];
        }
        let bearing_and_rest = buffers.applied.iter().zip(&buffers.internal);
        for (sum, (applied, internal)) in buffers.residual.iter_mut().zip(bearing_and_rest) {
            *sum += applied + internal;
        }
        if let Some(implicit) = &slope.implicit {
            for (mass, ids) in implicit.element_mass.iter().zip(&slope.covers.element_covers) {
                push_mass(mass, ids.map(|i| i as usize), &buffers.field, &mut buffers.residual);
            }
            if !inertia.rests {
                let momentum = buffers.field.iter().zip(&slope.metric.row_sum).map(|(a, m)| (a * *m).norm_squared());
                scale = scale.max(momentum.sum::<f64>().sqrt());
            }
        }
        for (i, force) in buffers.residual.iter_mut().enumerate() {
            for axis in 0..2 {
                if buffers.held[2 * i + axis] {
                    force[axis] = 0.0;
                }
            }
        }
        [norm(&buffers.residual), scale]
    }

    /// Forces of contacts and supports on the covers, into the residual.
    pub(super) fn push_bearing(&mut self) {
        let scratch = &mut *self.scratch;
        let residual = &mut scratch.implicit.residual;
        residual.fill(Vector::zeros());
        for contact in scratch.contacts.iter().filter(|c| c.history.state != ContactState::Open) {
            let force = contact.normal * contact.history.normal_force + contact.tangent() * contact.history.shear_force;
            mechanics::spread(&contact.pair.covers[0], &contact.pair.weights[0], force, residual);
            mechanics::spread(&contact.pair.covers[1], &contact.pair.weights[1], -force, residual);
        }
        for row in &scratch.rows {
            let support = &self.slope.supports[row.support as usize];
            mechanics::spread(&support.covers, &support.weights, support.direction * row.force, residual);
        }
    }
}

/// Forces and state of a contact after displacements of its covers (Eq. I4): the springs at the places reached, within
/// what the joint can carry.
fn judge(contact: &mut VertexEdge, moved: &[Vector], least: f64) {
    let [opened, sheared] = contact.relative(moved);
    let gap = contact.gap + opened;
    let was_open = contact.history.state == ContactState::Open;
    let normal = if was_open && gap < 0.0 && gap > -least { 0.0 } else { -contact.stiffness[0] * gap };
    contact.decide(normal, contact.history.shear_stored - contact.stiffness[1] * sheared);
}

/// Euclidean norm of a cover field.
pub(super) fn norm(field: &[Vector]) -> f64 {
    field.iter().map(|f| f.norm_squared()).sum::<f64>().sqrt()
}
