//! How a slope has failed in a stage, and where a dynamic stage has left it.

use serde::{Deserialize, Serialize};

use enmm::geometry::Vector;
use enmm::model::case::{Case, Monitor};
use enmm::model::{Farthest, Simulation, SlopeFailure};
use enmm_observe::{Joints, SlipSince};

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
    /// Largest slip of the joints of each law that slipped, the largest first.
    pub laws: Vec<LawSlip>,
}

/// Slip of the joints of a law in a stage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LawSlip {
    /// The law that they have at its end.
    pub law: String,
    /// Largest slip since the stage began (m).
    pub slip: f64,
    /// Where (m).
    pub place: [f64; 2],
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
        let slips = joints.slips_since(simulation, began);
        Self {
            stage: simulation.stage().name.clone(),
            displacement: farthest.map_or(0.0, |farthest| farthest.displacement),
            block: farthest.map(|farthest| farthest.block),
            place: farthest.map(|farthest| farthest.place.into()),
            joints: of_joints(simulation, &slips),
            monitors: monitors(simulation, began),
            laws: of_laws(simulation, &slips),
        }
    }
}

fn of_joints(simulation: &Simulation, slips: &[SlipSince]) -> Vec<JointSlip> {
    let mut found = largest(slips, |slip| joint_name(simulation, slip.trace));
    found.truncate(JOINTS);
    let record = |(joint, slip): (String, SlipSince)| JointSlip { joint, slip: slip.slip, place: slip.place.into() };
    found.into_iter().map(record).collect()
}

fn of_laws(simulation: &Simulation, slips: &[SlipSince]) -> Vec<LawSlip> {
    let law = |slip: &SlipSince| simulation.case().joint_laws.keys().nth(slip.law as usize).cloned();
    let found = largest(slips, |slip| law(slip).unwrap_or_default());
    let record = |(law, slip): (String, SlipSince)| LawSlip { law, slip: slip.slip, place: slip.place.into() };
    found.into_iter().map(record).collect()
}

/// The largest slip of each name, the largest first.
fn largest(slips: &[SlipSince], name: impl Fn(&SlipSince) -> String) -> Vec<(String, SlipSince)> {
    let mut found: Vec<(String, SlipSince)> = Vec::new();
    for slip in slips {
        let own = name(slip);
        match found.iter_mut().find(|(other, _)| *other == own) {
            Some((_, other)) if other.slip >= slip.slip => {}
            Some((_, other)) => *other = *slip,
            None => found.push((own, *slip)),
        }
    }
    found.sort_by(|(a, of_a), (b, of_b)| of_b.slip.total_cmp(&of_a.slip).then(a.cmp(b)));
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
