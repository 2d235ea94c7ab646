//! The problems of joints and supports pass with their own values and with others.

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

fn assert_all(id: &str, sets: &[&[(&str, f64)]]) {
    let failing: Vec<String> = sets.iter().flat_map(|set| solve(id, true, set)).collect();
    assert!(failing.is_empty(), "{failing:#?}");
}

/// A block as high as long slides upright up to 45° of friction, and tips over beyond: C1 offers no such friction, and
/// C2 no block that topples.
#[test]
fn c1_and_c2_offer_no_block_that_topples() {
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
fn c3_two_blocks() {
    assert_all(
        "C3",
        &[
            &[],
            &[("phi_lower_deg", 30.0)],
            &[("a_deg", 22.0), ("phi_lower_deg", 27.0), ("phi_upper_deg", 5.0), ("mesh", 0.4)],
            &[("phi_lower_deg", 10.0), ("phi_upper_deg", 25.0)],
        ],
    );
}

#[test]
fn c12_bolts() {
    assert_all("C12", &[&[], &[("a_deg", 35.0), ("phi_deg", 20.0), ("weight", 750.0), ("spacing", 2.0)]]);
}

#[test]
fn d3_direct_shear() {
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
fn d6_roof_wedge() {
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
