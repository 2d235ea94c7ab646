//! Claim: every problem that both integrators know passes in its quick form with either.

use enmm::model::case::Integrator;
use enmm_verification::{Setup, problems::ALL};

/// Problems of the continuum and of walls at rest; tolerances are the problems' own, the same for both.
#[test]
fn beams_columns_and_walls_pass_with_either() {
    for problem in ALL.iter().filter(|p| ["B1", "B2", "B3", "E2"].contains(&p.id)) {
        for integrator in [Integrator::Explicit, Integrator::Implicit] {
            let mut setup = Setup { integrator, ..Setup::of(problem, true) };
            let outcome = (problem.run)(&mut setup).unwrap_or_else(|e| panic!("{}: {}", problem.id, e.0));
            for row in &outcome.rows {
                let message = format!("{} is {:e}, exact {:e}", row.quantity, row.computed, row.exact);
                assert!(row.passes(), "{} {integrator:?}: {message}", problem.id);
            }
            assert!(outcome.passes(), "{} has no rows", problem.id);
        }
    }
}

/// A document comes out of a comparison, with every model in it.
#[test]
fn long_a_quick_comparison_writes_its_document() {
    let comparison = enmm_verification::comparison::compare(true).unwrap_or_else(|e| panic!("{}", e.0));
    let text = comparison.markdown(&[]);
    assert!(["Beam", "Sliding block", "Fractured slope", "Slope that fails"].iter().all(|name| text.contains(name)));
    assert!(comparison.entries.iter().all(|e| e.error.is_finite() && e.at_rest), "{text}");
    let failures = &comparison.failures;
    assert!(failures.iter().all(|f| f.entry.error.abs() < 0.05 && f.entry.at_rest && f.entry.steps[1] > 0), "{text}");
    assert_eq!(comparison.plots.len(), 5);
}
