//! Other programs on the same models, turn by turn with this one, on one thread: Rapier's soft bodies and Box2D on
//! sliding slopes, a Numba kernel on elements.
//!
//! Each is a small program of its own below `tools/bench/peers`, outside the workspace, with its own pinned
//! dependencies. It is built when it is asked for and tells its result as one JSON object.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde::{Deserialize, Serialize};

use enmm::engine_version;
use enmm_verification::bench::{BenchError, BenchOptions, Machine, Model, advance, in_pool, measure, sizes, timed};

use super::scene::{Outcome, Placed, Scene};

/// Models that are compared when none is named.
pub const COMPARED: [Model; 4] =
    [Model::Slope(500, 4), Model::Slope(2_000, 4), Model::Continuum(10_000), Model::Continuum(100_000)];
/// Wall time (s) for the element passes of this program in a round.
const SECONDS: f64 = 1.0;
/// Element updates that the figure of a continuum is for.
const UPDATES: f64 = 1e6;
/// How this program runs.
const OWN_SETTINGS: &str = "deformable blocks, explicit steps as the case has them, without mass scaling, \
                            `contact_tolerance` 0.01, 8-byte numbers";
/// Lines of what a program said that its failure repeats.
const LAST_LINES: usize = 3;

/// A program that is timed beside this one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Peer {
    /// Its name.
    pub name: &'static str,
    /// Folder of its sources, which ends the name of its program.
    folder: &'static str,
    /// Whether it simulates slopes; else it updates the elements of continua.
    is_for_slopes: bool,
}

impl Peer {
    /// Rapier's soft bodies: deformable blocks, implicit finite elements.
    const RAPIER: Self = Self { name: "rapier", folder: "rapier", is_for_slopes: true };
    /// The same, their elasticity swept with the contacts.
    const RAPIER_CONSTRAINTS: Self = Self { name: "rapier-constraints", ..Self::RAPIER };
    /// Box2D: rigid blocks.
    const BOX2D: Self = Self { name: "box2d", folder: "box2d", is_for_slopes: true };
    /// A Numba kernel: elements without contact.
    const NUMBA: Self = Self { name: "numba", folder: "numba", is_for_slopes: false };
    /// All of them.
    pub const ALL: [Self; 4] = [Self::RAPIER, Self::RAPIER_CONSTRAINTS, Self::BOX2D, Self::NUMBA];

    /// Reads a name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|peer| peer.name == name)
    }

    /// Whether it can be timed on a model.
    pub fn takes(self, model: &Model) -> bool {
        if self.is_for_slopes { matches!(model, Model::Slope(..)) } else { matches!(model, Model::Continuum(_)) }
    }
}

/// Options of a comparison.
#[derive(Debug, Clone)]
pub struct PeerOptions {
    /// Models: slopes and continua.
    pub models: Vec<Model>,
    /// Programs.
    pub peers: Vec<Peer>,
    /// Rounds: in each, every program runs once.
    pub rounds: usize,
    /// Simulated time (s) of slopes.
    pub duration: f64,
    /// Folder of the sources of the programs.
    pub sources: PathBuf,
    /// Folder for what is built.
    pub builds: PathBuf,
}

/// Why nothing was compared.
#[derive(Debug, thiserror::Error)]
pub enum PeerError {
    /// The sources of the other programs are not there.
    #[error(
        "the sources of the other programs were not found in {}: run in the root of the repository of enmm, or name \
        its folder tools/bench/peers by --peer-sources", .0.display()
    )]
    Sources(PathBuf),
    /// A folder or file cannot be written.
    #[error("cannot write {0}: choose another target folder by CARGO_TARGET_DIR")]
    Files(#[from] std::io::Error),
    /// This program failed.
    #[error(transparent)]
    Own(#[from] BenchError),
}

/// Programs timed beside each other.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct PeerReport {
    /// Version of the engine.
    pub version: String,
    /// The machine.
    pub machine: Machine,
    /// Rounds.
    pub rounds: usize,
    /// Simulated time (s) of a slope.
    pub duration: f64,
    /// The models.
    pub models: Vec<Compared>,
    /// Programs and models that could not be timed, and why.
    pub left_out: Vec<String>,
}

/// A model with the programs that were timed on it, this one first.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Compared {
    /// Name of the model.
    pub model: String,
    /// Mesh size (m) of a slope, which overlaps are compared with.
    pub size: Option<f64>,
    /// The programs.
    pub programs: Vec<Timed>,
}

/// One program on one model.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Timed {
    /// Program with its version.
    pub program: String,
    /// Its settings.
    pub settings: String,
    /// Seconds in each round: for a simulated second of a slope, or for a million element updates.
    pub seconds: Vec<f64>,
    /// Elements; none for rigid blocks.
    pub elements: Option<usize>,
    /// Contacts at the end.
    pub contacts: Option<usize>,
    /// Steps of a simulated second, or substeps if steps have them.
    pub steps: Option<f64>,
    /// Outcome of the slope.
    pub outcome: Option<Outcome>,
}

impl Timed {
    /// Adds a round.
    fn add(&mut self, answer: Answer, task: &Task) -> Result<(), String> {
        self.outcome = task.outcome(&answer)?;
        let Answer { program, settings, seconds, elements, contacts, steps, .. } = answer;
        self.seconds.push(seconds);
        (self.program, self.settings, self.elements) = (program, settings, elements);
        (self.contacts, self.steps) = (contacts, steps);
        Ok(())
    }

    /// The middle of the rounds (s); not a number without rounds.
    pub fn median(&self) -> f64 {
        range(self.seconds.clone())[1]
    }

    /// How many times as long as `own` it took: the least, middle and greatest of the rounds.
    pub fn ratios(&self, own: &Self) -> [f64; 3] {
        range(self.seconds.iter().zip(&own.seconds).map(|(theirs, ours)| theirs / ours).collect())
    }
}

/// The least, middle and greatest value; of an even number the upper of the middle two.
fn range(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    let at = |k: usize| values.get(k).copied().unwrap_or(f64::NAN);
    [at(0), at(values.len() / 2), at(values.len().saturating_sub(1))]
}

/// Answer of a program about a run.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Answer {
    program: String,
    settings: String,
    seconds: f64,
    elements: Option<usize>,
    contacts: Option<usize>,
    steps: Option<f64>,
    #[serde(default)]
    blocks: Vec<Placed>,
}

/// A program that is ready to run: what begins its command line.
struct Built {
    peer: Peer,
    command: Vec<PathBuf>,
}

/// Times this program and others turn by turn on one thread; `begin` hears what comes next.
///
/// A program that cannot be built or does not run is left out, and the report names it.
///
/// # Errors
/// When the sources of the others are not there, a file cannot be written, or this program fails.
pub fn compare(options: &PeerOptions, begin: &mut (dyn FnMut(&str) + Send)) -> Result<PeerReport, PeerError> {
    if !options.sources.is_dir() {
        return Err(PeerError::Sources(options.sources.clone()));
    }
    std::fs::create_dir_all(&options.builds)?;
    in_pool(1, || compare_here(options, begin))?
}

fn compare_here(options: &PeerOptions, begin: &mut dyn FnMut(&str)) -> Result<PeerReport, PeerError> {
    let mut report = PeerReport {
        version: engine_version().to_owned(),
        machine: Machine::here(false),
        rounds: options.rounds,
        duration: options.duration,
        ..PeerReport::default()
    };
    let mut ready = Vec::new();
    for &peer in &options.peers {
        begin(&format!("building {}", peer.name));
        match build(peer, options) {
            Ok(command) => ready.push(Built { peer, command }),
            Err(why) => report.left_out.push(format!("{}: {why}", peer.name)),
        }
    }
    for model in &options.models {
        let others: Vec<&Built> = ready.iter().filter(|built| built.peer.takes(model)).collect();
        if others.is_empty() {
            report.left_out.push(format!("{model}: no program that is ready takes it"));
        } else {
            report.models.extend(rounds(model, &others, options, begin, &mut report.left_out)?);
        }
    }
    Ok(report)
}

/// Work of the programs on a model.
enum Task {
    /// Simulate a slope.
    Slope(Box<Scene>),
    /// Update so many elements.
    Elements(usize),
}

impl Task {
    /// The task of a model; none for one that no program takes.
    fn of(model: &Model, duration: f64) -> Result<Option<Self>, BenchError> {
        Ok(match model {
            Model::Slope(..) => Scene::of(&model.build()?, duration).map(Box::new).map(Self::Slope),
            Model::Continuum(elements) => Some(Self::Elements(*elements)),
            Model::Resting | Model::Failing => None,
        })
    }

    /// Argument of the others: a file that is written, or a number.
    fn argument(&self, file: PathBuf) -> std::io::Result<PathBuf> {
        match self {
            Self::Slope(scene) => std::fs::write(&file, serde_json::to_vec(scene)?).map(|()| file),
            Self::Elements(elements) => Ok(elements.to_string().into()),
        }
    }

    /// One run of this program.
    fn own(&self, model: &Model) -> Result<Answer, BenchError> {
        let program = format!("enmm {}", engine_version());
        let settings = OWN_SETTINGS.to_owned();
        let Self::Slope(scene) = self else {
            let (seconds, models) = (SECONDS, Vec::new());
            let options = BenchOptions { models, seconds, threads: None, limits: false, first_second: false };
            let found = measure(model, &options, &Machine::default())?;
            let (seconds, elements) = (UPDATES / found.elements_per_second, Some(found.elements));
            let (contacts, steps, blocks) = (None, None, Vec::new());
            return Ok(Answer { program, settings, seconds, elements, contacts, steps, blocks });
        };
        let mut simulation = model.build()?;
        let steps = simulation.steps_in(scene.duration);
        let (done, seconds) = timed(|| advance(&mut simulation, steps));
        done?;
        Ok(Answer {
            program,
            settings,
            seconds: seconds / scene.duration,
            elements: Some(sizes(&simulation).elements),
            contacts: Some(simulation.state().contacts.len()),
            steps: Some(steps as f64 / scene.duration),
            blocks: scene.placed(&simulation),
        })
    }

    /// Outcome of the slope; an error when the answer has other blocks or wrong numbers.
    fn outcome(&self, answer: &Answer) -> Result<Option<Outcome>, String> {
        let Self::Slope(scene) = self else { return Ok(None) };
        let wrong = || "its blocks are not those of the slope, or their places are not finite".to_owned();
        scene.outcome(&answer.blocks).map(Some).ok_or_else(wrong)
    }
}

/// All rounds on one model; none for a model that no program takes, or on which this one failed.
fn rounds(
    model: &Model,
    others: &[&Built],
    options: &PeerOptions,
    begin: &mut dyn FnMut(&str),
    left_out: &mut Vec<String>,
) -> Result<Option<Compared>, PeerError> {
    let Some(task) = Task::of(model, options.duration)? else { return Ok(None) };
    let argument = task.argument(options.builds.join(format!("{model}.json")))?;
    // The first is this program; a program that failed has no results any more.
    let mut results: Vec<Option<Timed>> = vec![Some(Timed::default()); others.len() + 1];
    for round in 0..options.rounds {
        begin(&format!("{model}, round {} of {}", round + 1, options.rounds));
        // Who is first changes, so that none always finds the machine as another left it.
        let mut order: Vec<usize> = (0..results.len()).collect();
        order.rotate_left(round % results.len());
        for k in order {
            let Some(so_far) = &mut results[k] else { continue };
            let answer = if k == 0 { Ok(task.own(model)?) } else { ask(&others[k - 1].command, &argument) };
            if let Err(why) = answer.and_then(|answer| so_far.add(answer, &task)) {
                let name = if k == 0 { "enmm" } else { others[k - 1].peer.name };
                left_out.push(format!("{name} on {model}: {why}"));
                results[k] = None;
            }
        }
    }
    if results[0].is_none() {
        return Ok(None);
    }
    let size = if let Task::Slope(scene) = &task { Some(scene.size) } else { None };
    Ok(Some(Compared { model: model.to_string(), size, programs: results.into_iter().flatten().collect() }))
}

/// One run of another program.
fn ask(command: &[PathBuf], input: &Path) -> Result<Answer, String> {
    let Some((program, rest)) = command.split_first() else { return Err("has no command".to_owned()) };
    let mut run = Command::new(program);
    run.args(rest).arg(input).envs(["RAYON_NUM_THREADS", "NUMBA_NUM_THREADS"].map(|name| (name, "1")));
    let told = output(&mut run)?;
    let answer: Answer = serde_json::from_slice(&told).map_err(|error| format!("its answer is wrong: {error}"))?;
    if answer.seconds.is_finite() && answer.seconds > 0.0 {
        return Ok(answer);
    }
    Err(format!("it took {} s, which is no time", answer.seconds))
}

/// Builds a program; returns what begins its command line.
fn build(peer: Peer, options: &PeerOptions) -> Result<Vec<PathBuf>, String> {
    let sources = options.sources.join(peer.folder);
    if peer == Peer::NUMBA {
        let python = environment(&sources, &options.builds.join("venv"))?;
        return Ok(vec![python, sources.join("elements.py")]);
    }
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut build = Command::new(cargo);
    build.args(["build", "--release", "--locked", "--manifest-path"]).arg(sources.join("Cargo.toml"));
    // Settings for builds of this workspace are not theirs, and they get the same instructions of the processor.
    for (name, _) in std::env::vars_os() {
        if name.to_string_lossy().starts_with("CARGO_PROFILE_") {
            build.env_remove(name);
        }
    }
    build.env_remove("CARGO_ENCODED_RUSTFLAGS").env("RUSTFLAGS", "-C target-cpu=native");
    output(build.arg("--target-dir").arg(&options.builds))?;
    let program = format!("enmm-peer-{}{}", peer.folder, std::env::consts::EXE_SUFFIX);
    let mut command = vec![options.builds.join("release").join(program)];
    command.extend((peer == Peer::RAPIER_CONSTRAINTS).then(|| "constraints".into()));
    Ok(command)
}

/// Makes a virtual environment with the requirements of a folder, unless it is there; returns its Python.
fn environment(sources: &Path, place: &Path) -> Result<PathBuf, String> {
    let requirements = sources.join("requirements.txt");
    let wanted = std::fs::read(&requirements).map_err(|error| format!("{}: {error}", requirements.display()))?;
    let python = place.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let stamp = place.join("enmm-requirements");
    if std::fs::read(&stamp).is_ok_and(|found| found == wanted) {
        return Ok(python);
    }
    output(Command::new(if cfg!(windows) { "python" } else { "python3" }).args(["-m", "venv", "--clear"]).arg(place))?;
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r"];
    output(Command::new(&python).args(pip).arg(&requirements))?;
    std::fs::write(&stamp, wanted).map_err(|error| format!("{}: {error}", stamp.display()))?;
    Ok(python)
}

/// Output of a command; its last words when it cannot be started or fails.
fn output(command: &mut Command) -> Result<Vec<u8>, String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let told = command.output().map_err(|error| format!("{name} cannot be started ({error}): install it"))?;
    if told.status.success() {
        return Ok(told.stdout);
    }
    let words = String::from_utf8_lossy(&told.stderr).trim().to_owned();
    let lines: Vec<&str> = words.lines().rev().take(LAST_LINES).collect();
    Err(format!("{name} failed: {}", lines.into_iter().rev().collect::<Vec<_>>().join(" / ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(sources: &Path, builds: PathBuf) -> PeerOptions {
        let models = vec![Model::Slope(20, 4), Model::Resting];
        let (peers, sources) = (Peer::ALL.to_vec(), sources.to_owned());
        PeerOptions { models, peers, rounds: 1, duration: 1.0, sources, builds }
    }

    #[test]
    fn names_are_read_back() {
        assert!(Peer::ALL.into_iter().all(|peer| Peer::parse(peer.name) == Some(peer)));
        assert_eq!(Peer::parse("all"), None);
    }

    #[test]
    fn ratios_are_those_of_rounds() {
        let timed = |seconds: [f64; 3]| Timed { seconds: seconds.into(), ..Timed::default() };
        let (own, other) = (timed([1.0, 2.0, 4.0]), timed([3.0, 4.0, 20.0]));
        assert_eq!((other.median(), other.ratios(&own)), (4.0, [2.0, 3.0, 5.0]));
    }

    #[test]
    fn programs_that_cannot_be_built_are_left_out_by_name() {
        let folder = std::env::temp_dir().join(format!("enmm-peers-{}", std::process::id()));
        let none = options(&folder.join("sources"), folder.join("builds"));
        let refused = compare(&none, &mut |_| {}).map(|_| ()).unwrap_err().to_string();
        assert!(refused.contains("sources") && refused.contains("--peer-sources"), "{refused}");
        std::fs::create_dir_all(&none.sources).expect("a folder");
        let report = compare(&none, &mut |_| {}).unwrap_or_else(|e| panic!("{e}"));
        assert!(report.models.is_empty(), "{report:?}");
        let starts = ["rapier:", "rapier-constraints:", "box2d:", "numba:", "slope_20x4:", "fractured_resting:"];
        for (line, start) in report.left_out.iter().zip(starts) {
            assert!(line.starts_with(start), "{line}");
        }
        assert_eq!(report.left_out.len(), starts.len(), "{:?}", report.left_out);
        std::fs::remove_dir_all(&folder).expect("a folder to remove");
    }

    #[test]
    fn a_program_that_is_not_there_is_named() {
        let missing = Path::new("no-such-program-of-enmm").to_owned();
        let refused = ask(&[missing], Path::new("1")).unwrap_err();
        assert!(refused.contains("no-such-program-of-enmm cannot be started"), "{refused}");
    }

    #[test]
    fn answers_are_read() {
        let read = |text: &str| serde_json::from_str::<Answer>(text);
        let told = r#"{"program": "p 1", "settings": "s", "seconds": 0.5, "elements": 3, "blocks": [null, [[0, 1]]]}"#;
        assert!(read(told).is_ok_and(|answer| answer.blocks == [None, Some(vec![[0.0, 1.0]])]));
        assert!(read(r#"{"program": "p 1", "settings": "s", "second": 0.5}"#).is_err());
    }
}
