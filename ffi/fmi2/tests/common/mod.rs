//! An importer of FMI 2 that calls the C functions.

use std::ffi::{CStr, CString, c_void};
use std::path::Path;
use std::sync::Mutex;

use enmm_fmi::table::{Table, Version};
use enmm_fmi2::*;
use enmm_io::{LoadedCase, parse_case};

pub const OK: Status = Status::Ok;
pub const ERROR: Status = Status::Error;

/// Resources and table of an FMU.
pub struct Fmu {
    pub folder: tempfile::TempDir,
    pub table: Table,
}

impl Fmu {
    fn of(loaded: LoadedCase) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let resources = folder.path().join("resources");
        write_resources(&loaded, &resources);
        let blocks = loaded.cosimulation().unwrap().block_states().len();
        let table = Table::new(&loaded.case, blocks, &loaded.hash, Version::Two);
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

    pub fn uri(&self) -> String {
        format!("file://{}/resources", self.folder.path().display())
    }

    pub fn instance(&self) -> Instance<'_> {
        self.instantiate(&self.table.token, &self.uri(), 1, false).unwrap()
    }

    pub fn instantiate(&self, token: &str, uri: &str, kind: i32, logging: bool) -> Result<Instance<'_>, Vec<Line>> {
        let log = Box::new(Log::default());
        let (token, uri) = (CString::new(token).unwrap(), CString::new(uri).unwrap());
        let functions = CallbackFunctions {
            logger: Some(logger()),
            component_environment: (&raw const *log).cast_mut().cast(),
            ..CallbackFunctions::NONE
        };
        let name = c"box".as_ptr();
        let component =
            unsafe { fmi2Instantiate(name, kind, token.as_ptr(), uri.as_ptr(), &functions, 0, i32::from(logging)) };
        if component.is_null() {
            return Err(log.lines.lock().unwrap().clone());
        }
        Ok(Instance { fmu: self, component, log })
    }
}

pub fn write_resources(loaded: &LoadedCase, resources: &Path) {
    std::fs::create_dir_all(resources).unwrap();
    std::fs::write(resources.join("case.json"), enmm_fmi::resource::encode(loaded, "case").unwrap()).unwrap();
}

pub type Line = (Status, String, String);

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
        assert_eq!(fmi2SetupExperiment(self.component, 0, 0.0, 0.0, 0, 0.0), OK);
        assert_eq!(fmi2EnterInitializationMode(self.component), OK);
        assert_eq!(fmi2ExitInitializationMode(self.component), OK, "{:?}", self.log.lines);
    }

    pub fn lines(&self) -> Vec<Line> {
        self.log.lines.lock().unwrap().clone()
    }

    pub fn set(&self, name: &str, value: f64) -> Status {
        unsafe { fmi2SetReal(self.component, &self.fmu.reference(name), 1, &value) }
    }

    pub fn step(&self, t: f64, h: f64) -> Status {
        fmi2DoStep(self.component, t, h, 1)
    }
}
