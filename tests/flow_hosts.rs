//! Claims: heads, rain and drains that a host sets move the water in joints in dynamic stages that follow them, with
//! the pressures and flows of hand calculations, and the same bits by communication steps, returns, bytes and threads;
//! what enters leaves; a flow that is held refuses them. A flow that goes on in time lags behind them at its pace, as
//! by hand, and what enters has left or is in the joints.

use allocation_counter::measure;

use enmm::cosimulation::{Cosimulation, CosimulationError, Input, Interpolation, Named};
use enmm::model::bytes::{Keeper, decode, encode};
use enmm::model::{Seepage, Simulation, State};

use crate::common::{case, refusal, run_stage, simulation, step};

/// Unit weight of the water (N/m³).
const WEIGHT: f64 = 9810.0;
/// Transmissivity (m²/s) of joints of 0.1 mm: γe³/12μ.
const T: f64 = WEIGHT * 1e-12 / (12.0 * 1e-3);
/// Width (m) of the dam, and height (m) of the joint below it.
const WIDTH: f64 = 20.0;
const BASE: f64 = 3.0;
/// Sums of these times are exact, so that hosts that sum them up differently agree about them.
const STEP: f64 = 1.0 / 2048.0;
const END: f64 = 80.0 * STEP;

/// A dam on a joint, with a joint in it that takes rain, a drain that does not act yet, and a dynamic stage.
fn dam(size: f64, course: &str) -> String {
    let stored = if course.contains("transient") { STORES } else { "" };
    format!(
        "title = \"dam\"\n[domain]\noutline = [[0, 0], [20, 0], [20, 9], [0, 9]]\n[mesh]\nsize = {size:?}\n\
         origin = [0.131, 0.077]\n[[joint]]\npoints = [[0, 3], [20, 3]]\n[[joint]]\npoints = [[12, 3], [12, 9]]\n\
         [rock.rock]\ndensity = 2600\nyoung = 1e10\npoisson = 0.25\n[joint_law.joint]\nfriction_deg = 40\n[[fix]]\n\
         edge = [[0, 0], [20, 0]]\n[[fix]]\nedge = [[0, 3], [0, 9]]\n[flow]\naperture = 1e-4\naperture_min = 1e-4\n\
         aperture_max = 1e-4\n{stored}[[head]]\nname = \"heel\"\nedge = [[0, 0], [0, 9]]\nlevel = 9.0\n[[head]]\n\
         name = \"toe\"\nedge = [[20, 0], [20, 9]]\nlevel = 4.0\n[[rain]]\nname = \"crest\"\n\
         edge = [[0, 9], [20, 9]]\nrate = 0.0\n[[drain]]\nname = \"row\"\npoints = [[5, 3], [5, 6]]\nactive = false\n\
         [[port]]\nname = \"base\"\njoint = [[0, 3], [20, 3]]\n[[stage]]\nname = \"rest\"\nkind = \"static\"\n\
         duration = 0.3\n[[stage]]\nname = \"motion\"\nkind = \"dynamic\"\nduration = 1.0\n{course}"
    )
}

const FOLLOWS: &str = "flow = \"steady\"\nflow_every = 4\n";

/// Lets the flow go on in time.
const LAGS: &str = "flow = \"transient\"\nflow_every = 4\n";
/// The joint in the dam then fills and drains in some 4 hours, which are 74 ms of motion.
const STORES: &str = "storage = 2.5e-3\npace = 2e5\n";

/// Finds the flow before each internal step.
const AT_ONCE: &str = "flow = \"steady\"\nflow_every = 1\n";

fn host(course: &str) -> Cosimulation {
    Cosimulation::new(case(&dam(1.3, course))).unwrap_or_else(|e| panic!("{e}"))
}

fn good<T>(result: Result<T, CosimulationError>) -> T {
    result.unwrap_or_else(|e| panic!("{e}"))
}

/// Goes on to a time (s) in steps of `h` (s).
fn go(model: &mut Cosimulation, until: f64, h: f64) {
    while model.time() < until {
        let (t, step) = (model.time(), h.min(until - model.time()));
        good(model.do_step(t, step));
    }
}

fn bytes(model: &Cosimulation) -> Vec<u8> {
    model.serialize(&model.save()).unwrap_or_else(|e| panic!("{e}"))
}

fn seepage(model: &Cosimulation) -> &Seepage {
    model.simulation().state().seepage.as_ref().expect("water that flows")
}

fn assert_near(found: f64, exact: f64, scale: f64, what: &str) {
    assert!((found - exact).abs() <= 1e-12 * scale, "{what}: {found:?} instead of {exact:?}");
}

/// Checks pressures at the base and flow through it, between heads (m above the joint) at its ends.
fn assert_through_base(model: &Cosimulation, [heel, toe]: [f64; 2]) {
    let port = model.port_state(good(model.find_port("base")));
    let mean = 0.5 * (heel + toe);
    assert_near(port.water.pressure, WEIGHT * mean, WEIGHT * mean, "pressure");
    assert_near(port.water.pressure_max, WEIGHT * heel.max(toe), WEIGHT * mean, "greatest pressure");
    assert_near(port.water.uplift, WEIGHT * mean * WIDTH, WEIGHT * mean * WIDTH, "uplift");
    let through = T * (heel - toe) / WIDTH;
    let of = |name| good(model.inlet(Named::Head, good(model.find_name(Named::Head, name))));
    assert_near(of("heel").inflow, through, T, "flow at the heel");
    assert_near(of("toe").outflow, through, T, "flow at the toe");
    assert_eq!(of("toe").inflow, -of("toe").outflow);
    assert!(model.totals().flow.residual <= 1e-12 * T);
}

#[test]
fn heads_of_a_host_move_pressures_and_flow_as_by_hand() {
    let mut model = host(AT_ONCE);
    // Before the start they belong to the initial equilibrium.
    good(model.set_head(0, 8.0));
    good(model.start());
    assert_eq!(model.totals().flow.seepage_height, BASE, "nothing seeps");
    assert_through_base(&model, [5.0, 1.0]);
    assert_eq!(model.totals().flow.passed, [0.0; 2], "no time has passed");
    good(model.set_head(1, 5.5));
    good(model.do_step(0.0, 4.0 * STEP));
    assert_through_base(&model, [5.0, 2.5]);
    // Water above the joint at the heel, none at the toe: it seeps out there.
    good(model.set_head(1, 2.0));
    good(model.do_step(4.0 * STEP, 4.0 * STEP));
    assert_through_base(&model, [5.0, 0.0]);
    assert_eq!(model.totals().flow.seepage_height, BASE);
}

#[test]
fn a_drain_and_rain_of_a_host_act_as_by_hand() {
    let mut model = host(AT_ONCE);
    good(model.start());
    good(model.set_drain(good(model.find_name(Named::Drain, "row")), true));
    // The joint in the dam takes all of it, and carries it down as a film.
    let rate = 0.1 * T / WIDTH;
    good(model.set_rain(0, rate));
    good(model.do_step(0.0, 4.0 * STEP));
    let at = |kind| good(model.inlet(kind, 0));
    assert_near(at(Named::Rain).inflow, 0.1 * T, T, "rain");
    assert_eq!(at(Named::Rain).run_off, 0.0);
    assert_near(at(Named::Head).inflow, T * 6.0 / 5.0, T, "heel");
    // Between drain, rain and toe: h is the head at the foot of the joint in the dam.
    let h = (0.1 + 1.0 / 8.0) / (1.0 / 7.0 + 1.0 / 8.0);
    assert_near(at(Named::Drain).outflow, T * (6.0 / 5.0 + h / 7.0), T, "drain");
    let uplift = WEIGHT * (6.0 * 5.0 + h * 7.0 + (h + 1.0) * 8.0) / 2.0;
    assert_near(model.port_state(0).water.uplift, uplift, uplift, "uplift");
    // More than the joint can take runs off.
    good(model.set_rain(0, 2.0 * T / WIDTH));
    good(model.set_drain(0, false));
    good(model.do_step(4.0 * STEP, 4.0 * STEP));
    let rain = good(model.inlet(Named::Rain, 0));
    assert!(rain.run_off > 0.9 * T, "{rain:?}");
    assert_near(rain.inflow + rain.run_off, 2.0 * T, T, "all rain");
    assert_eq!(good(model.inlet(Named::Drain, 0)).outflow, 0.0);
}

#[test]
fn heads_on_their_way_are_those_of_the_last_flow_on_the_grid() {
    let mut model = host(FOLLOWS);
    good(model.start());
    good(model.set_interpolation_of(Input::Head(0), Interpolation::Linear));
    good(model.set_head(0, 7.0));
    good(model.do_step(0.0, END));
    let (dt, steps) = (model.internal_step(), model.simulation().state().stage_step);
    let part = model.simulation().state().part > 0.0;
    let last = if part { steps / 4 * 4 } else { (steps - 1) / 4 * 4 };
    let share = last as f64 * dt / END;
    assert!(share > 0.5 && share < 1.0, "{share}");
    assert_through_base(&model, [6.0 - 2.0 * share, 1.0]);
}

/// A host that sets all kinds of inputs at the same times, in communication steps of `h` (s).
fn driven(h: f64, course: &str) -> Cosimulation {
    let mut model = host(course);
    good(model.set_head(0, 8.5));
    good(model.start());
    good(model.set_head(1, 5.0));
    go(&mut model, 0.25 * END, h);
    good(model.set_rain(0, 0.3 * T / WIDTH));
    go(&mut model, 0.5 * END, h);
    good(model.set_drain(0, true));
    good(model.set_head(0, 7.0));
    go(&mut model, END, h);
    model
}

#[test]
fn the_flow_has_the_same_bits_in_any_communication_steps() {
    let whole = driven(END, FOLLOWS);
    assert!(seepage(&whole).passed[0] > 0.0);
    for (course, h) in [FOLLOWS, LAGS].iter().flat_map(|c| [0.5, 0.05, 0.025, 1.0 / 640.0].map(|h| (c, h * END))) {
        let (whole, parts) = (driven(END, course), driven(h, course));
        assert_eq!(parts.block_states(), whole.block_states(), "steps of {h} s");
        assert_eq!(seepage(&parts), seepage(&whole));
        assert_eq!(parts.port_state(0), whole.port_state(0));
        assert_eq!(parts.totals(), whole.totals());
    }
    // Another grid is another flow on its way, and the same one in the end.
    let fine = driven(END, AT_ONCE);
    assert!(seepage(&fine).passed != seepage(&whole).passed);
    let apart = (fine.port_state(0).water.uplift - whole.port_state(0).water.uplift).abs();
    assert!(apart < 1e-9 * whole.port_state(0).water.uplift, "{apart}");
}

#[test]
fn entered_less_left_is_nothing_in_steady_flow() {
    for course in [FOLLOWS, ""] {
        let mut model = host(course);
        good(model.start());
        good(model.set_interpolation_of(Input::WaterLevel, Interpolation::Linear));
        if !course.is_empty() {
            good(model.set_drain(0, true));
            good(model.set_rain(0, 0.2 * T / WIDTH));
        }
        go(&mut model, END, STEP);
        let [entered, left] = model.totals().flow.passed;
        assert!(entered > 0.5 * END * T * 5.0 / WIDTH, "{entered}");
        assert!((entered - left).abs() <= 1e-12 * entered, "{entered} {left}");
        if course.is_empty() {
            assert_near(entered, END * T * 5.0 / WIDTH, entered, "held flow");
        }
    }
}

#[test]
fn returns_and_bytes_have_the_same_bits() {
    [FOLLOWS, LAGS].into_iter().for_each(assert_goes_on);
}

fn assert_goes_on(course: &str) {
    let mut model = driven(STEP, course);
    // Between two points of the grid, with a head on its way.
    good(model.set_interpolation_of(Input::Head(0), Interpolation::Linear));
    good(model.set_head(0, 8.0));
    let before = model.save();
    let saved = bytes(&model);
    let again = |model: &mut Cosimulation| {
        go(model, END + STEP, STEP / 16.0);
        good(model.set_rain(0, 0.0));
        good(model.set_drain(0, false));
        go(model, END + 8.0 * STEP, STEP);
        bytes(model)
    };
    let end = again(&mut model);
    for _ in 0..20 {
        model.restore(&before).unwrap_or_else(|e| panic!("{e}"));
        good(model.set_head(1, 3.5));
        good(model.do_step(END, STEP / 16.0));
    }
    model.restore(&before).unwrap_or_else(|e| panic!("{e}"));
    assert!(again(&mut model) == end, "returned");
    let mut other = host(course);
    let read = other.deserialize(&saved).unwrap_or_else(|e| panic!("{e}"));
    other.restore(&read).unwrap_or_else(|e| panic!("{e}"));
    assert!(again(&mut other) == end, "from bytes");
}

#[test]
fn threads_do_not_change_the_bits() {
    let run = |course, threads| {
        let text = dam(0.22, course).replace("duration = 0.3", "duration = 0.002");
        let mut model = Cosimulation::new(case(&text)).unwrap_or_else(|e| panic!("{e}"));
        assert!(model.simulation().model().covers.cover_count() > enmm::internals::step::THREADS_FROM);
        good(model.set_threads(threads));
        good(model.start());
        good(model.set_head(0, 7.0));
        good(model.do_step(0.0, 20.0 * model.internal_step()));
        bytes(&model)
    };
    assert!(run(FOLLOWS, 1) == run(FOLLOWS, 2));
    assert!(run(LAGS, 1) == run(LAGS, 2));
}

#[test]
fn a_stage_sets_heads_as_a_host_does() {
    let mut by_stage =
        host(&format!("{FOLLOWS}heads = {{ heel = 7.0 }}\nrain = {{ crest = 1e-9 }}\ndrain = [\"row\"]\n"));
    go(&mut by_stage, 8.0 * STEP, STEP);
    let mut by_host = host(FOLLOWS);
    good(by_host.start());
    good(by_host.set_head(0, 7.0));
    good(by_host.set_rain(0, 1e-9));
    good(by_host.set_drain(0, true));
    go(&mut by_host, 8.0 * STEP, STEP);
    assert_eq!(by_stage.block_states(), by_host.block_states());
    assert_eq!(seepage(&by_stage), seepage(&by_host));
}

#[test]
fn a_flow_that_is_held_refuses_inputs_after_the_start() {
    let mut model = host("");
    good(model.set_head(0, 8.0));
    good(model.start());
    assert_through_base(&model, [5.0, 1.0]);
    let before = bytes(&model);
    let told = [model.set_head(0, 7.0), model.set_rain(0, 0.0), model.set_drain(0, true)].map(|refused| {
        let told = refused.expect_err("the flow is held").to_string();
        assert!(told.contains("in stage \"motion\"") && told.contains("flow = \"steady\""), "{told}");
        told
    });
    assert!(told[0].starts_with("head: ") && told[1].starts_with("rain: ") && told[2].starts_with("drain: "));
    assert!(bytes(&model) == before);
    good(model.do_step(0.0, STEP));
    assert_through_base(&model, [5.0, 1.0]);
}

#[test]
fn heads_that_a_host_moves_may_begin_equal() {
    let warnings = |course| {
        let text = dam(1.3, course).replace("level = 4.0", "level = 9.0");
        simulation(&text).built().warnings.clone()
    };
    let told = warnings("");
    assert!(told.len() == 1 && told[0].contains("all heads are equal"), "{told:?}");
    assert_eq!(warnings(FOLLOWS), Vec::<String>::new());
}

#[test]
fn inputs_that_cannot_be_are_refused_by_name() {
    let mut model = host(FOLLOWS);
    for (refused, wanted) in [
        (model.set_head(0, f64::NAN), "level of head \"heel\": is NaN m"),
        (model.set_head(0, 2e9), "level of head \"heel\": is 2e9 m"),
        (model.set_head(2, 1.0), "index: is 2, must be less than the number of heads, 2"),
        (model.set_rain(0, -1e-9), "rate of rain \"crest\": is -1e-9 m/s"),
        (model.set_rain(0, 1.0), "at most 1e-3 m/s"),
        (model.set_drain(1, true), "index: is 1, must be less than the number of drains, 1"),
        (model.find_name(Named::Head, "crest").map(|_| ()), "name: is \"crest\", must be that of one of the heads: "),
        (model.inlet(Named::Port, 0).map(|_| ()), "kind: is ports, must be heads, rains or drains"),
        (model.set_interpolation_of(Input::Drain(3), Interpolation::Hold), "index: is 3"),
    ] {
        let told = refused.expect_err(wanted).to_string();
        assert!(told.contains(wanted), "{told} instead of {wanted}");
    }
}

#[test]
fn keys_of_a_stage_that_make_no_sense_are_refused() {
    let text = dam(1.3, FOLLOWS);
    for (old, new, wanted) in [
        ("flow_every = 4", "flow_every = 0", "stage[1].flow_every: is 0, must be at least 1"),
        ("flow = \"steady\"\n", "", "stage[1].flow_every: is 4, and has no effect without `flow = \"steady\"` or"),
        ("[flow]\n", "[flow]\npace = 10\n", "flow.pace: is 10, and has no effect without a dynamic stage with"),
        ("flow = \"steady\"", "flow = \"hold\"", "stage[1].flow_every: is 4"),
        ("flow = \"steady\"", "flow = \"still\"", "is \"still\", must be one of hold, steady, transient"),
        ("flow = \"steady\"", "flow = 3", "must be one of the strings hold, steady, transient, or a table"),
        ("duration = 0.3\n", "duration = 0.3\nflow = \"steady\"\n", "stage[0].flow: is \"steady\", but only dynamic"),
        ("flow_every = 4", "rain = { fog = 1e-9 }", "fog"),
    ] {
        assert!(text.contains(old), "{old}");
        let told = refusal(&text.replacen(old, new, 1));
        assert!(told.contains(wanted), "{told} instead of {wanted}");
    }
    let lags = dam(1.3, LAGS);
    for (old, new, wanted) in [
        ("pace = 2e5", "pace = 0.0", "flow.pace: is 0, must be greater than 0"),
        (
            "duration = 0.3\n",
            "duration = 0.3\nflow = \"transient\"\n",
            "stage[0].flow: is \"transient\", but only dynamic",
        ),
        ("flow_every = 4", "flow_every = 0", "stage[1].flow_every: is 0, must be at least 1"),
    ] {
        let told = refusal(&lags.replacen(old, new, 1));
        assert!(told.contains(wanted), "{told} instead of {wanted}");
    }
    // Factors of safety leave the dynamic stages out, and what has an effect in them alone.
    let mut short = case(&lags);
    short.keep_stages(2);
    assert_eq!(short.pace(), 2e5);
    short.keep_stages(1);
    assert!(short.validate().is_ok() && short.pace() == 1.0);
    let held = dam(1.3, "heads = { toe = 5.0 }\n");
    assert!(refusal(&held).contains("stage[1].heads.toe: is in a dynamic stage, which holds"), "{}", refusal(&held));
}

#[test]
fn a_step_in_which_nothing_around_the_joints_has_changed_allocates_nothing() {
    let mut model = simulation(&dam(1.3, AT_ONCE));
    model.set_serial(true);
    run_stage(&mut model);
    assert!(model.next_stage().expect("a stage"));
    step(&mut model, 100);
    let found = measure(|| step(&mut model, 50));
    assert_eq!(found.count_total, 0, "{found:?}");
}

/// No host can set such rain; a solver that fails has no other cause that a test could make.
#[test]
fn a_flow_that_is_not_found_ends_the_step_with_its_place() {
    for course in [FOLLOWS, LAGS] {
        let mut model = simulation(&dam(1.3, course));
        run_stage(&mut model);
        assert!(model.next_stage().expect("a stage"));
        let before = model.state().clone();
        let drive = model.drive();
        (drive.from.rain[0], drive.to.rain[0]) = (-1.0, -1.0);
        let told = model.advance(false).expect_err("no such rain").to_string();
        assert!(told.contains("at (12.000, 9.000) m") && told.contains("rate"), "{told}");
        assert!(told.contains("apertures differ less"), "{told}");
        assert_eq!((model.state().stage_step, &model.state().seepage), (0, &before.seepage));
    }
}

/// A crack of 5 mm, 20 m high, that a joint of 0.1 mm and 10 m drains at its foot, where the head falls by 16 m as a
/// dynamic stage begins; the crack drains to 1/e in 500 s of flow and more.
fn crack(every: u64, pace: f64) -> Simulation {
    let text = format!(
        "title = \"crack\"\n[domain]\noutline = [[0, 0], [12, 0], [12, 22], [0, 22]]\n[mesh]\nsize = 1.0\n\
         origin = [0.131, 0.077]\n[[joint]]\npoints = [[2, 2], [2, 22]]\nlaw = \"crack\"\n[[joint]]\n\
         points = [[2, 2], [12, 2]]\nlaw = \"joint\"\n[rock.rock]\ndensity = 2600\nyoung = 1e10\npoisson = 0.25\n\
         [joint_law.crack]\nfriction_deg = 40\naperture = 5e-3\n[joint_law.joint]\nfriction_deg = 40\n\
         aperture = 1e-4\n[[fix]]\nedge = [[0, 0], [12, 0]]\n[flow]\npace = {pace:?}\n[[head]]\nname = \"exit\"\n\
         edge = [[12, 0], [12, 22]]\nlevel = 18.0\n[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 0.3\n\
         [[stage]]\nname = \"motion\"\nkind = \"dynamic\"\nduration = 1.0\nflow = \"transient\"\n\
         flow_every = {every}\nheads = {{ exit = 2.0 }}\n"
    );
    let mut model = simulation(&text);
    assert!(model.next_stage().expect("a stage"));
    model
}

/// Head (m) at the foot of the crack.
fn foot(model: &Simulation) -> f64 {
    let net = model.model().flow.as_ref().expect("a net");
    let is_foot = |k: &usize| (net.places[*k].x - 2.0).hypot(net.places[*k].y - 2.0) < 1e-9;
    let foot = (0..net.places.len()).find(is_foot).expect("the foot");
    2.0 + model.state().seepage.as_ref().expect("water that flows").unknowns[foot]
}

/// Water (m²) that entered and neither left nor is in the joints, of all that has passed.
fn assert_closes(seepage: &Seepage, holds: f64) {
    let ([entered, left], stored) = (seepage.passed, seepage.stored);
    let allowed = 1e-12 * (entered + left) + 1e-14 * holds;
    assert!((entered - left - stored).abs() <= allowed, "{entered:e} - {left:e} - {stored:e}, up to {allowed:.1e}");
}

#[test]
fn the_head_in_a_crack_falls_with_the_motion_at_its_pace() {
    let tau = 5e-3 * 10.0 / T;
    let dt = crack(1, 1.0).model().dt;
    for (every, steps) in [(2, 20), (1, 80)] {
        let pace = tau / (dt * (every * steps) as f64);
        let mut model = crack(every, pace);
        let mut falls = vec![foot(&model)];
        for _ in 0..steps {
            step(&mut model, every);
            falls.push(foot(&model));
        }
        assert!((falls[0] - 18.0).abs() < 1e-9 && falls.is_sorted_by(|a, b| a > b), "{falls:?}");
        for (k, head) in falls.iter().enumerate() {
            let exact = (1.0 + 1.0 / steps as f64).powi(-(k as i32));
            assert!(((head - 2.0) / 16.0 - exact).abs() < 1e-4, "{k} of {steps}: {head} {exact}");
        }
        let found = model.state().seepage.as_ref().expect("water that flows");
        let exact = -5e-3 * 16.0 * (1.0 - (1.0 + 1.0 / steps as f64).powi(-(steps as i32)));
        assert!((found.stored / exact - 1.0).abs() < 1e-3, "{} {exact}", found.stored);
        assert!((found.time / tau - 1.0).abs() < 1e-12);
        assert_eq!(found.balances.last().and_then(|own| own.water.as_ref()).map(|own| own.stored), Some(found.stored));
        assert_closes(found, 5e-3 * 20.0);
        assert_eq!(model.unfinished_drainage(), None, "no stage with a time of flow");
    }
}

#[test]
fn entered_less_left_is_stored_in_flow_that_goes_on() {
    let model = driven(STEP, LAGS);
    let found = seepage(&model);
    println!("{:?} {:e}", found.passed, found.stored);
    assert!(found.passed.iter().all(|volume| *volume > 0.0) && found.stored.abs() > 1e-6);
    assert_closes(found, 0.1);
    assert_eq!(model.totals().flow.stored, found.stored);
    // A later stage that holds the flow goes on with its rates.
    let held = "[[stage]]\nname = \"held\"\nkind = \"dynamic\"\nduration = 1.0\n";
    let text = dam(1.3, &format!("{LAGS}{held}")).replacen("duration = 1.0", "duration = 0.01", 1);
    let mut model = Cosimulation::new(case(&text)).unwrap_or_else(|e| panic!("{e}"));
    good(model.start());
    good(model.set_head(0, 5.0));
    go(&mut model, 24.0 * STEP, STEP);
    let before = seepage(&model).clone();
    go(&mut model, 32.0 * STEP, STEP);
    assert_eq!(seepage(&model).unknowns, before.unknowns);
    assert!(seepage(&model).passed[1] > before.passed[1] && seepage(&model).stored < before.stored);
    assert_closes(seepage(&model), 0.1);
}

/// Pressures lie between those of before and those that follow, and come to the latter after a long time.
#[test]
fn pressures_lag_behind_heads_and_come_to_rest() {
    let uplift = |course: &str, pace: &str| {
        let mut model =
            Cosimulation::new(case(&dam(1.3, course).replace("2e5", pace))).unwrap_or_else(|e| panic!("{e}"));
        good(model.start());
        let before = model.port_state(0).water.uplift;
        good(model.set_head(0, 6.0));
        good(model.do_step(0.0, 8.0 * STEP));
        [before, model.port_state(0).water.uplift]
    };
    let [before, after] = uplift(FOLLOWS, "");
    let [start, late] = uplift(LAGS, "2e5");
    assert_eq!(start, before);
    assert!(late < before && late - after > 0.1 * (before - after), "{late} of {before} to {after}");
    let [_, rests] = uplift(LAGS, "1e10");
    assert_near(rests, after, 1e3 * after, "after a long time");
    let [_, own] = uplift(LAGS, "4e5");
    assert!(own < late, "twice the pace");
}

#[test]
fn inputs_before_the_start_belong_to_the_flow_at_the_start() {
    let text = dam(1.3, LAGS);
    let (rest, motion) = (text.find("[[stage]]").expect("rest"), text.rfind("[[stage]]").expect("motion"));
    for text in [format!("{}{}", &text[..rest], &text[motion..]), text] {
        let mut model = Cosimulation::new(case(&text)).unwrap_or_else(|e| panic!("{e}"));
        good(model.set_head(0, 8.0));
        good(model.start());
        good(model.do_step(0.0, STEP));
        let (uplift, exact) = (model.port_state(0).water.uplift, WEIGHT * 3.0 * WIDTH);
        assert_near(uplift, exact, 1e3 * exact, "uplift");
        assert!(seepage(&model).time > 0.0 && seepage(&model).stored.abs() < 1e-12);
    }
}

/// As a run that stops and is resumed between two flows, and that comes to the same flow again after a return.
#[test]
fn a_run_goes_on_from_bytes_and_returns_with_the_same_bits() {
    let text = dam(1.3, &format!("{LAGS}heads = {{ heel = 6.0 }}\nrain = {{ crest = 1e-8 }}\n"));
    let begin = || {
        let mut model = simulation(&text);
        assert!(model.next_stage().expect("a stage"));
        model
    };
    let bits = |model: &Simulation| encode(Keeper::Model, model.state(), "hash").expect("bytes");
    let mut whole = begin();
    step(&mut whole, 6);
    let (before, written) = (whole.state().clone(), bits(&whole));
    step(&mut whole, 9);
    let end = bits(&whole);
    whole.return_to(&before);
    step(&mut whole, 9);
    assert!(bits(&whole) == end, "returned");
    let mut other = begin();
    let read: State = decode(Keeper::Model, &written, "hash").expect("a state");
    other.check(&read).expect("a state of this model");
    other.restore(read);
    step(&mut other, 9);
    assert!(bits(&other) == end, "from bytes");
    let mut wrong = before;
    wrong.seepage.as_mut().expect("flow").stored = f64::NAN;
    assert!(other.check(&wrong).expect_err("refused").to_string().starts_with("seepage.stored is NaN"));
}
