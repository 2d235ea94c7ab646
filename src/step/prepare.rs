//! Preparation of a stage before its first step: masses with its fixities, buffers, reference of the static damping.

use crate::contact::{Support, SupportRow};
use crate::cover::CoverId;
use crate::geometry::Vector;
use crate::state::{Model, State, Workspace};

use super::{Regime, applied, integrator_of, quiet};

/// Sizes the buffers and derives masses, support rows and laws from the state: needed after a build, a change of stage
/// and a restored state.
pub fn prepare(model: &Model, state: &State, workspace: &mut Workspace) {
    let covers = model.covers.cover_count();
    let Workspace { motion, selection, sweep, sums, sections, .. } = &mut *workspace;
    for field in [&mut motion.predicted, &mut sweep.increment] {
        field.clear();
        field.resize(covers, Vector::zeros());
    }
    motion.blocks.resize(model.covers.block_count(), Default::default());
    motion.start.resize(model.covers.block_count(), Default::default());
    sums.resize(model.chunks.len(), Default::default());
    sweep.push.resize(model.covers.block_count(), Default::default());
    motion.columns.clear();
    motion.columns.extend(state.columns.iter().map(|column| column.velocity.clone()));
    selection.trace_law.clear();
    selection.trace_law.extend(model.trace_law.iter().map(|&law| state.law_switch[law]));
    selection.section_share.reserve(model.sections.list.len());
    sections.reserve(model.sections.list.len());
    selection.near_sides.forget();
    selection.kept_gaps = None;
    selection.left_out.clear();
    expose(model, &mut motion.exposed);
    hold(model, state, workspace);
    workspace.sweep.open_close.prepare(&workspace.mass_matrix, &model.supports, &workspace.supports.rows);
    integrator_of(model).prepare(model, workspace);
}

/// Marks the covers whose predicted velocities contacts, supports or bolts may read.
fn expose(model: &Model, exposed: &mut Vec<bool>) {
    exposed.clear();
    exposed.resize(model.covers.cover_count(), false);
    let of_contacts = &model.boundary.covers;
    let of_supports = model.supports.iter().map(|support| &support.covers);
    let of_bolts = model.bolts.iter().flat_map(|bolt| &bolt.covers);
    for &cover in of_contacts.iter().chain(of_supports).chain(of_bolts).flatten() {
        exposed[cover] = true;
    }
}

/// Masses and support rows under the fixities that hold and the blocks that are gone.
fn hold(model: &Model, state: &State, workspace: &mut Workspace) {
    workspace.mass_matrix.clone_from(&model.mass_matrix);
    let mass_matrix = &mut workspace.mass_matrix;
    for (fixity, _) in model.fixities.iter().zip(&state.fix_active).filter(|(_, active)| **active) {
        for &(cover, axes) in &fixity.covers {
            mass_matrix.hold_block(&model.covers, model.covers.cover_block[cover]);
            mass_matrix.hold_cover(cover, axes);
        }
    }
    for block in model.covers.blocks().filter(|&b| state.removed[b]) {
        mass_matrix.hold_block(&model.covers, block);
        CoverId::range(model.covers.covers_of(block)).for_each(|i| mass_matrix.hold_cover(i, [true, true]));
    }
    workspace.supports.rows.clear();
    let holds = |(_, s): &(usize, &Support)| state.fix_active[s.fix as usize] && !state.removed[s.block];
    for (_, support) in model.supports.iter().enumerate().filter(holds) {
        mass_matrix.hold_block(&model.covers, support.block);
    }
    workspace.supports.rows.extend(model.supports.iter().enumerate().filter(holds).map(|(k, support)| SupportRow {
        support: k as u32,
        displacement: 0.0,
        target: 0.0,
        viscosity: 0.0,
        approach: 0.0,
        compliance: support.compliance(mass_matrix),
        force: state.support_force[k],
    }));
    let is_static = !state.stage_displacement.is_empty();
    let lightness = integrator_of(model).lightness(model);
    if is_static && lightness > 1.0 {
        mass_matrix.lighten(lightness);
    }
    mass_matrix.mark_fixed(&model.covers);
    let motion = &mut workspace.motion;
    motion.damping_of = None;
    let is_movable = |i: usize| mass_matrix.inverse[i].x > 0.0 && mass_matrix.inverse[i].y > 0.0;
    motion.movable.clear();
    motion.movable.extend(model.chunks.iter().map(|chunk| chunk.covers.clone().all(is_movable)));
}

/// Sets the clock and the references of a new stage; call [`prepare`] afterwards.
///
/// Velocities count as those of the start itself when they are `at_rest`, so that a sudden change of strength acts for
/// half a step only in the first kick; otherwise the leapfrog goes on. An implicit stage after a static one begins
/// from rest.
pub fn begin_stage(model: &Model, regime: Regime, state: &mut State, stage: u32, start: f64, at_rest: bool) {
    if at_rest {
        state.dt_last = 0.0;
        integrator_of(model).stop(model, state, stage);
    }
    state.acceleration.clear();
    state.static_stretch = 0.0;
    (state.most_rest, state.friction_delay) = (None, None);
    state.stage = stage;
    state.stage_start = start;
    state.stage_step = 0;
    state.stage_starts.truncate(stage as usize);
    state.stage_starts.push(start);
    quiet::begin_stage(model, regime, state);
    state.neighbours.forget();
    state.found.forget();
    state.stage_displacement.clear();
    state.stage_force.clear();
    if let Regime::Static { .. } = regime {
        state.stage_displacement.clone_from(&state.displacement);
        let acceleration = applied::acceleration(model, state, start);
        let mut force: Vec<Vector> = model.mass_matrix.row_sum.iter().map(|m| acceleration * *m).collect();
        applied::push_forces(model, state, Regime::AT_REST, start, &mut force[..]);
        state.stage_force = force;
    }
    for block in model.covers.blocks().filter(|&b| state.removed[b]) {
        state.velocity[model.covers.covers_of(block)].fill(Vector::zeros());
    }
}
