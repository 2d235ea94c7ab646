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

#[test]
fn one_that_rests_or_slides_on_still_ground_is_not() {
    for (moves, friction_deg) in [(true, 60.0), (false, 20.0)] {
        assert_eq!(warnings(moves, friction_deg), Vec::<String>::new(), "{moves}, {friction_deg}");
    }
}
