//! The vertex rule at corners: nothing catches where nothing is in the way, and nothing passes through.

use crate::common::claims::{advance, block_at, motion};
use crate::common::loose::{FLAT, G, SIZE, loose_blocks, thrown};
use crate::common::parts::{dynamic, rock};
use crate::common::run_stage;
use enmm::geometry::Vector;
use enmm::model::Simulation;
use enmm::model::overlap::deepest_overlap;

/// Loose blocks (`islands`) over a held base, with further text; E = 1 GPa.
fn case(base: &str, islands: &str, seconds: f64, more: &str) -> Simulation {
    loose_blocks(base, islands, 20.0, &format!("{more}{}{}", rock(1e9, 2500.0), dynamic("fall", seconds, 0.1)))
}

/// Advances to the end of the stage; returns the deepest overlap (m) seen by the audit.
fn run(simulation: &mut Simulation) -> f64 {
    let (mut worst, mut k) = (0.0f64, 0u64);
    while !simulation.stage_is_over(None) {
        simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
        k += 1;
        if k.is_multiple_of(20) {
            worst = worst.max(deepest_overlap(simulation).depth);
        }
    }
    println!("overlap {worst:e} m, counters {:?}", simulation.state().counters);
    worst
}

/// A block slides off an edge with 6 m/s, tips and falls past the wall below: after it has left, it falls freely.
#[test]
fn a_block_slides_over_an_edge_and_falls() {
    let base = "[[0.0, -1.0], [3.0, -1.0], [3.0, 4.0], [0.0, 4.0]]";
    let islands = "[[[1.5, 4.001], [2.5, 4.001], [2.5, 5.0], [1.5, 5.0]]]";
    let mut simulation = case(base, islands, 0.9, &thrown([2.0, 4.5], [6.0, 0.0]));
    let steps = simulation.steps_in(0.6);
    advance(&mut simulation, steps);
    let ((_, before, ..), from) = (motion(&simulation, [2.0, 4.5]), simulation.time());
    assert!(run(&mut simulation) < 0.005 * SIZE);
    let ((place, after, ..), to) = (motion(&simulation, [2.0, 4.5]), simulation.time());
    let free = before + Vector::new(0.0, -G * (to - from));
    assert!(place.x > 4.0 && (after - free).norm() < 1e-3, "{place} at {after}, free fall {free}");
    assert_eq!(simulation.state().counters.deep_contacts, 0);
}

/// Two squares stand on a corner, one over the other and a little beside it: they part sideways and never cross.
#[test]
fn a_corner_falls_on_a_corner() {
    for shift in [0.0, 1e-3, 0.02, -0.05] {
        let (low, high) = (4.0, 4.0 + shift);
        let diamond = |x: f64, y: f64| {
            format!("[[{x}, {y}], [{}, {}], [{x}, {}], [{}, {}]]", x + 1.0, y + 1.0, y + 2.0, x - 1.0, y + 1.0)
        };
        let islands = format!("[{}, {}]", diamond(low, 0.0), diamond(high, 2.3));
        let mut simulation = case(FLAT, &islands, 2.0, "");
        let worst = run(&mut simulation);
        assert!(worst < 0.01 * SIZE, "shift {shift}: overlap {worst:e} m");
    }
}

/// A wedge lands on its tip and slides over an edge: the edge carries it, though it is soon above the wedge's upper
/// face.
#[test]
fn an_edge_bears_the_tip_of_a_wedge() {
    let base = "[[0.0, -1.0], [12.0, -1.0], [12.0, 0.0], [5.0, 0.0], [5.0, -0.5], [0.0, -0.5]]";
    for (before, speed) in [(5e-4, 0.2), (5e-4, 1.0), (2e-3, 1.0)] {
        let wedge = format!("[[[{}, 0.002], [7.0, 0.102], [7.0, 0.7]]]", 5.0 + before);
        let mut simulation = case(base, &wedge, 0.1, &thrown([6.5, 0.2], [-speed, -6.0]));
        let mut worst = 0.0f64;
        for _ in 0..100 {
            advance(&mut simulation, 1);
            worst = worst.max(deepest_overlap(&simulation).depth);
        }
        assert!(worst < 0.002 * SIZE, "{before} m before the edge at {speed} m/s: overlap {worst:e} m");
    }
}

/// A block slides over the closed mouth of a crack as over a whole face: it loses v²/2gμ of its way to friction.
#[test]
fn a_block_slides_over_a_closed_crack() {
    for crack in
        ["", "[[joint]]\npoints = [[5.0, 0.0], [4.7, -0.6]]\n", "[[joint]]\npoints = [[5.0, 0.0], [5.4, -0.6]]\n"]
    {
        let islands = "[[[2.0, 0.001], [3.0, 0.001], [3.0, 1.0], [2.0, 1.0]]]";
        let more = format!("{crack}{}", thrown([2.5, 0.5], [4.0, 0.0]));
        let mut simulation = case(FLAT, islands, 2.0, &more);
        let start = motion(&simulation, [2.51, 0.48]).0.x;
        let worst = run(&mut simulation);
        let way = motion(&simulation, [2.51, 0.48]).0.x - start;
        let law = simulation.state().laws[0];
        println!("{crack:?}: way {way}, friction {}", law.friction);
        let exact = 16.0 / (2.0 * G * 20.0f64.to_radians().tan());
        assert!((way / exact - 1.0).abs() < 0.05, "{crack:?}: {way} m of {exact} m");
        assert!(worst < 0.005 * SIZE, "overlap {worst:e} m");
    }
}

/// A square in the notch of an L, and one in a slot that fits it, rest where they are.
#[test]
fn notch_and_slot_hold_a_square() {
    let l = "[[4.0, 0.001], [7.0, 0.001], [7.0, 1.0], [5.0, 1.0], [5.0, 3.0], [4.0, 3.0]]";
    let u = "[[4.0, 0.001], [7.0, 0.001], [7.0, 2.0], [6.0, 2.0], [6.0, 1.0], [5.0, 1.0], [5.0, 2.0], [4.0, 2.0]]";
    let square = "[[5.001, 1.001], [5.999, 1.001], [5.999, 2.0], [5.001, 2.0]]";
    for holder in [l, u] {
        let mut simulation = case(FLAT, &format!("[{holder}, {square}]"), 4.0, "");
        assert_ne!(block_at(&simulation, [5.5, 1.5]), block_at(&simulation, [4.5, 0.5]));
        let start = motion(&simulation, [5.5, 1.5]).0;
        let worst = run(&mut simulation);
        let (place, velocity, ..) = motion(&simulation, [5.5, 1.5]);
        assert!((place - start).norm() < 3e-3 && velocity.norm() < 1e-3, "{start} to {place} at {velocity}");
        assert!(worst < 0.002 * SIZE, "overlap {worst:e} m");
    }
}

/// A sharp wedge drops between two loose blocks: it drives them apart and stays between them.
#[test]
fn a_thin_wedge_drives_two_blocks_apart() {
    let islands = "[[[4.0, 0.001], [5.0, 0.001], [5.0, 2.0], [4.0, 2.0]], [[5.02, 0.001], [6.02, 0.001], [6.02, 2.0], \
                   [5.02, 2.0]], [[5.01, 1.99], [5.16, 3.5], [4.86, 3.5]]]";
    let mut simulation = case(FLAT, islands, 2.0, &thrown([5.01, 3.0], [0.0, -3.0]));
    let worst = run(&mut simulation);
    let [left, right, wedge] = [[4.5, 1.0], [5.5, 1.0], [5.01, 3.0]].map(|p| motion(&simulation, p).0);
    println!("{left} {wedge} {right}");
    assert!(right.x - left.x > 1.025 && left.x < wedge.x && wedge.x < right.x, "{left} {wedge} {right}");
    assert!(worst < 0.01 * SIZE, "overlap {worst:e} m");
}

/// A block falls on a pile of twelve sheets, a fiftieth of the mesh size thick each: every node is over all of their
/// sides, and none is left out.
#[test]
fn a_pile_of_thin_sheets_bears_a_block() {
    let joint = |k: usize| format!("[[joint]]\npoints = [[4.0, {y}], [8.0, {y}]]\n", y = 0.02 * k as f64);
    let joints: String = (0..12).map(joint).collect();
    let base = "[[0.0, -1.0], [12.0, -1.0], [12.0, 0.0], [8.0, 0.0], [8.0, 0.24], [4.0, 0.24], [4.0, 0.0], [0.0, 0.0]]";
    let block = "[[[5.5, 0.241], [6.5, 0.241], [6.5, 1.241], [5.5, 1.241]]]";
    let mut simulation = case(base, block, 1.0, &joints);
    let worst = run(&mut simulation);
    let (place, velocity, ..) = motion(&simulation, [6.0, 0.7]);
    assert!((place.y - 0.74).abs() < 1e-3 && velocity.norm() < 1e-2, "{place} at {velocity}");
    assert!(worst < 0.002 * SIZE, "overlap {worst:e} m");
}

/// Ten equal blocks on each other, corners exactly over corners, stay aligned for 10 s.
///
/// The mesh is not symmetric about the tower: it may lean by less than it settles, 3.5e-3 m, but then it stands.
#[test]
fn a_stack_of_equal_blocks_stays_aligned() {
    let joints: String = (0..10).map(|k| format!("[[joint]]\npoints = [[5.0, {k}.0], [6.0, {k}.0]]\n")).collect();
    let base = "[[0.0, -1.0], [12.0, -1.0], [12.0, 0.0], [6.0, 0.0], [6.0, 10.0], [5.0, 10.0], [5.0, 0.0], [0.0, 0.0]]";
    let settle = "[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-6\n";
    let mut simulation = case(base, "[]", 10.0, &format!("{joints}{settle}"));
    run_stage(&mut simulation);
    assert!(simulation.next_stage().expect("a stage"));
    let places = |simulation: &Simulation| [0, 3, 6, 9].map(|k| motion(simulation, [5.51, k as f64 + 0.52]).0);
    let before = places(&simulation);
    let worst = run(&mut simulation);
    for (from, to) in before.into_iter().zip(places(&simulation)) {
        assert!((to.x - 5.5).abs() < 3.5e-3 && (to - from).norm() < 1e-6 * SIZE, "{from} to {to}");
    }
    assert!(worst < 0.002 * SIZE, "overlap {worst:e} m");
}
