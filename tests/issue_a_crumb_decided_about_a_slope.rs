//! A chip of a few square centimetres kept static stages from rest for ever and turned the verdicts of trials.

use crate::common::simulation;
use enmm::geometry::Point;
use enmm::model::Simulation;

use crate::common::pit::PIT;

/// A block of 10 m by 6 m, held at its base, with joints and more.
fn built(joints: &[[[f64; 2]; 2]], more: &str) -> Simulation {
    let joint = |[a, b]: &[[f64; 2]; 2]| format!("[[joint]]\npoints = [{a:?}, {b:?}]\n");
    let joints: String = joints.iter().map(joint).collect();
    let text = format!(
        "title = \"t\"\n[domain]\noutline = [[0, 0], [10, 0], [10, 6], [0, 6]]\n{more}\n\
         {joints}[rock.granite]\ndensity = 2650\nyoung = 50e9\npoisson = 0.25\n[joint_law.j]\nfriction_deg = 30\n\
         [[fix]]\nedge = [[0, 0], [10, 0]]\n[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 2\n"
    );
    simulation(&text)
}

/// Three joints that cross in a triangle with legs of 4 cm, 8 cm² large.
const CROSSING: [[[f64; 2]; 2]; 3] = [[[0.0, 3.0], [10.0, 3.0]], [[5.0, 0.0], [5.0, 6.0]], [[2.0, 6.04], [8.04, 0.0]]];

#[test]
fn a_crumb_joins_a_neighbour() {
    let kept = built(&CROSSING, "[mesh]\nsize = 1.0\nleast_block = 0");
    let simulation = built(&CROSSING, "[mesh]\nsize = 1.0");
    let blocks = |simulation: &Simulation| simulation.model().covers.block_count();
    assert_eq!((blocks(&kept), blocks(&simulation)), (7, 6));
    assert_eq!(kept.built().crumbs, []);
    let [crumb] = simulation.built().crumbs[..] else { panic!("{:?}", simulation.built().crumbs) };
    assert!((crumb.area - 8e-4).abs() < 1e-9 && crumb.joined, "{crumb:?}");
    assert!((crumb.place - Point::new(5.0 + 0.04 / 3.0, 3.0 + 0.04 / 3.0)).norm() < 1e-9, "{crumb:?}");
    let [note] = &simulation.built().notes[..] else { panic!("{:?}", simulation.built().notes) };
    assert!(
        note.starts_with("1 block has less than the least area") && note.contains("8.00e-4 m² at (5.013"),
        "{note}"
    );
}

/// The upright joint is the shortest of the three, 6 m: the crumb joins the block beyond it, and both longer ones stay
/// whole.
#[test]
fn areas_and_masses_stay_and_no_other_joint_goes() {
    let simulation = built(&CROSSING, "[mesh]\nsize = 1.0");
    let covers = &simulation.model().covers;
    let area: f64 = covers.element_area.iter().sum();
    assert!((area - 60.0).abs() < 1e-11, "{area}");
    let block = |x: f64, y: f64| {
        let element = covers.element_near(Point::new(x, y), 0.0).expect("rock");
        covers.element_block[element]
    };
    assert_eq!(block(5.01, 3.01), block(4.9, 3.02), "across the upright joint");
    for (x, y) in [(5.01, 2.9), (5.2, 3.1)] {
        assert_ne!(block(x, y), block(4.9, 3.02), "the longer joints stay");
    }
    let kept = built(&CROSSING, "[mesh]\nsize = 1.0\nleast_block = 0");
    let length = |simulation: &Simulation| -> f64 {
        let lists = simulation.built().noding.traces.iter();
        lists.map(|trace| trace.in_rock).sum()
    };
    assert!((length(&kept) - length(&simulation)).abs() < 1e-9);
}

/// Crumbs that share no face with larger rock join each other first.
#[test]
fn crumbs_beside_each_other_join_what_is_larger() {
    let mut joints = CROSSING.to_vec();
    joints.push([[5.0, 2.98], [5.04, 3.06]]);
    let simulation = built(&joints, "[mesh]\nsize = 1.0");
    assert!(simulation.built().crumbs.iter().all(|crumb| crumb.joined), "{:?}", simulation.built().crumbs);
    let covers = &simulation.model().covers;
    assert!(covers.blocks().all(|b| covers.block_area(b) >= 2.5e-3));
}

#[test]
fn a_crumb_that_falls_is_named_and_holds_up_no_stage() {
    let island = "islands = [[[11, 5], [11.02, 5], [11, 5.02]]]\n[mesh]\nsize = 1.0";
    let mut simulation = built(&[[[0.0, 3.0], [10.0, 3.0]]], island);
    let [crumb] = simulation.built().crumbs[..] else { panic!("{:?}", simulation.built().crumbs) };
    assert!(!crumb.joined, "it touches no rock: {crumb:?}");
    let report = simulation.run_stage().expect("rests");
    assert!(simulation.at_rest(&report) && simulation.time() < 0.5, "{} s", simulation.time());
    let [restless] = &simulation.restless(&report)[..] else { panic!("{:?}", simulation.restless(&report)) };
    assert!((restless.area - 2e-4).abs() < 1e-12 && restless.law.is_none(), "{restless:?}");
    assert!(restless.to_string().contains("in free flight"), "{restless}");
}

/// A crumb of 0.24 m² in a pit is pushed at 2 mm/s before two reports of three. At the third its neighbours, which it
/// has shaken, have more energy than the crumb: such reports set the time of rest back to zero, and a stage ran for
/// all of 20 s.
#[test]
fn a_crumb_that_shakes_its_neighbours_holds_up_no_stage() {
    let mut simulation = simulation(PIT);
    let covers = &simulation.model().covers;
    let crumb = covers.blocks().find(|&b| (covers.block_area(b) - 0.241).abs() < 1e-3).expect("the crumb");
    let own = covers.covers_of(crumb);
    let report = loop {
        let step = simulation.state().step;
        let pushed = step.is_multiple_of(10) && !step.is_multiple_of(30);
        if pushed {
            let mut state = simulation.state().clone();
            state.velocity[own.clone()].iter_mut().for_each(|v| v.y += 2e-3);
            simulation.restore(state);
        }
        let report = simulation.advance(step.is_multiple_of(10)).expect("moves");
        if pushed && (simulation.at_rest(&report) || simulation.time() > 0.7) {
            break report;
        }
    };
    assert!(simulation.at_rest(&report) && simulation.time() < 0.5, "{} s", simulation.time());
    let [restless] = &simulation.restless(&report)[..] else { panic!("{:?}", simulation.restless(&report)) };
    assert!((restless.area - 0.241).abs() < 1e-3 && restless.speed < 3e-3, "{restless:?}");
    assert_eq!(restless.law.as_deref(), Some("joints"));
}

/// Half of the rock falls: that is no rest.
#[test]
fn a_block_that_falls_is_no_crumb() {
    let island = "islands = [[[11, 5], [13, 5], [13, 7], [11, 7]]]\n[mesh]\nsize = 1.0";
    let mut simulation = built(&[[[0.0, 3.0], [10.0, 3.0]]], island);
    let report = simulation.run_stage().expect("runs");
    assert!(!simulation.at_rest(&report) && simulation.restless(&report).is_empty());
    assert_eq!(simulation.moving().len(), 1);
}
