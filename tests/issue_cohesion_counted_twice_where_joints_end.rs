//! Cohesion on a joint on which other joints end is that of its length: faces of those joints count on their own.

use enmm::internals::contact::Limits;
use enmm::model::{Case, Simulation};
use serde_json::json;

/// Cohesion (Pa) of the joint that is looked at.
const COHESION: f64 = 1e5;

/// Shear force (N/m) of cohesion and tension on a level joint 6 m long, on which slanted joints end from above.
fn strength(ends: &[[f64; 2]], mesh: f64) -> [f64; 2] {
    let joints: Vec<_> = ends
        .iter()
        .map(|[foot, head]| json!({ "points": [[foot, 0.0], [head, 3.0]], "law": "joint" }))
        .chain([json!({ "points": [[0.0, 0.0], [6.0, 0.0]], "law": "fault" })])
        .collect();
    let case: Case = serde_json::from_value(json!({
        "title": "Joints that end on a joint",
        "domain": { "outline": [[0.0, -2.0], [6.0, -2.0], [6.0, 3.0], [0.0, 3.0]] },
        "mesh": { "size": mesh, "angle_deg": 11.0 },
        "joint": joints,
        "joint_law": {
            "fault": { "friction_deg": 30.0, "cohesion": COHESION, "tension": 0.1 * COHESION },
            "joint": { "friction_deg": 30.0 }
        },
        "rock": { "rock": { "density": 2600.0, "young": 1e10, "poisson": 0.25 } },
        "fix": [{ "edge": [[0.0, -2.0], [6.0, -2.0]] }],
        "stage": [{ "name": "rest", "kind": "static", "duration": 1.0 }]
    }))
    .expect("a case");
    let simulation = Simulation::new(case).unwrap_or_else(|error| panic!("{error}"));
    let mut sums = [0.0; 2];
    let (state, workspace) = simulation.look_ahead();
    let setting = workspace.setting(simulation.model(), &state);
    for contact in &workspace.contacts {
        if let Limits::MohrCoulomb { cohesion, tension, .. } = contact.limits(&setting) {
            sums = [sums[0] + cohesion, sums[1] + tension];
        }
    }
    sums
}

#[test]
fn cohesion_and_tension_act_on_the_length_of_the_joint_alone() {
    let slanted: [&[[f64; 2]]; 4] =
        [&[], &[[2.0, 4.0]], &[[1.3, 3.5], [3.1, 4.9]], &[[2.0, 0.4], [2.9, 3.3], [4.0, 5.8]]];
    for ends in slanted {
        for mesh in [0.5, 1.1, 2.0] {
            let [cohesion, tension] = strength(ends, mesh);
            let exact = 6.0 * COHESION;
            assert!((cohesion / exact - 1.0).abs() < 1e-3, "{ends:?}, mesh {mesh}: {cohesion} for {exact}");
            assert!((10.0 * tension / exact - 1.0).abs() < 1e-3, "{ends:?}, mesh {mesh}: {tension}");
        }
    }
}
