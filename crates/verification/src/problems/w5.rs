//! W5: rain on joints: what they take, what runs off, and the mound that stands under it.

use super::joint_flow::{Plate, ROUND_OFF, SHARE, flows, head_at, heads_at, transmissivity};
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "W5",
    title: "Rain: film, run-off and the mound below it",
    source: "an upright joint takes rain up to its transmissivity T, with unit gradient, and the rest runs off; beside \
             a river an aquifer under rain w has h² = H² + w(L² − x²)/K (J. Dupuit); catches rain that is lost or \
             taken twice, and films that carry pressure",
    parameters: &[
        Parameter::new("aperture", "m", 1e-4, [1e-5, 1e-3], "aperture of all joints"),
        Parameter::new("share", "", 0.3, [0.0, 1.0], "gentle rain over what the joint can take"),
        Parameter::new("storm", "", 2.5, [1.0, 100.0], "storm over what the joint can take"),
        Parameter::new("length", "", 20.0, [5.0, 60.0], "length L of the aquifer over the spacing of joints"),
        Parameter::new("river", "", 4.0, [1.0, 20.0], "level H of the river over the spacing"),
        Parameter::new("mound", "", 6.0, [1.0, 30.0], "level at the far end over the spacing, above the river"),
    ],
    quick: true,
    implicit: false,
    run,
};

/// Rain (m/s) on top of a plate.
fn rain([w, h]: [f64; 2], rate: f64) -> String {
    format!("[[rain]]\nname = \"sky\"\nedge = [[0.0, {h:?}], [{w:?}, {h:?}]]\nrate = {rate:e}\n")
}

/// A plate with one upright joint in rain, which is free at its foot.
fn joint(aperture: f64, rate: f64) -> String {
    let size = [10.0, 8.0];
    let plate =
        Plate { joints: vec![([[3.0, 0.0], [3.0, 8.0]], aperture)], more: rain(size, rate), ..Plate::new(size, 0.9) };
    // Held at its sides: water leaves through the base.
    let text = plate.text("Joint in rain");
    let base = "edge = [[0.0, 0.0], [10.0, 0.0]]\n";
    text.replacen(base, "edge = [[0.0, 0.0], [0.0, 8.0]]\n[[fix]]\nedge = [[10.0, 0.0], [10.0, 8.0]]\n", 1)
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let aperture = setup.get("aperture");
    let t = transmissivity(aperture);
    let mut rows = Vec::new();
    for (name, share) in [("gentle rain", setup.get("share")), ("storm", setup.get("storm"))] {
        let file = name.replace(' ', "_");
        let found = setup.simulation(&file, joint(aperture, share * t / 10.0))?;
        let [enters, _, off] = flows(&found, "sky")?;
        let taken = share.min(1.0) * t;
        // Shares of T, since one of both may be none.
        let mut row = |what: &str, found: f64, exact: f64| {
            rows.push(Row::new(format!("{name}: {what} over T"), "", found / t, exact / t).absolute(SHARE, ROUND_OFF));
        };
        row("rain that enters", enters, taken);
        row("rain that runs off", off, share * t - taken);
        row("water that leaves below", flows(&found, "air")?[1], taken);
        let [_, pressure] = heads_at(&found, [3.0, 4.0])?;
        rows.push(Row::new(format!("{name}: pressure head halfway"), "m", pressure, 0.0).at_most(SHARE, ROUND_OFF));
    }
    let [length, river, mound] = ["length", "river", "mound"].map(|name| setup.get(name).round());
    if mound <= river {
        return Err(Trouble("mound must be above river".to_owned()));
    }
    // K = T over a spacing of 1 m.
    let rate = t * (mound * mound - river * river) / (length * length);
    let size = [length, mound + 2.0];
    let middle = |k: u32| f64::from(k) + 0.5;
    let level = (0..size[1] as u32).map(|k| ([[0.0, middle(k)], [length, middle(k)]], aperture));
    let upright = (0..length as u32).map(|k| ([[middle(k), 0.0], [middle(k), size[1]]], aperture));
    let left = format!("[[fix]]\nedge = [[0.0, 0.0], [0.0, {:?}]]\naxes = \"x\"\n", size[1]);
    let plate =
        Plate { joints: level.chain(upright).collect(), more: rain(size, rate) + &left, ..Plate::new(size, 0.9) };
    let found = setup.simulation("mound", plate.side("river", length, river).text("Mound under rain"))?;
    let exact = |x: f64| (mound * mound - (mound * mound - river * river) * (x / length).powi(2)).sqrt();
    let reason = "Dupuit has no vertical flow, and ends at the river without a seepage face";
    let mut marks = Vec::new();
    for k in 0..length as u32 {
        marks.push([middle(k), head_at(&found, [middle(k), 0.5])?]);
    }
    for (name, k) in [("far end", 0), ("middle", length as usize / 2)] {
        let [x, head] = marks[k];
        rows.push(Row::new(format!("mound: head at the {name}"), "m", head, exact(x)).relative(0.02, reason));
    }
    let entered = flows(&found, "sky")?[0];
    rows.push(Row::new("mound: rain that enters", "m²/s", entered, rate * length).relative(SHARE, ROUND_OFF));
    let line = (0..=40).map(|k| f64::from(k) * length / 40.0).map(|x| [x, exact(x)]).collect();
    let plot = Plot::new("Mound under rain", ["place [m]", "head [m]"]).line("Dupuit", line).marks("computed", marks);
    Ok(Outcome { rows, plots: vec![plot] })
}
