//! Checks of rock that breaks.

use crate::key::{Check, Key, fail};
use crate::keys::Plain;
use crate::{Case, Integrator, Rock, RockFracture};

/// Checks the strengths of rock that breaks, and that the case can follow its parts.
///
/// # Errors
/// The first value that cannot be used.
pub fn validate_fracture(root: &Key, case: &Case) -> Check {
    for (name, rock) in &case.rocks {
        if let Some(strength) = &rock.fracture {
            let key = root.field("rock").field(name).field("fracture");
            validate_strength(&key, rock, strength)?;
            validate_integrator(&key, case.solver.integrator)?;
        }
    }
    let Some(fracture) = &case.fracture else { return Ok(()) };
    let key = root.field("fracture");
    fracture.check(&key)?;
    if case.breaks() {
        return Ok(());
    }
    fail(&key, "has no effect: no rock breaks; add `[rock.NAME.fracture]` with the strength of the rock, or remove it")
}

fn validate_strength(key: &Key, rock: &Rock, strength: &RockFracture) -> Check {
    strength.check(key)?;
    if rock.yields() {
        return fail(
            key,
            "is for rock that is elastic until it breaks, and this rock yields (`friction_deg`, `cohesion` or \
             `hoek_brown`): remove one of both strengths",
        );
    }
    let RockFracture { tension, cohesion, friction_deg, residual_friction_deg, .. } = *strength;
    let tangent = libm::tan(friction_deg.to_radians());
    if tension * tangent > cohesion {
        let message = format!(
            "is {} Pa, must be at most cohesion/tan(friction_deg), {} Pa, where the shear strength ends; lower it or \
             raise the cohesion",
            Plain(tension),
            Plain(cohesion / tangent)
        );
        return fail(&key.field("tension"), message);
    }
    match residual_friction_deg.filter(|residual| *residual > friction_deg) {
        Some(residual) => {
            let message = format!(
                "is {} degrees, must be at most friction_deg, {} degrees: a crack is no stronger than the rock; lower \
                 it, or leave it out",
                Plain(residual),
                Plain(friction_deg)
            );
            fail(&key.field("residual_friction_deg"), message)
        }
        None => Ok(()),
    }
}

fn validate_integrator(key: &Key, integrator: Integrator) -> Check {
    match integrator {
        Integrator::Explicit => Ok(()),
        Integrator::Implicit => fail(
            key,
            "is for solver.integrator = \"explicit\", and the case has \"implicit\", which cannot go on with other \
             blocks; use the explicit one, or remove it",
        ),
    }
}
