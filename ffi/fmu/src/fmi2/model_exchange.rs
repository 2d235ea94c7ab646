//! Functions of model exchange: they must exist, and refuse.

use super::types::{Boolean, Component, EventInfo, Real, Status, call};

fn refuse(c: Component, name: &str) -> Status {
    call(c, name, |instance| instance.refuse("this FMU is for co-simulation only; use fmi2DoStep"))
}

macro_rules! refused {
    ($($name:ident($($argument:ident: $kind:ty),*);)*) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(c: Component, $($argument: $kind),*) -> Status {
            refuse(c, stringify!($name))
        }
    )*};
}

refused! {
    fmi2EnterEventMode();
    fmi2NewDiscreteStates(_info: *mut EventInfo);
    fmi2EnterContinuousTimeMode();
    fmi2CompletedIntegratorStep(_no_set_state: Boolean, _enter_event_mode: *mut Boolean, _terminate: *mut Boolean);
    fmi2SetTime(_time: Real);
    fmi2SetContinuousStates(_x: *const Real, _n: usize);
    fmi2GetDerivatives(_derivatives: *mut Real, _n: usize);
    fmi2GetEventIndicators(_indicators: *mut Real, _n: usize);
    fmi2GetContinuousStates(_x: *mut Real, _n: usize);
    fmi2GetNominalsOfContinuousStates(_nominals: *mut Real, _n: usize);
}
