//! A host's look at a call in progress, by which it can stop the call.

use std::fmt::{Debug, Formatter};
use std::ops::ControlFlow;

use super::{Cosimulation, CosimulationError, initial_stages};

/// How far a call has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// Time reached (s): as [`Cosimulation::time`] counts or, in the initial equilibrium, since its start.
    pub time: f64,
    /// End of the communication step (s), or the most time that the initial equilibrium may take.
    pub end: f64,
    /// In the initial equilibrium the last net over applied force that is known, else none.
    pub unbalanced: Option<f64>,
    /// Whether the call seeks the initial equilibrium.
    pub is_equilibrium: bool,
}

/// Looks at a call between two internal steps, on the thread of the call; a break ends it.
pub type Watch = Box<dyn FnMut(&Pace) -> ControlFlow<()> + Send + Sync>;

/// The watch of a model; a copy of the model has none.
#[derive(Default)]
pub(super) struct Watcher(Option<Watch>);

impl Clone for Watcher {
    fn clone(&self) -> Self {
        Self(None)
    }
}

impl Debug for Watcher {
    fn fmt(&self, f: &mut Formatter) -> std::fmt::Result {
        f.write_str(if self.0.is_some() { "Watcher" } else { "no Watcher" })
    }
}

impl Cosimulation {
    /// Sets what looks at calls between internal steps and may end them, or takes it away. It sees numbers alone and
    /// changes none, so that results do not depend on it. A call that it ends is [`CosimulationError::Interrupted`].
    pub fn set_watch(&mut self, watch: Option<Watch>) {
        self.watcher = Watcher(watch);
    }

    /// Shows the watch that a communication step stands before another internal step.
    pub(super) fn watch_step(&mut self, end: f64) -> Result<(), CosimulationError> {
        let time = self.grid_time();
        self.watch(|| Pace { time, end, unbalanced: None, is_equilibrium: false })
    }

    /// Shows the watch that the initial equilibrium stands before another internal step.
    pub(super) fn watch_equilibrium(&mut self, unbalanced: Option<f64>) -> Result<(), CosimulationError> {
        let time = self.simulation.time();
        let stages = &self.case().stages[..initial_stages(self.case())];
        let end = stages.iter().map(|stage| stage.duration).sum();
        self.watch(|| Pace { time, end, unbalanced, is_equilibrium: true })
    }

    fn watch(&mut self, pace: impl FnOnce() -> Pace) -> Result<(), CosimulationError> {
        match self.watcher.0.as_mut().map(|watch| watch(&pace())) {
            Some(ControlFlow::Break(())) => Err(CosimulationError::Interrupted),
            Some(ControlFlow::Continue(())) | None => Ok(()),
        }
    }
}
