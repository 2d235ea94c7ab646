//! The models of the comparison: a beam, a block on an incline, a fractured slope.

use enmm::cover::BlockId;
use enmm::geometry::Vector;
use enmm::model::Simulation;
use enmm::model::case::Integrator;
use enmm::step::energies;

use super::{Entry, FAILING, Failure, Run};
use crate::Trouble;
use crate::problems::{Beam, Plane};

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

/// A slope of 100 m under two sets of joints at a spacing (m); it settles under a friction of 50°; under 45°
/// one of 3.2 m does not.
pub fn slope_text(spacing: f64, seconds: f64) -> String {
    let set = |dip: f64, seed: u32, ratio: f64| {
        format!(
            "[[joint_set]]\nangle_deg = {dip:?}\nangle_sd_deg = 1.0\nspacing = {:e}\nspacing_sd = {:e}\nseed = {seed}\n\
             region = [[58, 18], [122, 122], [200, 122]]\n",
            spacing * ratio,
            0.16 * spacing
        )
    };
    let failure = format!(
        "[[stage]]\nname = \"failure\"\nkind = \"dynamic\"\nduration = {seconds:e}\ndamping = 0.1\n[[stage.law]]\n\
         law = \"joint\"\nfriction_deg = 28.0\n"
    );
    format!(
        "title = \"Fractured slope\"\n[domain]\n\
         outline = [[0, 0], [230, 0], [230, 120], [120, 120], [60, 20], [0, 20]]\n[mesh]\nsize = {:e}\n\
         angle_deg = 7.0\n{}{}[rock.gneiss]\ndensity = 2650\nyoung = 5e9\npoisson = 0.25\n\
         [joint_law.joint]\nfriction_deg = 50\n[[fix]]\nedge = [[0, 0], [230, 0]]\n[[fix]]\nedge = [[0, 0], [0, 20]]\n\
         axes = \"x\"\n[[fix]]\nedge = [[230, 0], [230, 120]]\naxes = \"x\"\n[[stage]]\nname = \"gravity\"\n\
         kind = \"static\"\nduration = 12.0\n{}",
        0.65 * spacing,
        set(36.0, 11, 1.0),
        set(118.0, 12, 1.06),
        if seconds > 0.0 { failure } else { String::new() },
    )
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

/// What a slope has done since it began to fail. Single blocks go their own ways; these sums hardly know them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Totals {
    /// Potential energy set free (J/m).
    pub released: f64,
    /// Kinetic energy (J/m).
    pub kinetic: f64,
    /// Heat of slip (J/m).
    pub friction: f64,
    /// Mean displacement of all rock (m).
    pub displacement: f64,
}

impl Totals {
    /// Names with units, in the order of [`Totals::values`].
    pub const NAMES: [(&str, &str); 4] = [
        ("potential energy released", "J/m"),
        ("kinetic energy", "J/m"),
        ("heat of slip", "J/m"),
        ("mean displacement of all rock", "m"),
    ];

    /// The totals in the order of their names.
    pub fn values(&self) -> [f64; 4] {
        [self.released, self.kinetic, self.friction, self.displacement]
    }

    fn now(simulation: &Simulation, places: &[Vector]) -> Self {
        let ledger = energies(simulation.model(), simulation.state(), &simulation.workspace().mass_matrix);
        let moved = block_displacements(simulation);
        let mass = &simulation.model().mass_matrix.total;
        let way: f64 = moved.iter().zip(places).zip(mass).map(|((now, then), mass)| mass * (now - then).norm()).sum();
        Self {
            released: -ledger.potential,
            kinetic: ledger.kinetic,
            friction: ledger.friction,
            displacement: way / mass.iter().sum::<f64>(),
        }
    }

    /// These beside those of the start, and `share` of the way to `next`.
    fn since(&self, start: &Self, next: &Self, share: f64) -> Self {
        let between = |of: fn(&Self) -> f64| of(self) + share * (of(next) - of(self)) - of(start);
        Self {
            released: between(|t| t.released),
            kinetic: between(|t| t.kinetic),
            friction: between(|t| t.friction),
            displacement: between(|t| t.displacement),
        }
    }
}

/// Begins the failure of a slope at rest; its totals after exactly so many seconds, between the two steps about them.
pub(crate) fn fail(simulation: &mut Simulation, seconds: f64) -> Result<Totals, Trouble> {
    let places = block_displacements(simulation);
    let first = Totals::now(simulation, &places);
    simulation.next_stage()?;
    let steps = seconds / simulation.model().dt;
    for _ in 0..steps as u64 {
        simulation.advance(false)?;
    }
    let before = Totals::now(simulation, &places);
    simulation.advance(false)?;
    Ok(before.since(&first, &Totals::now(simulation, &places), steps.fract()))
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

/// Mean displacement of every block (m).
pub(crate) fn block_displacements(simulation: &Simulation) -> Vec<Vector> {
    let slope = simulation.model();
    let of = |b: BlockId| {
        let covers = slope.covers.covers_of(b);
        let sum: Vector = covers.map(|i| simulation.state().displacement[i] * slope.mass_matrix.row_sum[i]).sum();
        sum / slope.mass_matrix.total[b]
    };
    slope.covers.blocks().map(of).collect()
}

/// Root mean square of the difference of two displacement fields over that of the second.
pub(crate) fn difference(a: &[Vector], b: &[Vector]) -> f64 {
    let square = |v: f64| v.max(f64::MIN_POSITIVE);
    let apart: f64 = a.iter().zip(b).map(|(a, b)| (a - b).norm_squared()).sum();
    (apart / square(b.iter().map(Vector::norm_squared).sum())).sqrt()
}
