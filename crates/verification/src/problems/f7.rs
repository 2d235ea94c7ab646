//! F7: limit analysis of a block whose front lies over a joint of its base.

use super::limit::{Scene, bound_of, endless_row, factor_rows};
use crate::{Outcome, Parameter, Problem, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "F7",
    title: "Limit analysis: block over a crossing with level tops",
    source: "a joint of the base ends below the front of a block: the tops of both pieces are level and let the block \
             pass, tan φ/tan a; held to both facets of the corner that it faces there it would never move; catches \
             facets on the wrong side and corners that catch",
    parameters: &[
        Parameter::new("a_deg", "°", 30.0, [5.0, 45.0], "dip of the plane"),
        Parameter::new("phi_deg", "°", 35.0, [1.0, 70.0], "friction"),
        Parameter::new("length", "m", 4.0, [0.5, 50.0], "length of the block"),
        Parameter::new("height", "m", 2.0, [0.2, 20.0], "height, below length/tan a: no toppling"),
        Parameter::new("lean", "", 0.0, [0.0, 0.5], "cot of the joint to the plane"),
        Parameter::new("gamma", "N/m³", 25e3, [5e3, 5e4], "unit weight"),
    ],
    quick: true,
    implicit: false,
    run,
};

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [tan_a, tan_phi] = ["a_deg", "phi_deg"].map(|name| setup.get(name).to_radians().tan());
    let [length, height, lean] = ["length", "height", "lean"].map(|name| setup.get(name));
    let mut scene = Scene::block(setup, 0.0)?;
    scene.joints.push((vec![[length, 0.0], [length + lean * height, -height]], "joint"));
    scene.held.push([1.9 * length, -0.5 * height]);
    let bound = bound_of(setup, "block_over_crossing", scene.text("Limit analysis of a block over a crossing"))?;
    let mut rows = factor_rows("", &bound, tan_phi / tan_a).to_vec();
    rows.push(endless_row("factor when every corner catches", bound.catching.factor.value()));
    Ok(Outcome { rows, ..Outcome::default() })
}
