//! A search for the factor of safety from case to results: `fos.json`, `fos.csv` and two pictures.
//!
//! Nothing is written before the first trial has ended. Prints nothing: a closure hears of each trial.

use enmm::model::case::keys::Plain;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Instant;
use std::{fs, io};

use serde_json::{Value, json};

use super::bound::{bound_record, bracket_record, factor};
pub use super::found::{Found, remedy};
use super::mechanism_page::write_fos_page;
use super::meshes::{Meshes, OnMesh};
use super::seismic::{self, Seismic};
use enmm::engine_version;
use enmm::model::{Case, Mechanism};
use enmm_io::files::{at_path, write_atomic};
use enmm_io::{CaseError, LoadedCase};
use enmm_picture::{failure_picture, trials_picture};
use enmm_record::Folder;
use enmm_record::input_record;
use enmm_record::results::has_run;
use enmm_record::summary::BoltRecord;
use enmm_report::PAGE;
use enmm_stability::strength_reduction::seismic::{Direction, SeismicOptions, SeismicTrial};
use enmm_stability::strength_reduction::{
    End, FACTOR_RANGE, FailingBlock, HELD, MechanismOptions, Progress, Reduction, ReductionError, ReductionOptions,
    Series, TOLERANCE, Trial, mechanisms,
};
use enmm_stability::up_to_stage;

/// Elements of a mesh over those of the one before it: sides are shorter by its root.
const REFINEMENT: f64 = 2.0;
/// Pictures of the trials and of the mechanism.
const PICTURES: [&str; 2] = ["fos", "failure"];

/// How to look for the factor of safety of a case, and where results go.
#[derive(Debug)]
pub struct FosOptions<'a> {
    /// Where results go.
    pub directory: PathBuf,
    /// Least F that trials reach; where the search begins when given.
    pub low: Option<f64>,
    /// Greatest F that trials reach; where the search begins when given.
    pub high: Option<f64>,
    /// Width of the final bracket relative to F.
    pub tolerance: f64,
    /// Which ways to fail to look for.
    pub mechanisms: MechanismOptions,
    /// Threads; all that there are when none is given. The results do not depend on it.
    pub threads: Option<usize>,
    /// Whether to draw pictures and a page.
    pub pictures: bool,
    /// The static stage after which the slope is looked at; the last one when none is given.
    pub stage: Option<String>,
    /// Meshes on which to look for it, the first that of the case and each finer by √2: more than one gives the error
    /// of the mesh.
    pub meshes: usize,
    /// Whether to look for the yield acceleration as well.
    pub seismic: bool,
    /// The side to which the slope falls; that to which its ground falls where none is named.
    pub direction: Option<Direction>,
    /// Set by another thread to end the search with the trials that are done.
    pub interrupt: Option<&'a AtomicBool>,
}

impl FosOptions<'_> {
    /// The defaults of a search with results in a directory.
    pub fn into_directory(directory: PathBuf) -> Self {
        Self {
            directory,
            low: None,
            high: None,
            tolerance: TOLERANCE,
            mechanisms: MechanismOptions::default(),
            threads: None,
            pictures: true,
            stage: None,
            meshes: 1,
            seismic: false,
            direction: None,
            interrupt: None,
        }
    }

    /// Refuses options with which no search can be made.
    ///
    /// # Errors
    /// What, the value, the limit and the remedy.
    pub fn check(&self) -> Result<(), String> {
        let [least, most] = FACTOR_RANGE;
        for (name, value) in [("--low", self.low), ("--high", self.high)] {
            if let Some(value) = value.filter(|value| !(least..=most).contains(value)) {
                return Err(format!(
                    "{name}: is {}, must be from {least} to {most}; 0.5 and 3 bracket most slopes",
                    Plain(value)
                ));
            }
        }
        let (low, high) = (self.low.unwrap_or(least), self.high.unwrap_or(most));
        if low > high {
            return Err(format!(
                "--low: is {}, must not be above --high, {}; swap or leave out one of them",
                Plain(low),
                Plain(high)
            ));
        }
        if !(1e-4..=0.5).contains(&self.tolerance) {
            return Err(format!("--tolerance: is {}, must be from 1e-4 to 0.5; 0.005 is usual", Plain(self.tolerance)));
        }
        if let Some(area) = self.mechanisms.least_area.filter(|area| !(*area >= 0.0 && area.is_finite())) {
            return Err(format!(
                "--least-area: is {area}, must be 0 m² or more; the area of a block that does not count"
            ));
        }
        Ok(())
    }
}

/// Why there is no result.
#[derive(Debug, thiserror::Error)]
pub enum FosError {
    /// An option cannot be used.
    #[error("{0}")]
    Options(String),
    /// The case cannot be built or begun.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The slope does not come to rest, or fails numerically, before the trials.
    #[error("{0}")]
    NoRest(ReductionError),
    /// The caller stopped it before the first trial.
    #[error("interrupted before the first trial")]
    Interrupted,
    /// The threads cannot be started.
    #[error("cannot start {0} threads: ask for fewer")]
    Threads(usize),
    /// The directory cannot take results.
    #[error("cannot write results ({0}): choose another directory with -o")]
    Directory(io::Error),
    /// A result cannot be written.
    #[error("cannot write results ({0}): choose another directory with -o")]
    Output(io::Error),
}

/// Finds the factor of safety of a case, and its yield acceleration where that is asked for, and writes its results.
///
/// # Errors
/// When something cannot be used, built or written; a search without end is not an error but an [`End`].
pub fn fos(
    loaded: &LoadedCase,
    options: &FosOptions,
    hear: &mut (dyn FnMut(&Trial, Progress) + Send),
    hear_seismic: &mut (dyn FnMut(&SeismicTrial, Progress) + Send),
) -> Result<Found, FosError> {
    let clock = Instant::now();
    let _held = Folder::open(&options.directory, loaded.source.inputs()).map_err(FosError::Directory)?;
    let mut found = search(loaded, options, hear)?;
    if options.meshes > 1 && found.main().end != End::Interrupted {
        found.meshes = Some(on_finer_meshes(loaded, options, &found, hear));
    }
    if options.seismic && found.main().end != End::Interrupted {
        found.seismic = Some(shaken(loaded, options, &found, hear_seismic)?);
    }
    let record = record(loaded, options, &found, clock.elapsed().as_secs_f64());
    let directory = &options.directory;
    write(directory, &record, found.main()).map_err(FosError::Output)?;
    Seismic::write(found.seismic.as_ref(), directory, &loaded.case.title, options.pictures)
        .map_err(FosError::Output)?;
    if options.pictures {
        draw(directory, found.main()).map_err(FosError::Output)?;
        write_fos_page(directory, loaded, &found).map_err(FosError::Output)?;
    } else {
        remove_drawings(directory).map_err(FosError::Output)?;
    }
    Ok(found)
}

/// Finds the factor of safety of a case and writes nothing.
///
/// # Errors
/// When something cannot be used or built.
pub fn search(
    loaded: &LoadedCase,
    options: &FosOptions,
    hear: &mut (dyn FnMut(&Trial, Progress) + Send),
) -> Result<Found, FosError> {
    options.check().map_err(FosError::Options)?;
    let case = up_to_stage(&loaded.case, options.stage.as_deref()).map_err(FosError::Options)?;
    let FosOptions { low, high, tolerance, interrupt, mechanisms: which, .. } = *options;
    let search = ReductionOptions { low, high, tolerance, interrupt, integrators: &enmm_implicit::Both };
    let mut find = || mechanisms(&case, which, &search, hear);
    let mut searches = on_threads(options, &mut find)?.map_err(|error| failure(loaded, error))?;
    searches[0].warnings.splice(0..0, loaded.warnings.iter().cloned());
    Ok(Found { searches, which, meshes: None, seismic: None })
}

/// Finds the yield acceleration of a case of which `found` is the search for the factor of safety.
fn shaken(
    loaded: &LoadedCase,
    options: &FosOptions,
    found: &Found,
    hear: &mut (dyn FnMut(&SeismicTrial, Progress) + Send),
) -> Result<Seismic, FosError> {
    let FosOptions { direction, tolerance, interrupt, .. } = *options;
    let case = up_to_stage(&loaded.case, options.stage.as_deref()).map_err(FosError::Options)?;
    let search = SeismicOptions { direction, tolerance, interrupt, integrators: &enmm_implicit::Both };
    let setting = seismic::Setting { loaded, case: &case, directory: &options.directory };
    let mut find = || seismic::seismic(&setting, &search, found.main(), hear);
    on_threads(options, &mut find)?.map_err(|error| failure(loaded, error))
}

/// Acts on as many threads as are asked for.
fn on_threads<T: Send>(options: &FosOptions, act: &mut (dyn FnMut() -> T + Send)) -> Result<T, FosError> {
    let Some(threads) = options.threads else { return Ok(act()) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(pool.map_err(|_| FosError::Threads(threads))?.install(act))
}

fn failure(loaded: &LoadedCase, error: ReductionError) -> FosError {
    match error {
        ReductionError::Case(invalid) => FosError::Case(loaded.source.locate(&invalid.key, &invalid.message)),
        ReductionError::Interrupted => FosError::Interrupted,
        other => FosError::NoRest(other),
    }
}

/// Searches on finer meshes of the same geometry than that of the case, on which `found` was.
fn on_finer_meshes(
    loaded: &LoadedCase,
    options: &FosOptions,
    found: &Found,
    hear: &mut (dyn FnMut(&Trial, Progress) + Send),
) -> Meshes {
    let size = loaded.case.mesh.size;
    let mut all = Meshes { searches: vec![on_mesh(size, found.main())], is_interrupted: false };
    // One area for all meshes: the free rock of each differs by rounding.
    let least_area = Some(found.which.least(found.main()));
    for k in 1..options.meshes {
        let size = size / libm::pow(REFINEMENT, 0.5 * k as f64);
        let finer = LoadedCase { case: refined(&loaded.case, size), ..loaded.clone() };
        let own = FosOptions {
            mechanisms: MechanismOptions { least_area, count: 1 },
            stage: options.stage.clone(),
            directory: options.directory.clone(),
            ..*options
        };
        let on = match search(&finer, &own, hear) {
            Ok(finer) if finer.main().end == End::Interrupted => None,
            Ok(finer) => Some(on_mesh(size, finer.main())),
            Err(FosError::Interrupted) => None,
            Err(error) => Some(OnMesh { size, counts: None, bracket: None, end: error.to_string() }),
        };
        all.is_interrupted = on.is_none();
        all.searches.extend(on);
        if all.is_interrupted {
            break;
        }
    }
    all
}

fn on_mesh(size: f64, reduction: &Reduction) -> OnMesh {
    let covers = &reduction.simulation.model().covers;
    let bracket = reduction.low.zip(reduction.high).map(|(low, high)| [low, high]);
    OnMesh {
        size,
        counts: Some([covers.element_count(), covers.block_count()]),
        bracket: bracket.filter(|_| reduction.factor().is_some() && reduction.at_most().is_none()),
        end: reduction.end.name().to_owned(),
    }
}

/// The case on another mesh, with the blocks and the measure of failure of its own, whose defaults follow the size.
fn refined(case: &Case, size: f64) -> Case {
    let mut finer = case.clone();
    finer.mesh = case.mesh.of_size(size);
    finer.solver.failure_displacement = case.solver.failure_displacement.or(Some(case.mesh.size));
    finer
}

fn write(directory: &Path, record: &Value, reduction: &Reduction) -> io::Result<()> {
    let path = directory.join("fos.json");
    let text = serde_json::to_vec_pretty(record).map_err(io::Error::from).map_err(at_path(&path))?;
    write_table(&directory.join("fos.csv"), &reduction.trials)?;
    write_atomic(&path, &text)
}

fn draw(directory: &Path, reduction: &Reduction) -> io::Result<()> {
    let title = &reduction.simulation.case().title;
    trials_picture(title, reduction).write(directory, PICTURES[0])?;
    failure_picture(title, reduction).write(directory, PICTURES[1])
}

/// Removes the pictures of an earlier search, and its page, unless a run has left one there.
fn remove_drawings(directory: &Path) -> io::Result<()> {
    let page = (!has_run(directory)).then_some(PAGE);
    let pictures = PICTURES.into_iter().flat_map(|name| ["png", "svg"].map(|end| format!("{name}.{end}")));
    let drawings = pictures.chain(page.map(str::to_owned)).map(|name| directory.join(name));
    drawings.filter(|path| path.exists()).try_for_each(|path| fs::remove_file(&path).map_err(at_path(&path)))
}

fn record(loaded: &LoadedCase, options: &FosOptions, found: &Found, wall: f64) -> Value {
    let mut mechanisms: Vec<Value> = found.searches.iter().map(search_record).collect();
    let main = mechanisms[found.place_of_main()].clone();
    for (mechanism, search) in mechanisms.iter_mut().zip(&found.searches) {
        mechanism["counts"] = json!(found.which.counts(search));
    }
    let mut record = json!({
        "title": loaded.case.title,
        "version": engine_version(),
        "case_file": loaded.source.file(),
        "case_hash": loaded.hash,
        "tolerance": options.tolerance,
        "least_area": found.which.least(found.main()),
        "chips": found.chips().map(|chip| json!({
            "factor_of_safety": chip.factor().filter(|_| chip.at_most().is_none()),
            "at_most": chip.at_most(),
            "area": chip.first_unstable().map(Trial::failing_area),
        })).collect::<Vec<_>>(),
        "wall_seconds": wall,
        "mechanisms": mechanisms,
        "input": input_record(loaded),
    });
    if !loaded.settings.is_empty() {
        record["settings"] = json!(loaded.settings);
    }
    if let Some(stage) = &options.stage {
        record["stage"] = json!(stage);
    }
    if let Some(meshes) = &found.meshes {
        record["meshes"] = meshes.record();
    }
    if let Some(seismic) = &found.seismic {
        record["seismic"] = seismic.record();
    }
    if let (Value::Object(record), Value::Object(main)) = (&mut record, main) {
        record.extend(main);
    }
    record
}

/// One search as an object.
fn search_record(reduction: &Reduction) -> Value {
    let failing = reduction.first_unstable();
    let mut record = json!({
        "status": reduction.end.name(),
        "factor_of_safety": reduction.factor().filter(|_| reduction.at_most().is_none()),
        "at_least": reduction.at_least().filter(|_| reduction.at_most().is_none()),
        "at_most": reduction.at_most(),
        "bracket": { "stable": reduction.low, "unstable": reduction.high },
        "rest": { "strength_factor": HELD, "time": reduction.rest.0, "steps": reduction.rest.1 },
        "trials": reduction.trials.iter().map(trial_record).collect::<Vec<_>>(),
        "failing": failing.map(|trial| json!({
            "verdict": trial.verdict.name(),
            "mechanism": reduction.mechanism.map(Mechanism::verb),
            "blocks": trial.failing.len(),
            "area": trial.failing_area(),
            "mass": trial.failing_mass(),
            "share": trial.failing_area() / reduction.free_area,
        })),
        "failing_blocks": failing.map_or(&[][..], |trial| &trial.failing).iter().map(block_record).collect::<Vec<_>>(),
        "bound": match (&reduction.bracket, &reduction.bound) {
            (Some(bracket), _) => bracket_record(bracket),
            (None, Ok(bound)) => bound_record(bound),
            (None, Err(refused)) => json!({ "refused": refused }),
        },
        "joint_water": reduction.simulation.pressure_in_joints(),
        "remedy": remedy(reduction),
        "bolts": BoltRecord::of(&reduction.simulation),
        "notes": reduction.simulation.built().notes,
        "warnings": reduction.warnings,
    });
    if let Value::Object(record) = &mut record {
        record.extend(others_record(reduction));
    }
    if let Some(doubt) = reduction.doubt() {
        record["doubt"] = json!(doubt);
    }
    record
}

/// The factors beside the headline: where corners hold, where the slope is lost, and before nudges.
fn others_record(reduction: &Reduction) -> serde_json::Map<String, Value> {
    let corners = reduction.corners.as_ref();
    let held = corners.map(|corners| &corners.series);
    let carrying = corners.map_or(&[][..], |corners| &corners.corners).iter().map(|carrying| {
        let at = carrying.corner.ends[0];
        json!({
            "block": carrying.corner.block.number(),
            "ahead": carrying.corner.ahead.number(),
            "x": at.x,
            "y": at.y,
            "length": carrying.corner.length(),
            "force": carrying.force,
            "strength": carrying.corner.strength,
        })
    });
    let ends = reduction.ends.as_ref();
    let others = [
        ("factor_corners_hold", json!(held.and_then(Series::factor))),
        ("corners_hold", json!(held.map(series_record))),
        ("corner_contacts", carrying.collect()),
        ("factor_ends_drawn", json!(ends.map(|ends| factor(ends.drawn)))),
        ("factor_ends_joined", json!(ends.map(|ends| factor(ends.joined)))),
        ("factor_lost", json!(reduction.lost.as_ref().and_then(Series::factor))),
        ("lost", json!(reduction.lost.as_ref().map(series_record))),
        ("first_yield", json!(reduction.first_yield())),
        ("factor_before_nudges", json!(reduction.before_nudges)),
    ];
    others.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}

/// A search in another setting as an object.
fn series_record(series: &Series) -> Value {
    json!({
        "status": series.end.name(),
        "at_least": series.at_least(),
        "bracket": { "stable": series.low, "unstable": series.high },
        "trials": series.trials.iter().map(trial_record).collect::<Vec<_>>(),
    })
}

fn block_record(block: &FailingBlock) -> Value {
    json!({
        "block": block.block,
        "place": [block.position.x, block.position.y],
        "area": block.area,
        "mass": block.mass,
        "displacement": block.displacement,
        "rotation": block.rotation,
        "speed": block.speed,
    })
}

/// One trial as an object.
fn trial_record(trial: &Trial) -> Value {
    json!({
        "factor": trial.factor,
        "verdict": trial.verdict.name(),
        "reason": trial.reason.name(),
        "geometry": trial.geometry.name(),
        "rests_after": trial.is_far,
        "time": trial.time,
        "displacement": trial.displacement,
        "slip": trial.slip,
        "speed": trial.speed,
        "kinetic_energy": trial.kinetic,
        "released_energy": trial.released,
        "acceleration": trial.acceleration,
        "failing_blocks": trial.failing.len(),
        "failing_area": trial.failing_area(),
        "steps": trial.steps,
        "ledger_residual": trial.ledger_residual,
        "wall_seconds": trial.wall,
    })
}

const HEADER: [&str; 14] = [
    "factor",
    "verdict",
    "reason",
    "time [s]",
    "displacement [m]",
    "slip [m]",
    "speed [m/s]",
    "kinetic_energy [J/m]",
    "released_energy [J/m]",
    "acceleration [m/s2]",
    "failing_blocks",
    "failing_area [m2]",
    "steps",
    "wall [s]",
];

/// Writes the trials as CSV, ascending in F.
fn write_table(path: &Path, trials: &[Trial]) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    csv.write_record(HEADER).map_err(io::Error::from).map_err(at_path(path))?;
    for t in trials {
        let numbers = [t.time, t.displacement, t.slip, t.speed, t.kinetic, t.released, t.acceleration];
        let mut row = vec![t.factor.to_string(), t.verdict.name().to_owned(), t.reason.name().to_owned()];
        row.extend(numbers.map(|number| number.to_string()));
        row.extend([t.failing.len().to_string(), t.failing_area().to_string()]);
        row.extend([t.steps.to_string(), t.wall.to_string()]);
        csv.write_record(row).map_err(io::Error::from).map_err(at_path(path))?;
    }
    let bytes = csv.into_inner().map_err(|error| error.into_error()).map_err(at_path(path))?;
    write_atomic(path, &bytes)
}
