//! Velocities with the consistent mass: energy, damping of deformation, the first acceleration of the trapezoidal rule.

use enmm::geometry::{Point, Vector};
use enmm::internals::cover::{BlockId, CoverId};
use enmm::internals::mechanics::MassMatrix;
use enmm::internals::state::{Model, State};

use super::choices::Implicit;
use super::step::{ImplicitStep, Inertia};

/// Kinetic energy (J/m) by the consistent mass of all blocks that can move.
pub fn kinetic_energy(model: &Model, implicit: &Implicit, mass_matrix: &MassMatrix, velocity: &[Vector]) -> f64 {
    model.covers.blocks().filter(|&b| !mass_matrix.fixed[b]).map(|b| block_energy(model, implicit, velocity, b)).sum()
}

/// Kinetic energy (J/m) of one block by the consistent mass.
pub fn block_energy(model: &Model, implicit: &Implicit, velocity: &[Vector], block: BlockId) -> f64 {
    let of_element = |e: usize| {
        let [v0, v1, v2] = model.covers.element_covers[e].map(|i| velocity[i]);
        let [m00, m11, m22, m01, m02, m12] = implicit.element_mass[e];
        0.5 * (m00 * v0.norm_squared() + m11 * v1.norm_squared() + m22 * v2.norm_squared())
            + m01 * v0.dot(&v1)
            + m02 * v0.dot(&v2)
            + m12 * v1.dot(&v2)
    };
    model.covers.elements_of(block).map(of_element).sum()
}

/// Takes the velocities of a static stage, which its steps do not use, and their energy, which its reports hold.
pub fn stop(model: &Model, implicit: &Implicit, state: &mut State) {
    let moving = model.covers.blocks().filter(|&b| !state.removed[b]);
    let energy: f64 = moving.map(|b| block_energy(model, implicit, &state.velocity, b)).sum();
    state.ledger.damping -= energy;
    state.velocity.fill(Vector::zeros());
}

impl ImplicitStep<'_> {
    /// M·a = forces at the start of the sub-step, solved for a; contacts have the limits that hold now.
    pub(super) fn implicit_start_acceleration(&mut self, implicit: &Implicit) {
        self.update_contacts();
        let forces = self.workspace.contacts.iter().map(|c| [c.history.normal_force, c.history.shear_force]);
        self.buffers.start.contacts.clear();
        self.buffers.start.contacts.extend(forces);
        self.start_balance();
        let buffers = &mut self.buffers;
        buffers.matrix.zero();
        self.add_elements(&implicit.element_mass, 1.0, 0.0);
        if self.finish_matrix().is_err() {
            self.singular = true;
        }
        self.solve();
        self.state.acceleration.extend(self.buffers.unknowns.chunks_exact(2).map(|a| Vector::new(a[0], a[1])));
    }

    /// Damps the velocities of the state relative to the rigid motion of every block by exp(−2ξπ·cs/√A·dt) (Eq. 11);
    /// returns the energy (J/m) that this took.
    pub(super) fn implicit_damp(&mut self, implicit: &Implicit, ratio: f64, inertia: &Inertia) -> f64 {
        if ratio == 0.0 || inertia.rests {
            return 0.0;
        }
        let model = self.model;
        let mut taken = 0.0;
        for block in model.covers.blocks() {
            if self.workspace.mass_matrix.fixed[block] {
                continue;
            }
            let before = block_energy(model, implicit, &self.state.velocity, block);
            let factor = libm::exp(-ratio * inertia.dt * model.block_frequency[block]);
            self.damp_block(implicit, block, factor);
            taken += before - block_energy(model, implicit, &self.state.velocity, block);
        }
        taken
    }

    fn damp_block(&mut self, implicit: &Implicit, block: BlockId, factor: f64) {
        let model = self.model;
        let (state, buffers) = (&mut *self.state, &mut self.buffers);
        let range = model.covers.covers_of(block);
        let mass = &model.mass_matrix.row_sum;
        let total: f64 = model.mass_matrix.total[block];
        let position = |u: &[Vector], i: usize| model.covers.star_position[i] + u[i];
        let centre: Point = range.clone().map(|i| position(&state.displacement, i) * mass[i]).sum::<Point>() / total;
        let mean: Vector = range.clone().map(|i| state.velocity[i] * mass[i]).sum::<Vector>() / total;
        for i in range.clone() {
            let arm = position(&state.displacement, i) - centre;
            buffers.field[i] = Vector::new(-arm.y, arm.x);
        }
        let [spun, inertia] = [&state.velocity, &buffers.field].map(|field| {
            let of_element = |e: usize| {
                let ids = model.covers.element_covers[e];
                turned_product(&implicit.element_mass[e], ids, &buffers.field, field)
            };
            model.covers.elements_of(block).map(of_element).sum::<f64>()
        });
        let spin = spun / inertia;
        for i in range {
            let rigid = mean + buffers.field[i] * spin;
            let damped = rigid + (state.velocity[i] - rigid) * factor;
            for axis in 0..2 {
                state.velocity[i][axis] = if buffers.held[2 * i + axis] { 0.0 } else { damped[axis] };
            }
        }
    }
}

/// aᵀ·M·b of one element.
fn turned_product(mass: &[f64; 6], ids: [CoverId; 3], a: &[Vector], b: &[Vector]) -> f64 {
    let [m00, m11, m22, m01, m02, m12] = *mass;
    let product = |p: usize, q: usize| a[ids[p]].dot(&b[ids[q]]);
    m00 * product(0, 0)
        + m11 * product(1, 1)
        + m22 * product(2, 2)
        + m01 * (product(0, 1) + product(1, 0))
        + m02 * (product(0, 2) + product(2, 0))
        + m12 * (product(1, 2) + product(2, 1))
}
