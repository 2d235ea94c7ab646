//! An undamped elastic block keeps its energy: leapfrog drifts by less than 1e-6 in 2e4 steps.

mod common;

use common::claims::{dynamic, rock};
use common::simulation;
use enmm::geometry::Vector;
use enmm::model::Simulation;
use enmm::step::energies;

/// One irregular block that swings freely after a uniform stretch.
fn case(mesh: &str) -> String {
    format!(
        "title = \"swing\"\n[domain]\noutline = [[0.0, 0.0], [3.0, 0.2], [3.4, 1.6], [1.8, 1.2], [0.3, 1.9]]\n\
        [mesh]\n{mesh}\n\
         [gravity]\ny = 0.0\n{}{}",
        rock(1e9, 2500.0),
        dynamic("swing", 1e3, 0.0)
    )
}

/// ½v⁻·M·v⁺ + U: what leapfrog keeps exactly in a linear system. The product of two fields is a difference of squares.
fn kept(simulation: &mut Simulation) -> f64 {
    let before = simulation.state().clone();
    simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
    let after = &simulation.state().velocity;
    let with = |f: &dyn Fn(&Vector, &Vector) -> Vector| {
        let mut state = before.clone();
        state.velocity = before.velocity.iter().zip(after).map(|(a, b)| f(a, b)).collect();
        energies(simulation.slope(), &state, &simulation.scratch().metric)
    };
    let mean = with(&|a, b| (a + b) * 0.5);
    mean.kinetic - with(&|a, b| (b - a) * 0.5).kinetic + mean.strain
}

/// Strain of 1e-6 keeps the corotated block linear to 1e-6 of its energy, a difference that swings; the drift between
/// the means over 500 steps at both ends of 2e4 steps is what rounding leaves: 2e4·1e-16 and the rest of that swing.
#[test]
fn an_undamped_block_keeps_its_energy() {
    for mesh in ["size = 0.4", "size = 0.9\nangle_deg = 21.0\norigin = [0.2, 0.1]"] {
        let mut simulation = simulation(&case(mesh));
        let mut state = simulation.state().clone();
        let stars = &simulation.slope().covers.star_position;
        state.displacement = stars.iter().map(|x| Vector::new(1e-6 * x.x + 4e-7 * x.y, -7e-7 * x.y)).collect();
        simulation.restore(state);
        // The first kick is half a step, from rest: the sum holds from the second on.
        simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
        let first = kept(&mut simulation);
        let (mut worst, mut largest) = (0.0f64, 0.0f64);
        for _ in 0..20_000 {
            let report = simulation.advance(false);
            report.unwrap_or_else(|e| panic!("{e}"));
            largest = largest.max(simulation.state().velocity[0].norm());
        }
        for _ in 0..100 {
            worst = worst.max((kept(&mut simulation) / first - 1.0).abs());
        }
        println!("{mesh:?}: {first:e} J, drift {worst:e}");
        assert!(first > 0.0 && largest > 1e-5, "it must swing: {largest:e} m/s");
        assert!(worst < 1e-6, "drift {worst:e}");
    }
}
