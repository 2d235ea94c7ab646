//! C7: a block that rocks.

use enmm::model::Simulation;

use super::block::{Block, Fate, G, advance, bisect};
use crate::{Origin, Outcome, Parameter, Plot, Problem, Row, Setup, Tolerance, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "C7",
    title: "Rocking block",
    source: "Block b × h on a level base. Under a lasting horizontal acceleration ah it lifts off and tips over from \
             ah/g = b/h on. Released at a tilt θ0 below the critical one α = atan(b/h) it rocks back: ½·θ'² = \
             p²·(cos(α − θ0) − cos(α − θ)), p² = 3g/(4R), R = ½·√(b² + h²), and reaches its base after a quarter of \
             the period. Housner (1963) linearises this for slender blocks: T = 4/p·arcosh(1/(1 − θ0/α)), and gives \
             the spin after the impact over that before as 1 − 1.5·sin²α. Catches corners that stick, wrong inertia, \
             impacts that bounce.",
    parameters: &[
        Parameter::new("b", "m", 0.2, [0.02, 5.0], "width of the block; at most 0.5·h"),
        Parameter::new("h", "m", 1.0, [0.1, 50.0], "height of the block"),
        Parameter::new("tilt", "", 0.5, [0.1, 0.9], "tilt at release over the critical"),
        Parameter::new("phi_deg", "°", 60.0, [40.0, 80.0], "friction angle; no slip"),
        Parameter::new("stiffness", "", 1e7, [3e6, 1e9], "Young's modulus over ρ·g·h"),
        Parameter::new("mesh", "", 0.8, [0.15, 1.5], "side of the mesh over the height"),
    ],
    quick: true,
    implicit: true,
    run,
};

/// Time (in √(h/g)) over which gravity grows.
const RAMP: f64 = 0.05;
/// Turn (in the critical angle) from which a block counts as tipping over.
const TIPS: f64 = 0.05;

/// Rocking as Housner describes it.
#[derive(Clone, Copy, Debug)]
struct Rocking {
    /// Critical angle (rad).
    critical: f64,
    /// p² (1/s²).
    rate: f64,
}

impl Rocking {
    fn new(b: f64, h: f64) -> Self {
        Self { critical: (b / h).atan(), rate: 1.5 * G / b.hypot(h) }
    }

    /// Period (s) by the linearised equation.
    fn housner(&self, tilt: f64) -> f64 {
        4.0 / self.rate.sqrt() * (1.0 / (1.0 - tilt / self.critical)).acosh()
    }

    /// Four times the time (s) from the release at `tilt` (rad) to the base: the integral of 1/θ' with θ = θ0·(1 − s²),
    /// which takes the pole at θ0 away.
    fn period(&self, tilt: f64) -> f64 {
        let count = 2000;
        let slice = |i: i32| {
            let s = (f64::from(i) + 0.5) / f64::from(count);
            // cos(α − θ0) − cos(α − θ) as a product, without cancellation.
            let [sum, difference] = [2.0 * self.critical - tilt * (2.0 - s * s), tilt * s * s];
            let half_square = self.rate * 2.0 * (0.5 * sum).sin() * (0.5 * difference).sin();
            2.0 * tilt * s / (2.0 * half_square).sqrt()
        };
        4.0 * (0..count).map(slice).sum::<f64>() / f64::from(count)
    }

    /// Spin after the impact over that before.
    fn restitution(&self) -> f64 {
        1.0 - 1.5 * self.critical.sin().powi(2)
    }
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [b, h] = ["b", "h"].map(|name| setup.get(name));
    if b > 0.5 * h {
        return Err(Trouble(format!("C7: b is {b}, must be at most half of h = {h}: wider blocks hardly rock")));
    }
    let uplift = uplift(setup)?;
    let reason = "a block is seen to tip when it has turned by 0.05·α in the time allowed: from 1 + 0.05/(cosh pt − 1) \
                  times the limit on, pt = 4.5";
    let mut rows = vec![Row::new("horizontal acceleration of uplift, ah/g", "", uplift, b / h).relative(5e-3, reason)];
    let (rocking, plot) = rocking(setup)?;
    rows.extend(rocking);
    Ok(Outcome { rows, plots: vec![plot] })
}

fn block(setup: &Setup) -> Block {
    let [b, h, friction_deg] = ["b", "h", "phi_deg"].map(|name| setup.get(name));
    Block { friction_deg, ..Block::level(setup, [b, h], RAMP) }
}

/// The horizontal acceleration (in g) from which on the block tips, by bisection.
fn uplift(setup: &mut Setup) -> Result<f64, Trouble> {
    let block = block(setup);
    let shape = Rocking::new(block.base, block.height);
    let time = 4.5 / shape.rate.sqrt();
    let slender = block.base / block.height;
    let width = if setup.quick { 4e-3 } else { 1e-3 };
    bisect([0.5 * slender, 2.0 * slender], width * slender, |share| {
        let block = Block { horizontal: share * G, ..block };
        let mut simulation = block.build(setup, &format!("uplift_{share:.5}"), 2.0 * time)?;
        let tips = |s: &Simulation| block.fate(s).turned > TIPS * shape.critical;
        advance(&mut simulation, time, tips)?;
        Ok(!tips(&simulation))
    })
}

/// Time (s) and tilt (rad) from the release on, and what the impact was like.
struct Swing {
    /// Tilt over time.
    path: Vec<[f64; 2]>,
    /// Time of the first impact (s).
    impact: f64,
    /// Spin after the impact over that before.
    restitution: f64,
    ledger: Row,
}

fn swing(setup: &mut Setup, tilt: f64, period: f64) -> Result<Swing, Trouble> {
    let block = Block { tilt, ..block(setup) };
    let mut simulation = block.build(setup, "release", 2.0 * period)?;
    let mut path = vec![[0.0, tilt]];
    let (mut last, mut before) = (Fate::default(), None);
    // The corner in the air comes down to the base level when the block has turned back by the tilt.
    let mut note = |simulation: &Simulation| {
        let fate = block.fate(simulation);
        if before.is_none() && fate.turned <= -tilt {
            let share = (last.turned + tilt) / (last.turned - fate.turned);
            before = Some((last.time + share * (fate.time - last.time), last.spin));
        }
        if fate.time - path.last().map_or(0.0, |p| p[0]) > 0.01 * period {
            path.push([fate.time, tilt + fate.turned]);
        }
        last = fate;
        false
    };
    advance(&mut simulation, 0.45 * period, &mut note)?;
    let (impact, spin) = before.ok_or_else(|| Trouble(format!("C7: the block has not come down by {period} s")))?;
    let after = block.fate(&simulation);
    // The spin just after the impact, from that at 0.45 of the period: ½·θ'² + p²·cos(α − |θ|) is kept.
    let shape = Rocking::new(block.base, block.height);
    let away = (after.turned + tilt).abs();
    let lift = shape.rate * ((shape.critical - away).cos() - shape.critical.cos());
    let just_after = (after.spin.powi(2) + 2.0 * lift).sqrt();
    Ok(Swing { path, impact, restitution: just_after / spin.abs(), ledger: Row::ledger(&simulation.report()) })
}

fn rocking(setup: &mut Setup) -> Result<(Vec<Row>, Plot), Trouble> {
    let block = block(setup);
    let shape = Rocking::new(block.base, block.height);
    let tilt = setup.get("tilt") * shape.critical;
    let (exact, housner) = (shape.period(tilt), shape.housner(tilt));
    let Swing { path, impact, restitution, ledger } = swing(setup, tilt, exact)?;
    // Under a force that grows over a short time a body is half of that time late.
    let computed = 4.0 * (impact - 0.5 * block.ramp);
    let rows = vec![
        Row::new("period, four times the way down", "s", computed, exact).relative(
            5e-3,
            "the elastic corner takes part of the start; half the time of growing gravity is \
             taken off, exact to its square",
        ),
        Row::new("the same beside Housner's linearised period", "s", computed, housner)
            .from(Origin::Published("Housner 1963"))
            .within(Tolerance::Shown, "linearised: exact for slender blocks only"),
        Row::new("spin after over before the impact", "", restitution, shape.restitution())
            .from(Origin::Published("Housner 1963"))
            .within(
                Tolerance::Shown,
                "an impact of a rigid block that takes all energy of the far corner; on springs in \
             normal and shear direction part of it comes back",
            ),
        ledger,
    ];
    let way_down = fall(shape, tilt, exact).into_iter().map(|[t, angle]| [t + 0.5 * block.ramp, angle]).collect();
    let plot = Plot::new(
        format!("Tilt of a block released at {} of the critical tilt", setup.get("tilt")),
        ["time [s]", "tilt [rad]"],
    )
    .line("rigid block, to the impact", way_down)
    .marks("computed", path);
    Ok((rows, plot))
}

/// Time and tilt of the rigid block on its way down.
fn fall(shape: Rocking, tilt: f64, period: f64) -> Vec<[f64; 2]> {
    let steps = 4000;
    let dt = 0.25 * period / f64::from(steps);
    let (mut angle, mut spin, mut points) = (tilt, 0.0, vec![[0.0, tilt]]);
    for step in 1..=steps {
        spin -= dt * shape.rate * (shape.critical - angle - 0.5 * dt * spin).sin();
        angle += dt * spin;
        if step % 50 == 0 {
            points.push([f64::from(step) * dt, angle]);
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_give_the_published_numbers() {
        let shape = Rocking::new(0.2, 1.0);
        assert!((shape.housner(0.5 * shape.critical) - 1.386_788).abs() < 1e-6);
        // A slender block swings as the linearised one does.
        let slender = Rocking::new(0.01, 1.0);
        assert!((slender.period(0.5 * slender.critical) / slender.housner(0.5 * slender.critical) - 1.0).abs() < 1e-4);
        assert!(fall(shape, 0.1, shape.period(0.1)).last().expect("points")[1].abs() < 1e-3);
    }
}
