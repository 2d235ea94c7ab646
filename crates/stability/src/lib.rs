//! Factors of safety of slopes: by strength reduction, which lets the model move, and by limit analysis.
#![forbid(unsafe_code)]

pub mod kinematics;
pub mod limit_analysis;
pub mod strength_reduction;

use enmm::model::case::{Case, StageKind};

/// The stages of a case that neither method looks at, as a warning; none if there are none, or if the case begins with
/// one of them and is refused.
pub fn left_out_stages(case: &Case) -> Option<String> {
    case.stages.first().filter(|stage| stage.kind == StageKind::Static)?;
    let moving = case.stages.iter().skip_while(|stage| stage.kind == StageKind::Static);
    let names: Vec<&str> = moving.map(|stage| stage.name.as_str()).collect();
    (!names.is_empty()).then(|| format!("stages from the first dynamic one on are left out: {}", names.join(", ")))
}
