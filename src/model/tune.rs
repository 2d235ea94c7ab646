//! Changes of parameters while a model runs: joint laws, damping, the density of water, bolts.

use crate::contact::{BoltState, LawId};
use crate::geometry::Vector;
use crate::state::{Model, State};

use super::Simulation;

/// A parameter that may change between two steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tunable {
    /// Friction angle of a joint law (rad), the residual one included.
    Friction(LawId),
    /// Cohesion of a joint law (Pa), the residual one included.
    Cohesion(LawId),
    /// Tensile strength of a joint law (Pa).
    Tension(LawId),
    /// Joint roughness coefficient of a joint law.
    Roughness(LawId),
    /// Joint wall compressive strength of a joint law (Pa).
    WallStrength(LawId),
    /// Damping ratio of dynamic stages.
    Damping,
    /// Density of water (kg/m³).
    WaterDensity,
    /// Whether a bolt of the case is installed: 0 or 1.
    Bolt(u32),
}

impl Simulation {
    /// Gives a parameter another value, from the next step on and until a stage of the case changes it.
    pub fn tune(&mut self, what: Tunable, value: f64) {
        self.looks.forget();
        tune(&self.built.model, &mut self.state, what, value);
        self.regime = self.regime_of(self.state.stage as usize);
    }

    /// Gives a state of this model, or of one that differs from it in parameters alone, the parameters that the case
    /// has in its stage, but for `others`.
    pub(crate) fn give_parameters(&self, state: &mut State, others: impl Iterator<Item = (Tunable, f64)>) {
        (state.laws, state.law_switch) = self.laws_in(state.stage);
        (state.damping, state.water_density) = (None, self.model().water_density());
        others.for_each(|(what, value)| tune(self.model(), state, what, value));
    }
}

/// Gives a parameter of a state another value.
fn tune(model: &Model, state: &mut State, what: Tunable, value: f64) {
    state.found.forget();
    match what {
        Tunable::Friction(law) => state.laws[law].set_friction(value),
        Tunable::Cohesion(law) => state.laws[law].set_cohesion(value),
        Tunable::Tension(law) => state.laws[law].tension = value,
        Tunable::Roughness(law) => state.laws[law].roughness.iter_mut().for_each(|r| r.jrc = value),
        Tunable::WallStrength(law) => state.laws[law].roughness.iter_mut().for_each(|r| r.jcs = value),
        Tunable::Damping => state.damping = Some(value),
        Tunable::WaterDensity => state.water_density = value,
        Tunable::Bolt(bolt) => switch_bolt(model, state, bolt, value != 0.0),
    }
}

/// Installs a bolt at its length now, with its pretension, or takes it away; one that is as wanted stays as it is.
fn switch_bolt(model: &Model, state: &mut State, bolt: u32, is_active: bool) {
    let displacement: &[Vector] = &state.displacement;
    for (segment, own) in model.bolts.iter().zip(&mut state.bolts).filter(|(segment, _)| segment.bolt == bolt) {
        let is_gone = segment.blocks.iter().any(|&block| state.removed[block]);
        if !is_active || is_gone {
            *own = BoltState { active: false, force: 0.0, ..*own };
        } else if !own.active {
            let length = segment.span(&model.covers.star_position, displacement).norm();
            *own = segment.install(length);
            state.ledger.bolts.installed += segment.energy(own, length);
        }
    }
}
