//! A fault drawn 0.24 m short of the face was joined to it on a mesh of 1.4 m, with a factor of 1.20, and not on one of
//! 1.3 m, where "at least 1000" stood beside a note. The length is one of the drawing now, and where an end decides
//! about the slope, both factors are in a warning.

use crate::common::case;
use enmm_stability::limit_analysis::{BoundError, Factor, bound, bounds};
use enmm_stability::strength_reduction::{ReductionOptions, factor_of_safety};

/// A wedge on a fault that stops before the face, a distance (m) along the fault.
fn slope(short: f64, mesh: f64, more: &str) -> String {
    let (dx, dy) = (15.2 / 15.2f64.hypot(9.49801), 9.49801 / 15.2f64.hypot(9.49801));
    let (x, y) = (0.8 + short * dx, 2.0 + short * dy);
    format!(
        "title = \"t\"\n[domain]\noutline = [[-15, -8], [40, -8], [40, 20], [8, 20], [0, 0], [-15, 0]]\n\
         joint_law = \"joints\"\n{more}\n[mesh]\nsize = {mesh:?}\n[[joint]]\n\
         points = [[{x:?}, {y:?}], [16.0, 11.49801]]\nlaw = \"fault\"\n[[joint]]\n\
         points = [[16.0, 11.49801], [16.0, 20.0]]\n[rock.gneiss]\ndensity = 2650\n\
         young = 20e9\npoisson = 0.25\n[joint_law.joints]\nfriction_deg = 35\n[joint_law.fault]\nfriction_deg = 30\n\
         [[fix]]\nedge = [[-15, -8], [40, -8]]\n[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration_max = 10\n"
    )
}

/// A second block that can move, on a level joint, so that the slope is not one block.
const LOOSE: &str = "[[joint]]\npoints = [[30, 18], [40, 18]]\n[[joint]]\npoints = [[30, 18], [30, 20]]\n";

/// tan 30° over the slope of the fault.
const RIGHT: f64 = 0.923_95;

fn assert_right(factor: Factor) {
    assert!((factor.value() / RIGHT - 1.0).abs() < 1e-3, "{factor}");
}

#[test]
fn the_bound_is_the_same_on_every_mesh() {
    for short in [0.1, 0.9] {
        let found = [0.9, 1.3, 1.4, 4.0].map(|mesh| bound(&case(&(slope(short, mesh, "") + LOOSE))).expect("a bound"));
        for bound in &found {
            assert_eq!(bound.level_tops.factor, found[0].level_tops.factor);
            let ends = bound.ends.as_ref().expect("ends that decide");
            assert_eq!(ends.drawn, Factor::AtLeast(1000.0));
            assert_right(ends.joined);
        }
        match short < 0.12 {
            true => assert_right(found[0].level_tops.factor),
            false => assert_eq!(found[0].level_tops.factor, Factor::AtLeast(1000.0)),
        }
    }
}

#[test]
fn both_factors_and_the_end_are_in_a_warning() {
    let found = bound(&case(&(slope(0.5, 2.0, "") + LOOSE))).expect("a bound");
    let told = |text: &&String| text.starts_with("ends of joints that miss a line decide about the slope");
    let warning = found.warnings.iter().find(told).expect("a warning");
    for part in ["at least 1000 as they are drawn and 0.92", "joint[0] at (1.224, 2.265) m, 0.500 m from", "(kept)"] {
        assert!(warning.contains(part), "{warning}");
    }
    assert_eq!(bounds(&case(&(slope(0.5, 2.0, "") + LOOSE))).expect("a bound").ends, None, "not beside samples");
}

#[test]
fn ends_that_do_not_decide_are_no_warning() {
    let whole = bound(&case(&(slope(0.0, 2.0, "") + LOOSE))).expect("a bound");
    assert_right(whole.level_tops.factor);
    assert_eq!(whole.ends, None);
    // A joint in the block on the fault that stops before it: with it or without it the block slides on the fault.
    let idle = "[[joint]]\npoints = [[14.0, 20.0], [14.0, 10.6]]\n";
    let found = bound(&case(&(slope(0.0, 2.0, "") + LOOSE + idle))).expect("a bound");
    assert_right(found.level_tops.factor);
    assert_eq!(found.ends, None);
}

/// One block, which is held: an error before, that named no end.
#[test]
fn an_end_that_leaves_one_block_is_named_by_the_error() {
    let error = bound(&case(&slope(0.5, 2.0, ""))).expect_err("one block");
    let text = error.to_string();
    assert!(text.contains("every block is held") && text.contains("joint[0] at (1.224, 2.265) m, 0.500 m"), "{text}");
    let BoundError::Held { ends: Some(ends), .. } = error else { panic!("{error:?}") };
    assert_right(ends.joined);
    let error = bound(&case(&slope(4.0, 2.0, ""))).expect_err("one block, and the end is deep in the rock");
    assert!(matches!(error, BoundError::Held { ends: None, .. }), "{error}");
}

#[test]
fn a_search_warns_of_the_end_that_holds_it() {
    let options = ReductionOptions { low: Some(1.0), high: Some(2.0), ..ReductionOptions::default() };
    let found = factor_of_safety(&case(&slope(0.5, 2.0, "")), &options, &mut |_, _| {}).expect("a search");
    assert!(found.factor().is_none() && found.at_least().is_some(), "{:?}", found.end);
    assert_right(found.ends.as_ref().expect("ends").joined);
    assert!(found.warnings.iter().any(|text| text.contains("joint[0] at (1.224, 2.265) m")), "{:?}", found.warnings);
}

#[test]
fn a_length_that_is_given_decides() {
    for (given, joins) in [("extend_ends = 0.6", true), ("extend_ends = 0.2", false), ("extend_ends = 0", false)] {
        let found = bound(&case(&(slope(0.5, 2.0, given) + LOOSE))).expect("a bound");
        assert_eq!(found.level_tops.factor.value() < 1.0, joins, "{given}");
        assert!(found.ends.is_some(), "{given}");
    }
    let found = bound(&case(&(slope(0.5, 2.0, "extend_ends = 0\nnear_ends = 0.1") + LOOSE))).expect("a bound");
    assert_eq!((found.ends, found.level_tops.factor), (None, Factor::AtLeast(1000.0)));
}
