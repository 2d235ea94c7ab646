//! FMI 3 steps have the bits of the façade, however instances, threads and communication steps are arranged.

use crate::common::{ERROR, Fmu, Instance, OK, Options, update};
use enmm::geometry::Vector;
use enmm_fmi3::{Status, fmi3EnterInitializationMode, fmi3ExitInitializationMode, fmi3Reset};

#[test]
fn every_output_has_the_bits_of_the_facade() {
    for fmu in [Fmu::incline(), Fmu::boxed()] {
        let (instance, mut model) = (fmu.started(), fmu.model());
        model.start().unwrap();
        assert_eq!(instance.snapshot(), model.serialize(&model.save()).unwrap());
        instance.run(0.01, 0.05);
        let mut t = 0.0;
        for _ in 0..5 {
            model.do_step(t, 0.01).unwrap();
            t += 0.01;
        }
        assert_eq!(instance.snapshot(), model.serialize(&model.save()).unwrap());
        let states = model.block_states();
        let each = |of: &dyn Fn(&enmm::model::BlockState) -> f64| states.iter().map(of).collect::<Vec<_>>();
        assert_eq!(instance.get("block_x"), each(&|b| b.centroid.x));
        assert_eq!(instance.get("block_displacement_y"), each(&|b| b.displacement.y));
        assert_eq!(instance.get("block_velocity_x"), each(&|b| b.velocity.x));
        assert_eq!(instance.get("block_stress_yy"), each(&|b| b.mean_stress[1]));
        assert_eq!(instance.get("time"), [t]);
        let totals = model.totals();
        assert_eq!(instance.get("kinetic_energy"), [totals.ledger.kinetic]);
        assert_eq!(instance.get("energy_residual"), [totals.ledger.residual()]);
        assert_eq!(instance.integer("sliding_contacts"), totals.slipping_contacts as i32);
        assert_eq!(instance.integer("slipping_contacts"), totals.slipping_contacts as i32);
        assert_eq!(instance.get("internal_dt"), [model.internal_step()]);
        for (k, port) in model.ports().iter().enumerate() {
            let state = model.port_state(k);
            match port.kind {
                enmm::cosimulation::PortKind::Joint => {
                    assert_eq!(instance.get(&format!("{}.normal_force", port.name)), [state.normal_force]);
                }
                _ => assert_eq!(instance.get(&format!("{}.displacement_y", port.name)), [state.displacement.y]),
            }
        }
    }
}

#[test]
fn inputs_act_as_those_of_the_facade_and_forces_of_ports_and_arrays_add_up() {
    let fmu = Fmu::boxed();
    let (instance, mut model) = (fmu.started(), fmu.model());
    model.start().unwrap();
    let block = model.ports()[0].block;
    let mut forces = [0.0; 2];
    forces[block] = 2e3;
    for (name, values) in [
        ("box.force_x", &[1e3][..]),
        ("box.moment", &[50.0]),
        ("block_force_x", &forces),
        ("gravity_x", &[0.5]),
        ("base_acceleration_y", &[-0.25]),
        ("water_level", &[0.5]),
        ("strength_factor", &[0.9]),
        ("face.traction_y", &[-100.0]),
        ("face.pressure", &[300.0]),
        ("bed.pressure", &[400.0]),
    ] {
        assert_eq!(instance.set(name, values), OK, "{}", instance.last_line());
        assert_eq!(instance.get(name), values);
    }
    model.set_block_force(block.number(), Vector::new(3e3, 0.0), 50.0).unwrap();
    model.set_gravity(Vector::new(0.5, -9.81)).unwrap();
    model.set_base_acceleration(Vector::new(0.0, -0.25)).unwrap();
    model.set_water_level(0.5).unwrap();
    model.set_strength_factor(0.9).unwrap();
    model.set_boundary_traction(1, Vector::new(0.0, -100.0)).unwrap();
    model.set_pressure(1, 300.0).unwrap();
    model.set_pressure(2, 400.0).unwrap();
    instance.run(0.01, 0.02);
    model.do_step(0.0, 0.01).unwrap();
    model.do_step(0.01, 0.01).unwrap();
    assert_eq!(instance.snapshot(), model.serialize(&model.save()).unwrap());
}

#[test]
fn communication_steps_do_not_change_the_motion() {
    for fmu in [Fmu::incline(), Fmu::boxed()] {
        let states = [0.04, 0.02, 0.004].map(|h| {
            let instance = fmu.started();
            instance.run(h, 0.08);
            (instance.get("block_x"), instance.get("block_velocity_y"), instance.get("block_rotation"))
        });
        assert_eq!(states[0], states[1]);
        assert_eq!(states[0], states[2]);
    }
}

#[test]
fn reset_is_as_new_and_parameters_build_another_model() {
    let fmu = Fmu::boxed();
    let instance = fmu.started();
    instance.run(0.01, 0.03);
    let first = instance.snapshot();
    assert_eq!(instance.set("box.force_x", &[5e3]), OK);
    instance.run_from(0.03, 0.01, 0.05);
    assert_eq!(fmi3Reset(instance.pointer), OK);
    assert_eq!(instance.get("box.force_x"), [0.0]);
    instance.start();
    instance.run(0.01, 0.03);
    assert_eq!(instance.snapshot(), first);

    assert_eq!(fmi3Reset(instance.pointer), OK);
    assert_eq!(instance.set("rock.stone.density", &[2000.0]), OK);
    assert_eq!(instance.set("box.force_y", &[-1e3]), OK, "{}", instance.last_line());
    instance.start();
    instance.run(0.01, 0.03);
    let mut case = fmu.loaded.case.clone();
    case.rocks.values_mut().for_each(|rock| rock.density = 2000.0);
    let loaded = enmm_io::LoadedCase::of(case, "other").unwrap();
    let mut model = loaded.cosimulation().unwrap();
    model.set_block_force(model.ports()[0].block.number(), Vector::new(0.0, -1e3), 0.0).unwrap();
    (0..3).for_each(|k| drop(model.do_step(0.01 * f64::from(k), 0.01).unwrap()));
    assert_eq!(instance.snapshot(), model.serialize(&model.save()).unwrap());

    assert_eq!(fmi3Reset(instance.pointer), OK);
    instance.start();
    instance.run(0.01, 0.03);
    assert_eq!(instance.snapshot(), first);
}

#[test]
fn instances_do_not_feel_each_other_in_one_thread_or_two() {
    let fmu = Fmu::boxed();
    let (a, b) = (fmu.started(), fmu.started());
    assert_eq!(b.set("box.force_x", &[1e3]), OK);
    let mut t = 0.0;
    for _ in 0..4 {
        assert_eq!((a.step(t, 0.01), b.step(t, 0.01)), ((OK, false, t + 0.01), (OK, false, t + 0.01)));
        t += 0.01;
    }
    let [alone_a, alone_b] = std::thread::scope(|scope| {
        let run = |force: f64| {
            let fmu = &fmu;
            scope.spawn(move || {
                let instance = fmu.started();
                assert_eq!(instance.set("box.force_x", &[force]), OK);
                instance.run(0.01, 0.04);
                instance.snapshot()
            })
        };
        [run(0.0), run(1e3)].map(|thread| thread.join().unwrap())
    });
    assert_eq!((a.get("block_x"), a.get("block_rotation")), {
        let again = fmu.started();
        again.run(0.01, 0.04);
        assert_eq!(again.get("kinetic_energy"), a.get("kinetic_energy"));
        (again.get("block_x"), again.get("block_rotation"))
    });
    assert_eq!(b.snapshot(), alone_b);
    assert_ne!(alone_a, alone_b);
}

#[test]
fn threads_do_not_change_the_bits_and_interpolation_is_that_of_the_facade() {
    let fmu = Fmu::boxed();
    let run = |threads: i32, linear: bool| {
        let instance = fmu.instance();
        let (pointer, references) = (instance.pointer, [fmu.reference("threads"), fmu.reference("interpolate_inputs")]);
        assert_eq!(unsafe { enmm_fmi3::fmi3SetInt32(pointer, &references[0], 1, &threads, 1) }, OK);
        assert_eq!(unsafe { enmm_fmi3::fmi3SetBoolean(pointer, &references[1], 1, &linear, 1) }, OK);
        instance.start();
        assert_eq!(instance.set("box.force_x", &[1e3]), OK);
        instance.run(0.01, 0.02);
        let mut back = false;
        assert_eq!(unsafe { enmm_fmi3::fmi3GetBoolean(pointer, &references[1], 1, &mut back, 1) }, OK);
        assert_eq!((instance.integer("threads"), back), (threads, linear));
        instance.get("block_velocity_x")
    };
    assert_eq!(run(1, false), run(2, false));
    assert_eq!(run(1, true), run(2, true));
    let mut model = fmu.model();
    model.set_interpolation(enmm::cosimulation::Interpolation::Linear);
    model.start().unwrap();
    model.set_block_force(model.ports()[0].block.number(), Vector::new(1e3, 0.0), 0.0).unwrap();
    model.do_step(0.0, 0.01).unwrap();
    model.do_step(0.01, 0.01).unwrap();
    assert_eq!(run(1, true), model.block_states().iter().map(|b| b.velocity.x).collect::<Vec<_>>());
}

#[test]
fn bad_steps_are_errors_and_the_stop_time_holds() {
    let fmu = Fmu::boxed();
    for (t, h) in [(0.0, 0.0), (0.0, -0.01), (0.0, f64::NAN), (0.0, f64::INFINITY), (0.5, 0.01), (f64::NAN, 0.01)] {
        let instance = fmu.started();
        let state = instance.save();
        assert_eq!(instance.step(t, h).0, ERROR, "{t} {h}");
        assert_eq!(instance.lines().len(), 1, "{:?}", instance.lines());
        assert_eq!(instance.step(0.0, 0.01).0, ERROR, "after an error");
        assert_eq!(instance.get("time"), [0.0]);
        assert_eq!(instance.restore(state), OK);
        assert_eq!(instance.step(0.0, 0.01), (OK, false, 0.01));
    }
    let instance = fmu.instance();
    assert_eq!(fmi3EnterInitializationMode(instance.pointer, true, 1e-6, 2.0, true, 2.03), OK);
    assert_eq!(fmi3ExitInitializationMode(instance.pointer), OK);
    assert_eq!(instance.get("time"), [2.0]);
    instance.run_from(2.0, 0.01, 2.03);
    assert_eq!(instance.step(2.0 + 0.01 + 0.01 + 0.01, 0.01).0, ERROR);
    assert!(instance.last_line().contains("stop time"), "{}", instance.last_line());
}

#[test]
fn a_start_far_from_time_0_changes_no_motion() {
    let fmu = Fmu::boxed();
    let plain = fmu.started();
    plain.run(0.01, 0.1);
    for start in [1e7, -1e7, 1e9] {
        let instance = fmu.instance();
        assert_eq!(fmi3EnterInitializationMode(instance.pointer, false, 0.0, start, false, 0.0), OK);
        assert_eq!(fmi3ExitInitializationMode(instance.pointer), OK);
        // Half of the steps begin where the last one ended, half on the grid of the importer.
        for k in 0..10 {
            let sum = start + 0.01 * f64::from(k);
            let t = if k % 2 == 0 { sum } else { instance.get("time")[0] };
            assert_eq!(instance.step(t, 0.01), (OK, false, t + 0.01), "{}", instance.last_line());
        }
        assert_eq!(instance.get("block_y"), plain.get("block_y"), "{start}");
        assert_eq!(instance.get("block_velocity_x"), plain.get("block_velocity_x"), "{start}");
        assert_eq!(instance.step(start, 0.01).0, ERROR, "a time that is over");
        assert!(instance.last_line().contains("must be the time"), "{}", instance.last_line());
    }
}

#[test]
fn an_event_ends_a_step_early_where_that_is_allowed() {
    let fmu = Fmu::boxed();
    let lift = |early_return| {
        let instance = fmu.instantiate(&Options { early_return, logging: true, ..Options::default() }).unwrap();
        instance.start();
        assert_eq!(instance.set("box.force_y", &[60e3]), OK);
        instance
    };
    let plain = lift(false);
    assert_eq!(plain.step(0.0, 0.1), (OK, false, 0.1));
    assert!(plain.integer("event_count") > 0);
    let instance = lift(true);
    let (status, early, time) = instance.step(0.0, 0.1);
    assert_eq!((status, early), (OK, true));
    assert!(time > 0.0 && time < 0.1);
    assert_eq!((instance.get("time"), instance.get("last_event_time")), (vec![time], vec![time]));
    assert!(instance.lines().iter().any(|line| line.1 == "logEvents"));
    let (mut t, mut returns) = (time, 1);
    while t < 0.1 {
        let (status, early, last) = instance.step(t, 0.1 - t);
        assert_eq!(status, OK);
        returns += i32::from(early);
        t = last;
    }
    assert_eq!(returns, instance.integer("event_count"));
    assert_eq!(instance.get("block_y"), plain.get("block_y"));
}

#[test]
fn updates_come_at_every_internal_step_and_may_end_the_step() {
    let fmu = Fmu::boxed();
    let options = Options { early_return: true, update: Some(update), ..Options::default() };
    let instance = fmu.instantiate(&options).unwrap();
    let names = ["time", "box.displacement_y"];
    {
        let mut updates = instance.log.updates.lock().unwrap();
        updates.instance = instance.pointer as usize;
        updates.references = names.map(|name| fmu.reference(name)).to_vec();
    }
    instance.start();
    assert_eq!(instance.step(0.0, 0.01), (OK, false, 0.01));
    let dt = instance.get("internal_dt")[0];
    {
        let updates = instance.log.updates.lock().unwrap();
        assert_eq!(updates.seen.len(), (0.01 / dt).round() as usize);
        for (k, (time, values, can_return)) in updates.seen.iter().enumerate() {
            assert!((time - (k + 1) as f64 * dt).abs() < 1e-9 && values[0] == *time);
            assert_eq!(*can_return, k + 1 < updates.seen.len());
        }
    }
    let plain = fmu.started();
    plain.run(0.01, 0.01);
    assert_eq!(instance.snapshot(), plain.snapshot());
    // At once, and between two internal steps.
    instance.log.updates.lock().unwrap().ask = Some((0.01, 0.0));
    let (status, early, first) = instance.step(0.01, 0.01);
    assert_eq!((status, early), (OK, true));
    assert!((first - 0.01 - dt).abs() < 1e-9, "{first}");
    let wanted = first + 2.3 * dt;
    instance.log.updates.lock().unwrap().ask = Some((0.01, wanted));
    let (status, early, second) = instance.step(first, 0.01);
    assert_eq!((status, early), (OK, true));
    assert!((second - wanted).abs() < 1e-6 * dt, "{second} {wanted}");
    instance.log.updates.lock().unwrap().ask = None;
    assert_eq!(instance.step(second, 0.02 - second).0, OK);
    plain.run_from(0.01, 0.01, 0.02);
    assert_eq!(instance.get("block_y"), plain.get("block_y"));
}

/// An instance whose inputs move linearly, and that may return early at a time.
fn ramped(fmu: &Fmu, start: f64, ask: Option<(f64, f64)>) -> Instance<'_> {
    let options = Options { early_return: true, update: Some(update), ..Options::default() };
    let instance = fmu.instantiate(&options).unwrap();
    {
        let mut updates = instance.log.updates.lock().unwrap();
        (updates.instance, updates.ask) = (instance.pointer as usize, ask);
    }
    let reference = fmu.reference("interpolate_inputs");
    assert_eq!(unsafe { enmm_fmi3::fmi3SetBoolean(instance.pointer, &reference, 1, &true, 1) }, OK);
    assert_eq!(fmi3EnterInitializationMode(instance.pointer, false, 0.0, start, false, 0.0), OK);
    assert_eq!(fmi3ExitInitializationMode(instance.pointer), OK);
    assert_eq!(instance.set("box.force_x", &[1e3]), OK);
    instance
}

#[test]
fn an_early_return_leaves_linear_inputs_on_their_way() {
    let fmu = Fmu::boxed();
    let plain = ramped(&fmu, 0.0, None);
    let dt = plain.get("internal_dt")[0];
    plain.run(0.04, 0.04);
    let last = plain.get("block_velocity_x");
    for wanted in [4.0 * dt, 4.3 * dt] {
        let instance = ramped(&fmu, 0.0, Some((0.0, wanted)));
        let (status, early, time) = instance.step(0.0, 0.04);
        assert_eq!((status, early, time), (OK, true, wanted));
        let mut model = fmu.model();
        model.set_interpolation(enmm::cosimulation::Interpolation::Linear);
        model.start().unwrap();
        model.set_block_force(model.ports()[0].block.number(), Vector::new(1e3, 0.0), 0.0).unwrap();
        let mut interval = model.begin(0.0, 0.04).unwrap();
        model.advance(&mut interval).unwrap();
        model.shorten(&mut interval, model.time() + (wanted - model.time()));
        while model.advance(&mut interval).unwrap() {}
        assert_eq!(instance.snapshot(), model.serialize(&model.save()).unwrap());
        // The rest of the same way, on the same line.
        instance.log.updates.lock().unwrap().ask = None;
        assert_eq!(instance.step(time, 0.04 - time), (OK, false, time + (0.04 - time)));
        let velocity = instance.get("block_velocity_x");
        let scale = last.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        assert!(velocity.iter().zip(&last).all(|(a, b)| (a - b).abs() < 0.01 * scale), "{velocity:?} {last:?}");
    }
}

#[test]
fn a_wanted_time_at_or_after_the_end_is_the_end() {
    let fmu = Fmu::boxed();
    for start in [0.0, 1e9] {
        let plain = ramped(&fmu, start, None);
        assert_eq!(plain.step(start, 0.02), (OK, false, start + 0.02));
        for wanted in [start + 0.02, start + 0.5, 1e300] {
            let instance = ramped(&fmu, start, Some((0.0, wanted)));
            assert_eq!(instance.step(start, 0.02), (OK, false, start + 0.02), "{wanted}");
            assert_eq!(instance.snapshot(), plain.snapshot());
        }
    }
}

#[test]
fn an_illegal_call_within_an_update_is_an_error_and_frees_nothing() {
    let fmu = Fmu::boxed();
    let instance = fmu.instantiate(&Options { update: Some(update), ..Options::default() }).unwrap();
    instance.start();
    let state = instance.save();
    let before = instance.snapshot();
    {
        let mut updates = instance.log.updates.lock().unwrap();
        updates.instance = instance.pointer as usize;
        updates.try_illegal = true;
    }
    assert_eq!(instance.step(0.0, 0.01).0, ERROR);
    assert_eq!(instance.log.updates.lock().unwrap().illegal, [Status::Error]);
    assert_eq!(instance.restore(state), OK);
    assert_eq!(instance.snapshot(), before);
}

#[test]
fn a_discarded_step_changes_nothing() {
    let fmu = Fmu::boxed();
    let (instance, plain) = (fmu.started(), fmu.started());
    instance.run(0.01, 0.01);
    plain.run(0.01, 0.01);
    let before = instance.get("block_y");
    assert_eq!(instance.set("box.force_x", &[1e15]), OK);
    assert_eq!(instance.step(0.01, 0.05), (Status::Discard, false, 0.01));
    assert_eq!((instance.get("block_y"), instance.get("time")), (before, vec![0.01]));
    assert_eq!(instance.set("box.force_x", &[0.0]), OK);
    instance.run_from(0.01, 0.01, 0.03);
    plain.run_from(0.01, 0.01, 0.03);
    assert_eq!(instance.get("block_y"), plain.get("block_y"));
}

#[test]
fn energy_from_nowhere_is_a_warning_in_the_log() {
    let doubts = |fmu: &Fmu| {
        let instance = fmu.instantiate(&Options { logging: true, ..Options::default() }).unwrap();
        instance.start();
        let is_doubt = |(_, _, text): &crate::common::Line| text.contains(": the energy residual is ");
        instance
            .lines()
            .into_iter()
            .filter(is_doubt)
            .map(|(status, category, _)| (status, category))
            .collect::<Vec<_>>()
    };
    assert_eq!(doubts(&Fmu::soft()), [(Status::Warning, "logStatusWarning".to_owned())]);
    assert_eq!(doubts(&Fmu::boxed()), []);
}
