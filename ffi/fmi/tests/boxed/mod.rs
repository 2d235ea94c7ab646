//! A box on a base as an FMU of `super::VERSION`, and what a library exports: for the tests of both versions.

use std::path::{Path, PathBuf};

use enmm_fmi::log::Status;
use enmm_fmi::table::Table;
use enmm_io::{LoadedCase, parse_case};

use super::VERSION;

/// The case of the box.
pub const BOX: &str = include_str!("box.toml");

/// Status, category and text of a message.
pub type Line = (Status, String, String);

/// Resources and table of an FMU.
pub struct Fmu {
    folder: tempfile::TempDir,
    pub table: Table,
}

impl Fmu {
    pub fn of(text: &str) -> Self {
        let loaded = parse_case(text, "box.toml", Path::new(".")).unwrap();
        let folder = tempfile::tempdir().unwrap();
        write_resources(&loaded, &folder.path().join("resources"));
        let blocks = loaded.cosimulation().unwrap().block_states().len();
        let table = Table::new(&loaded.case, blocks, &loaded.hash, VERSION);
        Self { folder, table }
    }

    pub fn boxed() -> Self {
        Self::of(BOX)
    }

    /// The box of rock of 50 Pa instead of 10 GPa, which comes to rest within two steps by an energy that is not there.
    pub fn soft() -> Self {
        let text = BOX.replace("young = 10e9", "young = 50").replace("communication_step = 0.01", "");
        Self::of(&text.replace("duration = 1.0", "duration = 5.0").replace("duration = 0.5", "duration = 50.0"))
    }

    pub fn reference(&self, name: &str) -> u32 {
        let found = self.table.variables.iter().find(|v| v.name == name);
        found.unwrap_or_else(|| panic!("no variable {name}")).reference
    }

    pub fn resources(&self) -> PathBuf {
        self.folder.path().join("resources")
    }
}

fn write_resources(loaded: &LoadedCase, resources: &Path) {
    std::fs::create_dir_all(resources).unwrap();
    std::fs::write(resources.join("case.json"), enmm_fmi::resource::encode(loaded, "case").unwrap()).unwrap();
}

/// Status and category of the messages that tell of an energy from nowhere.
pub fn doubts(lines: Vec<Line>) -> Vec<(Status, String)> {
    let told = lines.into_iter().filter(|line| line.2.contains(": the energy residual is "));
    told.map(|(status, category, _)| (status, category)).collect()
}

/// Asserts that the library next to this test exports these functions of the standard, so many, and nothing else.
#[cfg(target_os = "linux")]
pub fn assert_exports(standard: &str, count: usize, functions: &str) {
    let here = std::env::current_exe().unwrap();
    let places = here.ancestors().skip(1).take(2).map(|folder| folder.join(format!("libenmm_{standard}.so")));
    let library = places.into_iter().find(|path| path.exists()).expect("the library is built with its tests");
    let listed = std::process::Command::new("nm").args(["-D", "--defined-only"]).arg(library).output().unwrap();
    assert!(listed.status.success());
    let text = String::from_utf8(listed.stdout).unwrap();
    let mut names: Vec<&str> = text.lines().filter_map(|line| line.split_whitespace().nth(2)).collect();
    names.sort_unstable();
    let mut expected: Vec<String> = functions.split_whitespace().map(|name| format!("{standard}{name}")).collect();
    expected.sort_unstable();
    assert_eq!((names.len(), names), (count, expected.iter().map(String::as_str).collect()));
}
