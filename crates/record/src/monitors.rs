//! Monitors at the end of a run, for summaries.

use serde::Serialize;

use enmm::model::{JointMonitorState, Simulation, Stress};

use crate::lines::LineRecord;

/// Monitors at the end of a run, and lines.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Measured {
    /// Points of the case; not there of a case that neither reads stress nor names a stage to count from.
    #[serde(skip_serializing_if = "<[MonitorRecord]>::is_empty")]
    pub monitors: Vec<MonitorRecord>,
    /// Gauges across joints.
    #[serde(skip_serializing_if = "<[JointMonitorRecord]>::is_empty")]
    pub joint_monitors: Vec<JointMonitorRecord>,
    /// Lines at the ends of the stages.
    #[serde(skip_serializing_if = "<[LineRecord]>::is_empty")]
    pub lines: Vec<LineRecord>,
    /// Stage from whose end displacements count; not there when they count from the start.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub since: Option<String>,
}

impl Measured {
    /// That of a model with lines so far.
    pub(crate) fn of(simulation: &Simulation, lines: Vec<LineRecord>) -> Self {
        Self {
            monitors: MonitorRecord::all(simulation),
            joint_monitors: JointMonitorRecord::all(simulation),
            lines,
            since: simulation.case().output.since.clone(),
        }
    }
}

/// A point of the case at the end of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MonitorRecord {
    /// Name.
    pub name: String,
    /// Place in the reference configuration (m).
    pub place: [f64; 2],
    /// Displacement (m).
    pub displacement: [f64; 2],
    /// Stress xx, yy, xy (Pa, tension positive); not there of a point that reads none, nulls where rock is gone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stress: Option<Stress>,
}

/// A gauge across a joint at the end of a run; nulls where a side is gone.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointMonitorRecord {
    /// Name.
    pub name: String,
    /// Place on the joint in the reference configuration (m).
    pub place: [f64; 2],
    /// Opening (m).
    pub opening: f64,
    /// Slip (m), positive where the far side has moved to the right.
    pub slip: f64,
    /// Normal stress (Pa, tension positive).
    pub normal_stress: f64,
    /// Shear stress (Pa), as the slip.
    pub shear_stress: f64,
}

impl MonitorRecord {
    /// Those of a model; none of a case that neither reads stress at one nor says from when displacements count.
    pub fn all(simulation: &Simulation) -> Vec<Self> {
        let case = simulation.case();
        if case.output.since.is_none() && !case.monitors.iter().any(|monitor| monitor.stress) {
            return Vec::new();
        }
        let monitors = case.monitors.iter().enumerate();
        monitors
            .map(|(k, monitor)| Self {
                name: monitor.name.clone(),
                place: monitor.point,
                displacement: simulation.monitor(k).0.into(),
                stress: simulation.monitor_stress(k),
            })
            .collect()
    }
}

impl JointMonitorRecord {
    /// Those of a model.
    pub fn all(simulation: &Simulation) -> Vec<Self> {
        let (case, places) = (simulation.case(), &simulation.built().monitors.joints);
        let states = case.joint_monitors.iter().zip(places).zip(simulation.joint_monitors());
        states
            .map(|((monitor, place), state)| {
                let JointMonitorState { opening, slip, normal_stress, shear_stress } = *state;
                let (name, place) = (monitor.name.clone(), place.place.into());
                Self { name, place, opening, slip, normal_stress, shear_stress }
            })
            .collect()
    }
}
