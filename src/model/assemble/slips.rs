//! Slips of the pen: values of joints, sets and water that can be computed with, but mostly have the wrong unit.

use crate::model::case::key::Key;
use crate::model::case::{Case, JointSet};

/// Least cohesion and tensile strength (Pa) that a joint with any has; what is less is mostly in kPa or MPa.
const STRENGTH_MIN: f64 = 1e3;
/// Least friction angle (degrees) of a joint with friction; what is less is mostly its tangent.
const FRICTION_MIN_DEG: f64 = 2.0;
/// Least spacing of joints over the mesh size.
const SPACING_RATIO: f64 = 0.1;

/// Warnings about values that are mostly slips; `low` and `high` are the lowest and the highest y of the rock (m).
pub(super) fn of_values(case: &Case, low: f64, high: f64) -> Vec<String> {
    let mut warnings = strengths(case);
    warnings.extend(frictions(case));
    warnings.extend(spacings(case));
    warnings.extend(water(case, low, high));
    warnings
}

fn strengths(case: &Case) -> Vec<String> {
    let of_laws = case.joint_laws.iter().flat_map(|(name, law)| {
        let key = Key::root().field("joint_law").field(name);
        [("cohesion", law.cohesion), ("tension", law.tension)].map(|(field, value)| (key.field(field), value))
    });
    let of_rocks = case.rocks.iter().map(|(name, rock)| {
        (Key::root().field("rock").field(name).field("cohesion"), rock.cohesion.unwrap_or_default())
    });
    let small = of_laws.chain(of_rocks).filter(|(_, value)| *value > 0.0 && *value < STRENGTH_MIN);
    small
        .map(|(key, value)| {
            format!(
                "{key}: is {value} Pa, joints and rock that have any have {STRENGTH_MIN:e} Pa or more; {value} kPa are \
                 {value}e3, {value} MPa {value}e6"
            )
        })
        .collect()
}

fn frictions(case: &Case) -> Vec<String> {
    let of_laws = case
        .joint_laws
        .iter()
        .map(|(name, law)| (Key::root().field("joint_law").field(name).field("friction_deg"), law.friction_deg));
    let of_rocks = case.rocks.iter().map(|(name, rock)| {
        (Key::root().field("rock").field(name).field("friction_deg"), rock.friction_deg.unwrap_or_default())
    });
    let small = of_laws.chain(of_rocks).filter(|(_, value)| *value > 0.0 && *value < FRICTION_MIN_DEG);
    small
        .map(|(key, value)| {
            format!(
                "{key}: is {value} degrees, joints and rock have 10 to 60; as a tangent, {value} is an angle of {:.1} \
                 degrees",
                libm::atan(value).to_degrees()
            )
        })
        .collect()
}

fn spacings(case: &Case) -> Vec<String> {
    let size = case.mesh.size;
    let is_dense = |(_, set): &(usize, &JointSet)| set.spacing < SPACING_RATIO * size;
    let dense = case.joint_sets.iter().enumerate().filter(is_dense);
    dense
        .map(|(k, set)| {
            format!(
                "joint_set[{k}].spacing: is {} m on a mesh of {size} m; spacings are usually above {} m, a tenth of \
                 the mesh size: raise it, or lower mesh.size",
                set.spacing,
                SPACING_RATIO * size
            )
        })
        .collect()
}

/// A surface of water above all rock, as of heights above the sea in a model that begins at 0.
fn water(case: &Case, low: f64, high: f64) -> Option<String> {
    let water = case.water.as_ref()?;
    let key = Key::root().field("water").field(if water.level.is_some() { "level" } else { "table" });
    let level = water.start_level();
    (level > high).then(|| {
        format!(
            "{key}: reaches y = {level} m, but the rock lies between {low:.6} and {high:.6} m: above its top the water \
             stands on the slope and holds it; give heights in the coordinates of the outline"
        )
    })
}
