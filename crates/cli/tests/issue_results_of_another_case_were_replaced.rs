//! A second case with the same folder for its results replaced those of the first without a word.

use crate::support::{Place, incline};

#[test]
fn results_of_another_case_are_replaced_by_force_alone() {
    let place = Place::with(&incline(0.65, ""));
    std::fs::copy(place.path("case.toml"), place.path("other.toml")).expect("a copy");
    for command in ["run", "fos"] {
        let first = place.enmm(&[command, "case.toml", "-o", command]);
        assert_eq!(first.status, Some(0), "{first:?}");
        assert_eq!(place.enmm(&[command, "case.toml", "-o", command]).status, Some(0), "its own results are replaced");
        let refused = place.enmm(&[command, "other.toml", "-o", command]);
        assert_eq!(refused.status, Some(2), "{refused:?}");
        assert!(refused.stderr.contains("case.toml") && refused.stderr.contains("--force"), "{refused:?}");
        assert_eq!(place.enmm(&[command, "other.toml", "-o", command, "--force"]).status, Some(0));
    }
}

/// A picture that `check` draws among the results of another case, or a bound beside its factor, passes for its own.
#[test]
fn bounds_and_pictures_of_another_case_are_refused_as_well() {
    let place = Place::with(&incline(0.65, ""));
    std::fs::copy(place.path("case.toml"), place.path("other.toml")).expect("a copy");
    assert_eq!(place.enmm(&["bound", "case.toml", "-o", "out"]).status, Some(0));
    for command in ["bound", "check"] {
        assert_eq!(place.enmm(&[command, "case.toml", "-o", "out"]).status, Some(0), "its own results are replaced");
        let before = std::fs::read(place.path("out/bound.json")).expect("a record");
        let refused = place.enmm(&[command, "other.toml", "-o", "out"]);
        assert_eq!(refused.status, Some(2), "{refused:?}");
        assert!(refused.stderr.contains("case.toml") && refused.stderr.contains("--force"), "{refused:?}");
        assert_eq!(std::fs::read(place.path("out/bound.json")).expect("a record"), before);
    }
    for command in ["check", "bound"] {
        let forced = place.enmm(&[command, "other.toml", "-o", "out", "--force"]);
        assert_eq!(forced.status, Some(0), "{forced:?}");
    }
    assert_eq!(place.enmm(&["fos", "case.toml", "-o", "out"]).status, Some(2), "the bound is that of the other case");
}
