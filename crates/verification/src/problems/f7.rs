//! F7: limit analysis of a block whose front lies over a joint of its base.

use super::limit::{Scene, block_on_plane, bound_of, endless_row, factor_rows};
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
    let [a, phi, length, height] = ["a_deg", "phi_deg", "length", "height"].map(|name| setup.get(name));
    let [tan_a, tan_phi] = [a, phi].map(|angle| angle.to_radians().tan());
    if tan_a > length / height {
        return Err(Trouble("the block topples: choose a height below length/tan a".to_owned()));
    }
    let (outline, joint) = block_on_plane(length, height);
    let foot = [length + setup.get("lean") * height, -height];
    let scene = Scene {
        dip_deg: a,
        outline,
        joints: vec![(joint, "joint"), (vec![[length, 0.0], foot], "joint")],
        laws: vec![("joint", phi, 0.0)],
        held: vec![[-0.25 * length, -0.5 * height], [1.9 * length, -0.5 * height]],
        unit_weight: setup.get("gamma"),
        seismic: 0.0,
        size: 0.45 * height,
    };
    let bound = bound_of(setup, "block_over_crossing", scene.text("Limit analysis of a block over a crossing"))?;
    let mut rows = factor_rows("", &bound, tan_phi / tan_a).to_vec();
    rows.push(endless_row("factor when every corner catches", bound.catching.factor.value()));
    Ok(Outcome { rows, ..Outcome::default() })
}
