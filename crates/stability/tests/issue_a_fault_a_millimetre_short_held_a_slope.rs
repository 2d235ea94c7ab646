//! A fault that was drawn 0.3 mm short of the face raised the factor of safety from 1.09 to 2.6 without a word: a rest
//! of elastic rock cannot break, however thin it is.

use crate::common::case;
use enmm::geometry::ends::EndChange;
use enmm::model::Simulation;
use enmm_stability::limit_analysis::bound;

/// A wedge on a fault that begins at the face, moved along its normal into the rock by a distance (m).
fn slope(inside: f64) -> String {
    let face = 8f64.hypot(20.0);
    let (x, y) = (0.8 + inside * 20.0 / face, 2.0 - inside * 8.0 / face);
    format!(
        "title = \"t\"\n[domain]\noutline = [[-15, -8], [40, -8], [40, 20], [8, 20], [0, 0], [-15, 0]]\n\
         joint_law = \"joints\"\n[mesh]\nsize = 2.0\n[[joint]]\npoints = [[{x:?}, {y:?}], [16.0, 11.49801]]\n\
         law = \"fault\"\n[[joint]]\npoints = [[16.0, 11.49801], [16.0, 20.0]]\n[rock.gneiss]\ndensity = 2650\n\
         young = 20e9\npoisson = 0.25\n[joint_law.joints]\nfriction_deg = 35\n[joint_law.fault]\nfriction_deg = 30\n\
         [[fix]]\nedge = [[-15, -8], [40, -8]]\n[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 10\n"
    )
}

fn factor(text: &str) -> f64 {
    bound(&case(text)).expect("a bound").level_tops.factor.value()
}

#[test]
fn the_bound_does_not_hang_on_a_millimetre() {
    let drawn = factor(&slope(0.0));
    for inside in [0.28e-3, 1.4e-3, 28e-3, 0.12] {
        let text = slope(inside);
        let found = factor(&text);
        assert!((found / drawn - 1.0).abs() < 0.015, "{inside} m inside: {found} instead of {drawn}");
        let simulation = Simulation::new(case(&text)).expect("builds");
        let [end] = &simulation.built().ends[..] else { panic!("{:?}", simulation.built().ends) };
        assert_eq!((end.name.as_str(), end.change), ("joint[0]", EndChange::Extended));
        assert!(end.gap > inside && end.gap < 2.0 * inside, "{} m", end.gap);
        let notes = &simulation.built().notes;
        assert!(notes.iter().any(|note| note.contains("joint[0] at (0.") && note.contains("mm to the outline")));
    }
}

#[test]
fn what_is_drawn_stays_on_request_and_is_noted() {
    let drawn = slope(28e-3).replace("joint_law = \"joints\"", "joint_law = \"joints\"\nextend_ends = 0");
    assert!(bound(&case(&drawn)).is_err(), "one block, which is held");
    for (text, place) in [(drawn, "joint[0] ends 0.047 m inside the outline"), (slope(0.6), "joint[0] ends 1.0")] {
        let simulation = Simulation::new(case(&text)).expect("builds");
        assert_eq!(simulation.built().ends[0].change, EndChange::Kept);
        let notes = &simulation.built().notes;
        assert!(notes.iter().any(|n| n.starts_with(place) && n.contains("cannot break it")), "{notes:?}");
    }
}

#[test]
fn a_fault_that_ends_deep_in_the_rock_stays_without_a_word() {
    let simulation = Simulation::new(case(&slope(4.0))).expect("builds");
    assert_eq!(simulation.built().ends, []);
}
