//! C9: plane slide with tension crack, water and a seismic coefficient.

use super::incline::{factor_row, ledger_row, reduce, trial_plot};
use super::plane_slide::PlaneSlide;
use crate::parts::dynamic;
use crate::{Outcome, Parameter, Plot, Problem, Row, Series, Setup, Tolerance, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "C9",
    title: "Plane slide with tension crack, water and earthquake",
    source: "E. Hoek and J. W. Bray, Rock Slope Engineering, plane failure: FoS = (cA + (W(cos ψ − k sin ψ) − U − \
             V sin ψ)·tan φ)/(W(sin ψ + k cos ψ) + V cos ψ), U = ½γw·zw·A, V = ½γw·zw²; catches wrong pressure in \
             joints, body loads, cohesion lost at the toe or the crack",
    parameters: &[
        Parameter { name: "height", unit: "m", default: 60.0, range: [5.0, 500.0], doc: "height of the slope" },
        Parameter { name: "crack", unit: "m", default: 14.0, range: [0.0, 100.0], doc: "depth of the tension crack" },
        Parameter { name: "face_deg", unit: "°", default: 50.0, range: [20.0, 80.0], doc: "dip of the face" },
        Parameter { name: "plane_deg", unit: "°", default: 35.0, range: [10.0, 70.0], doc: "dip of the plane" },
        Parameter { name: "cohesion", unit: "Pa", default: 100e3, range: [0.0, 1e7], doc: "cohesion of the plane" },
        Parameter { name: "phi_deg", unit: "°", default: 35.0, range: [1.0, 70.0], doc: "friction of the plane" },
        Parameter { name: "gamma", unit: "N/m³", default: 26.5e3, range: [1e4, 4e4], doc: "unit weight of the rock" },
        Parameter { name: "gamma_w", unit: "N/m³", default: 9.81e3, range: [5e3, 2e4], doc: "unit weight of water" },
        Parameter { name: "water_half", unit: "m", default: 7.0, range: [0.1, 100.0], doc: "lower water in the crack" },
        Parameter {
            name: "water_full",
            unit: "m",
            default: 14.0,
            range: [0.1, 100.0],
            doc: "higher water in the crack",
        },
        Parameter { name: "kh", unit: "", default: 0.08, range: [0.0, 0.5], doc: "seismic coefficient" },
        Parameter { name: "young", unit: "Pa", default: 5e10, range: [1e9, 2e11], doc: "Young's modulus of the rock" },
        Parameter { name: "mesh", unit: "", default: 0.13, range: [0.02, 0.3], doc: "mesh size over height" },
    ],
    quick: true,
    implicit: false,
    run,
};

fn slide(setup: &Setup, water: f64, seismic: f64) -> PlaneSlide {
    let height = setup.get("height");
    PlaneSlide {
        height,
        crack: setup.get("crack"),
        face: setup.get("face_deg").to_radians(),
        plane: setup.get("plane_deg").to_radians(),
        cohesion: setup.get("cohesion"),
        friction: setup.get("phi_deg").to_radians(),
        unit_weight: setup.get("gamma"),
        water_weight: setup.get("gamma_w"),
        water,
        seismic,
        young: setup.get("young"),
        size: setup.get("mesh") * height,
        planes: 1,
        spacing: height,
    }
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let levels = [0.0, setup.get("water_half"), setup.get("water_full")];
    if levels.iter().any(|&level| level > setup.get("crack")) || !slide(setup, 0.0, 0.0).is_sound() {
        let message = "water stands no higher than the crack is deep, and the plane reaches behind the crest: change \
                       water_half, water_full, crack, face_deg or plane_deg";
        return Err(Trouble(message.to_owned()));
    }
    let mut outcome = Outcome::default();
    let mut series = Vec::new();
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
        series.push(Series { name: format!("exact, kh = {seismic}"), points, marks: false });
        series.push(Series { name: format!("computed, kh = {seismic}"), points: marks, marks: true });
    }
    outcome.rows.push(ledger_row(&found.iter().collect::<Vec<_>>()));
    let axes = ["water in the crack (m)".to_owned(), "factor of safety".to_owned()];
    outcome.plots.push(Plot { title: "Plane slide".to_owned(), axes, logarithmic: [false; 2], series });
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
            outcome.rows.push(row.within(Tolerance::Absolute(most), "sums of some hundred terms: rounding"));
        }
    }
    Ok(())
}

fn row(name: &str, reduction: &enmm_stability::strength_reduction::Reduction, exact: f64) -> Row {
    let reason = "bracket of 0.2 % (0.5 % when quick); the wedge is elastic and its toe a corner of 15°";
    factor_row(&format!("factor of safety, {name}"), reduction, exact, reason)
}
