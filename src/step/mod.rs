//! One internal step: order of the stages, open–close iteration, damping, checks, report. Knows nothing of files.

mod applied;
mod blocks;
mod commit;
mod events;
mod guard;
mod implicit;
mod predict;
mod prepare;
mod quiet;
mod report;
mod settle;
mod times;
mod touch;
mod works;
mod yielding;

pub use applied::{acceleration, push_forces};
pub use guard::{Failure, StepError};
pub use prepare::{begin_stage, prepare};
pub use report::{StepReport, block_motion, energies, momentum};
pub(crate) use touch::CUTOFF;

use crate::contact::{SolverReport, VertexEdge};
use crate::mechanics::Damping;
use crate::state::{Model, State, Workspace};

use times::{StepTimes, Window};
use touch::CONTACTS;

/// Relative change of force above which an unsettled step is redone in halves (Eq. 16).
const UNSETTLED: f64 = 0.1;
/// Largest decay c·dt of velocities in a step: a factor d before the kick needs (ω dt)² < 2(1 + d), which holds at 0.9
/// of the critical step for d > 0.62.
const DECAY_MAX: f64 = 0.3;
/// Near pairs that are judged together, about, when contacts are only shown.
const PIECE: usize = 1 << 16;
/// Most times that a step is halved.
const HALVINGS_MAX: u32 = 4;
/// Covers from which a step is worth other threads than the caller's own.
pub const THREADS_FROM: usize = 4096;

/// How a stage treats velocities and gravity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Regime {
    /// Damped to equilibrium; gravity grows over `ramp` (s).
    Static {
        /// Time over which gravity and body loads grow (s); 0 for at once.
        ramp: f64,
    },
    /// True motion with deformation damping of ratio `damping`.
    Dynamic {
        /// Damping ratio ξ.
        damping: f64,
    },
}

/// Advances one internal step; with `report` the energies and the unbalanced ratio at its start are computed as well.
///
/// # Errors
/// Fails on a non-finite state, a runaway block or a penetration beyond the limit; `state` is then spoilt.
pub fn advance(
    model: &Model,
    regime: Regime,
    state: &mut State,
    workspace: &mut Workspace,
    report: bool,
) -> Result<StepReport, StepError> {
    let rest = model.dt - state.part;
    let mut step = Step::new(model, regime, state, workspace);
    step.report = report;
    let outcome = step.on_threads(rest);
    step.guard()?;
    state.stage_step += 1;
    state.step += 1;
    state.part = 0.0;
    let time = state.stage_start + state.stage_step as f64 * model.dt;
    events::note(model, regime, state, workspace, time);
    Ok(outcome)
}

/// Advances `dt` (s), a part of an internal step.
///
/// # Errors
/// As [`advance`].
pub fn advance_part(
    model: &Model,
    regime: Regime,
    state: &mut State,
    workspace: &mut Workspace,
    dt: f64,
) -> Result<StepReport, StepError> {
    let mut step = Step::new(model, regime, state, workspace);
    let outcome = step.on_threads(dt);
    step.guard()?;
    state.part += dt;
    Ok(outcome)
}

/// Energies and the unbalanced ratio that the next step will find at its start; nothing advances. With `serial` it
/// keeps to the calling thread.
pub fn outlook(model: &Model, regime: Regime, mut state: State, serial: bool) -> StepReport {
    let mut workspace = Workspace { serial, ..Workspace::default() };
    prepare(model, &state, &mut workspace);
    let rest = model.dt - state.part;
    let mut step = Step::new(model, regime, &mut state, &mut workspace);
    step.report = true;
    match &model.implicit {
        Some(implicit) => step.implicit_outlook(implicit, rest),
        None => step.interval(rest, 0),
    }
}

/// A copy of the state, with buffers of its own.
fn beside(model: &Model, state: &State, serial: bool) -> (State, Workspace) {
    let mut workspace = Workspace { serial, ..Workspace::default() };
    prepare(model, state, &mut workspace);
    (state.clone(), workspace)
}

/// State and buffers as the next step will have them when it has judged its contacts; nothing advances. With `serial`
/// it keeps to the calling thread.
pub fn look_ahead(model: &Model, regime: Regime, state: &State, serial: bool) -> (State, Workspace) {
    let (mut state, mut workspace) = beside(model, state, serial);
    let dt = model.dt - state.part;
    let mut step = Step::new(model, regime, &mut state, &mut workspace);
    if model.implicit.is_some() {
        step.implicit_contacts(dt);
    } else {
        let times = step.times(dt);
        step.set_out(times);
        step.touch(times);
    }
    (state, workspace)
}

/// Shows the contacts of [`look_ahead`], one by one and without holding all of them.
pub fn each_contact(model: &Model, regime: Regime, state: &State, serial: bool, see: &mut dyn FnMut(&VertexEdge)) {
    let (mut state, mut workspace) = beside(model, state, serial);
    let dt = model.dt - state.part;
    let mut step = Step::new(model, regime, &mut state, &mut workspace);
    if model.implicit.is_some() {
        step.implicit_contacts(dt);
        return workspace.contacts.iter().for_each(see);
    }
    let times = step.times(dt);
    step.set_out(times);
    step.entrance_by_pieces(times, see);
}

/// Share of gravity that acts at a time of the stage (s): a smooth rise over the ramp of a static stage.
fn ramp(regime: Regime, stage_time: f64) -> f64 {
    match regime {
        Regime::Static { ramp } if ramp > 0.0 => {
            let x = (stage_time / ramp).clamp(0.0, 1.0);
            x * x * (3.0 - 2.0 * x)
        }
        _ => 1.0,
    }
}

/// One step in progress.
struct Step<'a> {
    model: &'a Model,
    regime: Regime,
    state: &'a mut State,
    workspace: &'a mut Workspace,
    time: f64,
    report: bool,
    damping: Damping,
    /// Whether all speeds were found finite and below the limit.
    is_sound: bool,
    /// Whether the matrix of an implicit step was not positive definite however short the sub-step.
    singular: bool,
}

impl<'a> Step<'a> {
    fn new(model: &'a Model, regime: Regime, state: &'a mut State, workspace: &'a mut Workspace) -> Self {
        let time = state.stage_start + state.stage_step as f64 * model.dt + state.part;
        Self {
            model,
            regime,
            state,
            workspace,
            time,
            report: false,
            damping: Damping::Deformation(0.0),
            is_sound: false,
            singular: false,
        }
    }
}

impl Step<'_> {
    /// Covers `dt` (s) on the threads of the pool. A caller from outside hands over the whole of it at once, which is
    /// dearer for every parallel part by itself.
    fn on_threads(&mut self, dt: f64) -> StepReport {
        let is_small = self.model.covers.cover_count() < THREADS_FROM && self.state.contacts.len() <= CONTACTS;
        if self.workspace.serial || is_small { self.interval(dt, 0) } else { rayon::scope(|_| self.interval(dt, 0)) }
    }

    /// Covers `dt` (s) by one sub-step, or by two halves when the iteration does not settle.
    fn interval(&mut self, dt: f64, halvings: u32) -> StepReport {
        let model = self.model;
        if let Some(implicit) = &model.implicit {
            return self.implicit_interval(implicit, dt);
        }
        let times = self.times(dt);
        self.set_out(times);
        self.touch(times);
        self.answer(times);
        let swept = self.open_close(times);
        if swept.unsettled > UNSETTLED && halvings < HALVINGS_MAX {
            self.state.counters.halved += 1;
            let first = self.interval(0.5 * dt, halvings + 1);
            self.report = false;
            self.interval(0.5 * dt, halvings + 1);
            return first;
        }
        self.count(dt, &swept);
        self.commit(times)
    }

    /// Positions, near pairs, yielding and predicted velocities of a sub-step.
    fn set_out(&mut self, times: StepTimes) {
        self.locate();
        self.search();
        self.yield_rock();
        self.predict(times);
    }

    /// The contacts of a sub-step, judged piece by piece: all together they can be larger than the model. The
    /// near pairs of the state are spoilt.
    fn entrance_by_pieces(&mut self, times: StepTimes, see: &mut dyn FnMut(&VertexEdge)) {
        let all = std::mem::take(&mut self.state.neighbours.pairs);
        let mut rest = all.as_slice();
        while let Some(last) = rest.get(PIECE).or(rest.last()) {
            let (piece, others) = rest.split_at(rest.partition_point(|c| c.node <= last.node));
            self.state.neighbours.pairs.clear();
            self.state.neighbours.pairs.extend_from_slice(piece);
            self.touch(times);
            self.workspace.contacts.iter().for_each(&mut *see);
            rest = others;
        }
    }

    fn count(&mut self, dt: f64, swept: &SolverReport) {
        let counters = &mut self.state.counters;
        counters.substeps += 1;
        counters.sweeps += u64::from(swept.sweeps);
        counters.sweeps_max = counters.sweeps_max.max(swept.sweeps);
        counters.unsettled += u64::from(swept.unsettled > self.model.tolerance);
        counters.judged += swept.judged;
        counters.dt_min = if counters.dt_min > 0.0 { counters.dt_min.min(dt) } else { dt };
        counters.dt_max = counters.dt_max.max(dt);
    }
}
