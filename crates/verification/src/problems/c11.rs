//! C11: a semicircular arch of voussoirs.

use std::f64::consts::{FRAC_PI_2, PI};

use enmm::geometry::Vector;
use enmm::model::Simulation;

use super::block::{G, advance, bisect};
use crate::{Origin, Outcome, Parameter, Plot, Problem, Row, Setup, Tolerance, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "C11",
    title: "Semicircular voussoir arch",
    source: "An arch of thickness t and mean radius R stands under its own weight while a line of thrust fits into it. \
             With joints everywhere the least thickness is t/R = 0.1075 (Milankovitch 1907, with the true centroids of \
             the voussoirs; Heyman's 0.106 takes them on the mean circle). An arch of n voussoirs hinges at its joints \
             only and may be a little thinner: its limit is computed here by limit analysis. With the horizontal \
             thrust H and its moment C about the centre, the thrust meets the joint at angle β from the crown, above \
             which weigh W at x from the middle, at the radius (C + x·W)/(W·sin β + H·cos β); the arch stands if some \
             H and C keep it within the thickness at all joints. The engine's limit is found by bisection: \
             after gravity has grown the arch rests, or falls. Catches hinges at the wrong place, corners that \
             interpenetrate, energy that holds or throws an arch.",
    parameters: &[
        Parameter::new("n", "", 15.0, [5.0, 41.0], "number of voussoirs"),
        Parameter::new("n_low", "", 8.0, [5.0, 41.0], "number of a second arch"),
        Parameter::new("n_high", "", 24.0, [5.0, 41.0], "number of a third arch"),
        Parameter::new("R", "m", 10.0, [0.5, 100.0], "mean radius"),
        Parameter::new("phi_deg", "°", 45.0, [30.0, 70.0], "friction angle; no slip"),
        Parameter::new("stiffness", "", 1e5, [2e4, 1e7], "Young's modulus over ρ·g·R"),
        Parameter::new("time", "", 8.0, [6.0, 60.0], "time to fall, in √(R/g)"),
    ],
    quick: true,
    implicit: true,
    run,
};

/// Density (kg/m³).
const DENSITY: f64 = 2500.0;
/// Time (in √(R/g)) over which gravity grows.
const RAMP: f64 = 0.5;
/// Way of the crown (in the thickness) from which the arch counts as falling.
const FALLS: f64 = 0.2;

/// An arch of `n` voussoirs with plane faces between radial joints, thickness `t`, both in mean radii of 1.
#[derive(Clone, Copy, Debug)]
struct Arch {
    n: usize,
    t: f64,
}

impl Arch {
    /// Radius inside or outside.
    fn radii(&self) -> [f64; 2] {
        [1.0 - 0.5 * self.t, 1.0 + 0.5 * self.t]
    }

    /// The middle of the voussoir at the crown, or of that beside it.
    fn middle(&self) -> [f64; 2] {
        let half = 0.5 * PI / self.n as f64;
        let angle = if self.n.is_multiple_of(2) { half } else { 0.0 };
        [half.cos() * angle.sin(), half.cos() * angle.cos()]
    }

    /// Corner at the `k`-th joint from the right, at a radius.
    fn corner(&self, k: usize, radius: f64) -> [f64; 2] {
        let angle = PI * k as f64 / self.n as f64;
        [radius * angle.cos(), radius * angle.sin()]
    }

    /// Of each joint of one half, from the crown: angle β, weight W above it and moment x·W, with a specific weight of
    /// 1. The joint at the crown, which odd numbers lack, has nothing above it.
    fn joints(&self) -> Vec<[f64; 3]> {
        let step = PI / self.n as f64;
        let [low, high] = self.radii();
        let place = |angle: f64, radius: f64| [radius * angle.sin(), radius * angle.cos()];
        let (mut joints, mut weight, mut moment, mut angle) = (Vec::new(), 0.0, 0.0, 0.0);
        if self.n.is_multiple_of(2) {
            joints.push([0.0; 3]);
        } else {
            let [below, above] = [low, high].map(|radius| radius * (0.5 * step).cos());
            angle = 0.5 * step;
            let half = [[0.0, below], place(angle, low), place(angle, high), [0.0, above]];
            [weight, moment] = area_and_moment(&half);
            joints.push([angle, weight, moment]);
        }
        while angle < FRAC_PI_2 - 0.5 * step {
            let next = angle + step;
            let [area, about] =
                area_and_moment(&[place(angle, low), place(next, low), place(next, high), place(angle, high)]);
            (weight, moment, angle) = (weight + area, moment + about, next);
            joints.push([angle, weight, moment]);
        }
        joints
    }

    /// Room (in C) that the best thrust leaves: below zero no line of thrust fits.
    fn room(&self) -> f64 {
        let joints = self.joints();
        let [low, high] = self.radii();
        let room = |thrust: f64| {
            let bound = |radius: f64, [angle, weight, moment]: &[f64; 3]| {
                radius * (weight * angle.sin() + thrust * angle.cos()) - moment
            };
            let most = joints.iter().map(|joint| bound(high, joint)).fold(f64::INFINITY, f64::min);
            let least = joints.iter().map(|joint| bound(low, joint)).fold(f64::NEG_INFINITY, f64::max);
            most - least
        };
        // A least of linear functions less a greatest one is concave: thirds find its top.
        let [mut left, mut right] = [0.0, 2.0 * self.t];
        for _ in 0..80 {
            let [a, b] = [left + (right - left) / 3.0, right - (right - left) / 3.0];
            if room(a) < room(b) { left = a } else { right = b }
        }
        room(0.5 * (left + right))
    }

    /// Least thickness over mean radius of an arch of `n` voussoirs.
    fn limit(n: usize) -> f64 {
        let [mut low, mut high] = [0.005, 0.5];
        for _ in 0..40 {
            let t = 0.5 * (low + high);
            if (Self { n, t }).room() < 0.0 { low = t } else { high = t }
        }
        0.5 * (low + high)
    }
}

/// Area of a polygon, either sense, and its moment about the y axis.
fn area_and_moment(points: &[[f64; 2]]) -> [f64; 2] {
    let (mut area, mut moment) = (0.0, 0.0);
    for (k, p) in points.iter().enumerate() {
        let q = points[(k + 1) % points.len()];
        let cross = p[0] * q[1] - p[1] * q[0];
        area += 0.5 * cross;
        moment += cross * (p[0] + q[0]) / 6.0;
    }
    [area * area.signum(), moment * area.signum()]
}

fn case(setup: &Setup, arch: &Arch, duration: f64) -> String {
    let radius = setup.get("R");
    let scaled = |points: Vec<[f64; 2]>| points.iter().map(|p| p.map(|x| x * radius)).collect::<Vec<_>>();
    let [low, high] = arch.radii();
    let ring = |r: f64| (0..=arch.n).map(move |k| arch.corner(k, r));
    let mut outline = vec![[-1.4, -0.3], [1.4, -0.3], [1.4, 0.0]];
    outline.extend(ring(high));
    outline.push([-1.4, 0.0]);
    let joint =
        |k: usize| format!("[[joint]]\npoints = {:?}\n", scaled(vec![arch.corner(k, low), arch.corner(k, high)]));
    let joints: String = (0..=arch.n).map(joint).collect();
    format!(
        "title = \"Arch of {} voussoirs, t/R = {}\"\n[domain]\noutline = {:?}\nholes = [{:?}]\n[mesh]\nsize = {}\n\
         origin = [{}, {}]\n{joints}[joint_law.joint]\nfriction_deg = {}\n[rock.rock]\ndensity = {DENSITY:?}\n\
         young = {:e}\npoisson = 0.25\n[gravity]\ny = 0.0\n[[load]]\nkind = \"body\"\nacceleration = [0.0, {}]\n\
         table = [[0.0, 0.0], [{:e}, 1.0]]\n[[fix]]\nblock = {:?}\n[[stage]]\nname = \"stand or fall\"\n\
         kind = \"dynamic\"\nduration = {duration:e}\ndamping = 0.1\n[[monitor]]\nname = \"crown\"\npoint = {:?}\n",
        arch.n,
        arch.t,
        scaled(outline),
        scaled(ring(low).collect()),
        0.25 * radius,
        0.031 * radius,
        0.017 * radius,
        setup.get("phi_deg"),
        setup.get("stiffness") * DENSITY * G * radius,
        -G,
        RAMP * (radius / G).sqrt(),
        [0.0, -0.2 * radius],
        arch.middle().map(|x| x * radius),
    )
}

/// How an arch of one thickness went: time (s) and way down of the crown (m), whether it fell, its ledger.
struct Fate {
    path: Vec<[f64; 2]>,
    falls: bool,
    ledger: Row,
}

fn fate(setup: &mut Setup, arch: &Arch, name: &str) -> Result<Fate, Trouble> {
    let radius = setup.get("R");
    let unit = (radius / G).sqrt();
    let time = unit * setup.get("time") * if setup.quick { 0.6 } else { 1.0 };
    let mut simulation = setup.simulation(name, case(setup, arch, 2.0 * time))?;
    let mut path = vec![[0.0; 2]];
    let sinks = |s: &Simulation| s.monitor(0).0.dot(&Vector::new(0.0, -1.0));
    let falls = |s: &Simulation| s.monitor(0).0.norm() > FALLS * arch.t * radius;
    let report = advance(&mut simulation, time, |s| {
        if s.time() > path.last().map_or(0.0, |p| p[0]) + 0.02 * time {
            path.push([s.time(), sinks(s)]);
        }
        falls(s)
    })?;
    Ok(Fate { path, falls: falls(&simulation), ledger: Row::ledger(&report) })
}

/// Number of voussoirs of the first arch; fewer in the quick form.
fn voussoirs(setup: &Setup) -> usize {
    let n = setup.get("n").round() as usize;
    if setup.quick { n.min(9) } else { n }
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let mut numbers = vec![voussoirs(setup)];
    if !setup.quick {
        numbers.extend(["n_low", "n_high"].map(|name| setup.get(name).round() as usize));
    }
    numbers.sort_unstable();
    numbers.dedup();
    let (mut rows, mut found) = (Vec::new(), Vec::new());
    for n in numbers {
        let exact = Arch::limit(n);
        let bracket = if setup.quick { [0.06, 0.18] } else { [0.04, 0.24] };
        let width = exact * if setup.quick { 1e-2 } else { 4e-3 };
        let limit = bisect(bracket, width, |t| Ok(fate(setup, &Arch { n, t }, &format!("n{n}_t{t:.5}"))?.falls))?;
        found.push([n as f64, limit]);
        let row = Row::new(format!("least t/R of {n} voussoirs"), "", limit, exact)
            .from(Origin::Numerical("limit analysis of these voussoirs"));
        rows.push(row.relative(
            1e-2,
            "half the width of the bisection, 2e-3 (quick form 5e-3), and the springs of the joints: each gives way by \
             some ρ·g·R·h/E, which over n joints and the lever R/t moves the line of thrust by 5e-3 of t",
        ));
    }
    let most = found.last().copied().unwrap_or_default();
    let row =
        Row::new(format!("the same of {} voussoirs beside joints everywhere", most[0]), "", most[1], Arch::limit(1000))
            .from(Origin::Numerical("limit analysis of 1000 voussoirs"));
    rows.push(
        row.within(Tolerance::Shown, "the limit of many voussoirs, 0.1075 by Milankovitch; fewer may be thinner"),
    );
    let (plot, ledger) = crown(setup, voussoirs(setup))?;
    rows.extend(ledger);
    Ok(Outcome { rows, plots: vec![limits(&found), plot] })
}

fn limits(found: &[[f64; 2]]) -> Plot {
    let exact = (5..=41).map(|n| [n as f64, Arch::limit(n)]).collect();
    Plot::new("Least thickness of a semicircular arch", ["number of voussoirs", "t/R"])
        .line("limit analysis, n voussoirs", exact)
        .line("joints everywhere", [5.0, 41.0].map(|n| [n, Arch::limit(1000)]).to_vec())
        .marks("computed", found.to_vec())
}

/// Way of the crown 4 % above and below the limit, and the ledgers of both.
fn crown(setup: &mut Setup, n: usize) -> Result<(Plot, Vec<Row>), Trouble> {
    let limit = Arch::limit(n);
    let mut rows = Vec::new();
    let mut plot = Plot::new(format!("Way of the crown of {n} voussoirs"), ["time [s]", "way down over thickness"]);
    for (factor, name, word) in [(1.04, "above", "4 % above the limit"), (0.96, "below", "4 % below the limit")] {
        let fate = fate(setup, &Arch { n, t: factor * limit }, &format!("n{n}_{name}"))?;
        let scale = factor * limit * setup.get("R");
        plot = plot.marks(word, fate.path.iter().map(|p| [p[0], p[1] / scale]).collect());
        rows.push(Row { quantity: format!("{}, {word}", fate.ledger.quantity), ..fate.ledger });
    }
    Ok((plot, rows))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_voussoirs_have_the_published_limit() {
        let limit = Arch::limit(1000);
        assert!((limit - 0.1075).abs() < 1e-4, "{limit}");
        // Hinges at few joints fail later; the limit is approached from below.
        assert!(Arch::limit(8) < Arch::limit(41) && Arch::limit(41) < limit);
    }

    #[test]
    fn weights_are_those_of_half_an_arch() {
        for n in [8, 9] {
            let arch = Arch { n, t: 0.1 };
            let [angle, weight, _] = *arch.joints().last().expect("joints");
            let whole: f64 = n as f64 * 0.5 * (1.05f64.powi(2) - 0.95f64.powi(2)) * (PI / n as f64).sin();
            assert!((angle - FRAC_PI_2).abs() < 1e-12 && (weight - 0.5 * whole).abs() < 1e-12, "{n}: {weight} {whole}");
        }
    }
}
