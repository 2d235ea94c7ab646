//! Checks of rock bolts: values, what fits the anchorage, and stages that install them.

use super::checks::{Names, each, segment, unique};
use crate::key::{Check, Key, fail};
use crate::keys::Plain;
use crate::{Anchorage, Bolt, Case, Support};

/// Checks the bolts of a case.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_bolts(key: &Key, bolts: &[Bolt]) -> Check {
    each(key, bolts, validate_bolt)?;
    unique(key, "bolt", bolts.iter().map(|bolt| bolt.name.as_deref()))
}

fn validate_bolt(key: &Key, bolt: &Bolt) -> Check {
    bolt.check(key)?;
    if bolt.has_no_points() {
        let message = "is missing (head and far end); add `points = [[1.0, 1.0], [5.0, 0.0]]`, or name the bolt in a \
                       layer of the drawing";
        return fail(&key.field("points"), message);
    }
    segment(&key.field("points"), &bolt.points)?;
    if bolt.free_length.is_some() && bolt.anchorage == Anchorage::Ends {
        let message = "a bar held at its ends is free between them; remove it, or set `anchorage = \"grouted\"`";
        return fail(&key.field("free_length"), message);
    }
    bond(key, bolt)?;
    if let Some(limit) = bolt.yield_force.filter(|&limit| bolt.pretension > limit) {
        let message = format!(
            "is {} N, must be at most {} N, at which the bar yields; lower it or raise `yield_force`",
            Plain(bolt.pretension),
            Plain(limit)
        );
        return fail(&key.field("pretension"), message);
    }
    let [needed, value] = match bolt.support {
        Some(Support::Active) if bolt.pretension == 0.0 => ["pretension", "pretension = 100e3"],
        Some(Support::Passive) if bolt.yield_force.is_none() => ["yield_force", "yield_force = 250e3"],
        _ => ["", ""],
    };
    if let (Some(support), false) = (bolt.support, needed.is_empty()) {
        let message = format!(
            "is {:?}, so the bolt carries its `{needed}`, which is missing; add it, such as `{value}`",
            support.name()
        );
        return fail(&key.field("support"), message);
    }
    if bolt.name.is_none() && !bolt.active {
        let message = "is false, and without a name no stage can install the bolt; add `name` or remove `active`";
        return fail(&key.field("active"), message);
    }
    Ok(())
}

/// Checks the bond of a bar with the rock, and what does not go with it.
fn bond(key: &Key, bolt: &Bolt) -> Check {
    if bolt.bond.is_none() {
        let needless = [("bond_stiffness", bolt.bond_stiffness.is_some()), ("plate", bolt.plate)];
        let message = "belongs to a grouted bar with a `bond`, which is missing; add it, such as `bond = 250e3`, or \
                       remove this";
        return needless.iter().find(|(_, given)| *given).map_or(Ok(()), |(name, _)| fail(&key.field(name), message));
    }
    if bolt.bond_stiffness.is_none() {
        return fail(&key.field("bond_stiffness"), "is missing beside `bond`; add it, such as `bond_stiffness = 1e9`");
    }
    let message = match (bolt.anchorage, bolt.free_length, bolt.support) {
        (Anchorage::Ends, ..) => "belongs to a grouted bar; set `anchorage = \"grouted\"`, or remove it",
        (_, Some(_), _) => "lets the bar slip along its whole length, beside `free_length`; keep one of them",
        (.., Some(_)) => "lets the rock decide on the force, beside `support`, which gives it; keep one of them",
        _ => return Ok(()),
    };
    fail(&key.field("bond"), message)
}

/// Checks that every bolt that a stage installs is known and not there yet.
///
/// # Errors
/// The first name that cannot be used.
pub fn validate_installs(key: &Key, case: &Case) -> Check {
    let known = Names::of_bolts(case);
    let active = case.bolts.iter().filter(|bolt| bolt.active);
    let mut there: Vec<&str> = active.filter_map(|bolt| bolt.name.as_deref()).collect();
    for (i, stage) in case.stages.iter().enumerate() {
        for (k, name) in stage.install.iter().enumerate() {
            let key = key.index(i).field("install").index(k);
            known.must_hold(&key, name)?;
            if there.contains(&name.as_str()) {
                let remedy = "give it `active = false`, or remove it here";
                return fail(
                    &key,
                    format!("bolt {name:?} is there already, from the start or an earlier stage; {remedy}"),
                );
            }
            there.push(name);
        }
    }
    Ok(())
}
