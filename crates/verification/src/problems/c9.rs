//! C9: plane slide with tension crack, water and a seismic coefficient.

use super::incline::{factor_row, ledger_row, reduce, trial_plot};
use super::plane_slide::PlaneSlide;
use crate::parts::dynamic;
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "C9",
    title: "Plane slide with tension crack, water and earthquake",
    source: "E. Hoek and J. W. Bray, Rock Slope Engineering, plane failure: FoS = (cA + (W(cos ψ − k sin ψ) − U − \
             V sin ψ)·tan φ)/(W(sin ψ + k cos ψ) + V cos ψ), U = ½γw·zw·A, V = ½γw·zw²; catches wrong pressure in \
             joints, body loads, cohesion lost at the toe or the crack",
    parameters: &[
        Parameter::new("height", "m", 60.0, [5.0, 500.0], "height of the slope"),
        Parameter::new("crack", "m", 14.0, [0.0, 100.0], "depth of the tension crack"),
        Parameter::new("face_deg", "°", 50.0, [20.0, 80.0], "dip of the face"),
        Parameter::new("plane_deg", "°", 35.0, [10.0, 70.0], "dip of the plane"),
        Parameter::new("cohesion", "Pa", 100e3, [0.0, 1e7], "cohesion of the plane"),
        Parameter::new("phi_deg", "°", 35.0, [1.0, 70.0], "friction of the plane"),
        Parameter::new("gamma", "N/m³", 26.5e3, [1e4, 4e4], "unit weight of the rock"),
        Parameter::new("gamma_w", "N/m³", 9.81e3, [5e3, 2e4], "unit weight of water"),
        Parameter::new("water_half", "m", 7.0, [0.1, 100.0], "lower water in the crack"),
        Parameter::new("water_full", "m", 14.0, [0.1, 100.0], "higher water in the crack"),
        Parameter::new("kh", "", 0.08, [0.0, 0.5], "seismic coefficient"),
        Parameter::new("young", "Pa", 5e10, [1e9, 2e11], "Young's modulus of the rock"),
        Parameter::new("mesh", "", 0.13, [0.02, 0.3], "mesh size over height"),
    ],
    quick: true,
    implicit: false,
    run,
};

fn slide(setup: &Setup, water: f64, seismic: f64) -> PlaneSlide {
    let slide = PlaneSlide::of(setup, setup.get("plane_deg"), setup.get("gamma"));
    let [crack, water_weight, young] = ["crack", "gamma_w", "young"].map(|name| setup.get(name));
    PlaneSlide { crack, water_weight, water, seismic, young, size: setup.get("mesh") * slide.height, ..slide }
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let levels = [0.0, setup.get("water_half"), setup.get("water_full")];
    if levels.iter().any(|&level| level > setup.get("crack")) || !slide(setup, 0.0, 0.0).is_sound() {
        let message = "water stands no higher than the crack is deep, and the plane reaches behind the crest: change \
                       water_half, water_full, crack, face_deg or plane_deg";
        return Err(Trouble(message.to_owned()));
    }
    let mut outcome = Outcome::default();
    let mut plot = Plot::new("Plane slide", ["water in the crack (m)", "factor of safety"]);
    let mut found = Vec::new();
    for seismic in [0.0, setup.get("kh")] {
        let mut marks = Vec::new();
        let quick = setup.quick;
        for level in levels.into_iter().filter(|level| !quick || *level != levels[1]) {
            let model = slide(setup, level, seismic);
            if level > 0.0 && seismic == 0.0 {
                pressures(setup, &model, &mut outcome)?;
            }
            let name = format!("water {level} m, kh {seismic}");
            let reduction = reduce(setup, &name.replace([' ', ','], "_"), model.text("Plane slide"))?;
            outcome.rows.push(row(&name, &reduction, model.factor()));
            marks.push([level, reduction.factor().unwrap_or(f64::NAN)]);
            if level == levels[2] && seismic == 0.0 {
                outcome.plots.push(trial_plot("Trials, higher water, no earthquake", &reduction, model.factor()));
            }
            found.push(reduction);
        }
        let levels = (0..=40).map(|k| levels[2] * f64::from(k) / 40.0);
        let points = levels.map(|level| [level, slide(setup, level, seismic).factor()]).collect();
        plot = plot.line(format!("exact, kh = {seismic}"), points).marks(format!("computed, kh = {seismic}"), marks);
    }
    outcome.rows.push(ledger_row(&found.iter().collect::<Vec<_>>()));
    outcome.plots.push(plot);
    Ok(outcome)
}

/// V and U on the wedge: by the water table, and by as much pressure in loads of the joints.
fn pressures(setup: &mut Setup, model: &PlaneSlide, outcome: &mut Outcome) -> Result<(), Trouble> {
    let (force, moment) = model.water_force();
    let dry = PlaneSlide { water: 0.0, ..*model };
    for (kind, text) in [
        ("a water table", model.model("Water table")),
        ("joint loads", dry.model("Joint loads") + &model.water_loads()),
    ] {
        let name = format!("pressure_{}_{}", kind.replace(' ', "_"), model.water);
        let mut simulation = setup.simulation(&name, text + &dynamic("one", 1.0, 0.1))?;
        let found = model.pushed(&mut simulation)?;
        for (what, unit, found, exact, arm) in [
            ("force along x", "N/m", found.0.x, force.x, 1.0),
            ("force along y", "N/m", found.0.y, force.y, 1.0),
            ("moment about the toe", "N", found.1, moment, model.height),
        ] {
            let row = Row::new(format!("{what} on the wedge, {kind}, water {} m", model.water), unit, found, exact);
            let most = 1e-10 * force.norm() * arm;
            outcome.rows.push(row.absolute(most, "sums of some hundred terms: rounding"));
        }
    }
    Ok(())
}

fn row(name: &str, reduction: &enmm_stability::strength_reduction::Reduction, exact: f64) -> Row {
    let reason = "bracket of 0.2 % (0.5 % when quick); the wedge is elastic and its toe a corner of 15°";
    factor_row(&format!("factor of safety, {name}"), reduction, exact, reason)
}
