//! FMI 3 states: the same bits after a rollback and in another instance; damaged bytes and freed states are refused.

use std::ptr::null_mut;

use crate::common::{ERROR, Fmu, OK};
use enmm_fmi3::*;

#[test]
fn a_rollback_repeats_the_bits() {
    for fmu in [Fmu::incline(), Fmu::boxed()] {
        let instance = fmu.started();
        instance.run(0.007, 0.021);
        let state = instance.save();
        instance.run_from(0.021, 0.01, 0.051);
        let first = instance.snapshot();
        assert_eq!(instance.restore(state), OK);
        assert_eq!(instance.get("time"), [0.021]);
        instance.run_from(0.021, 0.01, 0.051);
        assert_eq!(instance.snapshot(), first);
    }
}

#[test]
fn a_state_in_bytes_goes_on_in_another_instance_with_the_same_bits() {
    let fmu = Fmu::boxed();
    let instance = fmu.instance();
    assert_eq!(instance.set("rock.stone.density", &[2500.0]), OK);
    instance.start();
    assert_eq!(instance.set("box.force_x", &[2e3]), OK);
    instance.run(0.01, 0.03);
    let state = instance.save();
    let bytes = instance.bytes(state);
    instance.run_from(0.03, 0.01, 0.05);
    let other = fmu.instance();
    let (status, unpacked) = other.unpack(&bytes);
    assert_eq!((status, other.restore(unpacked)), (OK, OK), "{}", other.last_line());
    assert_eq!((other.get("rock.stone.density"), other.get("box.force_x")), (vec![2500.0], vec![2e3]));
    other.run_from(0.03, 0.01, 0.05);
    assert_eq!(other.snapshot(), instance.snapshot());
    assert_eq!(other.bytes(unpacked), bytes, "and is written as it was read");
}

/// The test runs itself in a child process, which finds the bytes by a variable of its environment.
#[test]
fn a_state_in_bytes_goes_on_in_a_fresh_process_with_the_same_bits() {
    const FILE: &str = "ENMM_FMI3_STATE";
    let fmu = Fmu::boxed();
    let instance = fmu.instance();
    if let Some(file) = std::env::var_os(FILE) {
        let (status, state) = instance.unpack(&std::fs::read(&file).unwrap());
        assert_eq!((status, instance.restore(state)), (OK, OK), "{}", instance.last_line());
        instance.run_from(0.03, 0.01, 0.05);
        std::fs::write(file, instance.snapshot()).unwrap();
        return;
    }
    instance.start();
    assert_eq!(instance.set("box.force_x", &[2e3]), OK);
    instance.run(0.01, 0.03);
    let file = fmu.folder.path().join("state");
    std::fs::write(&file, instance.bytes(instance.save())).unwrap();
    let mut child = std::process::Command::new(std::env::current_exe().unwrap());
    let name = "saved::a_state_in_bytes_goes_on_in_a_fresh_process_with_the_same_bits";
    assert!(child.args(["--exact", name]).env(FILE, &file).output().unwrap().status.success());
    instance.run_from(0.03, 0.01, 0.05);
    assert_eq!(std::fs::read(&file).unwrap(), instance.snapshot());
}

#[test]
fn states_of_every_mode_can_be_restored() {
    let fmu = Fmu::boxed();
    let instance = fmu.instance();
    assert_eq!(instance.set("rock.stone.density", &[2500.0]), OK);
    assert_eq!(instance.set("box.force_x", &[2e3]), OK);
    let born = instance.save();
    assert_eq!(fmi3EnterInitializationMode(instance.pointer, false, 0.0, 0.0, false, 0.0), OK);
    let initialization = instance.save();
    assert_eq!(fmi3ExitInitializationMode(instance.pointer), OK);
    instance.run(0.01, 0.02);
    let first = instance.snapshot();
    assert_eq!(instance.restore(initialization), OK);
    assert_eq!(fmi3ExitInitializationMode(instance.pointer), OK, "{}", instance.last_line());
    instance.run(0.01, 0.02);
    assert_eq!(instance.snapshot(), first);
    let done = instance.save();
    assert_eq!(fmi3Terminate(instance.pointer), OK);
    let terminated = instance.save();
    assert_eq!(instance.restore(born), OK);
    instance.start();
    instance.run(0.01, 0.02);
    assert_eq!(instance.snapshot(), first);
    assert_eq!(instance.restore(terminated), OK);
    assert_eq!(fmi3Terminate(instance.pointer), ERROR);
    assert_eq!(instance.restore(done), OK);
    assert_eq!(instance.step(0.02, 0.01).0, OK);
    assert_eq!(fmi3Reset(instance.pointer), OK);
    assert_eq!(instance.restore(done), OK, "states outlive a reset");
    assert_eq!(instance.snapshot(), first);
}

#[test]
fn damaged_bytes_are_refused_and_the_instance_goes_on() {
    let fmu = Fmu::boxed();
    let (instance, plain) = (fmu.started(), fmu.started());
    let bytes = instance.bytes(instance.save());
    let n = bytes.len();
    let mut places: Vec<usize> = (0..160.min(n)).collect();
    places.extend((0..n).step_by(n / 97 + 1));
    for place in places {
        let mut damaged = bytes.clone();
        damaged[place] ^= 0x41;
        let (status, state) = instance.unpack(&damaged);
        assert_eq!((status, state), (ERROR, null_mut()), "byte {place}");
    }
    for length in [0, 1, 7, 8, 40, n / 2, n - 1] {
        assert_eq!(instance.unpack(&bytes[..length]).0, ERROR, "{length} bytes");
    }
    assert_eq!(instance.unpack(&[&bytes[..], &[0]].concat()).0, ERROR);
    let foreign = Fmu::incline();
    let of_other = foreign.started();
    assert_eq!(instance.unpack(&of_other.bytes(of_other.save())).0, ERROR, "of another model");
    assert!(instance.last_line().contains("no state of this FMU"), "{}", instance.last_line());
    instance.run(0.01, 0.02);
    plain.run(0.01, 0.02);
    assert_eq!(instance.snapshot(), plain.snapshot());
}

#[test]
fn freed_foreign_and_missing_states_are_refused() {
    let fmu = Fmu::boxed();
    let (instance, other) = (fmu.started(), fmu.started());
    let mut state = instance.save();
    assert_eq!(other.restore(state), ERROR);
    let old = state;
    instance.run(0.01, 0.01);
    assert_eq!(unsafe { fmi3GetFMUState(instance.pointer, &mut state) }, OK);
    assert_eq!(state, old, "the state is used again");
    assert_eq!(instance.restore(state), OK);
    assert_eq!(instance.get("time"), [0.01]);
    let mut size = instance.bytes(state).len();
    let mut bytes = vec![0; size];
    unsafe {
        assert_eq!(fmi3SerializeFMUState(instance.pointer, state, bytes.as_mut_ptr(), size - 1), ERROR);
        assert_eq!(fmi3SerializeFMUState(instance.pointer, state, null_mut(), size), ERROR);
        assert_eq!(fmi3SerializedFMUStateSize(instance.pointer, state, null_mut()), ERROR);
        assert_eq!(fmi3FreeFMUState(instance.pointer, &mut state), OK);
        assert!(state.is_null());
        assert_eq!(fmi3FreeFMUState(instance.pointer, &mut state), OK, "NULL is ignored");
        state = old;
        assert_eq!(fmi3FreeFMUState(instance.pointer, &mut state), ERROR);
        assert_eq!(fmi3GetFMUState(instance.pointer, &mut state), ERROR);
        assert_eq!(fmi3SerializedFMUStateSize(instance.pointer, old, &mut size), ERROR);
        assert_eq!(fmi3GetFMUState(instance.pointer, null_mut()), ERROR);
    }
    assert_eq!((instance.restore(old), instance.restore(null_mut())), (ERROR, ERROR));
    assert_eq!(instance.step(0.01, 0.01).0, OK, "the instance is as before");
}
