//! C2: strength reduction of a block on an incline.

use super::incline::{G, ledger_row, reduce, trial_plot};
use crate::parts::{rock, turn};
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "C2",
    title: "Strength reduction of a block",
    source: "FoS = (c·A + W·cos a·tan φ)/(W·sin a); catches a wrong contact length, locked-in shear, a judge of \
             stability that takes elastic motion for failure or slow failure for rest",
    parameters: &[
        Parameter::new("a_deg", "°", 30.0, [5.0, 55.0], "dip of the plane"),
        Parameter::new("length", "m", 4.0, [0.5, 50.0], "length along the plane"),
        Parameter::new("height", "m", 2.0, [0.2, 20.0], "height above the plane, below length/tan a: no toppling"),
        Parameter::new("gamma", "N/m³", 25e3, [5e3, 5e4], "unit weight"),
        Parameter::new("phi_deg", "°", 40.0, [1.0, 70.0], "friction of the first block"),
        Parameter::new("phi_c_deg", "°", 35.0, [0.0, 60.0], "friction with cohesion"),
        Parameter::new("cohesion", "Pa", 20e3, [1.0, 1e6], "cohesion"),
        Parameter::new("phi_weak_deg", "°", 25.0, [1.0, 60.0], "friction too small"),
        Parameter::new("young", "Pa", 5e9, [1e8, 1e11], "Young's modulus of the rock"),
        Parameter::new("mesh", "", 0.45, [0.1, 1.0], "mesh size over block height"),
    ],
    quick: true,
    implicit: true,
    run,
};

/// (c·A + W·cos a·tan φ)/(W·sin a) of a block of weight `weight` (N/m) on `length` (m); angles in radians.
fn exact(a: f64, phi: f64, cohesion: f64, length: f64, weight: f64) -> f64 {
    (cohesion * length + weight * a.cos() * phi.tan()) / (weight * a.sin())
}

/// The case. A cohesive joint has as much tensile strength: where the resultant leaves the middle third of the base,
/// the heel would open and lose the cohesion that the formula counts on.
fn text(setup: &Setup, phi_deg: f64, cohesion: f64) -> String {
    let [a, long, high] = ["a_deg", "length", "height"].map(|name| setup.get(name));
    let corners = [
        [-0.5 * long, -high],
        [2.0 * long, -high],
        [2.0 * long, 0.0],
        [long, 0.0],
        [long, high],
        [0.0, high],
        [0.0, 0.0],
        [-0.5 * long, 0.0],
    ];
    format!(
        "title = \"Block on an incline: strength reduction\"\n[domain]\noutline = {:?}\n[mesh]\nsize = {:e}\n\
         origin = [0.031, 0.017]\n[[joint]]\npoints = {:?}\n[joint_law.joint]\nfriction_deg = {phi_deg:?}\n\
         cohesion = {cohesion:e}\ntension = {cohesion:e}\nresidual_tension = {cohesion:e}\n\
         [[fix]]\nblock = {:?}\n{}[[stage]]\nname = \"settle\"\nkind = \"static\"\n\
         duration = {:e}\n",
        turn(&corners, -a),
        setup.get("mesh") * high,
        turn(&[[0.0, 0.0], [long, 0.0]], -a),
        turn(&[[-0.25 * long, -0.5 * high]], -a)[0],
        rock(setup.get("young"), setup.get("gamma") / G),
        5.0 * (5e9 / setup.get("young")).sqrt().max(1.0),
    )
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [a, long, high] = ["a_deg", "length", "height"].map(|name| setup.get(name));
    let weight = setup.get("gamma") * long * high;
    if a.to_radians().tan() > long / high {
        return Err(Trouble("the block topples: choose a height below length/tan a".to_owned()));
    }
    let variants = [
        ("friction alone", setup.get("phi_deg"), 0.0),
        ("friction and cohesion", setup.get("phi_c_deg"), setup.get("cohesion")),
        ("a block that slides by itself", setup.get("phi_weak_deg"), 0.0),
    ];
    let mut outcome = Outcome::default();
    let mut reductions = Vec::new();
    let mut marks = Vec::new();
    for (name, phi, cohesion) in variants {
        let exact = exact(a.to_radians(), phi.to_radians(), cohesion, long, weight);
        let reduction = reduce(setup, &name.replace(' ', "_"), text(setup, phi, cohesion))?;
        let found = reduction.factor().unwrap_or(f64::NAN);
        let reason = "half of a bracket that is 0.2 % wide (0.5 % when quick), and contact lengths add up to 0.1 %";
        let row = Row::new(format!("factor of safety, {name}"), "", found, exact);
        outcome.rows.push(row.relative(5e-3, reason));
        marks.push([phi.to_radians().tan(), found]);
        if reductions.is_empty() {
            outcome.plots.push(trial_plot("Trials, friction alone", &reduction, exact));
        }
        reductions.push(reduction);
    }
    outcome.rows.push(ledger_row(&reductions.iter().collect::<Vec<_>>()));
    outcome.plots.push(curves(a.to_radians(), setup.get("cohesion"), long, weight, marks));
    Ok(outcome)
}

fn curves(a: f64, cohesion: f64, long: f64, weight: f64, marks: Vec<[f64; 2]>) -> Plot {
    let line = |cohesion: f64| -> Vec<[f64; 2]> {
        let points = (0..=60).map(|k| f64::from(k) / 60.0).map(|t| [t, exact(a, t.atan(), cohesion, long, weight)]);
        points.collect()
    };
    Plot::new("Factor of safety of a block", ["tan φ", "factor of safety"])
        .line("exact, no cohesion", line(0.0))
        .line("exact, with cohesion", line(cohesion))
        .marks("computed", marks)
}

#[cfg(test)]
mod tests {
    use super::exact;

    #[test]
    fn the_formula_gives_the_published_numbers() {
        let a = 30f64.to_radians();
        assert!((exact(a, 40f64.to_radians(), 0.0, 4.0, 1.0) - 1.453363).abs() < 1e-6);
        assert!((exact(a, 35f64.to_radians(), 20e3, 4.0, 25e3 * 8.0) - 2.012795).abs() < 1e-6);
    }
}
