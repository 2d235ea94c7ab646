//! FMI 3 importers that call within a step: from the logger, and from another thread.

use std::ffi::c_void;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use super::common::{ERROR, Fmu, Instance, Log, OK, update};
use enmm_fmu::fmi3::*;

/// An update that only counts.
unsafe extern "C" fn count(
    environment: *mut c_void,
    _: f64,
    _: bool,
    _: bool,
    _: bool,
    _: bool,
    _: *mut bool,
    _: *mut f64,
) {
    unsafe { &*environment.cast::<Log>() }.updates.fetch_add(1, Relaxed);
}

/// An instance whose box is about to be lifted off, so that events come within the step.
fn lifted(fmu: &Fmu, update: Option<IntermediateUpdate>) -> Instance<'_> {
    let instance = fmu.instantiate(true, update);
    instance.start();
    assert_eq!(instance.set("box.force_y", &[60e3]), OK);
    instance.log.instance.store(instance.pointer, Relaxed);
    instance
}

#[test]
fn a_logger_that_calls_back_within_a_step_is_refused_and_the_step_goes_on() {
    let fmu = Fmu::boxed();
    let (plain, instance) = (lifted(&fmu, None), lifted(&fmu, Some(update)));
    assert_eq!(plain.step(0.0, 0.1), (OK, false, 0.1));
    let (address, force) = (instance.pointer as usize, fmu.reference("box.force_y"));
    let state = instance.save() as usize;
    let statuses = std::sync::Arc::new(std::sync::Mutex::new(Vec::new()));
    let told = statuses.clone();
    *instance.log.meddle.lock().unwrap() = Some(Box::new(move || {
        let at = |address| address as *mut c_void;
        let (mut flags, mut last, mut value, mut saved) = ([false; 3], 0.0, 0.0, at(0));
        let [event, terminate, early] = &mut flags;
        fmi3FreeInstance(at(address));
        *told.lock().unwrap() = unsafe {
            vec![
                fmi3Reset(at(address)),
                fmi3SetFMUState(at(address), at(state)),
                fmi3GetFMUState(at(address), &mut saved),
                fmi3SetFloat64(at(address), &force, 1, &0.0, 1),
                fmi3GetFloat64(at(address), &force, 1, &mut value, 1),
                fmi3DoStep(at(address), 0.0, 0.001, true, event, terminate, early, &mut last),
                fmi3Terminate(at(address)),
                fmi3EnterEventMode(at(address)),
            ]
        };
    }));
    assert_eq!(instance.step(0.0, 0.1), (OK, false, 0.1));
    assert_eq!(*statuses.lock().unwrap(), [ERROR; 8]);
    assert!(instance.lines().iter().any(|line| line.2.contains("`within a step`")));
    assert_eq!(instance.snapshot(), plain.snapshot());
    assert_eq!(instance.step(0.1, 0.01).0, OK);
}

#[test]
fn a_logger_may_free_the_instance_when_the_step_is_over() {
    let fmu = Fmu::boxed();
    let instance = lifted(&fmu, None);
    let address = instance.pointer as usize;
    *instance.log.meddle.lock().unwrap() = Some(Box::new(move || fmi3FreeInstance(address as *mut c_void)));
    assert_eq!(instance.step(0.0, 0.1), (OK, false, 0.1));
    assert_eq!(fmi3Reset(instance.pointer), ERROR, "it is gone");
}

#[test]
fn another_thread_that_asks_all_the_time_does_not_disturb_a_step() {
    let fmu = Fmu::boxed();
    let (plain, instance) = (lifted(&fmu, None), lifted(&fmu, Some(count)));
    assert_eq!(plain.step(0.0, 0.1), (OK, false, 0.1));
    let (address, time) = (instance.pointer as usize, fmu.reference("time"));
    let (log, over) = (&instance.log, &AtomicBool::new(false));
    std::thread::scope(|scope| {
        scope.spawn(move || {
            while !over.load(Relaxed) {
                if log.updates.load(Relaxed) > 0 {
                    let mut now = 0.0;
                    unsafe { fmi3GetFloat64(address as *mut c_void, &time, 1, &mut now, 1) };
                }
                std::thread::yield_now();
            }
        });
        let stepped = instance.step(0.0, 0.1);
        over.store(true, Relaxed);
        assert_eq!(stepped, (OK, false, 0.1));
    });
    assert_eq!(instance.snapshot(), plain.snapshot());
}
