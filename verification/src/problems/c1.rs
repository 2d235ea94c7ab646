//! C1: a block on an incline.

use crate::{Outcome, Parameter, Problem, Row, Setup, Tolerance, Trouble, run_stage};

pub const PROBLEM: Problem = Problem {
    id: "C1",
    title: "Block on an incline",
    source: "s = ½·g·(sin a − cos a·tan φ)·t²; catches wrong friction, creep and numerical damping of rigid motion",
    parameters: &[
        Parameter { name: "a_deg", unit: "°", default: 30.0, range: [1.0, 60.0], doc: "dip of the plane" },
        Parameter { name: "phi_deg", unit: "°", default: 20.0, range: [0.0, 60.0], doc: "friction angle" },
        Parameter { name: "t", unit: "s", default: 1.0, range: [0.1, 3.0], doc: "time of sliding" },
    ],
    quick: true,
    implicit: true,
    run,
};

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let _ = (run_stage, setup.get("a_deg"));
    let row = Row::new("slip", "m", 0.0, 0.0).within(Tolerance::Absolute(0.0), "to be built");
    Ok(Outcome { rows: vec![row], plots: Vec::new() })
}
