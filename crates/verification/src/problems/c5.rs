//! C5: Newmark's block under a sine.

use std::f64::consts::PI;

use super::newmark::{Sliding, way_at};
use super::slider::Slider;
use super::strip::rows;
use crate::{Origin, Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "C5",
    title: "Newmark's block, harmonic base",
    source: "A rigid block on a plane whose base shakes with a0·sin(2πft): its slip by fine integration of the sliding \
             block; two inclines on which it slides down, and a flat base on which it slides both ways. Catches slip \
             that starts or stops late, normal forces without the base's part, and drift",
    parameters: &[
        Parameter::new("gravity", "m/s²", 9.81, [0.1, 100.0], "acceleration of gravity"),
        Parameter::new("a_deg", "°", 20.0, [0.0, 40.0], "dip, first incline"),
        Parameter::new("phi_deg", "°", 30.0, [5.0, 50.0], "friction, both inclines"),
        Parameter::new("a0", "g", 0.5, [0.05, 0.9], "amplitude, first incline"),
        Parameter::new("f", "Hz", 2.0, [0.2, 20.0], "frequency, first incline"),
        Parameter::new("a2_deg", "°", 22.6, [0.0, 40.0], "dip, second incline"),
        Parameter::new("a02", "g", 0.28, [0.05, 0.9], "amplitude, second incline"),
        Parameter::new("f2", "Hz", 2.66, [0.2, 20.0], "frequency, second incline"),
        Parameter::new("mu", "", 0.3, [0.05, 0.8], "friction coefficient, flat"),
        Parameter::new("a03", "g", 0.5, [0.05, 0.9], "amplitude, flat"),
        Parameter::new("f3", "Hz", 1.0, [0.2, 20.0], "frequency, flat"),
        Parameter::new("cycles", "", 5.0, [1.0, 20.0], "cycles on the inclines"),
    ],
    quick: true,
    implicit: true,
    run,
};

/// Step of the fine integration over the period.
const FINE: f64 = 1e-4;
/// Rows of the base's table in a cycle: the line between them errs by (2π/n)²/8 = 3e-5 of the amplitude.
const ROWS: f64 = 400.0;

/// One variant: its dip, friction and shaking.
struct Shake {
    name: &'static str,
    dip: f64,
    friction: f64,
    peak: f64,
    frequency: f64,
    cycles: f64,
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let get = |name: &str| setup.get(name);
    let friction = get("phi_deg").to_radians().tan();
    let cycles = if setup.quick { get("cycles").min(2.0) } else { get("cycles") }.floor();
    let shake = |name, dip, friction, peak, frequency, cycles| Shake { name, dip, friction, peak, frequency, cycles };
    let shakes = [
        shake("first incline", get("a_deg"), friction, get("a0"), get("f"), cycles),
        shake("second incline", get("a2_deg"), friction, get("a02"), get("f2"), cycles),
        shake("flat", 0.0, get("mu"), get("a03"), get("f3"), 2.0),
    ];
    let mut outcome = Outcome::default();
    for shake in shakes {
        shake.solve(setup, &mut outcome)?;
    }
    Ok(outcome)
}

impl Shake {
    fn solve(&self, setup: &mut Setup, outcome: &mut Outcome) -> Result<(), Trouble> {
        let Self { name, dip, friction, peak, frequency, cycles } = *self;
        let (gravity, period) = (setup.get("gravity"), 1.0 / frequency);
        let push = |t: f64| peak * gravity * (2.0 * PI * frequency * t).sin();
        let dt = FINE * period;
        let rigid = Sliding { gravity, dip: dip.to_radians(), friction, push };
        let path = rigid.slip(dt, cycles * period);
        let most = path.iter().map(|s| s.way.abs()).fold(0.0, f64::max);
        let base = rows(cycles * period, (ROWS * cycles) as usize, |t| -push(t));
        let duration = cycles * period;
        let slider = Slider { dip, friction, gravity, young: 50e9, base: &base, duration, reach: 1.2 * most + 0.2 };
        let slide = slider.slide(setup, name)?;
        let origin = Origin::Numerical("rigid sliding block, Simpson's rule with a step of 1e-4 of the period");
        let reason = "2 % asked; the block stops and starts within a step or two of the rigid one";
        let start = path.iter().find(|s| s.way.abs() > 1e-3 * most).map_or(0.0, |s| s.time);
        let found = slide.path.iter().find(|p| p[1].abs() > 1e-3 * most).map_or(0.0, |p| p[0]);
        let mut rows = vec![("time at 1/1000 of the greatest slip".to_string(), "s", found, start, 0.02)];
        let marks: Vec<f64> = (1..=cycles as u32).map(|k| f64::from(k) * period).collect();
        for (k, t) in marks.iter().enumerate() {
            let exact = way_at(&path, dt, *t);
            rows.push((format!("slip after cycle {}", k + 1), "m", slide.way_at(*t), exact, 0.02));
        }
        if dip == 0.0 {
            let found = slide.path.iter().map(|p| p[1]).fold(0.0, f64::max);
            let exact = path.iter().map(|s| s.way).fold(0.0, f64::max);
            rows.push(("first slip".to_string(), "m", found, exact, 0.02));
        }
        outcome.rows.extend(rows.into_iter().map(|(quantity, unit, computed, exact, share)| {
            let row = Row::new(format!("{name}: {quantity}"), unit, computed, exact).from(origin);
            row.absolute(share * exact.abs() + 1e-6, reason)
        }));
        outcome.rows.push(Row::ledger(&slide.last));
        let every = (path.len() / 300).max(1);
        let line = path.iter().step_by(every).map(|s| [s.time, s.way]).collect();
        let plot = Plot::new(format!("C5, {name}: slip under {peak} g at {frequency} Hz"), ["time (s)", "slip (m)"]);
        outcome.plots.push(plot.line("rigid block", line).marks("computed", slide.points()));
        Ok(())
    }
}
