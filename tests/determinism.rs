//! Runs are the same to the bit on one and on two threads, and when run again.

use crate::common::parts::{dynamic, rock};
use crate::common::{simulation, step};
use enmm::model::State;

/// 300 bricks on a held slab under a gravity that leans: contacts open, slip and lock, and the blocks fill several
/// groups.
fn heap(bond: &str) -> String {
    let mut joints = String::new();
    for row in 0..15 {
        let (low, high) = (0.7 * row as f64, 0.7 * (row + 1) as f64);
        joints += &format!("[[joint]]\npoints = [[0.0, {low}], [20.0, {low}]]\n");
        for k in 0..20 {
            let x = k as f64 + if row % 2 == 1 { 0.6 } else { 0.1 };
            joints += &format!("[[joint]]\npoints = [[{x}, {low}], [{x}, {high}]]\n");
        }
    }
    format!(
        "title = \"heap\"\n[domain]\noutline = [[-6.0, -1.0], [30.0, -1.0], [30.0, 0.0], [20.0, 0.0], [20.0, 10.5], \
         [0.0, 10.5], [0.0, 0.0], [-6.0, 0.0]]\n[mesh]\nsize = 0.5\nangle_deg = 7.0\n{joints}[joint_law.joint]\n\
         friction_deg = 15.0\n{bond}[[fix]]\nblock = [-5.0, -0.5]\n[gravity]\nx = 5.0\n{}{}",
        rock(1e9, 2500.0),
        dynamic("slide", 10.0, 0.1)
    )
}

/// The state after some steps on so many threads.
fn run(threads: usize, bond: &str) -> State {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    pool.install(|| {
        let mut simulation = simulation(&heap(bond));
        let covers = &simulation.model().covers;
        assert!(covers.block_count() > 100 && covers.cover_count() > 4096, "{} blocks", covers.block_count());
        step(&mut simulation, 400);
        simulation.state().clone()
    })
}

#[test]
fn threads_change_no_bit() {
    let one = run(1, "");
    assert!(one.displacement.iter().any(|u| u.norm() > 0.05), "the heap must move");
    compare(&one, "");
}

/// Bonds that break in the middle of the run.
#[test]
fn threads_change_no_bit_of_a_failure() {
    let bond = "cohesion = 2e4\nresidual_cohesion = 0\ntension = 1e4\ntension_energy = 2\nshear_energy = 20\n";
    let one = run(1, bond);
    let whole = one.bonds.iter().filter(|bond| bond.lengths[1] > 0.0).count();
    let damaged = one.bonds.iter().filter(|bond| bond.damage > 0.0).count();
    assert!(one.counters.broken > 1.0 && damaged > 0 && whole > damaged, "{damaged} of {whole} bonds damaged");
    compare(&one, bond);
}

fn compare(one: &State, bond: &str) {
    for threads in [2, 3, 1] {
        let other = run(threads, bond);
        let bits = |s: &State| -> Vec<[u64; 4]> {
            let fields = s.displacement.iter().zip(&s.velocity);
            fields.map(|(u, v)| [u.x, u.y, v.x, v.y].map(f64::to_bits)).collect()
        };
        assert!(bits(one) == bits(&other), "{threads} threads differ from 1");
        assert!(*one == other, "histories and ledgers of {threads} threads differ from 1");
    }
}
