//! Frames hold the stress out of the plane: that of a confined column equals the other horizontal stress, yielded rock
//! keeps to its strength in all directions, and plane stress has none.

use enmm::model::{Case, Simulation};
use enmm_observe::Snapshot;
use serde_json::json;

/// A column 2 m wide and 4 m high between smooth walls, under its weight; `rock` has further keys.
fn column(rock: serde_json::Value) -> Simulation {
    let mut properties = json!({ "density": 2600.0, "young": 1e9, "poisson": 0.3 });
    let more = rock.as_object().expect("keys").clone();
    properties.as_object_mut().expect("keys").extend(more);
    let case: Case = serde_json::from_value(json!({
        "title": "Column",
        "domain": { "outline": [[0.0, 0.0], [2.0, 0.0], [2.0, 4.0], [0.0, 4.0]] },
        "mesh": { "size": 0.5 },
        "rock": { "rock": properties },
        "fix": [
            { "edge": [[0.0, 0.0], [2.0, 0.0]], "axes": "y", "stiffness": 1e14 },
            { "edge": [[0.0, 0.0], [0.0, 4.0]], "axes": "x", "stiffness": 1e14 },
            { "edge": [[2.0, 0.0], [2.0, 4.0]], "axes": "x", "stiffness": 1e14 }
        ],
        "stage": [{ "name": "weight", "kind": "static", "duration": 20.0, "convergence": 1e-7 }]
    }))
    .expect("a case");
    let mut simulation = Simulation::new(case).unwrap_or_else(|error| panic!("{error}"));
    let report = simulation.run_stage().expect("no failure");
    assert!(simulation.at_rest(&report));
    simulation
}

#[test]
fn confined_rock_is_pressed_alike_in_both_horizontal_directions() {
    let snapshot = Snapshot::of(&column(json!({})));
    assert!(snapshot.stress.len() > 50 && snapshot.stress.len() == snapshot.stress_zz.len());
    for (stress, zz) in snapshot.stress.iter().zip(&snapshot.stress_zz) {
        // The walls give way by their springs, 1 % of the stiffness of the rock or less.
        let most = snapshot.stress.iter().map(|s| s[1].abs()).fold(0.0, f64::max);
        assert!((zz - stress[0]).abs() < 0.01 * most, "{zz} beside {stress:?}");
    }
}

#[test]
fn yielded_rock_keeps_to_its_strength_out_of_the_plane_too() {
    // Rock without friction: no two principal stresses differ by more than twice the cohesion.
    let cohesion = 1e4;
    let simulation = column(json!({ "cohesion": cohesion, "friction_deg": 0.0 }));
    assert!(simulation.yielded_elements() > 20);
    let snapshot = Snapshot::of(&simulation);
    for (&[xx, yy, xy], &zz) in snapshot.stress.iter().zip(&snapshot.stress_zz) {
        let (mean, radius) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
        let all = [mean + radius, mean - radius, zz];
        let spread = all.iter().copied().fold(f64::MIN, f64::max) - all.iter().copied().fold(f64::MAX, f64::min);
        assert!(spread <= 2.0 * cohesion * (1.0 + 1e-6), "{all:?}");
    }
}

#[test]
fn plane_stress_has_none_out_of_the_plane() {
    let snapshot = Snapshot::of(&column(json!({ "plane": "stress" })));
    assert!(snapshot.stress_zz.iter().all(|&zz| zz == 0.0) && snapshot.stress.iter().any(|s| s[1] < -1e4));
}
