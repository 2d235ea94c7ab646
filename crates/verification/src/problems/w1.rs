//! W1: water in one joint, in two in series and in three that meet.

use super::joint_flow::{Plate, ROUND_OFF, SHARE, flows, head_at, transmissivity};
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "W1",
    title: "Flow in joints: one, two in series, three that meet",
    source: "cubic law q = γe³/12μ·Δh/L and Kirchhoff's law: flows in series are one, those that meet sum to none; \
             catches pieces that do not meet at their ends, wrong lengths and apertures of another law",
    parameters: &[
        Parameter::new("length", "m", 10.0, [1.0, 200.0], "length of the level joint"),
        Parameter::new("left", "", 9.0, [6.0, 100.0], "head at its left end over its length/10"),
        Parameter::new("right", "", 6.5, [6.0, 100.0], "head at its right end over its length/10"),
        Parameter::new("below", "", 6.2, [6.0, 100.0], "head at the foot of the joint that meets it, over length/10"),
        Parameter::new("aperture", "m", 1e-4, [1e-5, 1e-3], "aperture of its left part"),
        Parameter::new("ratio", "", 2.0, [0.1, 10.0], "aperture of its right part over that"),
        Parameter::new("meets", "", 0.3, [0.1, 0.9], "place where both meet over its length"),
    ],
    quick: true,
    implicit: false,
    run,
};

/// Height of the joint and of the plate over a tenth of the length.
const HEIGHTS: [f64; 2] = [5.0, 7.0];

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [length, aperture, meets] = ["length", "aperture", "meets"].map(|name| setup.get(name));
    let unit = 0.1 * length;
    let [left, right, below] = ["left", "right", "below"].map(|name| unit * setup.get(name));
    let (y, middle) = (unit * HEIGHTS[0], meets * length);
    let apertures = [aperture, aperture * setup.get("ratio")];
    let conductance = |aperture: f64, length: f64| transmissivity(aperture) / length;
    let plate =
        Plate::new([length, unit * HEIGHTS[1]], 0.9 * unit).side("left", 0.0, left).side("right", length, right);
    let parts = |apertures: [f64; 2]| {
        let ends = [[0.0, y], [middle, y], [length, y]];
        vec![([ends[0], ends[1]], apertures[0]), ([ends[1], ends[2]], apertures[1])]
    };
    let mut rows = Vec::new();
    let mut row = |name: &str, unit, found: f64, exact: f64| {
        rows.push(Row::new(name, unit, found, exact).relative(SHARE, ROUND_OFF));
    };
    let one = Plate { joints: parts([aperture; 2]), ..plate.clone() };
    let found = setup.simulation("one_joint", one.text("Water in one joint"))?;
    let [enters, leaves, _] = flows(&found, "left")?;
    row("one joint: flow", "m²/s", enters - leaves, conductance(aperture, length) * (left - right));
    let two = Plate { joints: parts(apertures), ..plate.clone() };
    let found = setup.simulation("two_joints", two.text("Water in two joints in series"))?;
    let [g, k] = [conductance(apertures[0], middle), conductance(apertures[1], length - middle)];
    let [enters, leaves, _] = flows(&found, "left")?;
    row("two in series: flow", "m²/s", enters - leaves, (left - right) / (g.recip() + k.recip()));
    let head = head_at(&found, [middle, y])?;
    row("two in series: head where they meet", "m", head, (g * left + k * right) / (g + k));
    let mut three = Plate { joints: parts(apertures), ..plate };
    three.joints.push(([[middle, 0.0], [middle, y]], aperture));
    three.heads.push(("below", [[0.0, 0.0], [length, 0.0]], below));
    // The base is one of the heads, so that corners of the sides have another.
    three.heads.iter_mut().take(2).for_each(|(_, edge, _)| edge[0][1] = 0.5 * y);
    let found = setup.simulation("three_joints", three.text("Water in three joints that meet"))?;
    let down = conductance(aperture, y);
    let exact = (g * left + k * right + down * below) / (g + k + down);
    row("three that meet: head there", "m", head_at(&found, [middle, y])?, exact);
    for (name, conductance, level) in [("left", g, left), ("right", k, right), ("below", down, below)] {
        let [enters, leaves, _] = flows(&found, name)?;
        row(&format!("three that meet: flow from {name}"), "m²/s", enters - leaves, conductance * (level - exact));
    }
    let series = (g * left + k * right) / (g + k);
    let line = vec![[0.0, left], [middle, series], [length, right]];
    let marks = vec![[0.0, left], [middle, head], [length, right]];
    let plot = Plot::new("Head along two joints in series", ["place [m]", "head [m]"]);
    Ok(Outcome { rows, plots: vec![plot.line("exact", line).marks("computed", marks)] })
}
