//! Claim A2: blocks that touch nothing fall by ½gt², without stress or spin.

mod common;

use common::claims::{advance, block_at, dynamic, rock, stresses};
use common::simulation;
use enmm::geometry::Vector;
use enmm::step::block_motion;

/// A rock with a dead-end joint, an island larger than the mesh, one of a mesh size and a sliver; wide gaps between.
fn case(gravity: [f64; 2], mesh: &str, damping: f64) -> String {
    format!(
        "title = \"fall\"\n[domain]\noutline = [[0.0, 0.0], [4.0, 0.5], [3.0, 4.0], [-1.0, 3.0]]\nislands = [\n\
         [[6.0, 0.0], [9.0, 0.0], [9.5, 2.5], [7.0, 4.0], [7.5, 2.0]],\n[[6.0, 6.0], [6.9, 6.2], [6.3, 6.9]],\n\
         [[0.0, 6.0], [5.0, 6.05], [5.0, 6.11], [0.0, 6.06]]]\n[mesh]\n{mesh}\n[joint_law.joint]\nfriction_deg = 20.0\n\
         [[joint]]\npoints = [[1.0, 1.0], [3.0, 3.0]]\n[gravity]\nx = {}\ny = {}\n{}{}",
        gravity[0],
        gravity[1],
        rock(2e9, 2400.0),
        dynamic("fall", 10.0, damping)
    )
}

/// Leapfrog from v0 = 0 with a half kick is exact for constant acceleration: u = ½g(n dt)². Each step rounds by ε of
/// the place and the sum of n steps by n·ε at most: 5e3·2e-16 = 1e-12, taken ten times. Stress sees differences of u.
#[test]
fn every_point_falls_by_half_g_t_squared() {
    let meshes = ["size = 1.0", "size = 0.7\nangle_deg = 17.0\norigin = [0.123, 0.456]"];
    for (gravity, mesh, damping) in
        [([0.0, -9.81], meshes[0], 0.1), ([0.0, -9.81], meshes[1], 0.0), ([1.7, -3.1], meshes[1], 0.1)]
    {
        let mut simulation = simulation(&case(gravity, mesh, damping));
        let steps = 5000;
        let report = advance(&mut simulation, steps);
        let t = steps as f64 * simulation.model().dt;
        let fall = Vector::from(gravity) * (0.5 * t * t);
        assert!(fall.norm() > 1.0);
        for u in &simulation.state().displacement {
            assert!((u - fall).norm() <= 1e-11 * fall.norm(), "{u} against {fall}");
        }
        let stress = stresses(&simulation, simulation.state());
        let largest = stress.iter().flatten().fold(0.0f64, |a, s| a.max(s.abs()));
        assert!(largest <= 1e-12 * 2e9 * fall.norm().max(1.0), "{largest:e} Pa after {} m", fall.norm());
        for point in [[0.5, 0.6], [8.0, 1.0], [6.4, 6.4], [2.5, 6.05]] {
            let block = block_at(&simulation, point);
            let slope = simulation.model();
            let (_, velocity, spin, _) =
                block_motion(slope, simulation.state(), &simulation.workspace().mass_matrix, block);
            // Rounding of v over the size of a block (0.4 m and more).
            assert!(spin.abs() <= 1e-11 * velocity.norm(), "spin {spin:e} at {point:?}");
        }
        assert_eq!(simulation.model().covers.block_count(), 4);
        // ½v² is compared at full steps, where the mean of the half-step energies exceeds it by (g·dt)²/8.
        assert!(report.ledger.residual().abs() < 1e-6 * report.ledger.largest(), "{:?}", report.ledger);
    }
}
