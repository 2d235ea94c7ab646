//! How a slope has failed in a stage, and where a dynamic stage has left it.

use serde::{Deserialize, Serialize};

use enmm::geometry::Vector;
use enmm::model::case::{Case, Monitor};
use enmm::model::{Farthest, Simulation, SlopeFailure};
use enmm_observe::Joints;

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
            block,
            place: place.into(),
            text: failure.to_string(),
        }
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
            block: farthest.map(|farthest| farthest.block),
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
        Some(k) => case.joint_set_name(k),
        None if trace < case.joints.len() => format!("joint[{trace}]"),
        None => "other joints".to_owned(),
    }
}

fn monitors(simulation: &Simulation, began: &[Vector]) -> Vec<MonitorMotion> {
    let places = &simulation.built().monitors.points;
    let of = |(k, monitor): (usize, &Monitor)| {
        let (element, point) = places[k];
        let sample = |field: &[Vector]| simulation.model().sample(element, point, field);
        let since = sample(&simulation.state().displacement) - sample(began);
        MonitorMotion { name: monitor.name.clone(), place: monitor.point, displacement: since.into() }
    };
    simulation.case().monitors.iter().enumerate().map(of).collect()
}
