//! Checks of water that flows in joints.

use super::checks::{Names, each, segment, unique};
use super::ports::word;
use crate::key::{Check, Key, fail};
use crate::keys::Plain;
use crate::{Case, Flow, Head, Integrator, Stage, StageKind};

/// Names of places in results that are no heads.
pub const PLACES: [&str; 2] = ["reservoir", "air"];

/// Checks `[flow]`, the heads, and the keys that belong to them.
///
/// # Errors
/// The first value that cannot be used, or that has no effect.
pub fn validate_flow(root: &Key, case: &Case) -> Check {
    each(&root.field("head"), &case.heads, validate_head)?;
    unique(&root.field("head"), "head", case.heads.iter().map(|head| Some(head.name.as_str())))?;
    let Some(flow) = &case.flow else { return refuse_alone(root, case) };
    let key = root.field("flow");
    flow.check(&key)?;
    validate_apertures(root, flow, case)?;
    if [case.gravity.x, case.gravity.y] == [0.0; 2] {
        return fail(&key, "needs gravity, which drives the water, and the case has 0 m/s²; add it or remove [flow]");
    }
    if case.water.as_ref().is_some_and(|water| water.joints) {
        let message = "is true, the default, and fills the joints with still water beside [flow], whose joints have \
                       the pressure of the flow; write `joints = false`";
        return fail(&root.field("water").field("joints"), message);
    }
    if case.solver.integrator == Integrator::Implicit {
        let message = "is for solver.integrator = \"explicit\", and the case has \"implicit\"; use the explicit one, \
                       or remove it";
        return fail(&key, message);
    }
    refuse_other_blocks(&key, case)
}

fn validate_head(key: &Key, head: &Head) -> Check {
    head.check(key)?;
    word(&key.field("name"), &head.name, "head")?;
    if PLACES.contains(&head.name.as_str()) {
        let message = format!("is {:?}, as results name a place that is no head; rename the head", head.name);
        return fail(&key.field("name"), message);
    }
    segment(&key.field("edge"), &head.edge)
}

/// Keys that have no effect without `[flow]`.
fn refuse_alone(root: &Key, case: &Case) -> Check {
    let remedy = "add `[flow]` or remove it";
    if !case.heads.is_empty() {
        return fail(&root.field("head").index(0), format!("has no effect without [flow], which it is for; {remedy}"));
    }
    match case.joint_laws.iter().find(|(_, law)| law.aperture.is_some()) {
        Some((name, _)) => {
            let key = root.field("joint_law").field(name).field("aperture");
            fail(&key, format!("has no effect without [flow], which it is for; {remedy}"))
        }
        None => Ok(()),
    }
}

/// Checks that each law has an aperture, and that all are in their range.
fn validate_apertures(root: &Key, flow: &Flow, case: &Case) -> Check {
    let key = root.field("flow");
    let laws = || case.joint_laws.iter().map(|(name, law)| (name, case.aperture(name, law)));
    if let Some((name, _)) = laws().find(|(_, aperture)| aperture.is_none()) {
        let message =
            format!("is missing, and joint_law.{name} has no aperture either; add `aperture = 1e-4` here or there");
        return fail(&key.field("aperture"), message);
    }
    let Some([low, high]) = case.aperture_range() else {
        return fail(&key, "has no effect: no joint law has an aperture above 0 m; give one, or remove [flow]");
    };
    if low > high {
        let (field, message) = match flow.aperture_min {
            Some(_) => {
                ("aperture_min", format!("is {} m, must be at most the greatest, {} m", Plain(low), Plain(high)))
            }
            None => ("aperture_max", format!("is {} m, must be at least the least, {} m", Plain(high), Plain(low))),
        };
        return fail(&key.field(field), format!("{message}; leave both out for the defaults"));
    }
    let outside = laws().filter_map(|(name, aperture)| Some((name, aperture.filter(|e| *e > 0.0)?)));
    match outside.clone().find(|(_, aperture)| !(low..=high).contains(aperture)) {
        Some((name, aperture)) => {
            let own = case.joint_laws[name].aperture.is_some();
            let key = if own { root.field("joint_law").field(name).field("aperture") } else { key.field("aperture") };
            let message = format!(
                "is {} m, must be at least {} m and at most {} m: flow.aperture_min and flow.aperture_max; widen that \
                 range, or correct it",
                Plain(aperture),
                Plain(low),
                Plain(high)
            );
            fail(&key, message)
        }
        None => Ok(()),
    }
}

/// The net of joints is that of the blocks at the start.
fn refuse_other_blocks(key: &Key, case: &Case) -> Check {
    let broken = case.rocks.iter().find(|(_, rock)| rock.fracture.is_some());
    let cut = case.stages.iter().position(|stage| !stage.cuts.is_empty());
    let what = match (broken, cut) {
        (Some((name, _)), _) => format!("rock.{name}.fracture"),
        (None, Some(stage)) => format!("stage[{stage}].cut"),
        (None, None) => return Ok(()),
    };
    fail(key, format!("cannot follow blocks that break or that a stage cuts, as {what} does; remove one of both"))
}

/// Checks the heads that a stage brings.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_heads(key: &Key, place: usize, stage: &Stage, case: &Case) -> Check {
    for name in stage.heads.keys() {
        let own = key.field(name);
        Names::of_heads(case).must_hold(key, name)?;
        if place == 0 {
            let message = "is in the first stage, which has the level of its [[head]]; give it there, or in a later \
                           stage";
            return fail(&own, message);
        }
        if stage.kind == StageKind::Dynamic {
            let message = "is in a dynamic stage, which holds the water pressures of the stage before; give it in a \
                           static stage";
            return fail(&own, message);
        }
    }
    Ok(())
}
