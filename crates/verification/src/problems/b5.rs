//! B5: periods of an elastic column on a rigid base.

use std::f64::consts::PI;

use super::strip::{Motion, Rock, Strip, Wave, run as run_strip};
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Tolerance, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "B5",
    title: "Periods of an elastic column",
    source: "T = 4L·√(ρ/M) with M = λ + 2μ (confined) and M = G (shear); under a base acceleration a that sets in at \
             once the head goes to twice aρL²/2M. Catches wrong moduli, masses and base motion",
    parameters: &[
        Parameter::new("length", "m", 800.0, [1.0, 1e4], "height of the column"),
        Parameter::new("density", "kg/m³", 1.0, [1e-3, 1e5], "density"),
        Parameter::new("shear_modulus", "Pa", 1e4, [1.0, 1e12], "shear modulus G"),
        Parameter::new("poisson", "", 2.0 / 11.0, [0.0, 0.45], "Poisson's ratio"),
        Parameter::new("elements", "", 20.0, [6.0, 80.0], "mesh sizes over the height"),
    ],
    quick: true,
    implicit: false,
    run,
};

/// Period of the first mode of a column that is held at its foot.
fn period(length: f64, density: f64, modulus: f64) -> f64 {
    4.0 * length * (density / modulus).sqrt()
}

/// A period (s) by the times at which a signal passes `level` upwards, `cycles` of them.
fn measured_period(times: &[f64], signal: &[f64], level: f64, cycles: usize) -> f64 {
    let crossings: Vec<f64> = (1..signal.len())
        .filter(|&k| signal[k - 1] < level && signal[k] >= level)
        .map(|k| {
            let share = (level - signal[k - 1]) / (signal[k] - signal[k - 1]);
            times[k - 1] + share * (times[k] - times[k - 1])
        })
        .collect();
    if crossings.len() > cycles { (crossings[cycles] - crossings[0]) / cycles as f64 } else { f64::NAN }
}

/// Displacements of the head by its velocities.
fn displacement(motion: &Motion) -> (Vec<f64>, Vec<f64>) {
    let dt = 2.0 * motion.times[0];
    let mut sum = 0.0;
    let way = motion.velocity[0].iter().map(|v| {
        sum += v * dt;
        sum
    });
    (motion.times.iter().map(|t| t + 0.5 * dt).collect(), way.collect())
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [length, density, shear, poisson] = ["length", "density", "shear_modulus", "poisson"].map(|n| setup.get(n));
    let rock = Rock { density, young: 2.0 * shear * (1.0 + poisson), poisson };
    let count = setup.get("elements");
    let meshes = if setup.quick { vec![count] } else { vec![0.5 * count, count, 2.0 * count] };
    let mut outcome = Outcome::default();
    for (wave, name) in [(Wave::P, "confined"), (Wave::S, "shear")] {
        let exact = period(length, density, rock.modulus(wave));
        let push = 1e-3 * rock.modulus(wave) / (density * length);
        let level = push * density * length * length / (2.0 * rock.modulus(wave));
        let mut errors = Vec::new();
        for &mesh in &meshes {
            let size = length / mesh;
            let axis = ["x", "y"][wave.axis()];
            let extra = format!(
                "[[fix]]\nedge = [[0.0, 0.0], [{}, 0.0]]\n[[base_motion]]\naxis = \"{axis}\"\nscale = -1.0\n\
                 table = [[0.0, {push:e}], [{:e}, {push:e}]]\n",
                2.0 * size,
                10.0 * exact
            );
            let origin = [0.31 * size, 0.17 * size];
            let strip =
                Strip { wave, rock, height: length, size, origin, monitors: &[length], duration: 10.0 * exact, extra };
            let motion = run_strip(setup, &format!("{name}, L/h = {mesh}"), &strip, 3.5 * exact)?;
            let (times, way) = displacement(&motion);
            let found = measured_period(&times, &way, level, 3);
            errors.push(found / exact - 1.0);
            if mesh == count {
                let reason = "linear elements and leapfrog: (ω·h)²/24c² of both signs, and supports that give by h/50L";
                let reason = format!("{reason}, in all below 2e-3 at 20 mesh sizes, falling with 1/n");
                let most = 2e-3 * (20.0 / count).max(0.1);
                outcome.rows.push(Row::new(format!("{name}: period"), "s", found, exact).relative(most, reason));
                let peak = Motion::peak(&way);
                let reason = "the head's kink at its turn is rounded by the mesh: less than 2h/L of twice the rest";
                let most = Tolerance::Relative(1.0 / count);
                let row = Row::new(format!("{name}: greatest displacement of the head"), "m", peak, 2.0 * level);
                outcome.rows.push(row.within(most, reason));
                outcome.rows.push(Row::ledger(&motion.last));
                outcome.plots.push(plot(name, &times, &way, level, exact));
            }
        }
        if let [first, middle, last] = errors[..] {
            let limit = last + (last - middle);
            let order = ((first - middle) / (middle - last)).abs().log2();
            let reason = "error ∝ 1/n by the give of the base's springs: what two meshes extrapolate to";
            let row = Row::new(format!("{name}: extrapolated error of the period"), "", limit, 0.0);
            outcome.rows.push(row.at_most(5e-4, reason));
            outcome.rows.push(Row::new(format!("{name}: order of convergence"), "", order, 1.0));
        }
    }
    Ok(outcome)
}

/// Displacement of the head over time, computed and exact: the sum over modes is a parabola back and forth.
fn plot(name: &str, times: &[f64], way: &[f64], level: f64, period: f64) -> Plot {
    let every = (times.len() / 300).max(1);
    let computed = times.iter().zip(way).step_by(every).map(|(t, u)| [*t, *u]).collect();
    let exact = |t: f64| {
        let modes = (0..40).map(|k| 2.0 * f64::from(k) + 1.0);
        let sum: f64 = modes.map(|n| (0.5 * PI * n).sin() * (2.0 * PI * n * t / period).cos() / n.powi(3)).sum();
        level * (1.0 - sum * 32.0 / PI.powi(3))
    };
    let line = times.iter().step_by(every).map(|t| [*t, exact(*t)]).collect();
    Plot::new(format!("B5, {name}: head of the column"), ["time (s)", "displacement (m)"])
        .line("exact", line)
        .marks("computed", computed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_periods() {
        let rock = Rock { density: 1.0, young: 2e4 * 13.0 / 11.0, poisson: 2.0 / 11.0 };
        assert!((rock.modulus(Wave::P) / 25714.16 - 1.0).abs() < 1e-5, "{}", rock.modulus(Wave::P));
        assert!((period(800.0, 1.0, 25714.16) - 19.9556).abs() < 1e-4);
        assert!((period(800.0, 1.0, rock.modulus(Wave::S)) - 32.0).abs() < 1e-9);
    }
}
