//! A box on a base as an FMU, for the tests of both versions.

use std::path::{Path, PathBuf};

use enmm_fmi::log::Status;
use enmm_fmi::table::{Table, Version};
use enmm_io::{LoadedCase, parse_case};

/// The case of the box.
pub const BOX: &str = include_str!("box.toml");

/// Status, category and text of a message.
pub type Line = (Status, String, String);

/// Resources and table of an FMU of a version of FMI.
pub struct Fmu<const FMI: u8> {
    folder: tempfile::TempDir,
    pub table: Table,
}

impl<const FMI: u8> Fmu<FMI> {
    pub fn of(text: &str) -> Self {
        let version = if FMI == 2 { Version::Two } else { Version::Three };
        let loaded = parse_case(text, "box.toml", Path::new(".")).unwrap();
        let folder = tempfile::tempdir().unwrap();
        write_resources(&loaded, &folder.path().join("resources"));
        let blocks = loaded.cosimulation().unwrap().blocks_max();
        let table = Table::new(&loaded.case, blocks, &loaded.hash, version);
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
