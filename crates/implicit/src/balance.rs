//! Forces out of balance: inertia, elements, contacts and supports at the positions reached.

use enmm::geometry::Vector;
use enmm::internals::contact::{Boundary, ContactSetting, Pair, VertexEdge};
use enmm::internals::mechanics::{Deformation, Forces};
use enmm::internals::state::Workspace;

use super::buffers::ImplicitBuffers;
use super::consistent::push_mass;
use super::step::{ImplicitStep, Inertia};

impl ImplicitStep<'_> {
    /// Internal forces at the positions reached (Eq. 7).
    pub(super) fn implicit_internal(&mut self) {
        let (model, state) = (self.model, &*self.state);
        let (covers, buffers) = (&model.covers, &mut self.buffers);
        buffers.internal.fill(Vector::zeros());
        for e in covers.elements() {
            let ids = covers.element_covers[e];
            let gradients = &covers.gradients[covers.element_triangle[e].set as usize];
            let rock = &model.rocks[model.element_rock[e] as usize];
            let u = ids.map(|i| state.displacement[i] + buffers.moved[i]);
            let deformation = Deformation::new(u, gradients);
            let forces = deformation.forces(gradients, covers.element_area[e], rock, &model.pre_stress_of(e));
            for (i, f) in ids.into_iter().zip(forces) {
                buffers.internal[i] += f;
            }
        }
    }

    /// Updates all contacts to the positions reached; returns whether one is not as the factor holds it.
    pub(super) fn update_contacts(&mut self) -> bool {
        let (setting, contacts, buffers) = self.contacts_and_buffers();
        let mut changed = buffers.factored.len() != contacts.len();
        for (k, contact) in contacts.iter_mut().enumerate() {
            update(contact, &setting, &buffers.moved);
            changed |= buffers.factored.get(k) != Some(&contact.history.state);
        }
        self.bear();
        changed
    }

    /// Forces of all contacts at the positions reached, friction under the pressure kept in `pressing`.
    pub(super) fn implicit_probe(&mut self) {
        let (setting, contacts, buffers) = self.contacts_and_buffers();
        for (contact, pressing) in contacts.iter_mut().zip(&buffers.pressing) {
            update_under(contact, &setting, &buffers.moved, *pressing);
        }
        self.bear();
    }

    /// The contacts of the sub-step, what they share, and the buffers of the integrator.
    fn contacts_and_buffers(&mut self) -> (ContactSetting<'_>, &mut [VertexEdge], &ImplicitBuffers) {
        let Workspace { contacts, frames, selection, .. } = &mut *self.workspace;
        (self.model.contact_setting(&self.state.laws, frames, selection), contacts, &*self.buffers)
    }

    /// Forces of all supports at the positions reached.
    fn bear(&mut self) {
        let workspace = &mut *self.workspace;
        for row in &mut workspace.supports.rows {
            let support = &self.model.supports[row.support as usize];
            let moved = support.sample(&self.buffers.moved);
            row.force = support.preload - support.stiffness * (row.displacement + moved);
        }
    }

    /// Forces out of balance (Eq. 67) at the positions reached; returns their norm and the norm of the largest part.
    pub(super) fn implicit_residual(&mut self, inertia: &Inertia) -> [f64; 2] {
        let model = self.model;
        self.push_bearing();
        let buffers = &mut self.buffers;
        let mut scale = norm(&buffers.residual).max(norm(&buffers.applied));
        for (i, acceleration) in buffers.field.iter_mut().enumerate() {
            *acceleration = buffers.moved[i] * -inertia.factor - buffers.offset[i];
        }
        let bearing_and_rest = buffers.applied.iter().zip(&buffers.internal);
        for (sum, (applied, internal)) in buffers.residual.iter_mut().zip(bearing_and_rest) {
            *sum += applied + internal;
        }
        for (mass, ids) in inertia.element_mass.iter().zip(&model.covers.element_covers) {
            push_mass(mass, *ids, &buffers.field, &mut buffers.residual);
        }
        if !inertia.rests {
            let momentum = buffers.field.iter().zip(&*model.mass_matrix.row_sum).map(|(a, m)| (a * *m).norm_squared());
            scale = scale.max(momentum.sum::<f64>().sqrt());
        }
        self.drop_held();
        let buffers = &self.buffers;
        [norm(&buffers.residual), scale]
    }

    /// Forces out of balance at the start of the sub-step, by the contact forces of the last one; into the residual.
    pub(super) fn start_balance(&mut self) {
        self.push_bearing();
        let buffers = &mut self.buffers;
        let others = buffers.start.applied.iter().zip(&buffers.start.internal);
        buffers.residual.iter_mut().zip(others).for_each(|(sum, (applied, internal))| *sum += applied + internal);
        self.drop_held();
    }

    /// Takes what acts on held rows out of the residual.
    fn drop_held(&mut self) {
        let buffers = &mut self.buffers;
        if !buffers.any_held {
            return;
        }
        for (force, held) in buffers.residual.iter_mut().zip(buffers.held.chunks_exact(2)) {
            for axis in (0..2).filter(|&axis| held[axis]) {
                force[axis] = 0.0;
            }
        }
    }

    /// Forces of contacts and supports on the covers, into the residual.
    pub(super) fn push_bearing(&mut self) {
        let workspace = &mut *self.workspace;
        let residual = &mut self.buffers.residual;
        residual.fill(Vector::zeros());
        for contact in &workspace.contacts {
            if contact.history.normal_force == 0.0 && contact.history.shear_force == 0.0 {
                continue;
            }
            let force = contact.normal * contact.history.normal_force + contact.tangent() * contact.history.shear_force;
            let Pair { covers, weights, .. } = contact.pair(&self.model.boundary);
            residual.at_point(&covers[0], &weights[0], force);
            residual.at_point(&covers[1], &weights[1], -force);
        }
        for row in &workspace.supports.rows {
            let support = &self.model.supports[row.support as usize];
            residual.at_point(&support.covers, &support.weights, support.direction * row.force);
        }
    }
}

/// Forces and state of a contact after displacements of its covers (Eq. 70): the springs at the positions reached,
/// within what the joint can carry.
fn update(contact: &mut VertexEdge, setting: &ContactSetting, moved: &[Vector]) {
    let [normal, shear] = springs(contact, setting.boundary, moved);
    contact.decide(normal, shear, setting);
}

/// The same with the shear limit of an earlier normal force.
fn update_under(contact: &mut VertexEdge, setting: &ContactSetting, moved: &[Vector], pressing: f64) {
    let [normal, shear] = springs(contact, setting.boundary, moved);
    let limit = contact.shear_limit(pressing, setting);
    contact.decide(normal, shear, setting);
    contact.history.shear_force = shear.clamp(-limit, limit);
}

/// Normal and shear force (N/m) that the springs of a contact ask for.
fn springs(contact: &VertexEdge, boundary: &Boundary, moved: &[Vector]) -> [f64; 2] {
    let [opened, sheared] = contact.relative(boundary, moved);
    let shear = contact.shear_stored() - contact.stiffness[1] * sheared;
    [-contact.stiffness[0] * (contact.gap + opened), shear]
}

/// Euclidean norm of a cover field.
pub fn norm(field: &[Vector]) -> f64 {
    field.iter().map(|f| f.norm_squared()).sum::<f64>().sqrt()
}
