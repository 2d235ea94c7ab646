//! A valid case and edits of it, for the tests of reading.
#![allow(dead_code)]

use std::path::Path;

use enmm_io::{LoadedCase, load_case, parse_case};

/// A valid case with most tables; tests change a line of it. Line numbers count from 1.
pub const CASE: &str = r#"title = "Two blocks on a slope"

[domain]
outline = [[0.0, 0.0], [10.0, 0.0], [10.0, 5.0], [0.0, 5.0]]
holes = [[[1.0, 1.0], [2.0, 1.0], [2.0, 2.0]]]
joint_law = "clean"

[mesh]
size = 1.0
angle_deg = 15
origin = [0.5, 0.25]

[[joint]]
points = [[0.0, 2.0], [10.0, 3.0]]

[[joint]]
points = [
    [5.0, 0.0],
    [5.0, 5.0],
]
law = "rough"

[[joint_set]]
angle_deg = 60
dip_sd_deg = 2.0
spacing = 2.0
spacing_sd = 0.1
trace_length = 4.0
trace_length_sd = 1.0
gap = 0.5
bridge_law = "rough"
seed = 7
region = [[0.0, 0.0], [10.0, 0.0], [10.0, 5.0]]

[rock.granite]
density = 2650
young = 5e10
poisson = 0.25

[rock.marl]
density = 2200.0
young = 1e9
poisson = 0.3
plane = "stress"
region = [[0.0, 0.0], [10.0, 0.0], [10.0, 2.0]]
blocks = [[9.0, 1.0]]

[joint_law.clean]
friction_deg = 35.0

[joint_law.rough]
kind = "mohr_coulomb"
friction_deg = 40.0
cohesion = 1e4
tension = 1e3

[gravity]
x = 0.0
y = -9.81

[[fix]]
name = "base"
edge = [[0.0, 0.0], [10.0, 0.0]]
stiffness = 1e12

[[fix]]
name = "wedge"
box = [0.0, 0.0, 1.0, 5.0]
axes = "x"

[[fix]]
point = [3.0, 3.0]

[[load]]
name = "anchor"
kind = "point"
point = [5.0, 5.0]
force = [0.0, -1e4]
table = [[0.0, 0.0], [1.0, 1.0]]

[[load]]
kind = "pressure"
edge = [[0.0, 5.0], [10.0, 5.0]]
pressure = 1e4

[in_situ]
sxx = -1e6
syy = -2e6
y_reference = 5.0

[[stage]]
name = "settle"
kind = "static"
duration = 10.0
convergence = 1e-4
ramp = 1.0

[[stage]]
name = "slide"
kind = "dynamic"
duration = 5.0
damping = 0.05
free = ["wedge"]
excavate = [[9.0, 4.0]]
excavate_region = [[0.0, 4.0], [1.0, 4.0], [1.0, 5.0]]

[[stage.law]]
law = "clean"
friction_deg = 20.0
cohesion = 0.0
tension = 0.0

[[stage.switch_law]]
from = "rough"
to = "clean"

[[monitor]]
name = "crest"
point = [5.0, 5.0]

[output]
frame_interval = 0.5

[solver]
dt_safety = 0.8
sweeps_max = 12
memory_limit = 1000000000

[rock.mass]
density = 2600.0
young = 5e9
poisson = 0.25
hoek_brown = { sigma_ci = 50e6, mi = 10.0, gsi = 45.0, d = 0.7, associated = true }
blocks = [[1.0, 4.0]]
"#;

/// Returns the valid case with `from` replaced by `to`; `from` must occur.
pub fn edited(from: &str, to: &str) -> String {
    assert!(CASE.contains(from), "{from:?} is not in the case");
    CASE.replacen(from, to, 1)
}

/// Returns the message about a text that must be refused.
pub fn error_of(text: &str) -> String {
    match parse_case(text, "slope.toml", Path::new("")) {
        Ok(_) => panic!("the case was accepted:\n{text}"),
        Err(error) => error.to_string(),
    }
}

/// Checks that the valid case with `from` replaced by `to` is refused with exactly this message.
#[track_caller]
pub fn assert_refused(from: &str, to: &str, message: &str) {
    let text = edited(from, to);
    let line = |part: &str| 1 + CASE[..CASE.find(part).unwrap()].matches('\n').count();
    assert_eq!(error_of(&text), format!("slope.toml:{}", message.replace("LINE", &line(from).to_string())));
}

/// Returns a case without outline and joints of its own that reads `geometry` from a file called `name`, and the error
/// text with the folder removed.
pub fn with_geometry(name: &str, geometry: &str) -> Result<LoadedCase, String> {
    with_geometry_and(name, geometry, "")
}

/// As [`with_geometry`], with more keys in `[domain]`.
pub fn with_geometry_and(name: &str, geometry: &str, domain: &str) -> Result<LoadedCase, String> {
    let folder = tempfile::tempdir().unwrap();
    let case = format!(
        r#"title = "From a file"
[domain]
geometry_file = "{name}"
{domain}
[mesh]
size = 1.0
[rock.granite]
density = 2650
young = 5e10
poisson = 0.25
[joint_law.clean]
friction_deg = 35.0
[[stage]]
name = "fall"
kind = "dynamic"
duration = 1.0
"#
    );
    std::fs::write(folder.path().join(name), geometry).unwrap();
    std::fs::write(folder.path().join("case.toml"), case).unwrap();
    let prefix = format!("{}/", folder.path().display());
    match load_case(&folder.path().join("case.toml")) {
        Ok(mut loaded) => {
            loaded.warnings.iter_mut().for_each(|warning| *warning = warning.replace(&prefix, ""));
            Ok(loaded)
        }
        Err(error) => Err(error.to_string().replace(&prefix, "")),
    }
}
