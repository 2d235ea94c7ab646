//! The models: two blocks, and fifty.

use std::path::Path;

use enmm_io::{LoadedCase, parse_case};

/// A block on an incline, which slides.
const INCLINE: &str = include_str!("../../../../examples/cases/block_on_incline.toml");

/// Fifty blocks in five courses, which rest.
const WALL: &str = r#"
title = "Fifty blocks"
domain.outline = [[0, 0], [20, 0], [20, 5], [0, 5]]
mesh = { size = 0.7, angle_deg = 7 }
rock.rock = { density = 2600, young = 5e9, poisson = 0.25 }
joint_law.joint.friction_deg = 35
fix = [{ edge = [[0, 0], [20, 0]] }]
port = [{ name = "block", block = [1, 4.5] }]
stage = [
    { name = "settle", kind = "static", duration = 5.0 },
    { name = "rest", kind = "dynamic", duration = 1e6, damping = 0.1 },
]
"#;

/// A case with its text.
pub struct Model {
    pub name: &'static str,
    pub text: &'static str,
    pub loaded: LoadedCase,
}

/// Both models.
pub fn models() -> [Model; 2] {
    let wall: &'static str = Box::leak(with_joints().into_boxed_str());
    [("two blocks", INCLINE), ("fifty blocks", wall)].map(|(name, text)| {
        let loaded = parse_case(text, "case", Path::new("")).expect("a case");
        Model { name, text, loaded }
    })
}

/// The wall with its nine upright and four level joints.
fn with_joints() -> String {
    let upright = (1..10).map(|k| format!("[[joint]]\npoints = [[{x}, -1], [{x}, 6]]\n", x = 2 * k));
    let level = (1..5).map(|k| format!("[[joint]]\npoints = [[-1, {k}], [21, {k}]]\n"));
    upright.chain(level).fold(WALL.to_owned(), |text, joint| text + &joint)
}
