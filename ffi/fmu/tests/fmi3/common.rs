//! An importer of FMI 3 that calls the C functions.

use std::ffi::{CStr, CString, c_void};
use std::ptr::{null, null_mut};
use std::sync::Mutex;
use std::sync::atomic::{AtomicPtr, AtomicUsize, Ordering::Relaxed};

use enmm_fmu::fmi3::*;

pub use crate::boxed::{BOX, Line, doubts};

pub type Fmu = crate::boxed::Fmu<3>;
pub const OK: Status = Status::Ok;
pub const ERROR: Status = Status::Error;

impl Fmu {
    pub fn instance(&self) -> Instance<'_> {
        self.instantiate(false, None)
    }

    pub fn started(&self) -> Instance<'_> {
        let instance = self.instance();
        instance.start();
        instance
    }

    pub fn instantiate(&self, logging: bool, update: Option<IntermediateUpdate>) -> Instance<'_> {
        self.instantiate_with(logging, update, false)
    }

    pub fn instantiate_with(
        &self,
        logging: bool,
        update: Option<IntermediateUpdate>,
        event_mode: bool,
    ) -> Instance<'_> {
        let log = Box::new(Log::default());
        let token = CString::new(self.table.token.as_str()).unwrap();
        let path = CString::new(format!("{}/", self.resources().display())).unwrap();
        let (name, token, path) = (c"box".as_ptr(), token.as_c_str(), path.as_c_str());
        let (environment, no, take) = ((&raw const *log).cast_mut().cast(), false, Some(take_line as LogMessage));
        let pointer = unsafe {
            let (token, path) = (token.as_ptr(), path.as_ptr());
            fmi3InstantiateCoSimulation(
                name,
                token,
                path,
                no,
                logging,
                event_mode,
                no,
                null(),
                0,
                environment,
                take,
                update,
            )
        };
        assert!(!pointer.is_null(), "{:?}", log.lines);
        Instance { fmu: self, pointer, log }
    }
}

/// The environment of an instance: its messages, and what its updates see.
#[derive(Default)]
pub struct Log {
    pub lines: Mutex<Vec<Line>>,
    /// Action of the logger at the next message.
    pub meddle: Mutex<Option<Meddle>>,
    /// The instance whose values an update reads.
    pub instance: AtomicPtr<c_void>,
    /// Number of updates.
    pub updates: AtomicUsize,
}

pub type Meddle = Box<dyn FnOnce() + Send>;

unsafe extern "C" fn take_line(environment: *mut c_void, status: Status, category: Text, message: Text) {
    let log = unsafe { &*environment.cast::<Log>() };
    let text = |pointer| unsafe { CStr::from_ptr(pointer) }.to_str().unwrap().to_owned();
    log.lines.lock().unwrap().push((status, text(category), text(message)));
    let meddle = log.meddle.lock().unwrap().take();
    if let Some(meddle) = meddle {
        meddle();
    }
}

/// An update that reads within the step.
pub unsafe extern "C" fn update(
    environment: *mut c_void,
    _: f64,
    set_requested: bool,
    get_allowed: bool,
    finished: bool,
    _: bool,
    _: *mut bool,
    _: *mut f64,
) {
    assert!(!set_requested && get_allowed && finished);
    let log = unsafe { &*environment.cast::<Log>() };
    let (mut time, no) = ([0.0; 1], 0);
    let status = unsafe { fmi3GetFloat64(log.instance.load(Relaxed), null(), no, time.as_mut_ptr(), no) };
    assert_eq!(status, OK);
    log.updates.fetch_add(1, Relaxed);
}

/// An instance that is freed at the end.
pub struct Instance<'a> {
    pub fmu: &'a Fmu,
    pub pointer: *mut c_void,
    pub log: Box<Log>,
}

unsafe impl Send for Instance<'_> {}

impl Drop for Instance<'_> {
    fn drop(&mut self) {
        fmi3FreeInstance(self.pointer);
    }
}

impl Instance<'_> {
    pub fn start(&self) {
        self.start_as(OK);
    }

    /// Starts with this status at the end of initialization.
    pub fn start_as(&self, status: Status) {
        assert_eq!(fmi3EnterInitializationMode(self.pointer, false, 0.0, 0.0, false, 0.0), OK);
        assert_eq!(fmi3ExitInitializationMode(self.pointer), status, "{:?}", self.log.lines);
    }

    pub fn lines(&self) -> Vec<Line> {
        self.log.lines.lock().unwrap().clone()
    }

    pub fn last_line(&self) -> String {
        self.lines().last().map(|line| line.2.clone()).unwrap_or_default()
    }

    pub fn get(&self, name: &str) -> Vec<f64> {
        let v = self.fmu.table.get(self.fmu.reference(name)).unwrap();
        let mut values = vec![0.0; v.size()];
        let status = unsafe { fmi3GetFloat64(self.pointer, &v.reference, 1, values.as_mut_ptr(), values.len()) };
        assert_eq!(status, OK, "{name}: {}", self.last_line());
        values
    }

    pub fn set(&self, name: &str, values: &[f64]) -> Status {
        unsafe { fmi3SetFloat64(self.pointer, &self.fmu.reference(name), 1, values.as_ptr(), values.len()) }
    }

    pub fn snapshot(&self) -> Vec<u8> {
        let (mut size, mut bytes) = (0, std::ptr::null());
        let reference = self.fmu.reference("snapshot");
        let status = unsafe { fmi3GetBinary(self.pointer, &reference, 1, &mut size, &mut bytes, 1) };
        assert_eq!(status, OK, "{}", self.last_line());
        unsafe { std::slice::from_raw_parts(bytes, size) }.to_vec()
    }

    /// Status, early return and last successful time of a step.
    pub fn step(&self, t: f64, h: f64) -> (Status, bool, f64) {
        let (mut event, mut terminate, mut early, mut last) = (true, true, true, f64::NAN);
        let status = unsafe { fmi3DoStep(self.pointer, t, h, true, &mut event, &mut terminate, &mut early, &mut last) };
        assert!(!event && !terminate);
        (status, early, last)
    }

    pub fn save(&self) -> *mut c_void {
        let mut state = null_mut();
        assert_eq!(unsafe { fmi3GetFMUState(self.pointer, &mut state) }, OK);
        assert!(!state.is_null());
        state
    }
}
