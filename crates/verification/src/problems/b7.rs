//! B7: a disc under two opposite point loads.

use enmm::geometry::Point;
use enmm::model::{Simulation, StepReport};

use super::continuum::{list, order, quarter_circle, smooth_rise, stress_at, stress_error};
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble, run_all};

pub const PROBLEM: Problem = Problem {
    id: "B7",
    title: "Brazil disc",
    source: "H. Hertz (1883), Timoshenko and Goodier: a disc under two opposite point loads has 2P/(πD) of tension and \
             6P/(πD) of compression at its centre; catches wrong point loads and wrong stress of cut boundary elements",
    parameters: &[
        Parameter::new("force", "N/m", 1e6, [1e2, 1e8], "load on each end, P"),
        Parameter::new("diameter", "m", 1.0, [0.05, 50.0], "diameter of the disc, D"),
        Parameter::new("mesh", "", 0.02, [0.012, 0.04], "mesh size over diameter"),
        Parameter::new("young", "Pa", 5e10, [1e9, 1e12], "Young's modulus"),
        Parameter::new("poisson", "", 0.25, [0.0, 0.4], "Poisson's ratio"),
    ],
    quick: true,
    implicit: true,
    run,
};

/// Horizontal and vertical stress (Pa, tension positive) on the horizontal diameter, `x` from the centre.
fn exact(force: f64, diameter: f64, x: f64) -> [f64; 2] {
    let unit = 2.0 * force / (std::f64::consts::PI * diameter);
    let ratio = 4.0 * x * x / (diameter * diameter);
    [unit * ((1.0 - ratio) / (1.0 + ratio)).powi(2), unit * (1.0 - 4.0 / (1.0 + ratio).powi(2))]
}

/// Stress xx, yy, xy (Pa, tension positive) at a place: that of both loads on a half plane, −2P·cos α/(πr) along the
/// line to each load with α from the axis, and the tension 2P/(πD) that frees the rim.
fn exact_at(force: f64, diameter: f64, p: Point) -> [f64; 3] {
    let mut stress = [2.0 * force / (std::f64::consts::PI * diameter); 2];
    let mut shear = 0.0;
    for end in [0.5 * diameter, -0.5 * diameter] {
        let (x, y) = (p.x, p.y - end);
        let square = x * x + y * y;
        let unit = -2.0 * force * y.abs() / (std::f64::consts::PI * square * square);
        stress[0] += unit * x * x;
        stress[1] += unit * y * y;
        shear += unit * x * y;
    }
    [stress[0], stress[1], shear]
}

/// A quarter of the disc with half of the load on its top.
fn solve(setup: &mut Setup, mesh: f64) -> Result<(Simulation, StepReport), Trouble> {
    let (force, radius) = (setup.get("force"), 0.5 * setup.get("diameter"));
    let mesh = mesh * 2.0 * radius;
    let mut outline = quarter_circle(radius, mesh);
    outline.push([0.0, 0.0]);
    outline.reverse();
    let ramp = 20.0 * radius * (2650.0 / setup.get("young")).sqrt();
    let text = format!(
        "title = \"Brazil disc\"\n[domain]\noutline = {}\n[mesh]\nsize = {mesh:e}\nangle_deg = 15.0\n[gravity]\n\
         y = 0.0\n[rock.rock]\ndensity = 2650.0\nyoung = {:e}\npoisson = {:e}\n[[fix]]\n\
         edge = [[0.0, 0.0], [{radius:?}, 0.0]]\naxes = \"y\"\n[[fix]]\nedge = [[0.0, 0.0], [0.0, {radius:?}]]\n\
         axes = \"x\"\n[[load]]\nkind = \"point\"\npoint = [0.0, {radius:?}]\nforce = [0.0, {:e}]\ntable = {}\n\
         [[stage]]\nname = \"load\"\nkind = \"dynamic\"\ndamping = 1.0\nduration = {:e}\n[[stage]]\nname = \"rest\"\n\
         kind = \"static\"\nduration = {:e}\n",
        list(&outline),
        setup.get("young"),
        setup.get("poisson"),
        -0.5 * force,
        smooth_rise(ramp),
        1.2 * ramp,
        50.0 * ramp,
    );
    let mut simulation = setup.simulation("b7", text)?;
    let reports = run_all(&mut simulation)?;
    Ok((simulation, reports[1]))
}

/// Horizontal and vertical stress found at `x` on the horizontal diameter.
fn found(simulation: &Simulation, x: f64) -> [f64; 2] {
    let [xx, yy, _] = stress_at(simulation, Point::new(x, 0.0));
    [xx, yy]
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let (force, diameter) = (setup.get("force"), setup.get("diameter"));
    let mesh = if setup.quick { setup.get("mesh").max(0.04) } else { setup.get("mesh") };
    let (simulation, report) = solve(setup, mesh)?;
    let unit = exact(force, diameter, 0.0)[0];
    let nu = setup.get("poisson");
    let stiff = ((1.0 - nu) / (1.0 - 2.0 * nu)).max(1.5);
    let most = 30.0 * mesh * mesh * unit * stiff;
    let reason = "fitted stresses are of second order in h: 30·(h/D)² units of 2P/(πD), for the stress bends by some \
                  50 units over D² there, times the confined modulus over 2G, at least 1.5";
    let mut rows = Vec::new();
    for (share, place) in [(0.0, "at the centre"), (0.25, "a quarter of D beside it")] {
        let (computed, exact) = (found(&simulation, share * diameter), exact(force, diameter, share * diameter));
        for (k, what) in ["horizontal stress", "vertical stress"].into_iter().enumerate() {
            let row = Row::new(format!("{what} {place}"), "Pa", computed[k], exact[k]);
            rows.push(row.absolute(most, reason));
        }
    }
    let (rough, _) = solve(setup, 2.0 * mesh)?;
    let reach = 0.25 * diameter;
    let field = |p: Point| exact_at(force, diameter, p);
    let errors = [&rough, &simulation].map(|s| stress_error(s, reach, &field) / unit);
    let row = Row::new("rms error of element stresses within D/4 of the centre", "2P/(πD)", errors[1], 0.0);
    let reason = "constant stress per element: 0.4 h times the stress gradient, some 10 units over D, times the same";
    rows.push(row.at_most(4.0 * mesh * stiff, reason));
    let row = Row::new("order of that error in h", "", order(errors[0], errors[1], 2.0), 1.0);
    rows.push(row.absolute(0.3, "linear covers have stresses of first order"));
    rows.push(Row::ledger(&report));
    Ok(Outcome { rows, plots: vec![plot(&simulation, force, diameter)] })
}

fn plot(simulation: &Simulation, force: f64, diameter: f64) -> Plot {
    let unit = exact(force, diameter, 0.0)[0];
    let mut plot = Plot::new("Stress on the horizontal diameter of a Brazil disc", ["x/D", "stress over 2P/(πD)"]);
    for (k, name) in ["horizontal", "vertical"].into_iter().enumerate() {
        let curve = (0..=50).map(|n| 0.01 * f64::from(n)).map(|x| [x, exact(force, diameter, x * diameter)[k] / unit]);
        let marks = (0..=24).map(|n| 0.02 * f64::from(n)).map(|x| [x, found(simulation, x * diameter)[k] / unit]);
        plot = plot.line(format!("{name}, exact"), curve.collect()).marks(format!("{name}, computed"), marks.collect());
    }
    plot
}

#[cfg(test)]
mod tests {
    /// Numbers of verification.md: P = 1 MN/m, D = 1 m. The vertical stress on the diameter balances P.
    #[test]
    fn the_formula_gives_the_published_numbers() {
        let [tension, compression] = super::exact(1e6, 1.0, 0.0);
        assert!((tension - 636_620.0).abs() < 1.0 && (compression + 1_909_859.0).abs() < 1.0);
        let field = super::exact_at(1e6, 1.0, enmm::geometry::Point::new(0.2, 0.0));
        let line = super::exact(1e6, 1.0, 0.2);
        assert!((field[0] - line[0]).abs() < 1e-3 && (field[1] - line[1]).abs() < 1e-3 && field[2].abs() < 1e-3);
        let count = 100_000;
        let at = |k: i32| super::exact(1e6, 1.0, (f64::from(k) + 0.5) / f64::from(count) * 0.5)[1];
        let carried: f64 = (0..count).map(at).sum::<f64>() / f64::from(count);
        assert!((carried + 1e6).abs() < 1.0, "{carried}");
    }
}
