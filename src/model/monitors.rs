//! Numbers of monitors and lines now.

use crate::geometry::Vector;
use crate::monitor::{self, JointMonitorState, LinePlace, LinePoint, Stress};

use super::Simulation;

impl Simulation {
    /// Displacement (m), from the end of the stage `output.since` on if the case names one, and velocity (m/s) of a
    /// monitor.
    pub fn monitor(&self, k: usize) -> (Vector, Vector) {
        let (element, point) = self.built.monitors.points[k];
        let (model, state) = (self.model(), self.state());
        (monitor::displacement(model, state, (element, point)), model.sample(element, point, &state.velocity))
    }

    /// Stress at a monitor now, NaN where the rock has been excavated; none at one that reads no stress.
    pub fn monitor_stress(&self, k: usize) -> Option<Stress> {
        let fit = self.built.monitors.stresses[k].as_ref()?;
        Some(fit.read(self.model(), self.state()))
    }

    /// Monitors of joints, in the order of the case, by the contacts that the next step will find with the forces of
    /// the last one; worked out at the first look after a step.
    pub fn joint_monitors(&self) -> &[JointMonitorState] {
        if self.built.monitors.joints.is_empty() {
            return &[];
        }
        self.looks.joints.get_or_init(|| {
            let monitors = &self.built.monitors;
            let contacts = self.contacts();
            let ground = (self.model(), &monitors.faces);
            monitors.joints.iter().map(|joint| joint.read(ground, self.state(), &contacts)).collect()
        })
    }

    /// The points of a line now.
    pub fn line(&self, k: usize) -> Vec<LinePoint> {
        let read = |place: &LinePlace| place.read(self.model(), self.state());
        self.built.monitors.lines[k].iter().map(read).collect()
    }
}
