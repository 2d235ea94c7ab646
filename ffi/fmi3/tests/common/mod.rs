//! An importer of FMI 3 that calls the C functions.

use std::ffi::{CStr, CString, c_void};
use std::path::{Path, PathBuf};
use std::ptr::null_mut;
use std::sync::Mutex;

use enmm_fmi::table::{Table, Version};
use enmm_fmi3::*;
use enmm_io::{LoadedCase, parse_case};

pub const OK: Status = Status::Ok;
pub const ERROR: Status = Status::Error;

/// Resources and table of an FMU.
pub struct Fmu {
    pub folder: tempfile::TempDir,
    pub table: Table,
}

impl Fmu {
    pub fn of(loaded: LoadedCase) -> Self {
        let folder = tempfile::tempdir().unwrap();
        write_resources(&loaded, folder.path());
        let blocks = loaded.cosimulation().unwrap().block_states().len();
        let table = Table::new(&loaded.case, blocks, &loaded.hash, Version::Three);
        Self { folder, table }
    }

    pub fn boxed() -> Self {
        Self::of(parse_case(include_str!("box.toml"), "box.toml", Path::new(".")).unwrap())
    }

    /// The box of rock of 50 Pa instead of 10 GPa, which comes to rest within two steps by an energy that is not there.
    pub fn soft() -> Self {
        let text = include_str!("box.toml").replace("young = 10e9", "young = 50");
        let text = text.replace("duration = 1.0", "duration = 5.0").replace("duration = 0.5", "duration = 50.0");
        let text = text.replace("communication_step = 0.01", "");
        Self::of(parse_case(&text, "soft.toml", Path::new(".")).unwrap())
    }

    pub fn reference(&self, name: &str) -> u32 {
        let found = self.table.variables.iter().find(|v| v.name == name);
        found.unwrap_or_else(|| panic!("no variable {name}")).reference
    }

    pub fn path(&self) -> PathBuf {
        self.folder.path().join("resources/")
    }

    pub fn instance(&self) -> Instance<'_> {
        self.instantiate(&Options::default()).unwrap()
    }

    pub fn started(&self) -> Instance<'_> {
        let instance = self.instance();
        instance.start();
        instance
    }

    pub fn instantiate(&self, options: &Options) -> Result<Instance<'_>, Vec<Line>> {
        let log = Box::new(Log::default());
        let token = CString::new(options.token.as_deref().unwrap_or(&self.table.token)).unwrap();
        let path = options.path.clone().unwrap_or_else(|| self.path());
        let path = CString::new(path.to_str().unwrap()).unwrap();
        let pointer = unsafe {
            fmi3InstantiateCoSimulation(
                c"box".as_ptr(),
                token.as_ptr(),
                path.as_ptr(),
                false,
                options.logging,
                options.event_mode,
                options.early_return,
                options.required.as_ptr(),
                options.required.len(),
                (&raw const *log).cast_mut().cast(),
                Some(take_line),
                options.update,
            )
        };
        if pointer.is_null() {
            return Err(log.lines.lock().unwrap().clone());
        }
        Ok(Instance { fmu: self, pointer, log })
    }
}

pub fn write_resources(loaded: &LoadedCase, folder: &Path) {
    let resources = folder.join("resources");
    std::fs::create_dir_all(&resources).unwrap();
    std::fs::write(resources.join("case.json"), enmm_fmi::resource::encode(loaded, "case").unwrap()).unwrap();
}

/// Choices of an importer.
#[derive(Default, Clone)]
pub struct Options {
    pub token: Option<String>,
    pub path: Option<PathBuf>,
    pub logging: bool,
    pub event_mode: bool,
    pub early_return: bool,
    pub required: Vec<u32>,
    pub update: Option<IntermediateUpdate>,
}

pub type Line = (Status, String, String);

/// The environment of an instance: its log, and what its updates do and see.
#[derive(Default)]
pub struct Log {
    pub lines: Mutex<Vec<Line>>,
    /// Action of the logger at the next message.
    pub meddle: Mutex<Option<Meddle>>,
    pub updates: Mutex<Updates>,
}

pub type Meddle = Box<dyn FnOnce() + Send>;

#[derive(Default)]
pub struct Updates {
    pub instance: usize,
    pub references: Vec<u32>,
    pub seen: Vec<(f64, Vec<f64>, bool)>,
    /// Time from which on an early return is requested, and the time that is requested.
    pub ask: Option<(f64, f64)>,
    /// Statuses of calls that are illegal within an update.
    pub illegal: Vec<Status>,
    pub try_illegal: bool,
}

unsafe extern "C" fn take_line(environment: *mut c_void, status: Status, category: Text, message: Text) {
    let log = unsafe { &*environment.cast::<Log>() };
    let text = |pointer| unsafe { CStr::from_ptr(pointer) }.to_str().unwrap().to_owned();
    log.lines.lock().unwrap().push((status, text(category), text(message)));
    let meddle = log.meddle.lock().unwrap().take();
    if let Some(meddle) = meddle {
        meddle();
    }
}

pub unsafe extern "C" fn update(
    environment: *mut c_void,
    time: f64,
    set_requested: bool,
    get_allowed: bool,
    finished: bool,
    can_return: bool,
    wanted: *mut bool,
    wanted_time: *mut f64,
) {
    assert!(!set_requested && get_allowed && finished);
    let log = unsafe { &*environment.cast::<Log>() };
    let mut updates = log.updates.lock().unwrap();
    let instance: *mut c_void = updates.instance as *mut c_void;
    let n = updates.references.len();
    let mut values = vec![0.0; n];
    let status = unsafe { fmi3GetFloat64(instance, updates.references.as_ptr(), n, values.as_mut_ptr(), n) };
    assert_eq!(status, OK);
    if updates.try_illegal {
        fmi3FreeInstance(instance);
        updates.illegal.push(fmi3Reset(instance));
    }
    updates.seen.push((time, values, can_return));
    if let Some((_, at)) = updates.ask.filter(|&(from, _)| time >= from) {
        unsafe { (wanted.write(true), wanted_time.write(at)) };
    }
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
        assert_eq!(fmi3EnterInitializationMode(self.pointer, false, 0.0, 0.0, false, 0.0), OK);
        assert_eq!(fmi3ExitInitializationMode(self.pointer), OK, "{:?}", self.log.lines);
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
