//! Joints of frames and pictures are where the joints of the model are, and bear what statics asks of them.

use enmm::model::{ContactState, Simulation};
use enmm_observe::{JointPiece, Joints};

/// A block of 2 m × 1 m on a base, which a crack enters from above and does not part, beside a block on another base.
const CASE: &str = r#"
title = "Two blocks on bases"
domain.outline = [[0, 0], [4, 0], [4, 1], [3, 1], [3, 2], [1, 2], [1, 1], [0, 1]]
domain.islands = [[[6, 0], [8, 0], [8, 2], [6, 2]]]
domain.joint_law = "bed"
mesh = { size = 0.37, origin = [0.07, 0.03] }
joint = [
    { points = [[1, 1], [3, 1]], law = "bed" },
    { points = [[2, 2.1], [2, 1.6]], law = "crack" },
    { points = [[5.9, 1], [8.1, 1]], law = "bed" },
]
rock.granite = { density = 2600, young = 1e9, poisson = 0.25 }
joint_law.bed.friction_deg = 30
joint_law.crack.friction_deg = 30
fix = [
    { block = [2, 0.5] },
    { block = [7, 0.5] },
]
stage = [
    { name = "rest", kind = "static", duration = 5.0, convergence = 1e-6 },
    { name = "dig", kind = "static", duration = 0.01, excavate = [[7, 1.5]] },
]
"#;
/// Weight of 1 m² of rock (N/m).
const WEIGHT: f64 = 2600.0 * 9.81;

fn at_rest() -> Simulation {
    let loaded = enmm_io::parse_case(CASE, "case", "".as_ref()).expect("a case");
    let mut simulation = Simulation::new(loaded.case).expect("a model");
    simulation.run_stage().expect("no failure");
    simulation
}

fn length(joint: &JointPiece) -> f64 {
    (joint.ends[1] - joint.ends[0]).norm()
}

#[test]
fn joints_bear_the_weight_above_them_as_an_even_stress() {
    let simulation = at_rest();
    let joints = Joints::of(&simulation).now(&simulation);
    for (left, right) in [(1.0, 3.0), (6.0, 8.0)] {
        let within = |joint: &&JointPiece| {
            joint.law == 0 && joint.ends.iter().all(|end| (left - 0.01..=right + 0.01).contains(&end.x))
        };
        let bed: Vec<&JointPiece> = joints.iter().filter(within).collect();
        let total: f64 = bed.iter().map(|joint| length(joint)).sum();
        // Corners of the block spread by its Poisson strain, some 1e-5.
        assert!((total - 2.0).abs() < 1e-4, "{total} m of joint");
        let upward: f64 = bed.iter().map(|joint| joint.force.y.abs()).sum();
        assert!((upward / (2.0 * WEIGHT) - 1.0).abs() < 1e-3, "{upward} N/m");
        for joint in bed {
            assert!(joint.is_joint && joint.state == ContactState::Lock, "{joint:?}");
            assert!((joint.normal_stress / -WEIGHT - 1.0).abs() < 1e-3, "{joint:?}");
            assert!(joint.shear_stress.abs() < 1e-3 * WEIGHT, "{joint:?}");
            assert!((-1e-3..=0.0).contains(&joint.opening) && joint.slip < 1e-4, "{joint:?}");
            // The force on the first block points away from the second one, which the normal points at.
            assert!(joint.blocks[0] != joint.blocks[1] && joint.force.dot(&joint.normal) < 0.0, "{joint:?}");
        }
    }
}

#[test]
fn a_joint_that_ends_in_a_block_has_it_on_both_sides() {
    let simulation = at_rest();
    let joints = Joints::of(&simulation).now(&simulation);
    let crack: Vec<&JointPiece> = joints.iter().filter(|joint| joint.law == 1).collect();
    let total: f64 = crack.iter().map(|joint| length(joint)).sum();
    // Both faces are edges of the boundary; the mesh decides where the crack ends.
    let boundary = &simulation.model().boundary;
    let faces = boundary.edges().filter(|&edge| boundary.partial[edge]);
    let of_faces: f64 =
        faces.map(|edge| (boundary.reference[boundary.after(edge)] - boundary.reference[edge]).norm()).sum();
    assert!(total > 0.2 && (total - 0.5 * of_faces).abs() < 1e-4, "{total} m of crack of {of_faces} m of faces");
    assert!(crack.iter().all(|joint| joint.blocks[0] == joint.blocks[1]));
}

#[test]
fn joints_of_blocks_that_are_dug_out_are_gone() {
    let mut simulation = at_rest();
    let joints = Joints::of(&simulation);
    let right = |simulation: &Simulation| joints.now(simulation).iter().filter(|joint| joint.ends[0].x > 5.0).count();
    assert!(right(&simulation) > 0);
    assert!(simulation.next_stage().expect("a stage"));
    assert_eq!(right(&simulation), 0);
    assert!(!joints.now(&simulation).is_empty());
}
