//! The FMI 3 library exports the functions of the standard and nothing else.

use std::path::PathBuf;

const FUNCTIONS: &str = "
    ActivateModelPartition CompletedIntegratorStep DeserializeFMUState DoStep EnterConfigurationMode
    EnterContinuousTimeMode EnterEventMode EnterInitializationMode EnterStepMode EvaluateDiscreteStates
    ExitConfigurationMode ExitInitializationMode FreeFMUState FreeInstance GetAdjointDerivative GetBinary GetBoolean
    GetClock GetContinuousStateDerivatives GetContinuousStates GetDirectionalDerivative GetEventIndicators GetFMUState
    GetFloat32 GetFloat64 GetInt16 GetInt32 GetInt64 GetInt8 GetIntervalDecimal GetIntervalFraction
    GetNominalsOfContinuousStates GetNumberOfContinuousStates GetNumberOfEventIndicators
    GetNumberOfVariableDependencies GetOutputDerivatives GetShiftDecimal GetShiftFraction GetString GetUInt16 GetUInt32
    GetUInt64 GetUInt8 GetVariableDependencies GetVersion InstantiateCoSimulation InstantiateModelExchange
    InstantiateScheduledExecution Reset SerializeFMUState SerializedFMUStateSize SetBinary SetBoolean SetClock
    SetContinuousStates SetDebugLogging SetFMUState SetFloat32 SetFloat64 SetInt16 SetInt32 SetInt64 SetInt8
    SetIntervalDecimal SetIntervalFraction SetShiftDecimal SetShiftFraction SetString SetTime SetUInt16 SetUInt32
    SetUInt64 SetUInt8 Terminate UpdateDiscreteStates";

/// The library next to this test.
fn library() -> PathBuf {
    let here = std::env::current_exe().unwrap();
    let folders = here.ancestors().skip(1).take(2);
    let places = folders.map(|folder| folder.join("libenmm_fmi3.so"));
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
    let mut expected: Vec<String> = FUNCTIONS.split_whitespace().map(|name| format!("fmi3{name}")).collect();
    expected.sort_unstable();
    assert_eq!((expected.len(), names), (75, expected.iter().map(String::as_str).collect()));
}
