//! C14: blocks that slide over crossings, bricks and ledges, and one that a step catches.

use super::block::G;
use super::limit::Scene;
use crate::parts::turn;
use crate::{Outcome, Parameter, Problem, Row, Setup, Trouble};
use enmm::geometry::Vector;
use enmm::model::Simulation;

pub const PROBLEM: Problem = Problem {
    id: "C14",
    title: "Blocks over crossings, bricks and steps",
    source: "s = ½·g·(sin a − cos a·tan φ)·t² for blocks over ends of joints whose tops are level, at any angle and \
             however many; a step holds a block at its foot. F7 has the same by limit analysis. Catches corners that \
             hold blocks where strength does not, and steps that let them pass",
    parameters: &[
        Parameter::new("a_deg", "°", 30.0, [10.0, 40.0], "dip of the plane"),
        Parameter::new("phi_deg", "°", 20.0, [0.0, 35.0], "friction, below a_deg"),
        Parameter::new("angle_1_deg", "°", 45.0, [45.0, 135.0], "joint to the plane"),
        Parameter::new("angle_2_deg", "°", 90.0, [45.0, 135.0], "a second one"),
        Parameter::new("angle_3_deg", "°", 120.0, [45.0, 135.0], "a third one"),
        Parameter::new("brick", "m", 0.21, [0.05, 1.0], "length of the level bricks"),
        Parameter::new("ledge", "", 5e-4, [0.0, 7e-4], "that lets pass, over mesh size"),
        Parameter::new("step", "", 0.01, [2e-3, 0.2], "that holds, over mesh size"),
        Parameter::new("t", "s", 0.5, [0.1, 0.7], "time of sliding"),
        Parameter::new("mesh", "m", 0.5, [0.2, 1.0], "mesh size for blocks of 1 m"),
    ],
    quick: true,
    implicit: false,
    run,
};

/// Way (m) from the front of a block to a ledge or step.
const AWAY: f64 = 0.02;
/// Friction above the dip (degrees) while blocks settle.
const HELD: f64 = 15.0;

/// Blocks on a base whose top is the plane: a point in each, and its area (m²).
#[derive(Debug, Clone)]
struct Blocks {
    name: String,
    outline: Vec<[f64; 2]>,
    joints: Vec<Vec<[f64; 2]>>,
    held: Vec<[f64; 2]>,
    bodies: Vec<([f64; 2], f64)>,
}

impl Blocks {
    /// Two blocks side by side, parted by a joint that goes on through the base.
    fn crossing(angle_deg: f64) -> Self {
        let shift = 1.0 / angle_deg.to_radians().tan();
        let outline =
            [[-1.0, -1.5], [5.0, -1.5], [5.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0], [0.0, 0.0], [-1.0, 0.0]];
        Self {
            name: format!("joint at {angle_deg}°"),
            outline: outline.into(),
            joints: vec![vec![[0.0, 0.0], [2.0, 0.0]], vec![[1.0 + shift, 1.0], [1.0 - 1.5 * shift, -1.5]]],
            held: vec![[-0.9, -0.1], [4.9, -0.1]],
            bodies: vec![
                ([0.5 + 0.25 * shift, 0.45], 1.0 + 0.5 * shift),
                ([1.5 + 0.25 * shift, 0.45], 1.0 - 0.5 * shift),
            ],
        }
    }

    /// A block of 1 m on a base whose top rises by `rise` (m) before it; so low and near that it does not trip.
    fn stepped(name: &str, rise: f64) -> Self {
        let foot = 1.5 + AWAY;
        let mut outline = vec![[0.0, -1.0], [6.0, -1.0], [6.0, rise], [foot, rise]];
        outline.extend([[foot, 0.0], [1.5, 0.0], [1.5, 0.5], [0.5, 0.5], [0.5, 0.0], [0.0, 0.0]]);
        outline.dedup();
        Self {
            name: name.into(),
            outline,
            joints: vec![vec![[0.5, 0.0], [1.5, 0.0]]],
            held: vec![[0.1, -0.5]],
            bodies: vec![([1.03, 0.26], 0.5)],
        }
    }

    /// The same on a level base of bricks, which are held.
    fn bricks(long: f64) -> Self {
        let mut blocks = Self::stepped("level bricks", 0.0);
        let joint = |k: u32| 1.4 + long * f64::from(k);
        let ends: Vec<f64> = (0..).map(joint).take_while(|x| *x < 5.5).collect();
        blocks.joints.extend(ends.iter().map(|&x| vec![[x, 0.0], [x, -1.0]]));
        blocks.held.extend(ends.iter().zip(ends.iter().skip(1).chain([&6.0])).map(|(a, b)| [0.5 * (a + b), -0.5]));
        blocks
    }

    /// The farthest slide of each block, and the time for which they slid.
    fn slides(&self, setup: &mut Setup) -> Result<(Vec<f64>, f64), Trouble> {
        let [a, phi, t, size] = ["a_deg", "phi_deg", "t", "mesh"].map(|name| setup.get(name));
        let scene = Scene {
            dip_deg: a,
            outline: self.outline.clone(),
            joints: self.joints.iter().map(|joint| (joint.clone(), "joint")).collect(),
            laws: vec![("joint", a + HELD, 0.0)],
            held: self.held.clone(),
            unit_weight: 2650.0 * G,
            seismic: 0.0,
            size,
        };
        let mut text = scene.text("Blocks over crossings");
        text += &format!(
            "convergence = 1e-5\n[[stage]]\nname = \"slide\"\nkind = \"dynamic\"\nduration = {t:e}\ndamping = 0.0\n\
             [[stage.law]]\nlaw = \"joint\"\nfriction_deg = {phi:?}\n"
        );
        let points: Vec<[f64; 2]> = self.bodies.iter().map(|(point, _)| *point).collect();
        for (k, point) in turn(&points, -a).iter().enumerate() {
            text += &format!("[[monitor]]\nname = \"block {k}\"\npoint = {point:?}\n");
        }
        let mut simulation = setup.simulation(&self.name, text)?;
        simulation.run_stage()?;
        simulation.next_stage()?;
        let (s, c) = a.to_radians().sin_cos();
        let places = |simulation: &Simulation| -> Vec<f64> {
            (0..points.len()).map(|k| Vector::new(c, -s).dot(&simulation.monitor(k).0)).collect()
        };
        let (before, start) = (places(&simulation), simulation.time());
        let mut farthest = vec![0.0f64; points.len()];
        while !simulation.stage_is_over(None) {
            simulation.advance(false)?;
            let now = places(&simulation);
            farthest.iter_mut().zip(now.iter().zip(&before)).for_each(|(far, (now, then))| *far = far.max(now - then));
        }
        Ok((farthest, simulation.time() - start))
    }
}

/// Why slides may differ.
const PUSH: &str = "the drop of friction frees elastic strain, and blocks push each other: half a per cent of the way \
                    of all, and 2 % of that of one";

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [a, phi, size] = ["a_deg", "phi_deg", "mesh"].map(|name| setup.get(name));
    let acceleration = G * (a.to_radians().sin() - a.to_radians().cos() * phi.to_radians().tan());
    let far = 0.5 * acceleration * setup.get("t").powi(2);
    if !(2.0 * AWAY..=2.5).contains(&far) {
        return Err(Trouble(format!("the blocks slide {far:.3} m: choose phi_deg and t for 0.1 to 2.5 m")));
    }
    let mut outcome = Outcome::default();
    let mut free = ["angle_1_deg", "angle_2_deg", "angle_3_deg"].map(|name| Blocks::crossing(setup.get(name))).to_vec();
    free.push(Blocks::bricks(setup.get("brick")));
    for blocks in &free {
        let (slides, time) = blocks.slides(setup)?;
        let exact = 0.5 * acceleration * time * time;
        let areas: f64 = blocks.bodies.iter().map(|(_, area)| area).sum();
        let mean = slides.iter().zip(&blocks.bodies).map(|(slide, (_, area))| slide * area).sum::<f64>() / areas;
        let row = Row::new(format!("slide, {}", blocks.name), "m", mean, exact);
        outcome.rows.push(row.relative(5e-3, PUSH));
        if slides.len() > 1 {
            let worst = slides.iter().map(|slide| (slide / exact - 1.0).abs()).fold(0.0, f64::max);
            let row = Row::new(format!("farthest from that over it, {}", blocks.name), "", worst, 0.0);
            outcome.rows.push(row.at_most(0.02, PUSH));
        }
    }
    let ledge = setup.get("ledge") * size;
    let (slides, time) = Blocks::stepped("ledge", ledge).slides(setup)?;
    let exact = 0.5 * acceleration * time * time;
    let climb = ledge * G * a.to_radians().cos() / acceleration;
    let reason = "half a per cent, and what the block loses when it climbs the ledge: its height times g·cos a over \
                  the acceleration";
    let row = Row::new("slide, ledge", "m", slides[0], exact);
    outcome.rows.push(row.absolute(5e-3 * exact + climb, reason));
    let (slides, _) = Blocks::stepped("step", setup.get("step") * size).slides(setup)?;
    let reason = "the speed v with which it strikes can lift a block by v²/2g, and as far it can turn over its toe";
    let row = Row::new("farthest slide up to the step that holds", "m", slides[0], AWAY);
    outcome.rows.push(row.absolute(acceleration * AWAY / G, reason));
    Ok(outcome)
}
