//! FMI 2: the bits of the façade, legal calls, refused values, discarded steps, saved states, all spellings of
//! resources.

use std::ffi::c_void;
use std::ptr::{null, null_mut};

use crate::common::{ERROR, Fmu, OK, write_resources};
use enmm::geometry::Vector;
use enmm_fmi2::*;

#[test]
fn outputs_have_the_bits_of_the_facade_under_inputs_and_parameters() {
    for fmu in [Fmu::incline(), Fmu::boxed()] {
        let (instance, mut model) = (fmu.started(), fmu.model());
        let boxed = fmu.loaded.case.water.is_some();
        if boxed {
            for (name, value) in [("box.force_x", 2e3), ("box.moment", 9.0), ("face.pressure", 10.0)] {
                assert_eq!(instance.set(name, value), OK, "{}", instance.last_line());
            }
            model.start().unwrap();
            model.set_block_force(model.ports()[0].block.number(), Vector::new(2e3, 0.0), 9.0).unwrap();
            model.set_pressure(1, 10.0).unwrap();
        }
        instance.run(0.0, 0.01, 0.04);
        (0..4).fold(0.0, |t, _| {
            model.do_step(t, 0.01).unwrap();
            t + 0.01
        });
        let totals = model.totals();
        assert_eq!(instance.get("kinetic_energy"), totals.ledger.kinetic);
        assert_eq!(instance.get("displacement_max"), totals.displacement_max);
        let monitor = fmu.loaded.case.monitors[0].name.clone();
        assert_eq!(instance.get(&format!("monitor.{monitor}.velocity_x")), model.simulation().monitor(0).1.x);
        if boxed {
            assert_eq!(instance.get("box.rotation"), model.port_state(0).rotation);
            assert_eq!(instance.get("box.contact_force_y"), model.port_state(0).contact_force.y);
            assert_eq!(instance.get("bed.shear_force"), model.port_state(2).shear_force);
        }
        let mut count = 0;
        let reference = fmu.reference("locked_contacts");
        assert_eq!(unsafe { fmi2GetInteger(instance.component, &reference, 1, &mut count) }, OK);
        assert_eq!(count as u32, totals.locked_contacts);
    }
}

#[test]
fn steps_may_be_divided_and_reset_is_as_new() {
    let fmu = Fmu::boxed();
    let instance = fmu.started();
    instance.run(0.0, 0.04, 0.08);
    let first = instance.outputs();
    for h in [0.02, 0.004] {
        assert_eq!(fmi2Reset(instance.component), OK);
        instance.start();
        instance.run(0.0, h, 0.08);
        assert_eq!(instance.outputs(), first, "{h}");
    }
    assert_eq!(fmi2Reset(instance.component), OK);
    assert_eq!(instance.set("rock.stone.young", 2e10), OK);
    instance.start();
    instance.run(0.0, 0.02, 0.08);
    assert_ne!(instance.outputs(), first);
    assert_eq!(fmi2Reset(instance.component), OK);
    instance.start();
    instance.run(0.0, 0.02, 0.08);
    assert_eq!(instance.outputs(), first);
}

#[test]
fn resources_are_found_by_every_spelling_of_their_uri() {
    let fmu = Fmu::boxed();
    for (name, spelt) in [("a b", "a%20b"), ("a b", "a b"), ("Böschung", "B%C3%B6schung"), ("x%20y", "x%2520y")] {
        write_resources(&fmu.loaded, &fmu.folder.path().join(name).join("resources"));
        for prefix in ["file://", "file:", "file://localhost"] {
            let uri = format!("{prefix}{}/{spelt}/resources", fmu.folder.path().display());
            assert!(fmu.instantiate(&fmu.table.token, &uri, 1, false).is_ok(), "{uri}");
        }
    }
    for uri in ["", "resources", "http://a/b", "file:///nowhere"] {
        let lines = fmu.instantiate(&fmu.table.token, uri, 1, false).err().expect("refused");
        assert_eq!((lines.len(), lines[0].0, lines[0].1.as_str()), (1, ERROR, "logStatusError"), "{uri}");
    }
    assert!(fmu.instantiate("wrong", &fmu.uri(), 1, false).is_err_and(|lines| lines[0].2.contains("token")));
    assert!(fmu.instantiate(&fmu.table.token, &fmu.uri(), 0, false).is_err_and(|lines| lines.len() == 1));
    unsafe {
        let name = c"a".as_ptr();
        assert!(fmi2Instantiate(name, 1, name, null(), null(), 0, 0).is_null());
        let functions = CallbackFunctions::NONE;
        assert!(fmi2Instantiate(name, 1, name, null(), &functions, 0, 0).is_null());
        assert!(fmi2Instantiate(null(), 1, null(), null(), &functions, 0, 0).is_null());
    }
}

#[test]
fn each_state_allows_its_calls_and_no_others() {
    let fmu = Fmu::boxed();
    type Act<'a> = (&'a str, Box<dyn Fn(*mut c_void) -> Status>);
    let (input, output) = (fmu.reference("box.force_x"), fmu.reference("kinetic_energy"));
    let parameter = fmu.reference("rock.stone.young");
    let calls: Vec<Act> = vec![
        ("setup", Box::new(|c| fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0))),
        ("enter", Box::new(|c| fmi2EnterInitializationMode(c))),
        ("exit", Box::new(|c| fmi2ExitInitializationMode(c))),
        ("terminate", Box::new(|c| fmi2Terminate(c))),
        ("get", Box::new(move |c| unsafe { fmi2GetReal(c, &output, 1, &mut 0.0) })),
        ("set", Box::new(move |c| unsafe { fmi2SetReal(c, &input, 1, &0.0) })),
        ("parameter", Box::new(move |c| unsafe { fmi2SetReal(c, &parameter, 1, &1e10) })),
        ("step", Box::new(|c| fmi2DoStep(c, 0.0, 0.001, 1))),
        ("status", Box::new(|c| unsafe { fmi2GetRealStatus(c, 2, &mut 0.0) })),
        ("reset", Box::new(|c| fmi2Reset(c))),
    ];
    for (state, legal) in [
        ("instantiated", &["setup", "enter", "set", "parameter", "reset"][..]),
        ("initialization", &["exit", "get", "set", "parameter", "reset"]),
        ("step", &["get", "set", "step", "status", "terminate", "reset"]),
        ("failed", &["get", "set", "status", "terminate", "reset"]),
        ("terminated", &["get", "status", "reset"]),
        ("error", &["get", "reset"]),
    ] {
        for (call, act) in calls.iter().filter(|(call, _)| (state, *call) != ("failed", "step")) {
            let instance = fmu.instance();
            match state {
                "instantiated" => {}
                "initialization" => assert_eq!(fmi2EnterInitializationMode(instance.component), OK),
                _ => instance.start(),
            }
            match state {
                "failed" => {
                    assert_eq!(instance.set("box.force_x", 1e15), OK);
                    assert_eq!(instance.step(0.0, 0.05), Status::Discard);
                }
                "terminated" => assert_eq!(fmi2Terminate(instance.component), OK),
                "error" => assert_eq!(instance.step(5.0, 0.01), ERROR),
                _ => {}
            }
            let expected = if legal.contains(call) { OK } else { ERROR };
            let lines = instance.lines().len() + usize::from(expected == ERROR);
            assert_eq!(act(instance.component), expected, "{call} in {state}: {:?}", instance.lines());
            assert_eq!(instance.lines().len(), lines, "{call} in {state}");
        }
    }
}

#[test]
fn a_discarded_step_changes_nothing_and_tells_its_time() {
    let fmu = Fmu::boxed();
    let (instance, plain) = (fmu.started(), fmu.started());
    instance.run(0.0, 0.01, 0.01);
    plain.run(0.0, 0.01, 0.02);
    let before = instance.outputs();
    let state = instance.save();
    assert_eq!(instance.set("box.force_x", 1e15), OK);
    assert_eq!(instance.step(0.01, 0.05), Status::Discard);
    let (mut time, mut terminated, mut status) = (0.0, 1, OK);
    let c = instance.component;
    unsafe {
        assert_eq!(fmi2GetRealStatus(c, 2, &mut time), OK);
        assert_eq!(fmi2GetBooleanStatus(c, 3, &mut terminated), OK);
        assert_eq!(fmi2GetStatus(c, 0, &mut status), OK);
        assert_eq!(fmi2GetIntegerStatus(c, 0, &mut 0), Status::Discard);
        assert_eq!(fmi2GetStringStatus(c, 1, &mut null()), Status::Discard);
    }
    assert_eq!((time, terminated, status), (0.01, 0, Status::Discard));
    // Without a saved state, by another input; and with one.
    assert_eq!(instance.set("box.force_x", 0.0), OK);
    assert_eq!(instance.outputs(), before);
    assert_eq!(instance.step(0.01, 0.01), OK, "{}", instance.last_line());
    assert_eq!(instance.get("box.displacement_y"), plain.get("box.displacement_y"));
    assert_eq!(fmi2SetFMUstate(c, state), OK);
    assert_eq!(instance.step(0.01, 0.01), OK);
    assert_eq!(instance.outputs(), plain.outputs());
}

#[test]
fn bad_values_and_steps_are_errors_and_a_saved_state_mends_them() {
    let fmu = Fmu::boxed();
    let instance = fmu.started();
    let state = instance.save();
    let bad = [("box.force_x", f64::NAN), ("gravity_x", f64::INFINITY), ("strength_factor", -1.0), ("damping", 0.2)];
    for (name, value) in bad {
        assert_eq!(instance.set(name, value), ERROR);
        assert!(instance.last_line().contains(name), "{}", instance.last_line());
        assert_eq!(instance.step(0.0, 0.01), ERROR);
        assert_eq!(fmi2SetFMUstate(instance.component, state), OK);
    }
    for (t, h) in [(0.0, 0.0), (0.0, -1.0), (0.0, f64::NAN), (0.0, f64::INFINITY), (0.1, 0.01)] {
        assert_eq!(instance.step(t, h), ERROR, "{t} {h}");
        assert_eq!(fmi2SetFMUstate(instance.component, state), OK);
    }
    assert_eq!(instance.step(0.0, 0.01), OK);
    assert_eq!(fmi2Reset(instance.component), OK);
    assert_eq!(fmi2SetupExperiment(instance.component, 1, 1e-4, 0.0, 1, 0.01), OK);
    assert_eq!(fmi2EnterInitializationMode(instance.component), OK);
    assert_eq!(fmi2ExitInitializationMode(instance.component), OK);
    assert_eq!((instance.step(0.0, 0.01), instance.step(0.01, 0.01)), (OK, ERROR));
    let c = instance.component;
    let real = fmu.reference("box.force_x");
    let bad: [&dyn Fn() -> Status; 9] = unsafe {
        [
            &|| fmi2GetReal(c, &real, 1, null_mut()),
            &|| fmi2GetReal(c, &9999, 1, &mut 0.0),
            &|| fmi2GetInteger(c, &real, 1, &mut 0),
            &|| fmi2GetBoolean(c, &real, 1, &mut 0),
            &|| fmi2GetString(c, &real, 1, null_mut()),
            &|| fmi2SetRealInputDerivatives(c, &real, 1, &1, &0.0),
            &|| fmi2GetRealOutputDerivatives(c, &real, 1, &1, &mut 0.0),
            &|| fmi2GetDirectionalDerivative(c, null(), 0, null(), 0, null(), null_mut()),
            &|| fmi2CancelStep(c),
        ]
    };
    for (k, act) in bad.iter().enumerate() {
        assert_eq!(fmi2SetFMUstate(c, state), OK);
        assert_eq!((act(), instance.step(0.0, 0.01)), (ERROR, ERROR), "{k}");
    }
    assert_eq!((fmi2SetTime(c, 0.0), fmi2EnterEventMode(null_mut())), (ERROR, ERROR));
    assert_eq!(fmi2GetString(null_mut(), null(), 0, null_mut()), ERROR);
    fmi2FreeInstance(null_mut());
}

#[test]
fn states_survive_as_bytes_and_damage_is_refused() {
    let fmu = Fmu::boxed();
    let (instance, other) = (fmu.started(), fmu.instance());
    assert_eq!(instance.set("box.force_x", 2e3), OK);
    instance.run(0.0, 0.01, 0.02);
    let mut state = instance.save();
    let bytes = instance.bytes(state);
    instance.run(0.02, 0.01, 0.04);
    let (status, unpacked) = other.unpack(&bytes);
    assert_eq!((status, fmi2SetFMUstate(other.component, unpacked)), (OK, OK), "{}", other.last_line());
    other.run(0.02, 0.01, 0.04);
    assert_eq!(other.outputs(), instance.outputs());
    for place in (0..120).chain((120..bytes.len()).step_by(bytes.len() / 50)) {
        let mut damaged = bytes.clone();
        damaged[place] ^= 0x20;
        assert_eq!(other.unpack(&damaged), (ERROR, null_mut()), "byte {place}");
    }
    assert_eq!(other.unpack(&bytes[..bytes.len() - 1]).0, ERROR);
    assert_eq!(other.unpack(&[]).0, ERROR);
    assert_eq!(other.step(0.04, 0.01), OK, "the instance goes on");
    let old = state;
    unsafe {
        assert_eq!(fmi2FreeFMUstate(instance.component, &mut state), OK);
        assert_eq!((state.is_null(), fmi2FreeFMUstate(instance.component, &mut state)), (true, OK));
    }
    assert_eq!(fmi2SetFMUstate(instance.component, old), ERROR, "freed");
    assert_eq!(fmi2SetFMUstate(other.component, old), ERROR, "of another instance");
}

#[test]
fn derivatives_logging_and_whole_numbers() {
    let fmu = Fmu::boxed();
    let instance = fmu.instantiate(&fmu.table.token, &fmu.uri(), 1, true).unwrap();
    let c = instance.component;
    assert_eq!(instance.lines().last().map(|line| line.1.clone()).as_deref(), Some("logAll"));
    let (threads, linear) = (fmu.reference("threads"), fmu.reference("interpolate_inputs"));
    let (mut number, mut on) = (0, 0);
    unsafe {
        assert_eq!(fmi2SetInteger(c, &threads, 1, &2), OK);
        assert_eq!(fmi2SetBoolean(c, &linear, 1, &1), OK);
        instance.start();
        assert_eq!((fmi2GetInteger(c, &threads, 1, &mut number), fmi2GetBoolean(c, &linear, 1, &mut on)), (OK, OK));
    }
    assert_eq!((number, on), (2, 1));
    assert_eq!(instance.set("box.force_x", 30e3), OK);
    instance.run(0.0, 0.01, 0.02);
    let references = ["box.displacement_x", "monitor.top.displacement_y"].map(|name| fmu.reference(name));
    let mut values = [0.0; 2];
    let (orders, out) = ([1, 1], values.as_mut_ptr());
    assert_eq!(unsafe { fmi2GetRealOutputDerivatives(c, references.as_ptr(), 2, orders.as_ptr(), out) }, OK);
    assert_eq!(values, [instance.get("box.velocity_x"), instance.get("monitor.top.velocity_y")]);
    let names = [c"logStatusError".as_ptr(), c"logOther".as_ptr()];
    unsafe {
        assert_eq!(fmi2SetDebugLogging(c, 1, 1, names.as_ptr()), OK);
        assert_eq!(fmi2SetDebugLogging(c, 1, 2, names.as_ptr()), ERROR);
        assert_eq!(fmi2SetDebugLogging(c, 0, 0, null()), OK);
        assert_eq!(std::ffi::CStr::from_ptr(fmi2GetVersion()), c"2.0");
        assert_eq!(std::ffi::CStr::from_ptr(fmi2GetTypesPlatform()), c"default");
    }
}

#[test]
fn energy_from_nowhere_is_a_warning_in_the_log() {
    let doubts = |fmu: &Fmu| {
        let instance = fmu.instantiate(&fmu.table.token, &fmu.uri(), 1, true).unwrap();
        instance.start();
        let is_doubt = |(_, _, text): &crate::common::Line| text.contains(": the energy residual is ");
        instance
            .lines()
            .into_iter()
            .filter(is_doubt)
            .map(|(status, category, _)| (status, category))
            .collect::<Vec<_>>()
    };
    assert_eq!(doubts(&Fmu::soft()), [(Status::Warning, "logStatusWarning".to_owned())]);
    assert_eq!(doubts(&Fmu::boxed()), []);
}
