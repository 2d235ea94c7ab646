//! Claim: what is found of water in joints hangs on none of the small numbers by which it is told from round-off:
//! halving and doubling each changes nothing.

use crate::common::{example, simulation};
use enmm::model::Simulation;
use enmm::model::tables::Facings;

/// A plate, 100 m by 30 m, with a level joint between two heads, an isolated joint of a length (m) and what else.
fn plate(heads: [f64; 2], alone: f64, more: &str) -> String {
    let [left, right] = heads;
    format!(
        "title = \"plate\"\n[domain]\noutline = [[0, 0], [100, 0], [100, 30], [0, 30]]\n[mesh]\nsize = 3.0\n\
         origin = [0.131, 0.077]\n[[joint]]\npoints = [[0, 10], [100, 10]]\n[[joint]]\n\
         points = [[40, 20], [{:?}, 20]]\n[rock.rock]\ndensity = 2600\nyoung = 1e10\npoisson = 0.25\n\
         [joint_law.joint]\nfriction_deg = 40\n[[fix]]\nedge = [[0, 0], [100, 0]]\n[flow]\naperture = 1e-4\n[[head]]\n\
         name = \"left\"\nedge = [[0, 0], [0, 30]]\n\
         level = {left:e}\n[[head]]\nname = \"right\"\nedge = [[100, 0], [100, 30]]\nlevel = {right:e}\n{more}\
         [[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 1.0\n",
        40.0 + alone
    )
}

fn is_told(simulation: &Simulation, text: &str) -> bool {
    simulation.built().warnings.iter().any(|warning| warning.contains(text))
}

/// Overlaps of faces are pieces from a millionth of an edge on. All overlaps of the examples are above twice that, or
/// below half of it.
#[test]
fn half_and_twice_the_sliver_give_the_same_nets() {
    for name in ["fractured_slope", "road_cut", "toppling", "pit", "../flow/seepage_slide", "../flow/drained_bench"] {
        let model = simulation(&example(name));
        let boundary = &model.model().boundary;
        let Facings { pieces, same, .. } = Facings::of(boundary, &model.built().traces);
        let share = |span: [f64; 2]| (span[1] - span[0]).abs();
        let least = pieces.iter().map(|piece| piece.spans.map(share).into_iter().fold(0.0, f64::max));
        let least = least.fold(f64::INFINITY, f64::min);
        let long = |edge| (boundary.reference[boundary.after(edge)] - boundary.reference[edge]).norm();
        let shortest = boundary.edges().map(long).fold(f64::INFINITY, f64::min);
        let apart = same.iter().map(|[a, b]| (b - a).norm()).fold(0.0, f64::max);
        println!("{name}: least share {least:.1e}, greatest joined {:.1e} of the shortest edge", apart / shortest);
        assert!(least > 2e-6 && apart < 0.5e-6 * shortest, "{name}: {least} {apart} {shortest}");
    }
}

/// 1e-9 m: heads of the same number are equal whatever rounding has done, and heads that a user sets apart are not.
#[test]
fn half_and_twice_the_difference_of_equal_heads_tell_the_same() {
    let still = "all heads are equal and no water flows";
    for (apart, equal) in [(0.0, true), (4e-15, true), (0.4e-9, true), (2.1e-9, false), (1e-6, false)] {
        let model = simulation(&plate([25.0, 25.0 + apart], 5.0, ""));
        assert_eq!(is_told(&model, still), equal, "{apart}");
    }
}

/// A twentieth of all joints may be isolated, by their length as they are cut: shares of half and of twice that are
/// told alike, and so are those close to it.
#[test]
fn isolated_joints_are_told_from_a_twentieth_on() {
    let mut close = [false; 2];
    for alone in [2.0, 4.0, 5.0, 5.5, 6.0, 7.0, 8.0, 12.0, 20.0] {
        let model = simulation(&plate([25.0, 20.0], alone, ""));
        let survey = model.flow_survey().expect("a net");
        let share = survey.isolated / survey.length;
        let told = is_told(&model, "meet neither a head nor an outcrop");
        println!("{alone} m: {share:.4} {told}");
        assert_eq!(told, share > 0.05, "{alone} m: {share}");
        close[usize::from(told)] |= (0.035..0.07).contains(&share);
    }
    assert_eq!(close, [true; 2]);
}

/// A pump that takes all that arrives, to rounding, does not run dry; one that wants more than that does.
#[test]
fn half_and_twice_the_share_of_a_dry_pump_tell_the_same() {
    let transmissivity = 9810.0 * 1e-12 / 12e-3;
    let supply = transmissivity * 10.0 * (1.0 / 50.0 + 1.0 / 50.0);
    for (off, dry) in [(-1e-3, false), (-1e-8, false), (-1e-14, false), (0.4e-9, false), (2.1e-9, true), (1e-3, true)] {
        let pump = supply * (1.0 + off);
        let well = format!("[[drain]]\nname = \"well\"\npoints = [[50, 15], [50, 5]]\npump = {pump:e}\n");
        let model = simulation(&plate([20.0, 20.0], 5.0, &well));
        assert_eq!(!model.dry_drains().is_empty(), dry, "{off}: {:?}", model.dry_drains());
    }
}

/// An outcrop seeps from a billionth of the flow on: below is the round-off of flows, above what a joint brings.
#[test]
fn half_and_twice_the_share_of_a_seeping_outcrop_tell_the_same() {
    for (share, seeps) in [(1e-15, false), (0.4e-9, false), (2.1e-9, true), (1e-6, true)] {
        // Three times the drop drives the wide joint, and flow goes with the cube of the aperture.
        let aperture = 1e-4 * f64::cbrt(3.0 * share);
        let tight = format!(
            "[[joint]]\npoints = [[0, 20], [100, 20]]\nlaw = \"tight\"\n[joint_law.tight]\nfriction_deg = 40\n\
             aperture = {aperture:e}\n"
        );
        // The isolated joint of the plate lies on another height.
        let text = plate([25.0, 5.0], 5.0, &tight)
            .replace("[[40, 20], [45.0, 20]]", "[[40, 25], [45, 25]]")
            .replace("[mesh]", "joint_law = \"joint\"\n[mesh]");
        let model = simulation(&text);
        assert_eq!(model.joint_flow().seepage_height, if seeps { 20.0 } else { 10.0 }, "{share}");
    }
}

/// Transmissivities may differ by 1e12: a warning alone hangs on it.
#[test]
fn contrasts_are_told_from_1e12_on() {
    for (contrast, told) in [(1e9, false), (0.45e12, false), (2.2e12, true), (1e15, true)] {
        let aperture = 1e-2 / f64::cbrt(contrast);
        let tight = format!(
            "[[joint]]\npoints = [[0, 15], [100, 15]]\nlaw = \"tight\"\n[joint_law.tight]\nfriction_deg = 40\n\
             aperture = {aperture:e}\n"
        );
        let text = plate([25.0, 20.0], 5.0, &tight)
            .replace("[flow]\naperture = 1e-4", "[flow]\naperture = 1e-2")
            .replace("[mesh]", "joint_law = \"joint\"\n[mesh]");
        assert_eq!(is_told(&simulation(&text), "transmissivities that differ by a factor of"), told, "{contrast}");
    }
}
