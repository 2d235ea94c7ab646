//! A4: momentum and energy of colliding blocks.

use enmm::model::{Simulation, StepReport};

use crate::parts::{dynamic, rock};
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble, wider_open};

pub const PROBLEM: Problem = Problem {
    id: "A4",
    title: "Momentum and energy of a set of contacts",
    source: "contacts push in opposite pairs at one point, so that linear and angular momentum keep to round-off, and \
             every joule is accounted for; catches wrong action and reaction, and energy from nowhere",
    parameters: &[
        Parameter::new("seed", "", 1.0, [0.0, 1e6], "seed of the joints"),
        Parameter::new("spacing", "m", 0.8, [0.4, 2.0], "spacing of the joints"),
        Parameter::new("friction_deg", "°", 30.0, [0.0, 70.0], "friction of the joints"),
        Parameter::new("damping", "", 0.1, [0.0, 1.0], "damping ratio of the blocks"),
        Parameter::new("speed", "m/s", 3.0, [0.1, 5.0], "speed of the projectiles"),
        Parameter::new("spin", "rad/s", 1.0, [-5.0, 5.0], "spin of the first"),
        Parameter::new("mesh", "m", 0.7, [0.25, 1.5], "mesh size"),
        Parameter::new("young", "Pa", 1e9, [1e8, 1e11], "Young's modulus"),
        Parameter::new("steps", "", 3000.0, [200.0, 40000.0], "steps"),
        Parameter::new(
            "dt_max",
            "s",
            1.0,
            [1e-7, 1.0],
            "greatest step; small without damping, for then waves of the shortest length stay, whose energy the ledger \
             knows to ½(ω dt)² only",
        ),
    ],
    quick: true,
    implicit: false,
    run,
};

/// Rock cut by two sets of joints, and two islands that fly into it, spinning; no gravity.
fn case(setup: &Setup) -> String {
    let get = |name| setup.get(name);
    let seed = get("seed") as u64;
    format!(
        "title = \"Collision\"\n[domain]\noutline = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]\n\
         islands = [[[-2.0, 0.4], [-0.2, 1.1], [-1.6, 2.3]], [[4.3, 1.2], [5.4, 0.8], [5.9, 2.2], [4.6, 2.4]]]\n\
         [mesh]\nsize = {:?}\nangle_deg = 13.0\n[[joint_set]]\nangle_deg = 10.0\nspacing = {:?}\nseed = {seed}\n\
         [[joint_set]]\nangle_deg = 85.0\nangle_sd_deg = 5.0\nspacing = {:?}\nseed = {seed}\n[joint_law.joint]\n\
         friction_deg = {:?}\n[gravity]\ny = 0.0\n[rock.rock]\ndensity = 2500.0\nyoung = {:e}\npoisson = 0.25\n\
         [[initial_velocity]]\nblock = [-1.2, 1.2]\nvelocity = [{:?}, 0.5]\nangular_velocity = {:?}\n\
         [[initial_velocity]]\nblock = [5.0, 1.6]\nvelocity = [{:?}, 0.3]\nangular_velocity = -2.0\n[[stage]]\n\
         name = \"collide\"\nkind = \"dynamic\"\nduration = 1e3\ndamping = {:?}\n[solver]\ndt_max = {:e}\n",
        get("mesh"),
        get("spacing"),
        1.25 * get("spacing"),
        get("friction_deg"),
        get("young"),
        get("speed"),
        get("spin"),
        -0.7 * get("speed"),
        get("damping"),
        get("dt_max"),
    )
}

/// Penetration (m) from which blocks have met.
const LEAST: f64 = 1e-5;

/// Largest change of linear and angular momentum over M|v| and M|v|·5 m, and the report with the worst ledger.
fn collide(simulation: &mut Simulation, steps: u64, curve: &mut Curve) -> Result<([f64; 2], StepReport), Trouble> {
    let (linear, angular) = simulation.momentum();
    let mass: f64 = simulation.model().mass_matrix.total.iter().sum();
    let scale = mass * 0.5;
    let (mut worst, mut report) = ([0.0f64; 2], StepReport::default());
    for k in 0..steps {
        let now = simulation.advance(k % 20 == 19)?;
        let (p, l) = simulation.momentum();
        worst[0] = worst[0].max((p - linear).norm() / scale);
        worst[1] = worst[1].max((l - angular).abs() / (5.0 * scale));
        if now.dt > 0.0 {
            let ledger = &now.ledger;
            curve.push([now.time, ledger.kinetic, ledger.strain + ledger.stored, ledger.friction, ledger.residual()]);
            report = wider_open(report, now);
        }
    }
    Ok((worst, report))
}

/// Time (s), kinetic energy, energy of springs and rock, friction, residual (J/m).
type Curve = Vec<[f64; 5]>;

/// Forces (N/m) that push a crack shut, and steps for which they do.
const SHUT: (f64, u64) = (2e6, 400);

/// The two faces of a crack that opposite forces push shut strike each other within one block, which gains no momentum.
fn crack(setup: &mut Setup) -> Result<Row, Trouble> {
    let (force, steps) = SHUT;
    let push =
        |y: f64, force: f64| format!("[[load]]\nkind = \"point\"\npoint = [0.2, {y:?}]\nforce = [0.0, {force:e}]\n");
    let text = format!(
        "title = \"Crack\"\n[domain]\noutline = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.5], [0.0, 1.5]]\n[mesh]\nsize = 0.45\n\
         [[joint]]\npoints = [[-0.1, 0.7], [1.7, 0.8]]\n[joint_law.joint]\nfriction_deg = 30.0\n[gravity]\ny = 0.0\n\
         {}{}{}{}",
        rock(1e9, 2500.0),
        push(1.5, -force),
        push(0.0, force),
        dynamic("shut", 10.0, 0.1),
    );
    let mut simulation = setup.simulation("a4_crack", text)?;
    let mut report = StepReport::default();
    for step in 1..=steps {
        report = simulation.advance(step == steps)?;
    }
    let carried: f64 = simulation.state().contacts.iter().map(|contact| contact.normal_force).sum();
    if report.locked == 0 || carried < 0.05 * force {
        return Err(Trouble(format!("A4: the crack bears {carried} N/m only: its faces have not met")));
    }
    let impulse = force * steps as f64 * simulation.model().dt;
    let found = simulation.momentum().0.norm() / impulse;
    let row = Row::new("momentum of a block whose crack is pushed shut, over the impulse of a force", "", found, 0.0);
    Ok(row.at_most(1e-11, "400 opposite impulses round to √400·2e-16 of them"))
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let text = case(setup);
    let mut simulation = setup.simulation("a4", text)?;
    let steps = if setup.quick { setup.get("steps").min(1000.0) } else { setup.get("steps") };
    let mut curve = Curve::new();
    let (worst, report) = collide(&mut simulation, steps as u64, &mut curve)?;
    let reason = "impulses come in opposite pairs at one point: rounding alone, some √(3e5)·2e-16 over the run; 1e-11";
    let within = |row: Row| row.at_most(1e-11, reason);
    let counters = &simulation.state().counters;
    let judged = counters.contacts_solved as f64;
    if counters.penetration_max < LEAST {
        let deepest = counters.penetration_max;
        return Err(Trouble(format!(
            "A4: no block has met another by more than {deepest:e} m: more steps, or more speed"
        )));
    }
    let rows = vec![
        within(Row::new("largest change of linear momentum over M·0.5 m/s", "", worst[0], 0.0)),
        within(Row::new("largest change of angular momentum over M·0.5 m/s·5 m", "", worst[1], 0.0)),
        Row::new("contacts judged", "", judged, judged),
        Row::ledger(&report),
        crack(setup)?,
    ];
    let line = |k: usize| curve.iter().map(|p| [p[0], p[k]]).collect::<Vec<_>>();
    let plot = Plot::new("Energies of a collision", ["time [s]", "energy [J/m]"])
        .line("kinetic", line(1))
        .line("stored", line(2))
        .line("friction", line(3))
        .line("residual (exact: 0)", line(4));
    Ok(Outcome { rows, plots: vec![plot] })
}
