//! A1: patch tests on covers that any joints cut.

use enmm::geometry::Vector;
use enmm::model::tables::ElementId;
use enmm::model::{Simulation, State};

use crate::random::Random;
use crate::{Outcome, Parameter, Plot, Problem, Row, Series, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "A1",
    title: "Patch tests on cut covers",
    source: "rigid motion of any size strains nothing, and a uniform strain has the stress of Hooke's law in every \
             element, cut or not; catches wrong weights, gradients and rotations",
    parameters: &[
        Parameter::new("seed", "", 1.0, [0.0, 1e6], "seed of the joints"),
        Parameter::new("joints", "", 12.0, [0.0, 200.0], "random joints"),
        Parameter::new("traces", "m", 4.0, [1.0, 20.0], "mean length of the traces of two joint sets"),
        Parameter::new("mesh", "m", 0.8, [0.2, 3.0], "mesh size in a rock of 12 m"),
        Parameter::new("mesh_angle_deg", "°", 17.0, [-180.0, 180.0], "turn of the mesh"),
        Parameter::new("mesh_x", "m", 0.3, [-100.0, 100.0], "shift of the mesh along x"),
        Parameter::new("mesh_y", "m", -0.2, [-100.0, 100.0], "shift of the mesh along y"),
        Parameter::new("turn_deg", "°", 30.0, [-360.0, 360.0], "rotation of the rock"),
        Parameter::new("shift", "m", 8.0, [-1e3, 1e3], "translation of the rock"),
        Parameter::new("strain", "", 2e-3, [1e-6, 1e-2], "size of the uniform strain"),
        Parameter::new("young", "Pa", 3e10, [1e6, 1e12], "Young's modulus E"),
        Parameter::new("poisson", "", 0.25, [-0.9, 0.49], "Poisson's ratio"),
    ],
    quick: true,
    implicit: false,
    run,
};

const OUTLINE: [[f64; 2]; 7] = [[0.0, 0.0], [10.0, 1.0], [11.0, 6.0], [8.0, 9.0], [6.5, 7.0], [4.0, 9.5], [-1.0, 5.0]];
/// Models of as many seeds.
const SEEDS: u64 = 12;

/// Area (m²) of the outline.
fn area() -> f64 {
    let cross = |k: usize| {
        let [a, b] = [OUTLINE[k], OUTLINE[(k + 1) % OUTLINE.len()]];
        a[0] * b[1] - a[1] * b[0]
    };
    0.5 * (0..OUTLINE.len()).map(cross).sum::<f64>()
}

/// A joint set of finite traces, which end inside blocks.
fn joint_set(random: &mut Random, traces: f64, seed: u64) -> String {
    format!(
        "[[joint_set]]\nangle_deg = {:?}\nangle_sd_deg = 8.0\nspacing = {:?}\nspacing_sd = 0.2\n\
         trace_length = {traces:?}\ntrace_length_sd = {:?}\ngap = 0.4\nseed = {seed}\n",
        random.between(-80.0, 80.0),
        random.between(0.7, 2.0),
        0.25 * traces,
    )
}

fn case(setup: &Setup, seed: u64) -> String {
    let mut random = Random::new(seed);
    let joint = |_| {
        let mut end = || [random.between(-1.0, 11.0), random.between(0.0, 9.0)];
        let ends = [end(), end()];
        format!("[[joint]]\npoints = {ends:?}\n")
    };
    let joints: String = (0..setup.get("joints") as usize).map(joint).collect();
    let sets: String = [seed, seed + 100].map(|seed| joint_set(&mut random, setup.get("traces"), seed)).concat();
    format!(
        "title = \"Patch\"\n[domain]\noutline = {OUTLINE:?}\nextend_ends = 0\n[mesh]\nleast_block = 0\nsize = {:?}\n\
         angle_deg = {:?}\norigin = [{:?}, {:?}]\n{joints}{sets}[rock.rock]\ndensity = 2600.0\nyoung = {:e}\n\
         poisson = {:?}\n[joint_law.joint]\nfriction_deg = 30.0\n[[stage]]\nname = \"none\"\nkind = \"dynamic\"\n\
         duration = 1.0\n",
        setup.get("mesh"),
        setup.get("mesh_angle_deg"),
        setup.get("mesh_x"),
        setup.get("mesh_y"),
        setup.get("young"),
        setup.get("poisson"),
    )
}

/// The state in which every star has moved by `field` of its place.
fn moved(simulation: &Simulation, field: impl Fn(Vector) -> Vector) -> State {
    let mut state = simulation.state().clone();
    state.displacement = simulation.model().covers.star_position.iter().map(|x| field(*x)).collect();
    state
}

/// Largest difference (Pa) of the stress of any element from an expected one.
fn worst(simulation: &Simulation, state: &State, expected: [f64; 3]) -> f64 {
    let slope = simulation.model();
    let of = |e: ElementId| {
        let found = slope.stress(state, e);
        (0..3).map(|k| (found[k] - expected[k]).abs()).fold(0.0, f64::max)
    };
    slope.covers.elements().map(of).fold(0.0, f64::max)
}

/// Stress (Pa) of plane strain by Hooke's law.
fn hooke(young: f64, poisson: f64, [xx, yy, xy]: [f64; 3]) -> [f64; 3] {
    let mu = young / (2.0 * (1.0 + poisson));
    let volume = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)) * (xx + yy);
    [2.0 * mu * xx + volume, 2.0 * mu * yy + volume, 2.0 * mu * xy]
}

/// Errors over E of translation, rotation, uniform strain, and strain that then turns.
fn errors(setup: &mut Setup, seed: u64) -> Result<([f64; 4], Simulation), Trouble> {
    let (young, poisson, size) = (setup.get("young"), setup.get("poisson"), setup.get("strain"));
    let text = case(setup, seed);
    let simulation = setup.simulation(&format!("a1_{seed}"), text)?;
    let shift = setup.get("shift");
    let (s, c) = setup.get("turn_deg").to_radians().sin_cos();
    let turn = |x: Vector| Vector::new(c * x.x - s * x.y, s * x.x + c * x.y);
    let mut random = Random::new(seed + 1);
    let strain = [0.0; 3].map(|_: f64| random.between(-size, size));
    let stretched = |x: Vector| Vector::new(strain[0] * x.x + strain[2] * x.y, strain[2] * x.x + strain[1] * x.y);
    let [a, b, t] = hooke(young, poisson, strain);
    let both = 2.0 * s * c * t;
    let turned = [c * c * a + s * s * b - both, s * s * a + c * c * b + both, s * c * (a - b) + (c * c - s * s) * t];
    let found = [
        worst(&simulation, &moved(&simulation, |_| Vector::new(0.4 * shift, -shift)), [0.0; 3]),
        worst(&simulation, &moved(&simulation, |x| turn(x) - x), [0.0; 3]),
        worst(&simulation, &moved(&simulation, stretched), [a, b, t]),
        worst(&simulation, &moved(&simulation, |x| turn(x + stretched(x)) - x), turned),
    ];
    Ok((found.map(|e| e / young), simulation))
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let seed = setup.get("seed") as u64;
    let mut series: [Vec<[f64; 2]>; 4] = Default::default();
    let (mut most, mut counts, mut farthest) = ([0.0f64; 4], [0; 4], area());
    for k in 0..SEEDS {
        let (found, simulation) = errors(setup, seed + k)?;
        let covers = &simulation.model().covers;
        let full = 0.75f64.sqrt() / 2.0 * covers.mesh.size.powi(2);
        counts[0] += covers.element_count();
        counts[1] += covers.element_area.iter().filter(|area| **area < 0.999 * full).count();
        counts[2] += covers.covers_by_star().iter().filter(|(_, covers)| *covers > 1).count();
        counts[3] += simulation.model().boundary.partial.iter().filter(|partial| **partial).count();
        let whole: f64 = covers.element_area.iter().sum();
        if (whole - area()).abs() >= (farthest - area()).abs() {
            farthest = whole;
        }
        for (n, error) in found.into_iter().enumerate() {
            most[n] = most[n].max(error);
            series[n].push([(seed + k) as f64, error]);
        }
    }
    let scale = (setup.get("shift").abs().max(12.0) / (100.0 * setup.get("mesh"))).max(1.0);
    let names = ["rigid translation", "rigid rotation", "uniform strain", "uniform strain, then rotation"];
    let row = |n: usize| {
        Row::new(format!("{}: largest stress error over E", names[n]), "", most[n], 0.0).at_most(
            1e-12 * scale,
            "rounding of displacements U is εU, of strain a few times εU/h, of which 1e-12 is far above to U = 100 h; \
             beyond, in proportion to U/h",
        )
    };
    let mut rows: Vec<Row> = (0..4).map(row).collect();
    rows.push(
        Row::new("area of all elements, where it is farthest from that of the rock", "m²", farthest, area())
            .absolute(1e-3, "corners are snapped to a grid and so move by at most 1.5e-5 m, along 40 m of outline"),
    );
    let counted =
        ["elements", "of which cut", "mesh nodes with several covers", "sides of joints that end inside a block"];
    rows.extend(counted.into_iter().zip(counts).map(|(name, count)| Row::new(name, "", count as f64, count as f64)));
    let line = |n: usize| Series::marks(names[n], series[n].clone());
    let plot = Plot::new("Largest stress error of random patches", ["seed", "error over E"]).with((0..4).map(line));
    Ok(Outcome { rows, plots: vec![plot] })
}
