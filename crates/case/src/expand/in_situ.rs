//! In-situ stress by K0: the vertical stress is the weight of the rock above, the horizontal one K0 times it.

use crate::key::{Check, Key, fail};
use crate::{Case, InSitu};

/// Expands the in-situ stress of a case.
///
/// # Errors
/// Stress that is not given, given twice, or that does not follow from the weight.
pub fn expand(case: &mut Case) -> Check {
    let key = Key::root().field("in_situ");
    let Some(mut stress) = case.in_situ.take() else { return Ok(()) };
    stress.check(&key)?;
    match stress.k0 {
        Some(k0) => by_weight(&key, case, &mut stress, k0)?,
        None => check_plain(&key, &stress)?,
    }
    stress.y_reference.get_or_insert(0.0);
    case.in_situ = Some(stress);
    Ok(())
}

/// Stress by its components.
fn check_plain(key: &Key, stress: &InSitu) -> Check {
    if stress.density.is_some() {
        return fail(&key.field("density"), "belongs to `k0`, which is not given; add `k0` or remove it");
    }
    for (name, value) in [("sxx", stress.sxx), ("syy", stress.syy)] {
        if value.is_none() {
            let message =
                format!("is missing; add `{name} = -1e6` (Pa, tension positive), or give `k0` instead of both");
            return fail(&key.field(name), message);
        }
    }
    Ok(())
}

fn by_weight(key: &Key, case: &Case, stress: &mut InSitu, k0: f64) -> Check {
    let given = [
        ("sxx", stress.sxx.is_some()),
        ("syy", stress.syy.is_some()),
        ("sxy", stress.sxy != 0.0),
        ("gradient", stress.gradient != [0.0; 3]),
    ];
    if let Some((name, _)) = given.iter().find(|(_, there)| *there) {
        return fail(&key.field(name), "follows from `k0` and the weight of the rock; remove it, or remove `k0`");
    }
    let gravity = &case.gravity;
    gravity.check(&Key::root().field("gravity"))?;
    if gravity.x != 0.0 || gravity.y >= 0.0 {
        let message = format!(
            "needs gravity that acts straight down, but gravity is ({}, {}) m/s²; give `sxx` and `syy` instead",
            gravity.x, gravity.y
        );
        return fail(&key.field("k0"), message);
    }
    let Some(density) = stress.density.or_else(|| density(case)) else {
        let message = "is not given, and no rock lies everywhere else; add `density` (kg/m³) of the rock above";
        return fail(&key.field("density"), message);
    };
    let highest = case.domain.outline.iter().map(|point| point[1]).fold(f64::NEG_INFINITY, f64::max);
    if stress.y_reference.is_none() && !highest.is_finite() {
        return fail(&key.field("y_reference"), "is not given, and there is no outline; add the height of the surface");
    }
    let weight = density * -gravity.y;
    *stress = InSitu {
        sxx: Some(0.0),
        syy: Some(0.0),
        gradient: [k0 * weight, weight, 0.0],
        y_reference: stress.y_reference.or(Some(highest)),
        k0: None,
        density: None,
        ..stress.clone()
    };
    Ok(())
}

/// Density of the only rock, or of the one that fills what others leave.
fn density(case: &Case) -> Option<f64> {
    let background = case.rocks.values().find(|rock| rock.region.is_none() && rock.blocks.is_empty());
    let only = case.rocks.values().next().filter(|_| case.rocks.len() == 1);
    background.or(only).map(|rock| rock.density)
}
