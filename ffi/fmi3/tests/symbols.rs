//! The FMI 3 library exports the functions of the standard and nothing else.

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

#[test]
#[cfg(target_os = "linux")]
fn exactly_the_functions_of_the_standard_are_exported() {
    crate::common::assert_exports("fmi3", 75, FUNCTIONS);
}
