//! FMI 3: the calls that each state allows, getters that fail, and warnings of the log.

use std::ffi::c_void;

use super::common::{BOX, ERROR, Fmu, OK, doubts};
use enmm_fmu::fmi3::*;

/// Every call that takes a value of an instance, by name.
type Calls = Vec<(&'static str, Box<dyn Fn(*mut c_void) -> Status>)>;

fn calls(fmu: &Fmu) -> Calls {
    let (input, output) = (fmu.reference("box.force_x"), fmu.reference("block_x"));
    let parameter = fmu.reference("rock.stone.young");
    let blocks = fmu.table.get(output).unwrap().size();
    let zero = 0.0;
    let start = fmu.table.get(parameter).unwrap().start.unwrap();
    vec![
        ("enter", Box::new(|i| fmi3EnterInitializationMode(i, false, 0.0, 0.0, false, 0.0))),
        ("exit", Box::new(|i| fmi3ExitInitializationMode(i))),
        ("terminate", Box::new(|i| fmi3Terminate(i))),
        ("get", Box::new(move |i| unsafe { fmi3GetFloat64(i, &output, 1, vec![0.0; blocks].as_mut_ptr(), blocks) })),
        ("get_start", Box::new(move |i| unsafe { fmi3GetFloat64(i, &input, 1, vec![0.0].as_mut_ptr(), 1) })),
        ("set", Box::new(move |i| unsafe { fmi3SetFloat64(i, &input, 1, &zero, 1) })),
        ("parameter", Box::new(move |i| unsafe { fmi3SetFloat64(i, &parameter, 1, &start, 1) })),
        (
            "step",
            Box::new(|i| {
                let (mut flags, mut last) = ([false; 3], 0.0);
                let [event, terminate, early] = &mut flags;
                unsafe { fmi3DoStep(i, 0.0, 0.001, true, event, terminate, early, &mut last) }
            }),
        ),
        ("reset", Box::new(|i| fmi3Reset(i))),
    ]
}

#[test]
fn each_state_allows_its_calls_and_no_others() {
    let fmu = Fmu::boxed();
    let state = |name: &str| {
        let instance = fmu.instance();
        if name != "instantiated" {
            assert_eq!(fmi3EnterInitializationMode(instance.pointer, false, 0.0, 0.0, false, 0.0), OK);
        }
        if !["instantiated", "initialization"].contains(&name) {
            assert_eq!(fmi3ExitInitializationMode(instance.pointer), OK);
        }
        if name == "terminated" {
            assert_eq!(fmi3Terminate(instance.pointer), OK);
        }
        if name == "error" {
            assert_eq!(instance.step(7.0, 1.0).0, ERROR);
        }
        instance
    };
    for (name, legal) in [
        ("instantiated", &["enter", "get_start", "set", "parameter", "reset"][..]),
        ("initialization", &["exit", "get", "get_start", "set", "parameter", "reset"]),
        ("step", &["get", "get_start", "set", "step", "terminate", "reset"]),
        ("terminated", &["get", "get_start", "reset"]),
        ("error", &["get", "get_start", "reset"]),
    ] {
        for (call, act) in calls(&fmu) {
            let instance = state(name);
            let lines = instance.lines().len();
            let expected = if legal.contains(&call) { OK } else { ERROR };
            assert_eq!(act(instance.pointer), expected, "{call} in {name}: {:?}", instance.lines());
            assert_eq!(instance.lines().len(), lines + usize::from(expected == ERROR), "{call} in {name}");
            if expected == ERROR {
                assert_eq!(instance.step(0.0, 0.001).0, ERROR, "after an error only a state, a reset or the end");
                assert_eq!(fmi3Reset(instance.pointer), OK);
                instance.start();
                assert_eq!(instance.step(0.0, 0.001).0, OK);
            }
        }
    }
}

#[test]
fn a_getter_that_fails_writes_nothing_and_one_that_works_needs_no_values_before() {
    use std::mem::MaybeUninit;
    let fmu = Fmu::boxed();
    let (real, other, array) = (fmu.reference("box.displacement_x"), fmu.reference("time"), fmu.reference("block_x"));
    let instance = fmu.started();
    let blocks = instance.get("block_x").len();
    let mut room = vec![MaybeUninit::<f64>::uninit(); blocks];
    let status = unsafe { fmi3GetFloat64(instance.pointer, &array, 1, room.as_mut_ptr().cast::<f64>(), room.len()) };
    assert_eq!(status, OK);
    let values: Vec<f64> = room.iter().map(|value| unsafe { value.assume_init() }).collect();
    assert_eq!(values, instance.get("block_x"));
    let mut values = [7.0; 2];
    let (references, out) = ([real, other], values.as_mut_ptr());
    unsafe {
        let orders = [1, 1];
        let status = fmi3GetOutputDerivatives(instance.pointer, references.as_ptr(), 2, orders.as_ptr(), out, 2);
        assert_eq!(status, ERROR, "time has no derivative that could be asked for");
        assert_eq!(fmi3GetFloat64(instance.pointer, [real, 9999].as_ptr(), 2, out, 2), ERROR);
    }
    assert_eq!(values, [7.0; 2]);
}

#[test]
fn slips_of_units_are_warnings_of_the_log() {
    let fmu = Fmu::of(&BOX.replace("density = 2650.0", "density = 26.5"));
    let instance = fmu.instantiate(true, None);
    instance.start();
    let told: Vec<_> = instance.lines().into_iter().filter(|line| line.1 == "logStatusWarning").collect();
    assert!(told.iter().any(|line| line.2.contains("rock.stone.density: is 26.5 kg/m³")), "{told:?}");
}

#[test]
fn time_has_no_value_before_initialization_mode() {
    let fmu = Fmu::boxed();
    let instance = fmu.instance();
    let (time, mut value) = (fmu.reference("time"), 7.0);
    assert_eq!(unsafe { fmi3GetFloat64(instance.pointer, &time, 1, &mut value, 1) }, ERROR);
    assert!(instance.last_line().contains("time: has no start value"), "{}", instance.last_line());
    assert_eq!(value, 7.0);
}

#[test]
fn energy_from_nowhere_is_a_warning_in_the_log() {
    let doubts_of = |fmu: &Fmu, status| {
        let instance = fmu.instantiate(true, None);
        instance.start_as(status);
        doubts(instance.lines())
    };
    assert_eq!(doubts_of(&Fmu::soft(), Status::Warning), [(Status::Warning, "logStatusWarning".to_owned())]);
    assert_eq!(doubts_of(&Fmu::boxed(), Status::Ok), []);
}

#[test]
fn places_for_the_end_of_a_step_are_looked_at_before_the_step() {
    let fmu = Fmu::boxed();
    let mut bytes = [0_u64; 2];
    let odd = bytes.as_mut_ptr().cast::<u8>().wrapping_add(1).cast::<f64>();
    for place in [odd, std::ptr::null_mut()] {
        let instance = fmu.instance();
        assert_eq!(fmi3EnterInitializationMode(instance.pointer, false, 0.0, 0.0, false, 0.0), OK);
        assert_eq!(fmi3ExitInitializationMode(instance.pointer), OK);
        let mut flags = [true; 3];
        let [event, terminate, early] = &mut flags;
        let refused = unsafe { fmi3DoStep(instance.pointer, 0.0, 0.001, true, event, terminate, early, place) };
        // A step that is done writes all that it can.
        assert_eq!((refused, flags), (ERROR, [true; 3]), "{place:?}");
    }
    assert_eq!(bytes, [0; 2]);
}

/// Two steps under a force that is set in event mode or in step mode.
fn moved(fmu: &Fmu, linear: bool, in_event_mode: bool) -> Vec<u64> {
    let instance = fmu.instantiate_with(false, None, true);
    let on = fmu.reference("interpolate_inputs");
    assert_eq!(unsafe { fmi3SetBoolean(instance.pointer, &on, 1, &linear, 1) }, OK);
    instance.start();
    if in_event_mode {
        assert_eq!(instance.set("box.force_x", &[1e5]), OK);
    }
    let (mut flags, mut next) = ([true; 5], f64::NAN);
    let [a, b, c, d, e] = &mut flags;
    assert_eq!(unsafe { fmi3UpdateDiscreteStates(instance.pointer, a, b, c, d, e, &mut next) }, OK);
    assert_eq!((flags, next), ([false; 5], 0.0));
    assert_eq!(fmi3EnterStepMode(instance.pointer), OK);
    if !in_event_mode {
        assert_eq!(instance.set("box.force_x", &[1e5]), OK);
    }
    for t in [0.0, 0.01] {
        assert_eq!(instance.step(t, 0.01).0, OK, "{}", instance.last_line());
    }
    ["box.displacement_x", "bed.shear_force", "kinetic_energy"].map(|name| instance.get(name)[0].to_bits()).to_vec()
}

#[test]
fn inputs_that_are_set_in_event_mode_jump() {
    let fmu = Fmu::boxed();
    let jumped = moved(&fmu, false, false);
    assert_eq!(moved(&fmu, true, true), jumped);
    assert_ne!(moved(&fmu, true, false), jumped, "in step mode they go linearly");
}

#[test]
fn steps_and_event_mode_have_an_order() {
    let fmu = Fmu::boxed();
    let instance = fmu.instantiate_with(false, None, true);
    instance.start();
    assert_eq!(instance.step(0.0, 0.01).0, ERROR);
    assert!(instance.last_line().contains("illegal in the state `event mode`"), "{}", instance.last_line());
    let plain = fmu.started();
    assert_eq!(fmi3EnterEventMode(plain.pointer), ERROR);
    assert!(plain.last_line().contains("eventModeUsed was false"), "{}", plain.last_line());
}
