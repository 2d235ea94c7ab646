//! The library of FMUs exports the functions of both standards and nothing else.
#![cfg(target_os = "linux")]

use std::process::Command;

/// Functions of FMI 2, without `fmi2`.
const OF_FMI2: &str = "
    CancelStep CompletedIntegratorStep DeSerializeFMUstate DoStep EnterContinuousTimeMode EnterEventMode
    EnterInitializationMode ExitInitializationMode FreeFMUstate FreeInstance GetBoolean GetBooleanStatus
    GetContinuousStates GetDerivatives GetDirectionalDerivative GetEventIndicators GetFMUstate GetInteger
    GetIntegerStatus GetNominalsOfContinuousStates GetReal GetRealOutputDerivatives GetRealStatus GetStatus
    GetString GetStringStatus GetTypesPlatform GetVersion Instantiate NewDiscreteStates Reset SerializeFMUstate
    SerializedFMUstateSize SetBoolean SetContinuousStates SetDebugLogging SetFMUstate SetInteger SetReal
    SetRealInputDerivatives SetString SetTime SetupExperiment Terminate
";
/// Functions of FMI 3, without `fmi3`.
const OF_FMI3: &str = "
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

#[test]
fn exactly_the_functions_of_the_standards_are_exported() {
    let here = std::env::current_exe().unwrap();
    let places = here.ancestors().skip(1).take(2).map(|folder| folder.join("libenmm_fmu.so"));
    let library = places.into_iter().find(|path| path.exists()).expect("the library is built with its tests");
    let listed = Command::new("nm").args(["-D", "--defined-only"]).arg(library).output().unwrap();
    assert!(listed.status.success());
    let text = String::from_utf8(listed.stdout).unwrap();
    let mut names: Vec<&str> = text.lines().filter_map(|line| line.split_whitespace().nth(2)).collect();
    names.sort_unstable();
    let of = |standard: &'static str, functions: &'static str| {
        functions.split_whitespace().map(move |name| format!("{standard}{name}"))
    };
    let mut expected: Vec<String> = of("fmi2", OF_FMI2).chain(of("fmi3", OF_FMI3)).collect();
    expected.sort_unstable();
    assert_eq!((names.len(), names), (44 + 75, expected.iter().map(String::as_str).collect()));
}
