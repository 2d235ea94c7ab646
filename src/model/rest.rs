//! When a static stage is at rest.

use crate::geometry::polygon;
use crate::state::MostRest;
use crate::step::{Regime, StepReport};

use super::Simulation;

/// Unbalanced ratio at which a static stage that names none ends.
const CONVERGENCE: f64 = 1e-4;
/// Kinetic over potential or strain energy below which a static stage counts as at rest.
const REST: f64 = 1e-8;
/// Displacement, relative to the height of the model, within the time of a fall from it, of rock that is at rest.
const STILL: f64 = 1e-6;

/// Energy (J/m) that a static stage has turned over.
fn energy(report: &StepReport) -> f64 {
    report.ledger.potential.abs().max(report.ledger.strain.abs())
}

impl Simulation {
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

    /// Whether a static stage has converged: ramp over, forces balanced, motion died out. It has also converged when
    /// the rest has been still for the time that it needed, and for the time of waves, and a few blocks
    /// ([`Simulation::mass_of_few`]), which rattle or fall, held more energy meanwhile.
    ///
    /// A stage whose apertures follow openings has not converged before they agree.
    pub fn at_rest(&self, report: &StepReport) -> bool {
        !self.awaits_openings() && self.rock_rests(report)
    }

    /// Whether the rock is at rest, apart from what its openings do to the water.
    pub(super) fn rock_rests(&self, report: &StepReport) -> bool {
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
    pub(super) fn most_rest_with(&self, report: &StepReport) -> Option<MostRest> {
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
}
