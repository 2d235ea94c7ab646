//! `summary.json`: what a run was, did and cost. A value that is not finite is written as null.

use std::io;
use std::path::Path;

use serde::ser::SerializeMap;
use serde::{Deserialize, Serialize, Serializer};

use enmm::engine_version;
use enmm::model::case::{StageKind, Support};
use enmm::model::tables::Seconds;
use enmm::model::{EventKind, Ledger, Simulation, State, StepError};
use enmm_io::files::{at_path, write_atomic};
use enmm_observe::{BoltCondition, BoltLine, ENERGIES, bolts};

use crate::breaks::{BreakRecord, SectionRecord};
use crate::changes::{CrumbRecord, TraceEndRecord};
use crate::earthquake::EarthquakeRecord;
use crate::flow::{FlowRecord, PartedRecord};
use crate::lines::LineRecord;
use crate::monitors::Measured;
use crate::motion::{FailureOfStage, PermanentMotion};

/// How a stage ended in which the slope has failed.
pub const FAILED: &str = "FAILED";
/// How a dynamic stage ended in which the slope has not failed.
pub const OVER: &str = "over";

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RunStatus {
    /// All stages are over.
    Finished,
    /// The caller stopped it; a checkpoint was written.
    Interrupted,
    /// A numerical failure; the checkpoint holds the last good state.
    Failed,
}

/// Setting, results and cost of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Title of the case.
    pub title: String,
    /// Version of the engine.
    pub version: String,
    /// Case file as the user named it.
    pub case_file: String,
    /// Hash of the case.
    pub case_hash: String,
    /// Values that took the place of those of the case file, as `key=value`.
    #[serde(skip_serializing_if = "<[String]>::is_empty")]
    pub settings: Vec<String>,
    /// How the run ended.
    pub status: RunStatus,
    /// Whether the slope has failed in a stage.
    pub failed: bool,
    /// Whether the slope has failed, and how, in one line.
    pub verdict: String,
    /// Numerical failure, if any.
    pub failure: Option<FailureRecord>,
    /// Communication steps of a coupled run; not there for one without a host.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coupled: Option<CoupledRecord>,
    /// Size of the model.
    pub model: ModelCounts,
    /// Stages that have begun.
    pub stages: Vec<StageRecord>,
    /// Where each dynamic stage has left the rock.
    #[serde(skip_serializing_if = "<[PermanentMotion]>::is_empty")]
    pub permanent: Vec<PermanentMotion>,
    /// Monitors at the end, and lines.
    #[serde(flatten)]
    pub measured: Measured,
    /// Measures of ground motions and of the monitors that they shake.
    #[serde(skip_serializing_if = "<[EarthquakeRecord]>::is_empty")]
    pub earthquakes: Vec<EarthquakeRecord>,
    /// Simulated time (s).
    pub time: f64,
    /// Internal steps.
    pub steps: u64,
    /// Steps in time.
    pub dt: StepSizes,
    /// The open–close iteration over the whole run.
    pub open_close: OpenCloseRecord,
    /// Energy ledger at the last report (J/m).
    #[serde(serialize_with = "energies")]
    pub energy: Ledger,
    /// Elements that have yielded.
    pub yielded_elements: usize,
    /// Bolts at the end, in the order of the case.
    pub bolts: Vec<BoltRecord>,
    /// Largest penetration of all steps (m).
    pub penetration_max: f64,
    /// The same over the mesh size.
    pub penetration_max_relative: f64,
    /// Greatest depth (m) of overlaps of blocks, see [`enmm::model::overlap`]; 0 for none.
    pub overlap_max: f64,
    /// Pairs of blocks that have overlapped.
    pub overlapping_pairs: usize,
    /// Bonded length (m) that has broken, of rock bridges and joints with an energy of fracture.
    pub broken_length: f64,
    /// Joints whose last bond has broken, as numbers of traces, in the order of time.
    pub broken_joints: Vec<u32>,
    /// Blocks that have broken, in the order of time.
    #[serde(skip_serializing_if = "<[BreakRecord]>::is_empty")]
    pub breaks: Vec<BreakRecord>,
    /// The blocks nearest to breaking, the worst first; empty of rock that does not break.
    #[serde(skip_serializing_if = "<[SectionRecord]>::is_empty")]
    pub worst_sections: Vec<SectionRecord>,
    /// Water that went through the joints in each stage.
    #[serde(skip_serializing_if = "<[FlowRecord]>::is_empty")]
    pub flow: Vec<FlowRecord>,
    /// Wet joints that have parted, of a case in which water flows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow_parted: Option<PartedRecord>,
    /// Wall time (s) of the process that writes this.
    pub wall_seconds: WallSeconds,
    /// Threads that the run could use.
    pub threads: usize,
    /// Ends of joints near the outline or another joint.
    pub trace_ends: Vec<TraceEndRecord>,
    /// Blocks below the least area.
    pub crumbs: Vec<CrumbRecord>,
    /// What the build has changed in the drawing.
    pub notes: Vec<String>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
    /// Input of the case.
    pub input: serde_json::Value,
    /// Why the results of a run that has ended are worthless; it is among the warnings too.
    #[serde(skip)]
    pub doubt: Option<String>,
}

/// Where, when and why a run failed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FailureRecord {
    /// Block.
    pub block: u32,
    /// Place (m).
    pub place: [f64; 2],
    /// Simulated time (s).
    pub time: f64,
    /// Cause.
    pub cause: String,
}

impl From<&StepError> for FailureRecord {
    fn from(error: &StepError) -> Self {
        let place = [error.position.x, error.position.y];
        Self { block: error.block, place, time: error.time, cause: error.failure.to_string() }
    }
}

/// How a host drove a coupled run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct CoupledRecord {
    /// Communication steps that were recorded, those that were taken back included.
    pub communication_steps: u64,
    /// Times that the model went back to an earlier state.
    pub returns: u64,
}

/// Size of a model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelCounts {
    /// Blocks.
    pub blocks: usize,
    /// Manifold elements.
    pub elements: usize,
    /// Physical covers.
    pub physical_covers: usize,
    /// Stars.
    pub stars: usize,
    /// Nodes of the boundary that may meet edges.
    pub contact_nodes: usize,
    /// Pieces of the block boundaries.
    pub boundary_edges: usize,
    /// Contacts of the last step.
    pub contacts: usize,
    /// Joint traces.
    pub joints: usize,
    /// Springs that hold.
    pub supports: usize,
    /// Area of the rock (m²).
    pub area: f64,
    /// Mesh size (m).
    pub mesh_size: f64,
}

impl ModelCounts {
    /// Counts a model.
    pub fn of(simulation: &Simulation) -> Self {
        let model = simulation.model();
        let covers = &model.covers;
        Self {
            blocks: covers.block_count(),
            elements: covers.element_count(),
            physical_covers: covers.cover_count(),
            stars: covers.covers_by_star().len(),
            contact_nodes: model.boundary.node_count(),
            boundary_edges: simulation.built().boundary_pieces,
            contacts: simulation.state().contacts.len(),
            joints: model.trace_law.len(),
            supports: model.supports.len(),
            area: covers.element_area.iter().sum(),
            mesh_size: covers.mesh.size,
        }
    }
}

/// One stage as it went.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StageRecord {
    /// Name.
    pub name: String,
    /// Static or dynamic.
    pub kind: StageKind,
    /// Time at its start (s).
    pub start: f64,
    /// Simulated time in it (s).
    pub time: f64,
    /// Internal steps.
    pub steps: u64,
    /// Whether a static stage came to rest; null for a dynamic one.
    pub converged: Option<bool>,
    /// Whether a static stage ended before its time, because the slope had run away.
    pub ended_early: bool,
    /// Largest displacement of a block since the start of the stage (m), chips left out.
    pub displacement: f64,
    /// Failure of the slope in it; null where it has not failed.
    pub failure: Option<FailureOfStage>,
    /// Wall time (s) in the process that writes this; null for a stage that ended before it went on from a checkpoint.
    pub wall_seconds: Option<f64>,
    /// Unbalanced ratio at its end.
    pub unbalanced: f64,
    /// Kinetic energy at its end (J/m).
    pub kinetic_energy: f64,
    /// Potential energy that it released (J/m).
    pub potential_released: f64,
    /// Sub-steps whose open–close iteration ended unsettled.
    pub unsettled: u64,
    /// Largest penetration at the reports of the stage (m).
    pub penetration_max: f64,
}

impl StageRecord {
    /// A stage of the past of a state that no run has recorded: its times alone are known.
    pub(crate) fn unseen(simulation: &Simulation, state: &State, stage: usize) -> Self {
        let (of_case, starts) = (&simulation.case().stages[stage], &state.stage_starts);
        let start = starts.get(stage).copied().unwrap_or_default();
        let time = starts.get(stage + 1).map_or(0.0, |end| end - start);
        Self {
            name: of_case.name.clone(),
            kind: of_case.kind,
            start,
            time,
            steps: (time / simulation.model().dt).round() as u64,
            converged: None,
            ended_early: false,
            displacement: f64::NAN,
            failure: None,
            wall_seconds: None,
            unbalanced: f64::NAN,
            kinetic_energy: f64::NAN,
            potential_released: f64::NAN,
            unsettled: 0,
            penetration_max: f64::NAN,
        }
    }

    /// How it ended, in words.
    pub fn outcome(&self) -> String {
        match (&self.failure, self.converged) {
            (Some(failure), _) if self.ended_early => format!("{FAILED} by {}, ended early", failure.mechanism),
            (Some(failure), _) => format!("{FAILED} by {}", failure.mechanism),
            (None, Some(true)) => "at rest".to_owned(),
            (None, Some(false)) => "NOT at rest".to_owned(),
            (None, None) => OVER.to_owned(),
        }
    }
}

/// A free length of a bolt at the end of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BoltRecord {
    /// Name; null for a bolt without one.
    pub name: Option<String>,
    /// Index of the bolt in the case.
    pub bolt: u32,
    /// Middle of the free length in the reference configuration (m).
    pub place: [f64; 2],
    /// Tension of one bar (N).
    pub force: f64,
    /// Force that it has in a search for the factor of safety; null where the rock stretches it.
    pub support: Option<Support>,
    /// Tension over the force at which the bar yields; null for a bar that never does.
    pub utilisation: Option<f64>,
    /// Lasting elongation of the bar (m).
    pub plastic_elongation: f64,
    /// Largest slip of the bar along the rock at both ends of the free length (m); none for a bar without a bond.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slip: Option<f64>,
    /// Its condition.
    pub state: BoltCondition,
}

impl BoltRecord {
    /// Those of a model.
    pub fn of(simulation: &Simulation) -> Vec<Self> {
        let record = |line: &BoltLine| {
            let case = &simulation.case().bolts[line.bolt as usize];
            let middle = (line.reference[0] + line.reference[1]) * 0.5;
            Self {
                name: case.name.clone(),
                bolt: line.bolt,
                place: [middle.x, middle.y],
                force: line.force * case.spacing,
                support: case.support,
                utilisation: case.yield_force.map(|yields| line.force * case.spacing / yields),
                plastic_elongation: line.plastic_elongation,
                slip: case.bond.map(|_| line.slip[0].abs().max(line.slip[1].abs())),
                state: line.condition,
            }
        };
        bolts(simulation).iter().map(record).collect()
    }
}

/// Internal steps (s).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StepSizes {
    /// Shortest that was taken.
    pub min: f64,
    /// Longest that was taken.
    pub max: f64,
    /// Internal step of the model.
    pub internal: f64,
    /// Stability limit.
    pub critical: f64,
}

impl StepSizes {
    /// Those of a model.
    fn of(simulation: &Simulation) -> Self {
        let (model, counters) = (simulation.model(), &simulation.state().counters);
        Self { min: counters.dt_min, max: counters.dt_max, internal: model.dt, critical: model.critical_dt }
    }
}

/// The open–close iteration over a whole run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OpenCloseRecord {
    /// Mean sweeps of a sub-step.
    pub mean: f64,
    /// Most sweeps of a sub-step.
    pub max: u32,
    /// Sub-steps that ended unsettled.
    pub unsettled: u64,
    /// Sub-steps taken.
    pub substeps: u64,
    /// Steps that were redone in halves.
    pub halved: u64,
    /// Contacts first seen deep.
    pub deep_contacts: u64,
    /// Deepest of them (m).
    pub deepest_contact: f64,
    /// Times that a contact began to crush the rock (`crush` of its law).
    pub crushed: u64,
    /// Energy (J/m) that crushed rock took, part of `contact_dissipation`.
    pub crushing: f64,
    /// Contacts judged, over all sweeps.
    pub judged: u64,
    /// Searches for near edges.
    pub searches: u64,
}

/// Writes all energies of the table (J/m), and the residual over the largest term.
/// Joints whose last bond has broken, in the order of time.
fn broken(state: &State) -> Vec<u32> {
    let events = state.events.list.iter();
    events.filter(|event| event.kind == EventKind::Broken).map(|event| event.subject).collect()
}

fn energies<S: Serializer>(ledger: &Ledger, out: S) -> Result<S::Ok, S::Error> {
    let mut map = out.serialize_map(Some(ENERGIES.len() + 1))?;
    for energy in &ENERGIES {
        map.serialize_entry(energy.name, &(energy.get)(ledger))?;
    }
    map.serialize_entry("residual_relative", &ledger.residual_relative())?;
    map.end()
}

/// Wall time (s) by part of the step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct WallSeconds {
    /// The whole run, outputs included.
    pub total: f64,
    /// Elements and kick.
    pub elements: f64,
    /// Search for near edges.
    pub search: f64,
    /// Vertex rule and contact geometry.
    pub entrance: f64,
    /// Open–close iteration.
    pub sweep: f64,
    /// Velocities, positions, ledger.
    pub commit: f64,
}

impl WallSeconds {
    /// Those of the parts of the step, and a total.
    pub fn of(parts: &Seconds, total: f64) -> Self {
        let &Seconds { elements, search, entrance, sweep, commit } = parts;
        Self { total, elements, search, entrance, sweep, commit }
    }
}

/// Record that only the driver of a run has.
pub(crate) struct RunRecord<'a> {
    pub case_file: &'a str,
    pub case_hash: &'a str,
    pub settings: &'a [String],
    pub status: RunStatus,
    pub failure: Option<&'a StepError>,
    pub coupled: Option<CoupledRecord>,
    pub stages: Vec<StageRecord>,
    pub permanent: Vec<PermanentMotion>,
    pub lines: Vec<LineRecord>,
    /// Measures of ground motions.
    pub earthquakes: Vec<EarthquakeRecord>,
    pub failed: bool,
    pub verdict: String,
    pub ledger: &'a Ledger,
    pub wall: WallSeconds,
    pub warnings: Vec<String>,
    pub input: serde_json::Value,
    pub doubt: Option<String>,
}

impl Summary {
    pub(crate) fn new(simulation: &Simulation, record: RunRecord) -> Self {
        let (model, state, counters) = (simulation.model(), simulation.state(), &simulation.state().counters);
        Self {
            title: simulation.case().title.clone(),
            version: engine_version().to_owned(),
            case_file: record.case_file.to_owned(),
            case_hash: record.case_hash.to_owned(),
            settings: record.settings.to_vec(),
            status: record.status,
            failed: record.failed,
            verdict: record.verdict,
            failure: record.failure.map(FailureRecord::from),
            coupled: record.coupled,
            model: ModelCounts::of(simulation),
            stages: record.stages,
            permanent: record.permanent,
            measured: Measured::of(simulation, record.lines),
            earthquakes: record.earthquakes,
            time: simulation.time(),
            steps: state.step,
            dt: StepSizes::of(simulation),
            open_close: OpenCloseRecord {
                mean: counters.sweeps as f64 / counters.substeps.max(1) as f64,
                max: counters.sweeps_max,
                unsettled: counters.unsettled,
                substeps: counters.substeps,
                halved: counters.halved,
                deep_contacts: counters.deep_contacts,
                deepest_contact: counters.deepest_contact,
                crushed: counters.crushing.times,
                crushing: counters.crushing.energy,
                judged: counters.contacts_solved,
                searches: counters.searches,
            },
            energy: *record.ledger,
            yielded_elements: simulation.yielded_elements(),
            bolts: BoltRecord::of(simulation),
            penetration_max: counters.penetration_max,
            penetration_max_relative: counters.penetration_max / model.covers.mesh.size,
            overlap_max: state.events.overlap_max,
            overlapping_pairs: state.events.overlapped.len(),
            broken_length: state.counters.broken,
            broken_joints: broken(state),
            breaks: BreakRecord::all(simulation),
            worst_sections: SectionRecord::worst(simulation),
            flow: FlowRecord::all(simulation),
            flow_parted: PartedRecord::of(simulation),
            wall_seconds: record.wall,
            threads: rayon::current_num_threads(),
            trace_ends: TraceEndRecord::all(simulation.built()),
            crumbs: CrumbRecord::all(simulation.built()),
            notes: simulation.built().notes.clone(),
            warnings: record.warnings,
            input: record.input,
            doubt: record.doubt,
        }
    }

    /// Whether the slope has failed in a static stage, so that there is no slope at rest.
    pub fn failed_at_rest(&self) -> bool {
        self.stages.iter().any(|stage| stage.kind == StageKind::Static && stage.failure.is_some())
    }

    /// Writes the summary as JSON, whole or not at all.
    ///
    /// # Errors
    /// Whatever the file system refuses, with the path in the message.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        let mut text = serde_json::to_vec_pretty(self).map_err(io::Error::from).map_err(at_path(path))?;
        text.push(b'\n');
        write_atomic(path, &text)
    }
}
