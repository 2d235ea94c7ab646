//! C12: the least tension of a bolt that holds a block on a plane.

use enmm::geometry::{Point, Vector};
use enmm::model::StepReport;

use crate::parts::turn;
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "C12",
    title: "Bolt that holds a block on a plane",
    source: "Limit equilibrium: T = W·(sin a − cos a·tan φ)/(cos δ + sin δ·tan φ) for a bolt that pulls upslope at δ \
             into the plane; the least tension is searched by bisection on the pretension of a soft bar; catches wrong \
             directions and sizes of bolt forces",
    parameters: &[
        Parameter::new("a_deg", "°", 45.0, [10.0, 60.0], "dip of the plane"),
        Parameter::new("phi_deg", "°", 30.0, [0.0, 50.0], "friction angle, below the dip"),
        Parameter::new("weight", "kN/m", 100.0, [1.0, 1e4], "weight of the block"),
        Parameter::new("delta_deg", "°", 40.0, [0.0, 100.0], "one more angle of the bolt"),
        Parameter::new("spacing", "m", 1.0, [0.2, 10.0], "distance between bolts"),
        Parameter::new("mesh", "m", 0.6, [0.2, 1.0], "mesh size"),
    ],
    quick: true,
    implicit: true,
    run,
};

const G: f64 = 9.81;
/// Length and height (m) of the block.
const BLOCK: [f64; 2] = [2.0, 1.0];
/// Distance (m) of the wall upslope of the block in which flat bolts are anchored.
const WALL: f64 = 1.0;
/// Time of a trial (s), of which the last third is judged.
const TRIAL: f64 = 0.36;
/// Acceleration, relative to gravity, from which a block counts as sliding.
const SLIDING: f64 = 2e-4;

/// Least tension for a factor of safety of 1, for a bolt at `delta` (rad) into the plane.
fn tension(weight: f64, slope: f64, friction: f64, delta: f64) -> f64 {
    weight * (slope.sin() - slope.cos() * friction.tan()) / (delta.cos() + delta.sin() * friction.tan())
}

/// A block on a held base with a wall upslope, and a soft bar from its centroid into the held rock.
fn case(setup: &Setup, delta: f64, pretension: f64) -> String {
    let [slope, friction, weight] = ["a_deg", "phi_deg", "weight"].map(|name| setup.get(name));
    let [length, height] = BLOCK;
    let [left, right] = [-WALL - 2.0, length + 1.5];
    let base = [[left, -1.5], [right, -1.5], [right, 0.0]];
    let block = [[length, 0.0], [length, height], [0.0, height], [0.0, 0.0]];
    let wall = [[-WALL, 0.0], [-WALL, height + 1.0], [left, height + 1.0]];
    let outline = [&base[..], &block, &wall].concat();
    let centre = [0.5 * length, 0.5 * height];
    let to_wall = (centre[0] + WALL + 0.6) / delta.cos().max(1e-9);
    let to_base = (centre[1] + 0.6) / delta.sin().max(1e-9);
    let reach = to_wall.min(to_base);
    let anchor = [centre[0] - reach * delta.cos(), centre[1] - reach * delta.sin()];
    // A bar so soft that its force does not change: it would swing the block with a period of some 6 s.
    let stiffness = 0.1 * weight * 1e3;
    let spacing = setup.get("spacing");
    [
        format!("title = \"Bolt\"\n[domain]\noutline = {:?}\n", turn(&outline, -slope)),
        format!("[mesh]\nsize = {:?}\norigin = [0.031, 0.017]\n", setup.get("mesh")),
        format!("[[joint]]\npoints = {:?}\n", turn(&[[0.0, 0.0], [length, 0.0]], -slope)),
        format!("[joint_law.joint]\nfriction_deg = {:?}\n", (slope + 15.0).min(85.0)),
        format!(
            "[rock.rock]\ndensity = {:?}\nyoung = {:e}\npoisson = 0.25\n",
            weight * 1e3 / (G * length * height),
            3e8 * weight
        ),
        format!("[[fix]]\nblock = {:?}\n", turn(&[[0.5 * length, -0.75]], -slope)[0]),
        format!(
            "[[bolt]]\npoints = {:?}\nyoung = {:?}\narea = 1e-3\n",
            turn(&[centre, anchor], -slope),
            stiffness * reach * spacing / 1e-3
        ),
        format!("spacing = {spacing:?}\npretension = {:?}\n", pretension * spacing),
        "[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 5.0\nconvergence = 1e-5\n".into(),
        format!("[[stage]]\nname = \"release\"\nkind = \"dynamic\"\nduration = {TRIAL:?}\ndamping = 0.2\n"),
        format!("[[stage.law]]\nlaw = \"joint\"\nfriction_deg = {friction:?}\n"),
    ]
    .concat()
}

/// Acceleration down the plane (m/s²) of a block whose bar has this pretension (N/m), and the last report.
fn trial(setup: &mut Setup, delta: f64, pretension: f64) -> Result<(f64, StepReport), Trouble> {
    let text = case(setup, delta, pretension);
    setup.cases.retain(|(name, _)| *name != name_of(delta));
    let mut simulation = setup.simulation(&name_of(delta), text)?;
    simulation.run_stage()?;
    simulation.next_stage()?;
    let slope = setup.get("a_deg");
    let (s, c) = slope.to_radians().sin_cos();
    let middle = Point::from(turn(&[[0.5 * BLOCK[0], 0.5 * BLOCK[1]]], -slope)[0]);
    let covers = &simulation.model().covers;
    let element = covers.element_near(middle, 0.1).ok_or_else(|| Trouble("no rock in the block".into()))?;
    let block = covers.element_block[element];
    let third = simulation.steps_in(TRIAL / 3.0);
    let mut places = Vec::new();
    let mut report = StepReport::default();
    for _ in 0..3 {
        for step in 1..=third {
            report = simulation.advance(step == third)?;
        }
        let motion = simulation.rigid_motion_of(block);
        places.push(motion.0.dot(&Vector::new(c, -s)));
    }
    // From ½·a·t² at the last two times.
    Ok(((places[2] - places[1]) * 18.0 / (5.0 * TRIAL * TRIAL), report))
}

fn name_of(delta: f64) -> String {
    format!("c12 bolt at {:.1} degrees", delta.to_degrees())
}

/// The least tension (N/m) under which the block stays, by doubling and bisection to a share of 3e-4.
fn least(setup: &mut Setup, delta: f64) -> Result<(f64, StepReport), Trouble> {
    let mut high = 0.1e3 * setup.get("weight");
    let slides = |setup: &mut Setup, force: f64| -> Result<(bool, StepReport), Trouble> {
        let (acceleration, report) = trial(setup, delta, force)?;
        Ok((acceleration > SLIDING * G, report))
    };
    let (mut low, mut last) = (0.0, StepReport::default());
    let (sliding, report) = slides(setup, 0.0)?;
    if !sliding {
        return Ok((0.0, report));
    }
    loop {
        let (sliding, report) = slides(setup, high)?;
        if !sliding {
            break;
        }
        (low, high, last) = (high, 2.0 * high, report);
        if high > 1e7 * setup.get("weight") {
            return Err(Trouble("no tension holds the block".into()));
        }
    }
    while high - low > 3e-4 * high {
        let middle = 0.5 * (low + high);
        let (sliding, report) = slides(setup, middle)?;
        if sliding {
            low = middle
        } else {
            high = middle
        }
        last = report;
    }
    Ok((0.5 * (low + high), last))
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [slope, friction, extra] = ["a_deg", "phi_deg", "delta_deg"].map(|name| setup.get(name).to_radians());
    let weight = setup.get("weight");
    let exact = |delta: f64| tension(weight, slope, friction, delta).max(0.0);
    let (mut rows, mut found) = (Vec::new(), Vec::new());
    let all = [(0.0, "parallel to the plane"), (90f64.to_radians(), "normal to the plane"), (extra, "at delta_deg")];
    for (delta, name) in all {
        if delta > 0.5 && friction == 0.0 && (delta - 90f64.to_radians()).abs() < 1e-9 {
            continue;
        }
        let (force, report) = least(setup, delta)?;
        let computed = force / 1e3;
        found.push([delta.to_degrees(), computed]);
        let reason = "bisection to 3e-4; a block counts as sliding from 2e-4 g, which is up to 1e-3 of the tension";
        let row = Row::new(format!("least tension, {name}"), "kN/m", computed, exact(delta));
        rows.push(row.absolute(2e-3 * exact(delta).max(0.1 * weight), reason));
        if delta == extra {
            rows.push(Row::ledger(&report));
        }
    }
    let curve = (0..=100).map(f64::from).map(|d| [d, exact(d.to_radians())]).filter(|p| p[1].is_finite()).collect();
    let plot = Plot::new(
        "Least tension for a factor of safety of 1",
        ["angle of the bolt into the plane (°)", "tension (kN/m)"],
    )
    .line("limit equilibrium", curve)
    .marks("computed", found);
    Ok(Outcome { rows, plots: vec![plot] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_numbers_come_from_the_formula() {
        let [a, phi] = [45.0, 30.0].map(f64::to_radians);
        assert!((tension(100.0, a, phi, 0.0) - 29.885849).abs() < 1e-6);
        assert!((tension(100.0, a, phi, 90f64.to_radians()) - 51.763809).abs() < 1e-6);
        // The best bolt pulls at δ = φ and needs W·sin(a − φ).
        assert!((tension(100.0, a, phi, phi) - 100.0 * (a - phi).sin()).abs() < 1e-12);
    }
}
