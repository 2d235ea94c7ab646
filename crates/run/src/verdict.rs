//! What a run says of its slope in one line, and where a dynamic stage has left it.

use serde::{Deserialize, Serialize};

use enmm::geometry::Vector;
use enmm::model::case::Case;
use enmm::model::{Farthest, Simulation, SlopeFailure};
use enmm_io::numbers::three_digits;
use enmm_observe::Joints;

use crate::summary::{RunStatus, StageRecord};

/// Joints whose slip a record has: those that slipped farthest.
const JOINTS: usize = 20;

/// A failure of the slope in a stage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FailureOfStage {
    /// In a word: `sliding`, `toppling`, `falling` or `rotation`.
    pub mechanism: String,
    /// Blocks that have moved by more than a tenth of the largest displacement.
    pub blocks: usize,
    /// Mass of the rock that has (kg/m).
    pub mass: f64,
    /// Largest displacement since the stage began (m).
    pub displacement: f64,
    /// The block that went so far.
    pub block: u32,
    /// Its centroid when the stage began (m).
    pub place: [f64; 2],
    /// All of it in words, without the stage.
    pub text: String,
}

impl From<SlopeFailure> for FailureOfStage {
    fn from(failure: SlopeFailure) -> Self {
        let Farthest { displacement, block, place } = failure.farthest;
        Self {
            mechanism: failure.mechanism.noun().to_owned(),
            blocks: failure.blocks,
            mass: failure.mass,
            displacement,
            block: block.number(),
            place: place.into(),
            text: failure.to_string(),
        }
    }
}

/// Whether the slope has failed, in one line.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Whether it has failed in any stage.
    pub failed: bool,
    /// The line.
    pub text: String,
}

impl Verdict {
    /// The verdict on stages that have begun, of a run that ended in this way.
    pub fn of(stages: &[StageRecord], status: RunStatus) -> Self {
        let failed = |stage: &StageRecord| {
            let goes_on = if stage.ended_early { ", still moving when the stage was ended" } else { "" };
            Some(format!("in stage {} {}{goes_on}", stage.name, stage.failure.as_ref()?.text))
        };
        let failures: Vec<String> = stages.iter().filter_map(failed).collect();
        let text = if failures.is_empty() { unfailed(stages, status) } else { failing(&failures) };
        Self { failed: !failures.is_empty(), text }
    }
}

fn failing(failures: &[String]) -> String {
    format!("the slope failed {}", failures.join("; "))
}

fn unfailed(stages: &[StageRecord], status: RunStatus) -> String {
    let far = |stage: &StageRecord| {
        let displacement = three_digits(stage.displacement).unwrap_or_else(|small| format!("{small:.2e}"));
        format!("largest displacement {displacement} m")
    };
    let restless = stages.iter().find(|stage| stage.converged == Some(false));
    let farthest = stages.iter().max_by(|a, b| a.displacement.total_cmp(&b.displacement));
    match (status, restless, farthest) {
        (RunStatus::Interrupted, ..) => "no verdict yet: the run was interrupted".to_owned(),
        (RunStatus::Failed, ..) => "no verdict: the run failed numerically".to_owned(),
        (_, Some(stage), _) => format!("no verdict: stage {} did not come to rest, {}", stage.name, far(stage)),
        (_, None, Some(stage)) => format!("the slope has not failed: {} in stage {}", far(stage), stage.name),
        (_, None, None) => "no verdict: no stage has begun".to_owned(),
    }
}

/// Where a dynamic stage has left the rock since it began.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PermanentMotion {
    /// Name of the stage.
    pub stage: String,
    /// Largest displacement of a block (m), against the ground where quiet edges let that swing.
    pub displacement: f64,
    /// The block.
    pub block: Option<u32>,
    /// Its centroid when the stage began (m).
    pub place: Option<[f64; 2]>,
    /// Largest slip along each joint, the largest first.
    pub joints: Vec<JointSlip>,
    /// Monitors, in the order of the case.
    pub monitors: Vec<MonitorMotion>,
}

/// Slip of a joint, or of the joints of a set, in a stage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JointSlip {
    /// The joint, such as `joint[3]`, or the name of its set.
    pub joint: String,
    /// Largest slip since the stage began (m).
    pub slip: f64,
    /// Where (m).
    pub place: [f64; 2],
}

/// Displacement of a monitor in a stage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MonitorMotion {
    /// Name.
    pub name: String,
    /// Place in the reference configuration (m).
    pub place: [f64; 2],
    /// Displacement since the stage began (m).
    pub displacement: [f64; 2],
}

impl PermanentMotion {
    /// That of the stage in progress, at whose start the covers had other displacements (m).
    pub fn of(simulation: &Simulation, joints: &Joints, began: &[Vector]) -> Self {
        let farthest = simulation.farthest_since(began);
        Self {
            stage: simulation.stage().name.clone(),
            displacement: farthest.map_or(0.0, |farthest| farthest.displacement),
            block: farthest.map(|farthest| farthest.block.number()),
            place: farthest.map(|farthest| farthest.place.into()),
            joints: slips(simulation, joints, began),
            monitors: monitors(simulation, began),
        }
    }
}

fn slips(simulation: &Simulation, joints: &Joints, began: &[Vector]) -> Vec<JointSlip> {
    let mut found: Vec<JointSlip> = Vec::new();
    for slip in joints.slips_since(simulation, began) {
        let joint = joint_name(simulation, slip.trace);
        let own = JointSlip { joint, slip: slip.slip, place: slip.place.into() };
        match found.iter_mut().find(|other| other.joint == own.joint) {
            Some(other) if other.slip >= own.slip => {}
            Some(other) => *other = own,
            None => found.push(own),
        }
    }
    found.sort_by(|a, b| b.slip.total_cmp(&a.slip).then(a.joint.cmp(&b.joint)));
    found.truncate(JOINTS);
    found
}

/// The name of a joint by the number of its trace: that of its set, or `joint[3]`.
fn joint_name(simulation: &Simulation, trace: usize) -> String {
    let case: &Case = simulation.case();
    let sets = &simulation.built().set_start;
    match sets.windows(2).position(|range| (range[0]..range[1]).contains(&trace)) {
        Some(k) => {
            let named = case.joint_sets.get(k).and_then(|set| set.name.clone());
            named.unwrap_or_else(|| format!("joint_set[{k}]"))
        }
        None if trace < case.joints.len() => format!("joint[{trace}]"),
        None => "other joints".to_owned(),
    }
}

fn monitors(simulation: &Simulation, began: &[Vector]) -> Vec<MonitorMotion> {
    let places = &simulation.built().monitors;
    let of = |(k, monitor): (usize, &enmm::model::case::Monitor)| {
        let (element, point) = places[k];
        let since = simulation.monitor(k).0 - simulation.model().sample(element, point, began);
        MonitorMotion { name: monitor.name.clone(), place: monitor.point, displacement: since.into() }
    };
    simulation.case().monitors.iter().enumerate().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use enmm::model::case::StageKind;

    fn stage(name: &str, kind: StageKind, converged: Option<bool>, failure: Option<&str>) -> StageRecord {
        let failure = failure.map(|text| FailureOfStage {
            mechanism: "toppling".to_owned(),
            blocks: 56,
            mass: 1e6,
            displacement: 10.3,
            block: 17,
            place: [1.0, 2.0],
            text: text.to_owned(),
        });
        StageRecord {
            name: name.to_owned(),
            kind,
            start: 0.0,
            time: 1.0,
            steps: 10,
            converged,
            ended_early: false,
            displacement: 0.0321,
            failure,
            wall_seconds: None,
            unbalanced: 0.0,
            kinetic_energy: 0.0,
            potential_released: 0.0,
            unsettled: 0,
            penetration_max: 0.0,
        }
    }

    #[test]
    fn a_failure_is_named_with_its_stage_whatever_comes_later() {
        let stages = [
            stage("gravity", StageKind::Static, Some(false), Some("by toppling: 56 blocks")),
            stage("quake", StageKind::Dynamic, None, None),
        ];
        let verdict = Verdict::of(&stages, RunStatus::Finished);
        assert_eq!(verdict.text, "the slope failed in stage gravity by toppling: 56 blocks");
        assert!(verdict.failed);
    }

    #[test]
    fn a_slope_that_has_not_failed_is_said_to_stand_only_where_it_has_come_to_rest() {
        let at = |converged| [stage("gravity", StageKind::Static, Some(converged), None)];
        let text = |converged, status| Verdict::of(&at(converged), status).text;
        let finished = RunStatus::Finished;
        assert_eq!(text(true, finished), "the slope has not failed: largest displacement 0.0321 m in stage gravity");
        assert_eq!(
            text(false, finished),
            "no verdict: stage gravity did not come to rest, largest displacement 0.0321 m"
        );
        assert!(text(true, RunStatus::Interrupted).starts_with("no verdict yet"));
        assert!(text(true, RunStatus::Failed).starts_with("no verdict"));
    }
}
