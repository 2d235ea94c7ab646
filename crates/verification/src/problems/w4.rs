//! W4: seepage through a net of joints between two levels, with a seepage face.

use super::joint_flow::{Plate, flows, head_at, transmissivity};
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "W4",
    title: "Seepage through a net of joints with a seepage face",
    source: "I. A. Charny (1951), as proof of J. Dupuit: Q = K·(H1² − H2²)/2L whatever the free surface, here exact at \
             every spacing, because sums over level joints are the integrals; catches free surfaces, seepage faces \
             and films that are wrong, which change the flow",
    parameters: &[
        Parameter::new("length", "m", 20.0, [2.0, 200.0], "length L"),
        Parameter::new("upper", "", 10.0, [2.0, 40.0], "level H1 over the greatest spacing, a whole number"),
        Parameter::new("lower", "", 2.0, [0.0, 39.0], "level H2 over the greatest spacing, a whole number below"),
        Parameter::new("spacing", "m", 1.0, [0.1, 10.0], "greatest spacing of the joints"),
        Parameter::new("conductivity", "m/s", 1e-6, [1e-10, 1e-2], "conductivity K of the net"),
    ],
    quick: true,
    implicit: false,
    run,
};

/// Why flows may differ.
const REASON: &str = "the rounding of heads in thousands of joints, and the tolerance of the flow, 1e-12 of its terms";

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [length, spacing, conductivity] = ["length", "spacing", "conductivity"].map(|name| setup.get(name));
    let [upper, lower] = ["upper", "lower"].map(|name| spacing * setup.get(name).round());
    if lower >= upper || length < spacing {
        return Err(Trouble("lower must be below upper, and length at least the spacing".to_owned()));
    }
    let exact = conductivity * (upper * upper - lower * lower) / (2.0 * length);
    let (mut rows, mut plots) = (Vec::new(), Vec::new());
    for finer in if setup.quick { &[1.0][..] } else { &[1.0, 2.0][..] } {
        let apart = spacing / finer;
        let height = upper + spacing;
        // Transmissivity K·s of joints at a distance s.
        let aperture = (conductivity * apart / transmissivity(1.0)).cbrt();
        let places = |to: f64| {
            let count = (to / apart).round().max(1.0);
            (0..count as u32).map(move |k| (f64::from(k) + 0.5) * to / count)
        };
        let level = places(height).map(|y| ([[0.0, y], [length, y]], aperture));
        let upright = places(length).map(|x| ([[x, 0.0], [x, height]], aperture));
        let plate = Plate { joints: level.chain(upright).collect(), ..Plate::new([length, height], 0.9 * apart) };
        let text = plate.side("upper", 0.0, upper).side("lower", length, lower).text("Seepage through a net of joints");
        let found = setup.simulation(&format!("net_{finer}"), text)?;
        let [enters, leaves, _] = flows(&found, "upper")?;
        let name = format!("flow, joints every {apart} m");
        rows.push(Row::new(name, "m²/s", enters - leaves, exact).relative(1e-10, REASON));
        if *finer == 1.0 {
            let foot = 0.5 * apart;
            let heads: Result<Vec<_>, Trouble> = places(length).map(|x| Ok([x, head_at(&found, [x, foot])?])).collect();
            let dupuit = |x: f64| (upper * upper - (upper * upper - lower * lower) * x / length).sqrt();
            let line = (0..=40).map(|k| f64::from(k) * length / 40.0).map(|x| [x, dupuit(x)]).collect();
            let plot = Plot::new("Head at the foot of the net", ["place [m]", "head [m]"]);
            plots.push(plot.line("Dupuit, who has no seepage face", line).marks("computed", heads?));
        }
    }
    Ok(Outcome { rows, plots })
}
