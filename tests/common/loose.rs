//! Blocks that move over a base, and small slopes that fail.

use enmm::model::Simulation;

use super::parts::{dynamic, rock, turn};
use super::simulation;

/// Mesh size (m) and gravity (m/s²).
pub const SIZE: f64 = 1.0;
pub const G: f64 = 9.81;
/// A level base.
pub const FLAT: &str = "[[0.0, -1.0], [12.0, -1.0], [12.0, 0.0], [0.0, 0.0]]";

/// Loose blocks (`islands`) over a held base, with further text: rock and stages.
pub fn loose_blocks(base: &str, islands: &str, friction_deg: f64, more: &str) -> Simulation {
    simulation(&format!(
        "title = \"loose blocks\"\n[domain]\noutline = {base}\nislands = {islands}\n[mesh]\nsize = {SIZE}\n\
         origin = [0.137, 0.071]\n[joint_law.joint]\nfriction_deg = {friction_deg:?}\n[[fix]]\nblock = [0.1, -0.9]\n\
         {more}"
    ))
}

/// An initial velocity of the block at a point.
pub fn thrown(point: [f64; 2], velocity: [f64; 2]) -> String {
    format!("[[initial_velocity]]\nblock = {point:?}\nvelocity = {velocity:?}\n")
}

/// Corners of a square of 1 m that stands on one of them, turned by an angle.
pub fn square([x, y]: [f64; 2], turn_deg: f64) -> Vec<[f64; 2]> {
    let corners = turn(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], turn_deg);
    corners.iter().map(|p| [x + p[0], y + p[1]]).collect()
}

/// A slope of 15 m in some 100 blocks by two sets of joints, at rest under a friction, then failing by one of 15°.
pub fn small_slope(dips: [f64; 2], spacings: [f64; 2], seeds: [u64; 2], friction_deg: f64) -> String {
    let set = |k: usize| {
        format!(
            "[[joint_set]]\nangle_deg = {}\ndip_sd_deg = {}\nspacing = {}\nspacing_sd = 0.3\nseed = {}\n\
             region = [[13.0, 4.0], [24.0, 20.5], [38.0, 20.5]]\n",
            dips[k],
            [1.5, 3.0][k],
            spacings[k],
            seeds[k],
        )
    };
    format!(
        "title = \"small slope\"\n[domain]\noutline = [[0.0, 0.0], [40.0, 0.0], [40.0, 20.0], [24.0, 20.0], \
         [14.0, 5.0], [0.0, 5.0]]\n[mesh]\nsize = {SIZE}\nangle_deg = 7.0\n[[joint]]\npoints = [[12.0, 4.0], \
         [39.0, 21.0]]\n{}{}[joint_law.joint]\nfriction_deg = {friction_deg:?}\n{}[[fix]]\n\
         edge = [[0.0, 0.0], [40.0, 0.0]]\n[[stage]]\nname = \"gravity\"\nkind = \"static\"\nduration = 6.0\n{}\
         [[stage.law]]\nlaw = \"joint\"\nfriction_deg = 15\n",
        set(0),
        set(1),
        rock(5e9, 2650.0),
        dynamic("failure", 1.5, 0.1)
    )
}
