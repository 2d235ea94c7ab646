//! How far a run is beyond its state, and its checkpoints.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::lines::LineRecord;
use crate::motion::PermanentMotion;
use crate::summary::StageRecord;
use enmm::geometry::Vector;
use enmm::model::bytes::{BytesError, Keeper, decode, decode_state};
use enmm::model::fit::{self, Unfit};
use enmm::model::{Ledger, Simulation, State};
use enmm_io::checkpoint::{self, CheckpointError};

/// Name of the checkpoint in a folder of results.
pub const CHECKPOINT: &str = "checkpoint.enmm";

/// Progress of a run beyond its state; part of its checkpoints, and so without a clock: equal runs leave equal bytes.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Progress {
    /// Stages that are over.
    pub done: Vec<StageRecord>,
    /// Numbers of the reports up to now.
    pub reports: Reports,
    /// Displacements of the covers at the start of this stage (m); empty where the state has them.
    pub started: Vec<Vector>,
    /// Where the dynamic stages that are over have left the rock.
    pub permanent: Vec<PermanentMotion>,
    /// Lines at the ends of the stages that are over.
    pub lines: Vec<LineRecord>,
}

/// Numbers of the reports up to an instant.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub struct Reports {
    /// Unsettled sub-steps before this stage.
    pub unsettled_before: u64,
    /// Potential energy at the start of this stage (J/m).
    pub potential_start: Option<f64>,
    /// Sweeps and sub-steps at the last row.
    pub row_sweeps: [u64; 2],
    /// Largest penetration at reports of this stage (m).
    pub penetration_max: f64,
    /// Unbalanced ratio at the last report.
    pub unbalanced: f64,
    /// Ledger at the last report.
    pub ledger: Ledger,
}

impl Progress {
    /// That of a run that begins at a state whose past nobody has recorded.
    fn from_here(simulation: &Simulation, state: &State) -> Self {
        let stages = 0..state.stage as usize;
        let counters = &state.counters;
        let reports = Reports {
            unsettled_before: counters.unsettled,
            row_sweeps: [counters.sweeps, counters.substeps],
            ledger: state.ledger,
            ..Reports::default()
        };
        let started = if state.stage_displacement.is_empty() { state.displacement.clone() } else { Vec::new() };
        let done = stages.map(|stage| StageRecord::unseen(simulation, state, stage)).collect();
        Self { done, reports, started, permanent: Vec::new(), lines: Vec::new() }
    }

    /// Whether it can be that of a state.
    ///
    /// # Errors
    /// The first number that cannot.
    fn check(&self, state: &State) -> Result<(), Unfit> {
        let Self { done, reports, started, permanent, lines } = self;
        let Reports { unsettled_before, potential_start, row_sweeps, penetration_max, unbalanced, ledger } = reports;
        let stages = u64::from(state.stage);
        fit::between("the number of records of stages", done.len() as f64, stages as f64, stages as f64 + 1.0)?;
        fit::at_most("unsettled_before", *unsettled_before, state.counters.unsettled)?;
        fit::at_most("the number of records of motions", permanent.len() as u64, done.len() as u64)?;
        if let Some(line) = lines.iter().max_by_key(|line| line.number) {
            fit::at_most("the number of the stage of a line", u64::from(line.number), stages + 1)?;
        }
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
pub struct Saved<S = State> {
    /// State of the model.
    pub state: S,
    /// How far the run is beyond it.
    pub progress: Progress,
}

/// Loads a saved state of this model, and returns whether a run saved it: one of a host brings no progress.
///
/// # Errors
/// One that cannot be read, or is of another case.
pub fn load_checkpoint(path: &Path, simulation: &Simulation, hash: &str) -> Result<(Saved, bool), CheckpointError> {
    let (keeper, bytes) = checkpoint::read(path, hash)?;
    if keeper != Keeper::Run {
        let state = decode_state(Keeper::Run, &bytes, hash)?;
        simulation.check(&state).map_err(|unfit| BytesError::Damaged(unfit.to_string()))?;
        return Ok((Saved { progress: Progress::from_here(simulation, &state), state }, false));
    }
    let saved: Saved = decode(keeper, &bytes, hash)?;
    let fits = simulation.check(&saved.state).and_then(|()| saved.progress.check(&saved.state));
    fits.map_err(|unfit| BytesError::Damaged(unfit.to_string()))?;
    Ok((saved, true))
}
