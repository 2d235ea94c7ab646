//! Checks of random values, their correlations and the ensemble.

use crate::key::{Check, Key, fail, list};
use crate::keys::Plain;
use crate::keys::{Range, Rule};
use crate::random::{Ensemble, EnsembleOutput, POSITIVE, RandomDistribution, RandomVariable, Sampling};
use crate::{Case, RandomOf};

/// Checks `[[random]]`, `[[random_correlation]]` and `[ensemble]`.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_random(root: &Key, case: &Case) -> Check {
    let key = root.field("random");
    for (i, variable) in case.random.iter().enumerate() {
        let key = key.index(i);
        if let Some(first) = case.random[..i].iter().position(|other| other.key == variable.key) {
            let message = format!("is {:?}, that of random[{first}] already; remove one of them", variable.key);
            return fail(&key.field("key"), message);
        }
        variable.check(&key)?;
        parameters(&key, variable)?;
        shape(&key, variable)?;
    }
    correlations(&root.field("random_correlation"), case)?;
    ensemble(&root.field("ensemble"), &case.ensemble)
}

/// Each parameter is there, and nothing else.
fn parameters(key: &Key, variable: &RandomVariable) -> Check {
    let kind = variable.distribution;
    let is_seeds = kind == RandomDistribution::Seeds;
    for (name, value) in variable.numbers() {
        let needed = kind.parameters().contains(&name);
        let bound = !is_seeds && ["low", "high"].contains(&name);
        match value {
            None if needed => {
                let remedy = format!("a {} distribution has {}", kind.name(), list(kind.parameters().iter().copied()));
                return fail(&key.field(name), format!("is missing; {remedy}"));
            }
            Some(value) if !needed && !bound => {
                let has = if is_seeds { "`first`".to_owned() } else { list(kind.parameters().iter().copied()) };
                let message = format!("is {value}, but a {} distribution has {has}; remove it", kind.name());
                return fail(&key.field(name), message);
            }
            _ => {}
        }
    }
    match variable.first {
        Some(first) if !is_seeds => {
            let message = format!("is {first}, but a {} distribution has no seeds; remove it", kind.name());
            fail(&key.field("first"), message)
        }
        None if is_seeds && variable.of != RandomOf::Value => {
            fail(&key.field("of"), "seeds are whole numbers of the key itself; remove it")
        }
        _ => Ok(()),
    }
}

/// The parameters make a distribution.
fn shape(key: &Key, variable: &RandomVariable) -> Check {
    let positive = [RandomDistribution::Lognormal, RandomDistribution::Exponential];
    if let Some(mean) = variable.mean.filter(|_| positive.contains(&variable.distribution)) {
        POSITIVE.of_key("mean").hint("this distribution has positive values alone").check(key, &mean, None)?;
    }
    ascending(key, [("least", variable.least), ("most", variable.most)], false)?;
    ascending(key, [("least", variable.least), ("mode", variable.mode)], true)?;
    ascending(key, [("mode", variable.mode), ("most", variable.most)], true)?;
    ascending(key, [("low", variable.low), ("high", variable.high)], false)
}

fn ascending(key: &Key, [a, b]: [(&str, Option<f64>); 2], may_equal: bool) -> Check {
    match (a.1, b.1) {
        (Some(x), Some(y)) if x > y || (x == y && !may_equal) => {
            let how = if may_equal { "at most" } else { "less than" };
            fail(&key.field(a.0), format!("is {}, must be {how} {}, {}; swap or correct them", Plain(x), b.0, Plain(y)))
        }
        _ => Ok(()),
    }
}

fn correlations(key: &Key, case: &Case) -> Check {
    let continuous = case.random.iter().filter(|variable| variable.distribution != RandomDistribution::Seeds);
    let names: Vec<&str> = continuous.map(|variable| variable.key.as_str()).collect();
    let sorted = |[a, b]: &[String; 2]| if a < b { [a.clone(), b.clone()] } else { [b.clone(), a.clone()] };
    for (i, correlation) in case.random_correlations.iter().enumerate() {
        let key = key.index(i);
        let [a, b] = &correlation.keys;
        for (j, name) in correlation.keys.iter().enumerate() {
            if !names.contains(&name.as_str()) {
                let known = list(names.iter().copied());
                let message = format!("{name:?} is no random value with a distribution; there are: {known}");
                return fail(&key.field("keys").index(j), message);
            }
        }
        if a == b {
            return fail(&key.field("keys"), format!("both are {a:?}, must be two different keys; correct one"));
        }
        let before = &case.random_correlations[..i];
        if before.iter().any(|other| sorted(&other.keys) == sorted(&correlation.keys)) {
            return fail(&key.field("keys"), format!("{a:?} and {b:?} have a correlation already; remove one"));
        }
        correlation.check(&key)?;
    }
    Ok(())
}

fn ensemble(key: &Key, ensemble: &Ensemble) -> Check {
    ensemble.check(key)?;
    if ensemble.output == EnsembleOutput::Failure {
        const RULE: Rule = Ensemble::rule("limit")
            .in_range(Range::from(0.05).to(20.0))
            .hint("with output = \"failure\" trials are made at it, which reach so far");
        RULE.check(key, &ensemble.limit, None)?;
    }
    if ensemble.interval.is_none() {
        return Ok(());
    }
    if ensemble.sampling != Sampling::MonteCarlo {
        let message = "needs sampling = \"monte_carlo\": the first samples of a Latin hypercube are no sample of the \
                       whole; set that, or leave out `interval`";
        return fail(&key.field("interval"), message.to_owned());
    }
    Ok(())
}
