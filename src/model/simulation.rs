//! The façade that callers hold: a built model that advances stage by stage.

use std::sync::OnceLock;

use crate::contact::{BoltState, EntranceRule, JointLaw, LawId, SideId, VertexEdge};
use crate::cover::BlockId;
use crate::geometry::{Point, Vector, polygon};
use crate::state::{Drive, Event, EventKind, Ledger, Model, MostRest, State, Workspace};
use crate::step::{self, Regime, StepError, StepReport};

use super::assemble::{BuildStage, Built, ExplicitAlone, Integrators, build, law_of};
use super::case::{Case, Invalid, Stage, StageKind};
use super::overlap::{self, Audit, Overlap};

/// Unbalanced ratio at which a static stage that names none ends.
const CONVERGENCE: f64 = 1e-4;
/// Kinetic over potential or strain energy below which a static stage counts as at rest.
const REST: f64 = 1e-8;
/// Displacement, relative to the height of the model, within the time of a fall from it, of rock that is at rest.
const STILL: f64 = 1e-6;
/// Residual of the ledger over its largest term from which a motion has nothing to do with the case.
const RESIDUAL_MAX: f64 = 0.9;
/// Displacement over the mesh size below which nothing has moved, and the ledger holds round-off.
const MOVED_MIN: f64 = 1e-9;

/// Energy (J/m) that a static stage has turned over.
fn energy(report: &StepReport) -> f64 {
    report.ledger.potential.abs().max(report.ledger.strain.abs())
}

/// A model in time.
#[derive(Debug, Clone)]
pub struct Simulation {
    case: Case,
    built: Built,
    workspace: Workspace,
    regime: Regime,
    /// The report on the state now, once a caller has requested it: it costs a step.
    report: OnceLock<StepReport>,
    /// The blocks as the audit of overlaps cuts them, once it has had to compare two.
    audit: OnceLock<Audit>,
}

impl Simulation {
    /// Builds the model of a case, which the explicit integrator advances, and begins its first stage.
    ///
    /// # Errors
    /// The first key of the case that does not fit.
    pub fn new(case: Case) -> Result<Self, Invalid> {
        Self::build(case, &mut |_| ())
    }

    /// As [`Simulation::new`]; `tell` is called with every part of the build as it begins.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn build(case: Case, tell: &mut dyn FnMut(BuildStage)) -> Result<Self, Invalid> {
        Self::with_integrators(case, &ExplicitAlone, tell)
    }

    /// As [`Simulation::build`], by one of the integrators given.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn with_integrators(
        case: Case,
        integrators: &dyn Integrators,
        tell: &mut dyn FnMut(BuildStage),
    ) -> Result<Self, Invalid> {
        let built = build(&case, integrators, tell)?;
        let mut simulation = Self {
            case,
            built,
            workspace: Workspace::default(),
            regime: Regime::Dynamic { damping: 0.0 },
            report: OnceLock::new(),
            audit: OnceLock::new(),
        };
        simulation.begin_stage(0, 0.0)?;
        Ok(simulation)
    }

    /// The same with other constants of contact, for studies of what they do.
    #[must_use]
    pub fn with_entrance(mut self, rule: EntranceRule) -> Self {
        self.built.model.entrance = rule;
        self.built.state.found.forget();
        self.report.take();
        self
    }

    /// The case.
    pub fn case(&self) -> &Case {
        &self.case
    }

    /// The model as built.
    pub fn built(&self) -> &Built {
        &self.built
    }

    /// The fixed part of the model.
    pub fn model(&self) -> &Model {
        &self.built.model
    }

    /// The state now.
    pub fn state(&self) -> &State {
        &self.built.state
    }

    /// Buffers of the last step: contacts and times.
    pub fn workspace(&self) -> &Workspace {
        &self.workspace
    }

    /// The stage in progress.
    pub fn stage(&self) -> &Stage {
        &self.case.stages[self.built.state.stage as usize]
    }

    /// Simulated time (s).
    pub fn time(&self) -> f64 {
        let state = self.state();
        state.stage_start + state.stage_step as f64 * self.model().dt + state.part
    }

    /// Whether steps keep to the calling thread.
    pub fn set_serial(&mut self, serial: bool) {
        self.workspace.serial = serial;
    }

    /// Takes the displacements of later steps as small: they change gaps and forces, but the contacts, their normals,
    /// lengths and places stay those of the next step. A new stage or another state ends this.
    pub fn assume_small_displacements(&mut self) {
        self.built.state.found.forget();
        self.workspace.selection.kept_gaps = Some(Vec::new());
    }

    /// Stops all blocks, as a damper would: the ledger takes their kinetic energy as damped.
    pub fn arrest(&mut self) {
        self.report.take();
        let kinetic: f64 = self.model().covers.blocks().map(|b| self.rigid_motion_of(b).3).sum();
        self.built.state.ledger.damping += kinetic;
        self.built.state.velocity.fill(Vector::zeros());
    }

    /// Leaves out the contacts of nodes of a block with a side, as often as there are pairs, in later steps. A new
    /// stage or another state ends this.
    pub fn leave_out(&mut self, mut contacts: Vec<(BlockId, SideId)>) {
        contacts.sort_unstable();
        self.workspace.selection.left_out = contacts;
        self.built.state.neighbours.forget();
        self.built.state.found.forget();
    }

    /// Inputs of the host, to be changed.
    pub fn drive(&mut self) -> &mut Drive {
        self.report.take();
        &mut self.built.state.drive
    }

    /// Internal steps that cover `seconds` of simulated time.
    pub fn steps_in(&self, seconds: f64) -> u64 {
        (seconds / self.model().dt - 1e-6).ceil().max(1.0) as u64
    }

    /// Takes a state that this model had before, as from a checkpoint.
    pub fn restore(&mut self, state: State) {
        self.built.state = state;
        self.take_up();
    }

    /// Takes over another state of this model, as [`Simulation::restore`] does, into the memory of its own.
    pub fn return_to(&mut self, state: &State) {
        self.built.state.copy_from(state);
        self.take_up();
    }

    /// Gives back the memory of the buffers, which the next step then fills again: outputs need some of their own.
    pub fn drop_buffers(&mut self) {
        let Workspace { serial, seconds, .. } = self.workspace;
        self.workspace = Workspace { serial, seconds, ..Workspace::default() };
        self.take_up();
    }

    /// Makes regime and buffers those of the state.
    fn take_up(&mut self) {
        self.report.take();
        self.regime = self.regime_of(self.built.state.stage as usize);
        step::prepare(&self.built.model, &self.built.state, &mut self.workspace);
    }

    /// Begins every later stage without taking a step, and returns: reports what does not fit before the run.
    ///
    /// # Errors
    /// A key of a stage that does not fit the model, whose state is then invalid.
    pub fn validate_stages(&mut self) -> Result<(), Invalid> {
        if self.state().stage as usize + 1 < self.case.stages.len() {
            let now = self.state().clone();
            while self.next_stage()? {}
            self.restore(now);
        }
        Ok(())
    }

    /// Begins the next stage; false when the last one has ended.
    ///
    /// # Errors
    /// A key of the stage that does not fit the model.
    pub fn next_stage(&mut self) -> Result<bool, Invalid> {
        let next = self.built.state.stage as usize + 1;
        if next >= self.case.stages.len() {
            return Ok(false);
        }
        self.begin_stage(next, self.time())?;
        Ok(true)
    }

    /// Advances one internal step; `report` requests energies and the unbalanced ratio at its start. Every
    /// [`overlap::EVERY`] steps it looks for blocks that overlap.
    ///
    /// # Errors
    /// A numerical failure; the state is then invalid and must be restored.
    pub fn advance(&mut self, report: bool) -> Result<StepReport, StepError> {
        self.report.take();
        let is_due = report && self.rest_due();
        let is_small = self.workspace.selection.kept_gaps.is_some();
        let audits = self.state().step.is_multiple_of(overlap::EVERY) && !is_small;
        let made = step::advance(&self.built.model, self.regime, &mut self.built.state, &mut self.workspace, report)?;
        if is_due {
            self.built.state.most_rest = self.most_rest_with(&made);
        }
        if audits {
            self.note_overlaps();
        }
        Ok(made)
    }

    /// Notes pairs of blocks that the step in the buffers has found in each other, each pair once, and how deep.
    fn note_overlaps(&mut self) {
        // Looks at the model as a whole, so the buffer is taken out of it meanwhile.
        let mut suspects = std::mem::take(&mut self.workspace.suspects);
        let found = overlap::find(self, &mut suspects);
        self.workspace.suspects = suspects;
        let time = self.time();
        let events = &mut self.built.state.events;
        for Overlap { depth, blocks, .. } in found {
            events.overlap_max = events.overlap_max.max(depth);
            if let Err(place) = events.overlapped.binary_search(&blocks) {
                events.overlapped.insert(place, blocks);
                let [subject, other] = blocks.map(BlockId::number);
                events.list.push(Event { kind: EventKind::Overlapped, subject, time, other, depth });
            }
        }
    }

    /// The blocks for the audit of overlaps.
    pub(super) fn overlap_audit(&self) -> &Audit {
        self.audit.get_or_init(|| Audit::new(self))
    }

    /// Advances `dt` (s), a part of an internal step that ends before the next point of the grid.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn advance_part(&mut self, dt: f64) -> Result<StepReport, StepError> {
        self.report.take();
        step::advance_part(&self.built.model, self.regime, &mut self.built.state, &mut self.workspace, dt)
    }

    /// Energies and the unbalanced ratio now, under the inputs of the last step; nothing advances. They are worked out
    /// once for every state, as a step beside the model, and the same bits on any threads.
    pub fn report(&self) -> StepReport {
        self.report_on(self.workspace.serial)
    }

    /// As [`Simulation::report`]; with `serial` on the calling thread alone.
    pub fn report_on(&self, serial: bool) -> StepReport {
        // Not `get_or_init`: a thread of the pool that waits for others may take up work that requests it, too.
        if let Some(report) = self.report.get() {
            return *report;
        }
        let mut state = self.state().clone();
        state.drive.hold_last();
        let report = step::outlook(self.model(), self.regime, state, serial);
        *self.report.get_or_init(|| report)
    }

    /// The contacts that the next step will find, with the forces of the last one; nothing advances.
    pub fn contacts(&self) -> Vec<VertexEdge> {
        self.look_ahead().1.contacts
    }

    /// Time (s) by which friction follows the normal force in a dynamic stage that begins with the contacts of
    /// [`Simulation::look_ahead`].
    pub fn friction_delay(&self, ahead: &Workspace) -> f64 {
        step::delay_of(self.model(), &ahead.mass_matrix, &ahead.contacts).time
    }

    /// State and buffers as the next step will have them when it has found its contacts; nothing advances.
    pub fn look_ahead(&self) -> (State, Workspace) {
        self.look_ahead_on(self.workspace.serial)
    }

    /// As [`Simulation::look_ahead`]; with `serial` on the calling thread alone.
    pub fn look_ahead_on(&self, serial: bool) -> (State, Workspace) {
        step::look_ahead(self.model(), self.regime, self.state(), serial)
    }

    /// Shows [`Simulation::contacts`] one by one: all of them together can be larger than the model.
    pub fn each_contact(&self, mut see: impl FnMut(&VertexEdge)) {
        step::each_contact(self.model(), self.regime, self.state(), self.workspace.serial, &mut see);
    }

    /// Whether the stage has covered its duration, or is static and at rest by this report.
    pub fn stage_is_over(&self, report: Option<&StepReport>) -> bool {
        let state = self.state();
        let stage = self.stage();
        state.stage_step >= self.steps_in(stage.duration) || report.is_some_and(|r| self.at_rest(r))
    }

    /// Time (s) over which gravity grows in the static stage in progress, and the unbalanced ratio at which it is at
    /// rest; none in dynamic stages.
    pub fn rest_target(&self) -> Option<(f64, f64)> {
        let Regime::Static { ramp } = self.regime else { return None };
        Some((ramp, self.stage().convergence.unwrap_or(CONVERGENCE)))
    }

    /// Whether a static stage has converged: ramp over, forces balanced, motion died out. A few blocks that rattle or
    /// fall do not hold it up ([`Simulation::mass_of_few`]): it has converged, too, when the motion of all others has
    /// died out for as long as it took to do so, and as waves take to pass, and the few had more energy in that time.
    pub fn at_rest(&self, report: &StepReport) -> bool {
        let start = self.state().stage_start;
        let is_long = |since: f64| report.time - since >= (since - start).max(self.wave_time());
        let for_long = self.state().most_rest.is_some_and(|rest| is_long(rest.since));
        self.all_rests(report) || for_long && self.most_rests(report)
    }

    /// Whether all rock is at rest by a report of a static stage.
    pub(super) fn all_rests(&self, report: &StepReport) -> bool {
        let balanced = self.rest_target().is_some_and(|(_, unbalanced)| report.unbalanced <= unbalanced);
        balanced && self.ramp_is_over(report) && report.ledger.kinetic <= REST * energy(report)
    }

    /// Whether the motion of all but a few blocks has died out by a report of a static stage, and these few have had
    /// more kinetic energy than all others since it did so.
    pub(super) fn most_rests(&self, report: &StepReport) -> bool {
        self.state().most_rest.is_some() && self.most_is_still(report)
    }

    /// How long all but a few blocks have been at rest with this report, which is the last one: none if they still
    /// move, or have had more kinetic energy than the few. Sums decide and not this report alone, because a grain that
    /// rattles shakes its neighbours, and lends them its energy and takes it back in each of its swings.
    fn most_rest_with(&self, report: &StepReport) -> Option<MostRest> {
        let MostRest { since, kinetic } =
            self.state().most_rest.unwrap_or(MostRest { since: report.time, kinetic: [0.0; 2] });
        let most = report.kinetic_of_most;
        let few = (report.ledger.kinetic - most).max(0.0);
        let kinetic = [kinetic[0] + few, kinetic[1] + most];
        (kinetic[0] > kinetic[1] && self.most_is_still(report)).then_some(MostRest { since, kinetic })
    }

    /// Whether the motion of all but a few blocks has died out, or is so slow that they would move by [`STILL`] of the
    /// height in the time of a fall from there.
    fn most_is_still(&self, report: &StepReport) -> bool {
        let (low, high) = polygon::bounds(&self.model().covers.star_position);
        let mass: f64 = self.model().mass_matrix.total.iter().sum();
        let still = 0.5 * mass * STILL * STILL * self.model().gravity.norm() * (high - low).y;
        self.ramp_is_over(report) && report.kinetic_of_most <= still.max(REST * energy(report))
    }

    fn ramp_is_over(&self, report: &StepReport) -> bool {
        self.rest_target().is_some_and(|(ramp, _)| report.time >= self.state().stage_start + 1.5 * ramp)
    }

    /// Why a motion with this ledger is worthless, when energy has come from nowhere.
    pub fn doubt(&self, ledger: &Ledger) -> Option<String> {
        let residual = ledger.residual_relative();
        let moved = MOVED_MIN * self.model().covers.mesh.size;
        let has_moved = self.state().displacement.iter().any(|u| u.norm() > moved);
        (has_moved && residual.abs() >= RESIDUAL_MAX).then(|| {
            format!(
                "the energy residual is {residual:.2} of the largest term, at most {RESIDUAL_MAX} can be borne: the \
                 motion is an artefact of too few or too large steps; check units of rock and loads, lower \
                 solver.dt_safety, or refine mesh.size"
            )
        })
    }

    fn regime_of(&self, stage: usize) -> Regime {
        let stage_case = &self.case.stages[stage];
        match stage_case.kind {
            StageKind::Dynamic => Regime::Dynamic { damping: stage_case.damping_ratio() },
            StageKind::Static => {
                let default = if stage == 0 { self.default_ramp() } else { 0.0 };
                Regime::Static { ramp: stage_case.ramp.unwrap_or(default) }
            }
        }
    }

    /// The time of waves; none under in-situ stress.
    fn default_ramp(&self) -> f64 {
        if self.case.in_situ.is_some() { 0.0 } else { self.wave_time() }
    }

    /// Four times the way of a shear wave through the height of the model (s).
    fn wave_time(&self) -> f64 {
        let (low, high) = polygon::bounds(&self.model().covers.star_position);
        let slowest = self.model().rocks.iter().map(|r| r.shear_wave_speed()).fold(f64::INFINITY, f64::min);
        4.0 * (high - low).y / slowest
    }

    fn begin_stage(&mut self, stage: usize, start: f64) -> Result<(), Invalid> {
        self.report.take();
        let before = self.energies();
        self.excavate(stage)?;
        change_laws(&self.case, stage, &mut self.built.state.laws, &mut self.built.state.law_switch);
        self.change_fixities(stage);
        self.change_bolts(stage)?;
        self.change_water(stage);
        let at_rest = stage == 0 || matches!(self.regime, Regime::Static { .. });
        self.regime = self.regime_of(stage);
        let (model, state) = (&self.built.model, &mut self.built.state);
        step::begin_stage(model, self.regime, state, stage as u32, start, at_rest);
        step::prepare(model, state, &mut self.workspace);
        let after = self.energies();
        let sum = |l: &Ledger| l.kinetic + l.strain + l.potential;
        let ledger = &mut self.built.state.ledger;
        ledger.baseline += if stage == 0 { sum(&after) } else { sum(&after) - sum(&before) };
        Ok(())
    }

    /// Energies (J/m) now beside the works so far: kinetic, strain and potential energy.
    pub fn energies(&self) -> Ledger {
        if self.workspace.mass_matrix.mass.is_empty() {
            return Ledger::default();
        }
        step::energies(self.model(), self.state(), &self.workspace.mass_matrix)
    }

    fn excavate(&mut self, stage: usize) -> Result<(), Invalid> {
        let covers = &self.built.model.covers;
        let stage_case = &self.case.stages[stage];
        for (k, &point) in stage_case.excavate.iter().enumerate() {
            let element = covers.element_near(Point::from(point), self.built.noding.tolerance);
            let block = element.map(|e| covers.element_block[e]).ok_or_else(|| Invalid {
                key: format!("stage[{stage}].excavate[{k}]"),
                message: format!("there is no block at ({}, {}): choose a point inside one", point[0], point[1]),
            })?;
            self.built.state.removed[block] = true;
        }
        if let Some(region) = &stage_case.excavate_region {
            let region: Vec<Point> = region.iter().map(|p| Point::from(*p)).collect();
            let inside = |b: &BlockId| polygon::contains(&region, covers.block_centroid(*b));
            let blocks: Vec<BlockId> = covers.blocks().filter(inside).collect();
            if blocks.is_empty() {
                return Err(Invalid {
                    key: format!("stage[{stage}].excavate_region"),
                    message: "the region holds no block's centroid: enlarge it".into(),
                });
            }
            blocks.into_iter().for_each(|b| self.built.state.removed[b] = true);
        }
        Ok(())
    }

    /// Laws and their switches as the stages of the case up to one make them.
    pub(super) fn laws_in(&self, stage: u32) -> (Vec<JointLaw>, Vec<LawId>) {
        let mut laws = self.model().laws.clone();
        let mut switch: Vec<LawId> = LawId::all(laws.len()).collect();
        (0..=stage as usize).for_each(|stage| change_laws(&self.case, stage, &mut laws, &mut switch));
        (laws, switch)
    }

    fn change_water(&mut self, stage: usize) {
        let Some(water) = self.built.model.water.as_ref().filter(|_| self.case.stages[stage].water.is_some()) else {
            return;
        };
        let (level, drive) = (water.surfaces[stage].level, &mut self.built.state.drive);
        (drive.from.water_level, drive.to.water_level) = (level, level);
    }

    fn change_fixities(&mut self, stage: usize) {
        let stage_case = &self.case.stages[stage];
        let (model, state) = (&self.built.model, &mut self.built.state);
        for (k, fixity) in model.fixities.iter().enumerate() {
            let Some(name) = &fixity.name else { continue };
            if stage_case.free.contains(name) {
                state.fix_active[k] = false;
            }
            if stage_case.fix.contains(name) && !state.fix_active[k] {
                state.fix_active[k] = true;
                for (s, support) in model.supports.iter().enumerate().filter(|(_, s)| s.fix == k as u32) {
                    state.support_rest[s] = support.sample(&state.displacement);
                    state.support_force[s] = support.preload;
                }
            }
        }
    }

    /// Installs the bolts of a stage, and those of the start in the first one; bars in blocks that are gone go as well.
    fn change_bolts(&mut self, stage: usize) -> Result<(), Invalid> {
        let (model, state) = (&self.built.model, &mut self.built.state);
        let install = &self.case.stages[stage].install;
        for (segment, bolt) in model.bolts.iter().zip(&mut state.bolts) {
            let name = self.case.bolts[segment.bolt as usize].name.as_ref();
            let position = install.iter().position(|wanted| Some(wanted) == name);
            let gone = segment.blocks.iter().any(|&b| state.removed[b]);
            if let (Some(k), true) = (position, gone) {
                let message =
                    format!("an end of bolt {:?} is in a block that has been removed: leave it out", install[k]);
                return Err(Invalid { key: format!("stage[{stage}].install[{k}]"), message });
            }
            if gone {
                *bolt = BoltState { active: false, force: 0.0, ..*bolt };
            } else if position.is_some() || stage == 0 && segment.active {
                let length = segment.span(&model.covers.star_position, &state.displacement).norm();
                *bolt = segment.install(length);
                state.ledger.bolts.installed += segment.energy(bolt, length);
            }
        }
        Ok(())
    }

    /// Displacement and velocity of a monitor.
    pub fn monitor(&self, k: usize) -> (Vector, Vector) {
        let (element, point) = self.built.monitors[k];
        let model = self.model();
        let sample = |field: &[Vector]| model.sample(element, point, field);
        (sample(&self.state().displacement), sample(&self.state().velocity))
    }

    /// Linear (kg·m/s per metre) and angular momentum (kg·m²/s per metre) about the origin of all free blocks.
    pub fn momentum(&self) -> (Vector, f64) {
        step::momentum(self.model(), self.state(), &self.workspace.mass_matrix)
    }
}

/// Changes and switches the laws as a stage of the case says.
fn change_laws(case: &Case, stage: usize, laws: &mut [JointLaw], switch: &mut [LawId]) {
    let stage_case = &case.stages[stage];
    for change in &stage_case.law_changes {
        let Some(k) = law_of(case, &change.law) else { continue };
        let law = &mut laws[k];
        if let Some(degrees) = change.friction_deg {
            law.friction = libm::tan(degrees.to_radians());
            law.residual_friction = law.friction;
            if let Some(roughness) = &mut law.roughness {
                roughness.angle = degrees.to_radians();
            }
        }
        if let Some(cohesion) = change.cohesion {
            (law.cohesion, law.residual_cohesion) = (cohesion, cohesion);
        }
        if let Some(tension) = change.tension {
            law.tension = tension;
        }
    }
    for names in &stage_case.law_switches {
        let find = |name: &str| law_of(case, name);
        let (Some(from), Some(to)) = (find(&names.from), find(&names.to)) else { continue };
        switch.iter_mut().filter(|law| **law == from).for_each(|law| *law = to);
    }
}
