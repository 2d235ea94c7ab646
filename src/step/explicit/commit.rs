//! The end of a sub-step: velocities, positions, contact histories and the ledger.

use crate::contact::{BoltState, ContactState, Frames};
use crate::geometry::Vector;
use crate::mechanics::{self, MassMatrix};
use crate::state::{
    BoltEnergies, ChunkSums, Ledger, Model, MotionBuffers, SelectionBuffers, State, SupportBuffers, SweepBuffers,
    Workspace,
};

use super::bonds::{Bonds, begin_sections, has_bonds};
use super::chunk_runs::{self, ChunkSlices};
use super::columns::move_columns;
use super::finish::Finish;
use super::kick::acceleration;
use super::settle::{settle_contacts, settle_supports};
use super::turn::turn;
use super::works::{contact_works, external_work, extra};
use super::{Regime, StepOutcome, StepReport, Substep, Wanted, guard, quiet, report};

/// Ends a sub-step; the outcome holds the report of its start when one is wanted.
pub(super) fn commit(model: &Model, state: &mut State, step: &Substep, workspace: &mut Workspace) -> StepOutcome {
    let Workspace { mass_matrix, motion, sums, frames, selection, contacts, .. } = workspace;
    let Workspace { outcomes, supports, sweep, sections, .. } = workspace;
    let totals = finish(model, state, step, mass_matrix, motion, sweep, sums);
    let setting = model.contact_setting(&state.laws, frames, selection);
    let has_bonds = has_bonds(model, state);
    let (velocities, counters) = ([&state.velocity[..], &motion.predicted], &mut state.counters);
    settle_contacts(setting, step, velocities, contacts, &mut state.contacts, outcomes, counters);
    settle_supports(&supports.rows, &mut state.support_force);
    let mut works = contact_works(model, step.kick, velocities, outcomes, supports);
    if has_bonds {
        let (histories, bonds) = (&mut state.contacts[..], &mut state.bonds);
        let mut bonds = Bonds { setting, step, velocities, contacts, histories, bonds, counters };
        begin_sections(&model.sections, &setting, sections);
        works.add_works(&bonds.settle(sections), 1.0);
        works.fracture += bonds.break_sections(model, sections, &mut state.sections);
    }
    works.damping = totals.damping;
    let forces = (extra(model, state, step), totals.row_sum);
    works.external_work += external_work(step.kick, velocities, forces, &workspace.load_force);
    let report = match step.wanted {
        Wanted::Nothing => StepReport::default(),
        Wanted::Forces => report_of_forces(model, state, step, workspace),
        Wanted::Report => start_report(model, state, step, &works, workspace),
    };
    let Workspace { mass_matrix, motion, sums, frames, selection, supports, sweep, .. } = workspace;
    keep_found(model, state, frames, selection);
    keep_stage_force(model, state, step, mass_matrix, motion);
    move_columns(step, &motion.columns, &mut state.columns);
    if step.wanted != Wanted::Nothing {
        drift(step.dt, &motion.predicted, &mut state.displacement, sums);
    }
    turn(model, step, mass_matrix, &sweep.push, motion, &mut state.displacement, sums);
    quiet::move_supports(model, state, step);
    settle_bolts(model, supports, &state.displacement, &mut state.bolts);
    std::mem::swap(&mut state.velocity, &mut motion.predicted);
    state.ledger.add_works(&works, 1.0);
    state.dt_last = step.dt;
    let is_sound = totals.squares.is_finite() && totals.fastest <= guard::speed_limit(model).powi(2);
    StepOutcome { report, end: step.time + step.dt, is_sound, is_singular: false }
}

/// Keeps what was found out about the contacts, unless bonds change them or displacements are small.
fn keep_found(model: &Model, state: &mut State, frames: &Frames, selection: &mut SelectionBuffers) {
    if has_bonds(model, state) || selection.kept_gaps.is_some() {
        state.found.forget();
    } else {
        state.found.take_over(&mut selection.accepted.found, frames, state.step, &model.detection);
    }
}

/// Adds what the impulses of all contacts give to every cover (Eq. 17); moves the covers unless a report wants the
/// positions before.
fn finish(
    model: &Model,
    state: &mut State,
    step: &Substep,
    mass_matrix: &MassMatrix,
    motion: &mut MotionBuffers,
    SweepBuffers { increment, push, .. }: &SweepBuffers,
    sums: &mut [ChunkSums],
) -> ChunkSums {
    let is_loaded = extra(model, state, step) != Vector::zeros();
    let MotionBuffers { predicted, blocks, start, damping, movable, exposed, .. } = motion;
    let finish = Finish {
        model,
        mass_matrix,
        before: &state.velocity,
        motion: blocks,
        start,
        push,
        increment,
        damping,
        movable,
        exposed,
        moves_for: if step.wanted == Wanted::Nothing { step.dt } else { 0.0 },
        is_loaded,
        grain: chunk_runs::grain(step.serial),
    };
    let displacement = &mut state.displacement;
    finish.run(ChunkSlices { velocity: predicted, displacement, sums, ..ChunkSlices::default() })
}

/// Moves the covers with the final velocities (m/s) after a report.
fn drift(dt: f64, velocity: &[Vector], displacement: &mut [Vector], sums: &mut [ChunkSums]) {
    displacement.iter_mut().zip(velocity).for_each(|(u, v)| *u += v * dt);
    sums.iter_mut().for_each(|sums| sums.is_near = false);
}

/// Keeps forces and lengths of the bolts that have carried force, and brings grouted bars into balance.
fn settle_bolts(model: &Model, supports: &mut SupportBuffers, displacement: &[Vector], bolts: &mut [BoltState]) {
    let star = &model.covers.star_position;
    for row in supports.bolts.iter().filter(|row| !row.stays) {
        let segment = &model.bolts[row.segment as usize];
        let bolt = &mut bolts[row.segment as usize];
        let length = segment.span(star, displacement).norm();
        *bolt = segment.after(bolt, length, row.force);
    }
    supports.grout.settle(&model.bolts, bolts, star, displacement);
}

/// Changes of the velocities (m/s) of each cover by all forces, cover by cover: what is more than damping leaves.
fn each_change(
    model: &Model,
    state: &State,
    mass_matrix: &MassMatrix,
    motion: &mut MotionBuffers,
    mut see: impl FnMut(usize, Vector),
) {
    let MotionBuffers { damped, damping, predicted, .. } = motion;
    for block in model.covers.blocks() {
        let own = model.covers.covers_of(block);
        damped.clear();
        damped.resize(own.len(), Vector::zeros());
        if !mass_matrix.fixed[block] {
            let covers = report::block_covers(model, mass_matrix, &state.displacement, &state.velocity, block);
            mechanics::damp(&covers, damping[block], damped);
        }
        own.zip(&*damped).for_each(|(i, damped)| see(i, predicted[i] - damped));
    }
}

/// Energies at the start of this sub-step and the unbalanced ratio.
fn start_report(model: &Model, state: &State, step: &Substep, works: &Ledger, workspace: &mut Workspace) -> StepReport {
    let of_forces = report_of_forces(model, state, step, workspace);
    let Workspace { mass_matrix, motion, .. } = workspace;
    let kinetic = |velocity: &[Vector]| report::kinetic(model, mass_matrix, &state.displacement, velocity);
    let mut ledger = state.ledger;
    ledger.add_works(works, 0.5);
    ledger.kinetic = 0.5 * (kinetic(&state.velocity) + kinetic(&motion.predicted));
    ledger.strain = report::strain(model, state);
    ledger.potential = report::potential(model, state);
    ledger.stored = of_forces.ledger.stored;
    ledger.bolts.stored = of_forces.ledger.bolts.stored;
    let contacts = workspace.contacts.iter();
    let count = |which: ContactState| contacts.clone().filter(|c| c.history.state == which).count() as u32;
    StepReport {
        ledger,
        kinetic_of_most: report::kinetic_of_most(model, &workspace.mass_matrix, state, &workspace.motion.predicted),
        locked: count(ContactState::Lock),
        slipping: count(ContactState::Slip),
        penetration_max: contacts.clone().map(|c| c.penetration()).fold(0.0, f64::max),
        speed_max: report::speed_max(model, state),
        ..of_forces
    }
}

/// The unbalanced ratio and the energies that the forces of this sub-step store.
fn report_of_forces(model: &Model, state: &State, step: &Substep, workspace: &mut Workspace) -> StepReport {
    let Workspace { mass_matrix, motion, load_force, .. } = workspace;
    let unbalanced = unbalanced(model, state, step, load_force, mass_matrix, motion);
    let stored = report::stored(model, state, workspace);
    let bolts = BoltEnergies { stored: report::bolt_stored(model, state), ..BoltEnergies::default() };
    let ledger = Ledger { stored, bolts, ..Ledger::default() };
    StepReport { time: step.time, dt: step.dt, ledger, unbalanced, ..StepReport::default() }
}

/// ‖m·dv/dt‖ over ‖applied force‖ (Eq. 19).
fn unbalanced(
    model: &Model,
    state: &State,
    step: &Substep,
    load_force: &[Vector],
    mass_matrix: &MassMatrix,
    motion: &mut MotionBuffers,
) -> f64 {
    let masses = &model.mass_matrix;
    let acceleration = acceleration(model, state, step);
    let load = |i: usize| load_force.get(i).copied().unwrap_or_default();
    let weights = masses.row_sum.iter().map(|mass| acceleration * *mass).enumerate();
    let applied: f64 = weights.map(|(i, weight)| (load(i) + weight).norm_squared()).sum();
    let mut net = 0.0;
    each_change(model, state, mass_matrix, motion, |i, change| {
        net += (change * (masses.mass[i] / step.kick)).norm_squared();
    });
    let stage: f64 = state.stage_force.iter().map(Vector::norm_squared).sum();
    report::unbalanced(net, applied.max(stage)).sqrt()
}

/// The forces out of balance in the first step of a static stage that begins under full load.
fn keep_stage_force(model: &Model, state: &mut State, step: &Substep, masses: &MassMatrix, motion: &mut MotionBuffers) {
    if state.stage_step > 0 || !matches!(step.regime, Regime::Static { ramp: 0.0 }) {
        return;
    }
    let mass = &model.mass_matrix.mass;
    let mut stage_force = std::mem::take(&mut state.stage_force);
    each_change(model, state, masses, motion, |i, change| stage_force[i] = change * (mass[i] / step.kick));
    state.stage_force = stage_force;
}
