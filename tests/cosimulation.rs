//! Co-simulation: steps cover exactly their interval, on a grid that no host can shift, all or nothing; saved states,
//! events, inputs and parameters.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::{Arc, Mutex};

use crate::common::saved::Whole;
use crate::common::{example as text_of, examples};
use enmm::cosimulation::{Cosimulation, CosimulationError, EventKind, Interpolation, Named, Pace, Watch, apply};
use enmm::geometry::Vector;
use enmm::model::Mechanism;
use enmm::model::bytes::{Keeper, decode, encode};
use enmm_io::{LoadedCase, load_case, parse_case};

fn example(name: &str) -> LoadedCase {
    load_case(&examples().join(format!("{name}.toml"))).unwrap_or_else(|e| panic!("{e}"))
}

fn model(name: &str) -> Cosimulation {
    example(name).cosimulation().unwrap_or_else(|e| panic!("{e}"))
}

/// Steps of `h` until `end`, with times summed as a careless master does.
fn run(model: &mut Cosimulation, h: f64, end: f64) {
    let mut t = model.time();
    while t < end - 0.5 * h {
        model.do_step(t, h).unwrap_or_else(|e| panic!("{e}"));
        t += h;
    }
}

/// One step until `end`.
fn go(model: &mut Cosimulation, end: f64) {
    let t = model.time();
    model.do_step(t, end - t).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn the_initial_equilibrium_ends_at_time_zero_and_equals_that_of_a_run() {
    let mut model = model("block_on_incline");
    assert_eq!((model.time(), model.is_started()), (0.0, false));
    model.start().unwrap();
    assert_eq!(model.time(), 0.0);
    assert_eq!(model.stop_time(), 1.0);
    let mut simulation = enmm::model::Simulation::new(example("block_on_incline").case).unwrap();
    let settled = model.simulation().state().step;
    assert!(settled > 100);
    (0..settled).for_each(|step| {
        simulation.advance(step % 10 == 0).unwrap();
    });
    simulation.next_stage().unwrap();
    assert_eq!(simulation.block_states(), model.block_states());
}

#[test]
fn any_division_into_steps_gives_the_same_bits() {
    for name in ["block_on_incline", "coupled_slope"] {
        let mut whole = model(name);
        whole.do_step(0.0, 0.2).unwrap();
        for h in [0.1, 0.01, 0.05 / 7.0, 0.2 / 3.0, 0.00123] {
            let mut parts = model(name);
            run(&mut parts, h, 0.2 - h);
            go(&mut parts, 0.2);
            assert!((parts.time() - 0.2).abs() < 1e-12, "{}", parts.time());
            assert_eq!(parts.block_states(), whole.block_states(), "{name} by steps of {h}");
        }
    }
}

#[test]
fn a_step_that_ends_between_grid_points_ends_exactly_there() {
    let mut model = model("block_on_incline");
    let dt = model.internal_step();
    let info = model.do_step(0.0, 10.4 * dt).unwrap();
    assert_eq!((info.steps, info.time), (11, 10.4 * dt));
    let there = model.block_states()[1].displacement;
    model.set_block_force(1, Vector::new(1e3, 0.0), 0.0).unwrap();
    assert_eq!(model.block_states()[1].displacement, there, "an input moves nothing by itself");
    let info = model.do_step(10.4 * dt, 0.2 * dt).unwrap();
    assert_eq!(info.steps, 1);
    assert!((model.time() - 10.6 * dt).abs() < 1e-15);
}

#[test]
fn times_that_do_not_fit_are_refused_and_change_nothing() {
    let mut model = model("block_on_incline");
    model.do_step(0.0, 0.01).unwrap();
    let before = model.block_states();
    for (t, h) in [(0.0, 0.01), (0.02, 0.01), (f64::NAN, 0.01)] {
        assert!(matches!(model.do_step(t, h), Err(CosimulationError::Time { .. })), "{t} {h}");
    }
    for h in [0.0, -0.01, f64::NAN, f64::INFINITY, 1e300] {
        assert!(matches!(model.do_step(0.01, h), Err(CosimulationError::Value { .. })), "{h}");
    }
    assert_eq!(model.block_states(), before);
    model.do_step(0.01, 0.01).unwrap();
}

#[test]
fn a_failed_step_leaves_the_model_where_it_was() {
    let mut plain = model("block_on_incline");
    let mut model = model("block_on_incline");
    run(&mut model, 0.01, 0.05);
    run(&mut plain, 0.01, 0.05);
    let saved = model.save();
    model.set_block_force(1, Vector::new(1e15, 1e15), 0.0).unwrap();
    let error = model.do_step(0.05, 0.05).unwrap_err();
    assert!(matches!(error, CosimulationError::Step(_)), "{error}");
    assert!((model.time() - 0.05).abs() < 1e-15);
    assert_eq!(model.block_states(), plain.block_states());
    model.restore(&saved).unwrap();
    run(&mut model, 0.01, 0.1);
    run(&mut plain, 0.01, 0.1);
    assert_eq!(model.block_states(), plain.block_states());
}

#[test]
fn saved_states_bring_back_everything_even_in_another_model_of_the_case() {
    let mut first = model("coupled_slope");
    first.set_water_level(12.0).unwrap();
    first.do_step(0.0, 0.0503).unwrap();
    let saved = first.save();
    let bytes = first.serialize(&saved).unwrap();
    first.set_water_level(18.0).unwrap();
    first.do_step(0.0503, 0.05).unwrap();
    let after = first.block_states();

    first.restore(&saved).unwrap();
    assert_eq!(first.inputs().water_level, 12.0);
    first.set_water_level(18.0).unwrap();
    first.do_step(0.0503, 0.05).unwrap();
    assert_eq!(first.block_states(), after);

    let mut fresh = model("coupled_slope");
    let again = fresh.deserialize(&bytes).unwrap();
    assert_eq!(again, saved);
    fresh.restore(&again).unwrap();
    fresh.set_water_level(18.0).unwrap();
    fresh.do_step(0.0503, 0.05).unwrap();
    assert_eq!(fresh.block_states(), after);
    assert_eq!(fresh.events().collect::<Vec<_>>(), first.events().collect::<Vec<_>>());
}

#[test]
fn damaged_and_foreign_states_are_refused() {
    let slope = model("coupled_slope");
    let bytes = slope.serialize(&slope.save()).unwrap();
    assert!(model("block_on_incline").deserialize(&bytes).is_err());
    for at in [0, 9, 14, 40, 60, bytes.len() / 2, bytes.len() - 1] {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x10;
        assert!(slope.deserialize(&damaged).is_err(), "byte {at}");
    }
    assert!(slope.deserialize(&bytes[..bytes.len() - 1]).is_err());
    assert!(slope.deserialize(&[]).is_err());
    let other = model("block_on_incline").save();
    assert!(model("coupled_slope").restore(&other).is_err());
}

#[test]
fn an_interval_may_be_left_early() {
    let mut model = model("block_on_incline");
    let mut interval = model.begin(0.0, 0.1).unwrap();
    for _ in 0..7 {
        assert!(model.advance(&mut interval).unwrap());
    }
    let info = model.leave(interval);
    assert_eq!(info.steps, 7);
    assert!((info.time - 7.0 * model.internal_step()).abs() < 1e-15 && info.time == model.time());
    model.do_step(info.time, 0.1 - info.time).unwrap();
    let mut whole = self::model("block_on_incline");
    whole.do_step(0.0, 0.1).unwrap();
    assert_eq!(model.block_states(), whole.block_states());
}

#[test]
fn the_incline_slips_once_and_fails_once_and_says_when() {
    let mut model = model("block_on_incline");
    let info = model.do_step(0.0, 1.0).unwrap();
    let kinds: Vec<EventKind> = info.events.iter().map(|e| e.kind).collect();
    assert_eq!(kinds, [EventKind::Slipped, EventKind::Slipped, EventKind::Failed]);
    assert!(info.events[0].time < 0.01 && info.events[0].subject == 0);
    assert_eq!(info.events[1].subject, u32::MAX, "beyond the joint the block slides on the outline");
    // s = ½·g'·t² passes the mesh size of 0.6 m at t = sqrt(2·0.6/1.812813).
    assert!((info.events[2].time - 0.8136).abs() < 1e-3, "{}", info.events[2].time);
    assert_eq!(model.totals().failed_blocks, 1);
}

/// The host is told once that the slope has failed, in the step in which it does, and goes on as it likes.
#[test]
fn the_step_in_which_the_slope_fails_says_how() {
    let mut model = model("block_on_incline");
    let infos: Vec<_> = (0..10).map(|k| model.do_step(0.1 * f64::from(k), 0.1).unwrap()).collect();
    let told: Vec<usize> = (0..infos.len()).filter(|&k| infos[k].failure.is_some()).collect();
    assert_eq!(told, [8], "it passes 0.6 m at 0.8136 s");
    let failure = infos[8].failure.expect("told");
    assert_eq!((failure.mechanism, failure.blocks, failure.farthest.block), (Mechanism::Slides, 1, 1));
    let way = 0.5 * 1.812813 * 0.9f64.powi(2);
    assert!((failure.farthest.displacement / way - 1.0).abs() < 5e-3, "{failure}");
    assert!(failure.to_string().starts_with("by sliding: 1 block, largest displacement 0.73"), "{failure}");
}

#[test]
fn a_block_that_is_pulled_off_detaches() {
    let mut model = model("block_on_incline");
    model.start().unwrap();
    let normal = Vector::new(0.5, 3f64.sqrt() / 2.0);
    model.set_block_force(1, normal * 1e5, 0.0).unwrap();
    let info = model.do_step(0.0, 0.2).unwrap();
    assert!(info.events.iter().any(|e| e.kind == EventKind::Detached && e.subject == 1), "{:?}", info.events);
    assert!(model.block_states()[1].detached);
}

#[test]
fn a_linear_input_arrives_at_the_end_of_the_step_and_a_held_one_jumps() {
    // Linear from 500 to 1000 N/m on 1000 kg/m gives v = 0.75·h, held v = h.
    let h = 0.5;
    for (interpolation, share) in [(Interpolation::Hold, 1.0), (Interpolation::Linear, 0.75)] {
        let mut model = free_block();
        model.set_interpolation(interpolation);
        model.set_block_force(0, Vector::new(-700.0, 0.0), 0.0).unwrap();
        model.set_block_force(0, Vector::new(500.0, 0.0), 0.0).unwrap();
        model.start().unwrap();
        model.set_block_force(0, Vector::new(1000.0, 0.0), 0.0).unwrap();
        model.set_strength_factor(0.5).unwrap();
        model.do_step(0.0, h).unwrap();
        let v = model.block_states()[0].velocity.x;
        assert!((v - share * h).abs() < 2.0 * model.internal_step(), "{interpolation:?}: {v}");
        model.do_step(h, h).unwrap();
        let gained = model.block_states()[0].velocity.x - v;
        assert!((gained - h).abs() < 2.0 * model.internal_step(), "the value holds: {gained}");
    }
}

#[test]
fn inputs_are_checked() {
    let mut slope = model("coupled_slope");
    for bad in [f64::NAN, f64::INFINITY, 1e30] {
        let v = Vector::new(0.0, bad);
        assert!(slope.set_gravity(v).is_err() && slope.set_base_acceleration(v).is_err());
        assert!(slope.set_water_level(bad).is_err() && slope.set_strength_factor(bad).is_err());
        assert!(slope.set_block_force(0, v, 0.0).is_err() && slope.set_block_force(0, Vector::zeros(), bad).is_err());
        assert!(slope.set_boundary_traction(1, v).is_err() && slope.set_pressure(2, bad).is_err());
    }
    assert!(slope.set_block_force(99, Vector::zeros(), 0.0).is_err());
    assert!(slope.set_boundary_traction(0, Vector::zeros()).is_err(), "the toe is a block");
    assert!(slope.set_pressure(0, 1.0).is_err() && slope.set_pressure(9, 1.0).is_err());
    assert!(slope.set_strength_factor(-1.0).is_err());
    assert!(model("block_on_incline").set_water_level(1.0).is_err(), "a case without water");
    assert_eq!(slope.inputs(), model("coupled_slope").inputs());
}

#[test]
fn parameters_change_what_counts_at_time_zero() {
    let mut loaded = example("block_on_incline");
    let original = loaded.case.clone();
    let list = enmm::cosimulation::parameters(&loaded.case);
    let friction = list.iter().find(|p| p.name == "joint_law.joint.friction").unwrap();
    assert_eq!(friction.start, 20f64.to_radians(), "the friction of the stage in which time begins");
    apply(&mut loaded.case, friction, friction.start).unwrap();
    assert_eq!(loaded.case, original);
    assert!(apply(&mut loaded.case, friction, f64::NAN).is_err() && apply(&mut loaded.case, friction, -0.1).is_err());
    apply(&mut loaded.case, friction, 10f64.to_radians()).unwrap();
    let mut model = LoadedCase::of(loaded.case, "changed").unwrap().cosimulation().unwrap();
    model.start().unwrap();
    let start = model.block_states()[1].displacement;
    model.do_step(0.0, 1.0).unwrap();
    let slid = (model.block_states()[1].displacement - start).norm();
    assert!((slid - 1.703489).abs() < 2e-4, "{slid}");
    for p in &list {
        let mut case = original.clone();
        apply(&mut case, p, if p.start > 0.0 { 0.9 * p.start } else { 0.1 * p.high.min(10.0) }).unwrap();
        assert_ne!(case, original, "{} does nothing", p.name);
    }
}

#[test]
fn threads_do_not_change_the_bits() {
    let text = text_of("fractured_slope");
    let settle = text.find("[[stage]]").unwrap()..text.find("[[stage]]\nname = \"failure\"").unwrap();
    let loaded = parse_case(&text.replace(&text[settle], ""), "failing.toml", Path::new("")).unwrap();
    let mut serial = loaded.cosimulation().unwrap();
    let mut parallel = loaded.cosimulation().unwrap();
    assert!(parallel.set_threads(0).is_err() && parallel.set_threads(100_000).is_err());
    parallel.set_threads(3).unwrap();
    let h = 20.0 * serial.internal_step();
    serial.do_step(0.0, h).unwrap();
    parallel.do_step(0.0, h).unwrap();
    assert_eq!(serial.block_states(), parallel.block_states());
}

/// A block of 1000 kg/m in empty space.
fn free_block() -> Cosimulation {
    let text = r#"
title = "Free block"
domain.outline = [[0, 0], [1, 0], [1, 1], [0, 1]]
mesh.size = 0.5
gravity.y = 0.0
rock.r = { density = 1000, young = 1e8, poisson = 0.2 }
solver.communication_step = 0.01
stage = [{ name = "fly", kind = "dynamic", duration = 1.0, damping = 0.0 }]
"#;
    parse_case(text, "free.toml", Path::new("")).unwrap().cosimulation().unwrap()
}

fn push(model: &mut Cosimulation, force: f64) {
    model.set_block_force(0, Vector::new(force, 0.0), 0.0).unwrap();
}

fn speed(model: &Cosimulation) -> f64 {
    model.block_states()[0].velocity.x
}

#[test]
fn a_linear_input_goes_on_after_an_early_end_whatever_else_is_set() {
    // From 0 to 1000 N/m over 0.4 s, left at 0.1 s: v = ∫F/m = ½·0.1·0.25; then on to 1000 over 0.3 s: + 0.3·0.625.
    for left_by_shortening in [false, true] {
        let mut model = free_block();
        model.set_interpolation(Interpolation::Linear);
        model.start().unwrap();
        push(&mut model, 1000.0);
        let mut interval = model.begin(0.0, 0.4).unwrap();
        if left_by_shortening {
            model.shorten(&mut interval, 0.1);
            while model.advance(&mut interval).unwrap() {}
        } else {
            while model.time() < 0.1 - 1e-9 {
                assert!(model.advance(&mut interval).unwrap());
            }
            model.leave(interval);
        }
        assert!((model.time() - 0.1).abs() < 1e-9);
        assert!((speed(&model) - 0.0125).abs() < 2e-4, "{}", speed(&model));
        model.set_strength_factor(0.5).unwrap();
        model.do_step(0.1, 0.3).unwrap();
        assert!((speed(&model) - 0.0125 - 0.1875).abs() < 4e-4, "{}", speed(&model));
    }
}

#[test]
fn an_interval_that_is_over_moves_nothing() {
    let mut model = model("block_on_incline");
    model.do_step(0.0, 0.0105).unwrap();
    let (before, saved) = (model.block_states(), model.save());
    let interval = model.begin(0.0105, 0.01).unwrap();
    let info = model.leave(interval);
    assert_eq!((info.steps, info.time, model.time()), (0, 0.0105, 0.0105), "nothing was done, nothing is lost");
    assert_eq!(model.block_states(), before);

    let mut first = model.begin(0.0105, 0.01).unwrap();
    model.advance(&mut first).unwrap();
    model.restore(&saved).unwrap();
    assert!(matches!(model.advance(&mut first), Err(CosimulationError::Stale)));
    let mut second = model.begin(0.0105, 0.01).unwrap();
    assert!(matches!(model.advance(&mut first), Err(CosimulationError::Stale)));
    while model.advance(&mut second).unwrap() {}
    assert!(matches!(model.advance(&mut second), Err(CosimulationError::Stale)));
    assert_eq!(model.time(), 0.0105 + 0.01);
}

/// Steps may end anywhere after an input between grid points that is held, and after a linear one has arrived.
#[test]
fn divisions_of_what_follows_an_input_give_the_same_bits() {
    let held: &[&[f64]] = &[&[40.0], &[3.5, 3.7, 3.9, 40.0], &[3.6, 9.1, 9.2, 20.0, 40.0]];
    let linear: &[&[f64]] = &[&[10.4, 40.0], &[10.4, 12.0, 15.5, 15.6, 40.0]];
    for (interpolation, set, divisions) in [(Interpolation::Hold, 3.3, held), (Interpolation::Linear, 5.0, linear)] {
        let ends = divisions.iter().map(|ends| {
            let mut model = model("block_on_incline");
            model.set_interpolation(interpolation);
            let dt = model.internal_step();
            go(&mut model, set * dt);
            model.set_block_force(1, Vector::new(2e4, 0.0), 0.0).unwrap();
            ends.iter().for_each(|end| go(&mut model, end * dt));
            model.block_states()
        });
        let ends: Vec<_> = ends.collect();
        assert!(ends.iter().all(|states| *states == ends[0]), "{interpolation:?}: {ends:?}");
    }
}

#[test]
fn times_of_events_do_not_change_and_errors_tell_the_time_of_the_host() {
    let mut model = model("block_on_incline");
    model.do_step(0.0, 0.3).unwrap();
    let first = model.events().next().unwrap();
    for k in 0..20 {
        let t = model.time();
        model.do_step(t, 0.0103).unwrap();
        assert_eq!(model.events().next().unwrap(), first, "{k}");
    }
    model.set_block_force(1, Vector::new(1e15, 1e15), 0.0).unwrap();
    let t = model.time();
    match model.do_step(t, 0.01) {
        Err(CosimulationError::Step(error)) => assert!((error.time - t).abs() < 0.01, "{}", error.time),
        other => panic!("{other:?}"),
    }
}

#[test]
fn stages_of_odd_lengths_change_at_their_own_times() {
    let mut loaded = example("block_on_incline");
    let (mut slide, mut calm) = (loaded.case.stages[1].clone(), loaded.case.stages[0].clone());
    slide.duration = 0.05003;
    (calm.name, calm.duration, calm.ramp) = ("calm".into(), 0.01011, None);
    let mut last = slide.clone();
    last.name = "again".into();
    loaded.case.stages.truncate(1);
    loaded.case.stages.extend([slide, calm, last]);
    let loaded = LoadedCase::of(loaded.case, "stages").unwrap();
    let run = |h: f64| {
        let mut model = loaded.cosimulation().unwrap();
        run(&mut model, h, 0.1);
        go(&mut model, 0.12);
        assert_eq!(model.simulation().state().stage, 3);
        model.block_states()
    };
    let plain = run(0.01);
    assert_eq!(run(0.0123), plain);
    assert_eq!(run(0.1), plain);
}

#[test]
fn an_equilibrium_that_is_not_found_leaves_the_model_as_it_was() {
    let mut model = model("block_on_incline");
    let before = model.save();
    model.set_block_force(1, Vector::new(1e15, 1e15), 0.0).unwrap();
    let with_force = model.save();
    assert!(matches!(model.start(), Err(CosimulationError::Step(_))));
    assert!(!model.is_started() && model.time() == 0.0);
    let mut same = self::model("block_on_incline");
    same.restore(&with_force).unwrap();
    assert_eq!(model.inputs(), same.inputs());
    model.restore(&before).unwrap();
    model.start().unwrap();
    let mut plain = self::model("block_on_incline");
    plain.start().unwrap();
    assert_eq!(model.block_states(), plain.block_states());
}

#[test]
fn an_initial_stage_that_does_not_come_to_rest_says_so() {
    let mut calm = model("coupled_slope");
    calm.start().unwrap();
    assert_eq!(calm.initial_residual(), None);
    let mut loaded = example("coupled_slope");
    loaded.case.stages[0].duration = 0.3;
    let mut sliding = LoadedCase::of(loaded.case, "short").unwrap().cosimulation().unwrap();
    sliding.set_strength_factor(0.5).unwrap();
    sliding.start().unwrap();
    assert!(sliding.initial_residual().is_some_and(|ratio| ratio > 1e-3), "{:?}", sliding.initial_residual());
}

/// A ledger that lacks 1e9 J/m is looked at when four internal steps have been taken, and when they have doubled.
#[test]
fn energy_from_nowhere_is_told_to_hosts() {
    let mut model = model("block_on_incline");
    model.start().unwrap();
    let h = model.internal_step();
    let mut doubts = |lost: f64| -> Vec<u64> {
        let mut whole: Whole = decode(Keeper::Model, &model.serialize(&model.save()).unwrap(), model.hash()).unwrap();
        whole.state.ledger.baseline += lost;
        let saved = model.deserialize(&encode(Keeper::Model, &whole, model.hash()).unwrap()).unwrap();
        model.restore(&saved).unwrap();
        let begin = (model.time() / h).round() as u64;
        let steps = begin..begin + 20;
        let told = steps.filter_map(|k| model.do_step(k as f64 * h, h).unwrap().doubt.map(|doubt| (k + 1, doubt)));
        let told: Vec<_> = told.collect();
        assert!(told.iter().all(|(_, doubt)| doubt.contains("energy residual is -")), "{told:?}");
        told.into_iter().map(|(k, _)| k).collect()
    };
    assert_eq!(doubts(0.0), [0; 0]);
    assert_eq!(doubts(1e9), [32]);
    assert!(model.doubt().is_some());
}

/// The implicit integrator is a crate of its own, which hosts of the engine need not link.
#[test]
fn a_case_for_the_implicit_integrator_is_refused_with_its_remedy() {
    let text = text_of("block_on_incline").replace("[solver]\n", "[solver]\nintegrator = \"implicit\"\n");
    let loaded = parse_case(&text, "block.toml", Path::new(".")).unwrap_or_else(|e| panic!("{e}"));
    let refused = loaded.cosimulation().err().map(|error| error.to_string()).unwrap_or_default();
    for part in ["block.toml", "solver.integrator", "\"implicit\"", "use \"explicit\"", "the program enmm"] {
        assert!(refused.contains(part), "{part}: {refused}");
    }
}

#[test]
fn ports_are_found_by_name_and_their_blocks_take_forces_by_id_or_number() {
    let mut slope = model("coupled_slope");
    assert_eq!(["toe", "face", "plane"].map(|name| slope.find_port(name).unwrap()), [0, 1, 2]);
    let error = slope.find_port("crest").unwrap_err();
    assert!(matches!(error, CosimulationError::NoPort { .. }));
    assert_eq!(error.to_string(), "no port is named \"crest\"; ports of the case: toe, face, plane");
    let (id, number) = (slope.ports()[0].block, slope.port_block(0).unwrap());
    assert_eq!(id.number(), number);
    slope.set_block_force(id, [1e3, 2e3], 3.0).unwrap();
    let by_id = slope.inputs().clone();
    slope.set_block_force(number, [0.0, 0.0], 0.0).unwrap();
    assert_ne!(*slope.inputs(), by_id);
    slope.set_block_force(number, Vector::new(1e3, 2e3), 3.0).unwrap();
    assert_eq!(*slope.inputs(), by_id);
    let error = slope.set_block_force(u32::MAX, [0.0, 0.0], 0.0).unwrap_err().to_string();
    assert!(error.starts_with("block: is 4294967295, must be less than the number of blocks, 13;"), "{error}");
    let error = slope.port_block(3).unwrap_err().to_string();
    assert!(error.starts_with("port: is 3, must be less than the number of ports, 3;"), "{error}");
}

/// A contact that opens is forgotten, with the slip that it has summed up.
#[test]
fn the_slip_of_a_port_never_falls() {
    let mut slope = model("coupled_slope");
    slope.start().unwrap();
    let plane = slope.find_port("plane").unwrap();
    let now = |slope: &Cosimulation| slope.port_state(plane).slip;
    let of_contacts = |slope: &Cosimulation| {
        let boundary = &slope.simulation().model().boundary;
        let contacts = slope.simulation().state().contacts.iter();
        let of_port = contacts.filter(|contact| slope.ports()[plane].has(contact, boundary));
        of_port.map(|contact| contact.slip).fold(0.0, f64::max)
    };
    let (mut last, mut forgotten) = (now(&slope), false);
    assert!(last > 0.0);
    for k in 0..128 {
        let level = 6.0 + 0.05 * f64::from(k);
        slope.set_water_level(level).unwrap();
        slope.set_pressure(plane, 0.6 * 9.81e3 * (level - 9.0_f64).max(0.0)).unwrap();
        let end = slope.time() + 0.01;
        go(&mut slope, end);
        assert!(now(&slope) >= last, "step {k}: {last} m, then {} m", now(&slope));
        last = now(&slope);
        forgotten |= of_contacts(&slope) < last;
    }
    assert!(forgotten, "no contact was forgotten");
    let mut other = model("coupled_slope");
    other.restore(&slope.save()).unwrap();
    assert_eq!(now(&other), last);
}

#[test]
fn things_have_the_names_of_the_case_or_stand_ins() {
    let slope = model("fractured_slope");
    let names = |model: &Cosimulation, kind| -> Vec<String> {
        (0..model.name_count(kind)).map(|k| model.name(kind, k).unwrap()).collect()
    };
    let joints = names(&slope, Named::Joint);
    let mut unlike = joints.clone();
    unlike.sort();
    unlike.dedup();
    assert_eq!(unlike.len(), joints.len(), "each joint has a name of its own");
    assert_eq!(joints[2..4], ["joint[2]", "joint_set[0] trace 0"]);
    assert_eq!(joints.last().unwrap(), "joint_set[1] trace 52");
    let bridged = model("step_path");
    assert_eq!(names(&bridged, Named::Joint)[3..5], ["joint[3]", "rock bridge 4"]);
    assert_eq!(names(&bridged, Named::Law), ["joint", "rock"]);
    let error = slope.name(Named::Law, 9).unwrap_err().to_string();
    assert!(error.starts_with("index: is 9, must be less than the number of joint laws,"), "{error}");
}

#[test]
fn a_monitor_has_the_motion_of_its_place() {
    let mut incline = model("block_on_incline");
    go(&mut incline, 0.5);
    let (displacement, velocity) = incline.monitor_state(0).unwrap();
    let block = incline.block_states()[1];
    // It stands in the middle of a block that slides without turning.
    assert!((displacement - block.displacement).norm() < 1e-6 * block.displacement.norm());
    assert!((velocity - block.velocity).norm() < 1e-6 * block.velocity.norm());
    assert!(incline.monitor_state(1).is_err());
}

/// A watch that ends calls after so many looks, and what it has seen.
fn ending_after(looks: usize) -> (Watch, Arc<Mutex<Vec<Pace>>>) {
    let seen = Arc::new(Mutex::new(Vec::new()));
    let own = Arc::clone(&seen);
    let watch = move |pace: &Pace| {
        let mut seen = own.lock().unwrap();
        seen.push(*pace);
        if seen.len() < looks { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    (Box::new(watch), seen)
}

#[test]
fn an_interrupted_call_leaves_the_model_as_it_was_and_changes_nothing_later() {
    let bytes = |model: &Cosimulation| model.serialize(&model.save()).unwrap();
    let mut whole = model("coupled_slope");
    let mut slope = model("coupled_slope");
    let before = bytes(&slope);
    for call in [Cosimulation::start, |model: &mut Cosimulation| model.do_step(0.0, 1.0).map(|_| ())] {
        let (watch, seen) = ending_after(100);
        slope.set_watch(Some(watch));
        assert!(matches!(call(&mut slope), Err(CosimulationError::Interrupted)));
        assert_eq!(bytes(&slope), before, "nothing is left of the equilibrium");
        let last = seen.lock().unwrap()[99];
        assert!(last.is_equilibrium && last.unbalanced.is_some() && last.time > 0.0 && last.time < last.end);
    }
    slope.set_watch(None);
    slope.do_step(0.0, 0.0123).unwrap();
    whole.do_step(0.0, 0.0123).unwrap();
    let before = bytes(&slope);
    let (watch, seen) = ending_after(20);
    slope.set_watch(Some(watch));
    assert!(matches!(slope.do_step(0.0123, 1e8), Err(CosimulationError::Interrupted)));
    assert_eq!(bytes(&slope), before);
    let last = seen.lock().unwrap()[19];
    assert!(!last.is_equilibrium && last.unbalanced.is_none() && last.end == 1e8 + 0.0123);
    assert!((last.time - 0.012 - 19.0 * slope.internal_step()).abs() < 2.0 * slope.internal_step(), "{last:?}");
    let (watch, _) = ending_after(usize::MAX);
    slope.set_watch(Some(watch));
    slope.do_step(0.0123, 0.05).unwrap();
    whole.do_step(0.0123, 0.05).unwrap();
    assert_eq!(bytes(&slope), bytes(&whole), "a watch changes no bit");
}
