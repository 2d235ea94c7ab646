//! A slope that fails: no block goes into another, by an audit of polygons that knows nothing of contacts.

use crate::common::loose::{SIZE, small_slope};
use crate::common::parts::{dynamic, rock};
use crate::common::{run_stage, simulation};
use enmm::model::overlap::Audit;

/// Impacts press blocks together and corners that meet tip on tip sink in by a few hundredths of the mesh size before
/// they part: the limit of the whole run is 0.05, which a node that passes a side unseen exceeds at once.
#[test]
fn a_failing_slope_overlaps_by_little() {
    let mut simulation = simulation(&small_slope([36.0, 118.0], [1.5; 2], [11, 12], 45.0));
    let report = run_stage(&mut simulation);
    assert!(simulation.at_rest(&report), "the slope must settle: {report:?}");
    assert!(simulation.next_stage().expect("a stage"));
    let overlaps = Audit::new(&simulation);
    let (mut worst, mut k, mut speed) = (0.0f64, 0u64, 0.0f64);
    while !simulation.stage_is_over(None) {
        let report = simulation.advance(k.is_multiple_of(50)).unwrap_or_else(|e| panic!("{e}"));
        speed = speed.max(report.speed_max);
        if k.is_multiple_of(50) {
            worst = worst.max(overlaps.deepest(&simulation).depth);
        }
        k += 1;
    }
    let end = overlaps.deepest(&simulation);
    println!("{} blocks, {speed} m/s, overlap {worst:e} m, {end:?}", simulation.model().covers.block_count());
    println!("{:?}", simulation.state().counters);
    assert!(speed > 3.0, "the slope must fail: {speed} m/s");
    assert!(worst < 0.05 * SIZE, "overlap {worst:e} m");
}

/// Cracks inside a block are loops of their own. Taken for parts of the outline, they gave a base rock in its notch.
#[test]
fn cracks_inside_a_block_make_no_overlap() {
    let cracks = ["[[1.0, 0.5], [1.4, 1.5]]", "[[4.6, 1.5], [5.0, 0.5]]"];
    for [first, second] in [cracks, [cracks[1], cracks[0]]] {
        let mut simulation = simulation(&format!(
            "title = \"notch\"\n[domain]\noutline = [[0.0, -2.0], [6.0, -2.0], [6.0, 2.0], [4.0, 2.0], [4.0, 0.0], \
             [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]\nislands = [[[2.5, 0.0], [3.5, 0.0], [3.5, 0.8], [2.5, 0.8]]]\n\
             [mesh]\nsize = 0.5\n[[joint]]\npoints = {first}\n[[joint]]\npoints = {second}\n\
             [joint_law.joint]\nfriction_deg = 30.0\n[[fix]]\nblock = [3.0, -1.0]\n{}{}",
            rock(5e9, 2650.0),
            dynamic("rest", 1.0, 0.1)
        ));
        simulation.advance(false).expect("a step");
        let overlap = Audit::new(&simulation).deepest(&simulation);
        assert!(overlap.depth < 1e-6, "{first}, {second}: {overlap:?}");
    }
}
