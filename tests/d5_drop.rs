//! Claim D5: a mass that drops on a spring goes as deep as its energy says and, undamped, comes back to where it was.

mod common;

use common::claims::{dynamic, motion, rock};
use common::simulation;

const G: f64 = 9.81;

/// What a drop was like: speed at contact (m/s), deepest penetration (m), share of the height that was lost.
struct Drop {
    speed: f64,
    depth: f64,
    lost: f64,
}

/// A block of 1 m × 1 m and `mass` (kg/m) falls `height` (m) on a joint of `stiffness` (N/m per metre).
///
/// The rock is 10000 times stiffer than the joint.
fn drop(mass: f64, stiffness: f64, height: f64, dt: f64) -> Drop {
    let low = height;
    let mut simulation = simulation(&format!(
        "title = \"drop\"\n[domain]\noutline = [[0.0, -1.0], [1.0, -1.0], [1.0, 0.0], [0.0, 0.0]]\n\
         islands = [[[0.0, {low}], [1.0, {low}], [1.0, {high}], [0.0, {high}]]]\n[mesh]\nsize = 1.1\norigin = \
         [0.03, 0.02]\n\
         [joint_law.spring]\nfriction_deg = 0.0\nnormal_stiffness = {stiffness:e}\n[[fix]]\nblock = [0.1, -0.9]\n{}{}\
         [solver]\ncontact_tolerance = 1e-9\nsweeps_max = 100\ndt_max = {dt:e}\n",
        rock(1e4 * stiffness, mass),
        dynamic("fall", 10.0, 0.0),
        high = height + 1.0,
    ));
    let middle = [0.51, height + 0.48];
    let start = motion(&simulation, middle).0.y;
    let (mut speed, mut depth, mut rebound, mut touched) = (0.0f64, 0.0f64, false, false);
    loop {
        let report = simulation.advance(true).unwrap_or_else(|e| panic!("{e}"));
        let (centre, velocity, ..) = motion(&simulation, middle);
        touched |= report.penetration_max > 0.0;
        if !touched {
            speed = -velocity.y;
        }
        depth = depth.max(report.penetration_max);
        rebound |= touched && velocity.y > 0.0;
        if rebound && velocity.y < 0.0 {
            // All terms are small again at the top: the largest was mgH.
            assert!(report.ledger.residual().abs() < 1e-3 * mass * G * height, "{:?}", report.ledger);
            return Drop { speed, depth, lost: (start - centre.y) / height };
        }
    }
}

/// v = √(2gH), deepest = mg/k + √((mg/k)² + 2mgH/k): 3.132092 m/s and 4.976858 mm for 2500 kg on 1e9 N/m from 0.5 m.
///
/// The block's own spring (some 1e4 k in series, and waves) takes 2e-4 of the depth: 1e-3 is asked. A joint's own
/// stiffness is a centred spring, which keeps its energy at any step that resolves it: what is lost are the waves that
/// the block takes along, some 1e-4.
#[test]
fn a_mass_on_a_spring_keeps_its_energy() {
    for (mass, stiffness, height) in [(2500.0, 1e9, 0.5), (2000.0, 4e8, 0.2)] {
        let (sag, omega) = (mass * G / stiffness, f64::sqrt(stiffness / mass));
        let deepest = sag + f64::sqrt(sag * sag + 2.0 * sag * height);
        assert!(mass != 2500.0 || (deepest - 4.976858e-3).abs() < 1e-8);
        let steps = [4e-3, 2e-3, 1e-3].map(|x| x / omega);
        let drops = steps.map(|dt| drop(mass, stiffness, height, dt));
        for (dt, drop) in steps.iter().zip(&drops) {
            println!("ω dt {:e}: v {}, depth {}, lost {}", dt * omega, drop.speed, drop.depth / deepest, drop.lost);
            assert!((drop.speed / f64::sqrt(2.0 * G * height) - 1.0).abs() < 1e-3, "{}", drop.speed);
            assert!(drop.lost.abs() < 1e-3, "lost {} at ω dt = {}", drop.lost, omega * dt);
            assert!((drop.depth / deepest - 1.0).abs() < 1e-3, "{} of {deepest}", drop.depth);
        }
    }
}
