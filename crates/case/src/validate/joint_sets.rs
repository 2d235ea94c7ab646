//! Checks of joint sets and of regions whose joints have another law.

use super::checks::{Names, each, region};
use crate::key::{Check, Key, fail, list, nearest};
use crate::keys::Plain;
use crate::{AngleDistribution, Case, Distribution, JointSet};

/// Greatest standard deviation of a uniform distribution of positive values, relative to the mean: 1/√3.
const UNIFORM_RATIO: f64 = 0.577_350_269_189_625_8;

/// Checks the values of a joint set.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_set(key: &Key, set: &JointSet) -> Check {
    set.check(key)?;
    for (name, value) in [("trace_length_sd", set.trace_length_sd), ("gap", set.gap)] {
        if set.trace_length.is_none() && value > 0.0 {
            let message =
                format!("is {} m, but joints without `trace_length` do not end; add `trace_length`", Plain(value));
            return fail(&key.field(name), message);
        }
    }
    validate_angles(key, set)?;
    validate_spread(key, "spacing", set.spacing_distribution, set.spacing, set.spacing_sd)?;
    let kind = set.trace_length_distribution;
    match set.trace_length {
        Some(length) => validate_spread(key, "trace_length", kind, length, set.trace_length_sd)?,
        None if kind != Distribution::Normal => {
            let message = "has no effect on joints that do not end; add `trace_length` or remove it";
            return fail(&key.field("trace_length_distribution"), message);
        }
        None => {}
    }
    set.region.as_ref().map_or(Ok(()), |ring| region(&key.field("region"), ring))
}

/// Checks the rock bridges of a set.
///
/// # Errors
/// Their law is none of the case, or the set has none.
pub fn validate_bridges(key: &Key, set: &JointSet, laws: &Names) -> Check {
    let Some(law) = &set.bridge_law else { return Ok(()) };
    let key = key.field("bridge_law");
    laws.must_hold(&key, law)?;
    if set.trace_length.is_none() || set.gap == 0.0 {
        let message =
            format!("is {law:?}, but the traces have no gaps; add `trace_length` and `persistence`, or remove it");
        return fail(&key, message);
    }
    Ok(())
}

/// Checks the keys that the distribution of angles needs, and those that it does not use.
fn validate_angles(key: &Key, set: &JointSet) -> Check {
    let is_fisher = set.angle_distribution == AngleDistribution::Fisher;
    match set.fisher_k {
        Some(k) if !is_fisher => {
            let remedy = "add `angle_distribution = \"fisher\"` or remove it";
            return fail(&key.field("fisher_k"), format!("is {k}, but the angles are not Fisher's; {remedy}"));
        }
        None if is_fisher => {
            let message = "is \"fisher\", which needs `fisher_k`, the concentration; add `fisher_k = 50.0`";
            return fail(&key.field("angle_distribution"), message);
        }
        _ => {}
    }
    if is_fisher && set.dip_sd_deg > 0.0 {
        let message = format!("is {}, but `fisher_k` gives the scatter; remove one of them", set.dip_sd_deg);
        return fail(&key.field("dip_sd_deg"), message);
    }
    Ok(())
}

/// Checks the keys that the distribution of spacings or lengths needs.
fn validate_spread(key: &Key, name: &str, kind: Distribution, mean: f64, sd: f64) -> Check {
    let place = key.field(&format!("{name}_sd"));
    match kind {
        Distribution::Normal if sd > mean => fail(
            &place,
            format!(
                "is {sd} m, must be at most the mean, {mean} m; lower it or add `{name}_distribution = \"lognormal\"`"
            ),
        ),
        Distribution::Exponential if sd != 0.0 && sd != mean => {
            fail(&place, format!("is {sd} m, but that of an exponential distribution is its mean, {mean} m; remove it"))
        }
        Distribution::Uniform if sd > UNIFORM_RATIO * mean => fail(
            &place,
            format!(
                "is {sd} m, must be at most {:.6} m, the mean over √3, for a uniform distribution without negative \
                 values; lower it",
                UNIFORM_RATIO * mean
            ),
        ),
        Distribution::Lognormal if sd > 10.0 * mean => {
            fail(&place, format!("is {sd} m, must be at most ten times the mean, {mean} m; lower it"))
        }
        Distribution::Lognormal | Distribution::Uniform if sd == 0.0 => {
            fail(&place, format!("is 0 m, so that `{name}_distribution` has no effect; add it, or remove that"))
        }
        _ => Ok(()),
    }
}

/// Checks on what the traces of a set end, and its name.
///
/// # Errors
/// There is no such set before this one and no such law, the set goes through, or the name is another set's or a law's.
pub fn validate_end(key: &Key, case: &Case, index: usize) -> Check {
    let (set, before) = (&case.joint_sets[index], &case.joint_sets[..index]);
    let sets = || before.iter().filter_map(|set| set.name.as_deref());
    let laws = || case.joint_laws.keys().map(String::as_str);
    if let Some(name) = &set.name
        && (name.trim().is_empty() || sets().chain(laws()).any(|other| other == name))
    {
        let message = format!("{name:?} is empty, or the name of another set or of a joint law; give it another name");
        return fail(&key.field("name"), message);
    }
    let Some(end) = &set.ends_on else { return Ok(()) };
    let key = key.field("ends_on");
    if !sets().chain(laws()).any(|name| name == end) {
        let near =
            nearest(end, sets().chain(laws())).map_or_else(String::new, |near| format!(", did you mean {near:?}?"));
        let message = format!(
            "no set before this one and no joint law is named {end:?}{near}; sets: {}; laws: {}",
            list(sets()),
            list(laws())
        );
        return fail(&key, message);
    }
    if set.trace_length.is_none() {
        let message = format!("is {end:?}, but joints without `trace_length` go through; add `trace_length`");
        return fail(&key, message);
    }
    Ok(())
}

/// Checks the regions whose joints have another law.
///
/// # Errors
/// The first polygon or law that cannot be used.
pub fn validate_law_regions(key: &Key, case: &Case) -> Check {
    let laws = Names::of_laws(case);
    each(key, &case.law_regions, |key, change| {
        change.check(key)?;
        region(&key.field("region"), &change.region)?;
        change.from.as_ref().map_or(Ok(()), |from| laws.must_hold(&key.field("from"), from))?;
        laws.must_hold(&key.field("to"), &change.to)?;
        if change.from.as_ref() == Some(&change.to) {
            return fail(&key.field("to"), format!("is {:?}, the law to replace; name another law", change.to));
        }
        Ok(())
    })
}
