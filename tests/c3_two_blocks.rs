//! Claim C3: of two equal blocks on a plane the upper pushes the lower as Newton and Coulomb say.

mod common;

use common::claims::{advance, assert_ledger, block_at, dynamic, motion, rock, turn};
use common::{run_stage, simulation};
use enmm::geometry::Vector;
use enmm::model::Simulation;

const SLOPE: f64 = 30.0;
const DENSITY: f64 = 2500.0;

/// Two blocks of 1 m × 1 m; the lower stands on a step of 0.2 m, so that each keeps a plane and a law of its own. The
/// face between them is smooth. Both settle under 45°, then get their frictions (degrees).
fn case(lower: f64, upper: f64) -> String {
    let outline = [
        [-1.0, -1.0],
        [5.0, -1.0],
        [5.0, -0.2],
        [2.0, -0.2],
        [2.0, 0.8],
        [1.0, 0.8],
        [1.0, 1.0],
        [0.0, 1.0],
        [0.0, 0.0],
        [-1.0, 0.0],
    ];
    let joint = |a: [f64; 2], b: [f64; 2], law: &str| {
        format!("[[joint]]\npoints = {:?}\nlaw = \"{law}\"\n", turn(&[a, b], -SLOPE))
    };
    let change = |law: &str, friction: f64| format!("[[stage.law]]\nlaw = \"{law}\"\nfriction_deg = {friction}\n");
    format!(
        "title = \"two blocks\"\n[domain]\noutline = {:?}\njoint_law = \"face\"\n[mesh]\nsize = 0.6\n\
         origin = [0.031, 0.017]\n{}{}{}{}[joint_law.face]\nfriction_deg = 0.0\n[joint_law.lower]\nfriction_deg \
         = 45.0\n\
         [joint_law.upper]\nfriction_deg = 45.0\n[[fix]]\nblock = {:?}\n{}[[stage]]\nname = \"settle\"\n\
         kind = \"static\"\nduration = 5.0\n{}{}{}",
        turn(&outline, -SLOPE),
        joint([0.0, 0.0], [1.0, 0.0], "upper"),
        joint([1.0, -0.2], [2.0, -0.2], "lower"),
        joint([1.0, -0.2], [1.0, 0.0], "face"),
        joint([1.0, 0.0], [1.0, 0.8], "face"),
        turn(&[[-0.5, -0.5]], -SLOPE)[0],
        rock(50e9, DENSITY),
        dynamic("slide", 1.0, 0.1),
        change("lower", lower),
        change("upper", upper)
    )
}

/// With m = 1: while both slide together 2a = 2g·sin a − g·cos a·(tan φ1 + tan φ2) and the lower needs the force
/// a − (g·sin a − g·cos a·tan φ1) from the upper; where that is negative they part.
///
/// The offset of velocity after the release (C1) is some 1e-4 m/s of 0.3 m/s; the second difference of places is free
/// of it, and the blocks turn a little on the step: 1e-3 is asked. The force swings with waves: its mean over 0.3 s.
#[test]
fn the_upper_block_pushes_the_lower() {
    for (lower, upper, published) in
        [(40.0, 10.0, [0.591615, 2.815362]), (30.0, 10.0, [1.703489, 1.703489]), (25.0, 5.0, [f64::NAN; 2])]
    {
        let (s, c) = f64::to_radians(SLOPE).sin_cos();
        let alone = |friction: f64| 9.81 * (s - c * friction.to_radians().tan());
        let common = 0.5 * (alone(lower) + alone(upper));
        let force = common - alone(lower);
        assert!(published[0].is_nan() || ((common - published[0]).abs() < 1e-6 && (force - published[1]).abs() < 1e-6));
        let mut simulation = simulation(&case(lower, upper));
        run_stage(&mut simulation);
        assert!(simulation.next_stage().expect("a stage"));
        let middles = [turn(&[[1.52, 0.31]], -SLOPE)[0], turn(&[[0.51, 0.48]], -SLOPE)[0]];
        let blocks = middles.map(|p| block_at(&simulation, p));
        let along = |simulation: &Simulation| middles.map(|p| motion(simulation, p).0.dot(&Vector::new(c, -s)));
        let (mut places, mut pushes) = (Vec::new(), Vec::new());
        let steps = simulation.steps_in(0.15);
        for window in 0..3 {
            let mut last = None;
            for _ in 0..steps / 10 {
                last = Some(advance(&mut simulation, 10));
                let between = |c: &&enmm::contact::VertexEdge| {
                    blocks.contains(&c.pair.blocks[0]) && blocks.contains(&c.pair.blocks[1])
                };
                let push: f64 =
                    simulation.workspace().contacts.iter().filter(between).map(|c| c.history.normal_force).sum();
                if window > 0 {
                    pushes.push(push / DENSITY);
                }
            }
            assert_ledger(&last.expect("a report"));
            places.push(along(&simulation));
        }
        let span = (steps / 10 * 10) as f64 * simulation.model().dt;
        let mean = pushes.iter().sum::<f64>() / pushes.len() as f64;
        for (k, start) in places[0].iter().enumerate() {
            let found = (places[2][k] - 2.0 * places[1][k] + start) / (span * span);
            println!("φ {lower} {upper}, block {k}: a {found} of {common}, force {mean} of {force}");
            assert!((found / common - 1.0).abs() < 1e-3, "φ {lower} {upper}, block {k}: {found} of {common}");
        }
        assert!((mean / force - 1.0).abs() < 5e-3, "φ {lower} {upper}: force {mean} of {force}");
    }
}
