//! Checks of joint laws: what belongs to the kind, and what a stage may change of it.

use crate::key::{Check, Key, fail};
use crate::keys::{Range, Rule};
use crate::{Breaks, Case, Integrator, JointLaw, JointLawKind, LawChange};

/// Residual friction angles of Barton–Bandis joints (degrees): the law ends at 70°.
const RESIDUAL: Rule =
    JointLaw::rule("friction_deg").in_range(Range::from(0.0).to(70.0)).hint("the residual angle, 20 to 35 is usual");

/// Checks that a law has what its kind needs and nothing else.
///
/// # Errors
/// The first key that does not fit the kind, or whose value cannot be used.
pub fn validate_kind(key: &Key, law: &JointLaw) -> Check {
    match law.kind {
        JointLawKind::MohrCoulomb => {
            let given = [
                ("jrc", law.jrc),
                ("jcs", law.jcs),
                ("closure_max", law.closure_max),
                ("mechanical_aperture", law.mechanical_aperture),
                ("intact_strength", law.intact_strength),
            ];
            let foreign = given.into_iter().find(|(_, value)| value.is_some()).map(|(name, _)| name);
            foreign.map_or(Ok(()), |name| {
                let remedy = "remove it, or set `kind = \"barton_bandis\"`";
                fail(&key.field(name), format!("a law of kind mohr_coulomb does not have it; {remedy}"))
            })
        }
        JointLawKind::BartonBandis => validate_rough(key, law),
    }
}

fn validate_rough(key: &Key, law: &JointLaw) -> Check {
    let strengths = [
        ("cohesion", law.cohesion != 0.0),
        ("tension", law.tension != 0.0),
        ("residual_friction_deg", law.residual_friction_deg.is_some()),
        ("residual_cohesion", law.residual_cohesion.is_some()),
        ("residual_tension", law.residual_tension != 0.0),
        ("tension_energy", law.tension_energy.is_some()),
        ("shear_energy", law.shear_energy.is_some()),
        ("breaks", law.breaks.is_some()),
    ];
    if let Some((name, _)) = strengths.iter().find(|(_, given)| *given) {
        let message = "a law of kind barton_bandis has no such strength: `friction_deg`, `jrc` and `jcs` give it; \
        remove \
                       it, or set `kind = \"mohr_coulomb\"`";
        return fail(&key.field(name), message);
    }
    for (name, value) in [("jrc", law.jrc), ("jcs", law.jcs)] {
        if value.is_none() {
            return fail(key, format!("a law of kind barton_bandis needs `{name}`, which is not given; add `{name}`"));
        }
    }
    RESIDUAL.check(key, &law.friction_deg, None)?;
    if law.closure_max.is_some() && law.normal_stiffness.is_none() {
        let message = "needs `normal_stiffness`, the stiffness at no closure, which is not given; add it";
        return fail(&key.field("closure_max"), message);
    }
    if law.closure_max.is_some() && law.dilation_deg > 0.0 {
        let message = format!(
            "is {}°, but a joint with `closure_max` does not dilate, since slip could close it further than that; \
            remove \
             one of them",
            law.dilation_deg
        );
        return fail(&key.field("dilation_deg"), message);
    }
    validate_mechanical(key, law)
}

/// Checks that one key at most gives the aperture, and that the mechanical one is above 0.
fn validate_mechanical(key: &Key, law: &JointLaw) -> Check {
    let given = [
        ("aperture", law.aperture),
        ("mechanical_aperture", law.mechanical_aperture),
        ("intact_strength", law.intact_strength),
    ];
    let mut names = given.into_iter().filter(|(_, value)| value.is_some()).map(|(name, _)| name);
    if let (Some(first), Some(second)) = (names.next(), names.next()) {
        let message = format!("gives the aperture, and so does `{first}`; remove one of both");
        return fail(&key.field(second), message);
    }
    match law.mechanical() {
        Some(mechanical) if mechanical.is_nan() || mechanical <= 0.0 => {
            let strength = law.intact_strength.unwrap_or_default();
            let message = format!(
                "is {strength} Pa, and gives a mechanical aperture of {mechanical} m, which must be greater than 0: \
                 give more than half of `jcs`, with a `jrc` above 0, or `aperture`"
            );
            fail(&key.field("intact_strength"), message)
        }
        _ => Ok(()),
    }
}

/// Checks that energies of fracture have a strength to take.
///
/// # Errors
/// An energy that cannot be used, or whose strength the law lacks.
pub fn validate_energies(key: &Key, law: &JointLaw) -> Check {
    if let Some(energy) = law.tension_energy.filter(|_| law.tension == 0.0) {
        let message = format!("is {energy} J/m², but `tension` is 0 Pa, so that nothing softens; add `tension`");
        return fail(&key.field("tension_energy"), message);
    }
    if law.softens() && law.residual_tension > 0.0 {
        let message = format!(
            "is {} Pa, but a joint that breaks with an energy of fracture keeps no tensile strength; remove it",
            law.residual_tension
        );
        return fail(&key.field("residual_tension"), message);
    }
    let Some(energy) = law.shear_energy else { return Ok(()) };
    let (friction, cohesion) = (law.friction_deg, law.cohesion);
    let residual = [law.residual_friction_deg.unwrap_or(friction), law.residual_cohesion.unwrap_or(cohesion)];
    let names = [("residual_friction_deg", friction, "degrees"), ("residual_cohesion", cohesion, "Pa")];
    for ((name, peak, unit), residual) in names.into_iter().zip(residual) {
        if residual > peak {
            let message = format!(
                "is {residual} {unit}, more than the peak of {peak} {unit}: a joint with `shear_energy` \
                 softens; lower it"
            );
            return fail(&key.field(name), message);
        }
    }
    if residual == [friction, cohesion] {
        let message = format!(
            "is {energy} J/m², but the residual strength is the peak one, so that nothing softens; add \
             `residual_cohesion` or `residual_friction_deg`"
        );
        return fail(&key.field("shear_energy"), message);
    }
    Ok(())
}

/// Checks that what breaks by section has the strength of one.
///
/// # Errors
/// The law has no tensile strength, keeps it after failure, or belongs to no rock bridge.
pub fn validate_breaks(key: &Key, law: &JointLaw, is_of_bridge: bool) -> Check {
    let Some(breaks) = law.breaks else { return Ok(()) };
    let key = key.field("breaks");
    if !is_of_bridge {
        let message = "is for rock bridges, and none has this law; remove it, or give the law to a `[[bridge]]`, a \
                       `bridge_law` of a joint set or `domain.bridge_law`";
        return fail(&key, message);
    }
    if breaks == Breaks::BySection && law.tension == 0.0 {
        let message = "is \"by section\", but `tension` is 0 Pa, so that any bending breaks all of a bridge; add \
                       `tension`, or let it break \"by node\"";
        return fail(&key, message);
    }
    if breaks == Breaks::BySection && law.residual_tension > 0.0 {
        let message = format!(
            "is \"by section\", but the bridge keeps a tensile strength of {} Pa (`residual_tension`); remove one",
            law.residual_tension
        );
        return fail(&key, message);
    }
    Ok(())
}

/// Checks that the integrator knows what the law has.
///
/// # Errors
/// The implicit one is asked for a law with an energy of fracture.
pub fn validate_integrator(key: &Key, law: &JointLaw, integrator: Integrator) -> Check {
    if integrator == Integrator::Explicit {
        return Ok(());
    }
    if law.breaks == Some(Breaks::BySection) {
        let message = "the implicit integrator knows no sections; remove it, or set `solver.integrator = \"explicit\"`";
        return fail(&key.field("breaks"), message);
    }
    if !law.softens() {
        return Ok(());
    }
    let name = if law.tension_energy.is_some() { "tension_energy" } else { "shear_energy" };
    let message = "the implicit integrator knows no energy of fracture; remove it, or set \
                   `solver.integrator = \"explicit\"`";
    fail(&key.field(name), message)
}

/// Checks that a stage changes no law with an energy of fracture: what is damaged belongs to its strength.
///
/// # Errors
/// It does.
pub fn validate_soft_change(key: &Key, change: &LawChange) -> Check {
    let message = format!(
        "changes {:?}, whose strength falls with an energy of fracture; let the joint break, or remove this",
        change.law
    );
    fail(key, message)
}

/// Checks that a stage switches no law with an energy of fracture, which its bonds keep until they break.
///
/// # Errors
/// It does.
pub fn validate_soft_switch(key: &Key, case: &Case, from: &str) -> Check {
    if !case.joint_laws.get(from).is_some_and(JointLaw::softens) {
        return Ok(());
    }
    let message =
        format!("is {from:?}, whose strength falls with an energy of fracture; let the joint break, or remove this");
    fail(key, message)
}

/// Checks what a stage changes of a Barton–Bandis law: its residual angle only.
///
/// # Errors
/// Another value is given, or the angle cannot be used.
pub fn validate_rough_change(key: &Key, change: &LawChange) -> Check {
    for (name, value) in [("cohesion", change.cohesion), ("tension", change.tension)] {
        if let Some(value) = value {
            let message = format!(
                "is {value} Pa, but {:?} is a barton_bandis law, of which a stage may change `friction_deg` (its \
                 residual angle) only; remove it, or switch to another law with `switch_law`",
                change.law
            );
            return fail(&key.field(name), message);
        }
    }
    RESIDUAL.check(key, &change.friction_deg, None)
}
