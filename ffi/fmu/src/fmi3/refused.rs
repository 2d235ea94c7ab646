//! Functions of capabilities that this FMU does not declare: they must exist, and refuse.

use super::types::{InstancePointer, Status, ValueReference, call};

macro_rules! refused {
    ($($reason:literal: { $($name:ident($($argument:ident: $kind:ty),*);)* })*) => {$($(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(instance: InstancePointer, $($argument: $kind),*) -> Status {
            call(instance, stringify!($name), |instance| instance.refuse($reason))
        }
    )*)*};
}

refused! {
    "this FMU has no discrete states to evaluate (providesEvaluateDiscreteStates=false)": {
        fmi3EvaluateDiscreteStates();
    }
    "this FMU has no structural parameters": {
        fmi3EnterConfigurationMode();
        fmi3ExitConfigurationMode();
    }
    "this FMU tells no dependencies (providesPerElementDependencies=false)": {
        fmi3GetNumberOfVariableDependencies(_reference: ValueReference, _n: *mut usize);
        fmi3GetVariableDependencies(
            _dependent: ValueReference, _elements_of_dependent: *mut usize, _independents: *mut ValueReference,
            _elements_of_independents: *mut usize, _kinds: *mut i32, _n: usize
        );
    }
    "this FMU has no partial derivatives (providesDirectionalDerivatives=false, providesAdjointDerivatives=false)": {
        fmi3GetDirectionalDerivative(
            _unknowns: *const ValueReference, _n_unknowns: usize, _knowns: *const ValueReference, _n_knowns: usize,
            _seed: *const f64, _n_seed: usize, _sensitivity: *mut f64, _n_sensitivity: usize
        );
        fmi3GetAdjointDerivative(
            _unknowns: *const ValueReference, _n_unknowns: usize, _knowns: *const ValueReference, _n_knowns: usize,
            _seed: *const f64, _n_seed: usize, _sensitivity: *mut f64, _n_sensitivity: usize
        );
    }
    "this FMU is for co-simulation only; use fmi3DoStep": {
        fmi3EnterContinuousTimeMode();
        fmi3CompletedIntegratorStep(_no_set_state: bool, _enter_event_mode: *mut bool, _terminate: *mut bool);
        fmi3SetTime(_time: f64);
        fmi3SetContinuousStates(_states: *const f64, _n: usize);
        fmi3GetContinuousStateDerivatives(_derivatives: *mut f64, _n: usize);
        fmi3GetEventIndicators(_indicators: *mut f64, _n: usize);
        fmi3GetContinuousStates(_states: *mut f64, _n: usize);
        fmi3GetNominalsOfContinuousStates(_nominals: *mut f64, _n: usize);
        fmi3GetNumberOfEventIndicators(_n: *mut usize);
        fmi3GetNumberOfContinuousStates(_n: *mut usize);
        fmi3ActivateModelPartition(_clock: ValueReference, _time: f64);
    }
}
