//! The program in a folder of its own, and cases for it.
#![allow(dead_code)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

/// The example with a wedge on a fault, which bolts hold.
pub const ROAD_CUT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/cases/road_cut.toml");

/// A folder that goes away, with the case in it.
pub struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    pub fn with(case: &str) -> Self {
        let place = Self { folder: tempfile::tempdir().expect("a folder") };
        fs::write(place.path("case.toml"), case).expect("written");
        place
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn names(&self) -> Vec<String> {
        self.names_in(".")
    }

    pub fn names_in(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(folder)).expect("a folder");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8")).collect();
        names.sort();
        names
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_enmm"));
        command.args(arguments).current_dir(self.folder.path());
        command
    }

    pub fn enmm(&self, arguments: &[&str]) -> Outcome {
        Outcome::of(self.command(arguments).output().expect("the program runs"))
    }

    /// Output of the program, which must end with this status.
    #[track_caller]
    pub fn answers(&self, status: i32, arguments: &[&str]) -> Outcome {
        let answer = self.enmm(arguments);
        assert_eq!(answer.status, Some(status), "{arguments:?}: {answer:?}");
        answer
    }

    /// The program, whose standard input the test holds.
    pub fn start_held(&self, arguments: &[&str]) -> Child {
        self.command(arguments).stdin(Stdio::piped()).spawn().expect("the program runs")
    }

    pub fn start(&self, arguments: &[&str]) -> Child {
        let mut command = self.command(arguments);
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program runs")
    }
}

/// Output of the program.
#[derive(Debug)]
pub struct Outcome {
    pub status: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Outcome {
    pub fn of(output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
        Self { status: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
    }

    /// The output as one JSON object.
    pub fn json(&self) -> serde_json::Value {
        serde_json::from_str(self.stdout.trim()).unwrap_or_else(|error| panic!("{error}: {self:?}"))
    }

    /// Asserts that the output has all `parts`.
    pub fn assert_printed(&self, parts: &[&str]) {
        for part in parts {
            assert!(self.stdout.contains(part), "{part:?} is not in {}", self.stdout);
        }
    }

    /// Asserts a status of 2 and one line that begins with `error: ` and has all `parts`; warnings may stand above it.
    pub fn assert_bad_input(&self, parts: &[&str]) {
        assert_eq!(self.status, Some(2), "{self:?}");
        let errors: Vec<&str> = self.stderr.lines().skip_while(|line| line.starts_with("warning: ")).collect();
        assert_eq!(errors.len(), 1, "{self:?}");
        assert!(errors[0].starts_with("error: "), "{self:?}");
        for part in parts {
            assert!(errors[0].contains(part), "{part:?} is not in {self:?}");
        }
    }
}

pub fn json(path: &Path) -> serde_json::Value {
    serde_json::from_str(&fs::read_to_string(path).expect("readable")).expect("JSON")
}

/// A block that rests on a base, then slides while a second one is taken away.
pub fn case(duration: f64) -> String {
    format!(
        r#"
title = "Two blocks"
[domain]
outline = [[0, 0], [6, 0], [6, 1], [5, 1], [5, 2], [4, 2], [4, 1], [2, 1], [2, 2], [1, 2], [1, 1], [0, 1]]
[mesh]
size = 0.6
origin = [0.07, 0.03]
[[joint]]
points = [[1, 1], [2, 1]]
law = "plane"
[[joint]]
points = [[4, 1], [5, 1]]
law = "plane"
[rock.granite]
density = 2600
young = 1e9
poisson = 0.25
[joint_law.plane]
friction_deg = 20
[[fix]]
block = [3, 0.5]
[[load]]
kind = "block"
point = [1.5, 1.5]
force = [100, 0]
[[monitor]]
name = "top"
point = [1.5, 1.9]
[[stage]]
name = "rest"
kind = "static"
duration = 0.2
[[stage]]
name = "slide"
kind = "dynamic"
duration = {duration:?}
excavate = [[4.5, 1.5]]
[[stage.law]]
law = "plane"
friction_deg = 0.1
"#
    )
}

/// A block of 1 m × 1 m on a plane that rises by 1 in 2 (tan a = 0.5), with friction tan φ = `tangent`, and what comes
/// after its static stage.
pub fn incline(tangent: f64, more: &str) -> String {
    let friction = tangent.atan().to_degrees();
    format!(
        r#"
title = "Block on an incline"
[domain]
outline = [[0, -1], [8, -1], [8, 0], [4, 2], [4.4, 2.8], [3.2, 3.4], [2.8, 2.6], [0, 4]]
[mesh]
size = 0.9
origin = [0.07, 0.03]
[[joint]]
points = [[4, 2], [2.8, 2.6]]
[rock.rock]
density = 2600
young = 1e9
poisson = 0.25
[joint_law.plane]
friction_deg = {friction}
[[fix]]
block = [1, 0]
[[stage]]
name = "rest"
kind = "static"
duration = 5.0
{more}"#
    )
}
