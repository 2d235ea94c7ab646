//! Contacts, supports and bolts of an explicit sub-step: their selection, and the open–close iteration.

use crate::contact::{
    Approach, BoltRow, BoltView, Frames, NeighbourList, OpenClose, OtherConstraints, SolverOptions, SolverReport,
    VertexEdge,
};
use crate::mechanics::MassMatrix;
use crate::state::{Model, MotionBuffers, SelectionBuffers, State, SupportBuffers, SweepBuffers};

use super::{Reach, Regime, Substep, contacts, quiet};

/// Contacts that take part in a sub-step in which no cover is faster than `speed_max` (m/s).
pub(super) fn detect(
    model: &Model,
    state: &State,
    step: &Substep,
    speed_max: f64,
    frames: &Frames,
    selection: &mut SelectionBuffers,
    contacts: &mut Vec<VertexEdge>,
) {
    let rule = &model.detection;
    let gap = rule.reach * model.covers.mesh.size + rule.reach_steps * step.dt * speed_max;
    contacts::find_contacts(model, state, step, Reach { gap, ahead: step.dt }, frames, selection, contacts);
}

/// Rows of supports and bolts for the iteration.
pub(super) fn prepare_supports(
    model: &Model,
    state: &State,
    step: &Substep,
    mass_matrix: &MassMatrix,
    motion: &MotionBuffers,
    supports: &mut SupportBuffers,
) {
    quiet::load_supports(model, state, step, motion, &mut supports.rows);
    load_bolts(model, state, mass_matrix, motion, &mut supports.bolts);
}

/// Bolts that carry force in this step.
fn load_bolts(model: &Model, state: &State, masses: &MassMatrix, motion: &MotionBuffers, bolts: &mut Vec<BoltRow>) {
    let view = BoltView {
        star: &model.covers.star_position,
        displacement: &state.displacement,
        predicted: &motion.predicted,
        mass_matrix: masses,
        motion: &motion.blocks,
    };
    let rows = model.bolts.iter().zip(&state.bolts).enumerate();
    let bearing = rows.filter(|(_, (_, bolt))| bolt.active && !bolt.broken);
    bolts.clear();
    bolts.extend(bearing.map(|(k, (segment, bolt))| segment.row(k as u32, bolt, &view)));
}

/// Order in which the iteration takes the contacts.
pub(super) fn order_contacts(
    model: &Model,
    neighbours: &NeighbourList,
    mass_matrix: &MassMatrix,
    selection: &SelectionBuffers,
    open_close: &mut OpenClose,
) {
    let near = (&neighbours.pairs[..], &selection.near_sides);
    let accepted = &selection.accepted.found;
    open_close.arrange(&model.boundary, near, mass_matrix, &model.covers.block_ranges.covers, accepted);
}

/// Motion from which the forces of contacts follow.
pub(super) fn approach<'a>(
    model: &'a Model,
    state: &'a State,
    step: &Substep,
    motion: &'a MotionBuffers,
    frames: &'a Frames,
    selection: &'a SelectionBuffers,
) -> Approach<'a> {
    Approach {
        predicted: &motion.predicted,
        velocity: &state.velocity,
        dt_last: state.dt_last,
        forward: model.theta_in(step.dt),
        damping: if let Regime::Dynamic { damping } = step.regime { Some(damping) } else { None },
        setting: model.contact_setting(&state.laws, frames, selection),
        motion: &motion.blocks,
    }
}

/// Open–close iteration on the predicted velocities.
pub(super) fn open_close(
    model: &Model,
    step: &Substep,
    mass_matrix: &MassMatrix,
    approach: &Approach,
    contacts: &mut [VertexEdge],
    supports: &mut SupportBuffers,
    sweep: &mut SweepBuffers,
) -> SolverReport {
    let Substep { dt, kick, serial, .. } = *step;
    let Model { theta, tolerance, sweeps_max, .. } = *model;
    let options = SolverOptions { dt, kick, theta, tolerance, sweeps_max, serial };
    let SupportBuffers { rows, bolts, .. } = supports;
    let SweepBuffers { open_close, increment, push } = sweep;
    let swept = open_close.run(mass_matrix, &options, approach, contacts, &mut OtherConstraints { rows, bolts });
    open_close.impulses(mass_matrix, increment, push);
    swept
}
