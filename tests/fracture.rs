//! Bonds along given planes break at the load and in the way that fracture mechanics and the field know.

use enmm::geometry::Vector;
use enmm::model::Simulation;

use crate::common::extent::by_extent;
use crate::common::{run_stage, simulation};

/// A3: a double cantilever of two arms of 0.1 m with a crack of 0.5 m, pulled apart at its end by a force (N/m).
fn cantilever(force: f64, size: f64) -> String {
    format!(
        "title = \"double cantilever\"\n[domain]\noutline = [[0, -0.1], [1, -0.1], [1, 0.1], [0, 0.1]]\n[mesh]\n\
         size = {size}\nangle_deg = 8\norigin = [0.00137, 0.00071]\n[[joint]]\npoints = [[0, 0], [0.5, 0]]\n\
         law = \"crack\"\n[[bridge]]\npoints = [[0.5, 0], [1, 0]]\nlaw = \"rock\"\n\
         [rock.rock]\ndensity = 2600\nyoung = 30e9\npoisson = 0.25\n[joint_law.crack]\nfriction_deg = 0\n\
         [joint_law.rock]\nfriction_deg = 45\ncohesion = 30e6\nresidual_cohesion = 0\ntension = 10e6\n\
         tension_energy = 50\nshear_energy = 5000\nnormal_stiffness = 1e14\nshear_stiffness = 1e14\n[gravity]\ny = 0\n\
         [[fix]]\nedge = [[1, -0.1], [1, 0.1]]\n\
         [[load]]\nkind = \"traction\"\nedge = [[0, 0], [0, 0.1]]\ntraction = [0, {up:?}]\n\
         [[load]]\nkind = \"traction\"\nedge = [[0, -0.1], [0, 0]]\ntraction = [0, {down:?}]\n\
         [[stage]]\nname = \"pull\"\nkind = \"static\"\nduration = 1\n",
        up = force / 0.1,
        down = -force / 0.1,
    )
}

/// E' = 32 GPa, G = 50 J/m²: beams split at 23.094 kN/m, arms that give where they are held (Williams: longer by 0.669
/// of their height) at 20.369 kN/m.
#[test]
fn long_a_double_cantilever_splits_at_the_load_of_its_energy() {
    let sizes: [&[f64]; 3] = [&[0.01], &[0.01], &[0.01, 0.006]];
    for &size in by_extent(sizes) {
        let broken = [0.95, 1.05].map(|share| {
            let mut simulation = simulation(&cantilever(20.369e3 * share, size));
            run_stage(&mut simulation);
            simulation.state().counters.broken
        });
        println!("h {size}: {broken:?} m broken at 0.95 and 1.05 of the load");
        assert!(broken[0] < 2.0 * size && broken[1] > 0.3, "h {size}: {broken:?} m broken");
    }
}

/// A12: two joints of 0.9 m, of which the second one lies `step` (m) higher, and a bridge of 0.2 m between their ends;
/// the rock above moves to the left.
fn two_joints(step: f64, [x, y]: [f64; 2]) -> String {
    let (half, low, high) = (if step == 0.0 { 0.1 } else { 0.0 }, -0.5 * step, 0.5 * step);
    format!(
        "title = \"two joints\"\n[domain]\noutline = [[-1, -1], [1, -1], [1, 1], [-1, 1]]\n\
         joint_law = \"joint\"\n[mesh]\nsize = 0.23\nangle_deg = 8\n\
         origin = [{x:?}, {y:?}]\n[[joint]]\npoints = [[-1, {low}], [{left}, {low}]]\n\
         [[joint]]\npoints = [[{half}, {high}], [1, {high}]]\n\
         [[bridge]]\npoints = [[{left}, {low}], [{half}, {high}]]\nlaw = \"rock\"\n\
         [rock.rock]\ndensity = 2600\nyoung = 30e9\npoisson = 0.25\n[joint_law.joint]\nfriction_deg = 30\n\
         [joint_law.rock]\nfriction_deg = 45\ncohesion = 1e6\nresidual_cohesion = 0\ntension = 0.5e6\n\
         tension_energy = 50\nshear_energy = 1000\n[[fix]]\nedge = [[-1, -1], [1, -1]]\n\
         [[initial_velocity]]\nblock = [0, 0.9]\nvelocity = [-2.0, 0]\n\
         [[stage]]\nname = \"shear\"\nkind = \"dynamic\"\nduration = 1.0\ndamping = 0\n",
        left = -half,
    )
}

/// Opening and slip (m) of the bridge when it has broken: means over its contacts.
fn ways(text: &str) -> [f64; 2] {
    let mut simulation = simulation(text);
    while simulation.state().counters.broken < 0.19 {
        simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
        assert!(simulation.time() < 0.5, "{} m broken", simulation.state().counters.broken);
    }
    apart(&simulation)
}

/// How far the faces of the bridge have moved apart, and along each other (m).
fn apart(simulation: &Simulation) -> [f64; 2] {
    let (boundary, positions) = (&simulation.model().boundary, simulation.positions());
    let bridge = simulation.built().traces.len() - 1;
    let line = &simulation.built().traces[bridge].0;
    let along = (line[1] - line[0]).normalize();
    let mut means = [(Vector::zeros(), 0.0); 2];
    for edge in boundary.edges().filter(|&edge| boundary.trace[edge].is_some_and(|trace| trace.index() == bridge)) {
        let way = boundary.reference[boundary.after(edge)] - boundary.reference[edge];
        let (sum, length) = &mut means[usize::from(way.dot(&along) > 0.0)];
        *sum += (positions[edge] - boundary.reference[edge]) * way.norm();
        *length += way.norm();
    }
    let way = means[1].0 / means[1].1 - means[0].0 / means[0].1;
    [way.perp(&along).abs(), way.dot(&along).abs()]
}

/// Twenty meshes: joints on one line join by shear of the bridge, and a step that the motion opens by tension across
/// it.
#[test]
fn joints_on_a_line_join_by_shear_and_opening_steps_by_tension() {
    for seed in 0..20 {
        let origin = [0.0137 + 0.0113 * f64::from(seed), 0.0071 + 0.0071 * f64::from(seed * seed % 17)];
        let [line, step] = [0.0, 0.2].map(|step| ways(&two_joints(step, origin)));
        println!("origin {origin:?}: on a line {line:?}, over a step {step:?} m apart and along");
        assert!(line[1] > 5.0 * line[0], "on a line: {line:?}");
        assert!(step[0] > 5.0 * step[1], "over a step: {step:?}");
    }
}
