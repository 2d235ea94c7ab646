//! Claim: the contact solver that steps use finds what plain Gauss–Seidel over the equations of theory §5 finds.

use crate::common::simulation;
use enmm::internals::contact::{Approach, OpenClose, OtherConstraints, SolverOptions, reference};
use enmm::model::{ContactState, Simulation};

/// Both solvers sweep until no force changes by more than this share of itself.
const SETTLED: f64 = 1e-13;
/// Forces and velocities may then differ by what is left of a change that decays by some per cent in each sweep.
const TOLERANCE: f64 = 1e-9;
/// Share of the largest force that is round-off.
const ROUND_OFF: f64 = 1e-13;

/// A slope in 13 blocks on joints with cohesion and tension; the master joint is curved in spring and strength. It
/// rests, then loses its strength and fails.
const SLOPE: &str = r#"
title = "a slope on joints"
domain = { outline = [[0, 0], [60, 0], [60, 40], [34, 40], [16, 10], [0, 10]], joint_law = "joint" }
mesh = { size = 5.0, angle_deg = 7.0 }
joint = [{ points = [[15, 8], [62, 37]], law = "master" }]
joint_set = [
    { angle_deg = 33.0, spacing = 6.1, spacing_sd = 0.5, seed = 11, region = [[15, 9], [33, 41], [58, 41]] },
    { angle_deg = 118.0, spacing = 6.3, spacing_sd = 0.6, seed = 12, region = [[15, 9], [33, 41], [58, 41]] },
]
rock.gneiss = { density = 2650, young = 5e9, poisson = 0.25 }
joint_law.joint = { friction_deg = 45, cohesion = 2e4, tension = 1e4 }
joint_law.master = { kind = "barton_bandis", friction_deg = 28.0, jrc = 10.0, jcs = 60e6 }
fix = [{ edge = [[0, 0], [60, 0]] }]
stage = [
    { name = "gravity", kind = "static", duration = 8.0 },
    { name = "failure", kind = "dynamic", duration = 3.0, damping = 0.1, law = [
        { law = "joint", friction_deg = 8, cohesion = 0, tension = 0 },
        { law = "master", friction_deg = 8 },
    ] },
]
"#;

/// Solves the contacts of the next step in both ways; returns how many are open, slip and lock.
fn compare(simulation: &Simulation) -> [usize; 3] {
    let (model, (state, mut workspace)) = (simulation.model(), simulation.look_ahead());
    let (dt, masses) = (model.dt, &workspace.mass_matrix);
    let (kick, theta) = (0.5 * (state.dt_last + dt), model.theta);
    let options = SolverOptions { dt, kick, theta, tolerance: SETTLED, sweeps_max: 100_000, serial: true };
    let approach = Approach {
        predicted: &workspace.motion.predicted,
        velocity: &state.velocity,
        dt_last: state.dt_last,
        forward: model.theta_in(dt),
        damping: (state.stage > 0).then_some(0.1),
        setting: model.contact_setting(&state.laws, &workspace.frames, &workspace.selection),
        motion: &workspace.motion.blocks,
    };
    let mut plain = workspace.contacts.clone();
    assert!(plain.iter().any(|contact| state.laws[contact.law].roughness.is_some()), "no contact of the master joint");
    let (expected, report) = reference::solve(masses, &options, &approach, &mut plain);
    assert!(report.unsettled <= SETTLED, "the reference has not settled: {report:?}");

    let mut solver = OpenClose::default();
    solver.prepare(masses, &[], &[]);
    let near = (&state.neighbours.pairs[..], &workspace.selection.near_sides);
    solver.arrange(
        &model.boundary,
        near,
        masses,
        &model.covers.block_ranges.covers,
        &workspace.selection.accepted.found,
    );
    let mut others = OtherConstraints { rows: &mut [], bolts: &mut [] };
    let report = solver.run(masses, &options, &approach, &mut workspace.contacts, &mut others);
    assert!(report.unsettled <= SETTLED, "the solver has not settled: {report:?}");
    solver.impulses(masses, &mut workspace.sweep.increment, &mut workspace.sweep.push);

    let largest = plain.iter().map(|contact| contact.history.normal_force).fold(0.0, f64::max);
    for (k, (found, plain)) in workspace.contacts.iter().zip(&plain).enumerate() {
        let (found, plain) = (&found.history, &plain.history);
        let apart = (found.normal_force - plain.normal_force).hypot(found.shear_force - plain.shear_force);
        assert!(apart <= TOLERANCE * largest, "contact {k}: {found:?} instead of {plain:?}");
        // Whether a force of round-off is one, chance decides.
        if found.normal_force.max(plain.normal_force) > ROUND_OFF * largest {
            assert_eq!(found.state, plain.state, "contact {k}: {found:?} instead of {plain:?}");
        }
    }
    let fastest = expected.increment.iter().map(|v| v.norm()).fold(0.0, f64::max);
    for (i, (found, plain)) in workspace.sweep.increment.iter().zip(&expected.increment).enumerate() {
        assert!((found - plain).norm() <= TOLERANCE * fastest, "cover {i}: {found} instead of {plain}");
    }
    let hardest = expected.block_impulse.iter().map(|b| b.impulse.norm()).fold(0.0, f64::max);
    for (block, (found, plain)) in workspace.sweep.push.iter().zip(&expected.block_impulse).enumerate() {
        let apart = (found.impulse - plain.impulse).norm().max((found.weighted - plain.weighted).norm());
        assert!(apart <= TOLERANCE * hardest, "block {block}: {found:?} instead of {plain:?}");
        assert!((found.moment - plain.moment).abs() <= TOLERANCE * hardest * model.covers.mesh.size, "block {block}");
    }
    let states = [ContactState::Open, ContactState::Slip, ContactState::Lock];
    states.map(|state| plain.iter().filter(|contact| contact.history.state == state).count())
}

/// The slope with a rock bridge, which breaks by section, as the upper half of its master joint.
fn bridged() -> String {
    let half = "points = [[15, 8], [38.5, 22.5]]";
    let bridge = "bridge = [{ points = [[38.5, 22.5], [62, 37]], law = \"rock\" }]\n";
    let law = "joint_law.rock = { friction_deg = 45, cohesion = 2e5, residual_cohesion = 0, tension = 1e5, \
               breaks = \"by section\" }\n";
    SLOPE.replace("points = [[15, 8], [62, 37]]", half).replace("stage = [", &[bridge, law, "stage = ["].concat())
}

#[test]
fn the_solver_of_steps_agrees_with_the_method_written_out() {
    let dilates = SLOPE.replace("friction_deg = 45", "friction_deg = 45, dilation_deg = 15, dilation_slip = 1.0");
    for (law, text) in [("plain", SLOPE), ("dilates", &dilates), ("with a bridge", &bridged())] {
        let mut slope = simulation(text);
        assert_eq!(slope.model().sections.list.is_empty(), law != "with a bridge");
        let mut seen = [0; 3];
        for (steps, stage) in [(1, "load comes"), (400, "rests"), (1, "loses its strength"), (300, "fails")] {
            if stage == "loses its strength" {
                slope.next_stage().unwrap_or_else(|e| panic!("{e}"));
            }
            for _ in 0..steps {
                slope.advance(false).unwrap_or_else(|e| panic!("{law}, {stage}: {e}"));
            }
            let states = compare(&slope);
            seen = [0, 1, 2].map(|k| seen[k] + states[k]);
        }
        assert!(seen.iter().all(|&count| count > 20), "{law}: open, slip and lock: {seen:?}");
    }
}
