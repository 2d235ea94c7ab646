//! A3: free spin.

use enmm::geometry::{Point, Vector};
use enmm::model::Simulation;
use enmm::model::tables::{BlockId, EdgeId};

use crate::random::Random;
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "A3",
    title: "Free spin",
    source: "a block that is pushed by a moment spins with the inertia of its true polygon, and keeps angular \
             momentum, \
             kinetic energy and area; catches wrong inertia of cut covers and stress rates that are not objective",
    parameters: &[
        Parameter::new("w0", "rad/s", 0.8, [0.05, 20.0], "angular velocity"),
        Parameter::new("turns", "", 10.0, [0.25, 20.0], "turns"),
        Parameter::new("corners", "", 5.0, [3.0, 12.0], "corners of the block"),
        Parameter::new("size", "m", 1.2, [0.1, 20.0], "radius of the block"),
        Parameter::new("seed", "", 1.0, [0.0, 1e6], "seed of its shape"),
        Parameter::new(
            "crack",
            "",
            0.0,
            [0.0, 1.2],
            "depth over radius of a joint that ends inside the block; none where it is 0",
        ),
        Parameter::new("mesh", "", 0.4, [0.1, 3.0], "mesh size over radius"),
        Parameter::new("young", "Pa", 2e10, [1e8, 1e12], "Young's modulus"),
        Parameter::new("density", "kg/m³", 2500.0, [100.0, 1e4], "density"),
    ],
    quick: true,
    implicit: false,
    run,
};

/// Why the tolerance is as it is.
const REASON: &str = "1e-9 for rounding and for the angle of the leapfrog, (ω·dt)²/24; centrifugal force strains the \
                      block by at most 0.4·ρω²R²/E, which changes inertia, energy and area by twice as much: three \
                      times ρω²R²/E";
/// Why this does not depend on the strain.
const ROUNDING: &str = "internal forces have no resultant: rounding over some 1e5 steps";
/// Length of the push (s).
const PUSH: f64 = 2e-3;

/// Area, centroid and polar moment of area about it of a polygon, by Green's theorem.
fn moments(points: &[[f64; 2]]) -> (f64, Point, f64) {
    let (mut area, mut first, mut polar) = (0.0, Vector::zeros(), 0.0);
    let origin = Point::from(points[0]);
    for k in 0..points.len() {
        let [p, q] = [points[k], points[(k + 1) % points.len()]].map(|p| Point::from(p) - origin);
        let cross = p.perp(&q);
        area += cross / 2.0;
        first += (p + q) * (cross / 6.0);
        polar += cross * (p.dot(&p) + p.dot(&q) + q.dot(&q)) / 12.0;
    }
    (area, origin + first / area, polar - first.norm_squared() / area)
}

/// A star-shaped polygon about the origin.
fn shape(setup: &Setup) -> Vec<[f64; 2]> {
    let mut random = Random::new(setup.get("seed") as u64);
    let (count, size) = (setup.get("corners") as usize, setup.get("size"));
    let corner = |k: usize| {
        let angle = std::f64::consts::TAU * (k as f64 + random.between(-0.25, 0.25)) / count as f64;
        let radius = size * random.between(0.6, 1.0);
        [radius * angle.cos(), radius * angle.sin()]
    };
    (0..count).map(corner).collect()
}

/// A joint from outside into the block, along x and a little above its middle.
fn crack(setup: &Setup) -> String {
    let [depth, size] = ["crack", "size"].map(|name| setup.get(name));
    if depth == 0.0 {
        return String::new();
    }
    let [from, to] = [[-1.2 * size, 0.07 * size], [(depth - 1.0) * size, 0.11 * size]];
    format!("[[joint]]\npoints = [{from:?}, {to:?}]\n[joint_law.joint]\nfriction_deg = 20.0\n")
}

/// Area (m²) of the boundary loop now, and the way from its first point to the one opposite.
fn now(simulation: &Simulation) -> (f64, Vector) {
    let (places, boundary) = (simulation.positions(), &simulation.model().boundary);
    let corner = |k: EdgeId| (places[k] - places[0]).perp(&(places[boundary.after(k)] - places[0])) / 2.0;
    (boundary.edges().map(corner).sum(), places[places.len() / 2] - places[0])
}

/// The block of this outline, at rest; a moment about its centre gives it its spin.
fn case(setup: &Setup, outline: &[[f64; 2]]) -> String {
    let (w0, density) = (setup.get("w0"), setup.get("density"));
    let (_, centre, polar) = moments(outline);
    format!(
        "title = \"Spin\"\n[domain]\noutline = {outline:?}\n[mesh]\nsize = {:e}\nangle_deg = 11.0\n\
         origin = [0.1, 0.2]\n{}[gravity]\ny = 0.0\n[rock.rock]\ndensity = {density:e}\nyoung = {:e}\npoisson = 0.25\n\
         [[load]]\nkind = \"block\"\npoint = [{:?}, {:?}]\nmoment = {:e}\n\
         table = [[0.0, 0.0], [{half:e}, 1.0], [{PUSH:e}, 0.0]]\n[solver]\ncommunication_step = {half:e}\n[[stage]]\n\
         name = \"spin\"\nkind = \"dynamic\"\nduration = 1e6\ndamping = 0.1\n",
        setup.get("mesh") * setup.get("size"),
        crack(setup),
        setup.get("young"),
        centre.x,
        centre.y,
        w0 * density * polar / (0.5 * PUSH),
        half = 0.5 * PUSH,
    )
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let (outline, w0, density) = (shape(setup), setup.get("w0"), setup.get("density"));
    let (area, centre, polar) = moments(&outline);
    let text = case(setup, &outline);
    let mut simulation = setup.simulation("a3", text)?;
    let settle = simulation.steps_in(0.1f64.max(2.0 * PUSH));
    for _ in 0..settle {
        simulation.advance(false)?;
    }
    let turns = if setup.quick { setup.get("turns").min(0.5) } else { setup.get("turns") };
    let steps = simulation.steps_in(turns * std::f64::consts::TAU / w0);
    let every = (steps / 400).max(1);
    let motion = |s: &Simulation| s.rigid_motion_of(BlockId::new(0));
    let (momentum, (_, _, spin, kinetic)) = (simulation.momentum().1, motion(&simulation));
    let (mut angle, mut arm, mut curve) = (0.0, now(&simulation).1, Vec::new());
    for k in 1..=steps {
        simulation.advance(false)?;
        if k.is_multiple_of(every) || k == steps {
            let next = now(&simulation).1;
            angle += arm.perp(&next).atan2(arm.dot(&next));
            arm = next;
            let turned = angle / std::f64::consts::TAU;
            curve.push([turned, simulation.momentum().1 / momentum - 1.0, motion(&simulation).3 / kinetic - 1.0]);
        }
    }
    let time = steps as f64 * simulation.model().dt;
    let drift = [motion(&simulation).3 / kinetic, now(&simulation).0 / area];
    let found = [momentum, spin, std::f64::consts::TAU * time / angle, kinetic];
    let mut rows = rows(setup, density * polar, found);
    let most = limit(setup);
    let last = motion(&simulation);
    let size = setup.get("size");
    for (name, value) in [
        ("change of the angular momentum over itself", simulation.momentum().1 / momentum - 1.0),
        ("way of the centroid over the radius", (last.0 - centre).norm() / size),
        ("speed of the centroid over that of the rim", last.1.norm() / (w0 * size)),
    ] {
        let row = Row::new(format!("{name}, after {turns} turns"), "", value, 0.0);
        rows.push(row.at_most(5e-10, ROUNDING));
    }
    for (name, value) in ["kinetic energy", "area"].into_iter().zip(drift) {
        let row = Row::new(format!("{name} after {turns} turns over that before"), "", value, 1.0);
        rows.push(row.relative(most, REASON));
    }
    rows.push(Row::ledger(&simulation.advance(true)?));
    Ok(Outcome { rows, plots: vec![plot(&curve, turns)] })
}

/// Relative tolerance of everything that a rigid block would keep.
fn limit(setup: &Setup) -> f64 {
    let strain = setup.get("density") * (setup.get("w0") * setup.get("size")).powi(2) / setup.get("young");
    1e-9 + 3.0 * strain
}

/// Angular momentum, spin, period and kinetic energy found, against those of a polar inertia (kg·m²/m).
fn rows(setup: &Setup, inertia: f64, [momentum, spin, period, kinetic]: [f64; 4]) -> Vec<Row> {
    let (w0, most) = (setup.get("w0"), limit(setup));
    let energy = Row::new("kinetic energy after the push", "J/m", kinetic, 0.5 * inertia * w0 * w0);
    let mut rows = vec![energy.relative(most, REASON)];
    for (name, unit, found, exact) in [
        ("angular momentum after the push", "kg·m²/s", momentum, inertia * w0),
        ("spin after the push, L/J of the true polygon", "rad/s", spin, w0),
        ("period", "s", period, std::f64::consts::TAU / w0),
    ] {
        rows.push(Row::new(name, unit, found, exact).relative(most, REASON));
    }
    rows
}

fn plot(curve: &[[f64; 3]], turns: f64) -> Plot {
    let line = |k: usize| curve.iter().map(|p| [p[0], p[k]]).collect::<Vec<_>>();
    let exact = vec![[0.0, 0.0], [turns, 0.0]];
    Plot::new("Drift of a free spin", ["turns", "change relative to the start"])
        .line("exact", exact)
        .line("angular momentum", line(1))
        .line("kinetic energy", line(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rectangle b × h has the polar moment bh(b² + h²)/12 about its centre.
    #[test]
    fn moments_of_a_rectangle() {
        let (area, centre, polar) = moments(&[[1.0, 1.0], [4.0, 1.0], [4.0, 3.0], [1.0, 3.0]]);
        assert!((area - 6.0).abs() < 1e-12 && (centre - Point::new(2.5, 2.0)).norm() < 1e-12);
        assert!((polar - 6.0 * 13.0 / 12.0).abs() < 1e-12, "{polar}");
    }
}
