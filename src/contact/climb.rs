//! Lift within a step: while a contact slips its asperities lift it, the lift presses it, and it slips less (Eq. 21).

use super::law::shear_on;
use super::{ContactSetting, Limits, VertexEdge};

/// Trials of a lift at most. The second is exact where spring and friction follow straight lines.
const TRIALS: usize = 8;
/// Rounding of a lift, as a share of the first trial.
const EXACT: f64 = 1e-12;

/// A contact in a sweep before its lift.
#[derive(Debug, Clone, Copy, Default)]
pub struct Slide {
    /// Force (N/m) of the normal spring.
    pub normal: f64,
    /// How it grows with velocity (N·s/m²).
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
    /// Answer of the normal spring, which is linear, when the contact climbs in the step: one that goes down does so
    /// after it.
    pub fn climb(&self, slide: &Slide, limits: &Limits, setting: &ContactSetting) -> f64 {
        let (law, per_lift) = (&setting.laws[self.law], slide.rate / slide.dt);
        let missing = |lift: f64| {
            // One that is open climbs as one does that is just in touch: no sweep jumps between both.
            let normal = (slide.normal + per_lift * lift).max(-limits.tension());
            let [friction, cohesion] = limits.line(normal, self.length);
            let slip = self.slip(slide, shear_on([friction, cohesion], normal));
            let heat = [friction, cohesion].map(|part| part * slip.abs());
            paid(law.rise(self.history.way, slip), heat, [slide.normal, per_lift]) - lift
        };
        let [friction, _] = limits.line(slide.normal, self.length);
        let falls = per_lift * friction * law.dilation * (slide.dt * slide.eased + 1.0 / self.stiffness[1]);
        let touch = (-limits.tension() - slide.normal).max(0.0) / per_lift;
        slide.normal + per_lift * balance(missing, touch, falls)
    }

    /// Slip (m) in a step with this limit of shear (N/m).
    #[inline(always)]
    fn slip(&self, slide: &Slide, limit: f64) -> f64 {
        let shear = slide.stick.clamp(-limit, limit);
        let moved = slide.dt * (slide.speed + slide.eased * (shear - slide.shear));
        self.clamped(self.shear_stored() - self.stiffness[1] * moved, limit).1
    }
}

/// As much of a rise (m) as friction pays for, against a force (N/m) that grows with the lift: its heat is one part per
/// normal force (m), which pays for as much lift, and one beside that (J/m).
#[inline(always)]
fn paid(rise: f64, [free, heat]: [f64; 2], [force, grows]: [f64; 2]) -> f64 {
    let (more, force) = (rise - free, force + grows * free);
    if more <= 0.0 || more * (force + grows * more) <= heat {
        return rise;
    }
    let root = (force * force + 4.0 * grows * heat).sqrt();
    free + if force > 0.0 { 2.0 * heat / (force + root) } else { (root - force) / (2.0 * grows) }
}

/// The lift (m), none or more, that misses nothing. What is `missing` falls by as much as the lift grows until a
/// `touch`, and by 1 + `falls` times as much beyond it, along a straight line.
fn balance(missing: impl Fn(f64) -> f64, touch: f64, falls: f64) -> f64 {
    let first = missing(0.0);
    if first <= 0.0 {
        return 0.0;
    }
    let exact = EXACT * first;
    let mut lift = first - falls * (first - touch).max(0.0) / (1.0 + falls);
    let more = missing(lift);
    if more.abs() <= exact {
        return lift;
    }
    let (mut low, mut high) = ([0.0, first], [lift, more]);
    if more > 0.0 {
        (low, high) = (high, [first, missing(first).min(-exact)]);
    }
    for _ in 2..TRIALS {
        lift = low[0] + (high[0] - low[0]) * low[1] / (low[1] - high[1]);
        let more = missing(lift);
        if more.abs() <= exact {
            break;
        }
        // Illinois: the end that stays counts half.
        if more > 0.0 {
            (low, high[1]) = ([lift, more], 0.5 * high[1]);
        } else {
            (high, low[1]) = ([lift, more], 0.5 * low[1]);
        }
    }
    lift
}
