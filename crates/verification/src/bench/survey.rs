//! What is aimed at, and what programs reach that are not timed beside this one (`peers` times those that are), as the
//! project's performance survey found on one core of its machine (server EPYC, AVX-512, two virtual cores).

use super::Model;

/// Where the figures come from.
pub const SOURCE: &str = "Figures of others and goals are those of the project's performance survey, taken on one \
core of the same kind\nof machine at another time: its clock drifts by a third, so that only ratios within one run \
are exact.\n`cargo xtask bench --peers` times Rapier, Box2D and a Numba kernel in one run with enmm.";

/// Head of the table of elements.
pub const ELEMENT_HEAD: [&str; 8] = ["model", "enmm", "goal", "tight kernel", "Warp", "Akantu", "OpenSees", "Kratos"];
/// Million updates per second by elements, in the order of the head.
const ELEMENT_RATES: [(usize, [f64; 6]); 3] = [
    (10_000, [450.0, 552.0, 166.0, 6.6, 2.5, 2.0]),
    (100_000, [450.0, 516.0, 211.0, 6.2, 1.25, 1.9]),
    (1_000_000, [360.0, 422.0, 181.0, 5.3, 1.1, 1.8]),
];

/// Head of the table of slopes.
pub const SLOPE_HEAD: [&str; 6] =
    ["model", "enmm, first second", "enmm, in its windows", "goal", "tight penalty step", "a DDA code"];
/// Blocks of the survey's slopes.
const SLOPE_BLOCKS: [usize; 3] = [548, 2_076, 10_339];
/// Seconds per simulated second by blocks, in the order of the head.
const SLOPE_SECONDS: [[Option<f64>; 3]; 3] =
    [[Some(0.2), Some(0.024), Some(10.0)], [Some(2.2), Some(0.19), Some(112.0)], [Some(97.0), Some(2.2), None]];

/// Million element updates per second of others on a continuum like this one.
pub fn element_rates(model: &Model) -> Option<[f64; 6]> {
    let Model::Continuum(elements) = *model else { return None };
    ELEMENT_RATES.iter().find(|(size, _)| *size == elements).map(|(_, rates)| *rates)
}

/// Seconds of others on a slope like this one.
pub fn slope_seconds(model: &Model) -> Option<[Option<f64>; 3]> {
    let Model::Slope(blocks, 4) = *model else { return None };
    let near = |size: &usize| (*size as f64 / blocks as f64 - 1.0).abs() < 0.12;
    SLOPE_BLOCKS.iter().position(near).map(|k| SLOPE_SECONDS[k])
}

/// Name and points (blocks, seconds per simulated second) of the lines of others.
pub fn slope_lines() -> impl Iterator<Item = (String, Vec<[f64; 2]>)> {
    (0..3).map(|k| {
        let points = SLOPE_BLOCKS.iter().zip(&SLOPE_SECONDS);
        (SLOPE_HEAD[k + 3].to_owned(), points.filter_map(|(&blocks, row)| Some([blocks as f64, row[k]?])).collect())
    })
}
