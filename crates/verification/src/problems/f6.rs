//! F6: limit analysis of a column that topples against a block that slides.

use super::limit::{Scene, bound_of, factor_rows};
use crate::{Outcome, Parameter, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "F6",
    title: "Limit analysis: column that topples against a block that slides",
    source: "a column b1 × h1 turns about its toe and leans by P = W1(h1·sin a − b1·cos a)/(2·h2) on the head of a \
             lower block, which slides for tan φ/F = (W2·sin a + P)/(W2·cos a); the joint between them is smooth; \
             alone, the column falls whatever its strength; catches wrong moments and ends of interfaces",
    parameters: &[
        Parameter::new("a_deg", "°", 30.0, [5.0, 45.0], "dip of the plane"),
        Parameter::new("phi_deg", "°", 50.0, [1.0, 70.0], "friction below the block"),
        Parameter::new("phi_base_deg", "°", 75.0, [1.0, 80.0], "same, of the column"),
        Parameter::new("width", "m", 1.0, [0.1, 10.0], "b1, width of the column"),
        Parameter::new("height", "m", 5.0, [0.2, 50.0], "h1, height of the column"),
        Parameter::new("length", "m", 8.0, [0.5, 100.0], "length of the block"),
        Parameter::new("low", "m", 2.0, [0.1, 50.0], "h2, height of the block"),
        Parameter::new("gamma", "N/m³", 25e3, [5e3, 5e4], "unit weight"),
    ],
    quick: true,
    implicit: false,
    run,
};

fn scene(setup: &Setup, is_alone: bool) -> Scene {
    let [width, height, length, low] = ["width", "height", "length", "low"].map(|name| setup.get(name));
    let (right, deep) = (width + length, -low);
    let mut outline = vec![[-length, deep], [2.0 * right, deep], [2.0 * right, 0.0]];
    let mut joints = vec![(vec![[0.0, 0.0], [width, 0.0]], "base")];
    if is_alone {
        outline.push([width, 0.0]);
    } else {
        outline.extend([[right, 0.0], [right, low], [width, low]]);
        joints.push((vec![[width, 0.0], [right, 0.0]], "plane"));
        joints.push((vec![[width, 0.0], [width, low]], "smooth"));
    }
    outline.extend([[width, height], [0.0, height], [0.0, 0.0], [-length, 0.0]]);
    Scene {
        dip_deg: setup.get("a_deg"),
        outline,
        joints,
        laws: vec![
            ("base", setup.get("phi_base_deg"), 0.0),
            ("plane", setup.get("phi_deg"), 0.0),
            ("smooth", 0.0, 0.0),
        ],
        held: vec![[-0.5 * length, 0.5 * deep]],
        unit_weight: setup.get("gamma"),
        seismic: 0.0,
        size: 0.4 * low,
    }
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [width, height, length, low] = ["width", "height", "length", "low"].map(|name| setup.get(name));
    let (s, c) = setup.get("a_deg").to_radians().sin_cos();
    let [column, block] = [width * height, length * low].map(|area| area * setup.get("gamma"));
    let lean = column * (height * s - width * c) / (2.0 * low);
    let factor = setup.get("phi_deg").to_radians().tan() * block * c / (block * s + lean);
    let base = setup.get("phi_base_deg").to_radians().tan() / factor * column * c;
    // The block must not turn about its toe, nor the column slip at its own.
    let turns = lean * low + 0.5 * block * low * s > 0.5 * block * length * c;
    if lean <= 0.0 || height <= low || turns || (column * s - lean).abs() > base {
        let what = "the column must topple without slip and the block slide without turning: choose a slender column \
                    on a rough base and a long block";
        return Err(Trouble(what.to_owned()));
    }
    let texts = [false, true].map(|alone| scene(setup, alone).text("Limit analysis of a column and a block"));
    let [both, alone] = texts;
    let bound = bound_of(setup, "column_against_block", both)?;
    let mut rows = factor_rows("", &bound, factor).to_vec();
    let alone = bound_of(setup, "column_alone", alone)?.level_tops.factor.value();
    let reason = "no strength holds it: factors below 0.001 are told from none";
    rows.push(Row::new("factor of the column alone", "", alone, 0.0).at_most(1e-3, reason));
    Ok(Outcome { rows, ..Outcome::default() })
}
