//! Claim: the yield acceleration of a block on a plane is that of limit equilibrium, with cohesion too, by trials and
//! by limit analysis, on either side, and is the same at any thread count.

use crate::common::parts::{rock, turn};
use enmm::model::{Case, ExplicitAlone, Mechanism};
use enmm_stability::strength_reduction::seismic::{
    Direction, SeismicOptions, YieldAcceleration, with_acceleration, yield_acceleration,
};
use enmm_stability::strength_reduction::{End, ReductionError, ReductionOptions, Verdict, factor_of_safety};

const OPTIONS: SeismicOptions =
    SeismicOptions { direction: None, tolerance: 5e-3, interrupt: None, integrators: &ExplicitAlone };
/// Dip of the plane (degrees).
const DIP: f64 = 30.0;

/// A block of 3 m × 1 m on a plane that falls to the right, or mirrored to the left: so low that its whole base is
/// pressed up to the yield acceleration, and keeps its cohesion.
fn case(friction: f64, cohesion: f64, side: f64) -> Case {
    let corners = [[-2.0, -1.5], [8.0, -1.5], [8.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0], [0.0, 0.0], [-2.0, 0.0]];
    let placed =
        |points: &[[f64; 2]]| -> Vec<[f64; 2]> { turn(points, -DIP).iter().map(|p| [side * p[0], p[1]]).collect() };
    let text = format!(
        "title = \"shaken\"\n[domain]\noutline = {:?}\n[mesh]\nsize = 0.9\norigin = [0.031, 0.017]\n[[joint]]\n\
         points = {:?}\n[joint_law.joint]\nfriction_deg = {friction:?}\ncohesion = {cohesion:e}\n\
         tension = {cohesion:e}\nresidual_tension = {cohesion:e}\n\
         [[fix]]\nblock = {:?}\n{}[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 5.0\n",
        placed(&corners),
        placed(&[[0.0, 0.0], [3.0, 0.0]]),
        placed(&[[-1.0, -1.0]])[0],
        rock(5e9, 2500.0),
    );
    crate::common::case(&text)
}

fn find(case: &Case, options: &SeismicOptions, threads: usize) -> YieldAcceleration {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| yield_acceleration(case, options, &mut |_, _| ())).unwrap_or_else(|error| panic!("{error}"))
}

/// k = (tan φ cos α − sin α + cL/W) / (cos α + tan φ sin α), which is tan(φ − α) without cohesion.
fn exact(friction: f64, cohesion: f64) -> f64 {
    let (sin, cos) = DIP.to_radians().sin_cos();
    let (tan, weight) = (friction.to_radians().tan(), 2500.0 * 9.81 * 3.0);
    (tan * cos - sin + cohesion * 3.0 / weight) / (cos + tan * sin)
}

#[test]
fn the_yield_acceleration_is_that_of_limit_equilibrium() {
    assert!((exact(40.0, 0.0) - 10f64.to_radians().tan()).abs() < 1e-12);
    for (friction, cohesion, side) in [(40.0, 0.0, 1.0), (45.0, 0.0, -1.0), (35.0, 5e3, 1.0), (20.0, 10e3, -1.0)] {
        let found = find(&case(friction, cohesion, side), &OPTIONS, 1);
        let (k, limit) = (found.coefficient().expect("a coefficient"), exact(friction, cohesion));
        println!("φ = {friction}°, c = {cohesion} Pa: {k} of {limit}, {} trials", found.trials.len());
        assert!((k / limit - 1.0).abs() < 1e-2, "φ = {friction}°, c = {cohesion} Pa: {k} of {limit}");
        let bound = *found.bound.as_ref().expect("limit analysis");
        assert!((bound / limit - 1.0).abs() < 2e-3, "{bound} of {limit}");
        assert_eq!(found.direction, if side > 0.0 { Direction::Right } else { Direction::Left });
        assert_eq!(found.mechanism(), Some(Mechanism::Slides));
        let stands = |t: &&enmm_stability::strength_reduction::seismic::SeismicTrial| t.verdict() == Verdict::Stable;
        assert!(found.trials.iter().filter(stands).all(|t| Some(t.coefficient) <= found.low), "monotone");
        assert!((found.gravity - 9.81).abs() < 1e-12 && found.end == End::Found);
    }
}

/// The factor of safety with the yield acceleration as a load is 1.
#[test]
fn a_load_of_the_yield_acceleration_has_a_factor_of_one() {
    let case = case(40.0, 0.0, 1.0);
    let found = find(&case, &OPTIONS, 2);
    let loaded = with_acceleration(&case, found.coefficient().expect("a coefficient") * 9.81);
    let reduction = factor_of_safety(&loaded, &ReductionOptions::default(), &mut |_, _| ()).expect("a search");
    let factor = reduction.factor().expect("a factor");
    assert!((factor - 1.0).abs() < 5e-3, "{factor}");
}

#[test]
fn threads_change_no_bit() {
    let case = case(38.0, 2e3, 1.0);
    let [one, two] = [1, 2].map(|threads| find(&case, &OPTIONS, threads));
    let bits = |found: &YieldAcceleration| {
        let bits = |t: &enmm_stability::strength_reduction::seismic::SeismicTrial| {
            let displacement = t.trial.as_ref().map(|trial| trial.displacement.to_bits());
            (t.coefficient.to_bits(), t.verdict(), displacement)
        };
        found.trials.iter().map(bits).collect::<Vec<_>>()
    };
    assert_eq!(bits(&one), bits(&two));
}

/// Pushed up the plane the block bears tan(φ + α); what does not stand without an earthquake bears none.
#[test]
fn a_named_side_is_taken() {
    let found = find(&case(31.0, 0.0, 1.0), &SeismicOptions { direction: Some(Direction::Left), ..OPTIONS }, 1);
    let (k, limit) = (found.coefficient().expect("a coefficient"), 61f64.to_radians().tan());
    assert!((k / limit - 1.0).abs() < 1e-2, "{k} of {limit}");
    let weak = find(&case(20.0, 0.0, 1.0), &OPTIONS, 1);
    assert!(weak.end == End::UnstableThroughout && weak.coefficient().is_none(), "{:?}", weak.trials);
}

#[test]
fn level_ground_has_no_side_and_weightless_rock_no_share() {
    let flat = "title = \"flat\"\n[domain]\noutline = [[0, 0], [4, 0], [4, 2], [0, 2]]\n[mesh]\nsize = 1.0\n[[joint]]\n\
                points = [[0, 1], [4, 1]]\n[joint_law.joint]\nfriction_deg = 30.0\n[[fix]]\nblock = [2, 0.5]\n";
    let stage = "[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 5.0\n";
    let error = |text: &str, options: &SeismicOptions| {
        let case = crate::common::case(text);
        match yield_acceleration(&case, options, &mut |_, _| ()) {
            Err(ReductionError::Case(invalid)) => format!("{}: {}", invalid.key, invalid.message),
            other => panic!("{other:?}"),
        }
    };
    let level = error(&format!("{flat}{}{stage}", rock(5e9, 2500.0)), &OPTIONS);
    assert!(level.starts_with("domain.outline: is as high") && level.ends_with("--seismic=left"), "{level}");
    let weightless = format!("{flat}{}{stage}[gravity]\nx = 0.0\ny = 0.0\n", rock(5e9, 2500.0));
    let error = error(&weightless, &SeismicOptions { direction: Some(Direction::Left), ..OPTIONS });
    assert!(error.starts_with("gravity: is 0"), "{error}");
}
