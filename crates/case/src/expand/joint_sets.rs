//! Joint sets: dips and dip directions become angles in the section, persistence the gap.

use super::Expanded;
use crate::key::{Check, Key, fail};
use crate::orientation::trace_angle;
use crate::{Case, JointSet, Section, Side};

/// Share of the normal of joints that must lie in the section for them to have a trace in it.
const TRACE_SHARE: f64 = 0.05;

/// Expands all joint sets.
///
/// # Errors
/// The first set whose direction or persistence is not given, or given twice.
pub fn expand(case: &mut Case, told: &mut Expanded) -> Check {
    let section = case.section;
    if let Some(section) = section {
        section.check(&Key::root().field("section"))?;
    }
    for (k, set) in case.joint_sets.iter_mut().enumerate() {
        let key = Key::root().field("joint_set").index(k);
        set.check(&key)?;
        if set.angle_sd_deg.is_some() {
            told.origins.insert(format!("{key}.dip_sd_deg"), format!("{key}.angle_sd_deg"));
        }
        angle(&key, set, section)?;
        if let Some(sd) = set.angle_sd_deg.take() {
            if set.dip_sd_deg != 0.0 {
                let message = format!("is {sd}, and `dip_sd_deg`, its old name, is {}; keep one", set.dip_sd_deg);
                return fail(&key.field("angle_sd_deg"), message);
            }
            set.dip_sd_deg = sd;
        }
        persistence(&key, set)?;
    }
    Ok(())
}

/// Gives a set its angle.
fn angle(key: &Key, set: &mut JointSet, section: Option<Section>) -> Check {
    let Some(dip) = set.dip_deg else {
        if set.angle_deg.is_none() {
            let message = "has no direction; add `angle_deg`, counter-clockwise from the x axis, or `dip_deg` with \
                           `dips = \"left\"` or `dips = \"right\"`";
            return fail(key, message);
        }
        return needless(key, set);
    };
    if let Some(angle) = set.angle_deg {
        return fail(&key.field("dip_deg"), format!("is {dip}, and `angle_deg` is {angle}; keep one of them"));
    }
    match (set.dips, set.dip_direction_deg) {
        (None, None) => {
            let message = format!(
                "is {dip}, but its side is missing; add `dips = \"left\"` or `dips = \"right\"`, or write \
                 `angle_deg = {dip}` for an angle counter-clockwise from the x axis"
            );
            return fail(&key.field("dip_deg"), message);
        }
        (Some(_), Some(direction)) => {
            let message = format!("is {direction}, and `dips` names a side; keep one of them");
            return fail(&key.field("dip_direction_deg"), message);
        }
        (Some(side), None) => {
            set.angle_deg = Some(if side == Side::Left { dip } else { -dip });
        }
        (None, Some(direction)) => {
            let Some(section) = section else {
                let message = format!(
                    "is {direction}, but the case does not say where its section lies; add `[section]` with \
                     `azimuth_deg`, the azimuth of the x axis"
                );
                return fail(&key.field("dip_direction_deg"), message);
            };
            apparent(key, set, dip, direction - section.azimuth_deg)?;
        }
    }
    (set.dip_deg, set.dips, set.dip_direction_deg) = (None, None, None);
    Ok(())
}

/// A side or an azimuth without a dip.
fn needless(key: &Key, set: &JointSet) -> Check {
    let given = [("dips", set.dips.is_some()), ("dip_direction_deg", set.dip_direction_deg.is_some())];
    given.into_iter().find(|(_, there)| *there).map_or(Ok(()), |(name, _)| {
        fail(&key.field(name), "belongs to `dip_deg`, which is not given; rename `angle_deg`, or remove this")
    })
}

/// The trace in the section of joints that dip by `dip_deg` towards `off_deg` clockwise from the x axis, seen on a map.
/// The pole leaves the section by asin(sin(dip)·sin(off)).
fn apparent(key: &Key, set: &mut JointSet, dip_deg: f64, off_deg: f64) -> Check {
    let out = libm::sin(dip_deg.to_radians()) * libm::sin(off_deg.to_radians());
    let within = (1.0 - out * out).max(0.0).sqrt();
    if within < TRACE_SHARE {
        let message = format!(
            "the joints lie within {:.1}° of the section and have no usable trace in it; give the trace by \
             `angle_deg`, or choose another section",
            libm::asin(within).to_degrees()
        );
        return fail(key, message);
    }
    set.angle_deg = Some(trace_angle(dip_deg, off_deg));
    set.out_of_section_deg = libm::asin(out).to_degrees();
    set.spacing /= within;
    set.spacing_sd /= within;
    Ok(())
}

/// Persistence gives the gap or the trace length.
fn persistence(key: &Key, set: &mut JointSet) -> Check {
    let Some(share) = set.persistence else { return Ok(()) };
    match (set.trace_length, set.gap) {
        (Some(length), gap) if gap != 0.0 => {
            let is = length / (length + gap);
            let message = format!("is {share}, but `trace_length` and `gap` make it {is:.4}; keep two of the three");
            return fail(&key.field("persistence"), message);
        }
        (Some(length), _) => set.gap = length * (1.0 - share) / share,
        (None, gap) if gap > 0.0 && share < 1.0 => set.trace_length = Some(gap * share / (1.0 - share)),
        (None, gap) if gap > 0.0 => {
            return fail(&key.field("gap"), format!("is {gap} m, but `persistence` is 1; remove one of them"));
        }
        (None, _) if share < 1.0 => {
            let message = format!("is {share}, which needs a length; add `trace_length` or `gap`");
            return fail(&key.field("persistence"), message);
        }
        (None, _) => {}
    }
    set.persistence = None;
    Ok(())
}
