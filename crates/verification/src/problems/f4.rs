//! F4: limit analysis of a wedge in a notch.

use super::limit::{Scene, bound_of, endless_row, factor_rows};
use crate::{Outcome, Parameter, Problem, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "F4",
    title: "Limit analysis: wedge in a notch",
    source: "a wedge in a notch whose sides dip by b rests without any friction; under a horizontal acceleration k·g \
             it rides up one side for tan φ/F = tan(atan k − b); catches a search without end, and corners in a notch \
             that press on one side only",
    parameters: &[
        Parameter::new("b_deg", "°", 30.0, [5.0, 60.0], "dip of both sides"),
        Parameter::new("phi_deg", "°", 20.0, [1.0, 70.0], "friction"),
        Parameter::new("k", "", 0.9, [0.1, 5.0], "acceleration over g, above tan b"),
        Parameter::new("depth", "m", 3.0, [0.5, 50.0], "depth of the notch"),
        Parameter::new("gamma", "N/m³", 25e3, [5e3, 5e4], "unit weight"),
    ],
    quick: true,
    implicit: false,
    run,
};

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [b, phi, k, depth] = ["b_deg", "phi_deg", "k", "depth"].map(|name| setup.get(name));
    let half = depth / b.to_radians().tan();
    let rides = (k.atan() - b.to_radians()).tan();
    if rides <= 0.0 {
        return Err(Trouble("without friction the wedge rests: choose k above tan b".to_owned()));
    }
    let scene = |seismic: f64| Scene {
        dip_deg: 0.0,
        outline: vec![[-2.0 * half, -depth], [2.0 * half, -depth], [2.0 * half, depth], [-2.0 * half, depth]],
        joints: vec![(vec![[-half, depth], [0.0, 0.0], [half, depth]], "joint")],
        laws: vec![("joint", phi, 0.0)],
        held: vec![[0.0, -0.5 * depth]],
        unit_weight: setup.get("gamma"),
        seismic,
        size: 0.45 * depth,
    };
    let texts = [scene(0.0), scene(k)].map(|scene| scene.text("Limit analysis of a wedge in a notch"));
    let [still, shaken] = texts;
    let still = bound_of(setup, "wedge_at_rest", still)?;
    let shaken = bound_of(setup, "wedge_that_rides_up", shaken)?;
    let mut rows = vec![
        endless_row("associated factor, at rest", still.associated.factor.value()),
        endless_row("level tops' factor, at rest", still.level_tops.factor.value()),
    ];
    rows.extend(factor_rows(", riding up", &shaken, phi.to_radians().tan() / rides));
    Ok(Outcome { rows, ..Outcome::default() })
}
