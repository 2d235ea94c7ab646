//! Water that went through the joints, stage by stage: `flow.csv`, and records for summaries.

use std::io;
use std::path::Path;

use serde::Serialize;

use enmm::model::{FlowBalance, Simulation};
use enmm_io::files::{at_path, write_atomic};

/// Name of the file.
pub(crate) const FLOW: &str = "flow.csv";
/// Litres per minute in a m³/s.
const LITRES_PER_MINUTE: f64 = 6e4;
/// Head of `flow.csv`.
const COLUMNS: [&str; 9] = [
    "stage",
    "name",
    "in [m2/s]",
    "out [m2/s]",
    "run-off [m2/s]",
    "in [L/min per m]",
    "out [L/min per m]",
    "run-off [L/min per m]",
    "residual [m2/s]",
];

/// Water that enters and leaves at one place in a stage.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FlowRecord {
    /// Name of the stage.
    pub stage: String,
    /// Name of the head or rain; `reservoir`, or `air` of outcrops above it.
    pub name: String,
    /// Water that enters the joints (m²/s).
    pub enters: f64,
    /// Water that leaves them (m²/s).
    pub leaves: f64,
    /// Rain (m²/s) that does not enter and runs off.
    pub runs_off: f64,
    /// Greatest imbalance of a node of the net (m²/s), for a whole stage.
    pub residual: f64,
}

impl FlowRecord {
    /// All of a run so far; none where water does not flow.
    pub fn all(simulation: &Simulation) -> Vec<Self> {
        let (Some(net), Some(seepage)) = (&simulation.model().flow, &simulation.state().seepage) else {
            return Vec::new();
        };
        let of_stage = |balance: &FlowBalance| {
            let FlowBalance { stage, sums, residual, .. } = balance.clone();
            let stage = simulation.case().stages[stage as usize].name.clone();
            let places = net.inlet_names().zip(sums).map(move |(name, [enters, leaves, runs_off])| {
                let (stage, name) = (stage.clone(), name.to_owned());
                Self { stage, name, enters, leaves, runs_off, residual }
            });
            places.collect::<Vec<_>>()
        };
        seepage.balances.iter().flat_map(of_stage).collect()
    }
}

/// Writes the records as CSV, units in the header; digits read back to the same numbers.
///
/// # Errors
/// All that the file system refuses, with the path in the message.
pub(crate) fn write_flow(path: &Path, records: &[FlowRecord]) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    csv.write_record(COLUMNS).map_err(io::Error::from).map_err(at_path(path))?;
    for FlowRecord { stage, name, enters, leaves, runs_off, residual } in records {
        let flows = [*enters, *leaves, *runs_off];
        let numbers = flows.into_iter().chain(flows.map(|flow| flow * LITRES_PER_MINUTE)).chain([*residual]);
        let row = [stage.clone(), name.clone()].into_iter().chain(numbers.map(|number| format!("{number:?}")));
        csv.write_record(row).map_err(io::Error::from).map_err(at_path(path))?;
    }
    let bytes = csv.into_inner().map_err(csv::IntoInnerError::into_error).map_err(at_path(path))?;
    write_atomic(path, &bytes)
}
