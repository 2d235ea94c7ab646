//! FMI 3 instances: what is refused at birth, which calls are legal when, what setters refuse, what the log says.

use std::ffi::c_void;
use std::ptr::{null, null_mut};

use crate::common::{ERROR, Fmu, OK, Options, write_resources};
use enmm_fmi3::*;

fn refusal(fmu: &Fmu, options: &Options) -> String {
    let lines = fmu.instantiate(options).err().expect("refused");
    assert_eq!(lines.len(), 1, "{lines:?}");
    assert_eq!((lines[0].0, lines[0].1.as_str()), (ERROR, "logStatusError"));
    lines[0].2.clone()
}

#[test]
fn wrong_tokens_flags_and_resources_are_refused_and_logged() {
    let fmu = Fmu::boxed();
    let plain = Options::default;
    assert!(refusal(&fmu, &Options { token: Some("wrong".into()), ..plain() }).contains("token"));
    assert!(refusal(&fmu, &Options { event_mode: true, ..plain() }).contains("hasEventMode"));
    assert!(refusal(&fmu, &Options { required: vec![9999], ..plain() }).contains("9999"));
    assert!(refusal(&fmu, &Options { path: Some("/nowhere".into()), ..plain() }).contains("cannot read"));
    let damaged = Fmu::boxed();
    std::fs::write(damaged.path().join("case.json"), "{").unwrap();
    assert!(refusal(&damaged, &plain()).contains("damaged"));
    assert!(fmu.instantiate(&Options { required: vec![fmu.reference("box.displacement_x")], ..plain() }).is_ok());
    let token = std::ffi::CString::new(fmu.table.token.as_str()).unwrap();
    let path = std::ffi::CString::new(fmu.path().to_str().unwrap()).unwrap();
    let (name, token, path) = (c"a".as_ptr(), token.as_ptr(), path.as_ptr());
    for [name, token, path] in
        [[null(), token, path], [c" ".as_ptr(), token, path], [name, null(), path], [name, token, null()]]
    {
        let made = unsafe {
            fmi3InstantiateCoSimulation(name, token, path, false, true, false, false, null(), 0, null_mut(), None, None)
        };
        assert!(made.is_null());
    }
    unsafe {
        assert!(fmi3InstantiateModelExchange(name, token, path, false, false, null_mut(), None).is_null());
        let made =
            fmi3InstantiateScheduledExecution(name, token, path, false, false, null_mut(), None, None, None, None);
        assert!(made.is_null());
        let made = fmi3InstantiateCoSimulation(
            name,
            token,
            path,
            false,
            false,
            false,
            false,
            null(),
            3,
            null_mut(),
            None,
            None,
        );
        assert!(made.is_null(), "intermediate variables are missing");
    }
}

#[test]
fn folders_with_blanks_umlauts_and_percent_signs_are_found() {
    let fmu = Fmu::boxed();
    for name in ["with blank", "Böschung", "a%20b"] {
        let folder = fmu.folder.path().join(name);
        write_resources(&fmu.loaded, &folder);
        for end in ["resources", "resources/"] {
            assert!(fmu.instantiate(&Options { path: Some(folder.join(end)), ..Options::default() }).is_ok(), "{name}");
        }
    }
}

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
fn capabilities_that_are_not_declared_are_refused() {
    let fmu = Fmu::boxed();
    let stubs: [fn(*mut c_void) -> Status; 8] = [
        |i| fmi3EnterEventMode(i),
        |i| fmi3EnterStepMode(i),
        |i| fmi3EnterConfigurationMode(i),
        |i| fmi3ExitConfigurationMode(i),
        |i| fmi3EvaluateDiscreteStates(i),
        |i| fmi3EnterContinuousTimeMode(i),
        |i| fmi3GetNumberOfVariableDependencies(i, 0, null_mut()),
        |i| fmi3GetNumberOfContinuousStates(i, null_mut()),
    ];
    for stub in stubs {
        let instance = fmu.started();
        assert_eq!(stub(instance.pointer), ERROR);
        assert_eq!(instance.lines().len(), 1);
        assert_eq!(stub(null_mut()), ERROR);
    }
}

#[test]
fn values_that_cannot_be_set_are_errors_and_a_saved_state_mends_them() {
    let fmu = Fmu::boxed();
    let instance = fmu.started();
    assert_eq!(instance.set("box.force_x", &[100.0]), OK);
    let state = instance.save();
    let before = instance.snapshot();
    for (name, value) in [
        ("box.force_x", f64::NAN),
        ("box.force_y", f64::INFINITY),
        ("water_level", f64::NEG_INFINITY),
        ("strength_factor", -1.0),
        ("gravity_y", 1e300),
        ("bed.pressure", 1e200),
        ("rock.stone.young", 1e10),
        ("kinetic_energy", 0.0),
        ("time", 0.0),
    ] {
        assert_eq!(instance.set(name, &[value]), ERROR, "{name}");
        assert!(instance.last_line().contains(name), "{}", instance.last_line());
        assert_eq!(instance.step(0.0, 0.01).0, ERROR);
        assert_eq!(instance.get("box.force_x"), [100.0]);
        assert_eq!(instance.restore(state), OK);
        assert_eq!(instance.snapshot(), before, "{name}");
    }
    assert_eq!(instance.step(0.0, 0.01).0, OK);
    let fresh = fmu.instance();
    assert_eq!(fresh.set("rock.stone.poisson", &[0.6]), ERROR);
    assert!(fresh.last_line().contains("rock.stone.poisson: is 0.6"), "{}", fresh.last_line());
}

#[test]
fn a_call_that_sets_many_values_sets_all_or_none() {
    let fmu = Fmu::boxed();
    let instance = fmu.started();
    let blocks = instance.get("block_x").len();
    assert_eq!(instance.set("block_force_x", &vec![9e14; blocks]), OK);
    let before = instance.snapshot();
    let set = |names: &[&str], values: &[f64]| {
        let references: Vec<u32> = names.iter().map(|name| fmu.reference(name)).collect();
        let n = references.len();
        unsafe { fmi3SetFloat64(instance.pointer, references.as_ptr(), n, values.as_ptr(), values.len()) }
    };
    // A value beyond its limits, and forces that only together are too large, after values that are welcome.
    for (names, values) in [
        (&["strength_factor", "bed.pressure", "gravity_x"][..], &[0.5, 10.0, 1e30][..]),
        (&["box.force_y", "face.pressure"], &[5.0, -2e15]),
        (&["gravity_x", "water_level", "box.force_x"], &[0.1, 0.5, 9e14]),
    ] {
        assert_eq!(set(names, values), ERROR);
        assert!(instance.last_line().contains(&names[names.len() - 1][..3]), "{}", instance.last_line());
        assert_eq!(instance.snapshot(), before, "{names:?}");
        for name in ["strength_factor", "bed.pressure", "gravity_x", "box.force_x", "box.force_y", "water_level"] {
            let start = fmu.table.get(fmu.reference(name)).unwrap().start.unwrap();
            assert_eq!(instance.get(name), [start], "{name}");
        }
        let state = fmi3Reset(instance.pointer);
        assert_eq!(state, OK);
        instance.start();
        assert_eq!(instance.set("block_force_x", &vec![9e14; blocks]), OK);
        assert_eq!(instance.snapshot(), before);
    }
}

#[test]
fn wrong_references_types_counts_and_pointers_are_errors() {
    let fmu = Fmu::boxed();
    let (real, array) = (fmu.reference("box.force_x"), fmu.reference("block_x"));
    let (integer, binary) = (fmu.reference("event_count"), fmu.reference("snapshot"));
    let mut values = [0.0; 4];
    let mut whole = [0; 4];
    let out = values.as_mut_ptr();
    let bad: Vec<Box<dyn Fn(*mut c_void) -> Status>> = vec![
        Box::new(move |i| unsafe { fmi3GetFloat64(i, &9999, 1, out, 1) }),
        Box::new(move |i| unsafe { fmi3GetFloat64(i, &integer, 1, out, 1) }),
        Box::new(move |i| unsafe { fmi3GetFloat64(i, &array, 1, out, 1) }),
        Box::new(move |i| unsafe { fmi3GetFloat64(i, &real, 1, out, 2) }),
        Box::new(move |i| unsafe { fmi3GetFloat64(i, &real, 1, null_mut(), 1) }),
        Box::new(move |i| unsafe { fmi3GetFloat64(i, null(), 1, out, 1) }),
        Box::new(move |i| unsafe { fmi3SetFloat64(i, &real, 1, null(), 1) }),
        Box::new(move |i| unsafe { fmi3SetFloat64(i, &real, 1, out, 0) }),
        Box::new(move |i| unsafe { fmi3GetBinary(i, &real, 1, &mut 0, &mut null(), 1) }),
        Box::new(move |i| unsafe { fmi3GetBinary(i, &binary, 1, null_mut(), &mut null(), 1) }),
        Box::new(move |i| fmi3GetFloat32(i, &real, 1, null_mut(), 1)),
        Box::new(move |i| unsafe { fmi3GetOutputDerivatives(i, &real, 1, &1, out, 1) }),
        Box::new(move |i| unsafe { fmi3GetOutputDerivatives(i, &array, 1, &2, out, 2) }),
    ];
    for (k, act) in bad.iter().enumerate() {
        let instance = fmu.started();
        assert_eq!(act(instance.pointer), ERROR, "{k}");
        assert_eq!(instance.lines().len(), 1, "{k}: {:?}", instance.lines());
        assert_eq!((act(null_mut()), act(17_000 as *mut c_void)), (ERROR, ERROR), "no instance");
    }
    let i = fmu.started();
    unsafe {
        assert_eq!(fmi3GetInt32(i.pointer, &real, 1, whole.as_mut_ptr(), 1), ERROR);
        assert_eq!(fmi3Reset(i.pointer), OK);
        assert_eq!(fmi3GetFloat64(i.pointer, null(), 0, null_mut(), 0), OK);
        assert_eq!(fmi3GetBinary(i.pointer, null(), 0, null_mut(), null_mut(), 0), OK);
    }
    assert_eq!(fmi3GetString(i.pointer, null(), 0, null_mut(), 0), OK);
    assert_eq!(fmi3SetClock(i.pointer, null(), 0, null()), OK);
    fmi3FreeInstance(null_mut());
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
fn derivatives_of_motions_are_their_velocities() {
    let fmu = Fmu::boxed();
    let instance = fmu.started();
    assert_eq!(instance.set("box.force_x", &[30e3]), OK);
    instance.run(0.01, 0.05);
    let names = ["box.displacement_x", "monitor.top.displacement_y", "block_rotation"];
    let references = names.map(|name| fmu.reference(name));
    let blocks = instance.get("block_rotation").len();
    let mut values = vec![0.0; 2 + blocks];
    let (pointer, n) = (instance.pointer, values.len());
    let orders = [1; 3];
    let status =
        unsafe { fmi3GetOutputDerivatives(pointer, references.as_ptr(), 3, orders.as_ptr(), values.as_mut_ptr(), n) };
    assert_eq!(status, OK, "{}", instance.last_line());
    let velocities = ["box.velocity_x", "monitor.top.velocity_y", "block_angular_velocity"];
    assert_eq!(values, velocities.map(|name| instance.get(name)).concat());
    assert_ne!(values[0], 0.0);
}

#[test]
fn logging_follows_the_categories() {
    let fmu = Fmu::boxed();
    let loud = fmu.instantiate(&Options { logging: true, ..Options::default() }).unwrap();
    assert!(loud.lines().iter().any(|line| line.1 == "logAll"));
    let instance = fmu.instance();
    let unknown = [c"logEvents".as_ptr(), c"logNothing".as_ptr()];
    assert_eq!(unsafe { fmi3SetDebugLogging(instance.pointer, true, 2, unknown.as_ptr()) }, ERROR);
    assert!(instance.last_line().contains("logNothing"));
    assert_eq!(unsafe { fmi3SetDebugLogging(instance.pointer, true, 1, unknown.as_ptr()) }, OK);
    instance.start();
    assert_eq!(instance.lines().len(), 1, "no logAll: {:?}", instance.lines());
    assert_eq!(unsafe { fmi3SetDebugLogging(instance.pointer, true, 1, null()) }, ERROR);
}

#[test]
fn slips_of_units_are_warnings_of_the_log() {
    let text = include_str!("common/box.toml").replace("density = 2650.0", "density = 26.5");
    let fmu = Fmu::of(enmm_io::parse_case(&text, "box.toml", std::path::Path::new(".")).unwrap());
    let instance = fmu.instantiate(&Options { logging: true, ..Options::default() }).unwrap();
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
