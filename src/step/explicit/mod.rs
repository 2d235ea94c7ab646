//! One step of the explicit integrator: [`set_out`] and [`cover`] are the table of contents.

mod blocks;
mod chunk_runs;
mod columns;
mod commit;
mod damp;
mod detect;
mod finish;
mod kick;
mod lane_work;
mod turn;
mod works;
mod yielding;

use std::time::Instant;

use crate::contact::{SolverReport, VertexEdge};
use crate::geometry::Vector;
use crate::mechanics::MassMatrix;
use crate::state::{Counters, Model, State, Workspace};

use super::contacts::{self, Reach};
use super::friction::delay_friction;
use super::integrator::{Integrator, StepOutcome};
use super::{Regime, StepInterval, StepReport, Substep, Wanted, applied, bonds, guard, quiet, records, report, settle};

use columns::kick_columns;
use commit::commit;
use damp::damp;
use detect::{approach, detect, open_close, order_contacts, prepare_supports};
use kick::predict;
use yielding::yield_rock;

/// Relative change of force above which an unsettled step is redone in halves (Eq. 16).
const UNSETTLED: f64 = 0.1;
/// Largest decay c·dt of velocities in a step: a factor d before the kick needs (ω dt)² < 2(1 + d), which holds at 0.9
/// of the critical step for d > 0.62.
const DECAY_MAX: f64 = 0.3;
/// Near pairs that are taken together, about, when contacts are only shown.
const PIECE: usize = 1 << 16;
/// Most times that a step is halved.
const HALVINGS_MAX: u32 = 4;

/// The explicit integrator.
pub(super) struct Explicit;

impl Integrator for Explicit {
    fn lightness(&self, model: &Model) -> f64 {
        model.mass_scaling
    }

    fn cover(
        &self,
        model: &Model,
        state: &mut State,
        workspace: &mut Workspace,
        interval: StepInterval,
    ) -> StepOutcome {
        cover(model, state, workspace, interval, 0)
    }

    fn find_contacts(&self, model: &Model, state: &mut State, workspace: &mut Workspace, interval: StepInterval) {
        let step = Substep::new(interval, state.dt_last, workspace.serial);
        set_out(model, state, &step, workspace);
        let Workspace { mass_matrix, motion, frames, selection, contacts, .. } = workspace;
        detect(model, state, &step, motion.speed_max, frames, selection, contacts);
        delay_friction(model, state, &step, mass_matrix, selection, contacts);
    }

    fn each_contact(
        &self,
        model: &Model,
        state: &mut State,
        workspace: &mut Workspace,
        interval: StepInterval,
        see: &mut dyn FnMut(&VertexEdge),
    ) {
        let step = Substep::new(interval, state.dt_last, workspace.serial);
        set_out(model, state, &step, workspace);
        detect_by_pieces(model, state, &step, workspace, see);
    }

    fn kinetic(&self, model: &Model, mass_matrix: &MassMatrix, displacement: &[Vector], velocity: &[Vector]) -> f64 {
        report::kinetic(model, mass_matrix, displacement, velocity)
    }
}

/// Positions, near pairs, yielding and predicted velocities of a sub-step.
fn set_out(model: &Model, state: &mut State, step: &Substep, workspace: &mut Workspace) {
    let Workspace { mass_matrix, load_force, yielding, motion, sums, frames, selection, sweep, seconds, .. } =
        workspace;
    let mut clock = Instant::now();
    contacts::locate(model, &state.displacement, frames, step.serial);
    seconds.entrance += lap(&mut clock);
    contacts::search(model, state, &mass_matrix.fixed, frames, selection, &mut sweep.open_close, step.serial);
    seconds.search += lap(&mut clock);
    yield_rock(model, state, step, mass_matrix, yielding);
    applied::load(model, state, step, load_force);
    damp(model, state, step, mass_matrix, motion);
    predict(model, state, step, (load_force, yielding), mass_matrix, motion, sums);
    kick_columns(model, state, step, &mut motion.columns);
    seconds.elements += lap(&mut clock);
}

/// Covers an interval by one sub-step, or by two halves when the iteration does not settle.
fn cover(
    model: &Model,
    state: &mut State,
    workspace: &mut Workspace,
    interval: StepInterval,
    halvings: u32,
) -> StepOutcome {
    let step = Substep::new(interval, state.dt_last, workspace.serial);
    set_out(model, state, &step, workspace);
    let Workspace { mass_matrix, motion, frames, selection, contacts, supports, sweep, seconds, .. } = workspace;
    let mut clock = Instant::now();
    detect(model, state, &step, motion.speed_max, frames, selection, contacts);
    delay_friction(model, state, &step, mass_matrix, selection, contacts);
    prepare_supports(model, state, &step, mass_matrix, motion, supports);
    seconds.entrance += lap(&mut clock);
    order_contacts(model, &state.neighbours, mass_matrix, selection, &mut sweep.open_close);
    let approach = approach(model, state, &step, motion, frames, selection);
    let swept = open_close(model, &step, mass_matrix, &approach, contacts, supports, sweep);
    seconds.sweep += lap(&mut clock);
    if swept.unsettled > UNSETTLED && halvings < HALVINGS_MAX {
        state.counters.halved += 1;
        let half = StepInterval { dt: 0.5 * step.dt, ..interval };
        let first = cover(model, state, workspace, half, halvings + 1);
        let rest = StepInterval { time: first.end, wanted: Wanted::Nothing, ..half };
        return StepOutcome { report: first.report, ..cover(model, state, workspace, rest, halvings + 1) };
    }
    count(model, step.dt, &swept, &mut state.counters);
    let outcome = commit(model, state, &step, workspace);
    workspace.seconds.commit += lap(&mut clock);
    outcome
}

/// The contacts of a sub-step, found piece by piece: all together they can be larger than the model. The
/// near pairs of the state are then of no further use.
fn detect_by_pieces(
    model: &Model,
    state: &mut State,
    step: &Substep,
    workspace: &mut Workspace,
    see: &mut dyn FnMut(&VertexEdge),
) {
    let Workspace { motion, frames, selection, contacts, .. } = workspace;
    let all = std::mem::take(&mut state.neighbours.pairs);
    let mut rest = all.as_slice();
    while let Some(last) = rest.get(PIECE).or(rest.last()) {
        let (piece, others) = rest.split_at(rest.partition_point(|c| c.node <= last.node));
        state.neighbours.pairs.clear();
        state.neighbours.pairs.extend_from_slice(piece);
        selection.near_sides.forget();
        detect(model, state, step, motion.speed_max, frames, selection, contacts);
        contacts.iter().for_each(&mut *see);
        rest = others;
    }
    selection.near_sides.forget();
}

fn count(model: &Model, dt: f64, swept: &SolverReport, counters: &mut Counters) {
    counters.substeps += 1;
    counters.sweeps += u64::from(swept.sweeps);
    counters.sweeps_max = counters.sweeps_max.max(swept.sweeps);
    counters.unsettled += u64::from(swept.unsettled > model.tolerance);
    counters.contacts_solved += swept.contacts_solved;
    counters.dt_min = if counters.dt_min > 0.0 { counters.dt_min.min(dt) } else { dt };
    counters.dt_max = counters.dt_max.max(dt);
}

/// Seconds since the last stage ended.
fn lap(clock: &mut Instant) -> f64 {
    let before = std::mem::replace(clock, Instant::now());
    (*clock - before).as_secs_f64()
}
