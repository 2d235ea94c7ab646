//! F1: limit analysis of a block on an incline.

use super::limit::{Scene, bound_of, factor_rows};
use crate::{Outcome, Parameter, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "F1",
    title: "Limit analysis: block on an incline",
    source: "tan φ/tan a, and the direction in which the block leaves, φ/F above the plane; catches wrong weights, \
             normals and multipliers",
    parameters: &[
        Parameter::new("a_deg", "°", 30.0, [5.0, 60.0], "dip of the plane"),
        Parameter::new("phi_deg", "°", 35.0, [1.0, 70.0], "friction"),
        Parameter::new("length", "m", 4.0, [0.5, 50.0], "length along the plane"),
        Parameter::new("height", "m", 2.0, [0.2, 20.0], "height, below length/tan a: no toppling"),
        Parameter::new("gamma", "N/m³", 25e3, [5e3, 5e4], "unit weight"),
    ],
    quick: true,
    implicit: false,
    run,
};

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [a, phi] = ["a_deg", "phi_deg"].map(|name| setup.get(name));
    let scene = Scene::block(setup, 0.0)?;
    let bound = bound_of(setup, "block_on_incline", scene.text("Limit analysis of a block on an incline"))?;
    let mut rows = factor_rows("", &bound, phi.to_radians().tan() / a.to_radians().tan()).to_vec();
    // At the limit the reduced friction angle is the dip: the block that dilates by it leaves level.
    let leaves = bound.associated.mechanism.first().map_or(f64::NAN, |block| block.velocity.y.atan2(block.velocity.x));
    let reason = "the mechanism is that of a factor within 2e-5 of the limit";
    rows.push(Row::new("direction of the block from level", "rad", leaves, 0.0).at_most(1e-4, reason));
    Ok(Outcome { rows, ..Outcome::default() })
}
