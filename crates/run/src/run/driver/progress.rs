//! How far a run is beyond its state, and its checkpoints.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::motion::PermanentMotion;
use crate::summary::StageRecord;
use enmm::geometry::Vector;
use enmm::model::bytes::BytesError;
use enmm::model::fit::{self, Unfit};
use enmm::model::{Ledger, Simulation, State};
use enmm_io::checkpoint;

use super::RunError;

/// Progress of a run beyond its state; part of its checkpoints, and so without a clock: equal runs leave equal bytes.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Progress {
    /// Stages that are over.
    pub(super) done: Vec<StageRecord>,
    /// Unsettled sub-steps before this stage.
    pub(super) unsettled_before: u64,
    /// Potential energy at the start of this stage (J/m).
    pub(super) potential_start: Option<f64>,
    /// Sweeps and sub-steps at the last row.
    pub(super) row_sweeps: [u64; 2],
    /// Largest penetration at reports of this stage (m).
    pub(super) penetration_max: f64,
    /// Unbalanced ratio at the last report.
    pub(super) unbalanced: f64,
    /// Ledger at the last report.
    pub(super) ledger: Ledger,
    /// Displacements of the covers at the start of this stage (m); empty where the state has them.
    pub(super) started: Vec<Vector>,
    /// Where the dynamic stages that are over have left the rock.
    pub(super) permanent: Vec<PermanentMotion>,
}

impl Progress {
    /// Whether it can be that of a state.
    ///
    /// # Errors
    /// The first number that cannot.
    fn check(&self, state: &State) -> Result<(), Unfit> {
        let Self { done, unsettled_before, potential_start, row_sweeps, .. } = self;
        let Self { penetration_max, unbalanced, ledger, started, permanent, .. } = self;
        let stages = u64::from(state.stage);
        fit::between("the number of records of stages", done.len() as f64, stages as f64, stages as f64 + 1.0)?;
        fit::at_most("unsettled_before", *unsettled_before, state.counters.unsettled)?;
        fit::at_most("the number of records of motions", permanent.len() as u64, done.len() as u64)?;
        fit::number("potential_start", potential_start.unwrap_or_default(), fit::FORCE)?;
        fit::at_most("row_sweeps[0]", row_sweeps[0], state.counters.sweeps)?;
        fit::at_most("row_sweeps[1]", row_sweeps[1], state.counters.substeps)?;
        fit::number("penetration_max", *penetration_max, fit::LENGTH)?;
        fit::between("unbalanced", *unbalanced, 0.0, f64::INFINITY)?;
        if !started.is_empty() {
            let covers = state.displacement.len() as f64;
            fit::between("the number of displacements in started", started.len() as f64, covers, covers)?;
        }
        started.iter().flatten().try_for_each(|part| fit::number("started", *part, fit::LENGTH))?;
        fit::check_ledger(ledger)
    }
}

/// A checkpoint of a run. The state comes first, so that it can be read alone.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Saved<S = State> {
    pub(super) state: S,
    pub(super) progress: Progress,
}

/// Loads a checkpoint of a run of this model.
///
/// # Errors
/// One that cannot be read, or is of another run.
pub(super) fn load(path: &Path, simulation: &Simulation, hash: &str) -> Result<Saved, RunError> {
    let refuse = |error| RunError::Checkpoint { path: path.to_owned(), error };
    let saved: Saved = checkpoint::load(path, hash).map_err(refuse)?;
    let fits = simulation.check(&saved.state).and_then(|()| saved.progress.check(&saved.state));
    fits.map_err(|unfit| refuse(BytesError::Damaged(unfit.to_string()).into()))?;
    Ok(saved)
}
