//! F3: limit analysis of two blocks that lean on each other.

use super::limit::{Scene, block_on_plane, bound_of, factor_rows};
use crate::{Outcome, Parameter, Problem, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "F3",
    title: "Limit analysis: two blocks with two frictions",
    source: "(W1·tan φ1 + W2·tan φ2)/((W1 + W2)·tan a) for a smooth joint between them, when the upper block has less \
             friction; catches forces that act on one block only",
    parameters: &[
        Parameter::new("a_deg", "°", 30.0, [5.0, 60.0], "dip of the plane"),
        Parameter::new("phi_1_deg", "°", 20.0, [0.0, 70.0], "friction, upper block"),
        Parameter::new("phi_2_deg", "°", 40.0, [1.0, 70.0], "friction, lower block"),
        Parameter::new("length_1", "m", 3.0, [0.5, 50.0], "length of the upper block"),
        Parameter::new("length_2", "m", 4.0, [0.5, 50.0], "length of the lower block"),
        Parameter::new("height", "m", 1.5, [0.2, 20.0], "height of both"),
        Parameter::new("gamma", "N/m³", 25e3, [5e3, 5e4], "unit weight"),
    ],
    quick: true,
    implicit: false,
    run,
};

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [a, phi_1, phi_2] = ["a_deg", "phi_1_deg", "phi_2_deg"].map(|name| setup.get(name));
    let [upper, lower, height] = ["length_1", "length_2", "height"].map(|name| setup.get(name));
    let [tan_1, tan_2, tan_a] = [phi_1, phi_2, a].map(|angle| angle.to_radians().tan());
    if phi_1 > phi_2 || 2.0 * height * tan_a > upper.min(lower) * 2.0 {
        return Err(Trouble("choose phi_1_deg at most phi_2_deg, and blocks too low to topple".to_owned()));
    }
    let (outline, _) = block_on_plane(upper + lower, height);
    let scene = Scene {
        dip_deg: a,
        outline,
        joints: vec![
            (vec![[0.0, 0.0], [upper, 0.0]], "upper"),
            (vec![[upper, 0.0], [upper + lower, 0.0]], "lower"),
            (vec![[upper, 0.0], [upper, height]], "smooth"),
        ],
        laws: vec![("upper", phi_1, 0.0), ("lower", phi_2, 0.0), ("smooth", 0.0, 0.0)],
        held: vec![[-0.25 * upper, -0.5 * height]],
        unit_weight: setup.get("gamma"),
        seismic: 0.0,
        size: 0.45 * height,
    };
    let exact = (upper * tan_1 + lower * tan_2) / ((upper + lower) * tan_a);
    let bound = bound_of(setup, "two_blocks", scene.text("Limit analysis of two blocks with two frictions"))?;
    Ok(Outcome { rows: factor_rows("", &bound, exact).to_vec(), ..Outcome::default() })
}
