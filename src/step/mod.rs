//! One internal step by the explicit integrator, or by another that is given to it, checks, events and reports. Knows
//! nothing of files.

mod applied;
mod bonds;
mod contacts;
mod events;
mod explicit;
mod faces;
mod friction;
mod guard;
mod integrator;
mod joint_water;
mod prepare;
mod quiet;
mod records;
mod report;
mod settle;
mod substep;

pub use applied::{acceleration, push_forces};
pub use bonds::has_bonds;
pub use contacts::{Reach, find_contacts, locate, search};
pub use friction::{delay_friction, delay_of};
pub use guard::{Failure, StepError};
pub use integrator::{Integrator, StepOutcome};
pub use prepare::{begin_stage, prepare};
pub use quiet::{load_supports, move_supports};
pub use records::base_motion;
pub use report::{
    StepReport, block_motion, energies, energies_at_velocities, mass_of_few, momentum, potential, speed_max, stored,
    strain, unbalanced,
};
pub use settle::{settle_contacts, settle_supports};
pub use substep::{StepInterval, Substep, Wanted, Window};

use crate::contact::VertexEdge;
use crate::state::{Model, State, Workspace};

use contacts::CONTACTS;
use explicit::Explicit;

/// Covers from which a step is worth other threads than the caller's own.
pub const THREADS_FROM: usize = 4096;

/// The integrator of a model: the one place that chooses.
fn integrator_of(model: &Model) -> &dyn Integrator {
    let other = model.integrator.as_ref().and_then(|other| other.get::<Box<dyn Integrator>>());
    other.map_or(&Explicit, |other| &**other)
}

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

impl Regime {
    /// A static stage whose gravity acts at once.
    pub const AT_REST: Self = Self::Static { ramp: 0.0 };
}

/// Advances one internal step; the report holds what is `wanted` of its start.
///
/// # Errors
/// Fails on a non-finite state, a runaway block or a penetration beyond the limit; `state` is then of no further use.
pub fn advance(
    model: &Model,
    regime: Regime,
    state: &mut State,
    workspace: &mut Workspace,
    wanted: Wanted,
) -> Result<StepReport, StepError> {
    let outcome = cover(model, state, workspace, StepInterval { wanted, ..rest_of_step(model, regime, state) })?;
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
    wanted: Wanted,
) -> Result<StepReport, StepError> {
    let outcome = cover(model, state, workspace, StepInterval { dt, wanted, ..rest_of_step(model, regime, state) })?;
    state.part += dt;
    Ok(outcome)
}

/// Covers an interval on the threads of the pool, and checks where it has led. A caller from outside hands over the
/// whole of it at once, which is dearer for every parallel part by itself.
fn cover(
    model: &Model,
    state: &mut State,
    workspace: &mut Workspace,
    interval: StepInterval,
) -> Result<StepReport, StepError> {
    let is_small = model.covers.cover_count() < THREADS_FROM && state.contacts.len() <= CONTACTS;
    let integrator = integrator_of(model);
    let outcome = if workspace.serial || is_small {
        integrator.cover(model, state, workspace, interval)
    } else {
        rayon::scope(|_| integrator.cover(model, state, workspace, interval))
    };
    guard::check(model, state, workspace, &outcome)?;
    Ok(outcome.report)
}

/// The rest of the internal step in progress, of whose start nothing is wanted.
fn rest_of_step(model: &Model, regime: Regime, state: &State) -> StepInterval {
    let time = state.stage_start + state.stage_step as f64 * model.dt + state.part;
    StepInterval { regime, time, dt: state.rest_of_step(model), wanted: Wanted::Nothing }
}

/// Energies and the unbalanced ratio that the next step will find at its start; nothing advances. With `serial` it
/// keeps to the calling thread.
pub fn outlook(model: &Model, regime: Regime, mut state: State, serial: bool) -> StepReport {
    let mut workspace = Workspace { serial, ..Workspace::default() };
    prepare(model, &state, &mut workspace);
    let interval = StepInterval { wanted: Wanted::Report, ..rest_of_step(model, regime, &state) };
    integrator_of(model).begin(model, &mut state, &mut workspace, interval)
}

/// A copy of the state, with buffers of its own.
fn beside(model: &Model, state: &State, serial: bool) -> (State, Workspace) {
    let mut workspace = Workspace { serial, ..Workspace::default() };
    prepare(model, state, &mut workspace);
    (state.clone(), workspace)
}

/// State and buffers as the next step will have them when it has found its contacts; nothing advances. With `serial`
/// it keeps to the calling thread.
pub fn look_ahead(model: &Model, regime: Regime, state: &State, serial: bool) -> (State, Workspace) {
    let (mut state, mut workspace) = beside(model, state, serial);
    let interval = rest_of_step(model, regime, &state);
    integrator_of(model).find_contacts(model, &mut state, &mut workspace, interval);
    (state, workspace)
}

/// Shows the contacts of [`look_ahead`], one by one and without holding all of them.
pub fn each_contact(model: &Model, regime: Regime, state: &State, serial: bool, see: &mut dyn FnMut(&VertexEdge)) {
    let (mut state, mut workspace) = beside(model, state, serial);
    let interval = rest_of_step(model, regime, &state);
    integrator_of(model).each_contact(model, &mut state, &mut workspace, interval, see);
}

/// Share of gravity that acts at a time of the stage (s): a smooth rise over the ramp of a static stage.
pub fn ramp(regime: Regime, stage_time: f64) -> f64 {
    match regime {
        Regime::Static { ramp } if ramp > 0.0 => {
            let x = (stage_time / ramp).clamp(0.0, 1.0);
            x * x * (3.0 - 2.0 * x)
        }
        _ => 1.0,
    }
}
