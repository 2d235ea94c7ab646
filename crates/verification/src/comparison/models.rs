//! The models of the comparison: a beam, a block on an incline, a fractured slope.

use enmm::geometry::Vector;
use enmm::model::case::Integrator;

use super::{Entry, FAILING, Failure, Run};
use crate::Trouble;
use crate::problems::{Beam, Plane};
use crate::slope::{Totals, block_displacements, difference, fail, slope_text};

/// Line of a case that sets the implicit step (s).
fn step_line(step: Option<f64>) -> String {
    step.map_or_else(String::new, |dt| format!("[solver]\nimplicit_step = {dt:e}\n"))
}

/// A simply supported beam under a uniform load, settled; error of the sag between points a tenth inside.
pub(super) fn beam(integrator: Integrator, rows: f64, step: Option<f64>) -> Result<Entry, Trouble> {
    let beam = Beam { length: 10.0, depth: 1.0, young: 1e9, poisson: 0.25, density: 2500.0, plane: Plane::Stress };
    let monitors: String = [1, 5, 9].map(|x| format!("[[monitor]]\nname = \"x{x}\"\npoint = [{x}.0, 0.0]\n")).concat();
    let text = format!(
        "{}[[fix]]\npoint = [0.0, 0.0]\n[[fix]]\npoint = [10.0, 0.0]\naxes = \"y\"\n[[load]]\nkind = \"traction\"\n\
         edge = [[0.0, 0.5], [10.0, 0.5]]\ntraction = [0.0, -1e4]\n{monitors}[[stage]]\nname = \"load\"\n\
         kind = \"static\"\nduration = 60.0\nramp = 0.0\nconvergence = 1e-5\n{}",
        beam.text(rows, 0.0),
        step_line(step)
    );
    let mut run = Run::start(integrator, text)?;
    let report = run.simulation.run_stage()?;
    let [left, middle, right] = [0, 1, 2].map(|k| -run.simulation.monitor(k).0.y);
    let exact = beam.uniform(1e4, 0.0) - beam.uniform(1e4, 4.0);
    let error = (middle - 0.5 * (left + right)) / exact - 1.0;
    Ok(run.entry("beam, static", format!("{rows} rows"), error, run.simulation.at_rest(&report)))
}

/// A block on an incline of 30° that settles and then slides for 1 s under 20°; error of the slip.
pub(super) fn incline(integrator: Integrator, size: f64, step: Option<f64>) -> Result<Entry, Trouble> {
    let (dip, friction) = (30f64.to_radians(), 20f64.to_radians());
    let turn = |x: f64, y: f64| [dip.cos() * x + dip.sin() * y, -dip.sin() * x + dip.cos() * y];
    let corners = [(-1.0, -0.8), (5.0, -0.8), (5.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0), (-1.0, 0.0)];
    let text = format!(
        "title = \"Incline\"\n[domain]\noutline = {:?}\n[mesh]\nsize = {size:e}\norigin = [0.031, 0.017]\n[[joint]]\n\
         points = {:?}\n[joint_law.joint]\nfriction_deg = 35.0\n[rock.rock]\ndensity = 2650.0\nyoung = 1e10\n\
         poisson = 0.25\n[[fix]]\nblock = {:?}\n[[monitor]]\nname = \"block\"\npoint = {:?}\n[[stage]]\n\
         name = \"settle\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-7\n[[stage]]\nname = \"slide\"\n\
         kind = \"dynamic\"\nduration = 1.0\ndamping = 0.1\n[[stage.law]]\nlaw = \"joint\"\nfriction_deg = 20.0\n{}",
        corners.map(|(x, y)| turn(x, y)),
        [turn(0.0, 0.0), turn(1.0, 0.0)],
        turn(-0.5, -0.4),
        turn(0.52, 0.48),
        step_line(step)
    );
    let mut run = Run::start(integrator, text)?;
    let report = run.simulation.run_stage()?;
    let at_rest = run.simulation.at_rest(&report);
    run.simulation.next_stage()?;
    let (start, from) = (run.simulation.time(), run.simulation.monitor(0).0);
    run.simulation.run_stage()?;
    let (slid, time) = ((run.simulation.monitor(0).0 - from).norm(), run.simulation.time() - start);
    let exact = 0.5 * 9.81 * (dip.sin() - dip.cos() * friction.tan()) * time * time;
    let variant = step.map_or_else(|| format!("h = {size} m"), |dt| format!("dt = {dt:.2e} s"));
    Ok(run.entry("sliding block", variant, slid / exact - 1.0, at_rest))
}

/// The slope under its weight; difference of the final places of all blocks from those in `places`, which the first
/// call fills.
pub(super) fn slope(integrator: Integrator, spacing: f64, places: &mut Vec<Vector>) -> Result<Entry, Trouble> {
    let mut run = Run::start(integrator, slope_text(spacing, 0.0))?;
    let report = run.simulation.run_stage()?;
    let at_rest = run.simulation.at_rest(&report);
    let mine = block_displacements(&run.simulation);
    if places.is_empty() {
        places.clone_from(&mine);
    }
    let error = difference(&mine, places);
    Ok(run.entry("fractured slope", format!("spacing {spacing} m"), error, at_rest))
}

/// The slope that fails: the cost of so many seconds alone, and its totals; its error is the difference of the mean
/// displacement from that of the explicit method, which comes first.
pub(super) fn failure(integrator: Integrator, spacing: f64, known: &mut Option<Totals>) -> Result<Failure, Trouble> {
    let mut run = Run::start(integrator, slope_text(spacing, 2.0 * FAILING))?;
    let report = run.simulation.run_stage()?;
    let at_rest = run.simulation.at_rest(&report);
    run.restart();
    let totals = fail(&mut run.simulation, FAILING)?;
    let error = totals.displacement / known.get_or_insert(totals).displacement - 1.0;
    let entry = run.entry("slope that fails", format!("spacing {spacing} m"), error, at_rest);
    Ok(Failure { entry, totals })
}
