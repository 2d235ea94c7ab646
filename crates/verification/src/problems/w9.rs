//! W9: where all heads are equal, water in joints presses as still water does.

use super::joint_flow::{Plate, ROUND_OFF};
use crate::{Outcome, Parameter, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "W9",
    title: "Still water as water that does not flow",
    source: "with one head everywhere nothing flows, and each point has the pressure γ·(H − y) of a still surface, \
             which another part of the program gives; catches pressures on the wrong face, on both faces of one piece, \
             or on a piece beside a crossing twice",
    parameters: &[
        Parameter::new("level", "", 0.8, [0.1, 1.5], "head over the height of the plate"),
        Parameter::new("height", "m", 8.0, [1.0, 100.0], "its height"),
        Parameter::new("dip_deg", "°", 31.0, [1.0, 44.0], "dip of one of its joints"),
        Parameter::new("aperture", "m", 1e-4, [1e-5, 1e-3], "aperture of all joints"),
    ],
    quick: true,
    implicit: false,
    run,
};

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [height, aperture] = ["height", "aperture"].map(|name| setup.get(name));
    let level = height * setup.get("level");
    let rise = 0.7 * height * setup.get("dip_deg").to_radians().tan();
    let joints = [
        [[0.0, 0.25], [1.5, 0.25]],
        [[0.1, 0.0], [1.5, 2.0 * rise / height]],
        [[1.13, 0.0], [1.0, 1.0]],
        [[0.5, 0.9], [1.5, 0.55]],
    ];
    let scaled = |points: [[f64; 2]; 2]| points.map(|point| point.map(|x| x * height));
    let plate = Plate {
        joints: joints.iter().map(|joint| (scaled(*joint), aperture)).collect(),
        ..Plate::new([1.5 * height, height], 0.09 * height)
    };
    let still = format!("[water]\nlevel = {level:?}\n");
    let plate = Plate { more: still.clone() + "joints = false\n", ..plate };
    let moving = plate.clone().side("right", 1.5 * height, level);
    let moving = setup.simulation("flow", moving.text("Water in joints under one head"))?;
    let begins = |text: &str, key: &str| text.find(key).ok_or(Trouble(format!("the case has no {key}")));
    let text = Plate { more: still, ..plate }.text("Still water");
    let [flow, fix] = [begins(&text, "[flow]")?, begins(&text, "[[fix]]")?];
    let text = (text[..flow].to_owned() + &text[fix..]).replace(&format!("aperture = {aperture:e}\n"), "");
    let still = setup.simulation("still", text)?;
    let [a, b] = [&still, &moving].map(enmm::model::Simulation::load_forces);
    let weight: f64 = still.model().mass_matrix.total.iter().map(|mass| mass * super::block::G).sum();
    let pushed = a.iter().map(|force| force.norm()).sum::<f64>() / weight;
    let apart = a.iter().zip(&b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / weight;
    Ok(Outcome {
        rows: vec![
            Row::new("forces of still water over the weight", "", pushed, 0.0),
            Row::new("greatest difference of forces over the weight", "", apart, 0.0).at_most(1e-12, ROUND_OFF),
        ],
        ..Outcome::default()
    })
}
