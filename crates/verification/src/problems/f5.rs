//! F5: limit analysis of a plane slide with water, a seismic coefficient and bolts.

use super::limit::{bound_of, factor_rows};
use super::plane_slide::PlaneSlide;
use crate::{Outcome, Parameter, Problem, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "F5",
    title: "Limit analysis: plane slide with water and bolts",
    source: "E. Hoek and J. W. Bray, Rock Slope Engineering: (cA + (W(cos ψ − k·sin ψ) − U − V·sin ψ + T·sin(ψ + δ))·\
             tan φ)/(W(sin ψ + k·cos ψ) + V·cos ψ − T·cos(ψ + δ)); catches water on the wrong faces, bolts that push \
             or pull by more than they bear",
    parameters: &[
        Parameter::new("height", "m", 30.0, [5.0, 500.0], "height of the slope"),
        Parameter::new("crack", "m", 7.0, [0.1, 200.0], "depth of the tension crack"),
        Parameter::new("water", "m", 5.0, [0.0, 200.0], "depth of the water in it"),
        Parameter::new("face_deg", "°", 60.0, [20.0, 80.0], "dip of the face"),
        Parameter::new("plane_deg", "°", 35.0, [10.0, 70.0], "dip of the plane"),
        Parameter::new("phi_deg", "°", 35.0, [1.0, 70.0], "friction of the plane"),
        Parameter::new("cohesion", "Pa", 25e3, [0.0, 1e7], "cohesion of the plane"),
        Parameter::new("gamma", "N/m³", 26e3, [1e4, 4e4], "unit weight"),
        Parameter::new("k", "", 0.05, [0.0, 0.5], "seismic coefficient"),
        Parameter::new("rows", "", 4.0, [1.0, 20.0], "rows of bolts"),
        Parameter::new("tension", "N/m", 210e3, [0.0, 1e7], "tension of a row at yield"),
        Parameter::new("delta_deg", "°", 10.0, [-30.0, 45.0], "fall of the bolts"),
    ],
    quick: true,
    implicit: false,
    run,
};

fn slide(setup: &Setup, water: f64, seismic: f64) -> PlaneSlide {
    let slide = PlaneSlide::of(setup, setup.get("plane_deg"), setup.get("gamma"));
    PlaneSlide { crack: setup.get("crack"), water, seismic, ..slide }
}

/// Bolts from the face through the plane, as the case writes them.
fn bolts(setup: &Setup, slide: &PlaneSlide) -> String {
    let (rows, delta) = (setup.get("rows") as u32, setup.get("delta_deg").to_radians());
    let (s, c) = delta.sin_cos();
    let bolt = |k: u32| {
        let y = 0.8 * slide.height * f64::from(k + 1) / f64::from(rows + 1);
        let head = [y / slide.face.tan() + 0.02 * slide.height, y];
        let reach = (y - head[0] * slide.plane.tan()) / (s + c * slide.plane.tan()) + 0.1 * slide.height;
        let end = [head[0] + reach * c, head[1] - reach * s];
        format!(
            "[[bolt]]\npoints = {:?}\nyoung = 2e11\narea = 4e-4\nspacing = 1.0\nyield_force = {:e}\n",
            [head, end],
            setup.get("tension")
        )
    };
    (0..rows).map(bolt).collect()
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [water, k, tension] = ["water", "k", "tension"].map(|name| setup.get(name));
    let delta = setup.get("delta_deg").to_radians();
    let all = setup.get("rows").floor() * tension;
    let variants = [
        (", dry", 0.0, 0.0, false),
        (", water", water, 0.0, false),
        (", water and earthquake", water, k, false),
        (", water and bolts", water, 0.0, true),
    ];
    let mut outcome = Outcome::default();
    for (name, water, seismic, bolted) in variants {
        let slide = slide(setup, water, seismic);
        if !slide.is_sound() || water > slide.crack {
            return Err(Trouble("the plane must daylight and the crack hold the water: steepen the face".to_owned()));
        }
        let mut text = slide.text("Limit analysis of a plane slide");
        if bolted {
            text = text.replace("[[stage]]", &(bolts(setup, &slide) + "[[stage]]"));
        }
        let bound = bound_of(setup, &format!("plane_slide{}", name.replace([',', ' '], "_")), text)?;
        outcome.rows.extend(factor_rows(name, &bound, slide.bolted_factor(if bolted { all } else { 0.0 }, delta)));
    }
    Ok(outcome)
}
