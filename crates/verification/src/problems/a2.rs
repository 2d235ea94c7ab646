//! A2: free fall.

use enmm::geometry::Vector;
use enmm::model::StepReport;
use enmm::model::tables::BlockId;

use crate::random::Random;
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Tolerance, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "A2",
    title: "Free fall",
    source: "blocks that touch nothing fall by ½gt² without stress or spin; catches wrong mass of cut covers and \
             gravity that strains",
    parameters: &[
        Parameter::new("g", "m/s²", 9.81, [0.01, 100.0], "gravity"),
        Parameter::new("direction_deg", "°", -90.0, [-360.0, 360.0], "its direction"),
        Parameter::new("t", "s", 2.0, [0.05, 5.0], "time of the fall"),
        Parameter::new("mesh", "m", 0.7, [0.3, 2.0], "mesh size beside blocks of 1 to 5 m"),
        Parameter::new("mesh_angle_deg", "°", 17.0, [-180.0, 180.0], "turn of the mesh"),
        Parameter::new("seed", "", 1.0, [0.0, 1e6], "seed of the shapes"),
        Parameter::new("young", "Pa", 2e9, [1e6, 1e11], "Young's modulus"),
        Parameter::new("damping", "", 0.1, [0.0, 1.0], "damping ratio of the blocks"),
    ],
    quick: true,
    implicit: true,
    run,
};

/// Why the ledger may be open.
const LEDGER: &str = "energies at full steps are the means of those of half steps, which exceed ½v² by (g·dt)²/8: \
                      1/4n² of ½v² after n steps";

/// A rock with a dead-end joint, and two islands of random shape and a sliver well apart.
fn case(setup: &Setup) -> String {
    let mut random = Random::new(setup.get("seed") as u64);
    let mut ring = |x: f64, y: f64, size: f64| {
        let count = 3 + random.between(0.0, 4.99) as usize;
        let corner = |k: usize| {
            let angle = std::f64::consts::TAU * (k as f64 + random.between(0.0, 0.7)) / count as f64;
            let radius = size * random.between(0.5, 1.0);
            format!("[{:?}, {:?}]", x + radius * angle.cos(), y + radius * angle.sin())
        };
        format!("[{}]", (0..count).map(corner).collect::<Vec<_>>().join(", "))
    };
    let islands =
        [ring(8.0, 1.5, 2.0), ring(7.0, 7.0, 0.6), "[[0.0, 6.0], [5.0, 6.05], [5.0, 6.11], [0.0, 6.06]]".into()];
    let (s, c) = setup.get("direction_deg").to_radians().sin_cos();
    let g = setup.get("g");
    format!(
        "title = \"Fall\"\n[domain]\noutline = [[0.0, 0.0], [4.0, 0.5], [3.0, 4.0], [-1.0, 3.0]]\nislands = [{}]\n\
         [mesh]\nsize = {:?}\nangle_deg = {:?}\n[joint_law.joint]\nfriction_deg = 20.0\n[[joint]]\n\
         points = [[1.0, 1.0], [3.0, 3.0]]\n[gravity]\nx = {:e}\ny = {:e}\n[rock.rock]\ndensity = 2400.0\n\
         young = {:e}\npoisson = 0.25\n[[stage]]\nname = \"fall\"\nkind = \"dynamic\"\nduration = 1e3\n\
         damping = {:?}\n",
        islands.join(", "),
        setup.get("mesh"),
        setup.get("mesh_angle_deg"),
        g * c,
        g * s,
        setup.get("young"),
        setup.get("damping"),
    )
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let text = case(setup);
    let mut simulation = setup.simulation("a2", text)?;
    let wanted = if setup.quick { setup.get("t").min(0.5) } else { setup.get("t") };
    let steps = simulation.steps_in(wanted).max(2);
    let g = setup.get("g");
    let (mut points, mut report) = (Vec::new(), StepReport::default());
    for step in 1..=steps {
        report = simulation.advance(step == steps)?;
        if step.is_multiple_of((steps / 12).max(1)) {
            points.push([simulation.time(), simulation.state().displacement[0].norm()]);
        }
    }
    let t = simulation.time();
    let (s, c) = setup.get("direction_deg").to_radians().sin_cos();
    let fall = Vector::new(c, s) * (0.5 * g * t * t);
    let (slope, state) = (simulation.model(), simulation.state());
    let off = state.displacement.iter().map(|u| (u - fall).norm()).fold(0.0, f64::max);
    let stress = slope.covers.elements().flat_map(|e| slope.stress(state, e)).fold(0.0f64, |a, s| a.max(s.abs()));
    let spin = |b: BlockId| simulation.rigid_motion_of(b).2.abs();
    let spin = slope.covers.blocks().map(spin).fold(0.0, f64::max);
    let rows = vec![
        Row::new("fall of the first cover", "m", state.displacement[0].norm(), fall.norm())
            .relative(1e-11, "exact under constant acceleration; n steps round by n·ε at most"),
        Row::new("largest deviation of any cover over the fall", "", off / fall.norm(), 0.0).at_most(1e-11, "the same"),
        Row::new("largest stress over E", "", stress / setup.get("young"), 0.0).at_most(
            1e-12 * (fall.norm() / (100.0 * setup.get("mesh"))).max(1.0),
            "rounding of a fall U is εU, of the strain εU/h: 1e-12 up to U = 100 h, beyond in proportion",
        ),
        Row::new("largest spin of a block over its speed", "1/m", spin / (g * t), 0.0)
            .at_most(1e-11, "rounding of velocities over the size of a block"),
        Row::new("blocks", "", slope.covers.block_count() as f64, 4.0)
            .absolute(0.0, "three islands and a rock that its joint does not part"),
        Row {
            tolerance: Tolerance::AtMost(0.5 / (steps as f64).powi(2) + 1e-12),
            reason: LEDGER.into(),
            ..Row::ledger(&report)
        },
    ];
    let exact = (0..=60).map(|k| t * f64::from(k) / 60.0).map(|t| [t, 0.5 * g * t * t]).collect();
    let plot = Plot::new("Fall of a cover", ["time [s]", "fall [m]"]).line("exact", exact).marks("computed", points);
    Ok(Outcome { rows, plots: vec![plot] })
}
