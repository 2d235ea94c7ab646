//! B2: frequencies of beams and of a bar in free vibration.

use std::f64::consts::PI;

use enmm::geometry::Vector;
use enmm::model::Simulation;

use super::beam::{Beam, Plane};
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "B2",
    title: "Eigenfrequencies",
    source: "Rayleigh–Lamb equation (simply supported), slender beam with shear and rotary inertia (cantilever), bar \
             with lateral inertia (free–free). Catches wrong mass, numerical damping and period error",
    parameters: &[
        Parameter::new("length", "m", 10.0, [5.0, 20.0], "length"),
        Parameter::new("depth", "m", 1.0, [0.5, 1.25], "depth"),
        Parameter::new("young", "Pa", 1e9, [1e8, 1e11], "Young's modulus"),
        Parameter::new("poisson", "", 0.25, [0.0, 0.4], "Poisson's ratio"),
        Parameter::new("density", "kg/m³", 2500.0, [500.0, 8000.0], "density"),
        Parameter::new(
            "rows",
            "",
            8.0,
            [4.0, 16.0],
            "rows of the finest mesh; twice that where both ends are supported",
        ),
    ],
    quick: true,
    implicit: true,
    run,
};

/// Body that swings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Supported,
    Cantilever,
    Axial,
}

/// A vibration that was measured: frequency (Hz) and the signal over time (s, m).
struct Swing {
    frequency: f64,
    signal: Vec<[f64; 2]>,
    ledger: Row,
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let finest = if setup.quick { 4.0 } else { setup.get("rows") };
    let mut outcome = Outcome::default();
    let mut cases = vec![(Kind::Supported, Plane::Stress), (Kind::Axial, Plane::Stress)];
    if !setup.quick {
        cases.push((Kind::Supported, Plane::Strain));
        cases.extend([(Kind::Cantilever, Plane::Stress), (Kind::Cantilever, Plane::Strain)]);
    }
    for (kind, plane) in cases {
        let [length, depth, young, poisson, density] =
            ["length", "depth", "young", "poisson", "density"].map(|name| setup.get(name));
        let beam = Beam { length, depth, young, poisson, density, plane };
        let rows = if kind == Kind::Supported && !setup.quick { 2.0 * finest } else { finest };
        let coarsest = swing(setup, &beam, kind, 0.25 * rows)?;
        let coarse = swing(setup, &beam, kind, 0.5 * rows)?;
        let fine = swing(setup, &beam, kind, rows)?;
        judge(&mut outcome, &beam, kind, rows, [&coarsest, &coarse, &fine].map(|swing| swing.frequency));
        if outcome.plots.len() < 2 {
            outcome.plots.push(plot(&beam, kind, &fine));
        }
        let quantity = format!("{kind:?}, plane {}: {}", plane.name(), fine.ledger.quantity);
        outcome.rows.push(Row { quantity, ..fine.ledger });
    }
    Ok(outcome)
}

fn exact(beam: &Beam, kind: Kind) -> f64 {
    match kind {
        Kind::Supported => beam.supported(),
        Kind::Cantilever => beam.cantilever()[1],
        Kind::Axial => beam.axial()[1],
    }
}

fn judge(outcome: &mut Outcome, beam: &Beam, kind: Kind, rows: f64, [coarsest, coarse, fine]: [f64; 3]) {
    let (exact, name) = (exact(beam, kind), format!("{kind:?}, plane {}", beam.plane.name()));
    // Share of lateral inertia, of which the closed form has the first term; the next is of the order of its square.
    let lateral = 0.5 * (PI / beam.length * beam.plane_stress().1).powi(2) * beam.depth.powi(2) / 12.0;
    let (tolerance, reason) = match kind {
        Kind::Axial => (5e-3 / rows + 4.0 * lateral * lateral, "axial strain is nearly uniform in an element"),
        _ => (1.05 / (rows * rows) + 1e-3, "half of the share 2.1/rows² of the stiffness that linear covers add"),
    };
    let row = Row::new(format!("{name}: frequency"), "Hz", fine, exact);
    outcome.rows.push(row.relative(tolerance, reason));
    if kind != Kind::Axial {
        let limit = fine + (fine - coarse) / 3.0;
        let left = 4.0 * (1.05 / (rows * rows)).powi(2) + if kind == Kind::Cantilever { 1.9e-3 } else { 4e-4 };
        let row = Row::new(format!("{name}: frequency, extrapolated"), "Hz", limit, exact);
        let reason = "Richardson's rule leaves the square of the error; the clamp's corners are singular";
        outcome.rows.push(row.relative(left, reason));
        let order = ((coarsest - coarse) / (coarse - fine)).log2();
        let row = Row::new(format!("{name}: order of the frequency in h"), "", order, 2.0);
        outcome.rows.push(row.absolute(0.5, "h²; the mesh does not fit the beam"));
    }
}

/// Starts the mode with a small velocity and measures by upward zero crossings.
fn swing(setup: &mut Setup, beam: &Beam, kind: Kind, rows: f64) -> Result<Swing, Trouble> {
    let (l, c) = (beam.length, 0.5 * beam.depth);
    let fix = |x: f64, axes: &str| format!("[[fix]]\nedge = [[{x:e}, {:e}], [{x:e}, {c:e}]]\naxes = \"{axes}\"\n", -c);
    let fixes = match kind {
        Kind::Supported => fix(0.0, "y") + &fix(l, "y"),
        Kind::Cantilever => fix(0.0, "xy"),
        Kind::Axial => String::new(),
    };
    let period = 1.0 / exact(beam, kind);
    let text = format!(
        "{}{fixes}[[monitor]]\nname = \"middle\"\npoint = [{:e}, 0.0]\n[[monitor]]\nname = \"end\"\n\
         point = [{l:e}, 0.0]\n[[stage]]\nname = \"swing\"\nkind = \"dynamic\"\nduration = {:e}\ndamping = 0.0\n\
         [solver]\nnewmark = \"trapezoidal\"\nimplicit_step = {:e}\n",
        beam.text(rows, 0.0),
        0.5 * l,
        20.0 * period,
        period / 200.0
    );
    let name = format!("b2_{kind:?}_{}_{rows}_rows", beam.plane.name()).to_lowercase();
    let mut simulation = setup.simulation(&name, text)?;
    start(&mut simulation, beam, kind);
    let signal = |s: &Simulation| match kind {
        Kind::Supported => s.monitor(0).0.y,
        Kind::Cantilever => s.monitor(1).0.y,
        Kind::Axial => s.monitor(1).0.x,
    };
    measure(&mut simulation, signal, if kind == Kind::Axial { 6 } else { 2 })
}

fn start(simulation: &mut Simulation, beam: &Beam, kind: Kind) {
    let (l, speed) = (beam.length, 1e-3);
    let mode = |x: Vector| match kind {
        Kind::Supported => {
            let k = PI / l;
            Vector::new(-k * x.y * (k * x.x).cos(), (k * x.x).sin())
        }
        Kind::Axial => {
            let (k, (_, poisson)) = (PI / l, beam.plane_stress());
            Vector::new((k * x.x).cos(), poisson * k * x.y * (k * x.x).sin())
        }
        Kind::Cantilever => {
            let (b, r, z) = (1.875104 / l, 0.734096, 1.875104 / l * x.x);
            let turn = b * (z.sinh() + z.sin() - r * (z.cosh() - z.cos()));
            Vector::new(-x.y * turn, z.cosh() - z.cos() - r * (z.sinh() - z.sin()))
        }
    };
    let mut state = simulation.state().clone();
    state.velocity = simulation.model().covers.star_position.iter().map(|x| mode(*x) * speed).collect();
    simulation.restore(state.clone());
    let energy = simulation.report().ledger.kinetic;
    state.ledger.baseline += energy;
    simulation.restore(state);
}

fn measure(simulation: &mut Simulation, signal: impl Fn(&Simulation) -> f64, swings: usize) -> Result<Swing, Trouble> {
    let (mut before, mut crossings, mut points) = ([0.0; 2], Vec::new(), Vec::new());
    while crossings.len() <= swings {
        if simulation.stage_is_over(None) {
            return Err(Trouble(format!("only {} of {swings} swings within the stage", crossings.len())));
        }
        simulation.advance(false)?;
        let now = [simulation.time(), signal(simulation)];
        if before[1] < 0.0 && now[1] >= 0.0 {
            crossings.push(now[0] - (now[0] - before[0]) * now[1] / (now[1] - before[1]));
        }
        points.push(now);
        before = now;
    }
    let frequency = swings as f64 / (crossings[swings] - crossings[0]);
    let ledger = Row::ledger(&simulation.report());
    let every = (points.len() / 400).max(1);
    Ok(Swing { frequency, signal: points.into_iter().step_by(every).collect(), ledger })
}

fn plot(beam: &Beam, kind: Kind, swing: &Swing) -> Plot {
    let most = swing.signal.iter().map(|p| p[1].abs()).fold(0.0, f64::max);
    let sign = if swing.signal.len() > 1 { swing.signal[1][1].signum() } else { 1.0 };
    let exact = |t: f64| sign * most * (2.0 * PI * exact(beam, kind) * t).sin();
    Plot::new(format!("B2: {kind:?}, free vibration"), ["time [s]", "displacement [m]"])
        .line("computed", swing.signal.clone())
        .line("exact", swing.signal.iter().map(|p| [p[0], exact(p[0])]).collect())
}
