//! Slips of the pen: values of joints, sets and water that can be computed with, but mostly have the wrong unit.

use crate::model::case::key::Key;
use crate::model::case::{Case, JointSet, Rock};

/// Least cohesion and tensile strength (Pa) that a joint with any has; what is less is mostly in kPa or MPa.
const STRENGTH_MIN: f64 = 1e3;
/// Least friction angle (degrees) of a joint with friction; what is less is mostly its tangent.
const FRICTION_MIN_DEG: f64 = 2.0;
/// Greatest dilation angle over the friction angle of rock: E. Hoek and E. T. Brown (1997) give a quarter for very good
/// rock masses, an eighth for average ones and none for poor ones.
const DILATION_SHARE: f64 = 1.0 / 3.0;
/// Least spacing of joints over the mesh size.
const SPACING_RATIO: f64 = 0.1;

/// Warnings about values that are mostly slips; `low` and `high` are the lowest and the highest y of the rock (m).
pub(super) fn of_values(case: &Case, low: f64, high: f64) -> Vec<String> {
    let mut warnings = strengths(case);
    warnings.extend(frictions(case));
    warnings.extend(dilations(case));
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

fn dilations(case: &Case) -> Vec<String> {
    let much = case.rocks.iter().filter_map(|(name, rock)| Some((name, much_dilation(rock)?)));
    much.map(|(name, by)| {
        format!(
            "rock.{name}: dilates by {by}; rock masses dilate by a quarter of their friction angle or less, and with \
             more a slope fails at a factor that is some per cent too high: leave `dilation_deg` out for 0"
        )
    })
    .collect()
}

/// By what angle a rock dilates that dilates by more than [`DILATION_SHARE`].
fn much_dilation(rock: &Rock) -> Option<String> {
    let friction = match &rock.hoek_brown {
        Some(mass) if mass.associated => return Some("its friction angle at each stress (associated)".to_owned()),
        Some(mass) => libm::atan(mass.envelope().unconfined().friction).to_degrees(),
        None => rock.friction_deg.unwrap_or_default(),
    };
    let dilation = rock.dilation_deg.filter(|dilation| *dilation > DILATION_SHARE * friction)?;
    let how = if dilation < friction { format!("φ {friction:.3}°") } else { "associated".to_owned() };
    Some(format!("{dilation}° ({how})"))
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
