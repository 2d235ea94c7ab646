//! Dips of planes of weakness become angles.

use crate::key::{Check, Key, fail};
use crate::keys::Plain;
use crate::{Case, PlaneOfWeakness, Side};

/// Gives the planes of weakness of all rocks their angle.
///
/// # Errors
/// A plane without a direction, or with more than one; a value out of its range.
pub fn expand(case: &mut Case) -> Check {
    let root = Key::root().field("rock");
    for (name, rock) in &mut case.rocks {
        if let Some(plane) = &mut rock.plane_of_weakness {
            angle(&root.field(name).field("plane_of_weakness"), plane)?;
        }
    }
    Ok(())
}

/// Whether a plane has its direction by other keys than its angle, or none.
pub fn is_short(plane: &PlaneOfWeakness) -> bool {
    plane.angle_deg.is_none() || plane.dip_deg.is_some() || plane.dips.is_some()
}

fn angle(key: &Key, plane: &mut PlaneOfWeakness) -> Check {
    plane.check(key)?;
    let angle = match (plane.angle_deg, plane.dip_deg, plane.dips) {
        (Some(angle), None, None) => angle,
        (None, Some(dip), Some(side)) => {
            if side == Side::Left {
                dip
            } else {
                -dip
            }
        }
        (Some(angle), Some(dip), _) => {
            let message = format!("is {}, and `angle_deg` is {}; keep one of them", Plain(dip), Plain(angle));
            return fail(&key.field("dip_deg"), message);
        }
        (None, Some(dip), None) => {
            let message = format!(
                "is {}, but its side is missing; add `dips = \"left\"` or `dips = \"right\"`, or write `angle_deg`",
                Plain(dip)
            );
            return fail(&key.field("dip_deg"), message);
        }
        (_, None, Some(_)) => {
            return fail(&key.field("dips"), "belongs to `dip_deg`, which is not given; add it, or remove this");
        }
        (None, None, None) => {
            let message = "has no direction; add `angle_deg`, counter-clockwise from the x axis, or `dip_deg` with \
                           `dips = \"left\"` or `dips = \"right\"`";
            return fail(key, message);
        }
    };
    (plane.angle_deg, plane.dip_deg, plane.dips) = (Some(angle), None, None);
    Ok(())
}
