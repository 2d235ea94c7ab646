//! Checks of the strength of rock: signs and ranges, and what makes no sense together.

use super::checks::{Check, Law, Range, fail, number, optional};
use crate::key::Key;
use crate::{HoekBrown, Plane, Rock};

/// Remedy for rock that is meant to be elastic.
const FREE: &str = "leave out friction_deg and cohesion for rock that never yields";

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
    match &rock.hoek_brown {
        Some(mass) => hoek_brown(key, rock, mass),
        None => mohr_coulomb(key, rock),
    }
}

fn mohr_coulomb(key: &Key, rock: &Rock) -> Check {
    optional(key, "friction_deg", rock.friction_deg, Law::ANGLE, "degrees", FREE)?;
    optional(key, "cohesion", rock.cohesion, Law::STRENGTH, "Pa", FREE)?;
    let (friction, cohesion) = (rock.friction_deg.unwrap_or(0.0), rock.cohesion.unwrap_or(0.0));
    if rock.yields() && friction == 0.0 && cohesion == 0.0 {
        return fail(key, format!("has friction_deg 0 and cohesion 0, one must be greater than 0; {FREE}"));
    }
    let hint = "more than friction_deg would make energy; leave it out for 0, which is usual";
    optional(key, "dilation_deg", rock.dilation_deg, Range::from(0.0).to(friction), "degrees", hint)?;
    let apex = if friction > 0.0 { cohesion / libm::tan(friction.to_radians()) } else { Law::STRENGTH_MAX };
    let hint = "the shear planes end at cohesion/tan(friction_deg); leave it out for that";
    optional(key, "tension", rock.tension, Range::from(0.0).to(apex), "Pa", hint)
}

fn hoek_brown(key: &Key, rock: &Rock, mass: &HoekBrown) -> Check {
    for (name, value) in [("friction_deg", rock.friction_deg), ("cohesion", rock.cohesion)] {
        if let Some(value) = value {
            let message = format!("is {value} beside hoek_brown, at most one of both strengths can hold; remove one");
            return fail(&key.field(name), message);
        }
    }
    if rock.plane == Plane::Stress {
        let message = "is \"stress\", but hoek_brown needs plane strain; use \"strain\", or friction_deg and cohesion";
        return fail(&key.field("plane"), message);
    }
    let own = key.field("hoek_brown");
    number(&own, "sigma_ci", mass.sigma_ci, Range::from(1e4).to(1e10), "Pa", "intact rock has 5e6 to 3e8")?;
    number(&own, "mi", mass.mi, Range::from(1.0).to(50.0), "", "intact rock has 4 to 35")?;
    number(&own, "gsi", mass.gsi, Range::from(1.0).to(100.0), "", "rock masses have 10 to 90")?;
    number(&own, "d", mass.d, Range::from(0.0).to(1.0), "", "0 for undisturbed rock, 1 for heavy blasting")?;
    if mass.associated && rock.dilation_deg.is_some() {
        let message = "has no effect beside hoek_brown.associated, which dilates by the friction angle; remove one";
        return fail(&key.field("dilation_deg"), message);
    }
    let hint = "0 is usual; hoek_brown.associated = true dilates by the friction angle at each stress";
    optional(key, "dilation_deg", rock.dilation_deg, Law::ANGLE, "degrees", hint)?;
    let hint = "the Hoek–Brown surface ends at s·sigma_ci/mb; leave it out for that";
    optional(key, "tension", rock.tension, Range::from(0.0).to(mass.envelope().tension()), "Pa", hint)
}
