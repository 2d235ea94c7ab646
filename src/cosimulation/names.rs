//! Names of what a model has by number, and the state of monitors.

use crate::model::case::key::list;
use crate::model::{JointMonitorState, MonitorState, Stress};

use super::{Cosimulation, CosimulationError};

/// Kinds of things that have a number and a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Named {
    /// A joint trace, which events of slip and of broken bonds name.
    Joint,
    /// A joint law, in alphabetical order, as contacts name them.
    Law,
    /// A rock, in alphabetical order.
    Rock,
    /// A stage, in the order of the case.
    Stage,
    /// A block.
    Block,
    /// A monitor, in the order of the case.
    Monitor,
    /// A port, in the order of the case.
    Port,
    /// A head of water in joints, in the order of the case.
    Head,
    /// Rain on joints, in the order of the case.
    Rain,
    /// A drain, in the order of the case.
    Drain,
    /// A monitor of a joint, in the order of the case.
    JointMonitor,
}

impl Named {
    /// The word for several of them.
    pub(super) fn plural(self) -> &'static str {
        match self {
            Self::Joint => "joint traces",
            Self::Law => "joint laws",
            Self::Rock => "rocks",
            Self::Stage => "stages",
            Self::Block => "blocks",
            Self::Monitor => "monitors",
            Self::Port => "ports",
            Self::Head => "heads",
            Self::Rain => "rains",
            Self::Drain => "drains",
            Self::JointMonitor => "monitors of joints",
        }
    }
}

/// Names of a kind that the error of a wrong one tells.
const NAMES_TOLD: usize = 20;

impl Cosimulation {
    /// Number of things of a kind. It never changes.
    pub fn name_count(&self, kind: Named) -> usize {
        let (model, case) = (self.simulation.model(), self.case());
        match kind {
            Named::Joint => model.trace_law.len(),
            Named::Law => case.joint_laws.len(),
            Named::Rock => case.rocks.len(),
            Named::Stage => case.stages.len(),
            Named::Block => model.covers.block_count(),
            Named::Monitor => case.monitors.len(),
            Named::Port => model.ports.len(),
            Named::Head => case.heads.len(),
            Named::Rain => case.rains.len(),
            Named::Drain => case.drains.len(),
            Named::JointMonitor => case.joint_monitors.len(),
        }
    }

    /// Name of a thing by its number: that of the case, or a stand-in for what the case does not name. These are
    /// `joint[2]` for a joint, by its place in the case; for a trace of a joint set the name of the set, or
    /// `joint_set[1]`, and its number in the set, as in `bedding trace 4`; `rock bridge 7`; `trace 9` for any other
    /// joint trace, which a region of another law has parted or which surrounds an island; and `block 3`.
    ///
    /// # Errors
    /// There is nothing of that number.
    pub fn name(&self, kind: Named, index: usize) -> Result<String, CosimulationError> {
        self.check_named(kind, index)?;
        let case = self.case();
        let key = |name: Option<&String>| name.cloned().unwrap_or_default();
        Ok(match kind {
            Named::Joint => self.trace_name(index),
            Named::Law => key(case.joint_laws.keys().nth(index)),
            Named::Rock => key(case.rocks.keys().nth(index)),
            Named::Stage => case.stages[index].name.clone(),
            Named::Block => format!("block {index}"),
            Named::Monitor => case.monitors[index].name.clone(),
            Named::Port => self.ports()[index].name.clone(),
            Named::Head => case.heads[index].name.clone(),
            Named::Rain => case.rains[index].name.clone(),
            Named::Drain => case.drains[index].name.clone(),
            Named::JointMonitor => case.joint_monitors[index].name.clone(),
        })
    }

    /// Number of the thing of a kind that has a name, from 0: the first one of several.
    ///
    /// # Errors
    /// None has it.
    pub fn find_name(&self, kind: Named, name: &str) -> Result<usize, CosimulationError> {
        let has = |index: &usize| self.name(kind, *index).is_ok_and(|own| own == name);
        (0..self.name_count(kind)).find(has).ok_or_else(|| {
            let names = (0..self.name_count(kind)).filter_map(|index| self.name(kind, index).ok());
            let names: Vec<String> = names.take(NAMES_TOLD).collect();
            let limit = format!("that of one of the {}: {}", kind.plural(), list(names.iter().map(String::as_str)));
            CosimulationError::value("name", format!("{name:?}"), &limit, "name one of them")
        })
    }

    /// Displacement (m) and velocity (m/s) of a monitor of the case.
    ///
    /// # Errors
    /// There is no such monitor.
    pub fn monitor_state(&self, monitor: usize) -> Result<MonitorState, CosimulationError> {
        self.check_named(Named::Monitor, monitor)?;
        Ok(self.simulation.monitor(monitor))
    }

    /// Stress at a monitor of the case, NaN where the rock has been excavated.
    ///
    /// # Errors
    /// There is no such monitor, or it reads no stress.
    pub fn monitor_stress(&self, monitor: usize) -> Result<Stress, CosimulationError> {
        self.check_named(Named::Monitor, monitor)?;
        self.simulation.monitor_stress(monitor).ok_or_else(|| {
            let remedy = "set `stress = true` at it in the case";
            CosimulationError::value("monitor", monitor, "one that reads the stress", remedy)
        })
    }

    /// A monitor of a joint of the case, NaN where a side of the joint has been excavated.
    ///
    /// # Errors
    /// There is no such monitor.
    pub fn joint_monitor_state(&self, monitor: usize) -> Result<JointMonitorState, CosimulationError> {
        self.check_named(Named::JointMonitor, monitor)?;
        Ok(self.simulation.joint_monitors()[monitor])
    }

    pub(super) fn check_named(&self, kind: Named, index: usize) -> Result<(), CosimulationError> {
        let count = self.name_count(kind);
        if index < count {
            return Ok(());
        }
        let limit = format!("less than the number of {}, {count}", kind.plural());
        Err(CosimulationError::value("index", index, &limit, "ask for their number first"))
    }

    fn trace_name(&self, trace: usize) -> String {
        let built = self.simulation.built();
        if trace < self.case().joints.len() {
            return format!("joint[{trace}]");
        }
        if let Some(set) = built.set_start.windows(2).position(|range| (range[0]..range[1]).contains(&trace)) {
            return format!("{} trace {}", self.case().joint_set_name(set), trace - built.set_start[set]);
        }
        let is_bridge = built.bridges.iter().any(|bridge| bridge.trace == trace);
        if is_bridge { format!("rock bridge {trace}") } else { format!("trace {trace}") }
    }
}
