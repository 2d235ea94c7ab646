//! D1: a plane wave meets one linear joint.

use std::f64::consts::PI;

use super::strip::{Jointed, Motion, Wave, rows};
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "D1",
    title: "Wave through one linear joint",
    source: "Displacement discontinuity: |T| = 2K/√(4K²+1), |R| = 1/√(4K²+1) with K = k/(zω), and v_t/v0 = \
             1 − exp(−2kt/z) behind a step. Catches joint springs that damp, lag or scale with the mesh",
    parameters: &[
        Parameter::new("young", "Pa", 50e9, [1e5, 1e12], "Young's modulus"),
        Parameter::new("poisson", "", 0.25, [0.0, 0.45], "Poisson's ratio"),
        Parameter::new("density", "kg/m³", 2650.0, [1.0, 1e5], "density"),
        Parameter::new("length", "m", 50.0, [1.0, 1e5], "wave length"),
        Parameter::new("elements", "", 60.0, [30.0, 200.0], "mesh sizes in a wave length"),
        Parameter::new("k", "", 1.0, [0.02, 50.0], "one more ratio K"),
    ],
    quick: true,
    implicit: false,
    run,
};

/// |T| and |R| at the stiffness ratio K = k/(zω).
fn coefficients(ratio: f64) -> [f64; 2] {
    let root = (4.0 * ratio * ratio + 1.0).sqrt();
    [2.0 * ratio / root, 1.0 / root]
}

/// Time in which a step of velocity rises, in mesh sizes over the wave speed.
const RISE: f64 = 6.0;

/// v_t/v0 at time `t` (s) after the front of a step that rises linearly in the time `rise` (s): the mean of
/// 1 − exp(−rate·t) over the rise, rate = 2k/z.
fn behind_step(t: f64, rate: f64, rise: f64) -> f64 {
    let integral = |t: f64| if t > 0.0 { t - (1.0 - (-rate * t).exp()) / rate } else { 0.0 };
    (integral(t) - integral(t - rise)) / rise
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let mut ratios = if setup.quick { vec![0.5] } else { vec![0.1, 0.5, 1.0, 2.0, 5.0] };
    let own = setup.get("k");
    if !ratios.contains(&own) {
        ratios.push(own);
    }
    let mut outcome = Outcome::default();
    for wave in Wave::BOTH {
        let joint = Jointed::of(setup, wave);
        harmonic(&joint, setup, &ratios, &mut outcome)?;
        step(&joint, setup, 0.5 * omega(&joint) * joint.rock.impedance(wave), &mut outcome)?;
        if !setup.quick {
            harmonic(&Jointed { across: true, ..joint }, setup, &[own], &mut outcome)?;
        }
    }
    Ok(outcome)
}

fn omega(joint: &Jointed) -> f64 {
    2.0 * PI * joint.rock.speed(joint.wave) / joint.length
}

/// A joint of this stiffness (Pa/m), so strong that it is linear.
fn linear(stiffness: f64) -> Option<(f64, &'static str)> {
    Some((stiffness, "cohesion = 1e12\ntension = 1e12\n"))
}

/// Amplitude (m/s) of the incident waves.
const AMPLITUDE: f64 = 1e-3;

fn harmonic(joint: &Jointed, setup: &mut Setup, ratios: &[f64], outcome: &mut Outcome) -> Result<(), Trouble> {
    let (omega, wave) = (omega(joint), joint.wave);
    let period = 2.0 * PI / omega;
    let until = 9.0 * period;
    // Four waves rise smoothly, so that the joint rings little when the measurement begins.
    let rise = |t: f64| 0.5 - 0.5 * (PI * (t / (2.0 * period)).min(1.0)).cos();
    let rows = rows(until, 900, |t| rise(t) * (omega * t).sin());
    let place = if joint.across { ", across elements" } else { "" };
    let open = joint.run(setup, &format!("{wave:?}{place}, no joint"), None, (&rows, AMPLITUDE), until)?;
    let window = (7.0 * period, 9.0 * period - 1e-9 * period);
    let amplitude = |motion: &Motion, signal: &[f64]| motion.amplitude(signal, omega, window.0, window.1);
    let incident = [0, 1].map(|k| amplitude(&open, &open.velocity[k]));
    let reason = if joint.across {
        "2 % of the incident wave: where a joint cuts elements, its nodes are off the stars, and mass and \
         stiffness near it err by that of up to some 0.1 h of rock"
    } else {
        "2 % asked; a wave of n mesh sizes errs by some (2π/n)²/12, and a little more where the joint is soft"
    };
    let mut found = [Vec::new(), Vec::new()];
    for &ratio in ratios {
        let stiffness = ratio * joint.rock.impedance(wave) * omega;
        let name = format!("{wave:?}{place}, K = {ratio}");
        let motion = joint.run(setup, &name, linear(stiffness), (&rows, AMPLITUDE), until)?;
        let back: Vec<f64> = motion.velocity[0].iter().zip(&open.velocity[0]).map(|(v, i)| v - i).collect();
        let measured = [amplitude(&motion, &motion.velocity[1]) / incident[1], amplitude(&motion, &back) / incident[0]];
        for ((k, which), exact) in ["|T|", "|R|"].into_iter().enumerate().zip(coefficients(ratio)) {
            found[k].push([ratio, measured[k]]);
            let most = 0.02 * if joint.across { 1.0 } else { exact };
            outcome.rows.push(Row::new(format!("{name}: {which}"), "", measured[k], exact).absolute(most, reason));
        }
        outcome.rows.push(Row::ledger(&motion.last));
    }
    let exact =
        |k: usize| (0..=60).map(|i| 0.05 * 10f64.powf(f64::from(i) / 25.0)).map(|r| [r, coefficients(r)[k]]).collect();
    let [t, r] = found;
    if joint.across {
        return Ok(());
    }
    outcome.plots.push(
        Plot::new(format!("D1: {wave:?} wave through one joint"), ["K = k/(zω)", "share of the incident amplitude"])
            .line("|T|, exact", exact(0))
            .line("|R|, exact", exact(1))
            .marks("|T|, computed", t)
            .marks("|R|, computed", r)
            .logarithmic([true, false]),
    );
    Ok(())
}

/// A step of velocity that rises within a few mesh sizes: what passes the joint of `stiffness` (Pa/m).
fn step(joint: &Jointed, setup: &mut Setup, stiffness: f64, outcome: &mut Outcome) -> Result<(), Trouble> {
    let Jointed { rock, wave, length, size, .. } = *joint;
    let speed = rock.speed(wave);
    let (arrival, rise) = (length / speed, RISE * size / speed);
    let rate = 2.0 * stiffness / rock.impedance(wave);
    let until = arrival + rise + 4.0 / rate;
    let rows = [[0.0, 0.0], [rise, 1.0], [1e6, 1.0]];
    let motion = joint.run(setup, &format!("{wave:?}, step"), linear(stiffness), (&rows, AMPLITUDE), until)?;
    let exact = |t: f64| behind_step(t - arrival, rate, rise);
    let shares: Vec<f64> = motion.velocity[1].iter().map(|v| v / 1e-3).collect();
    let at = |time: f64| {
        let k = motion.times.partition_point(|t| *t < time).clamp(1, shares.len() - 1);
        let part = (time - motion.times[k - 1]) / (motion.times[k] - motion.times[k - 1]);
        shares[k - 1] + part * (shares[k] - shares[k - 1])
    };
    let reason = "2 % asked, of the incident step; the mesh rings a little behind the front";
    for share in [0.5, 1.0, 2.0, 3.0] {
        let time = arrival + 0.5 * rise + share / rate;
        let row = Row::new(format!("{wave:?}, step: v_t/v0 {share}·z/2k after its middle"), "", at(time), exact(time));
        outcome.rows.push(row.absolute(0.02, reason));
    }
    let plot = Plot::new(format!("D1: {wave:?} velocity step behind one joint"), ["time (s)", "v_t/v0"]);
    outcome.plots.push(plot.beside("exact", exact, motion.points(&shares)));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rise of no time leaves 1 − exp(−2kt/z).
    #[test]
    fn a_sudden_step_passes_as_published() {
        for t in [0.1, 1.0, 3.0] {
            assert!((behind_step(t, 2.0, 1e-6) - (1.0 - (-2.0 * t).exp())).abs() < 1e-5);
        }
    }

    #[test]
    fn the_published_coefficients() {
        for (ratio, through) in
            [(0.1, 0.196116), (0.5, 0.5f64.sqrt()), (1.0, 0.894427), (2.0, 0.970143), (5.0, 0.995037)]
        {
            let [t, r] = coefficients(ratio);
            assert!((t - through).abs() < 1e-6 && (t * t + r * r - 1.0).abs() < 1e-12);
        }
    }
}
