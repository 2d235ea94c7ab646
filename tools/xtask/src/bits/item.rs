//! Items that are run, and the results that count.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

use super::Results;
use crate::emulator::Emulator;
use crate::platform::Platform;
use crate::repository::{self, Repository};
use crate::venv;

/// Something that is run.
pub struct Item {
    /// Name in the tables.
    pub name: &'static str,
    /// Whether `cargo xtask test` runs it.
    pub quick: bool,
    /// Whether it is in the golden table.
    pub golden: bool,
    /// How it is run.
    pub act: Act,
}

/// How an item is run.
pub enum Act {
    /// An example case, all its stages.
    Run,
    /// A model of `enmm bench` for so much simulated time (s).
    Model(&'static str),
    /// The factor of safety of an example case.
    Fos(&'static str),
    /// The limit analysis of an example case.
    Bound(&'static str),
    /// An example case as an FMU of this version.
    Fmu(&'static str, &'static str),
    /// Quick verification problems.
    Verify(&'static str),
}

const fn quick(name: &'static str, act: Act) -> Item {
    Item { name, quick: true, golden: true, act }
}

const fn full(name: &'static str, act: Act) -> Item {
    Item { name, quick: false, golden: true, act }
}

/// All items, the quick ones first.
pub const ITEMS: [Item; 20] = [
    quick("block_on_incline", Act::Run),
    quick("simply_supported_beam", Act::Run),
    quick("goodman_bray", Act::Run),
    quick("coupled_slope", Act::Run),
    quick("coupled_slope_fmi2", Act::Fmu("coupled_slope", "2")),
    quick("coupled_slope_fmi3", Act::Fmu("coupled_slope", "3")),
    quick("plane_slide_bound", Act::Bound("plane_slide")),
    quick("slope_500x4", Act::Model("0.2")),
    quick("continuum_10000", Act::Model("0.1")),
    full("block_on_incline_fmi2", Act::Fmu("block_on_incline", "2")),
    full("block_on_incline_fmi3", Act::Fmu("block_on_incline", "3")),
    full("masonry_wall", Act::Run),
    full("plane_slide", Act::Run),
    full("shaken_slope", Act::Run),
    full("plane_slide_fos", Act::Fos("plane_slide")),
    full("verify_explicit", Act::Verify("A,B,C,D,E2,F")),
    full("slope_2000x16", Act::Model("0.02")),
    full("slope_10000x4", Act::Model("0.01")),
    full("fractured_slope", Act::Run),
    // Its linear solver picks instructions by processor: the bits are those of one machine.
    Item { name: "verify_implicit", quick: false, golden: false, act: Act::Verify("E1") },
];

/// Item that takes a third of the time on an emulator, and shows nothing that another continuum does not.
pub const LONG_EMULATED: &str = "simply_supported_beam";

/// Time (s) without end of the models of `enmm bench`.
const ENDLESS: &str = "duration = 1e6\n";

impl Item {
    /// Version of FMI of an item that is an FMU.
    pub fn version(&self) -> Option<&'static str> {
        if let Act::Fmu(_, version) = self.act { Some(version) } else { None }
    }
}

/// Whether an FMU of this version has a folder for a platform beside that of this machine: FMI 2 names no processor.
pub fn has_folder(platform: &Platform, version: &str) -> bool {
    version == "3" || platform.is_windows()
}

/// The library of a platform as `enmm fmu --library` takes it.
pub fn library(repository: &Repository, platform: &Platform) -> String {
    let path = platform.shipped(repository).join(platform.library("enmm"));
    let name = platform.cross.as_ref().map_or("", |cross| cross.fmi);
    format!("{name}={}", path.display())
}

/// Options of `python_tests/fmu_bits.py` that have the library of a platform called by a host.
pub fn host_words(platform: &Platform, emulator: &Emulator, version: &str, host: &Path) -> Vec<String> {
    let name = platform.cross.as_ref().map_or("", |cross| cross.fmi);
    let folder = if version == "2" { "win64" } else { name };
    let words = ["--platform", folder, "--host"].into_iter().chain(emulator.words().iter().copied());
    words.map(str::to_owned).chain([host.display().to_string()]).collect()
}

/// Makes results by one build.
pub struct Maker<'a> {
    /// The repository.
    pub repository: &'a Repository,
    /// The platform of the build.
    pub platform: &'a Platform,
    /// Emulator of its programs.
    pub emulator: &'a Emulator,
    /// Host of FMUs for another platform.
    pub host: Option<&'a Path>,
    /// The program.
    pub program: &'a Path,
    /// The program that writes the cases of models.
    pub writer: &'a Path,
    /// Where results go.
    pub folder: PathBuf,
}

impl Maker<'_> {
    /// Runs an item.
    pub fn make(&self, item: &Item) -> Result<Results, String> {
        let place = self.folder.join(item.name);
        repository::make(&place)?;
        let results = match item.act {
            Act::Run => self.run_case(Path::new(&case(item.name)), &place),
            Act::Model(duration) => self.run_case(&self.model_case(item.name, duration)?, &place),
            Act::Fos(name) => self.fos(name, &place),
            Act::Bound(name) => self.bound(name, &place),
            Act::Fmu(name, version) => self.fmu(name, version, &place),
            Act::Verify(problems) => self.verify(problems),
        };
        let results = results.map_err(|error| format!("{}: {error}", item.name))?;
        if results.is_empty() { Err(format!("{}: no results", item.name)) } else { Ok(results) }
    }

    /// Removes the files of an item: frames of all items together would take more than a gigabyte.
    pub fn forget(&self, item: &Item) -> Result<(), String> {
        repository::remove(&self.folder.join(item.name))
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = self.emulator.command(self.repository, self.program);
        command.args(words);
        command
    }

    fn run_case(&self, case: &Path, place: &Path) -> Result<Results, String> {
        let mut run = self.command(&["run", "--quiet"]);
        repository::run(run.arg(case).arg("-o").arg(place).stderr(Stdio::null()))?;
        let mut results = results_of(place)?;
        clean(&mut results, "summary.json")?;
        Ok(results)
    }

    /// Writes the case of a model with an end; returns its path, which is the same for every program.
    fn model_case(&self, name: &str, duration: &str) -> Result<PathBuf, String> {
        let folder = self.repository.target.join("bits-models");
        let mut write = self.repository.command(self.writer);
        repository::capture(write.args(["bench", "--models", name, "--write"]).arg(&folder))?;
        let path = folder.join(name).with_extension("toml");
        let text = String::from_utf8_lossy(&repository::read(&path)?).into_owned();
        if !text.contains(ENDLESS) {
            return Err(format!("{}: has no stage with {ENDLESS:?}", path.display()));
        }
        let text = text.replace(ENDLESS, &format!("duration = {duration}\n"));
        repository::write(&path, text)?;
        Ok(path)
    }

    fn fos(&self, name: &str, place: &Path) -> Result<Results, String> {
        let mut fos = self.command(&["fos", &case(name), "--json", "-o"]);
        repository::capture(fos.arg(place).stderr(Stdio::null()))?;
        let mut results = results_of(place)?;
        // The table has a column of wall times; fos.json has the same rows.
        results.remove("fos.csv");
        clean(&mut results, "fos.json")?;
        Ok(results)
    }

    /// Output of the program.
    fn bound(&self, name: &str, place: &Path) -> Result<Results, String> {
        let mut bound = self.command(&["bound", &case(name), "--json", "-o"]);
        let mut results = Results::from([("bound.json".to_owned(), repository::capture(bound.arg(place))?)]);
        clean(&mut results, "bound.json")?;
        Ok(results)
    }

    /// Packs a case and steps it through its C functions, with a rollback. For another platform the FMU has the library
    /// of this machine as well, and is packed here.
    fn fmu(&self, name: &str, version: &str, place: &Path) -> Result<Results, String> {
        let packed = place.join(format!("{name}.fmu"));
        let mut pack = self.repository.command(self.host.map_or(self.program, |_| self.writer));
        pack.args(["fmu", &case(name), "--fmi", version, "-o"]).arg(&packed);
        let run = place.join("run");
        let mut steps = venv::command(self.repository, venv::Packages::Usual)?;
        steps.arg("python_tests/fmu_bits.py").arg(&packed).arg(&run);
        if let Some(host) = self.host {
            pack.args(["--library", &library(self.repository, self.platform)]);
            steps.args(host_words(self.platform, self.emulator, version, host));
            self.emulator.prepare(&mut steps);
        }
        repository::capture(&mut pack)?;
        repository::run(&mut steps)?;
        repository::files_of(&run)
    }

    /// Computed values of problems, without any text about them.
    fn verify(&self, problems: &str) -> Result<Results, String> {
        let told = repository::capture(&mut self.command(&["verify", "--quick", "--json", "--only", problems]))?;
        let record: Value = serde_json::from_slice(&told).map_err(|error| format!("verify: {error}"))?;
        let mut results = Results::new();
        for problem in record["problems"].as_array().into_iter().flatten() {
            let computed = problem["rows"].as_array().into_iter().flatten().map(|row| format!("{}\n", row["computed"]));
            let id = problem["id"].as_str().unwrap_or_default();
            results.insert(id.to_owned(), computed.collect::<String>().into_bytes());
        }
        Ok(results)
    }
}

/// Files of results without the page and its film, which show what is in the others with the release and the viewer.
fn results_of(place: &Path) -> Result<Results, String> {
    let mut results = repository::files_of(place)?;
    results.retain(|name, _| !["report.html", "film.bin"].contains(&name.as_str()));
    Ok(results)
}

fn case(name: &str) -> String {
    format!("examples/cases/{name}.toml")
}

/// Takes out of a JSON what differs from run to run, machine to machine and release to release.
fn clean(results: &mut Results, name: &str) -> Result<(), String> {
    let bytes = results.get_mut(name).ok_or_else(|| format!("{name} is missing"))?;
    let mut value: Value = serde_json::from_slice(bytes).map_err(|error| format!("{name}: {error}"))?;
    strip(&mut value);
    *bytes = format!("{value:#}\n").into_bytes();
    Ok(())
}

fn strip(value: &mut Value) {
    match value {
        Value::Object(entries) => {
            entries.retain(|key, _| !["wall_seconds", "threads", "version", "case_file"].contains(&key.as_str()));
            entries.values_mut().for_each(strip);
        }
        Value::Array(values) => values.iter_mut().for_each(strip),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_and_machines_are_taken_out_and_digits_kept() {
        let text = r#"{"threads":2,"time":0.1000000000000000055,"stages":[{"wall_seconds":1.5,"steps":3}]}"#;
        let mut results = Results::from([("summary.json".to_owned(), text.as_bytes().to_vec())]);
        clean(&mut results, "summary.json").expect("a JSON");
        let found: Value = serde_json::from_slice(&results["summary.json"]).expect("a JSON");
        assert_eq!(found, serde_json::json!({"time": 0.1, "stages": [{"steps": 3}]}));
        assert!(clean(&mut results, "absent.json").is_err());
    }

    #[test]
    fn names_of_items_are_their_own() {
        let names: std::collections::BTreeSet<&str> = ITEMS.iter().map(|item| item.name).collect();
        assert_eq!(names.len(), ITEMS.len());
        assert!(ITEMS.iter().all(|item| item.golden || !item.quick));
    }
}
