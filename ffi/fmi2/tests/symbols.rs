//! The FMI 2 library exports the functions of the standard and nothing else.

const FUNCTIONS: &str = "
    CancelStep CompletedIntegratorStep DeSerializeFMUstate DoStep EnterContinuousTimeMode EnterEventMode
    EnterInitializationMode ExitInitializationMode FreeFMUstate FreeInstance GetBoolean GetBooleanStatus
    GetContinuousStates GetDerivatives GetDirectionalDerivative GetEventIndicators GetFMUstate GetInteger
    GetIntegerStatus GetNominalsOfContinuousStates GetReal GetRealOutputDerivatives GetRealStatus GetStatus
    GetString GetStringStatus GetTypesPlatform GetVersion Instantiate NewDiscreteStates Reset SerializeFMUstate
    SerializedFMUstateSize SetBoolean SetContinuousStates SetDebugLogging SetFMUstate SetInteger SetReal
    SetRealInputDerivatives SetString SetTime SetupExperiment Terminate
";

#[test]
#[cfg(target_os = "linux")]
fn exactly_the_functions_of_the_standard_are_exported() {
    crate::common::assert_exports("fmi2", 44, FUNCTIONS);
}
