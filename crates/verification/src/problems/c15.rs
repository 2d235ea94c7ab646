//! C15: a jointed slope whose joints dilate by their friction angle moves below the limit and rests above it.

use super::limit::bound_of;
use crate::slope::{block_displacements, slope_text};
use crate::{Origin, Outcome, Parameter, Plot, Problem, Row, Series, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "C15",
    title: "Jointed slope, dilation as large as friction",
    source: "Limit analysis is exact for rigid blocks whose joints dilate by their friction angle: with less friction \
             than it asks for, no equilibrium exists and the slope must move on; with more it must come to rest. \
             Catches blocks that are held where joints cross",
    parameters: &[
        Parameter::new("spacing", "m", 6.4, [3.0, 30.0], "spacing of both joint sets"),
        Parameter::new("apart", "", 0.07, [0.02, 0.2], "tan φ below and above the limit"),
        Parameter::new("t", "s", 12.0, [2.0, 60.0], "time to come to rest"),
    ],
    quick: true,
    implicit: false,
    run,
};

/// Friction and dilation (degrees) with which limit analysis finds the limit.
const ASKED: f64 = 45.0;
/// Samples of the displacement over time.
const SAMPLES: usize = 100;

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let spacing = if setup.quick { setup.get("spacing").max(16.0) } else { setup.get("spacing") };
    let text = |angle_deg: f64| {
        let law = format!("friction_deg = {angle_deg:?}\ndilation_deg = {angle_deg:?}\ndilation_slip = 1e3\n");
        slope_text(spacing, 0.0).replace("friction_deg = 50\n", &law)
    };
    let tangent = 1.0 / bound_of(setup, "limit_analysis", text(ASKED))?.associated.factor.value();
    let origin = Origin::Numerical("limit analysis of rigid blocks");
    let degrees = tangent.atan().to_degrees();
    let mut outcome = Outcome::default();
    outcome.rows.push(Row::new("friction and dilation at the limit", "°", degrees, degrees).from(origin));
    let mut series = Vec::new();
    for (name, sign) in [("below", -1.0), ("above", 1.0)] {
        let angle = (tangent * (1.0 + sign * setup.get("apart"))).atan().to_degrees();
        let points = farthest(setup, name, text(angle))?;
        series.push(Series::line(format!("{angle:.2}°, {name} the limit"), points));
    }
    let last = |points: &[[f64; 2]]| points[SAMPLES][1] - points[SAMPLES - SAMPLES / 10][1];
    let [below, above] = [last(&series[0].points), last(&series[1].points)];
    let reason = "a slope that moves on goes as far in every tenth of the time; one that comes to rest only settles";
    outcome.rows.extend([
        Row::new("way in the last tenth of the time, above the limit over below", "", above / below, 0.0)
            .at_most(0.05, reason)
            .from(origin),
        Row::new("a thousandth of the spacing over the way below", "", 1e-3 * spacing / below, 0.0)
            .at_most(1.0, "below the limit the slope must move on")
            .from(origin),
    ]);
    let plot = Plot::new("Displacement of the block that goes farthest", ["time (s)", "displacement (m)"]);
    outcome.plots.push(plot.with(series).logarithmic([false, true]));
    Ok(outcome)
}

/// Displacement (m) of the block that has gone farthest over the time (s).
fn farthest(setup: &mut Setup, name: &str, text: String) -> Result<Vec<[f64; 2]>, Trouble> {
    let mut simulation = setup.simulation(name, text)?;
    let mut points = vec![[0.0; 2]];
    for sample in 1..=SAMPLES {
        let until = setup.get("t") * sample as f64 / SAMPLES as f64;
        while simulation.time() < until {
            simulation.advance(false)?;
        }
        let most = block_displacements(&simulation).iter().map(|way| way.norm()).fold(0.0, f64::max);
        points.push([simulation.time(), most]);
    }
    Ok(points)
}
