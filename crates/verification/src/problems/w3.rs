//! W3: uplift of a dam on a joint, with and without a drain.

use super::joint_flow::{Plate, ROUND_OFF, SHARE, WEIGHT, flows, push_on, transmissivity};
use crate::{Outcome, Parameter, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "W3",
    title: "Uplift below a dam, and a drain",
    source: "pressure falls in a straight line from heel to toe, so that the uplift is γHB/2, and with a drain at x \
             from the heel γHx/2, while the drain takes T·H/x; catches pressures on the wrong face, drains that miss \
             joints and drains that leave pressure behind them",
    parameters: &[
        Parameter::new("width", "m", 20.0, [2.0, 200.0], "width B of the dam"),
        Parameter::new("head", "m", 12.0, [0.1, 200.0], "head H at the heel over the joint; none at the toe"),
        Parameter::new("drain", "", 0.25, [0.05, 0.9], "place x of the drain over B"),
        Parameter::new("aperture", "m", 1e-4, [1e-5, 1e-3], "aperture of the joint"),
    ],
    quick: true,
    implicit: false,
    run,
};

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [width, head, aperture] = ["width", "head", "aperture"].map(|name| setup.get(name));
    let place = width * setup.get("drain");
    let (base, height) = (0.15 * width, 0.45 * width);
    let plate = Plate {
        joints: vec![([[0.0, base], [width, base]], aperture)],
        more: format!("[[fix]]\nedge = [[0.0, {base:?}], [0.0, {height:?}]]\n"),
        ..Plate::new([width, height], 0.065 * width)
    };
    let plate = plate.side("heel", 0.0, base + head).side("toe", width, base);
    let inside = [0.5 * width, 0.5 * (base + height)];
    let mut rows = Vec::new();
    let mut row = |name: &str, unit, found: f64, exact: f64| {
        rows.push(Row::new(name, unit, found, exact).relative(SHARE, ROUND_OFF));
    };
    let whole = setup.simulation("dam", plate.text("Dam on a joint"))?;
    row("uplift", "N/m", push_on(&whole, inside)?.y, 0.5 * WEIGHT * head * width);
    row("flow", "m²/s", flows(&whole, "toe")?[1] + flows(&whole, "air")?[1], transmissivity(aperture) * head / width);
    let ends = [[place, base - 0.05 * width], [place, base + 0.1 * width]];
    let drained =
        Plate { more: plate.more.clone() + &format!("[[drain]]\nname = \"row\"\npoints = {ends:?}\n"), ..plate };
    let drained = setup.simulation("dam_with_drain", drained.text("Dam on a joint with a drain"))?;
    row("uplift with a drain", "N/m", push_on(&drained, inside)?.y, 0.5 * WEIGHT * head * place);
    row("flow of the drain", "m²/s", flows(&drained, "row")?[1], transmissivity(aperture) * head / place);
    Ok(Outcome { rows, ..Outcome::default() })
}
