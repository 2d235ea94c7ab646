//! What a stage needs before its first step: masses with its fixities, buffers, reference of the static damping.

use crate::contact::{Support, SupportRow};
use crate::geometry::Vector;
use crate::state::{Scratch, Slope, State};

use super::{Regime, applied, implicit, quiet};

/// Sizes the buffers and derives masses, support rows and laws from the state: needed after a build, a change of stage
/// and a restored state.
pub fn prepare(slope: &Slope, state: &State, scratch: &mut Scratch) {
    let covers = slope.covers.cover_count();
    for field in [&mut scratch.load_force, &mut scratch.predicted, &mut scratch.damped, &mut scratch.increment] {
        field.clear();
        field.resize(covers, Vector::zeros());
    }
    scratch.motion.resize(slope.covers.block_count(), Default::default());
    scratch.start.resize(slope.covers.block_count(), Default::default());
    scratch.sums.resize(slope.chunks.len(), Default::default());
    scratch.push.resize(slope.covers.block_count(), Default::default());
    scratch.columns.clear();
    scratch.columns.extend(state.columns.iter().map(|column| column.velocity.clone()));
    scratch.trace_law.clear();
    scratch.trace_law.extend(slope.trace_law.iter().map(|&law| state.law_switch[law as usize]));
    hold(slope, state, scratch);
    expose(slope, &mut scratch.exposed);
    scratch.open_close.prepare(&scratch.mass_matrix, &slope.supports, &scratch.rows);
    implicit::prepare(slope, &scratch.mass_matrix, &mut scratch.implicit);
}

/// Marks the covers whose predicted velocities contacts, supports or bolts may ask for.
fn expose(slope: &Slope, exposed: &mut Vec<bool>) {
    exposed.clear();
    exposed.resize(slope.covers.cover_count(), false);
    let of_contacts = slope.boundary.covers.iter().chain(&slope.boundary.edge_covers);
    let of_supports = slope.supports.iter().map(|support| &support.covers);
    let of_bolts = slope.bolts.iter().flat_map(|bolt| &bolt.covers);
    for &cover in of_contacts.chain(of_supports).chain(of_bolts).flatten() {
        exposed[cover as usize] = true;
    }
}

/// Masses and support rows under the fixities that hold and the blocks that are gone.
fn hold(slope: &Slope, state: &State, scratch: &mut Scratch) {
    scratch.mass_matrix.clone_from(&slope.mass_matrix);
    let mass_matrix = &mut scratch.mass_matrix;
    for (fixity, _) in slope.fixities.iter().zip(&state.fix_active).filter(|(_, active)| **active) {
        for &(cover, axes) in &fixity.covers {
            mass_matrix.hold_block(&slope.covers, slope.covers.cover_block[cover as usize] as usize);
            mass_matrix.hold_cover(cover as usize, axes);
        }
    }
    for block in (0..slope.covers.block_count()).filter(|&b| state.removed[b]) {
        mass_matrix.hold_block(&slope.covers, block);
        slope.covers.covers_of(block).for_each(|i| mass_matrix.hold_cover(i, [true, true]));
    }
    scratch.rows.clear();
    let holds = |(_, s): &(usize, &Support)| state.fix_active[s.fix as usize] && !state.removed[s.block as usize];
    for (_, support) in slope.supports.iter().enumerate().filter(holds) {
        mass_matrix.hold_block(&slope.covers, support.block as usize);
    }
    scratch.rows.extend(slope.supports.iter().enumerate().filter(holds).map(|(k, support)| SupportRow {
        support: k as u32,
        displacement: 0.0,
        target: 0.0,
        viscosity: 0.0,
        approach: 0.0,
        compliance: support.compliance(mass_matrix),
        force: state.support_force[k],
    }));
    let is_static = !state.stage_displacement.is_empty();
    if is_static && slope.implicit.is_none() && slope.mass_scaling > 1.0 {
        mass_matrix.lighten(slope.mass_scaling);
    }
    mass_matrix.mark_fixed(&slope.covers);
    scratch.damping_of = None;
    let is_movable = |i: usize| mass_matrix.inverse[i].x > 0.0 && mass_matrix.inverse[i].y > 0.0;
    scratch.movable.clear();
    scratch.movable.extend(slope.chunks.iter().map(|chunk| chunk.covers.clone().all(is_movable)));
}

/// Sets the clock and the references of a new stage; call [`prepare`] afterwards.
///
/// Velocities count as those of the start itself when they are `at_rest`, so that a sudden change of strength acts for
/// half a step only in the first kick; otherwise the leapfrog goes on. An implicit stage after a static one begins
/// from rest.
pub fn begin_stage(slope: &Slope, regime: Regime, state: &mut State, stage: u32, start: f64, at_rest: bool) {
    if at_rest {
        state.dt_last = 0.0;
        if slope.implicit.is_some() && stage > 0 {
            implicit::stop(slope, state);
        }
    }
    state.acceleration.clear();
    state.static_stretch = 0.0;
    state.stage = stage;
    state.stage_start = start;
    state.stage_step = 0;
    state.stage_starts.truncate(stage as usize);
    state.stage_starts.push(start);
    quiet::begin_stage(slope, regime, state);
    state.neighbours.forget();
    state.stage_displacement.clear();
    state.stage_force.clear();
    if let Regime::Static { .. } = regime {
        state.stage_displacement.clone_from(&state.displacement);
        let acceleration = applied::acceleration(slope, state, start);
        let mut force: Vec<Vector> = slope.mass_matrix.row_sum.iter().map(|m| acceleration * *m).collect();
        applied::push_forces(slope, state, start, 1.0, &mut force);
        state.stage_force = force;
    }
    for block in (0..slope.covers.block_count()).filter(|&b| state.removed[b]) {
        state.velocity[slope.covers.covers_of(block)].fill(Vector::zeros());
    }
}
