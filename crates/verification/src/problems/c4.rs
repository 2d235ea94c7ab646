//! C4: Newmark's block under a pulse of its base.

use super::slider::Slider;
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "C4",
    title: "Newmark's block, rectangular pulse",
    source: "A base acceleration that sets in and ends at once: the block slides with constant acceleration, then with \
             constant deceleration; flat, and down an incline. Catches wrong impulses of jumps, inertia forces that \
             change no normal force, and friction that lags",
    parameters: &[
        Parameter::new("gravity", "m/s²", 9.81, [0.1, 100.0], "acceleration of gravity"),
        Parameter::new("pulse", "g", 0.5, [0.05, 0.9], "base acceleration over g"),
        Parameter::new("time", "s", 0.5, [0.05, 1.0], "length of the pulse"),
        Parameter::new("resistance", "g", 0.2, [0.05, 0.6], "friction on the flat base"),
        Parameter::new("a_deg", "°", 20.0, [1.0, 40.0], "dip of the incline"),
        Parameter::new("phi_deg", "°", 30.0, [5.0, 50.0], "friction angle on the incline"),
    ],
    quick: true,
    implicit: true,
    run,
};

/// Speed at the end of the pulse (m/s), slip (m) and time (s) at the stop of a rigid block.
#[derive(Debug, Clone, Copy)]
struct Exact {
    speed: f64,
    slip: f64,
    stop: f64,
}

/// Constant acceleration during the pulse, constant deceleration after it; nothing when it does not start, no end when
/// it does not stop.
fn exact(gravity: f64, pulse: f64, time: f64, friction: f64, dip: f64) -> Exact {
    let (sin, cos) = dip.sin_cos();
    let drive = |a: f64| gravity * (sin + a * cos - friction * (cos - a * sin).max(0.0));
    let (gain, loss) = (drive(pulse).max(0.0), -drive(0.0));
    let speed = gain * time;
    let braking = if speed == 0.0 { 0.0 } else { speed / loss.max(0.0) };
    Exact { speed, slip: 0.5 * speed * (time + braking), stop: time + braking }
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [gravity, pulse, time] = ["gravity", "pulse", "time"].map(|n| setup.get(n));
    let slope_friction = setup.get("phi_deg").to_radians().tan();
    let mut outcome = Outcome::default();
    let variants = [("flat", 0.0, setup.get("resistance")), ("incline", setup.get("a_deg"), slope_friction)];
    for (name, dip, friction) in variants {
        let exact = exact(gravity, pulse, time, friction, f64::to_radians(dip));
        if !exact.stop.is_finite() {
            return Err(Trouble(format!("C4, {name}: the block does not stop: raise the friction above the dip")));
        }
        let duration = (1.1 * exact.stop).max(exact.stop + 0.05);
        let base = [[0.0, -pulse * gravity], [time, -pulse * gravity]];
        let slider =
            Slider { dip, friction, gravity, young: 50e9, base: &base, duration, reach: 1.2 * exact.slip + 0.2 };
        let slide = slider.slide(setup, name)?;
        let speed = slide.path.iter().zip(&slide.speed).find(|(p, _)| p[0] >= time).map_or(0.0, |(_, v)| *v);
        let reason = "Coulomb's limit holds at the end of each step; the rock's own ringing as the drive jumps leaves \
                      an offset of some σ/√(Eρ)";
        outcome.rows.extend([
            Row::new(format!("{name}: speed as the pulse ends"), "m/s", speed, exact.speed)
                .absolute(0.01 * exact.speed + 1e-6, reason),
            Row::new(format!("{name}: slip"), "m", slide.way_at(duration), exact.slip)
                .absolute(0.01 * exact.slip + 1e-6, reason),
            Row::new(format!("{name}: time of the stop"), "s", slide.stop(1e-4 * exact.slip), exact.stop)
                .relative(0.02, "read where the way is within 1e-4 of its end: 1 % of the braking"),
            Row::ledger(&slide.last),
        ]);
        let gain = exact.speed / time;
        let way = |t: f64| {
            let rest = (exact.stop - t).max(0.0);
            let loss = exact.speed / (exact.stop - time).max(f64::MIN_POSITIVE);
            if t < time { 0.5 * gain * t * t } else { exact.slip - 0.5 * loss * rest * rest }
        };
        let points = slide.points();
        outcome.plots.push(
            Plot::new(format!("C4, {name}: slip under a pulse of {pulse} g for {time} s"), ["time (s)", "slip (m)"])
                .line("exact", points.iter().map(|p| [p[0], way(p[0])]).collect())
                .marks("computed", points),
        );
    }
    Ok(outcome)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Flat .5 g for .5 s against .2 g: 0.919687 m, stops at 1.25 s; a = 20°, φ = 30°: 1.805370 m/s, 1.279846 m.
    #[test]
    fn the_published_numbers() {
        let flat = exact(9.81, 0.5, 0.5, 0.2, 0.0);
        assert!((flat.slip - 0.919687).abs() < 1e-6 && (flat.stop - 1.25).abs() < 1e-12);
        let incline = exact(9.81, 0.5, 0.5, 30f64.to_radians().tan(), 20f64.to_radians());
        assert!((incline.speed - 1.805370).abs() < 1e-6 && (incline.slip - 1.279846).abs() < 1e-6, "{incline:?}");
    }
}
