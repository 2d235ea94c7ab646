//! FMI 2: the calls that each state allows, and a warning of the log.

use std::ffi::c_void;

use crate::common::{ERROR, Fmu, OK, doubts};
use enmm_fmi2::*;

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
