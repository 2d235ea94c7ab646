//! Construction joints become joints with a law that does not break.

use super::Expanded;
use crate::key::{Check, Key, fail};
use crate::validate::checks::points;
use crate::{Case, JointLaw, JointTrace};

/// Name of the law of construction joints.
pub const LAW: &str = "cut";
/// Cohesion and tensile strength (Pa): beyond the strength of any rock, but no more than contact forces resolve.
const STRENGTH: f64 = 1e9;
/// Friction angle (degrees) of the faces, once they are free.
const FRICTION_DEG: f64 = 35.0;

/// Expands all cuts.
///
/// # Errors
/// The first cut that is no line.
pub fn expand(case: &mut Case, told: &mut Expanded) -> Check {
    for (k, cut) in std::mem::take(&mut case.cuts).into_iter().enumerate() {
        let key = Key::root().field("cut").index(k);
        cut.check(&key)?;
        points(&key.field("points"), &cut.points, 2, "a cut")?;
        if k == 0 {
            law_of_others(case)?;
            // The only law of a case is that of joints that name none, and stays so beside this one.
            case.domain.joint_law = case.default_joint_law().map(str::to_owned);
            case.joint_laws.entry(LAW.to_owned()).or_insert_with(law);
        }
        told.origins.insert(format!("joint[{}]", case.joints.len()), key.to_string());
        case.joints.push(JointTrace { points: cut.points, law: Some(LAW.to_owned()) });
    }
    Ok(())
}

/// Refuses joints that would take the law of the cuts because there is no other.
fn law_of_others(case: &Case) -> Check {
    let joint = case.joints.iter().position(|joint| joint.law.is_none()).map(|k| ("joint", k));
    let set = || case.joint_sets.iter().position(|set| set.law.is_none()).map(|k| ("joint_set", k));
    let Some((name, k)) = joint.or_else(set).filter(|_| case.joint_laws.is_empty()) else { return Ok(()) };
    let message = format!("{name}[{k}] needs a joint law, but there is none; add `[joint_law.NAME]`");
    fail(&Key::root().field("joint_law"), message)
}

fn law() -> JointLaw {
    let tough = JointLaw { cohesion: STRENGTH, tension: STRENGTH, ..JointLaw::frictional(FRICTION_DEG) };
    JointLaw { residual_cohesion: Some(0.0), ..tough }
}
