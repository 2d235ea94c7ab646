//! Claim A4: contacts keep linear and angular momentum to round-off, and the energy ledger closes.

mod common;

use common::claims::{assert_ledger, dynamic, rock};
use common::simulation;
use enmm::model::Simulation;

/// Blocks of one rock: joints at 1 m and islands that fly into it, spinning; no gravity.
fn collision(seed: u64, friction: f64, damping: f64, young: f64) -> String {
    format!(
        "title = \"collision\"\n[domain]\noutline = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]\n\
         islands = [[[-2.0, 0.4], [-0.2, 1.1], [-1.6, 2.3]], [[4.3, 1.2], [5.4, 0.8], [5.9, 2.2], [4.6, 2.4]]]\n\
         [mesh]\nsize = 0.7\nangle_deg = 13.0\n[[joint_set]]\ndip_deg = 10.0\nspacing = 0.8\nseed = {seed}\n\
         [[joint_set]]\ndip_deg = 85.0\ndip_sd_deg = 5.0\nspacing = 1.0\nseed = {seed}\n\
         [joint_law.joint]\nfriction_deg = {friction}\n[gravity]\ny = 0.0\n{}\
         [[initial_velocity]]\nblock = [-1.2, 1.2]\nvelocity = [3.0, 0.5]\nangular_velocity = 1.0\n\
         [[initial_velocity]]\nblock = [5.0, 1.6]\nvelocity = [-2.0, 0.3]\nangular_velocity = -2.0\n{}",
        rock(young, 2500.0),
        dynamic("collide", 10.0, damping)
    )
}

/// Largest deviation of the two momenta from their start over a run, relative to `scale` = Σ M|v| and Σ M|v|·5 m.
fn momentum_drift(simulation: &mut Simulation, steps: u64, scale: f64) -> [f64; 2] {
    let (linear, angular) = simulation.momentum();
    let mut worst = [0.0f64; 2];
    for k in 0..steps {
        let report = simulation.advance(k % 100 == 99).unwrap_or_else(|e| panic!("{e}"));
        let (p, l) = simulation.momentum();
        worst[0] = worst[0].max((p - linear).norm() / scale);
        worst[1] = worst[1].max((l - angular).abs() / (5.0 * scale));
        if report.dt > 0.0 {
            assert_ledger(&report);
        }
    }
    worst
}

/// Impulses come in opposite pairs at one point (theory §5) and damping leaves momentum alone, so that only rounding
/// remains: 3000 steps with some 100 impulses each add up like a random walk, √(3e5)·2e-16 = 1e-13; 1e-11 is taken.
///
/// Without damping the impact leaves waves of the shortest length, whose energy the ledger holds to ½(ω dt)² only
/// (theory Eq. 28, ω dt up to 1.8), and block inertia follows the strain: that run has a stiff rock and a small step.
#[test]
fn collisions_keep_linear_and_angular_momentum() {
    for (seed, friction, damping, young, dt_max, steps) in [
        (1, 30.0, 0.1, 1e9, 1.0, 3000),
        (2, 0.0, 0.0, 1e11, 2.5e-6, 36_000),
        (3, 60.0, 0.5, 1e9, 1.0, 3000),
        (4, 20.0, 0.1, 1e9, 2e-4, 3000),
    ] {
        let text = format!("{}[solver]\ndt_max = {dt_max:e}\n", collision(seed, friction, damping, young));
        let mut simulation = simulation(&text);
        let mass: f64 = simulation.model().mass_matrix.total.iter().sum();
        assert!(simulation.model().covers.block_count() > 12);
        let [linear, angular] = momentum_drift(&mut simulation, steps, mass * 0.5);
        println!("seed {seed}: linear {linear:e}, angular {angular:e}");
        let (contacts, deepest) = (simulation.state().counters.judged, simulation.state().counters.penetration_max);
        assert!(contacts > 10_000 && deepest > 1e-4, "the blocks must meet: {contacts}, {deepest:e} m");
        assert!(linear < 1e-11, "seed {seed}: linear momentum drifts by {linear:e}");
        assert!(angular < 1e-11, "seed {seed}: angular momentum drifts by {angular:e}");
    }
}

/// Two faces of a crack that is pushed shut by two opposite forces strike each other within one block: nothing moves
/// the block as a whole.
#[test]
fn contacts_within_one_block_keep_its_momentum() {
    let mut simulation = simulation(&format!(
        "title = \"crack\"\n[domain]\noutline = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.5], [0.0, 1.5]]\n[mesh]\nsize = 0.45\n\
         [[joint]]\npoints = [[-0.1, 0.7], [1.7, 0.8]]\n[joint_law.joint]\nfriction_deg = 30.0\n[gravity]\ny = 0.0\n\
         [[load]]\nkind = \"point\"\npoint = [0.2, 1.5]\nforce = [0.0, -2e6]\n[[load]]\nkind = \"point\"\n\
         point = [0.2, 0.0]\nforce = [0.0, 2e6]\n{}{}",
        rock(1e9, 2500.0),
        dynamic("shut", 10.0, 0.1)
    ));
    let report = common::claims::advance(&mut simulation, 400);
    let carried: f64 = simulation.state().contacts.iter().map(|c| c.normal_force).sum();
    assert!(carried > 1e5, "the crack must bear: {carried}");
    let (linear, _) = simulation.momentum();
    let time = 400.0 * simulation.model().dt;
    // 400 steps of impulses of 2e6·dt each round to √400·2e-16 of them.
    assert!(linear.norm() <= 1e-11 * 2e6 * time, "{linear}");
    assert!(report.locked > 0);
}
