//! Claim: the default stiffness of joints is a property of the rock: jointed rock settles alike on any mesh of at
//! most a metre.

use crate::common::{run_stage, simulation};

const YOUNG: f64 = 1e9;
const POISSON: f64 = 0.25;
const DENSITY: f64 = 2500.0;
const BLOCKS: u32 = 5;

/// Blocks of 1 m on each other, without friction on what stands.
fn column(size: f64) -> String {
    let joints: String = (1..BLOCKS).map(|y| format!("[[joint]]\npoints = [[0, {y}], [1, {y}]]\n")).collect();
    format!(
        "title = \"column\"\n[domain]\noutline = [[0, 0], [1, 0], [1, {BLOCKS}], [0, {BLOCKS}]]\n[mesh]\n\
         size = {size}\nangle_deg = 8\norigin = [0.0137, 0.0071]\n{joints}[rock.rock]\ndensity = {DENSITY}\n\
         young = {YOUNG:e}\npoisson = {POISSON}\n[joint_law.joint]\nfriction_deg = 35\n[[fix]]\n\
         edge = [[0, 0], [1, 0]]\naxes = \"y\"\n[[fix]]\npoint = [0.5, 0.0]\naxes = \"x\"\n[[stage]]\n\
         name = \"settle\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-6\n[[monitor]]\nname = \"top\"\n\
         point = [0.5, {BLOCKS}]\n"
    )
}

/// Settlement of the top (m): the rock shortens by ½γH²(1 − ν²)/E, and the joint under each block by its load over the
/// joint's stiffness. On the coarsest mesh a block stands on two or three nodes and bends between them: 10 % more, then
/// 3 %, then less than 1 %. A stiffness that goes as 1/h gives half the settlement on the finest mesh.
#[test]
fn a_column_settles_alike_on_any_mesh() {
    let weight = DENSITY * 9.81;
    let height = f64::from(BLOCKS);
    let rock = 0.5 * weight * height * height * (1.0 - POISSON * POISSON) / YOUNG;
    let confined = YOUNG * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
    let load: f64 = (1..BLOCKS).map(|blocks| f64::from(blocks) * weight).sum();
    let exact = rock + load / (0.6 * confined);
    let settlements = [1.0, 0.5, 0.25].map(|size| {
        let mut simulation = simulation(&column(size));
        let report = run_stage(&mut simulation);
        assert!(simulation.at_rest(&report), "{size}: {report:?}");
        -simulation.monitor(0).0.y
    });
    println!("{settlements:?}, exact {exact}");
    for (settlement, tolerance) in settlements.into_iter().zip([0.12, 0.04, 0.01]) {
        assert!((settlement / exact - 1.0).abs() < tolerance, "{settlements:?}, exact {exact}");
    }
}
