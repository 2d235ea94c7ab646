//! Claim: problems pass with other values of their parameters, too: other shapes, planes, rocks and time steps.

use crate::common::extent::by_extent;
use enmm::model::case::Integrator;
use enmm_verification::{Setup, Values, problems};

/// Solves a problem with some values changed; returns the rows that fail.
fn solve(id: &str, quick: bool, changes: &[(&str, f64)]) -> Vec<String> {
    let problem = problems::ALL.iter().find(|p| p.id == id).expect("the problem is registered");
    let mut values = Values::of(problem);
    for (name, value) in changes {
        values.set(problem, name, *value).unwrap_or_else(|e| panic!("{}", e.0));
    }
    let mut setup = Setup { values, integrator: Integrator::Explicit, quick, cases: Vec::new() };
    let outcome = (problem.run)(&mut setup).unwrap_or_else(|e| panic!("{id} {changes:?}: {}", e.0));
    let mut failing = Vec::new();
    for row in &outcome.rows {
        let line = format!(
            "{id} {changes:?} {}: {:.7e} of {:.7e}, error {:.2e}",
            row.quantity,
            row.computed,
            row.exact,
            row.error()
        );
        if !row.passes() {
            failing.push(line);
        }
    }
    failing
}

/// Solves a problem with sets of values; its quick form takes two of them.
fn assert_all(id: &str, sets: &[&[(&str, f64)]]) {
    let taken = sets.iter().take(by_extent([2, usize::MAX, usize::MAX]));
    let failing: Vec<String> = taken.flat_map(|set| solve(id, true, set)).collect();
    assert!(failing.is_empty(), "{failing:#?}");
}

/// A block as high as long slides upright up to 45° of friction, and tips over beyond: C1 offers no such friction, and
/// C2 no block that topples.
#[test]
fn long_c1_and_c2_offer_no_block_that_topples() {
    assert_all("C1", &[&[("phi_brake_deg", 40.0)], &[("a_deg", 42.0), ("phi_deg", 40.0), ("phi_rest_deg", 60.0)]]);
    let problem = |id: &str| problems::ALL.iter().find(|p| p.id == id).expect("the problem is registered");
    assert!(Values::of(problem("C1")).set(problem("C1"), "phi_brake_deg", 45.0).is_err());
    let mut values = Values::of(problem("C2"));
    values.set(problem("C2"), "height", 7.0).unwrap_or_else(|e| panic!("{}", e.0));
    let mut setup = Setup { values, integrator: Integrator::Explicit, quick: true, cases: Vec::new() };
    let told = (problem("C2").run)(&mut setup).expect_err("a block of 7 m on 4 m topples on 30°");
    assert!(told.0.contains("below length/tan a"), "{}", told.0);
}

#[test]
fn long_a1_meshes_and_turns() {
    assert_all(
        "A1",
        &[
            &[
                ("seed", 21.0),
                ("mesh", 1.4),
                ("mesh_angle_deg", 47.0),
                ("mesh_x", 4.1),
                ("mesh_y", -3.3),
                ("turn_deg", -75.0),
            ],
            &[
                ("seed", 41.0),
                ("mesh", 0.6),
                ("mesh_angle_deg", 8.0),
                ("traces", 2.5),
                ("turn_deg", 179.0),
                ("joints", 4.0),
            ],
        ],
    );
}

#[test]
fn a2_gravity_and_damping() {
    let sideways = [("g", 3.5355), ("direction_deg", -61.26), ("mesh_angle_deg", 31.0)];
    assert_all("A2", &[&[("mesh", 1.0), ("mesh_angle_deg", 0.0)], &[("damping", 0.0)], &sideways]);
}

/// A block that is no convex polygon, one of about a mesh size, and one with a joint that ends inside it.
#[test]
fn long_a3_shapes() {
    assert_all(
        "A3",
        &[
            &[("seed", 3.0), ("corners", 9.0)],
            &[("corners", 3.0), ("size", 0.6), ("mesh", 1.6), ("w0", 2.0)],
            &[("corners", 4.0), ("size", 1.7), ("mesh", 0.27), ("crack", 1.0)],
        ],
    );
}

#[test]
fn long_a4_friction_damping_and_steps() {
    assert_all(
        "A4",
        &[
            &[("seed", 3.0), ("friction_deg", 60.0), ("damping", 0.5), ("dt_max", 1e-4)],
            &[("seed", 4.0), ("friction_deg", 20.0), ("dt_max", 2e-4)],
        ],
    );
}

/// A frictionless collision without damping, which the full form takes to its end.
#[test]
fn a4_without_damping() {
    let undamped = [("damping", 0.0), ("young", 1e11), ("dt_max", 2.5e-6), ("steps", 36_000.0)];
    let failing = solve("A4", false, &[&[("seed", 2.0), ("friction_deg", 0.0)][..], &undamped].concat());
    assert!(failing.is_empty(), "{failing:#?}");
}

#[test]
fn long_b1_and_b3_rocks() {
    assert_all("B1", &[&[("poisson", 0.1)]]);
    assert_all("B3", &[&[("young", 5e9), ("poisson", 0.35), ("gamma", 22e3)]]);
}

/// Friction just below the dip, steep planes, a level one, and rock so soft that a block takes up shear for long.
#[test]
fn long_c1_planes_and_rocks() {
    assert_all(
        "C1",
        &[
            &[("a_deg", 23.7), ("phi_deg", 11.3), ("a_steep_deg", 52.0), ("phi_steep_deg", 18.0)],
            &[("phi_deg", 29.0), ("a_rest_deg", 45.0), ("phi_rest_deg", 46.0), ("young_rest", 5e7), ("mesh", 1.0)],
            &[("a_deg", 37.0), ("phi_deg", 24.0), ("a_rest_deg", 20.0), ("phi_rest_deg", 20.5)],
            &[("phi_deg", 10.0), ("a_brake_deg", 10.0), ("phi_brake_deg", 25.0), ("v0", 1.5)],
            &[("a_brake_deg", 0.0), ("phi_brake_deg", 20.0), ("v0", 2.5), ("phi_rest_deg", 35.0), ("young_rest", 1e9)],
        ],
    );
}

#[test]
fn long_c2_blocks() {
    assert_all(
        "C2",
        &[
            &[("length", 3.7), ("height", 1.3), ("a_deg", 22.0), ("phi_c_deg", 18.0), ("cohesion", 11e3)],
            &[("height", 1.0), ("a_deg", 41.0), ("phi_c_deg", 0.0), ("cohesion", 30e3), ("mesh", 0.9)],
        ],
    );
}

#[test]
fn long_c3_two_blocks() {
    assert_all(
        "C3",
        &[
            &[],
            &[("phi_lower_deg", 30.0)],
            &[("phi_lower_deg", 25.0), ("phi_upper_deg", 5.0)],
            &[("a_deg", 22.0), ("phi_lower_deg", 27.0), ("phi_upper_deg", 5.0), ("mesh", 0.4)],
            &[("phi_lower_deg", 10.0), ("phi_upper_deg", 25.0)],
        ],
    );
}

/// The angular acceleration of other blocks; one limit each.
#[test]
fn c6_toppling_blocks() {
    let one = [("k_count", 1.0)];
    for (k, a_deg) in [(0.2, 30.0), (0.4, 30.0), (0.25, 20.0)] {
        let failing = solve(
            "C6",
            true,
            &[&one[..], &[("k", k), ("k_low", k), ("k_high", 0.34f64.max(k)), ("a_deg", a_deg)]].concat(),
        );
        assert!(failing.is_empty(), "{failing:#?}");
    }
}

#[test]
fn c9_wedge() {
    let wedge = [("height", 55.0), ("crack", 9.5), ("face_deg", 57.0), ("plane_deg", 31.0)];
    assert_all("C9", &[&[&wedge[..], &[("water_half", 3.1), ("water_full", 6.2)]].concat()]);
}

#[test]
fn long_c12_bolts() {
    assert_all("C12", &[&[], &[("a_deg", 35.0), ("phi_deg", 20.0), ("weight", 750.0), ("spacing", 2.0)]]);
}

#[test]
fn long_d3_direct_shear() {
    assert_all(
        "D3",
        &[
            &[],
            &[("sn", 3e6), ("phi_deg", 38.0), ("c", 0.2e6), ("ks", 4e10), ("jrc", 6.0)],
            &[
                ("sn", 2e5),
                ("c", 0.0),
                ("phi_residual_deg", 20.0),
                ("ks", 1e9),
                ("kn", 5e9),
                ("jrc", 15.0),
                ("jcs", 5e7),
            ],
        ],
    );
}

#[test]
fn long_d5_drop_of_less_on_a_softer_spring() {
    assert_all("D5", &[&[("m", 2000.0), ("k", 4e8), ("H", 0.2)]]);
}

/// Sixty seconds; the wall of 20 × 20 bricks with `ENMM_LONG=1`, one of 5 × 5 otherwise.
#[test]
fn long_e2_a_wall_rests_for_a_minute() {
    let (side, seconds) = by_extent([(5.0, 6.0), (5.0, 60.0), (20.0, 60.0)]);
    let failing = solve("E2", false, &[("columns", side), ("courses", side), ("seconds", seconds)]);
    assert!(failing.is_empty(), "{failing:#?}");
}

#[test]
fn long_d6_roof_wedge() {
    assert_all(
        "D6",
        &[
            &[],
            &[("rows", 14.0)],
            &[("a_deg", 30.0), ("phi_deg", 35.0), ("ratio", 5.0)],
            &[("a_deg", 12.0), ("phi_deg", 50.0), ("ratio", 0.5), ("height", 5.0), ("ks", 2e8)],
        ],
    );
}
