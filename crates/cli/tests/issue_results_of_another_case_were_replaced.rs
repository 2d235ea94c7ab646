//! A second case with the same folder for its results replaced those of the first without a word.

use crate::support::{Place, incline};

#[test]
fn results_of_another_case_are_replaced_by_force_alone() {
    let place = Place::with(&incline(0.65, ""));
    std::fs::copy(place.path("case.toml"), place.path("other.toml")).expect("a copy");
    for command in ["run", "fos"] {
        place.answers(0, &[command, "case.toml", "-o", command]);
        // Its own results are replaced.
        place.answers(0, &[command, "case.toml", "-o", command]);
        let refused = place.answers(2, &[command, "other.toml", "-o", command]);
        assert!(refused.stderr.contains("case.toml") && refused.stderr.contains("--force"), "{refused:?}");
        place.answers(0, &[command, "other.toml", "-o", command, "--force"]);
    }
}

/// A picture that `check` draws among the results of another case, or a bound beside its factor, passes for its own.
#[test]
fn bounds_and_pictures_of_another_case_are_refused_as_well() {
    let place = Place::with(&incline(0.65, ""));
    std::fs::copy(place.path("case.toml"), place.path("other.toml")).expect("a copy");
    place.answers(0, &["bound", "case.toml", "-o", "out"]);
    for command in ["bound", "check"] {
        // Its own results are replaced.
        place.answers(0, &[command, "case.toml", "-o", "out"]);
        let before = std::fs::read(place.path("out/bound.json")).expect("a record");
        let refused = place.answers(2, &[command, "other.toml", "-o", "out"]);
        assert!(refused.stderr.contains("case.toml") && refused.stderr.contains("--force"), "{refused:?}");
        assert_eq!(std::fs::read(place.path("out/bound.json")).expect("a record"), before);
    }
    for command in ["check", "bound"] {
        place.answers(0, &[command, "other.toml", "-o", "out", "--force"]);
    }
    // The bound is that of the other case.
    place.answers(2, &["fos", "case.toml", "-o", "out"]);
}
