//! W13: a pump in a joint lowers the head, until the joint runs dry.

use super::joint_flow::{Plate, ROUND_OFF, SHARE, flows, head_at, transmissivity};
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "W13",
    title: "A pump, and a well that runs dry",
    source: "a pump at x takes Q from a joint between two equal heads H: the head there is H − Q/(T/x + T/(L − x)), \
             and no lower than the joint, where the pump gets T·H/x + T·H/(L − x); catches negative pressures and \
             pumps that take what is not there",
    parameters: &[
        Parameter::new("length", "m", 20.0, [1.0, 200.0], "length L of the joint"),
        Parameter::new("head", "m", 10.0, [0.1, 100.0], "head H at both ends over the joint"),
        Parameter::new("well", "", 0.5, [0.05, 0.95], "place x of the well over L"),
        Parameter::new("share", "", 0.25, [0.01, 1.0], "flow of the pump over what the joint can give"),
        Parameter::new("greedy", "", 3.0, [1.0, 100.0], "flow of a pump that runs dry over that"),
        Parameter::new("aperture", "m", 1e-4, [1e-5, 1e-3], "aperture of the joint"),
    ],
    quick: true,
    implicit: false,
    run,
};

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [length, head, aperture] = ["length", "head", "aperture"].map(|name| setup.get(name));
    let place = length * setup.get("well");
    let (base, height) = (0.15 * length, 0.45 * length);
    let conductance = transmissivity(aperture) * (place.recip() + (length - place).recip());
    let supply = conductance * head;
    let with = |pump: f64| {
        let ends = [[place, base + 0.1 * length], [place, base - 0.05 * length]];
        let plate = Plate {
            joints: vec![([[0.0, base], [length, base]], aperture)],
            more: format!("[[drain]]\nname = \"well\"\npoints = {ends:?}\npump = {pump:e}\n"),
            ..Plate::new([length, height], 0.065 * length)
        };
        plate.side("left", 0.0, base + head).side("right", length, base + head).text("A pump in a joint")
    };
    let (mut rows, mut marks) = (Vec::new(), Vec::new());
    for (name, share) in [("pump", setup.get("share")), ("dry", setup.get("greedy"))] {
        let found = setup.simulation(name, with(share * supply))?;
        let level = head_at(&found, [place, base])? - base;
        let exact = head * (1.0 - share.min(1.0));
        rows.push(
            Row::new(format!("{name}: head over the joint"), "m", level, exact).absolute(SHARE * head, ROUND_OFF),
        );
        let taken = flows(&found, "well")?[1];
        let row = Row::new(format!("{name}: flow"), "m²/s", taken, share.min(1.0) * supply);
        rows.push(row.relative(SHARE, ROUND_OFF));
        let told = found.dry_drains().len() as f64;
        let dry = f64::from(u8::from(share > 1.0));
        rows.push(Row::new(format!("{name}: warnings"), "", told, dry).absolute(0.0, "a count"));
        marks.push([share, level]);
    }
    let end = setup.get("greedy");
    let plot = Plot::new("Head at a pump", ["flow over what the joint can give", "head over the joint [m]"]);
    let line = vec![[0.0, head], [1.0, 0.0], [end, 0.0]];
    Ok(Outcome { rows, plots: vec![plot.line("exact", line).marks("computed", marks)] })
}
