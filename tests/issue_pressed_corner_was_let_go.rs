//! A corner was let go with all its force when it had moved past the end of the other side by half its penetration,
//! although the corners still overlapped. No other contact replaced it: the corner of the other side was deeper in this
//! block than below its top, and counted as seen by mistake. On `fractured_slope` with Young's modulus changed by 1e-11
//! of itself, two blocks then went 1.2 m into each other without a force.
//!
//! Claim: a corner carries force until the corners have parted, or the other corner takes over.

use crate::common::{run_stage, simulation};
use enmm::geometry::Point;
use enmm::model::Simulation;
use enmm::model::tables::{EdgeId, VertexEdge};

/// Tops of the held block and of the one that slides (m).
const TOPS: [f64; 2] = [2.0, 2.004];

/// A block that a pressure holds against the face of a held one until friction is gone, 4 mm higher than that.
const PRESSED: &str = r#"
title = "pressed corner"
domain.outline = [[0, -1], [1, -1], [1, 0], [2, 0], [2, 2.004], [1, 2.004], [1, 2], [0, 2]]
mesh.size = 0.5
joint = [{ points = [[1, 0], [1, 2]] }]
rock.soft = { density = 2000, young = 1e8, poisson = 0.2 }
joint_law.joint.friction_deg = 60
fix = [{ edge = [[0, -1], [0, 2]] }]
load = [{ name = "press", kind = "pressure", edge = [[2, 0], [2, 2.004]], pressure = 7e5 }]
stage = [
    { name = "hang", kind = "static", duration = 20.0 },
    { name = "slide", kind = "dynamic", duration = 0.1, damping = 0.3, law = [{ law = "joint", friction_deg = 0 }] },
]
"#;

/// Boundary point at a place of the block that has another one at `of`.
fn point(simulation: &Simulation, place: [f64; 2], of: [f64; 2]) -> EdgeId {
    let boundary = &simulation.model().boundary;
    let at = |place: [f64; 2]| {
        boundary.edges().filter(move |&k| (boundary.reference[k] - Point::new(place[0], place[1])).norm() < 1e-6)
    };
    let block = boundary.block[at(of).next().unwrap()];
    at(place).find(|&k| boundary.block[k] == block).unwrap()
}

#[test]
fn a_corner_bears_until_the_corners_part() {
    let mut simulation = simulation(PRESSED);
    let held = point(&simulation, [1.0, TOPS[0]], [0.0, TOPS[0]]);
    let sliding = point(&simulation, [1.0, TOPS[1]], [2.0, TOPS[1]]);
    let report = run_stage(&mut simulation);
    assert!(simulation.at_rest(&report));
    assert!(simulation.next_stage().unwrap());
    let [mut above, mut past] = [0; 2];
    loop {
        simulation.advance(false).unwrap();
        let frames = &simulation.workspace().frames;
        let lowered = frames.position(held).y - frames.position(sliding).y;
        let boundary = &simulation.model().boundary;
        let is_corner = |contact: &&VertexEdge| boundary.nodes.point[contact.history.node] == held;
        let contact = simulation.workspace().contacts.iter().find(is_corner);
        let contact = contact.unwrap_or_else(|| panic!("the corner was let go, {lowered} m above the other one"));
        let closure = contact.penetration();
        assert!(closure > 3e-3 * 0.5, "the block is not pressed as this test needs it: {closure} m");
        if lowered > 0.9 * closure {
            break;
        }
        assert!(contact.history.normal_force > 0.0, "the corner bears nothing, {lowered} m above the other one");
        above += i32::from(lowered < 0.0);
        past += i32::from(lowered > 0.5 * closure + 1e-3 * 0.5);
    }
    assert!(above > 0 && past > 0, "{above} {past}");
}
