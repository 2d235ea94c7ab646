//! Claim E2: a masonry wall and a block stack stay at rest: no drift, kinetic energy down to round-off, thin overlaps.

mod common;

use common::claims::{advance, assert_ledger, dynamic, rock};
use common::{run_stage, simulation};
use enmm::model::Simulation;

const DENSITY: f64 = 2500.0;
const YOUNG: f64 = 1e9;
const SIZE: f64 = 1.0;

/// A wall of `columns` × `rows` blocks of 1 m × 0.5 m on a held slab; every other row is shifted by half a block
/// (`bond`), or none is (a row of stacks).
fn wall(columns: usize, rows: usize, bond: bool, seconds: f64) -> String {
    let (width, height) = (columns as f64, rows as f64 * 0.5);
    let mut joints = String::new();
    for row in 0..rows {
        let (low, high) = (row as f64 * 0.5, (row + 1) as f64 * 0.5);
        joints += &format!("[[joint]]\npoints = [[0.0, {low}], [{width:.1}, {low}]]\n");
        let shift = if bond && row % 2 == 1 { 0.5 } else { 0.0 };
        for k in 0..=columns {
            let x = k as f64 + shift;
            if x > 0.0 && x < width {
                joints += &format!("[[joint]]\npoints = [[{x}, {low}], [{x}, {high}]]\n");
            }
        }
    }
    format!(
        "title = \"wall\"\n[domain]\noutline = [[-1.0, -0.6], [{right}, -0.6], [{right}, 0.0], [{width:.1}, 0.0], \
         [{width:.1}, {height}], [0.0, {height}], [0.0, 0.0], [-1.0, 0.0]]\n[mesh]\nsize = {SIZE}\n\
         origin = [0.137, 0.071]\n{joints}[joint_law.mortar]\nfriction_deg = 35.0\n[[fix]]\nblock = [-0.9, -0.5]\n{}\
         [[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 30.0\nconvergence = 1e-6\n{}",
        rock(YOUNG, DENSITY),
        dynamic("rest", seconds, 0.1),
        right = width + 1.0,
    )
}

/// Largest distance (m) between two displacement fields.
fn distance(a: &[enmm::geometry::Vector], b: &[enmm::geometry::Vector]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

/// Settles a wall, lets it rest for `seconds` and asserts the claim.
///
/// Drift: after 4 s of rest nothing moves by more than 1e-6 of a block. Kinetic energy: an elastic body at rest has the
/// rounding of its forces left, v = ε·F·dt/m = 2e-16·g·10·dt: 1e-17 m/s; contacts whose iteration ends within its
/// tolerance leave more. 1e-12 of the energy of 1 m/s is asked. Penetration: σh/0.5E_c (theory Eq. 29) with σ =
/// ρg·height, 4e-4 of h here.
fn assert_rests(mut simulation: Simulation, seconds: f64) {
    let report = run_stage(&mut simulation);
    assert!(simulation.at_rest(&report), "the wall must settle: {report:?}");
    assert!(simulation.next_stage().expect("a stage"));
    let steps = simulation.steps_in(4.0);
    advance(&mut simulation, steps);
    let before = simulation.state().displacement.clone();
    let steps = simulation.steps_in(seconds - 4.0);
    let report = advance(&mut simulation, steps);
    let drift = distance(&before, &simulation.state().displacement);
    let mass: f64 = simulation.model().mass_matrix.total.iter().sum();
    let counters = simulation.state().counters;
    println!(
        "drift {drift:e} m, kinetic {:e} J of {mass} kg, penetration {:e} h, unsettled {}",
        report.ledger.kinetic,
        report.penetration_max / SIZE,
        counters.unsettled
    );
    assert!(drift < 1e-6 * 0.5, "drift {drift:e} m");
    assert!(report.ledger.kinetic < 1e-12 * 0.5 * mass, "kinetic energy {:e} J", report.ledger.kinetic);
    assert!(report.penetration_max < 1e-3 * SIZE, "penetration {:e} m", report.penetration_max);
    assert_ledger(&report);
}

#[test]
fn a_masonry_wall_rests() {
    assert_rests(simulation(&wall(20, 20, true, 12.0)), 12.0);
}

#[test]
fn a_row_of_stacks_rests() {
    assert_rests(simulation(&wall(6, 12, false, 20.0)), 20.0);
}

/// The full claim of 60 s with `ENMM_LONG=1`; a small wall otherwise.
#[test]
fn long_a_masonry_wall_rests_for_a_minute() {
    let side = if std::env::var_os("ENMM_LONG").is_some() { 20 } else { 5 };
    assert_rests(simulation(&wall(side, side, true, 60.0)), 60.0);
}
