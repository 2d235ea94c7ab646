//! Changes at the start of a stage: blocks that are dug away, laws, supports, bolts, water.

use crate::contact::{BoltState, JointLaw, LawId};
use crate::cover::BlockId;
use crate::geometry::{Point, polygon};
use crate::state::{Drive, Ledger};
use crate::step::{self, Regime};

use super::Simulation;
use super::assemble::law_of;
use super::case::{Case, Invalid, StageKind};

impl Simulation {
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
        let next = self.state.stage as usize + 1;
        if next >= self.case.stages.len() {
            return Ok(false);
        }
        self.begin_stage(next, self.time())?;
        Ok(true)
    }

    pub(super) fn regime_of(&self, stage: usize) -> Regime {
        let stage_case = &self.case.stages[stage];
        match stage_case.kind {
            StageKind::Dynamic => {
                let damping = self.state.damping.unwrap_or_else(|| stage_case.damping_ratio());
                Regime::Dynamic { damping }
            }
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
    pub(super) fn wave_time(&self) -> f64 {
        let (low, high) = polygon::bounds(&self.model().covers.star_position);
        let slowest = self.model().rocks.iter().map(|r| r.shear_wave_speed()).fold(f64::INFINITY, f64::min);
        4.0 * (high - low).y / slowest
    }

    pub(super) fn begin_stage(&mut self, stage: usize, start: f64) -> Result<(), Invalid> {
        self.looks.forget();
        let before = self.energies();
        self.cut(stage)?;
        self.excavate(stage)?;
        change_laws(&self.case, stage, &mut self.state.laws, &mut self.state.law_switch);
        self.change_fixities(stage);
        self.change_bolts(stage)?;
        self.change_water(stage);
        self.change_flow(stage);
        // Dynamic stages hold the pressures of before, or find them in their first step.
        if stage == 0 || self.case.stages[stage].kind == StageKind::Static {
            self.find_flow(stage, start)?;
        }
        let at_rest = stage == 0 || matches!(self.regime, Regime::Static { .. });
        self.regime = self.regime_of(stage);
        let (model, state) = (&self.built.model, &mut self.state);
        if self.case.since_stage() == Some(stage) {
            state.since.clone_from(&state.displacement);
        }
        step::begin_stage(model, self.regime, state, stage as u32, start, at_rest);
        step::prepare(model, state, &mut self.workspace);
        let after = self.energies();
        let sum = |l: &Ledger| l.kinetic + l.strain + l.potential;
        let ledger = &mut self.state.ledger;
        ledger.baseline += if stage == 0 { sum(&after) } else { sum(&after) - sum(&before) };
        Ok(())
    }

    fn excavate(&mut self, stage: usize) -> Result<(), Invalid> {
        let built = self.built.clone();
        let covers = &built.model.covers;
        let stage_case = &self.case.stages[stage];
        for (k, &point) in stage_case.excavate.iter().enumerate() {
            let element = covers.element_near(Point::from(point), self.built.noding.tolerance);
            let block = element.map(|e| covers.element_block[e]).ok_or_else(|| Invalid {
                key: format!("stage[{stage}].excavate[{k}]"),
                message: format!("there is no block at ({}, {}): choose a point inside one", point[0], point[1]),
            })?;
            self.state.removed[block] = true;
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
            blocks.into_iter().for_each(|b| self.state.removed[b] = true);
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
        let (level, drive) = (water.surfaces[stage].level, &mut self.state.drive);
        (drive.from.water_level, drive.to.water_level) = (level, level);
    }

    /// Heads, rain and drains that a stage sets.
    fn change_flow(&mut self, stage: usize) {
        let Some(net) = &self.built.model.flow else { return };
        let (brought, Drive { from, to, .. }) = (&self.case.stages[stage], &mut self.state.drive);
        for (k, head) in net.heads.iter().enumerate().filter(|(_, head)| brought.heads.contains_key(&head.name)) {
            (from.head[k], to.head[k]) = (head.levels[stage], head.levels[stage]);
        }
        for (k, rain) in net.rains.iter().enumerate().filter(|(_, rain)| brought.rain.contains_key(&rain.name)) {
            (from.rain[k], to.rain[k]) = (rain.rates[stage], rain.rates[stage]);
        }
        for (k, _) in net.drains.iter().enumerate().filter(|(_, drain)| brought.drain.contains(&drain.name)) {
            (from.drain[k], to.drain[k]) = (true, true);
        }
    }

    fn change_fixities(&mut self, stage: usize) {
        let stage_case = &self.case.stages[stage];
        let (model, state) = (&self.built.model, &mut self.state);
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
        let (model, state) = (&self.built.model, &mut self.state);
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
}

/// Changes and switches the laws as a stage of the case says.
fn change_laws(case: &Case, stage: usize, laws: &mut [JointLaw], switch: &mut [LawId]) {
    let stage_case = &case.stages[stage];
    for change in &stage_case.law_changes {
        let Some(k) = law_of(case, &change.law) else { continue };
        let law = &mut laws[k];
        if let Some(degrees) = change.friction_deg {
            law.set_friction(degrees.to_radians());
        }
        if let Some(cohesion) = change.cohesion {
            law.set_cohesion(cohesion);
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
