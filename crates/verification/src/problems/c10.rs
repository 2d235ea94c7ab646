//! C10: a high slope with joints that daylight in its face.

use super::incline::{G, factor_row, ledger_row, reduce, trial_plot};
use super::plane_slide::PlaneSlide;
use crate::{Outcome, Parameter, Problem, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "C10",
    title: "Slope with daylighting joints",
    source: "limit equilibrium of the wedge above the joint through the toe, (cA + W·cos ψ·tan φ)/(W·sin ψ), which is \
             the least of all parallel joints; once with that joint alone, once with a set above it",
    parameters: &[
        Parameter::new("height", "m", 260.0, [10.0, 1000.0], "height of the slope"),
        Parameter::new("face_deg", "°", 55.0, [20.0, 80.0], "dip of the face"),
        Parameter::new("joint_deg", "°", 35.0, [10.0, 70.0], "dip of the joints"),
        Parameter::new("cohesion", "Pa", 1e5, [0.0, 1e7], "cohesion of the joints"),
        Parameter::new("phi_deg", "°", 40.0, [1.0, 70.0], "friction of the joints"),
        Parameter::new("density", "kg/m³", 2660.0, [1e3, 4e3], "density of the rock"),
        Parameter::new("joints", "", 4.0, [1.0, 20.0], "joints of the set"),
        Parameter::new("spacing", "m", 20.0, [1.0, 200.0], "distance of the joints"),
        Parameter::new("young", "Pa", 5e10, [1e9, 2e11], "Young's modulus of the rock"),
        Parameter::new("mesh", "", 0.12, [0.02, 0.3], "mesh size over height"),
    ],
    quick: true,
    implicit: false,
    run,
};

fn slide(setup: &Setup, planes: u32) -> PlaneSlide {
    let slide = PlaneSlide::of(setup, setup.get("joint_deg"), setup.get("density") * G);
    let size = setup.get("mesh") * slide.height;
    PlaneSlide { young: setup.get("young"), size, planes, spacing: setup.get("spacing"), ..slide }
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    if !slide(setup, 1).is_sound() {
        return Err(Trouble("the joint through the toe must daylight: choose joint_deg below face_deg".to_owned()));
    }
    let count = setup.get("joints") as u32;
    let mut outcome = Outcome::default();
    let mut found = Vec::new();
    for planes in [1, count] {
        if planes == 1 && !found.is_empty() || planes > 1 && setup.quick {
            continue;
        }
        let model = slide(setup, planes);
        let name =
            if planes == 1 { "joint through the toe alone".to_owned() } else { format!("set of {planes} joints") };
        let reduction = reduce(setup, &name.replace(' ', "_"), model.text("Slope with daylighting joints"))?;
        let reason = "bracket of 0.2 % (0.5 % when quick); the wedge is elastic and ends in sharp corners";
        outcome.rows.push(factor_row(&format!("factor of safety, {name}"), &reduction, model.factor(), reason));
        outcome.plots.push(trial_plot(&format!("Trials, {name}"), &reduction, model.factor()));
        found.push(reduction);
    }
    outcome.rows.push(ledger_row(&found.iter().collect::<Vec<_>>()));
    Ok(outcome)
}
