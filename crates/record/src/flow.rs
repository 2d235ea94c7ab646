//! Water that went through the joints, stage by stage: `flow.csv`, and records for summaries.

use std::io;
use std::path::Path;

use serde::Serialize;

use enmm::model::{FlowBalance, Parted, Rounds, Simulation, StageWater};
use enmm_io::files::{at_path, write_atomic};

/// Name of the file.
pub(crate) const FLOW: &str = "flow.csv";
/// Litres per minute in a m³/s.
const LITRES_PER_MINUTE: f64 = 6e4;
/// Head of `flow.csv`.
const COLUMNS: [&str; 17] = [
    "stage",
    "name",
    "in [m2/s]",
    "out [m2/s]",
    "run-off [m2/s]",
    "in [L/min per m]",
    "out [L/min per m]",
    "run-off [L/min per m]",
    "residual [m2/s]",
    "time [s]",
    "entered [m2]",
    "left [m2]",
    "run off [m2]",
    "stored [m2]",
    "balance [m2]",
    "rounds",
    "asked for [ln e]",
];

/// Water that enters and leaves at one place in a stage: of a stage whose flow has a time, in its last step.
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
    /// Water of the time of the stage, if its flow has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub water: Option<WaterRecord>,
    /// Rounds of openings and flow of the stage, if its apertures follow openings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rounds: Option<RoundsRecord>,
}

/// Wet joints that have parted in a dynamic stage: their water pushes no more.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PartedRecord {
    /// Their length (m).
    pub length: f64,
    /// Their pieces.
    pub pieces: u32,
    /// Middle (m) of the piece with the greatest pressure; none where no joint has parted.
    pub place: Option<[f64; 2]>,
}

impl PartedRecord {
    /// Those of a model now; none where water does not flow.
    pub fn of(simulation: &Simulation) -> Option<Self> {
        simulation.model().flow.as_ref()?;
        let Parted { length, pieces, place } = simulation.parted();
        Some(Self { length, pieces, place: place.map(|place| [place.x, place.y]) })
    }
}

/// Rounds of openings and flow.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RoundsRecord {
    /// Flows found with apertures of openings.
    pub count: u32,
    /// Greatest change of ln e that openings ask for at the end.
    pub asked: f64,
    /// Whether openings and apertures agree.
    pub agree: bool,
}

/// Water that went through one place in the time of a stage, and what joints took.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct WaterRecord {
    /// Time of the flow in the stage (s).
    pub time: f64,
    /// Water that entered the joints there (m²).
    pub entered: f64,
    /// Water that left them there (m²).
    pub left: f64,
    /// Rain (m²) that did not enter and ran off.
    pub ran_off: f64,
    /// Water (m²) that all joints hold more at the end than at the start, for a whole stage.
    pub stored: f64,
    /// Water (m²) that entered and neither left nor is in the joints, for a whole stage: rounding.
    pub residual: f64,
}

impl FlowRecord {
    /// All of a run so far; none where water does not flow.
    pub fn all(simulation: &Simulation) -> Vec<Self> {
        let (Some(net), Some(seepage)) = (&simulation.model().flow, &simulation.state().seepage) else {
            return Vec::new();
        };
        let of_stage = |balance: &FlowBalance| {
            let FlowBalance { stage, sums, residual, water, rounds, .. } = balance;
            let rounds = rounds.map(|Rounds { count, asked, agree, .. }| RoundsRecord { count, asked, agree });
            let stage = &simulation.case().stages[*stage as usize].name;
            let places = net.inlet_names().zip(sums).enumerate();
            let of_place = |(k, (name, &[enters, leaves, runs_off])): (usize, (&str, &[f64; 3]))| {
                let water = water.as_ref().map(|water| WaterRecord::of(water, k));
                let (stage, name, residual) = (stage.clone(), name.to_owned(), *residual);
                Self { stage, name, enters, leaves, runs_off, residual, water, rounds }
            };
            places.map(of_place).collect::<Vec<_>>()
        };
        seepage.balances.iter().flat_map(of_stage).collect()
    }
}

impl WaterRecord {
    /// Of an inlet by its place.
    fn of(water: &StageWater, place: usize) -> Self {
        let [entered, left, ran_off] = water.sums[place];
        Self { time: water.time, entered, left, ran_off, stored: water.stored, residual: water.residual() }
    }
}

/// Writes the records as CSV, units in the header; digits read back to the same numbers.
///
/// # Errors
/// All that the file system refuses, with the path in the message.
pub(crate) fn write_flow(path: &Path, records: &[FlowRecord]) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    csv.write_record(COLUMNS).map_err(io::Error::from).map_err(at_path(path))?;
    for FlowRecord { stage, name, enters, leaves, runs_off, residual, water, rounds } in records {
        let flows = [*enters, *leaves, *runs_off];
        let numbers = flows.into_iter().chain(flows.map(|flow| flow * LITRES_PER_MINUTE)).chain([*residual]);
        let of_time = match water {
            Some(WaterRecord { time, entered, left, ran_off, stored, residual }) => {
                [time, entered, left, ran_off, stored, residual].map(|number| format!("{number:?}"))
            }
            None => Default::default(),
        };
        let row = [stage.clone(), name.clone()].into_iter().chain(numbers.map(|number| format!("{number:?}")));
        let of_rounds = rounds.map_or(Default::default(), |of| [of.count.to_string(), format!("{:?}", of.asked)]);
        let row = row.chain(of_time).chain(of_rounds);
        csv.write_record(row).map_err(io::Error::from).map_err(at_path(path))?;
    }
    let bytes = csv.into_inner().map_err(csv::IntoInnerError::into_error).map_err(at_path(path))?;
    write_atomic(path, &bytes)
}
