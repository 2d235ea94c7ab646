//! The façade that callers hold: a built model that advances stage by stage.

use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

use crate::contact::{DetectionRule, SideId, VertexEdge};
use crate::cover::BlockId;
use crate::fracture::BreakableBlocks;
use crate::geometry::Vector;
use crate::recut;
use crate::state::{Drive, Event, EventKind, Ledger, Model, State, Workspace};
use crate::step::{self, Regime, StepError, StepReport, Wanted};

use super::assemble::{BuildStage, Built, ExplicitAlone, Integrators};
use super::case::{Case, Invalid, Stage};
use super::grounds::{self, Broken, Ground};
use super::looks::Looks;
use super::overlap::{self, Audit, Overlap};

/// Residual of the ledger over its largest term from which a motion has nothing to do with the case.
const RESIDUAL_MAX: f64 = 0.9;
/// Displacement over the mesh size below which nothing has moved, and the ledger holds round-off.
const MOVED_MIN: f64 = 1e-9;

/// A model in time.
#[derive(Debug, Clone)]
pub struct Simulation {
    pub(super) case: Case,
    /// The model of each stage.
    pub(super) grounds: Vec<Ground>,
    /// That of the stage in progress.
    pub(super) built: Arc<Built>,
    pub(super) state: State,
    pub(super) workspace: Workspace,
    pub(super) regime: Regime,
    /// Models of rock that has broken.
    pub(super) broken: Broken,
    /// Blocks of the model that can break, once sections of them are looked for.
    pub(super) breakable: OnceLock<BreakableBlocks>,
    /// Looks of callers since the model last changed.
    pub(super) looks: Looks,
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
        let (grounds, state) = grounds::build(&case, integrators, tell)?;
        let mut simulation = Self {
            case,
            built: grounds[0].built.clone(),
            grounds,
            state,
            workspace: Workspace::default(),
            regime: Regime::Dynamic { damping: 0.0 },
            broken: Broken::default(),
            breakable: OnceLock::new(),
            looks: Looks::default(),
            audit: OnceLock::new(),
        };
        simulation.begin_stage(0, 0.0)?;
        Ok(simulation)
    }

    /// The same with other constants of contact, for studies of what they do.
    #[must_use]
    pub fn with_detection(mut self, rule: DetectionRule) -> Self {
        grounds::change(&mut self.grounds, |built| built.model.detection = rule);
        self.built = self.grounds[self.state.stage as usize].built.clone();
        self.state.found.forget();
        self.looks.forget();
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

    /// The model as built, for a caller who changes the state beside it.
    pub(crate) fn shared_model(&self) -> Arc<Built> {
        self.built.clone()
    }

    /// The state now.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Buffers of the last step: contacts and times.
    pub fn workspace(&self) -> &Workspace {
        &self.workspace
    }

    /// The stage in progress.
    pub fn stage(&self) -> &Stage {
        &self.case.stages[self.state.stage as usize]
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
        self.state.found.forget();
        self.workspace.selection.kept_gaps = Some(Vec::new());
    }

    /// Stops all blocks, as a damper would: the ledger takes their kinetic energy as damped.
    pub fn arrest(&mut self) {
        self.looks.forget();
        let kinetic: f64 = self.model().covers.blocks().map(|b| self.rigid_motion_of(b).3).sum();
        self.state.ledger.damping += kinetic;
        self.state.velocity.fill(Vector::zeros());
    }

    /// Leaves out the contacts of nodes of a block with a side, as often as there are pairs, in later steps. A new
    /// stage or another state ends this.
    pub fn leave_out(&mut self, mut contacts: Vec<(BlockId, SideId)>) {
        contacts.sort_unstable();
        self.workspace.selection.left_out = contacts;
        self.state.neighbours.forget();
        self.state.found.forget();
    }

    /// Inputs of the host, to be changed.
    pub fn drive(&mut self) -> &mut Drive {
        self.looks.report.take();
        &mut self.state.drive
    }

    /// Internal steps that cover `seconds` of simulated time.
    pub fn steps_in(&self, seconds: f64) -> u64 {
        (seconds / self.model().dt - 1e-6).ceil().max(1.0) as u64
    }

    /// Takes a state that this model had before, as from a checkpoint.
    pub fn restore(&mut self, state: State) {
        self.state = state;
        self.take_up();
    }

    /// Takes over another state of this model, as [`Simulation::restore`] does, into the memory of its own.
    pub fn return_to(&mut self, state: &State) {
        self.state.clone_from(state);
        self.take_up();
    }

    /// Gives back the memory of the buffers, which the next step then fills again: outputs need some of their own.
    pub fn drop_buffers(&mut self) {
        let Workspace { serial, seconds, .. } = self.workspace;
        self.workspace = Workspace { serial, seconds, ..Workspace::default() };
        self.take_up();
    }

    /// Makes model, regime and buffers those of the state.
    fn take_up(&mut self) {
        self.looks.forget();
        self.stand_on(self.built_for(&self.state));
        self.regime = self.regime_of(self.state.stage as usize);
        step::prepare(&self.built.model, &self.state, &mut self.workspace);
    }

    /// The model of a state that a simulation of this case has been in, or that [`Simulation::check`] has passed.
    fn built_for(&self, state: &State) -> Arc<Built> {
        let stage = state.stage as usize;
        self.ground(stage, &state.cuts).map_or_else(|_| self.grounds[stage].built.clone(), |ground| ground.built)
    }

    /// Makes a model that of the next step.
    pub(super) fn stand_on(&mut self, built: Arc<Built>) {
        if !Arc::ptr_eq(&built, &self.built) {
            let Workspace { serial, seconds, .. } = self.workspace;
            self.workspace = Workspace { serial, seconds, ..Workspace::default() };
            self.audit = OnceLock::new();
            self.breakable = OnceLock::new();
            self.built = built;
        }
    }

    /// Cuts the rock as a stage that begins does.
    ///
    /// # Errors
    /// A cut that cannot be made through rock that has broken.
    pub(super) fn cut(&mut self, stage: usize) -> Result<(), Invalid> {
        let Ground { built, lineage } = self.ground(stage, &self.state.cuts)?;
        if let Some(lineage) = lineage {
            let before = (&self.built.model, &self.state);
            self.state = recut::carry(&lineage, before, &self.workspace.mass_matrix, &built.model);
            self.stand_on(built);
        }
        Ok(())
    }

    /// The same with the cuts of all later stages, which part blocks and change nothing else, to be looked at: so that
    /// pictures of all stages have the same blocks.
    pub fn cut_ahead(&self) -> Cow<'_, Self> {
        let later = self.state.stage as usize + 1..self.grounds.len();
        if self.grounds[later.clone()].iter().all(|ground| ground.lineage.is_none()) {
            return Cow::Borrowed(self);
        }
        let mut ahead = self.clone();
        ahead.looks.forget();
        for stage in later {
            if ahead.cut(stage).is_err() {
                break;
            }
            step::prepare(&ahead.built.model, &ahead.state, &mut ahead.workspace);
        }
        Cow::Owned(ahead)
    }

    /// Advances one internal step; `report` requests energies and the unbalanced ratio at its start. Every
    /// [`overlap::EVERY`] steps it looks for blocks that overlap.
    ///
    /// # Errors
    /// A numerical failure; the state is then invalid and must be restored.
    pub fn advance(&mut self, report: bool) -> Result<StepReport, StepError> {
        self.advance_for(if report { Wanted::Report } else { Wanted::Nothing })
    }

    /// As [`Simulation::advance`]; the report holds what is `wanted` of the start of the step.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn advance_for(&mut self, wanted: Wanted) -> Result<StepReport, StepError> {
        self.looks.forget();
        self.follow_flow()?;
        let rest = self.state.rest_of_step(&self.built.model);
        let watched = self.watch(wanted);
        let is_due = wanted == Wanted::Report && self.rest_due();
        let is_small = self.workspace.selection.kept_gaps.is_some();
        let audits = self.state().step.is_multiple_of(overlap::EVERY) && !is_small;
        let mut made = step::advance(&self.built.model, self.regime, &mut self.state, &mut self.workspace, wanted)?;
        self.pass_water(rest);
        if is_due {
            self.state.most_rest = self.most_rest_with(&made);
            self.follow_openings(&made)?;
        }
        if audits {
            self.note_overlaps();
        }
        if let Some(watched) = watched {
            self.break_rock(&watched, &mut made)?;
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
        let events = &mut self.state.events;
        for Overlap { depth, blocks, .. } in found {
            events.overlap_max = events.overlap_max.max(depth);
            if let Err(place) = events.overlapped.binary_search(&blocks) {
                events.overlapped.insert(place, blocks);
                let [subject, other] = blocks.map(|block| self.built.model.labels[block]);
                events.list.push(Event { kind: EventKind::Overlapped, subject, time, other, depth });
            }
        }
    }

    /// The blocks for the audit of overlaps.
    pub(super) fn overlap_audit(&self) -> &Audit {
        self.audit.get_or_init(|| Audit::new(self))
    }

    /// Advances `dt` (s), a part of an internal step that ends before the next point of the grid; the report holds what
    /// is `wanted` of its start.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn advance_part(&mut self, dt: f64, wanted: Wanted) -> Result<StepReport, StepError> {
        self.looks.forget();
        self.follow_flow()?;
        let made =
            step::advance_part(&self.built.model, self.regime, &mut self.state, &mut self.workspace, dt, wanted)?;
        self.pass_water(dt);
        Ok(made)
    }

    /// Energies and the unbalanced ratio now, under the inputs of the last step; nothing advances. They are worked out
    /// once for every state, as a step beside the model, and the same bits on any threads.
    pub fn report(&self) -> StepReport {
        self.report_on(self.workspace.serial)
    }

    /// As [`Simulation::report`]; with `serial` on the calling thread alone.
    pub fn report_on(&self, serial: bool) -> StepReport {
        // Not `get_or_init`: a thread of the pool that waits for others may take up work that requests it, too.
        if let Some(report) = self.looks.report.get() {
            return *report;
        }
        let mut state = self.state().clone();
        state.drive.hold_last();
        let report = step::outlook(self.model(), self.regime, state, serial);
        *self.looks.report.get_or_init(|| report)
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

    /// Energies and works (J/m) half an internal step ago, at the time of the velocities. What contacts, supports and
    /// bolts store follows from forces and is not in it.
    pub fn energies_at_velocities(&self) -> Ledger {
        let look = || step::energies_at_velocities(self.model(), self.state(), &self.workspace.mass_matrix);
        *self.looks.energies.get_or_init(look)
    }

    /// Energies (J/m) now beside the works so far: kinetic, strain and potential energy.
    pub fn energies(&self) -> Ledger {
        if self.workspace.mass_matrix.mass.is_empty() {
            return Ledger::default();
        }
        step::energies(self.model(), self.state(), &self.workspace.mass_matrix)
    }

    /// Linear (kg·m/s per metre) and angular momentum (kg·m²/s per metre) about the origin of all free blocks.
    pub fn momentum(&self) -> (Vector, f64) {
        step::momentum(self.model(), self.state(), &self.workspace.mass_matrix)
    }
}
