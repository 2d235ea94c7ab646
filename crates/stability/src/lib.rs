//! Factors of safety of slopes: by strength reduction, which lets the model move, and by limit analysis.
#![forbid(unsafe_code)]

pub mod corners;
pub mod kinematics;
pub mod limit_analysis;
pub mod strength_reduction;

use enmm::model::case::{Case, StageKind, Support};

/// Stiffness of a bar whose force is given, over that of steel: a metre of slip changes the force by a few per cent.
const SOFT: f64 = 1e-4;

/// Strain at rupture of a bar whose force is given: it stretches with the rock.
const NEVER: f64 = 1e6;

/// The case with each bolt that is an active or a passive support at its pretension or its yield force, which hardly
/// change as the rock moves.
pub fn with_support_forces(case: &Case) -> Case {
    let mut case = case.clone();
    for bolt in &mut case.bolts {
        bolt.pretension = match bolt.support {
            None => continue,
            Some(Support::Active) => bolt.pretension,
            Some(Support::Passive) => bolt.yield_force.unwrap_or(bolt.pretension),
        };
        bolt.young *= SOFT;
        bolt.rupture_strain = bolt.rupture_strain.or(Some(NEVER));
    }
    case
}

/// The case without the stages after one of its static stages; all of it where no stage is named.
///
/// # Errors
/// The name, and those that there are.
pub fn up_to_stage(case: &Case, stage: Option<&str>) -> Result<Case, String> {
    let mut case = case.clone();
    let Some(name) = stage else { return Ok(case) };
    let statics = case.stages.iter().take_while(|stage| stage.kind == StageKind::Static);
    let names: Vec<&str> = statics.map(|stage| stage.name.as_str()).collect();
    let place = names.iter().position(|other| *other == name).ok_or_else(|| {
        format!(
            "--stage: there is no static stage {name:?} before the first dynamic one; there are: {}",
            names.join(", ")
        )
    })?;
    case.keep_stages(place + 1);
    Ok(case)
}

/// The stages of a case that neither method looks at, as a warning; none if there are none, or if the case begins with
/// one of them and is refused.
pub fn left_out_stages(case: &Case) -> Option<String> {
    case.stages.first().filter(|stage| stage.kind == StageKind::Static)?;
    let moving = case.stages.iter().skip_while(|stage| stage.kind == StageKind::Static);
    let names: Vec<&str> = moving.map(|stage| stage.name.as_str()).collect();
    (!names.is_empty()).then(|| format!("stages from the first dynamic one on are left out: {}", names.join(", ")))
}
