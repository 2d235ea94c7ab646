//! Lift within a step: while a contact slips its asperities lift it, the lift presses it, and it slips less (Eq. 21).

use super::{ContactSetting, VertexEdge};

/// Trials of a lift at most. The second is exact where spring and friction follow straight lines.
const TRIALS: usize = 8;
/// Rounding of a lift, as a share of the first trial.
const EXACT: f64 = 1e-12;

/// A contact in a sweep before its lift.
#[derive(Debug, Clone, Copy)]
pub struct Slide {
    /// Answer of the normal spring: force (N/m), or the closure (m) that determines it.
    pub normal: f64,
    /// How the answer grows with its force, of a spring that follows a curve (m²/N).
    pub kept: f64,
    /// How the answer grows with velocity (per m/s).
    pub rate: f64,
    /// Shear force (N/m) that it would have if it did not slip.
    pub stick: f64,
    /// Shear force (N/m) so far.
    pub shear: f64,
    /// Velocity (m/s) along the edge with which its points then move.
    pub speed: f64,
    /// Velocity (m/s) that a shear force adds in the step, per N/m.
    pub eased: f64,
    /// Step (s).
    pub dt: f64,
}

impl VertexEdge {
    /// Answer of the normal spring when the contact climbs in the step: one that goes down does so after it.
    pub fn climb(&self, slide: &Slide, setting: &ContactSetting) -> f64 {
        let (law, limits, closure) = (&setting.laws[self.law], self.limits(setting), self.closure(setting));
        let lifted = |lift: f64| slide.normal + slide.rate / slide.dt * lift;
        let rise = |lift: f64| {
            let normal = closure.force(lifted(lift), slide.kept);
            // One that is open without lift climbs as one does that is just in touch: no sweep jumps between both.
            let limit = limits.shear(normal.max(-limits.tension()), self.length);
            let slip = self.slip(slide, limit);
            let rise = law.rise(self.history.way, slip);
            // Friction pays for the lift.
            if normal > 0.0 { rise.min(limit * slip.abs() / normal) } else { rise }
        };
        lifted(balance(rise))
    }

    /// Slip (m) in a step with this limit of shear (N/m).
    #[inline(always)]
    fn slip(&self, slide: &Slide, limit: f64) -> f64 {
        let shear = slide.stick.clamp(-limit, limit);
        let moved = slide.dt * (slide.speed + slide.eased * (shear - slide.shear));
        self.clamped(self.shear_stored() - self.stiffness[1] * moved, limit).1
    }
}

/// The lift (m) that raises by itself, between none and what raises without lift: `rise` falls with the lift.
fn balance(rise: impl Fn(f64) -> f64) -> f64 {
    let first = rise(0.0);
    if first <= 0.0 {
        return 0.0;
    }
    let (mut low, mut high) = ([0.0, first], [first, rise(first) - first]);
    let mut lift = first;
    for _ in 1..TRIALS {
        lift = low[0] + (high[0] - low[0]) * low[1] / (low[1] - high[1]);
        let missing = rise(lift) - lift;
        if missing.abs() <= EXACT * first {
            break;
        }
        // Illinois: the end that stays counts half.
        if missing > 0.0 {
            (low, high[1]) = ([lift, missing], 0.5 * high[1]);
        } else {
            (high, low[1]) = ([lift, missing], 0.5 * low[1]);
        }
    }
    lift
}
