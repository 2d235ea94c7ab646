//! Checks of stages: what fits the kind, and references to laws and fixities.

use super::checks::{Names, each, points, region, unique};
use super::{flow, joints, ports};
use crate::key::{Check, Key, fail};
use crate::keys::{Range, Rule};
use crate::{Case, Integrator, JointLaw, LawChange, LawSwitch, Stage, StageCut, StageKind};

const RAMP: Rule = Stage::rule("ramp");

/// Checks the stages of a case.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_stages(key: &Key, case: &Case) -> Check {
    if case.stages.is_empty() {
        let remedy = "add [[stage]] with `name`, `kind` and `duration`";
        return fail(key, format!("the case has no stage, at least 1 is needed; {remedy}"));
    }
    let laws = Names::of_laws(case);
    let fixes = Names::of_fixes(case);
    for (i, stage) in case.stages.iter().enumerate() {
        let key = key.index(i);
        validate_motion(&key, stage)?;
        stage.excavate_region.as_ref().map_or(Ok(()), |ring| region(&key.field("excavate_region"), ring))?;
        each(&key.field("cut"), &stage.cuts, |key, cut| validate_cut(key, cut, case, &laws))?;
        validate_laws(&key, stage, case, &laws)?;
        validate_fixities(&key, stage, &fixes)?;
        validate_water(&key.field("water"), i, stage, case)?;
        flow::validate_heads(&key.field("heads"), i, stage, case)?;
    }
    unique(key, "stage", case.stages.iter().map(|stage| Some(stage.name.as_str())))
}

fn validate_motion(key: &Key, stage: &Stage) -> Check {
    if stage.duration == 0.0 {
        let other = if stage.kind == StageKind::Static { " or `duration_max = 5.0`" } else { "" };
        let message = format!(
            "is missing or 0 s, must be greater than 0 and at most 1e9; add `duration = 5.0`{other}, the simulated \
             time of the stage"
        );
        return fail(&key.field("duration"), message);
    }
    stage.check(key)?;
    let (kind, other, refused) = match stage.kind {
        StageKind::Static => ("static", "dynamic", [("damping", stage.damping), ("", None)]),
        StageKind::Dynamic => ("dynamic", "static", [("convergence", stage.convergence), ("ramp", stage.ramp)]),
    };
    for (name, value) in refused {
        if let Some(value) = value {
            let message = format!("is {value}, but only {other} stages have it and this one is {kind}; remove it");
            return fail(&key.field(name), message);
        }
    }
    RAMP.in_range(Range::from(0.0).to(stage.duration)).check(key, &stage.ramp, None)
}

fn validate_water(key: &Key, place: usize, stage: &Stage, case: &Case) -> Check {
    let Some(surface) = &stage.water else { return Ok(()) };
    if place == 0 {
        return fail(
            key,
            "is in the first stage, which has the surface of [water]; give it there, or in a later stage",
        );
    }
    if case.water.is_none() {
        return fail(key, "needs [water], which says what the water reaches; add it with the surface at the start");
    }
    ports::validate_surface(key, surface)
}

fn validate_cut(key: &Key, cut: &StageCut, case: &Case, laws: &Names) -> Check {
    cut.check(key)?;
    points(&key.field("points"), &cut.points, 2, "a cut")?;
    laws.must_hold(&key.field("law"), &cut.law)?;
    // The explicit integrator alone can go on with other covers in the middle of a run.
    match case.solver.integrator {
        Integrator::Explicit => Ok(()),
        Integrator::Implicit => fail(
            key,
            "is for solver.integrator = \"explicit\", and the case has \"implicit\"; use the explicit one, or draw the \
             joint from the start",
        ),
    }
}

fn validate_laws(key: &Key, stage: &Stage, case: &Case, laws: &Names) -> Check {
    for (i, change) in stage.law_changes.iter().enumerate() {
        let key = key.field("law").index(i);
        validate_change(&key, change, laws)?;
        if case.joint_laws.get(&change.law).is_some_and(JointLaw::is_curved) {
            joints::validate_rough_change(&key, change)?;
        }
        if case.joint_laws.get(&change.law).is_some_and(JointLaw::softens) {
            joints::validate_soft_change(&key, change)?;
        }
    }
    for (i, LawSwitch { from, to }) in stage.law_switches.iter().enumerate() {
        let key = key.field("switch_law").index(i);
        laws.must_hold(&key.field("from"), from)?;
        laws.must_hold(&key.field("to"), to)?;
        joints::validate_soft_switch(&key.field("from"), case, from)?;
        if from == to {
            return fail(&key.field("to"), format!("is {to:?}, the law to replace; name another law or remove it"));
        }
    }
    Ok(())
}

fn validate_change(key: &Key, change: &LawChange, laws: &Names) -> Check {
    laws.must_hold(&key.field("law"), &change.law)?;
    if change.friction_deg.is_none() && change.cohesion.is_none() && change.tension.is_none() {
        return fail(key, "changes nothing; give `friction_deg`, `cohesion` or `tension`, or remove it");
    }
    change.check(key)
}

fn validate_fixities(key: &Key, stage: &Stage, fixes: &Names) -> Check {
    for (list, names) in [("fix", &stage.fix), ("free", &stage.free)] {
        for (i, name) in names.iter().enumerate() {
            fixes.must_hold(&key.field(list).index(i), name)?;
        }
    }
    match stage.free.iter().position(|name| stage.fix.contains(name)) {
        Some(i) => fail(
            &key.field("free").index(i),
            format!(
                "{:?} is also in `fix` of this stage, it can be in one only; remove it from the other",
                stage.free[i]
            ),
        ),
        None => Ok(()),
    }
}
