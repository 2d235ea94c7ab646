//! Rock that breaks: the worst section of a model is looked for as it moves, and cuts it when it has its strength.

use crate::cover::BlockId;
use crate::fracture::{BreakableBlocks, Search, Watched, watch};
use crate::geometry::Vector;
use crate::recut;
use crate::state::{Breaking, Cut, Event, EventKind, WorstSection};
use crate::step::{self, Failure, Regime, StepError, StepReport, Wanted};

use super::Simulation;

/// Unbalanced ratio of a static stage, and kinetic energy over that of strain, below which the forces on blocks are
/// those of rest within 0.3 %.
const BALANCED: [f64; 2] = [1e-3, 1e-5];
/// Share of its strength from which on a block is looked at in every search, and in every step.
const NEAR: [f64; 2] = [0.3, 0.5];
/// Searches from one look at blocks that are far from their strength to the next.
const SELDOM: u64 = 4;

impl Simulation {
    /// Takes down what the rock carries that is looked at in the next step: in a dynamic stage every few steps, and
    /// blocks near their strength in each; in a static one all rock when a report says whether it is at rest.
    pub(super) fn watch(&self, wanted: Wanted) -> Option<Watched> {
        let breaking = self.model().breaking.as_ref()?;
        if self.workspace.selection.kept_gaps.is_some() {
            return None;
        }
        let breakable = self.breakable.get_or_init(|| BreakableBlocks::new(self.model()));
        let is_static = matches!(self.regime, Regime::Static { .. });
        if is_static && !(wanted == Wanted::Report && self.rest_due()) {
            return None;
        }
        let state = self.state();
        let is_due = |block: BlockId| {
            let share = state.worst_sections[block].share;
            let searches = state.step.is_multiple_of(breaking.every);
            let all = state.step.is_multiple_of(breaking.every * SELDOM);
            is_static || all || share >= NEAR[1] || searches && share >= NEAR[0]
        };
        let can_move = |block: BlockId| !self.workspace.mass_matrix.fixed[block] && !state.removed[block];
        let blocks: Vec<BlockId> = breakable.all().filter(|&block| can_move(block) && is_due(block)).collect();
        (!blocks.is_empty()).then(|| watch(self.model(), state, blocks, self.time()))
    }

    /// Looks for the section that is nearest to its strength, and cuts the rock along it when it has that.
    ///
    /// # Errors
    /// The rock has more parts than the case allows.
    pub(super) fn break_rock(&mut self, watched: &Watched, made: &mut StepReport) -> Result<(), StepError> {
        let model = &self.built.model;
        let (Some(breaking), Some(breakable)) = (&model.breaking, self.breakable.get()) else { return Ok(()) };
        let is_static = matches!(self.regime, Regime::Static { .. });
        let rests = made.unbalanced <= BALANCED[0] && made.kinetic_of_most <= BALANCED[1] * made.ledger.strain;
        if is_static && !rests {
            return Ok(());
        }
        // The state is that of the end of the step.
        let all_wanted = is_static || (self.state.step - 1).is_multiple_of(breaking.every);
        let (state, workspace, regime) = (&self.state, &self.workspace, self.regime);
        let found = Search { model, state, workspace, breakable, regime }.worst(watched, all_wanted);
        let mut failed: Vec<(f64, u32)> = Vec::new();
        for (block, section) in found {
            if section.share >= 1.0 && !section.barred {
                failed.push((section.share, model.labels[block]));
            }
            self.state.worst_sections[block] = section;
        }
        failed.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        for (_, label) in failed {
            if self.cut_block(label)? {
                // What it was at rest with has changed.
                (made.unbalanced, self.state.most_rest) = (1.0, None);
                break;
            }
        }
        Ok(())
    }

    /// Cuts the rock along the worst section of a block; false if the model cannot go on with that cut.
    fn cut_block(&mut self, label: u32) -> Result<bool, StepError> {
        let Some(block) = self.block_labelled(label) else { return Ok(false) };
        let (section, stage) = (self.state.worst_sections[block], self.state.stage);
        self.check_parts(block, &section)?;
        let rock = self.breakable.get().and_then(|breakable| breakable.of(block)).map_or(0, |of| of.outline.rock);
        let WorstSection { share, ends, carries, failure, .. } = section;
        let (step, time) = (self.state.step, self.time());
        let part = self.model().labels.iter().max().map_or(0, |most| most + 1);
        let cut = Cut { ends, stage, step, time, block: label, part, rock, share, carried: carries, failure };
        let cuts = [&self.state.cuts[..], &[cut]].concat();
        let ground = self.ground(stage as usize, &cuts).ok();
        let parts = ground.as_ref().map(|ground| ground.built.model.covers.block_count());
        let Some((ground, lineage)) = ground.and_then(|ground| Some((ground.built, ground.lineage?))) else {
            self.state.worst_sections[block].barred = true;
            return Ok(false);
        };
        if parts == Some(self.model().covers.block_count()) {
            self.state.worst_sections[block].barred = true;
            return Ok(false);
        }
        let before = self.energy_of_rock_and_springs();
        let masses = &self.workspace.mass_matrix;
        let now = (&self.built.model, &self.state);
        self.state = recut::carry_break(&lineage, now, masses, &ground.model, &cut);
        self.stand_on(ground);
        step::prepare(&self.built.model, &self.state, &mut self.workspace);
        let after = self.energy_of_rock_and_springs();
        self.state.ledger.baseline += after[0] - before[0];
        self.state.ledger.fracture += before.iter().sum::<f64>() - after.iter().sum::<f64>();
        let event = Event { kind: EventKind::Cut, subject: label, time, other: part, depth: 0.0 };
        self.state.events.list.push(event);
        self.looks.forget();
        Ok(true)
    }

    /// Refuses a cut that would make more parts than the case allows.
    fn check_parts(&self, block: BlockId, section: &WorstSection) -> Result<(), StepError> {
        let Some(Breaking { parts_max, cuts_max, .. }) = self.model().breaking else { return Ok(()) };
        let cuts = self.state.cuts.len();
        let failure = if cuts >= parts_max {
            Failure::Parts { limit: parts_max, key: "parts_max" }
        } else if cuts >= cuts_max {
            Failure::Parts { limit: cuts_max, key: "cuts_max" }
        } else {
            return Ok(());
        };
        let position = (section.ends[0] + section.ends[1]) * 0.5;
        Err(StepError { block: self.model().labels[block], position, time: self.time(), failure })
    }

    /// Energy (J/m) of the rock, and that of contacts and supports.
    fn energy_of_rock_and_springs(&self) -> [f64; 2] {
        let energies = self.energies();
        let (state, ahead) = self.look_ahead();
        let rock = energies.kinetic + energies.strain + energies.potential;
        [rock, step::stored(self.model(), &state, &ahead)]
    }

    /// A field on the covers of the model that had so many breaks, on those of the model now.
    pub fn after_breaks(&self, known: usize, field: &[Vector]) -> Vec<Vector> {
        let mut field = field.to_vec();
        for count in known..self.state.cuts.len() {
            let cuts = &self.state.cuts[..=count];
            let ground = self.ground(cuts[count].stage as usize, cuts).ok();
            if let Some(lineage) = ground.and_then(|ground| ground.lineage) {
                field = lineage.parents.covers.iter().map(|parent| field[parent.index()]).collect();
            }
        }
        field
    }

    /// This model at this time with the sections cut that have broken in another since, which goes on from it: both
    /// have the same blocks then, and can be compared.
    #[must_use]
    pub fn with_breaks_of(&self, other: &Self) -> Self {
        let mut cut = self.clone();
        cut.looks.forget();
        for count in self.state.cuts.len()..other.state.cuts.len() {
            let cuts = &other.state.cuts[..=count];
            let ground = other.ground(cuts[count].stage as usize, cuts).ok();
            let Some((built, lineage)) = ground.and_then(|ground| Some((ground.built, ground.lineage?))) else { break };
            let before = (&cut.built.model, &cut.state);
            cut.state = recut::carry(&lineage, before, &cut.workspace.mass_matrix, &built.model);
            cut.state.cuts.push(cuts[count]);
            cut.stand_on(built);
            step::prepare(&cut.built.model, &cut.state, &mut cut.workspace);
        }
        cut
    }

    /// Most blocks that the model can have: those of its last stage, and as many parts more as rock may break into.
    pub fn blocks_max(&self) -> usize {
        let parts = self.model().breaking.as_ref().map_or(0, |breaking| breaking.parts_max.min(breaking.cuts_max));
        self.grounds.last().map_or(0, |ground| ground.built.model.covers.block_count()) + parts
    }

    /// Sections of rock that have broken so far.
    pub fn cuts(&self) -> &[Cut] {
        &self.state.cuts
    }
}
