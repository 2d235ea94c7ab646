//! Impacts without damping keep their energy: a block that drops on a corner has as much of it afterwards (Eq. 86).

use crate::common::simulation;

/// A square of 1 m that drops by half a metre on rigid ground, turned by an angle (degrees), on joints of a stiffness
/// (Pa/m) without friction.
fn drop(angle_deg: f64, stiffness: f64) -> String {
    let (s, c) = angle_deg.to_radians().sin_cos();
    let corners =
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]: [f64; 2]| [c * x - s * y, s * x + c * y + 0.5]);
    format!(
        "title = \"drop\"\n[domain]\njoint_law = \"smooth\"\noutline = [[-4, -1], [5, -1], [5, 0], [-4, 0]]\n\
         islands = [{corners:?}]\n\
         [mesh]\nsize = 0.6\nangle_deg = 7.0\norigin = [0.13, 0.29]\n[rock.rock]\ndensity = 2600.0\nyoung = 1e12\n\
         poisson = 0.25\n[joint_law.smooth]\nfriction_deg = 0.0\nnormal_stiffness = {stiffness:e}\n\
         shear_stiffness = {stiffness:e}\n[[fix]]\nblock = [0.5, -0.5]\n\
         [[stage]]\nname = \"fall\"\nkind = \"dynamic\"\nduration = 400.0\ndamping = 0.0\n"
    )
}

/// Largest relative change of the energy of the block in the impacts of some seconds, and the number of impacts.
fn worst_change(angle_deg: f64, stiffness: f64, seconds: f64) -> (f64, u32) {
    let mut simulation = simulation(&drop(angle_deg, stiffness));
    let block = simulation.block_states().iter().position(|block| !block.fixed).expect("a block");
    let steps = simulation.steps_in(seconds);
    let energy = |simulation: &enmm::model::Simulation| {
        let state = &simulation.block_states()[block];
        (state.kinetic_energy + state.strain_energy + state.mass * 9.81 * state.centroid.y, state.detached)
    };
    let (mut flying, mut worst, mut impacts, mut before) = (true, 0.0f64, 0, energy(&simulation).0);
    for _ in 0..steps {
        simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
        let (now, detached) = energy(&simulation);
        if detached && !flying {
            worst = worst.max((now / before - 1.0).abs());
            (impacts, before) = (impacts + 1, now);
        }
        flying = detached;
    }
    (worst, impacts)
}

#[test]
fn a_block_that_drops_on_a_corner_keeps_its_energy() {
    for stiffness in [1e8, 1e9] {
        for angle in [3.0, 10.0, 20.0, 30.0, 44.0] {
            let (worst, impacts) = worst_change(angle, stiffness, 3.0);
            println!("{angle}°, {stiffness:e} Pa/m: {worst:.2e} in {impacts} impacts");
            assert!(impacts >= 4 && worst < 1e-4, "{angle}°, {stiffness:e} Pa/m: {worst:.2e} in {impacts} impacts");
        }
    }
}
