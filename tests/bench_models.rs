//! Claim: the standard models of `enmm bench` run, and its shares account for the whole step.

use enmm::io::bench::bench;

#[test]
fn standard_models_run_and_shares_sum_to_one() {
    let found = bench(0.05).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(found.len(), 2);
    for model in &found {
        let shares = model.shares;
        let sum = shares.elements + shares.search + shares.entrance + shares.sweep + shares.commit + shares.rest;
        assert!((sum - 1.0).abs() < 1e-12 && shares.rest >= 0.0, "{model:?}");
        assert!((5_000..20_000).contains(&model.elements) && model.steps_per_second > 0.0, "{model:?}");
    }
    assert!(found[0].contacts_per_second.is_none() && found[1].contacts > 1000, "{found:?}");
}
