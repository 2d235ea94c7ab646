//! Slips of the pen: values of rock, sets and water that fit neither each other nor the mesh, nor the model.

use crate::model::case::key::Key;
use crate::model::case::{Case, JointSet, Rock};

/// Greatest dilation angle over the friction angle of rock: E. Hoek and E. T. Brown (1997) give a quarter for very good
/// rock masses, an eighth for average ones and none for poor ones.
const DILATION_SHARE: f64 = 1.0 / 3.0;
/// Least spacing of joints over the mesh size.
const SPACING_RATIO: f64 = 0.1;

/// Warnings about values that are mostly slips; `low` and `high` are the lowest and the highest y of the rock (m).
pub(super) fn of_values(case: &Case, low: f64, high: f64) -> Vec<String> {
    let mut warnings = dilations(case);
    warnings.extend(spacings(case));
    warnings.extend(water(case, low, high));
    warnings
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
