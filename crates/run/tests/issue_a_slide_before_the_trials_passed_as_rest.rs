//! A slope with F < 1 that slid in its static stage until other rock stopped it passed as a slope at rest: its factor
//! of safety was that of the debris, 1.858 instead of 0.775.

use crate::quiet_run::{example, quiet_run};
use enmm::model::case::Case;
use enmm_stability::strength_reduction::{ReductionOptions, factor_of_safety};

/// The plane slide of the examples without water, and with less strength than it needs.
fn weak_slide([friction_deg, cohesion]: [f64; 2]) -> Case {
    let mut case = example("plane_slide.toml");
    let plane = case.joint_laws.get_mut("plane").expect("the law of the plane");
    (plane.friction_deg, plane.cohesion) = (friction_deg, cohesion);
    case.water = None;
    case
}

/// Bolts that a second static stage installs tied the wedge that had slid in the first one, and its slip did not count
/// any more. Now no joint slips before the trials, and the bolts hold a wedge that is where it was drawn.
#[test]
fn bolts_that_a_stage_installs_hold_a_wedge_that_has_not_slid() {
    let case = weak_slide([28.0, 2e3]);
    assert!(case.stages.len() == 2 && !case.stages[1].install.is_empty());
    let found = factor_of_safety(&case, &ReductionOptions::default(), &mut |_, _| {}).unwrap_or_else(|e| panic!("{e}"));
    let bound = found.bound.as_ref().expect("a bound").level_tops.factor.value();
    let factor = found.factor().expect("a factor");
    assert!((factor / bound - 1.0).abs() < 0.01, "{factor}, bound {bound}");
    assert!(!found.warnings.iter().any(|warning| warning.contains("slip")), "{:?}", found.warnings);
}

/// `enmm run` said no more than that the stage was at rest. Now the slide is a failure that ends the stage; one that is
/// followed until other rock stops it is warned of.
#[test]
fn a_run_warns_of_a_slide_in_a_static_stage() {
    let mut case = weak_slide([28.0, 2e3]);
    case.stages.truncate(1);
    case.bolts.clear();
    let failed = quiet_run(case.clone(), &mut ());
    assert!(failed.failed && failed.stages[0].ended_early, "{}", failed.verdict);
    assert!(failed.verdict.starts_with("the slope failed in stage gravity by sliding"), "{}", failed.verdict);
    case.solver.failure_displacement = Some(100.0);
    let followed = quiet_run(case, &mut ());
    assert!(!followed.failed && !followed.stages[0].ended_early, "{}", followed.verdict);
    assert!(followed.warnings.iter().any(|warning| warning.contains("rock slid until other rock stopped it")));
}

/// The closed form of Hoek and Bray, F = (cA + W·cos ψ·tan φ)/(W·sin ψ), for H = 30 m, ψ = 35°, ψf = 60° and a crack of
/// 7 m.
#[test]
fn a_slope_that_slides_in_its_static_stage_has_the_factor_of_its_slide() {
    let (friction_deg, cohesion) = (28.0f64, 2e3);
    let mut case = weak_slide([friction_deg, cohesion]);
    case.bolts.clear();
    case.stages.truncate(1);
    let found = factor_of_safety(&case, &ReductionOptions::default(), &mut |_, _| {}).unwrap_or_else(|e| panic!("{e}"));
    let (height, crack) = (30.0f64, 7.0f64);
    let [dip, face] = [35.0f64, 60.0].map(f64::to_radians);
    let area = (height - crack) / dip.sin();
    let weight =
        0.5 * 2650.0 * 9.81 * height.powi(2) * ((1.0 - (crack / height).powi(2)) / dip.tan() - 1.0 / face.tan());
    let exact = (cohesion * area + weight * dip.cos() * friction_deg.to_radians().tan()) / (weight * dip.sin());
    let factor = found.factor().expect("a factor");
    assert!((factor / exact - 1.0).abs() < 5e-3, "{factor}, exact {exact}");
    assert!(!found.warnings.iter().any(|warning| warning.contains("slip")), "{:?}", found.warnings);
}
