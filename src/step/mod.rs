//! One internal step: order of the stages, open–close iteration, damping, checks, report. Knows nothing of files.

mod applied;
mod blocks;
mod commit;
mod events;
mod guard;
mod implicit;
mod prepare;
mod quiet;
mod report;
mod yielding;

pub use guard::{Failure, StepError};
pub use prepare::{begin_stage, prepare};
pub use report::{StepReport, block_motion, energies, momentum};

use std::time::Instant;

use crate::contact::{self, BoltView, Narrow, OpenClose, SearchView, SweepOptions, SweepReport, VertexEdge};
use crate::geometry::{Point, Vector};
use crate::mechanics::Damping;
use crate::state::{Scratch, Slope, State};

/// Distance beyond the search cutoff, relative to the mesh size, that nodes may move before the next search.
const SKIN: f64 = 0.1;
/// Distance, relative to the mesh size, within which pairs are kept.
const CUTOFF: f64 = 0.25;
/// Gap, relative to the mesh size, within which a resting contact takes part in the iteration.
const REACH: f64 = 0.005;
/// Relative change of force above which an unsettled step is redone in halves (Eq. 16).
const UNSETTLED: f64 = 0.1;
/// Largest decay c·dt of velocities in a step: a factor d before the kick needs (ω dt)² < 2(1 + d), which holds at 0.9
/// of the critical step for d > 0.62.
const DECAY_MAX: f64 = 0.3;
/// Most times that a step is halved.
const HALVINGS_MAX: u32 = 4;

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
    slope: &Slope,
    regime: Regime,
    state: &mut State,
    scratch: &mut Scratch,
    report: bool,
) -> Result<StepReport, StepError> {
    let rest = slope.dt - state.part;
    let mut step = Step::new(slope, regime, state, scratch);
    step.report = report;
    let outcome = step.interval(rest, 0);
    step.guard()?;
    state.stage_step += 1;
    state.step += 1;
    state.part = 0.0;
    let time = state.stage_start + state.stage_step as f64 * slope.dt;
    events::note(slope, regime, state, scratch, time);
    Ok(outcome)
}

/// Advances `dt` (s), a part of an internal step.
///
/// # Errors
/// As [`advance`].
pub fn advance_part(
    slope: &Slope,
    regime: Regime,
    state: &mut State,
    scratch: &mut Scratch,
    dt: f64,
) -> Result<StepReport, StepError> {
    let mut step = Step::new(slope, regime, state, scratch);
    let outcome = step.interval(dt, 0);
    step.guard()?;
    state.part += dt;
    Ok(outcome)
}

/// Energies and the unbalanced ratio that the next step will find at its start; nothing advances.
pub fn outlook(slope: &Slope, regime: Regime, mut state: State, scratch: &Scratch) -> StepReport {
    let mut scratch = scratch.clone();
    let rest = slope.dt - state.part;
    let mut step = Step::new(slope, regime, &mut state, &mut scratch);
    step.report = true;
    match &slope.implicit {
        Some(implicit) => step.implicit_outlook(implicit, rest),
        None => step.interval(rest, 0),
    }
}

/// The contacts that the next step will judge, with the forces of the last one; nothing advances.
pub fn contacts(slope: &Slope, regime: Regime, state: &State, scratch: &Scratch) -> Vec<VertexEdge> {
    let (mut state, mut scratch) = (state.clone(), scratch.clone());
    let dt = slope.dt - state.part;
    let mut step = Step::new(slope, regime, &mut state, &mut scratch);
    if slope.implicit.is_some() {
        step.implicit_contacts(dt);
        return scratch.contacts;
    }
    step.search();
    step.yield_rock();
    step.predict(dt);
    step.entrance(step.reach(dt), step.state.dt_last);
    scratch.contacts
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
    slope: &'a Slope,
    regime: Regime,
    state: &'a mut State,
    scratch: &'a mut Scratch,
    time: f64,
    report: bool,
    damping: Damping,
    /// Whether the matrix of an implicit step was not positive definite however short the sub-step.
    singular: bool,
}

impl<'a> Step<'a> {
    fn new(slope: &'a Slope, regime: Regime, state: &'a mut State, scratch: &'a mut Scratch) -> Self {
        let time = state.stage_start + state.stage_step as f64 * slope.dt + state.part;
        Self { slope, regime, state, scratch, time, report: false, damping: Damping::Deformation(0.0), singular: false }
    }
}

impl Step<'_> {
    /// Covers `dt` (s) by one sub-step, or by two halves when the iteration does not settle.
    fn interval(&mut self, dt: f64, halvings: u32) -> StepReport {
        let slope = self.slope;
        if let Some(implicit) = &slope.implicit {
            return self.implicit_interval(implicit, dt);
        }
        self.search();
        self.yield_rock();
        self.predict(dt);
        self.entrance(self.reach(dt), self.state.dt_last);
        self.answer(dt);
        let swept = self.open_close(dt);
        if swept.unsettled > UNSETTLED && halvings < HALVINGS_MAX {
            self.state.counters.halved += 1;
            let first = self.interval(0.5 * dt, halvings + 1);
            self.report = false;
            self.interval(0.5 * dt, halvings + 1);
            return first;
        }
        self.count(dt, &swept);
        self.commit(dt)
    }

    /// Current places of boundary points, and near pairs when nodes have moved.
    fn search(&mut self) {
        let clock = Instant::now();
        let (slope, scratch) = (self.slope, &mut *self.scratch);
        let boundary = &slope.boundary;
        let star = &slope.covers.star_position;
        let displacement = &self.state.displacement;
        scratch.place.clear();
        scratch.place.extend(boundary.covers.iter().zip(&boundary.weights).map(|(covers, weights)| {
            (0..3).map(|k| (star[covers[k] as usize] + displacement[covers[k] as usize]) * weights[k]).sum::<Point>()
        }));
        let size = slope.covers.mesh.size;
        if self.state.near.is_stale(boundary, &scratch.place, SKIN * size) {
            let view = SearchView {
                boundary,
                place: &scratch.place,
                cell: size,
                cutoff: CUTOFF * size,
                removed: &self.state.removed,
                fixed: &scratch.metric.fixed,
            };
            scratch.search.search(&view, &mut self.state.near);
            self.state.counters.searches += 1;
        }
        scratch.seconds.search += clock.elapsed().as_secs_f64();
    }

    /// Plastic strain at the current displacements.
    fn yield_rock(&mut self) {
        let clock = Instant::now();
        yielding::update(self.slope, self.state, self.scratch, self.time);
        self.scratch.seconds.elements += clock.elapsed().as_secs_f64();
    }

    /// Internal forces, loads and the kick of every block without contact forces.
    fn predict(&mut self, dt: f64) {
        let clock = Instant::now();
        let kick_dt = 0.5 * (self.state.dt_last + dt);
        let (slope, state, scratch) = (self.slope, &*self.state, &mut *self.scratch);
        let ramp = ramp(self.regime, self.time - state.stage_start);
        scratch.load_force.fill(Vector::zeros());
        applied::push_forces(slope, state, self.time, ramp, &mut scratch.load_force);
        self.damping = self.damping_of(dt);
        let pass = blocks::Pass {
            slope,
            state: &*self.state,
            acceleration: self.acceleration(dt),
            damping: self.damping,
            dt: kick_dt,
            grain: blocks::grain(self.scratch.serial),
        };
        pass.run(self.scratch);
        self.kick_columns(dt);
        for (spin, motion) in self.scratch.metric.spin.iter_mut().zip(&self.scratch.motion) {
            *spin = motion.spin;
        }
        self.scratch.seconds.elements += clock.elapsed().as_secs_f64();
    }

    /// Acceleration of all rock (m/s²) in a step of `dt` (s).
    fn acceleration(&self, dt: f64) -> Vector {
        let base = applied::base_motion(self.slope, self.regime, self.state, self.kick_of(dt));
        applied::acceleration(self.slope, self.state, self.time) * self.ramp() - base
    }

    /// Share of gravity that acts at this time.
    fn ramp(&self) -> f64 {
        ramp(self.regime, self.time - self.state.stage_start)
    }

    /// Damping of a step of `dt` (s) (Eqs. 11, 12).
    fn damping_of(&self, dt: f64) -> Damping {
        match self.regime {
            Regime::Dynamic { damping } => Damping::Deformation(damping * dt),
            Regime::Static { .. } => {
                let (mut work, mut inertia) = (0.0, 0.0);
                let state = &*self.state;
                for i in 0..state.displacement.len() {
                    let moved = state.displacement[i] - state.stage_displacement[i];
                    work += state.stage_force[i].dot(&moved);
                    inertia += self.slope.metric.mass[i] * moved.norm_squared();
                }
                let rate = 2.0 * (self.ramp() * work.max(0.0) / inertia.max(f64::MIN_POSITIVE)).sqrt();
                Damping::Mass((-(rate * dt).min(DECAY_MAX)).exp())
            }
        }
    }

    /// Gap (m) below which a contact takes part in an explicit step of `dt` (s).
    fn reach(&self, dt: f64) -> f64 {
        REACH * self.slope.covers.mesh.size + 8.0 * dt * self.scratch.speed_max
    }

    /// Contacts that take part in this step, with geometry and approach velocities: those nearer than `reach` (m);
    /// covers have moved for `dt_last` (s) with the velocities of the state.
    fn entrance(&mut self, reach: f64, dt_last: f64) {
        let clock = Instant::now();
        let (slope, state, scratch) = (self.slope, &*self.state, &mut *self.scratch);
        let size = slope.covers.mesh.size;
        let narrow = Narrow {
            boundary: &slope.boundary,
            place: &scratch.place,
            star: &slope.covers.star_position,
            displacement: &state.displacement,
            metric: &scratch.metric,
            motion: &scratch.motion,
            laws: &state.laws,
            trace_law: &scratch.trace_law,
            strength: state.drive.strength_factor(state.drive.share(self.time)),
            default_law: state.law_switch.get(slope.default_law as usize).copied().unwrap_or_default(),
            velocity: &state.velocity,
            dt_last,
            history: &state.contacts,
            size,
            reach,
            theta: slope.theta,
            behind: &state.near.behind,
            first: state.step == 0,
            in_situ: slope.in_situ.as_ref(),
        };
        scratch.contacts.clear();
        contact::entrance_edges(&narrow, &state.near.candidates, &mut scratch.contacts);
        scratch.seconds.entrance += clock.elapsed().as_secs_f64();
    }

    /// How contacts, supports and bolts answer in a step of `dt` (s).
    fn answer(&mut self, dt: f64) {
        let clock = Instant::now();
        let (state, scratch) = (&*self.state, &mut *self.scratch);
        let kick = 0.5 * (state.dt_last + dt);
        let (is_dynamic, ratio) = match self.regime {
            Regime::Dynamic { damping } => (true, damping),
            Regime::Static { .. } => (false, 0.0),
        };
        for contact in &mut scratch.contacts {
            contact.approach = contact.relative(&scratch.predicted);
            let physical = state.laws[contact.law as usize].penalty.map(|penalty| is_dynamic && !penalty);
            if physical != [false; 2] {
                let last = contact.relative(&state.velocity).map(|v| v * state.dt_last);
                let inverse: f64 = contact.pair.blocks.map(|b| scratch.metric.inverse_total[b as usize]).iter().sum();
                let bouncing = if inverse > 0.0 { 2.0 * ratio / inverse.sqrt() } else { 0.0 };
                contact.centre(physical, dt, kick, last, bouncing);
            }
        }
        self.load_supports(dt);
        self.load_bolts();
        self.scratch.seconds.entrance += clock.elapsed().as_secs_f64();
    }

    /// Bolts that bear in this step.
    fn load_bolts(&mut self) {
        let (slope, state, scratch) = (self.slope, &*self.state, &mut *self.scratch);
        let view = BoltView {
            star: &slope.covers.star_position,
            displacement: &state.displacement,
            predicted: &scratch.predicted,
            metric: &scratch.metric,
            motion: &scratch.motion,
        };
        let rows = slope.bolts.iter().zip(&state.bolts).enumerate();
        let bearing = rows.filter(|(_, (_, bolt))| bolt.active && !bolt.broken);
        scratch.bolts.clear();
        scratch.bolts.extend(bearing.map(|(k, (segment, bolt))| segment.row(k as u32, bolt, &view)));
    }

    /// Open–close iteration on the predicted velocities.
    fn open_close(&mut self, dt: f64) -> SweepReport {
        let clock = Instant::now();
        let kick = 0.5 * (self.state.dt_last + dt);
        let (slope, scratch) = (self.slope, &mut *self.scratch);
        scratch.increment.fill(Vector::zeros());
        scratch.push.fill(contact::BlockPush::default());
        let (theta, tolerance, sweeps_max) = (slope.theta, slope.tolerance, slope.sweeps_max);
        let options = SweepOptions { dt, kick, theta, tolerance, sweeps_max };
        let iteration =
            OpenClose { metric: &scratch.metric, options, increment: &mut scratch.increment, push: &mut scratch.push };
        let (contacts, rows, bolts) = (&mut scratch.contacts, &mut scratch.rows, &mut scratch.bolts);
        let swept = contact::open_close(iteration, contacts, &slope.supports, rows, bolts);
        scratch.seconds.sweep += clock.elapsed().as_secs_f64();
        swept
    }

    fn count(&mut self, dt: f64, swept: &SweepReport) {
        let counters = &mut self.state.counters;
        counters.substeps += 1;
        counters.sweeps += u64::from(swept.sweeps);
        counters.sweeps_max = counters.sweeps_max.max(swept.sweeps);
        counters.unsettled += u64::from(swept.unsettled > self.slope.tolerance);
        counters.judged += u64::from(swept.sweeps) * self.scratch.contacts.len() as u64;
        counters.dt_min = if counters.dt_min > 0.0 { counters.dt_min.min(dt) } else { dt };
        counters.dt_max = counters.dt_max.max(dt);
    }
}
