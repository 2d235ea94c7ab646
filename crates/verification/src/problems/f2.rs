//! F2: limit analysis of a block held by cohesion.

use super::limit::{Scene, block_on_plane, bound_of, factor_rows};
use crate::{Outcome, Parameter, Problem, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "F2",
    title: "Limit analysis: block with cohesion",
    source: "(c·L + W·cos a·tan φ)/(W·sin a); catches a wrong length, or cohesion that is not divided by the factor",
    parameters: &[
        Parameter { name: "a_deg", unit: "°", default: 30.0, range: [5.0, 60.0], doc: "dip of the plane" },
        Parameter { name: "phi_deg", unit: "°", default: 35.0, range: [0.0, 70.0], doc: "friction" },
        Parameter { name: "cohesion", unit: "Pa", default: 20e3, range: [0.0, 1e6], doc: "cohesion" },
        Parameter { name: "length", unit: "m", default: 4.0, range: [0.5, 50.0], doc: "length along the plane" },
        Parameter {
            name: "height",
            unit: "m",
            default: 2.0,
            range: [0.2, 20.0],
            doc: "height, below length/tan a: no toppling",
        },
        Parameter { name: "gamma", unit: "N/m³", default: 25e3, range: [5e3, 5e4], doc: "unit weight" },
    ],
    quick: true,
    implicit: false,
    run,
};

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [a, phi, cohesion] = ["a_deg", "phi_deg", "cohesion"].map(|name| setup.get(name));
    let [length, height, unit_weight] = ["length", "height", "gamma"].map(|name| setup.get(name));
    let (outline, joint) = block_on_plane(length, height);
    let scene = Scene {
        dip_deg: a,
        outline,
        joints: vec![(joint, "joint")],
        laws: vec![("joint", phi, cohesion)],
        held: vec![[-0.25 * length, -0.5 * height]],
        unit_weight,
        seismic: 0.0,
        size: 0.45 * height,
    };
    let (s, c) = a.to_radians().sin_cos();
    if s / c > length / height {
        return Err(Trouble("the block topples: choose a height below length/tan a".to_owned()));
    }
    let weight = unit_weight * length * height;
    let exact = (cohesion * length + weight * c * phi.to_radians().tan()) / (weight * s);
    let bound = bound_of(setup, "block_with_cohesion", scene.text("Limit analysis of a block with cohesion"))?;
    Ok(Outcome { rows: factor_rows("", &bound, exact).to_vec(), ..Outcome::default() })
}
