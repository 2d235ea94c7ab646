//! A valid case and edits of it, for the tests of reading.
#![allow(dead_code)]

use std::path::Path;

use enmm_io::{LoadedCase, load_case, parse_case};

/// A valid case with every numeric key; tests change a line of it. Line numbers count from 1.
pub const CASE: &str = r#"title = "Two blocks on a slope"

[domain]
outline = [[0.0, 0.0], [10.0, 0.0], [10.0, 5.0], [0.0, 5.0]]
holes = [[[1.0, 1.0], [2.0, 1.0], [2.0, 2.0]]]
islands = [[[20.0, 1.0], [22.0, 1.0], [22.0, 2.0]]]
joint_law = "clean"
snap_tolerance = 1e-6

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
normal_stiffness = 1e10
shear_stiffness = 5e9
cohesion = 1e4
tension = 1e3
residual_friction_deg = 30.0
residual_cohesion = 0.0
residual_tension = 0.0
dilation_deg = 5.0
dilation_slip = 0.01
crush = 60e6

[joint_law.bond]
friction_deg = 45.0
cohesion = 2e6
residual_cohesion = 1.0
tension = 1e6
tension_energy = 100.0
shear_energy = 1e4

[[bridge]]
points = [[4.0, 1.0], [4.5, 1.0]]
law = "rough"

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

[[fix]]
block = [4.0, 4.0]

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

[[load]]
kind = "traction"
edge = [[10.0, 0.0], [10.0, 5.0]]
traction = [-1e4, 0.0]

[[load]]
kind = "body"
acceleration = [0.5, 0.0]

[[load]]
kind = "block"
point = [3.0, 3.0]
moment = 10.0

[[load]]
kind = "joint"
edge = [[0.0, 2.0], [10.0, 3.0]]
pressure = 1e4
pressure_end = 5e3

[[base_motion]]
kind = "velocity"
axis = "y"
table = [[0.0, 0.0], [1.0, 0.5]]
scale = 2.0

[[quiet]]
edge = [[0.0, 0.0], [10.0, 0.0]]
axes = "xy"
wave = [0.5, 0.0]
table = [[0.0, 0.0], [1.0, 1.0]]
scale = 2.0

[[free_field]]
edge = [[0.0, 0.0], [0.0, 5.0]]
axes = "x"

[[bolt]]
name = "anchor"
points = [[3.0, 1.2], [3.0, 4.0]]
anchorage = "grouted"
young = 2e11
area = 5e-4
spacing = 2.0
yield_force = 2e5
rupture_strain = 0.1
pretension = 5e4
free_length = 0.2

[[initial_velocity]]
block = [3.0, 3.0]
velocity = [0.1, 0.0]
angular_velocity = 0.2

[in_situ]
sxx = -1e6
syy = -2e6
sxy = 1e5
gradient = [1e4, 2e4, 0.0]
y_reference = 5.0
szz = -1e6
szz_gradient = 1e4

[water]
level = 1.5
density = 1000.0
joints = false
faces = [[[10.0, 0.0], [10.0, 5.0]]]

[[port]]
name = "keystone"
block = [3.0, 3.0]
force = [1e3, 0.0]
moment = 10.0

[[port]]
name = "wall"
boundary = [[10.0, 0.0], [10.0, 5.0]]
traction = [0.0, 1e3]
pressure = 1e3

[[port]]
name = "seam"
joint = [[0.0, 2.0], [10.0, 3.0]]

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
history_interval = 0.01
checkpoint_interval = 5.0

[solver]
communication_step = 0.01
dt_max = 1e-3
dt_safety = 0.8
contact_stiffness = 0.6
shear_ratio = 0.5
contact_theta = 4.0
mass_scaling = 1.0
contact_tolerance = 0.01
friction_delay = 0.01
corner_contacts = "hold"
sweeps_max = 12
penetration_limit = 0.5
implicit_step = 0.01
iterations_max = 8
displacement_ratio = 0.01
failure_displacement = 0.1
memory_limit = 1000000000

[rock.clay]
density = 2000.0
young = 1e8
poisson = 0.3
friction_deg = 25.0
cohesion = 2e4
dilation_deg = 5.0
tension = 1e4
region = [[0.0, 3.0], [10.0, 3.0], [10.0, 5.0]]

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
