//! FMI 2: the calls that each state allows, and a warning of the log.

use std::ffi::{CStr, CString, c_void};

use super::common::{ERROR, Fmu, OK, doubts};
use enmm_fmu::fmi2::*;

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
fn energy_from_nowhere_is_a_warning_in_the_log() {
    let doubts_of = |fmu: &Fmu, status| {
        let instance = fmu.instantiate(true);
        instance.start_as(status);
        doubts(instance.lines())
    };
    assert_eq!(doubts_of(&Fmu::soft(), Status::Warning), [(Status::Warning, "logStatusWarning".to_owned())]);
    assert_eq!(doubts_of(&Fmu::boxed(), Status::Ok), []);
}

/// Two steps under a force, from 0 to 100 kN/m within the first.
fn moved(instance: &super::common::Instance, go: impl FnOnce()) -> [u64; 3] {
    instance.start();
    go();
    for t in [0.0, 0.01] {
        assert_eq!(instance.step(t, 0.01), OK, "{:?}", instance.lines());
    }
    ["box.displacement_x", "bed.shear_force", "kinetic_energy"].map(|name| instance.get(name).to_bits())
}

#[test]
fn an_input_with_a_derivative_goes_linearly_through_one_step() {
    let fmu = Fmu::boxed();
    let (ramp, linear, jump) = (fmu.instance(), fmu.instance(), fmu.instance());
    let by_ramp = moved(&ramp, || assert_eq!(ramp.set_rate("box.force_x", 1, 1e7), OK));
    assert_eq!(ramp.get("box.force_x"), 1e5, "it stays where it has arrived");
    let on = fmu.reference("interpolate_inputs");
    assert_eq!(unsafe { fmi2SetBoolean(linear.component, &on, 1, &1) }, OK);
    assert_eq!(by_ramp, moved(&linear, || assert_eq!(linear.set("box.force_x", 1e5), OK)));
    assert_ne!(by_ramp, moved(&jump, || assert_eq!(jump.set("box.force_x", 1e5), OK)));
}

#[test]
fn derivatives_are_part_of_a_state_and_wrong_ones_are_refused() {
    let fmu = Fmu::boxed();
    let instance = fmu.instance();
    let mut state = std::ptr::null_mut();
    let first = moved(&instance, || {
        assert_eq!(instance.set_rate("box.force_x", 1, 1e7), OK);
        assert_eq!(unsafe { fmi2GetFMUstate(instance.component, &mut state) }, OK);
    });
    for (name, order, rate, told) in [
        ("box.force_x", 2, 1.0, "the order of the derivative is 2, must be 1"),
        ("box.force_x", 1, f64::NAN, "must be a finite number"),
        ("box.displacement_x", 1, 1.0, "is no input"),
    ] {
        assert_eq!(instance.set_rate(name, order, rate), ERROR);
        assert!(instance.lines().last().unwrap().2.contains(told), "{:?}", instance.lines());
        assert_eq!(fmi2SetFMUstate(instance.component, state), OK);
    }
    assert_eq!(instance.step(0.0, 0.01), OK);
    assert_eq!(instance.step(0.01, 0.01), OK);
    let names = ["box.displacement_x", "bed.shear_force", "kinetic_energy"];
    assert_eq!(first, names.map(|name| instance.get(name).to_bits()));
    assert_eq!(instance.set_rate("box.force_x", 1, 1e300), OK);
    assert_eq!(instance.step(0.02, 0.01), ERROR);
    assert!(instance.lines().last().unwrap().2.contains("at the end of the step, box.force_x: is"));
}

#[test]
fn results_go_to_the_folder_that_the_importer_names() {
    let (fmu, out) = (Fmu::boxed(), tempfile::tempdir().unwrap());
    let folder = out.path().join("results");
    let (reference, text) = (fmu.reference("results_folder"), CString::new(folder.to_str().unwrap()).unwrap());
    let instance = fmu.instance();
    assert_eq!(unsafe { fmi2SetString(instance.component, &reference, 1, &text.as_ptr()) }, OK);
    let plain = moved(&fmu.instance(), || {});
    assert_eq!(moved(&instance, || {}), plain, "recording changes no bit");
    let mut told = std::ptr::null();
    assert_eq!(unsafe { fmi2GetString(instance.component, &reference, 1, &mut told) }, OK);
    assert_eq!(unsafe { CStr::from_ptr(told) }, text.as_c_str());
    assert_eq!(fmi2Terminate(instance.component), OK);
    for name in ["summary.json", "history.csv", "report.html"] {
        assert!(folder.join(name).is_file(), "{name}");
    }
    assert_eq!(fmi2Reset(instance.component), OK);
    assert_eq!(
        unsafe { fmi2GetString(instance.component, &reference, 1, &mut told) },
        ERROR,
        "not before initialization"
    );
    let file = CString::new(out.path().join("results/summary.json").to_str().unwrap()).unwrap();
    assert_eq!(fmi2Reset(instance.component), OK);
    assert_eq!(unsafe { fmi2SetString(instance.component, &reference, 1, &file.as_ptr()) }, OK);
    assert_eq!(fmi2SetupExperiment(instance.component, 0, 0.0, 0.0, 0, 0.0), OK);
    assert_eq!(fmi2EnterInitializationMode(instance.component), OK);
    assert_eq!(fmi2ExitInitializationMode(instance.component), ERROR);
    assert!(instance.lines().last().unwrap().2.contains("results_folder: "), "{:?}", instance.lines());
}
