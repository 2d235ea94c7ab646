//! The example cases that show claims parse, build and run, and show what their comments say.

mod common;

use std::path::Path;

use common::run_all;
use enmm::model::Simulation;

/// The simulation of `examples/cases/NAME.toml`.
fn example(name: &str) -> Simulation {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/cases").join(format!("{name}.toml"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let loaded = enmm::io::parse_case(&text, name, path.parent().expect("a folder")).unwrap_or_else(|e| panic!("{e}"));
    Simulation::new(loaded.case).unwrap_or_else(|e| panic!("{e}"))
}

/// 0.906407 m at 1 s; the rock of 10 GPa rings a little more than that of the claim test: 5e-4.
#[test]
fn the_block_slides_as_its_comment_says() {
    let mut simulation = example("block_on_incline");
    common::run_stage(&mut simulation);
    assert!(simulation.next_stage().expect("a stage"));
    let start = simulation.monitor(0).0;
    common::run_stage(&mut simulation);
    let time = simulation.time() - simulation.state().stage_start;
    let way = (simulation.monitor(0).0 - start).norm();
    assert!((way / (0.906407 * time * time) - 1.0).abs() < 5e-4, "{way}");
}

/// 15.97188 mm within 1 %: the bending error of 16 rows and the dents of the supports.
#[test]
fn the_beam_sags_as_its_comment_says() {
    let mut simulation = example("simply_supported_beam");
    run_all(&mut simulation);
    let sag = -simulation.monitor(0).0.y;
    assert!((sag / 15.97188e-3 - 1.0).abs() < 1e-2, "{sag}");
}

/// The middle column topples by metres, the highest stays within centimetres.
#[test]
fn the_columns_topple_as_their_comment_says() {
    let mut simulation = example("goodman_bray");
    run_all(&mut simulation);
    let [toe, middle, top] = [0, 1, 2].map(|k| simulation.monitor(k).0.norm());
    assert!(toe > 1.0 && middle > 1.0 && top < 0.05, "{toe} {middle} {top}");
}

/// Settlement of the top is that of its weight; it moves no more in the second half of the rest.
#[test]
fn the_wall_rests_as_its_comment_says() {
    let mut simulation = example("masonry_wall");
    common::run_stage(&mut simulation);
    assert!(simulation.next_stage().expect("a stage"));
    let half = simulation.steps_in(5.0);
    common::claims::advance(&mut simulation, half);
    let before = simulation.monitor(0).0;
    let report = common::claims::advance(&mut simulation, half);
    assert!((simulation.monitor(0).0 - before).norm() < 1e-6 && report.penetration_max < 1e-3, "{report:?}");
}

/// Its bolts are put in with 350 kN a bar; the rock gives a fraction of a millimetre, and nothing slips.
#[test]
fn the_wedge_rests_on_its_bolts() {
    let mut simulation = example("plane_slide");
    let reports = run_all(&mut simulation);
    assert_eq!(reports.len(), 2);
    assert!(reports.iter().all(|report| report.unbalanced < 1e-5), "{reports:?}");
}

/// It starts from rest under its joints of Barton and Bandis; the wave takes 60 ms to the crest, which is 50 m at
/// 877 m/s. The slope still moves as its base does, for the record has hardly begun.
#[test]
fn the_slope_begins_to_shake_as_its_comment_says() {
    let mut simulation = example("shaken_slope");
    common::run_stage(&mut simulation);
    assert!(simulation.next_stage().expect("a stage"));
    let start = [0, 2].map(|k| simulation.monitor(k).0);
    let steps = simulation.steps_in(1.5);
    common::claims::advance(&mut simulation, steps);
    let [crest, base] = [(0, start[0]), (2, start[1])].map(|(k, before)| (simulation.monitor(k).0 - before).x);
    assert!(base.abs() > 1e-4 && (crest - base).abs() < 0.5 * base.abs(), "{crest} {base}");
}
