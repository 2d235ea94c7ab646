//! Claim: a corner that meets rock ahead of it in a point, or over a length that the rock cannot bear, carries no
//! slope: the factor is that of the plane on which the block stands. Corners that only look so are left alone.

use crate::common::case;
use enmm::model::Simulation;
use enmm_stability::corners::{CornerContact, corner_contacts};
use enmm_stability::strength_reduction::{Reduction, ReductionOptions, factor_of_safety};

/// A wedge of a face from (10, 5) to (15, 20) on a plane of 35° through `joint`, with the ground in front of it.
fn wedge(joint: &str, ground: f64, laws: &str, more: &str) -> String {
    format!(
        "title = \"toe\"\n[domain]\noutline = [[0, -20], [40, -20], [40, 20], [15, 20], [10, 5], [0, {ground}]]\n\
         [mesh]\nsize = 4.0\n[rock.r]\ndensity = 2650\nyoung = 20e9\npoisson = 0.25\n[joint_law.fault]\n{laws}\n\
         [[joint]]\npoints = {joint}\n[[fix]]\nedge = [[0, -20], [40, -20]]\n{more}\n\
         [[stage]]\nname = \"gravity\"\nkind = \"static\"\nduration_max = 5.0\n"
    )
}

/// Friction of 30° and cohesion of 20 kPa on a plane that daylights at the toe: the formula gives 1.1093.
const FORMULA: f64 = 1.1093;
const ROUGH: &str = "friction_deg = 30\ncohesion = 20e3";
const AT_TOE: &str = "[[10, 5], [32, 20.4046]]";

fn factor(text: &str) -> Reduction {
    let options = ReductionOptions { low: Some(0.5), tolerance: 1e-2, ..ReductionOptions::default() };
    factor_of_safety(&case(text), &options, &mut |_, _| {}).unwrap_or_else(|e| panic!("{e}"))
}

fn points(text: &str) -> Vec<CornerContact> {
    let simulation = Simulation::new(case(text)).expect("builds");
    corner_contacts(&simulation).into_iter().filter(|corner| corner.length() < 0.2).collect()
}

/// The bracket is 1 % wide, and so is the tolerance.
fn assert_near(text: &str, right: f64) -> Reduction {
    let found = factor(text);
    let factor = found.factor().expect("a factor");
    assert!((factor / right - 1.0).abs() < 0.01, "{factor} instead of {right}");
    found
}

#[test]
fn a_plane_that_daylights_at_the_toe_has_the_factor_of_its_formula() {
    let found = assert_near(&wedge(AT_TOE, 5.0, ROUGH, ""), FORMULA);
    let corners = found.corners.expect("the corner is named");
    let [carrying] = &corners.corners[..] else { panic!("{:?}", corners.corners) };
    let [at, _] = carrying.corner.ends;
    assert!((at.x - 10.0).hypot(at.y - 5.0) < 1e-9 && carrying.corner.length() == 0.0, "{at:?}");
    assert!(carrying.force > 1e5, "{} N/m", carrying.force);
    let held = corners.series.factor().expect("a factor where it holds");
    assert!((2.6..3.55).contains(&held), "{held}; rigid blocks 3.507");
    assert!(found.warnings.iter().any(|w| w.contains("at (10.000, 5.000) m carries")), "{:?}", found.warnings);
}

#[test]
fn ground_that_falls_less_than_the_plane_holds_no_tip() {
    let ground = 5.0 - 10.0 * 15f64.to_radians().tan();
    assert_near(&wedge("[[10, 5], [31.4222, 20]]", ground, "friction_deg = 20", ""), 0.520);
}

#[test]
fn a_lip_counts_by_the_force_that_its_length_bears() {
    let lip = |length: f64| format!("[[10, 5], [10, {}], [32, {}]]", 5.0 - length, 20.4046 - length);
    let short = assert_near(&wedge(&lip(0.01), 5.0, ROUGH, ""), FORMULA);
    let corners = short.corners.expect("the lip is named").corners;
    assert!((corners[0].corner.length() - 0.01).abs() < 1e-9, "{corners:?}");
    assert!(corners[0].force > corners[0].corner.capacity());
    let long = factor(&wedge(&lip(0.2), 5.0, ROUGH, ""));
    assert!(long.corners.is_none() && long.at_least().is_some(), "20 cm bear 10 MN/m: {:?}", long.factor());
}

#[test]
fn the_case_decides_about_corners() {
    let hold = factor(&wedge(AT_TOE, 5.0, ROUGH, "[solver]\ncorner_contacts = \"hold\""));
    assert!(hold.corners.is_none() && hold.factor().is_some_and(|factor| factor > 2.6), "{:?}", hold.factor());
}

/// A fault that goes on below the ground parts the rock ahead from the rock below: the same corner.
#[test]
fn rock_ahead_may_be_another_block() {
    let corners = points(&wedge("[[-4, -4.8029], [32, 20.4046]]", 5.0, ROUGH, ""));
    assert!(!corners.is_empty() && corners.iter().all(|c| (c.ends[0].x - 10.0).abs() < 1e-6), "{corners:?}");
}

#[test]
fn kinks_crossings_and_free_feet_are_no_corner_contacts() {
    let kinked = "[[joint]]\npoints = [[20, 12.0021], [20, 20]]";
    let free = wedge("[[10.1, 5.3], [20, 12], [32, 20.4046]]", 5.0, ROUGH, kinked);
    assert_eq!(points(&free), [], "a plane above the toe with a kink under a joint");
    let crossing = wedge("[[11, 8], [29, 20]]", 5.0, ROUGH, "[[joint]]\npoints = [[13, 14], [31, 2]]");
    assert_eq!(points(&crossing), [], "two joints that cross");
}

/// A square on one of its corners in a notch has no face to stand on.
#[test]
fn a_block_that_stands_on_corners_alone_keeps_them() {
    let text = "title = \"square\"\n[domain]\noutline = [[-6, -4], [6, -4], [6, 2], [0, 0], [-6, 2]]\n\
                islands = [[[0, 0], [1, 1], [0, 2], [-1, 1]]]\n[mesh]\nsize = 2.0\n[rock.r]\ndensity = 2600\n\
                young = 10e9\npoisson = 0.25\n[joint_law.j]\nfriction_deg = 30\n[[fix]]\nedge = [[-6, -4], [6, -4]]\n\
                [[stage]]\nname = \"s\"\nkind = \"static\"\nduration = 1.0\n";
    assert_eq!(points(text), []);
}
