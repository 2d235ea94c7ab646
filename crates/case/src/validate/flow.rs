//! Checks of water that flows in joints.

use super::checks::{Names, each, points, segment, unique};
use super::ports::word;
use crate::key::{Check, Key, fail};
use crate::keys::Plain;
use crate::{Case, Drain, Flow, Head, Integrator, JointLaw, Rain, Stage, StageFlow, StageKind};

/// Names of places in results that are no heads.
pub const PLACES: [&str; 2] = ["reservoir", "air"];

/// Checks `[flow]`, the heads, and the keys that belong to them.
///
/// # Errors
/// The first value that cannot be used, or that has no effect.
pub fn validate_flow(root: &Key, case: &Case) -> Check {
    each(&root.field("head"), &case.heads, validate_head)?;
    each(&root.field("rain"), &case.rains, validate_rain)?;
    each(&root.field("drain"), &case.drains, validate_drain)?;
    validate_names(root, case)?;
    let Some(flow) = &case.flow else { return refuse_alone(root, case) };
    let key = root.field("flow");
    flow.check(&key)?;
    validate_apertures(root, flow, case)?;
    validate_pace(&key, flow, case)?;
    validate_part(&key, flow, case)?;
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

/// Checks that the pace of flow has an effect.
fn validate_pace(key: &Key, flow: &Flow, case: &Case) -> Check {
    let Some(pace) = flow.pace.filter(|_| !case.stages.iter().any(Stage::is_transient)) else { return Ok(()) };
    let message = format!(
        "is {}, and has no effect without a dynamic stage with `flow = \"transient\"`; add one, or remove it",
        Plain(pace)
    );
    fail(&key.field("pace"), message)
}

/// Checks that an opening from which pieces part has an effect.
fn validate_part(key: &Key, flow: &Flow, case: &Case) -> Check {
    let is_dynamic = |stage: &Stage| stage.kind == StageKind::Dynamic;
    let Some(part) = flow.part.filter(|_| !case.stages.iter().any(is_dynamic)) else { return Ok(()) };
    let message = format!("is {} m, and has no effect without a dynamic stage; add one, or remove it", Plain(part));
    fail(&key.field("part"), message)
}

fn validate_head(key: &Key, head: &Head) -> Check {
    head.check(key)?;
    validate_name(key, &head.name, "head")?;
    segment(&key.field("edge"), &head.edge)
}

fn validate_rain(key: &Key, rain: &Rain) -> Check {
    rain.check(key)?;
    validate_name(key, &rain.name, "rain")?;
    segment(&key.field("edge"), &rain.edge)?;
    let [[a, _], [b, _]] = rain.edge;
    if a == b {
        let message = "is vertical, so that no rain falls on it; give two points of the surface whose x differ";
        return fail(&key.field("edge"), message);
    }
    Ok(())
}

fn validate_drain(key: &Key, drain: &Drain) -> Check {
    drain.check(key)?;
    validate_name(key, &drain.name, "drain")?;
    points(&key.field("points"), &drain.points, 2, "a drain")
}

fn validate_name(key: &Key, name: &str, what: &str) -> Check {
    let key = key.field("name");
    word(&key, name, what)?;
    if PLACES.contains(&name) {
        return fail(&key, format!("is {name:?}, as results name a place that is no {what}; rename the {what}"));
    }
    Ok(())
}

/// Results tell heads, rain and drains apart by name.
fn validate_names(root: &Key, case: &Case) -> Check {
    let lists = Names::of_flow(case);
    for (k, list) in lists.iter().enumerate() {
        let (what, names) = (list.what(), list.known());
        unique(&root.field(what), what, names.iter().copied().map(Some))?;
        for others in &lists[..k] {
            if let Some(at) = names.iter().position(|name| others.known().contains(name)) {
                let key = root.field(what).index(at).field("name");
                let other = others.what();
                let message = format!("is {:?}, as a {other} is called, and results need a name for each", names[at]);
                return fail(&key, format!("{message}; rename one of both"));
            }
        }
    }
    Ok(())
}

/// Keys that have no effect without `[flow]`.
fn refuse_alone(root: &Key, case: &Case) -> Check {
    let remedy = "add `[flow]` or remove it";
    let tables = [("head", case.heads.is_empty()), ("rain", case.rains.is_empty()), ("drain", case.drains.is_empty())];
    if let Some((table, _)) = tables.into_iter().find(|(_, is_empty)| !is_empty) {
        return fail(&root.field(table).index(0), format!("has no effect without [flow], which it is for; {remedy}"));
    }
    let keys = |law: &JointLaw| {
        [
            ("aperture", law.aperture),
            ("mechanical_aperture", law.mechanical_aperture),
            ("intact_strength", law.intact_strength),
        ]
    };
    let given = case.joint_laws.iter().flat_map(|(name, law)| keys(law).map(|(key, value)| (name, key, value)));
    match given.into_iter().find(|(.., value)| value.is_some()) {
        Some((name, field, _)) => {
            let key = root.field("joint_law").field(name).field(field);
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
            let law = &case.joint_laws[name];
            let key = match (law.aperture, law.mechanical()) {
                (Some(_), _) => root.field("joint_law").field(name).field("aperture"),
                (None, Some(_)) => root.field("joint_law").field(name),
                (None, None) => key.field("aperture"),
            };
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

/// Checks the heads, the rain and the drains that a stage brings.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_changes(key: &Key, place: usize, stage: &Stage, case: &Case) -> Check {
    let [heads, rain, drain] = ["heads", "rain", "drain"].map(|field| key.field(field));
    let [known_heads, known_rain, known_drains] = Names::of_flow(case);
    let of_heads = stage.heads.keys().map(|name| (&heads, name, &known_heads));
    let of_rain = stage.rain.keys().map(|name| (&rain, name, &known_rain));
    let of_drains = stage.drain.iter().map(|name| (&drain, name, &known_drains));
    for (key, name, names) in of_heads.chain(of_rain).chain(of_drains) {
        names.must_hold(key, name)?;
        let is_drain = std::ptr::eq(key, &raw const drain);
        let own = if is_drain { key.clone() } else { key.field(name) };
        if place == 0 && !is_drain {
            let message = "is in the first stage, which has the value of its own table; give it there, or in a later \
                           stage";
            return fail(&own, message);
        }
        if stage.kind == StageKind::Dynamic && stage.flow_steps().is_none() {
            let message = "is in a dynamic stage, which holds the water pressures of the stage before; give it in a \
                           static stage, or add `flow = \"steady\"` or `flow = \"transient\"`";
            return fail(&own, message);
        }
    }
    validate_course(key, place, stage, case)?;
    refuse_idle_drains(&drain, place, stage, case)
}

/// Checks how water in joints goes on in a stage.
fn validate_course(key: &Key, place: usize, stage: &Stage, case: &Case) -> Check {
    if let Some(every) = stage.flow_every.filter(|_| stage.flow_steps().is_none()) {
        let message = format!(
            "is {every}, and has no effect without `flow = \"steady\"` or `flow = \"transient\"`; add one of both, or \
             remove it"
        );
        return fail(&key.field("flow_every"), message);
    }
    let Some(flow) = stage.flow else { return Ok(()) };
    let key = key.field("flow");
    if case.flow.is_none() {
        return fail(&key, "has no effect without [flow], which it is for; add `[flow]` or remove it");
    }
    match flow {
        StageFlow::InMotion(word) if stage.kind == StageKind::Static => {
            let word = word.name();
            let message = format!(
                "is {word:?}, but only dynamic stages have it and this one is static, which finds the flow at its \
                 start; remove it"
            );
            fail(&key, message)
        }
        StageFlow::InMotion(_) => Ok(()),
        StageFlow::Over(_) if stage.kind == StageKind::Dynamic => fail(
            &key,
            "has a time, but only static stages have it and this one is dynamic; write \
             `flow = \"transient\"`, or remove it",
        ),
        StageFlow::Over(_) if place == 0 => fail(
            &key,
            "has a time, and is in the first stage, before which there is no flow that could go on; let a stage \
             without it come first, which finds the steady flow",
        ),
        StageFlow::Over(time) => time.check(&key),
    }
}

/// Refuses drains that act already.
fn refuse_idle_drains(key: &Key, place: usize, stage: &Stage, case: &Case) -> Check {
    for (k, name) in stage.drain.iter().enumerate() {
        let is_active = case.drains.iter().any(|drain| drain.name == *name && drain.active);
        let before = case.stages[..place].iter().any(|stage| stage.drain.contains(name));
        if is_active || before || stage.drain[..k].contains(name) {
            let message = format!(
                "drain {name:?} acts already; give it `active = false` in [[drain]], and name it in the first stage in \
                 which it acts"
            );
            return fail(key, message);
        }
    }
    Ok(())
}
