//! Claim F: strength reduction through the library finds the factor of safety of a block, also below 1, names the block
//! that fails, and gives the same bits at any thread count.

use crate::common::parts::{rock, turn};
use enmm_stability::strength_reduction::{
    End, MechanismOptions, Reduction, ReductionError, ReductionOptions, Verdict, factor_of_safety, mechanisms,
};

/// A block of 3 m × 2 m on a plane at 30°, and stages after its rest. Its resultant leaves the middle third of the
/// base, so that the heel would open and lose its cohesion if it had no tensile strength.
fn case(friction: f64, cohesion: f64, more: &str) -> enmm::model::Case {
    case_below(&[[8.0, 0.0]], friction, cohesion, more)
}

/// The same, over a ground that goes on below the block as given.
fn case_below(below: &[[f64; 2]], friction: f64, cohesion: f64, more: &str) -> enmm::model::Case {
    let ground = [[-2.0, -1.5], [8.0, -1.5]];
    let block = [[3.0, 0.0], [3.0, 2.0], [0.0, 2.0], [0.0, 0.0], [-2.0, 0.0]];
    let corners = [&ground[..], below, &block].concat();
    let text = format!(
        "title = \"reduction\"\n[domain]\noutline = {:?}\n[mesh]\nsize = 0.9\norigin = [0.031, 0.017]\n[[joint]]\n\
         points = {:?}\n[joint_law.joint]\nfriction_deg = {friction:?}\ncohesion = {cohesion:e}\n\
         tension = {cohesion:e}\nresidual_tension = {cohesion:e}\n\
         [[fix]]\nblock = {:?}\n{}[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 5.0\n{more}",
        turn(&corners, -30.0),
        turn(&[[0.0, 0.0], [3.0, 0.0]], -30.0),
        turn(&[[-1.0, -1.0]], -30.0)[0],
        rock(5e9, 2500.0),
    );
    crate::common::case(&text)
}

fn reduce(case: &enmm::model::Case, threads: usize) -> Reduction {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let found = pool.install(|| factor_of_safety(case, &ReductionOptions::default(), &mut |_, _| {}));
    found.unwrap_or_else(|e| panic!("{e}"))
}

/// FoS = (c·A + W·cos a·tan φ)/(W·sin a), W = 2500·9.81·6 N/m, A = 3 m. The bracket is 0.5 % wide and the result its
/// middle: 0.25 %, and as much again for lengths of contact (2e-3 in `contact_lengths`).
#[test]
fn the_factor_is_that_of_limit_equilibrium() {
    for (friction, cohesion) in [(40.0, 0.0), (35.0, 20e3), (20.0, 0.0), (0.0, 30e3)] {
        let (s, c) = 30f64.to_radians().sin_cos();
        let weight = 2500.0 * 9.81 * 6.0;
        let exact = (cohesion * 3.0 + weight * c * f64::to_radians(friction).tan()) / (weight * s);
        let reduction = reduce(&case(friction, cohesion, ""), 1);
        let factor = reduction.factor().expect("a factor");
        println!("φ = {friction}°, c = {cohesion} Pa: {factor} of {exact}, {} trials", reduction.trials.len());
        assert!((factor / exact - 1.0).abs() < 5e-3, "φ = {friction}°, c = {cohesion} Pa: {factor} of {exact}");
        let failing = &reduction.first_unstable().expect("an unstable trial").failing;
        assert_eq!(failing.len(), 1, "{failing:?}");
        let stable = reduction.trials.iter().filter(|t| t.verdict == Verdict::Stable);
        assert!(stable.clone().count() > 0 && stable.clone().all(|t| t.failing.is_empty()));
        assert!(reduction.trials.iter().all(|t| t.ledger_residual.abs() < 1e-3));
        assert_eq!(friction == 0.0, reduction.warnings.iter().any(|w| w.contains("no joint has friction")));
    }
}

/// The frames of the trial that fails come from its motion made once more, which ends in the same bits.
#[test]
fn the_trial_that_fails_can_be_made_again() {
    for friction in [40.0, 20.0] {
        let reduction = reduce(&case(friction, 0.0, ""), 1);
        let begun = reduction.begun.as_ref().expect("a trial that fails");
        let mut seen = Vec::new();
        let shown = begun.replay(19, |simulation| {
            seen.push((simulation.time(), simulation.state().displacement.clone()));
            if seen.len() < 20 || simulation.state().velocity == reduction.simulation.state().velocity {
                Ok(())
            } else {
                Err("other velocities at the end")
            }
        });
        assert_eq!(shown, Ok(()));
        let [(start, first), .., (end, last)] = &seen[..] else { panic!("no frames") };
        assert_eq!(seen.len(), 20);
        assert_eq!(*last, reduction.simulation.state().displacement);
        assert!(first != last && (end - start - begun.duration()).abs() < 1e-9 * end);
        assert!(seen.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }
}

/// What stands and what slides by itself are the same slope with another strength: limits are those of one state.
#[test]
fn the_strength_of_the_case_changes_no_limit() {
    let limit =
        |friction: f64| f64::to_radians(friction).tan() / reduce(&case(friction, 0.0, ""), 1).factor().expect("F");
    let [weak, strong] = [20.0, 60.0].map(limit);
    assert!((weak / strong - 1.0).abs() < 5e-3, "{weak} {strong}");
}

/// Trials of a block that stands at 1.1 times its factor, as one does that something other than strength holds.
#[test]
fn a_factor_above_limit_analysis_is_in_doubt() {
    let mut reduction = reduce(&case(40.0, 0.0, ""), 1);
    assert_eq!((reduction.doubt(), reduction.at_most()), (None, None));
    reduction.low = reduction.low.map(|low| 1.1 * low);
    let doubt = reduction.doubt().expect("a doubt");
    assert!(doubt.contains("above what limit analysis of rigid blocks allows"), "{doubt}");
    let exact = 40f64.to_radians().tan() / 30f64.to_radians().tan();
    assert!((reduction.at_most().expect("a bound") / exact - 1.0).abs() < 3e-4, "{:?}", reduction.at_most());
}

/// The friction of the first test, with a wall 20 mm below the block: it starts to move as it does without, whether it
/// reaches the wall or not.
#[test]
fn a_block_that_a_wall_would_catch_starts_to_move_as_without_it() {
    let wall = [[8.0, 0.5], [3.02, 0.5], [3.02, 0.0]];
    let reduction = reduce(&case_below(&wall, 40.0, 0.0, ""), 1);
    let exact = 40f64.to_radians().tan() / 30f64.to_radians().tan();
    let factor = reduction.factor().expect("a factor");
    assert!((factor / exact - 1.0).abs() < 5e-3, "{factor} of {exact}");
    assert!(reduction.trials.iter().all(|t| (t.verdict == Verdict::Stable) == (t.factor < exact)), "monotone");
    let lost = reduction.lost.as_ref().expect("trials in the real geometry");
    assert!(lost.low >= reduction.low && reduction.corners.is_none(), "{:?}", reduction.others());
    let bound = reduction.bound.as_ref().expect("a bound").level_tops.factor.value();
    assert!((bound / exact - 1.0).abs() < 3e-4, "{bound}: limit analysis knows no way to go");
}

/// Of two blocks the larger has less cohesion for its weight: it fails first, the smaller when it has gone. Where both
/// are too small to count nothing is left that fails.
#[test]
fn one_mechanism_follows_the_other() {
    let (friction, cohesion) = (20.0, 10e3);
    let small = [[7.0, 0.0], [7.0, 1.0], [5.5, 1.0], [5.5, 0.0]];
    let joint = format!("[[joint]]\npoints = {:?}\n", turn(&[[5.5, 0.0], [7.0, 0.0]], -30.0));
    let case = case_below(&[&[[8.0, 0.0]], &small[..]].concat(), friction, cohesion, &joint);
    let exact = [[3.0, 2.0], [1.5, 1.0]].map(|[length, height]: [f64; 2]| {
        let (s, c) = 30f64.to_radians().sin_cos();
        let weight = 2500.0 * 9.81 * length * height;
        (cohesion * length + weight * c * f64::to_radians(friction).tan()) / (weight * s)
    });
    let find = |which: MechanismOptions| {
        let found = mechanisms(&case, which, &ReductionOptions::default(), &mut |_, _| {});
        found.unwrap_or_else(|e| panic!("{e}"))
    };
    let found = find(MechanismOptions { count: 2, ..Default::default() });
    assert_eq!(found.len(), 2);
    for (reduction, exact, area) in [(&found[0], exact[0], 6.0), (&found[1], exact[1], 1.5)] {
        let factor = reduction.factor().expect("a factor");
        assert!((factor / exact - 1.0).abs() < 5e-3, "{factor} of {exact}");
        let trial = reduction.first_unstable().expect("a failure");
        assert!((trial.failing_area() / area - 1.0).abs() < 1e-9, "{trial:?}");
        assert!((trial.failing_mass() / (2500.0 * area) - 1.0).abs() < 1e-9, "{trial:?}");
    }
    assert!((found[0].free_area - 7.5).abs() < 1e-9, "{}", found[0].free_area);
    let passed = find(MechanismOptions { least_area: Some(7.0), count: 1 });
    let ends: Vec<&End> = passed.iter().map(|reduction| &reduction.end).collect();
    assert_eq!(ends, [&End::Found, &End::Found, &End::StableThroughout]);
    assert_eq!(passed[2].at_least(), Some(20.0));
}

#[test]
fn threads_change_no_bit() {
    let case = case(35.0, 20e3, "");
    let [one, two] = [1, 2].map(|threads| reduce(&case, threads));
    let bits = |r: &Reduction| {
        let trial = |t: &enmm_stability::strength_reduction::Trial| {
            [t.factor, t.displacement, t.speed, t.kinetic, t.released].map(f64::to_bits)
        };
        r.trials.iter().map(trial).collect::<Vec<_>>()
    };
    assert_eq!(bits(&one), bits(&two));
    assert!(one.simulation.state() == two.simulation.state());
}

#[test]
fn dynamic_stages_are_left_out_and_said_to_be() {
    let shake = "[[stage]]\nname = \"shake\"\nkind = \"dynamic\"\nduration = 1.0\n[[stage.law]]\nlaw = \"joint\"\n\
                 friction_deg = 5.0\n";
    let with = reduce(&case(40.0, 0.0, shake), 1);
    assert_eq!(with.factor(), reduce(&case(40.0, 0.0, ""), 1).factor());
    assert!(with.warnings.iter().any(|w| w.contains("shake")), "{:?}", with.warnings);
}

#[test]
fn what_cannot_be_judged_is_an_error_or_an_end() {
    let mut no_rest = case(40.0, 0.0, "");
    no_rest.stages[0].kind = enmm::model::case::StageKind::Dynamic;
    let find = |case: &_, options: ReductionOptions| factor_of_safety(case, &options, &mut |_, _| {});
    let error = find(&no_rest, ReductionOptions::default()).expect_err("no static stage");
    assert!(matches!(&error, ReductionError::Case(invalid) if invalid.key == "stage[0].kind"), "{error}");
    let mut short = case(40.0, 0.0, "");
    short.stages[0].duration = 1e-3;
    let error = find(&short, ReductionOptions::default()).expect_err("no time to come to rest");
    assert!(matches!(&error, ReductionError::NotAtRest { .. }) && error.to_string().contains("duration"), "{error}");
    let narrow = ReductionOptions { low: Some(0.8), high: Some(1.2), ..Default::default() };
    let reduction = find(&case(40.0, 0.0, ""), narrow).expect("trials");
    assert_eq!((reduction.end.clone(), reduction.factor()), (End::StableThroughout, None));
}
