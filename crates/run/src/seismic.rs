//! The yield acceleration of a case beside Newmark's block under its records and beside its run.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use enmm::model::case::{Axis, STANDARD_GRAVITY};
use enmm::model::{Case, Mechanism};
use enmm_io::LoadedCase;
use enmm_io::files::{at_path, write_atomic};
use enmm_picture::failure_picture;
use enmm_record::earthquake::{Place, Seismogram, records};
use enmm_stability::strength_reduction::seismic::{
    COEFFICIENT_RANGE, Direction, SeismicOptions, SeismicTrial, YieldAcceleration, yield_acceleration,
};
use enmm_stability::strength_reduction::{End, Progress, Reduction, ReductionError, Trial};

/// Name of the folder of a search within that of the run of its case.
const FOLDER: &str = "fos";
/// Table of the trials, and picture of the mechanism.
const TABLE: &str = "seismic.csv";
const PICTURE: &str = "seismic";
/// Largest summary of a run that is read (bytes).
const SUMMARY_MAX: u64 = 256 << 20;

/// The yield acceleration and what stands beside it.
#[derive(Debug)]
pub struct Seismic {
    /// The search; none where the slope does not stand without an earthquake.
    pub found: Option<YieldAcceleration>,
    /// Ways of Newmark's block, where a yield acceleration was found.
    pub blocks: Vec<NewmarkBlock>,
    /// Motion that a run of the same case has left.
    pub run: Option<RunMotion>,
    /// Remedy where something is missing.
    pub remedy: Option<String>,
}

/// A rigid block on ground that moves by a record of the case, and slides beyond the yield acceleration.
#[derive(Debug, Clone, PartialEq)]
pub struct NewmarkBlock {
    /// The record, such as `quiet[0]`.
    pub record: String,
    /// Whether it moves a base or is the motion of an outcrop.
    pub of: Place,
    /// Its peak acceleration (m/s²).
    pub pga: f64,
    /// Displacement (m) out of the slope.
    pub displacement: f64,
    /// The same for the record with its sign reversed.
    pub reversed: f64,
}

/// Motion that a run has left of its last stage with an earthquake.
#[derive(Debug, Clone, PartialEq)]
pub struct RunMotion {
    /// The summary of the run.
    pub summary: PathBuf,
    /// The stage.
    pub stage: String,
    /// Largest permanent displacement of a block (m).
    pub displacement: f64,
    /// Largest slip of a joint (m); none where none slipped.
    pub slip: Option<f64>,
}

/// A case whose yield acceleration is looked for.
#[derive(Debug)]
pub(crate) struct Setting<'a> {
    /// The case as it was loaded.
    pub loaded: &'a LoadedCase,
    /// The case up to the stage after which the slope is looked at.
    pub case: &'a Case,
    /// Where results go.
    pub directory: &'a Path,
}

/// Finds the yield acceleration of a case of whose factor of safety `main` is the search.
///
/// # Errors
/// As [`yield_acceleration`].
pub(crate) fn seismic(
    setting: &Setting,
    search: &SeismicOptions,
    main: &Reduction,
    hear: &mut (dyn FnMut(&SeismicTrial, Progress) + Send),
) -> Result<Seismic, ReductionError> {
    let run = run_of(setting.directory, &setting.loaded.hash);
    if let Some(remedy) = fails_at_rest(main) {
        return Ok(Seismic { found: None, blocks: Vec::new(), run, remedy: Some(remedy) });
    }
    let yields = yield_acceleration(setting.case, search, hear)?;
    let block = |record: &Seismogram, k: f64| newmark(record, yields.direction, k * yields.gravity);
    let moves = records(&setting.loaded.case).into_iter().filter(|record| record.axis == Axis::X);
    let blocks = yields.coefficient().map_or_else(Vec::new, |k| moves.map(|record| block(&record, k)).collect());
    let remedy = remedy(&yields, &blocks, run.as_ref());
    Ok(Seismic { found: Some(yields), blocks, run, remedy })
}

/// Why a slope has no yield acceleration: its factor is below 1.
fn fails_at_rest(reduction: &Reduction) -> Option<String> {
    let stands = reduction.low.is_some_and(|low| low >= 1.0);
    let fails = reduction.high.is_some_and(|high| high <= 1.0);
    match (stands, fails) {
        (true, _) => None,
        (false, true) => Some("the slope does not stand without an earthquake: strengthen it first".to_owned()),
        (false, false) if matches!(reduction.end, End::Interrupted | End::Failed(_)) => {
            Some("the search for the factor of safety did not end, so that none follows".to_owned())
        }
        // A bracket about 1: the coefficient is next to nothing, and its search says so.
        (false, false) => None,
    }
}

fn remedy(yields: &YieldAcceleration, blocks: &[NewmarkBlock], run: Option<&RunMotion>) -> Option<String> {
    let [least, most] = COEFFICIENT_RANGE;
    match &yields.end {
        End::Found if blocks.is_empty() => Some(
            "the case has no record along x for Newmark's block: give it a [[base_motion]] or a [[quiet]] with a wave"
                .to_owned(),
        ),
        End::Found if run.is_none() => Some(
            "no run of this case lies in this folder or the one above to stand beside Newmark's block: enmm run leaves \
             one in the folder above, unless -o names another"
                .to_owned(),
        ),
        End::Found => None,
        End::StableThroughout => Some(format!("the slope bears even {most} g along x: no joint lets it go")),
        End::UnstableThroughout => {
            Some(format!("the slope does not even bear {least} g: its factor of safety is about 1"))
        }
        End::Interrupted => Some("interrupted; the trials so far are kept".to_owned()),
        End::Failed(error) => Some(format!("a trial failed numerically, {error}: a finer mesh helps")),
    }
}

/// The way of a block by a record: rock is pushed out of the slope while the ground accelerates into it.
fn newmark(record: &Seismogram, direction: Direction, yields: f64) -> NewmarkBlock {
    let way = |sign: f64| record.acceleration.times(-sign * direction.sign()).sliding_block(yields);
    NewmarkBlock {
        record: record.name.clone(),
        of: record.of,
        pga: record.measures(STANDARD_GRAVITY).acceleration,
        displacement: way(1.0),
        reversed: way(-1.0),
    }
}

/// Motion that a run of the case has left in a folder, or in that above where the folder is that of a search within it.
/// A summary of another case or none that can be read is passed over: the answer says that there is none.
fn run_of(directory: &Path, hash: &str) -> Option<RunMotion> {
    let is_within = directory.file_name().is_some_and(|name| name == FOLDER);
    let above = directory.parent().filter(|_| is_within).map(Path::to_owned);
    [Some(directory.to_owned()), above].into_iter().flatten().find_map(|folder| motion_in(&folder, hash))
}

fn motion_in(folder: &Path, hash: &str) -> Option<RunMotion> {
    let summary = folder.join("summary.json");
    let is_small = fs::metadata(&summary).ok()?.len() <= SUMMARY_MAX;
    let record: Value = serde_json::from_slice(&fs::read(&summary).ok().filter(|_| is_small)?).ok()?;
    let shaken: Vec<&str> = list(&record["earthquakes"]).flat_map(|e| list(&e["stages"])).filter_map(text).collect();
    let mut motions = list(&record["permanent"]);
    let motion = motions.rfind(|motion| text(&motion["stage"]).is_some_and(|stage| shaken.contains(&stage)))?;
    (record["case_hash"] == hash).then_some(RunMotion {
        summary,
        stage: text(&motion["stage"])?.to_owned(),
        displacement: motion["displacement"].as_f64()?,
        slip: motion["joints"][0]["slip"].as_f64(),
    })
}

fn list(value: &Value) -> impl DoubleEndedIterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

fn text(value: &Value) -> Option<&str> {
    value.as_str()
}

impl Seismic {
    /// As JSON.
    pub(crate) fn record(&self) -> Value {
        let mut record = self.found.as_ref().map_or_else(|| json!({ "status": "fails_at_rest" }), search_record);
        record["newmark"] = self.blocks.iter().map(block_record).collect();
        record["run"] = json!(self.run.as_ref().map(|run| json!({
            "summary": run.summary,
            "stage": run.stage,
            "displacement": run.displacement,
            "slip": run.slip,
        })));
        record["remedy"] = json!(self.remedy);
        record
    }

    /// Writes the table of the trials, and draws the mechanism; removes those of an earlier search where none are.
    pub(crate) fn write(this: Option<&Self>, directory: &Path, title: &str, pictures: bool) -> io::Result<()> {
        let found = this.and_then(|seismic| seismic.found.as_ref());
        let failing = found.and_then(|found| found.failing.as_deref()).filter(|_| pictures);
        match found {
            Some(found) => write_table(&directory.join(TABLE), &found.trials)?,
            None => remove(&directory.join(TABLE))?,
        }
        match failing {
            Some(reduction) => {
                let least = found.and_then(|found| found.high).unwrap_or_default();
                failure_picture(&format!("{title}: under {least:.4} g along x"), reduction).write(directory, PICTURE)
            }
            None => ["png", "svg"].iter().try_for_each(|end| remove(&directory.join(format!("{PICTURE}.{end}")))),
        }
    }
}

fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(at_path(path)(error)),
        _ => Ok(()),
    }
}

fn search_record(found: &YieldAcceleration) -> Value {
    let failing = found.failing.as_deref();
    let trial = failing.and_then(Reduction::first_unstable);
    json!({
        "status": found.end.name(),
        "direction": found.direction.name(),
        "gravity": found.gravity,
        "yield_coefficient": found.coefficient(),
        "yield_acceleration": found.coefficient().map(|k| k * found.gravity),
        "at_least": found.at_least(),
        "bracket": { "stable": found.low, "unstable": found.high },
        "bound": found.bound.as_ref().ok(),
        "bound_refused": found.bound.as_ref().err(),
        "failing": failing.zip(trial).map(|(reduction, trial)| json!({
            "verdict": trial.verdict.name(),
            "mechanism": found.mechanism().map(Mechanism::verb),
            "blocks": trial.failing.len(),
            "area": trial.failing_area(),
            "mass": trial.failing_mass(),
            "share": trial.failing_area() / reduction.free_area,
        })),
        "trials": found.trials.iter().map(trial_record).collect::<Vec<_>>(),
    })
}

fn block_record(block: &NewmarkBlock) -> Value {
    json!({
        "record": block.record,
        "of": block.of,
        "pga": block.pga,
        "pga_g": block.pga / STANDARD_GRAVITY,
        "displacement": block.displacement,
        "displacement_reversed": block.reversed,
    })
}

/// One trial as an object.
pub fn trial_record(trial: &SeismicTrial) -> Value {
    let made = trial.trial.as_ref();
    json!({
        "coefficient": trial.coefficient,
        "verdict": trial.verdict().name(),
        "reason": trial.word(),
        "displacement": made.map(|trial| trial.displacement),
        "failing_blocks": made.map(|trial| trial.failing.len()),
        "failing_area": made.map(Trial::failing_area),
        "steps": made.map(|trial| trial.steps),
        "wall_seconds": made.map(|trial| trial.wall),
    })
}

const COLUMNS: [&str; 7] =
    ["coefficient", "verdict", "reason", "displacement [m]", "failing_blocks", "failing_area [m2]", "steps"];

/// Writes the trials as CSV, ascending in their coefficients.
fn write_table(path: &Path, trials: &[SeismicTrial]) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    csv.write_record(COLUMNS).map_err(io::Error::from).map_err(at_path(path))?;
    for trial in trials {
        let made = trial.trial.as_ref();
        let number = |get: fn(&Trial) -> String| made.map(get).unwrap_or_default();
        let row = [
            trial.coefficient.to_string(),
            trial.verdict().name().to_owned(),
            trial.word(),
            number(|trial| trial.displacement.to_string()),
            number(|trial| trial.failing.len().to_string()),
            number(|trial| trial.failing_area().to_string()),
            number(|trial| trial.steps.to_string()),
        ];
        csv.write_record(row).map_err(io::Error::from).map_err(at_path(path))?;
    }
    let bytes = csv.into_inner().map_err(|error| error.into_error()).map_err(at_path(path))?;
    write_atomic(path, &bytes)
}
