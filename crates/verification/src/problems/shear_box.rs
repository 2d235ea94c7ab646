//! A body that is moved against joints in small steps: its supports move along, and measure the force.

use enmm::geometry::Vector;
use enmm::model::{Simulation, StepReport};

use crate::Trouble;

/// Moves all supports of a model that hold along `axis` (0 or 1).
pub struct Drive {
    /// Supports that are moved.
    rows: Vec<usize>,
    /// Greatest force (N/m), without sign, in the steps of the last advance.
    pub greatest: f64,
}

impl Drive {
    /// The supports of a model along an axis.
    pub fn along(simulation: &Simulation, axis: usize) -> Self {
        let supports = simulation.model().supports.iter().enumerate();
        let rows = supports.filter(|(_, s)| s.direction[axis].abs() > 0.5).map(|(k, _)| k).collect();
        Self { rows, greatest: 0.0 }
    }

    /// Carries the supports on by `distance` (m) at an even speed in so many steps.
    ///
    /// # Errors
    /// A numerical failure.
    pub fn advance(&mut self, simulation: &mut Simulation, distance: f64, steps: u64) -> Result<StepReport, Trouble> {
        let mut report = StepReport::default();
        self.greatest = 0.0;
        for step in 1..=steps {
            let mut state = simulation.state().clone();
            self.rows.iter().for_each(|&k| state.support_rest[k] += distance / steps as f64);
            simulation.restore(state);
            report = simulation.advance(step == steps)?;
            self.greatest = self.greatest.max(self.force(simulation).abs());
        }
        Ok(report)
    }

    /// Force (N/m) of the supports on the body.
    pub fn force(&self, simulation: &Simulation) -> f64 {
        self.rows.iter().map(|&k| simulation.state().support_force[k]).sum()
    }
}

/// Share of a way that has been gone at point `point` of `points`: the speed rises evenly over the first quarter and
/// then stays, so that no wave starts.
pub fn share(point: usize, points: usize) -> f64 {
    let (x, rise) = (point as f64 / points as f64, 0.25);
    let way = if x < rise { 0.5 * x * x / rise } else { x - 0.5 * rise };
    way / (1.0 - 0.5 * rise)
}

/// Force on a joint and its displacement, over all of its contacts.
#[derive(Debug, Clone, Copy, Default)]
pub struct JointState {
    /// Mean normal stress (Pa), pressing positive.
    pub normal: f64,
    /// Mean shear stress (Pa), without sign.
    pub shear: f64,
    /// Mean shear displacement (m), without sign.
    pub slip: f64,
    /// Mean closure (m).
    pub closure: f64,
}

/// The joints of a model as the last step left them.
pub fn joint_state(simulation: &Simulation) -> JointState {
    let (contacts, boundary) = (simulation.contacts(), &simulation.model().boundary);
    let length: f64 = contacts.iter().map(|c| c.length).sum();
    // A node on one body and one on the other look at each other: what they do along the edge has the same sign.
    let along = |f: f64| f / length;
    let displacement: &[Vector] = &simulation.state().displacement;
    JointState {
        normal: along(contacts.iter().map(|c| c.history.normal_force).sum()),
        shear: along(contacts.iter().map(|c| c.history.shear_force).sum::<f64>()).abs(),
        slip: along(contacts.iter().map(|c| c.relative(boundary, displacement)[1] * c.length).sum::<f64>()).abs(),
        closure: along(contacts.iter().map(|c| -c.gap * c.length).sum()),
    }
}
