//! Claim: joints that must slip before they hold are strength. A slab presses on a toe of soft rock, which yields by
//! centimetres before it holds, in the geometry as drawn; the factor is that of limit analysis, which knows no
//! elasticity.

use crate::common::case;
use enmm_stability::strength_reduction::{ReductionOptions, Verdict, factor_of_safety};

/// A slab of 2 m by 28 m under 45° over a toe of 2 m by 10 m, which is five hundred times as soft.
const SOFT_TOE: &str = r#"
title = "slab on a soft toe"
domain.outline = [
    [-30, -6], [20, -6], [20, 0], [10, 0], [10, 2], [0, 2], [0, 2.8284], [-18.5858, 21.4142], [-20, 20], [-30, 20],
]
mesh = { size = 2.5, origin = [0.13, 0.29] }
rock.hard = { density = 2500, young = 1e10, poisson = 0.25 }
rock.soft = { density = 2500, young = 2e7, poisson = 0.25, region = [[0, 0], [10, 0], [10, 2], [0, 2]] }
joint_law.plane.friction_deg = 30
joint_law.floor.friction_deg = 35
joint = [
    { points = [[0, 0], [-20, 20]], law = "plane" },
    { points = [[0, 0], [10, 0]], law = "floor" },
    { points = [[0, 0], [0, 2]], law = "plane" },
]
fix = [{ edge = [[-30, -6], [20, -6]] }]
stage = [{ name = "settle", kind = "static", duration = 10 }]
"#;

/// The bracket is 1 % wide. Limit analysis is associated and the slab slides without dilation: it may hold less.
#[test]
fn a_slab_holds_as_soon_as_its_toe_is_pressed_together() {
    let case = case(SOFT_TOE);
    let options = ReductionOptions { low: Some(3.4), high: Some(4.0), tolerance: 1e-2, ..ReductionOptions::default() };
    let reduction = factor_of_safety(&case, &options, &mut |_, _| {}).unwrap_or_else(|e| panic!("{e}"));
    let bound = reduction.bound.as_ref().expect("a bound").level_tops.factor.value();
    let factor = reduction.factor().expect("a factor");
    println!("{factor} of {bound}: {:?}", reduction.trials);
    assert!((factor / bound - 1.0).abs() < 0.015, "{factor} of {bound}");
    let stable = reduction.trials.iter().filter(|t| t.verdict == Verdict::Stable);
    assert!(
        stable.clone().count() > 0 && stable.clone().all(|t| t.slip > 0.03 && t.failing.is_empty()),
        "it must slip"
    );
    assert!(stable.clone().all(|t| t.is_far && t.word().starts_with("rests after 0.")));
    assert!(reduction.warnings.iter().any(|w| w.contains("rests only after")), "{:?}", reduction.warnings);
}
