//! F2: limit analysis of a block held by cohesion.

use super::limit::{Scene, bound_of, factor_rows};
use crate::{Outcome, Parameter, Problem, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "F2",
    title: "Limit analysis: block with cohesion",
    source: "(c·L + W·cos a·tan φ)/(W·sin a); catches a wrong length, or cohesion that is not divided by the factor",
    parameters: &[
        Parameter::new("a_deg", "°", 30.0, [5.0, 60.0], "dip of the plane"),
        Parameter::new("phi_deg", "°", 35.0, [0.0, 70.0], "friction"),
        Parameter::new("cohesion", "Pa", 20e3, [0.0, 1e6], "cohesion"),
        Parameter::new("length", "m", 4.0, [0.5, 50.0], "length along the plane"),
        Parameter::new("height", "m", 2.0, [0.2, 20.0], "height, below length/tan a: no toppling"),
        Parameter::new("gamma", "N/m³", 25e3, [5e3, 5e4], "unit weight"),
    ],
    quick: true,
    implicit: false,
    run,
};

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [a, phi, cohesion] = ["a_deg", "phi_deg", "cohesion"].map(|name| setup.get(name));
    let [length, height, unit_weight] = ["length", "height", "gamma"].map(|name| setup.get(name));
    let scene = Scene::block(setup, cohesion)?;
    let (s, c) = a.to_radians().sin_cos();
    let weight = unit_weight * length * height;
    let exact = (cohesion * length + weight * c * phi.to_radians().tan()) / (weight * s);
    let bound = bound_of(setup, "block_with_cohesion", scene.text("Limit analysis of a block with cohesion"))?;
    Ok(Outcome { rows: factor_rows("", &bound, exact).to_vec(), ..Outcome::default() })
}
