//! Helpers of these tests: factors of case texts, parts of texts, refusals.

use std::fmt::Debug;

use enmm_stability::limit_analysis::BoundError;
use enmm_stability::strength_reduction::{ReductionOptions, factor_of_safety};

use crate::common::case;

/// Factor of safety by `enmm fos`.
pub fn factor(text: &str) -> f64 {
    let found = factor_of_safety(&case(text), &ReductionOptions::default(), &mut |_, _| {});
    found.unwrap_or_else(|e| panic!("{e}")).factor().expect("a factor")
}

/// `text` without what lies between the first `from` and the next `to`, or the end where `to` is empty.
pub fn without(text: &str, from: &str, to: &str) -> String {
    let (before, rest) = text.split_once(from).expect(from);
    let after = if to.is_empty() { "" } else { &rest[rest.find(to).expect(to)..] };
    format!("{before}{after}")
}

/// Asserts that limit analysis has refused a case for this key, with a remedy.
pub fn assert_refused<T: Debug>(found: Result<T, BoundError>, key: &str) {
    match found {
        Err(BoundError::Case(invalid)) => {
            assert_eq!(invalid.key, key, "{}", invalid.message);
            assert!(invalid.message.contains(": "), "no remedy: {}", invalid.message);
        }
        other => panic!("{key}: {other:?}"),
    }
}
