//! Checks of the strength of rock: signs and ranges, and what makes no sense together.

use crate::key::{Check, Key, fail};
use crate::keys::Plain;
use crate::keys::{Range, Rule};
use crate::rock::FREE;
use crate::{HoekBrown, Plane, PlaneOfWeakness, Rock};

const DILATION: Rule = Rock::rule("dilation_deg");
const TENSION: Rule = Rock::rule("tension");

/// Checks the strength of a rock.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_strength(key: &Key, rock: &Rock) -> Check {
    for (name, value) in [("dilation_deg", rock.dilation_deg), ("tension", rock.tension)] {
        if value.is_some() && !rock.yields() {
            let message = "has no effect on rock that never yields; add friction_deg, cohesion or hoek_brown, or \
                           remove it";
            return fail(&key.field(name), message);
        }
    }
    if let Some(plane) = &rock.plane_of_weakness {
        plane_of_weakness(&key.field("plane_of_weakness"), rock, plane)?;
    }
    match &rock.hoek_brown {
        Some(mass) => hoek_brown(key, rock, mass),
        None => mohr_coulomb(key, rock),
    }
}

fn mohr_coulomb(key: &Key, rock: &Rock) -> Check {
    let (friction, cohesion) = (rock.friction_deg.unwrap_or(0.0), rock.cohesion.unwrap_or(0.0));
    if rock.yields() && friction == 0.0 && cohesion == 0.0 {
        return fail(key, format!("has friction_deg 0 and cohesion 0, one must be greater than 0; {FREE}"));
    }
    let hint = "more than friction_deg would make energy; leave it out for 0, which is usual";
    DILATION.in_range(Range::from(0.0).to(friction)).hint(hint).check(key, &rock.dilation_deg, None)?;
    if friction == 0.0 {
        return Ok(());
    }
    let hint = "the shear planes end at cohesion/tan(friction_deg); leave it out for that";
    let apex = Range::from(0.0).to(cohesion / libm::tan(friction.to_radians()));
    TENSION.in_range(apex).hint(hint).check(key, &rock.tension, None)
}

fn plane_of_weakness(key: &Key, rock: &Rock, plane: &PlaneOfWeakness) -> Check {
    if !rock.yields() {
        let message = "has no effect on rock that never yields; add friction_deg, cohesion or hoek_brown for the rock \
                       between the planes, or use joints";
        return fail(key, message);
    }
    plane.check(key)?;
    let (friction, cohesion) = (plane.friction_deg, plane.cohesion);
    if friction == 0.0 && cohesion == 0.0 {
        return fail(key, "has friction_deg 0 and cohesion 0, one must be greater than 0; give the planes a strength");
    }
    let hint = "more than friction_deg would make energy; leave it out for 0, which is usual";
    let dilation = PlaneOfWeakness::rule("dilation_deg").in_range(Range::from(0.0).to(friction)).hint(hint);
    dilation.check(key, &plane.dilation_deg, None)?;
    if friction == 0.0 {
        return Ok(());
    }
    let hint = "the strength of the planes ends at cohesion/tan(friction_deg); leave it out for that";
    let apex = Range::from(0.0).to(cohesion / libm::tan(friction.to_radians()));
    PlaneOfWeakness::rule("tension").in_range(apex).hint(hint).check(key, &plane.tension, None)
}

fn hoek_brown(key: &Key, rock: &Rock, mass: &HoekBrown) -> Check {
    for (name, value) in [("friction_deg", rock.friction_deg), ("cohesion", rock.cohesion)] {
        if let Some(value) = value {
            let message =
                format!("is {} beside hoek_brown, at most one of both strengths can hold; remove one", Plain(value));
            return fail(&key.field(name), message);
        }
    }
    if rock.plane == Plane::Stress {
        let message = "is \"stress\", but hoek_brown needs plane strain; use \"strain\", or friction_deg and cohesion";
        return fail(&key.field("plane"), message);
    }
    mass.check(&key.field("hoek_brown"))?;
    if mass.associated && rock.dilation_deg.is_some() {
        let message = "has no effect beside hoek_brown.associated, which dilates by the friction angle; remove one";
        return fail(&key.field("dilation_deg"), message);
    }
    let hint = "the Hoek–Brown surface ends at s·sigma_ci/mb; leave it out for that";
    let most = Range::from(0.0).to(mass.envelope().tension());
    TENSION.in_range(most).hint(hint).check(key, &rock.tension, None)
}
