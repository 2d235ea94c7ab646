//! Claim: `enmm bench --write` writes the cases of its models and times nothing.

use crate::support::{Place, case};

#[test]
fn cases_of_models_are_written_and_can_be_built() {
    let place = Place::with(&case(0.02));
    let answer = place.answers(0, &["bench", "--models", "slope_20x4,continuum_200", "--write", "models"]);
    for name in ["models/slope_20x4.toml", "models/continuum_200.toml"] {
        assert!(answer.stdout.contains(name), "{answer:?}");
        place.answers(0, &["check", name]);
    }
    place.enmm(&["bench", "--write", "case.toml/x"]).assert_bad_input(&["case.toml/x", "another directory"]);
}
