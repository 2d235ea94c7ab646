//! The FMI 2 library exports the functions of the standard and nothing else.

use std::path::PathBuf;

const FUNCTIONS: &str = "
    CancelStep CompletedIntegratorStep DeSerializeFMUstate DoStep EnterContinuousTimeMode EnterEventMode
    EnterInitializationMode ExitInitializationMode FreeFMUstate FreeInstance GetBoolean GetBooleanStatus
    GetContinuousStates GetDerivatives GetDirectionalDerivative GetEventIndicators GetFMUstate GetInteger
    GetIntegerStatus GetNominalsOfContinuousStates GetReal GetRealOutputDerivatives GetRealStatus GetStatus
    GetString GetStringStatus GetTypesPlatform GetVersion Instantiate NewDiscreteStates Reset SerializeFMUstate
    SerializedFMUstateSize SetBoolean SetContinuousStates SetDebugLogging SetFMUstate SetInteger SetReal
    SetRealInputDerivatives SetString SetTime SetupExperiment Terminate
";

/// The library next to this test.
fn library() -> PathBuf {
    let here = std::env::current_exe().unwrap();
    let folders = here.ancestors().skip(1).take(2);
    let places = folders.map(|folder| folder.join("libenmm_fmi2.so"));
    places.into_iter().find(|path| path.exists()).expect("the library is built with its tests")
}

#[test]
#[cfg(target_os = "linux")]
fn exactly_the_functions_of_the_standard_are_exported() {
    let listed = std::process::Command::new("nm").args(["-D", "--defined-only"]).arg(library()).output().unwrap();
    assert!(listed.status.success());
    let text = String::from_utf8(listed.stdout).unwrap();
    let mut names: Vec<&str> = text.lines().filter_map(|line| line.split_whitespace().nth(2)).collect();
    names.sort_unstable();
    let mut expected: Vec<String> = FUNCTIONS.split_whitespace().map(|name| format!("fmi2{name}")).collect();
    expected.sort_unstable();
    assert_eq!((expected.len(), names), (44, expected.iter().map(String::as_str).collect()));
}
