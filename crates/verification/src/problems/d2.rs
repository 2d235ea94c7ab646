//! D2: a harmonic shear wave makes a joint slip.

use std::f64::consts::PI;

use super::strip::{Jointed, Wave, rows};
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "D2",
    title: "Slip of a joint by a harmonic shear wave",
    source: "The stress that passes a joint of shear strength τs is the incident sine, clipped at ±τs (after Miller): \
             T² and R² are the mean squares of the clipped sine and of what was clipped off, over that of the sine, \
             and A² = 1 − T² − R². Catches slip that lags, strength that scales with the mesh, and energy made by slip",
    parameters: &[
        Parameter::new("young", "Pa", 50e9, [1e5, 1e12], "Young's modulus"),
        Parameter::new("poisson", "", 0.25, [0.0, 0.45], "Poisson's ratio"),
        Parameter::new("density", "kg/m³", 2650.0, [1.0, 1e5], "density"),
        Parameter::new("length", "m", 50.0, [1.0, 1e5], "wave length"),
        Parameter::new("elements", "", 80.0, [40.0, 200.0], "mesh sizes in a wave length"),
        Parameter::new("ratio", "", 0.5, [0.05, 0.9], "strength over incident stress"),
    ],
    quick: true,
    implicit: false,
    run,
};

/// Particle velocity of the incident wave (m/s).
const VELOCITY: f64 = 0.01;

/// T, R and A of a sine clipped at `ratio` of its amplitude.
fn coefficients(ratio: f64) -> [f64; 3] {
    let angle = ratio.asin();
    let (rest, both) = (0.5 * PI - angle, ratio * angle.cos());
    let through = (0.5 * (angle - both) + ratio * ratio * rest) / (0.25 * PI);
    let back = (0.5 * (rest + both) - 2.0 * both + ratio * ratio * rest) / (0.25 * PI);
    [through.sqrt(), back.sqrt(), (1.0 - through - back).max(0.0).sqrt()]
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let own = setup.get("ratio");
    let mut ratios = if setup.quick { vec![own] } else { vec![0.1, 0.5, 0.8] };
    if !ratios.contains(&own) {
        ratios.push(own);
    }
    let mut outcome = Outcome::default();
    for ratio in ratios {
        solve(setup, ratio, &mut outcome)?;
    }
    Ok(outcome)
}

fn solve(setup: &mut Setup, ratio: f64, outcome: &mut Outcome) -> Result<(), Trouble> {
    let strip = Jointed::of(setup, Wave::S);
    let impedance = strip.rock.impedance(Wave::S);
    let period = strip.length / strip.rock.speed(Wave::S);
    let until = 6.0 * period;
    let wave = (&rows(until, 1200, |t| (2.0 * PI * t / period).sin())[..], VELOCITY);
    let open = strip.run(setup, "no joint", None, wave, until)?;
    let name = format!("strength {ratio} of the stress");
    let strength = format!("cohesion = {:e}\ntension = 1e12\nresidual_tension = 1e12\n", ratio * impedance * VELOCITY);
    let stiffness = 1000.0 * impedance * 2.0 * PI / period;
    let motion = strip.run(setup, &name, Some((stiffness, &strength)), wave, until)?;
    let (from, to) = (4.0 * period, 6.0 * period - 1e-9 * period);
    let back: Vec<f64> = motion.velocity[0].iter().zip(&open.velocity[0]).map(|(v, i)| v - i).collect();
    let incident = [0, 1].map(|k| open.mean_square(&open.velocity[k], from, to));
    let through = motion.mean_square(&motion.velocity[1], from, to) / incident[1];
    let reflected = motion.mean_square(&back, from, to) / incident[0];
    let found = [through.sqrt(), reflected.sqrt(), (1.0 - through - reflected).max(0.0).sqrt()];
    let reason = "2 % asked; the joint's own stiffness is 1000 zω, the mesh rounds the kinks of the clipped sine";
    for ((which, exact), found) in ["T", "R", "A"].into_iter().zip(coefficients(ratio)).zip(found) {
        outcome.rows.push(Row::new(format!("{name}: {which}"), "", found, exact).relative(0.02, reason));
    }
    outcome.rows.push(Row::ledger(&motion.last));
    let stress: Vec<f64> = motion.velocity[1].iter().map(|v| v / VELOCITY).collect();
    let clipped = |t: f64| {
        let phase = if t > period { (2.0 * PI * (t - period) / period).sin() } else { 0.0 };
        phase.clamp(-ratio, ratio)
    };
    outcome.plots.push(
        Plot::new(format!("D2: stress that passes, {name}"), ["time (s)", "stress over that of the incident wave"])
            .beside("clipped sine", clipped, motion.points(&stress)),
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_coefficients() {
        for (ratio, published) in [
            (0.5, [0.625302, 0.415941, 0.660296]),
            (0.1, [0.138385, 0.874601, 0.464674]),
            (0.8, [0.899516, 0.131548, 0.416613]),
        ] {
            for (found, exact) in coefficients(ratio).into_iter().zip(published) {
                assert!((found - exact).abs() < 1e-6, "{ratio}: {found} of {exact}");
            }
        }
    }
}
