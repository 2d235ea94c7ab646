//! Dense grids of joints with random apertures, and equal bits of two runs.

use crate::parts::{Joints, Random, grid, held};

/// A grid of 61 x 31 nodes between waters 25 and 8 m deep, with apertures of a scatter.
fn random_grid(seed: u64, scatter: f64) -> Joints {
    let (mut joints, [columns, rows]) = grid([60.0, 30.0], 1.0, 1e-4);
    let mut random = Random::new(seed);
    for apertures in &mut joints.apertures {
        *apertures = [(1e-4 * (scatter * random.normal()).exp()).clamp(1e-6, 2e-3); 2];
    }
    for row in 0..rows {
        if joints.places[row * columns][1] <= 25.0 {
            joints.conditions[row * columns] = held(25.0);
        }
        joints.conditions[row * columns + columns - 1] = held(8.0);
    }
    joints
}

#[test]
fn dense_random_grids_are_solved() {
    for seed in 0..20 {
        let joints = random_grid(seed, 1.0);
        let flow = joints.steady();
        let sum: f64 = flow.inflow.iter().sum();
        assert!(flow.solves <= 16, "{} solves", flow.solves);
        assert!(sum.abs() < 1e-8 * flow.through_flow, "{sum:e} of {:e}", flow.through_flow);
    }
}

#[test]
fn grids_of_the_greatest_contrast_are_solved() {
    for seed in 0..6 {
        let flow = random_grid(seed, 4.0).steady();
        println!("{seed}: {} solves, through {:e}", flow.solves, flow.through_flow);
        assert!(flow.inflow.iter().sum::<f64>().abs() < 1e-4 * flow.through_flow);
    }
}

#[test]
fn two_runs_have_the_same_bits() {
    let [first, second] = [0, 0].map(|_| random_grid(3, 2.0).steady());
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&first.u), bits(&second.u));
    let hash = bits(&first.u).into_iter().fold(0_u64, |hash, bits| hash.rotate_left(7) ^ bits);
    println!("hash of all unknowns: {hash:x}");
    assert_eq!(bits(&first.flow), bits(&second.flow));
}
