//! A run warns of the slips of a slope that the ground shook: they depend on the mesh.

use enmm::model::case::BaseMotion;

use crate::quiet_run::{example, quiet_run};

/// Warnings of slips in a run of the block on an incline, which slides in its second stage; the ground moves or rests,
/// and the joint has a friction angle (degrees).
fn warnings(moves: bool, friction_deg: f64) -> Vec<String> {
    let mut case = example("block_on_incline.toml");
    case.stages[1].duration = 0.2;
    case.stages[1].law_changes[0].friction_deg = Some(friction_deg);
    if moves {
        let table = Some(vec![[0.0, 0.0], [0.05, 0.1], [0.1, 0.0]]);
        case.base_motions.push(BaseMotion { table, scale: 1.0, ..BaseMotion::default() });
    }
    let of_them = |warning: &String| warning.contains("depends on the mesh");
    quiet_run(case, &mut ()).warnings.into_iter().filter(of_them).collect()
}

#[test]
fn a_shaken_block_that_slips_is_warned_of() {
    let warnings = warnings(true, 20.0);
    let [warning] = warnings.as_slice() else { panic!("{warnings:?}") };
    assert!(warning.starts_with("stage \"slide\": joints have slipped by up to 0.03"), "{warning}");
    assert!(warning.ends_with("(--set mesh.size=0.3)"), "{warning}");
}

/// A block that friction holds goes with its base: a sine of A = 1 m/s² and 2 Hz has the peak velocity 2A/ω, the way
/// At/ω and the Arias intensity πA²t/(4g).
#[test]
fn a_block_that_rides_on_a_shaken_base_has_its_motion() {
    let (amplitude, frequency, duration) = (1.0, 2.0, 1.0);
    let omega = 2.0 * std::f64::consts::PI * frequency;
    let mut case = example("block_on_incline.toml");
    case.stages[1].duration = duration;
    case.stages[1].law_changes[0].friction_deg = Some(60.0);
    let row = |k: u32| {
        let time = 1e-3 * f64::from(k);
        [time, amplitude * (omega * time).sin()]
    };
    let table = Some((0..=1000).map(row).collect());
    case.base_motions.push(BaseMotion { table, scale: 1.0, ..BaseMotion::default() });
    let summary = quiet_run(case, &mut ());
    let [earthquake] = summary.earthquakes.as_slice() else { panic!("{:?}", summary.earthquakes) };
    assert!(earthquake.interval < 0.00201, "a five-hundredth of a second: {}", earthquake.interval);
    let close = |found: f64, exact: f64| assert!((found / exact - 1.0).abs() < 0.02, "{found}, exactly {exact}");
    let along_x: Vec<_> = earthquake.motions.iter().filter(|motion| motion.axis == "x").collect();
    assert!(along_x.len() >= 2 && along_x[0].name == "base_motion[0]", "{along_x:?}");
    for motion in along_x {
        close(motion.pga, amplitude);
        close(motion.pga_g, amplitude / 9.80665);
        close(motion.pgv, 2.0 * amplitude / omega);
        close(motion.pgd, amplitude / omega * duration);
        close(motion.arias, 0.25 * std::f64::consts::PI / 9.80665 * duration);
    }
}

#[test]
fn one_that_rests_or_slides_on_still_ground_is_not() {
    for (moves, friction_deg) in [(true, 60.0), (false, 20.0)] {
        assert_eq!(warnings(moves, friction_deg), Vec::<String>::new(), "{moves}, {friction_deg}");
    }
}
