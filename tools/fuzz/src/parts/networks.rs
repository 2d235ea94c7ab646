//! Joint networks of nearly parallel, coincident, tiny and touching traces: whatever they cut, the areas of the blocks
//! sum to that of the outline, those of the elements to that of their block, and the model can move.

use std::fmt::Write;
use std::path::Path;

use enmm_io::parse_case;

use crate::parts::{Act, Outcome, finite};
use crate::random::Random;
use crate::trace::Trace;

type Place = [f64; 2];

/// Outlines (m).
const OUTLINES: [&[Place]; 5] = [
    &[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]],
    &[[0.0, 0.0], [5.0, 0.0], [5.0, 1.0], [3.0, 1.0], [2.0, 4.0], [0.0, 4.0]],
    &[[0.0, 0.0], [4.0, 0.1], [3.9, 3.0], [2.0, 2.9], [2.0, 1.0], [1.9, 3.1], [0.1, 3.0]],
    &[[0.0, 0.0], [6.0, 0.0], [0.0, 3.0]],
    &[[0.0, 0.0], [3.0, 0.0], [3.0, 1e-2], [4.0, 1e-2], [4.0, 2.0], [1.0, 2.0], [1.0, 2.5], [0.0, 2.5]],
];
/// End of every case.
const REST: &str = include_str!("network.toml");
/// Steps of a model.
const STEPS: usize = 3;
/// Way of an outline that is drawn onto traces, in snap tolerances.
const SNAP: f64 = 3.0;

/// Nothing is in common.
pub fn make() -> Result<Act, String> {
    Ok(Box::new(attempt))
}

fn attempt(random: &mut Random, trace: &mut Trace) -> Result<Outcome, String> {
    let outline = random.pick(&OUTLINES);
    let shift = random.pick(&[0.0, 0.0, 1e3, 1e6]);
    let text = case(outline, shift, random);
    trace.say(|| text.clone());
    let loaded = parse_case(&text, "case.toml", Path::new("")).map_err(|error| format!("not read: {error}"))?;
    let mut model = match enmm_implicit::simulation(loaded.case) {
        Ok(model) => model,
        Err(error) => {
            trace.say(|| format!("# {error}"));
            return Ok(Outcome::Done(1));
        }
    };
    let (covers, noding) = (&model.model().covers, &model.built().noding);
    let blocks: f64 = covers.blocks().map(|b| covers.block_area(b)).sum();
    let elements: f64 = covers.element_area.iter().sum();
    let [wanted, around] = measures(outline);
    // The noder draws an outline by a few tolerances, on all of its length; places far away have less digits.
    let allowed = around * (SNAP * noding.tolerance + 8.0 * f64::EPSILON * shift) + 1e-12 * wanted;
    for (name, area) in [("blocks", blocks), ("elements", elements)] {
        if (area - wanted).abs() > allowed || !area.is_finite() {
            return Err(format!(
                "areas of {name} sum to {area} m2, the outline has {wanted} m2 (allowed: {allowed:.1e})"
            ));
        }
    }
    if let Some(e) = covers.element_area.iter().position(|&area| area.is_nan() || area <= 0.0) {
        return Err(format!("element {e} has an area of {}", covers.element_area[e]));
    }
    model.set_serial(true);
    for step in 0..STEPS {
        if let Err(error) = model.advance(false) {
            trace.say(|| format!("# step {step}: {error}"));
            return Ok(Outcome::Done(2));
        }
        let state = model.state();
        let numbers = state.displacement.iter().chain(&state.velocity).flat_map(|v| [v.x, v.y]);
        finite("displacements and velocities", &numbers.collect::<Vec<_>>())?;
    }
    Ok(Outcome::Done(2 + STEPS as u64))
}

/// Area and circumference.
fn measures(outline: &[Place]) -> [f64; 2] {
    let sides = || outline.iter().zip(outline.iter().cycle().skip(1));
    let area: f64 = sides().map(|(a, b)| 0.5 * (a[0] * b[1] - b[0] * a[1])).sum();
    [area, sides().map(|(a, b)| (b[0] - a[0]).hypot(b[1] - a[1])).sum()]
}

/// A case with traces.
fn case(outline: &[Place], shift: f64, random: &mut Random) -> String {
    let traces = traces(outline, random);
    let moved = |points: &[Place]| points.iter().map(|p| [p[0] + shift, p[1] - shift]).collect::<Vec<_>>();
    let size = random.pick(&[0.3, 0.5, 0.9, 2.0, 20.0]);
    let angle = random.pick(&[0.0, 7.0, 30.0, 59.999_999]);
    let mut text = format!(
        "title = \"Network\"\n[domain]\noutline = {:?}\njoint_law = \"joint\"\n{}[mesh]\nsize = {size:?}\nangle_deg = \
         {angle:?}\norigin = {:?}\n",
        moved(outline),
        random.pick(&["", "", "snap_tolerance = 1e-9\n", "snap_tolerance = 1e-4\n", "snap_tolerance = 1e-2\n"]),
        moved(&[[random.pick(&[0.0, 0.031]), random.pick(&[0.0, 0.017])]])[0],
    );
    for points in &traces {
        // Writing to a text does not fail.
        let _ = writeln!(text, "[[joint]]\npoints = {:?}", moved(points));
    }
    text + REST
}

/// Up to thirty traces, each after one of those before or anew.
fn traces(outline: &[Place], random: &mut Random) -> Vec<Vec<Place>> {
    let mut traces: Vec<Vec<Place>> = Vec::new();
    for _ in 0..=random.below(30) {
        let a = place(outline, &traces, random);
        let old = traces.get(random.below(traces.len())).cloned();
        let off = random.pick(&[0.0, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3]);
        let trace = match (random.below(6), old) {
            (0, Some(old)) => old.iter().map(|p| [p[0] + off, p[1] - off]).collect(),
            (1, Some(old)) => vec![old[0], [old[1][0] + off, old[1][1]]],
            (2, Some(old)) => {
                let along = |s: f64| [0, 1].map(|k| old[0][k] + s * (old[1][k] - old[0][k]));
                vec![along(random.between(-0.5, 0.5)), along(random.between(0.6, 1.5))]
            }
            (3, _) => vec![a, [a[0] + random.between(-1e-3, 1e-3), a[1] + random.between(-1e-3, 1e-3)]],
            (4, _) => (0..3 + random.below(4)).map(|_| place(outline, &traces, random)).collect(),
            _ => vec![a, place(outline, &traces, random)],
        };
        let distinct = |pair: &[Place]| (pair[0][0] - pair[1][0]).hypot(pair[0][1] - pair[1][1]) > 1e-12;
        if trace.windows(2).all(distinct) {
            traces.push(trace);
        }
    }
    traces
}

/// A place: anywhere, on a grid, on the outline, on a trace or at its end, or close to one of these.
fn place(outline: &[Place], traces: &[Vec<Place>], random: &mut Random) -> Place {
    let between = |a: Place, b: Place, s: f64| [0, 1].map(|k| a[k] + s * (b[k] - a[k]));
    let side = random.below(outline.len());
    let share = random.pick(&[0.0, 0.5, 0.25, 1.0, 1.0 / 3.0]);
    let old = traces.get(random.below(traces.len()));
    let p = match (random.below(6), old) {
        (0, _) => outline[side],
        (1, _) => between(outline[side], outline[(side + 1) % outline.len()], share),
        (2, Some(old)) => old[random.below(old.len())],
        (3, Some(old)) => between(old[0], old[1], share),
        (4, _) => [0.5 * random.below(11) as f64, 0.5 * random.below(9) as f64],
        _ => [random.between(-0.5, 6.0), random.between(-0.5, 4.5)],
    };
    let off = random.pick(&[0.0, 0.0, 0.0, 1e-12, 1e-9, 1e-7, 1e-6, 3e-6, 1e-5, 1e-4]);
    [p[0] + off * random.between(-1.0, 1.0), p[1] + off * random.between(-1.0, 1.0)]
}
