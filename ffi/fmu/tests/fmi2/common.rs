//! An importer of FMI 2 that calls the C functions.

use std::ffi::{CStr, CString, c_void};
use std::sync::Mutex;

use enmm_fmu::fmi2::*;

pub use crate::boxed::{Line, doubts};

pub type Fmu = crate::boxed::Fmu<2>;
pub const OK: Status = Status::Ok;
pub const ERROR: Status = Status::Error;

impl Fmu {
    pub fn instance(&self) -> Instance<'_> {
        self.instantiate(false)
    }

    pub fn instantiate(&self, logging: bool) -> Instance<'_> {
        let log = Box::new(Log::default());
        let token = CString::new(self.table.token.as_str()).unwrap();
        let uri = CString::new(format!("file://{}", self.resources().display())).unwrap();
        let functions = CallbackFunctions {
            logger: Some(logger()),
            component_environment: (&raw const *log).cast_mut().cast(),
            ..CallbackFunctions::NONE
        };
        let (name, logging) = (c"box".as_ptr(), i32::from(logging));
        let component =
            unsafe { fmi2Instantiate(name, CO_SIMULATION, token.as_ptr(), uri.as_ptr(), &functions, 0, logging) };
        assert!(!component.is_null(), "{:?}", log.lines);
        Instance { fmu: self, component, log }
    }
}

/// Messages of an instance.
#[derive(Default)]
pub struct Log {
    pub lines: Mutex<Vec<Line>>,
}

/// A function of six arguments that is called as a variadic one: on Linux both pass pointers alike.
fn logger() -> Logger {
    let function: unsafe extern "C" fn(*mut c_void, Text, Status, Text, Text, Text) = take_line;
    unsafe { std::mem::transmute(function) }
}

unsafe extern "C" fn take_line(
    environment: *mut c_void,
    name: Text,
    status: Status,
    category: Text,
    format: Text,
    message: Text,
) {
    let log = unsafe { &*environment.cast::<Log>() };
    let text = |pointer| unsafe { CStr::from_ptr(pointer) }.to_str().unwrap().to_owned();
    assert_eq!((text(name).as_str(), text(format).as_str()), ("box", "%s"));
    log.lines.lock().unwrap().push((status, text(category), text(message)));
}

/// An instance that is freed at the end.
pub struct Instance<'a> {
    pub fmu: &'a Fmu,
    pub component: *mut c_void,
    pub log: Box<Log>,
}

impl Drop for Instance<'_> {
    fn drop(&mut self) {
        fmi2FreeInstance(self.component);
    }
}

impl Instance<'_> {
    pub fn start(&self) {
        self.start_as(OK);
    }

    /// Starts with this status at the end of initialization.
    pub fn start_as(&self, status: Status) {
        assert_eq!(fmi2SetupExperiment(self.component, 0, 0.0, 0.0, 0, 0.0), OK);
        assert_eq!(fmi2EnterInitializationMode(self.component), OK);
        assert_eq!(fmi2ExitInitializationMode(self.component), status, "{:?}", self.log.lines);
    }

    pub fn lines(&self) -> Vec<Line> {
        self.log.lines.lock().unwrap().clone()
    }

    pub fn set(&self, name: &str, value: f64) -> Status {
        unsafe { fmi2SetReal(self.component, &self.fmu.reference(name), 1, &value) }
    }

    pub fn get(&self, name: &str) -> f64 {
        let mut value = f64::NAN;
        assert_eq!(unsafe { fmi2GetReal(self.component, &self.fmu.reference(name), 1, &mut value) }, OK, "{name}");
        value
    }

    /// Sets the derivative of an order.
    pub fn set_rate(&self, name: &str, order: i32, rate: f64) -> Status {
        unsafe { fmi2SetRealInputDerivatives(self.component, &self.fmu.reference(name), 1, &order, &rate) }
    }

    pub fn step(&self, t: f64, h: f64) -> Status {
        fmi2DoStep(self.component, t, h, 1)
    }
}
