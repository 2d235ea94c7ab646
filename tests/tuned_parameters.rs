//! A host changes parameters by name: before the start as the case would have them, after it from the next step on;
//! they are part of the state, and a state goes into a model that differs in parameters alone.

use std::path::Path;

use crate::common::example as text_of;
use enmm::cosimulation::{Cosimulation, CosimulationError};
use enmm_io::parse_case;

const G: f64 = 9.81;

fn model(text: &str) -> Cosimulation {
    parse_case(text, "case", Path::new("")).unwrap().cosimulation().unwrap_or_else(|e| panic!("{e}"))
}

fn started(text: &str) -> Cosimulation {
    let mut model = model(text);
    model.start().unwrap();
    model
}

fn set(model: &mut Cosimulation, name: &str, value: f64) -> Result<(), CosimulationError> {
    let index = model.find_parameter(name)?;
    model.set_parameter(index, value)
}

fn value(model: &Cosimulation, name: &str) -> f64 {
    model.parameter_values()[model.find_parameter(name).unwrap()]
}

fn run(model: &mut Cosimulation, seconds: f64) -> Vec<u64> {
    model.do_step(model.time(), seconds).unwrap_or_else(|e| panic!("{e}"));
    model.block_states().iter().flat_map(|b| [b.displacement.x, b.displacement.y]).map(f64::to_bits).collect()
}

/// A block on a plane of 30 degrees: after a change of friction at 0.5 s it goes on with the speed that it has and
/// another acceleration. Half a step in which the old friction still acts is g·dt/4 of speed.
#[test]
fn a_block_slides_on_with_the_friction_that_holds() {
    let mut model = started(&text_of("block_on_incline"));
    let dip = 30f64.to_radians();
    let acceleration = |friction: f64| G * (dip.sin() - dip.cos() * friction.tan());
    let before = 20f64.to_radians();
    for after in [0.0, 10.0, 15.0, 25.0].map(f64::to_radians) {
        let mut model = model.clone();
        model.do_step(0.0, 0.5).unwrap();
        let start = model.block_states()[1].displacement;
        set(&mut model, "joint_law.joint.friction", after).unwrap();
        assert_eq!(value(&model, "joint_law.joint.friction"), after);
        model.do_step(0.5, 0.5).unwrap();
        let way = (model.block_states()[1].displacement - start).norm();
        let exact = 0.5 * acceleration(before) * 0.5 + 0.125 * acceleration(after);
        assert!((way / exact - 1.0).abs() < 2e-3, "{after}: {way} of {exact}");
    }
    let fixed = set(&mut model, "rock.rock.young", 5e9).unwrap_err().to_string();
    assert!(fixed.contains("rock.rock.young") && fixed.contains("once the model has started"), "{fixed}");
    for bad in [f64::NAN, -0.1, 1.6] {
        let error = set(&mut model, "joint_law.joint.friction", bad).unwrap_err().to_string();
        assert!(error.contains("joint_law.joint.friction") && error.contains("old value"), "{error}");
    }
    assert!(model.find_parameter("joint_law.weak.friction").unwrap_err().to_string().contains("joint_law.joint"));
}

/// Set before the start, values are those of a case that has them: same bits, same fingerprint.
#[test]
fn before_the_start_a_parameter_is_that_of_the_case() {
    let text = text_of("coupled_slope");
    let mut written =
        started(&text.replace("friction_deg = 26", "friction_deg = 25").replace("young = 5e9", "young = 4e9"));
    let mut given = model(&text);
    set(&mut given, "joint_law.weak.friction", 25f64.to_radians()).unwrap();
    set(&mut given, "rock.schist.young", 4e9).unwrap();
    given.start().unwrap();
    assert_eq!(written.hash(), given.hash());
    assert_eq!(run(&mut written, 0.1), run(&mut given, 0.1));
}

/// The state of a slope goes into slopes that have another friction, by a flag alone; the friction of the model then
/// acts, whether the case, a host before the start or a host after it has given it.
#[test]
fn a_state_goes_into_a_model_with_other_parameters() {
    let text = text_of("coupled_slope");
    let mut first = started(&text);
    run(&mut first, 0.05);
    let saved = first.save();
    let mut other = started(&text.replace("friction_deg = 26", "friction_deg = 23"));
    assert!(other.restore(&saved).is_err(), "without the flag");
    other.restore_keeping_parameters(&saved).unwrap();
    assert_eq!((other.time(), value(&other, "joint_law.weak.friction")), (0.05, 23f64.to_radians()));
    let moved = run(&mut other, 0.2);
    set(&mut first, "joint_law.weak.friction", 23f64.to_radians()).unwrap();
    assert_eq!(run(&mut first, 0.2), moved);
    let bytes = first.serialize(&saved).unwrap();
    assert!(other.deserialize(&bytes).is_err(), "without the flag");
    let back = other.deserialize_keeping_parameters(&bytes).unwrap();
    other.restore(&back).unwrap();
    assert_eq!(run(&mut other, 0.2), moved);
    // Of its own model a state brings its parameters along, or leaves those that hold.
    first.restore(&saved).unwrap();
    assert_eq!(value(&first, "joint_law.weak.friction"), 26f64.to_radians());
    let unmoved = run(&mut first, 0.2);
    assert_ne!(unmoved, moved);
    set(&mut first, "joint_law.weak.friction", 23f64.to_radians()).unwrap();
    first.restore_keeping_parameters(&saved).unwrap();
    assert_eq!(run(&mut first, 0.2), moved);
    let stiffer = started(&text.replace("young = 5e9", "young = 5e10"));
    let refused = { stiffer }.restore_keeping_parameters(&saved).unwrap_err().to_string();
    assert!(refused.contains("internal step"), "{refused}");
    let another = started(&text.replace("size = 2.0", "size = 2.1"));
    assert!({ another }.restore_keeping_parameters(&saved).is_err(), "another mesh");
}

/// A tuned model goes through bytes and a failed step with its values.
#[test]
fn parameters_are_part_of_the_state() {
    let text = text_of("coupled_slope");
    let mut model = started(&text);
    for (name, new) in [("joint_law.weak.friction", 0.41), ("joint_law.cross.cohesion", 2e4), ("damping", 0.3)] {
        assert!(model.parameters()[model.find_parameter(name).unwrap()].is_tunable, "{name}");
        set(&mut model, name, new).unwrap();
    }
    set(&mut model, "water.density", 1030.0).unwrap();
    let bytes = model.serialize(&model.save()).unwrap();
    let moved = run(&mut model, 0.1);
    let mut copy = started(&text);
    let saved = copy.deserialize(&bytes).unwrap();
    copy.restore(&saved).unwrap();
    assert_eq!((value(&copy, "damping"), value(&copy, "water.density")), (0.3, 1030.0));
    assert_eq!(run(&mut copy, 0.1), moved);
    let now = model.save();
    model.set_block_force(0, enmm::geometry::Vector::new(1e15, 1e15), 0.0).unwrap();
    set(&mut model, "damping", 0.1).unwrap();
    assert!(model.do_step(model.time(), 1.0).is_err(), "a force that no block bears");
    assert_eq!(value(&model, "damping"), 0.1, "what was set before a failed step stays");
    model.restore(&now).unwrap();
    assert_eq!(value(&model, "damping"), 0.3);
}

/// A bolt hangs a block; without it the block falls freely, and with it again it is caught.
#[test]
fn a_host_takes_a_bolt_away() {
    let text = "title = \"roof\"\ndomain.outline = [[-1, 0], [3, 0], [3, 1], [-1, 1]]\n\
        domain.islands = [[[0, -0.8], [2, -0.8], [2, 0], [0, 0]]]\nmesh = { size = 0.5, origin = [0.031, 0.017] }\n\
        joint_law.joint.friction_deg = 0.0\nrock.rock = { density = 2500, young = 2e10, poisson = 0.2 }\n\
        fix = [{ block = [-0.5, 0.5] }]\n\
        bolt = [{ name = \"bar\", points = [[1, -0.4], [1, 0.6]], young = 2e10, area = 1e-3 }]\n\
        stage = [{ name = \"settle\", kind = \"static\", duration = 20.0, convergence = 1e-7 },\n\
        { name = \"drop\", kind = \"dynamic\", duration = 2.0, damping = 0.0 }]\n";
    let mut model = started(text);
    assert_eq!(value(&model, "bolt.bar.active"), 1.0);
    assert!(set(&mut model, "bolt.bar.active", 0.5).unwrap_err().to_string().contains("0 or 1"));
    let hanging = model.block_states();
    let block = hanging.iter().position(|b| !b.fixed).unwrap();
    let start = hanging[block].displacement.y;
    run(&mut model, 0.1);
    assert!((model.block_states()[block].displacement.y - start).abs() < 1e-5);
    set(&mut model, "bolt.bar.active", 0.0).unwrap();
    run(&mut model, 0.1);
    let fallen = start - model.block_states()[block].displacement.y;
    assert!((fallen / (0.5 * G * 0.01) - 1.0).abs() < 0.01, "{fallen}");
    let ledger = model.energies();
    assert!(ledger.residual().abs() < 0.01 * ledger.kinetic, "{ledger:?}");
    let mut bare = self::model(text);
    set(&mut bare, "bolt.bar.active", 0.0).unwrap();
    assert!(!bare.case().bolts[0].active);
}
