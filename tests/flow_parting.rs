//! Claims: in dynamic stages a wet piece of joint whose faces have slipped by more than half of the mesh size or opened
//! by more than `part` pushes no more, so that a slide which has left its place moves by its weight alone, as by hand;
//! one within the limits moves as ever, to the bit, and so does any in a static stage or with `part = 0`. The bits are
//! the same by communication steps, threads, returns and bytes, and no energy comes from the push that ends.

use allocation_counter::measure;

use enmm::cosimulation::Cosimulation;
use enmm::geometry::Vector;
use enmm::model::tables::BlockId;
use enmm::model::{Parted, Simulation};

use crate::common::{case, refusal, run_stage, simulation, step, through_bytes};

/// Density (kg/m³) of the rock and unit weight (N/m³) of the water.
const DENSITY: f64 = 2600.0;
const WEIGHT: f64 = 9810.0;
const GRAVITY: f64 = 9.81;
/// Width and height (m) of the block, and height (m) of the joint below it.
const WIDTH: f64 = 12.0;
const HEIGHT: f64 = 4.0;
const BASE: f64 = 4.0;

/// A block on a joint along x, in gravity that is tilted by an angle (degrees), with a head (m above the joint) at both
/// ends of the joint. Friction follows the normal force at once, as by Coulomb.
#[derive(Debug, Clone, Copy)]
struct Block<'a> {
    tilt: f64,
    friction: f64,
    head: f64,
    mesh: f64,
    flow: &'a str,
    course: &'a str,
}

/// The weight along the joint is below its strength when it is dry, and water moves the block.
const SLIDE: Block = Block { tilt: 25.0, friction: 30.0, head: 7.0, mesh: 2.0, flow: "", course: "" };
/// Heads in motion (m above the joint) whose push exceeds the weight of the block.
const LIFTS: f64 = 14.0;
const LIFT: Block = Block {
    tilt: 0.0,
    friction: 40.0,
    head: 1.0,
    mesh: 2.0,
    flow: "part = 0.05\n",
    course: "flow = \"steady\"\nflow_every = 1\nheads = { left = 18.0, right = 18.0 }\n",
};

impl Block<'_> {
    fn text(&self) -> String {
        let Self { tilt, friction, head, mesh, flow, course } = *self;
        let (along, down) = (GRAVITY * tilt.to_radians().sin(), -GRAVITY * tilt.to_radians().cos());
        let (right, top, level) = (12.0 + WIDTH, BASE + HEIGHT, BASE + head);
        format!(
            "title = \"block\"\n[gravity]\nx = {along:?}\ny = {down:?}\n[domain]\njoint_law = \"plane\"\n\
             outline = [[0, 0], [48, 0], [48, {BASE}], [{right}, {BASE}], [{right}, {top}], [12, {top}], \
             [12, {BASE}], [0, {BASE}]]\n[mesh]\nsize = {mesh:?}\nangle_deg = 7.0\norigin = [0.13, 0.29]\n[[joint]]\n\
             points = [[12, {BASE}], [{right}, {BASE}]]\n[rock.rock]\ndensity = {DENSITY}\nyoung = 5e9\n\
             poisson = 0.25\n[joint_law.plane]\nfriction_deg = 80\n[[fix]]\nblock = [1.0, 1.0]\n[solver]\n\
             friction_delay = 0.0\n[flow]\n\
             aperture = 1e-4\n{flow}[[head]]\nname = \"left\"\nedge = [[12, {BASE}], [12, {top}]]\n\
             level = {level:?}\n[[head]]\nname = \"right\"\nedge = [[{right}, {BASE}], [{right}, {top}]]\n\
             level = {level:?}\n[[port]]\nname = \"plane\"\njoint = [[12, {BASE}], [{right}, {BASE}]]\n[[stage]]\n\
             name = \"rest\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-6\n[[stage]]\nname = \"motion\"\n\
             kind = \"dynamic\"\nduration = 10.0\n{course}[[stage.law]]\nlaw = \"plane\"\n\
             friction_deg = {friction:?}\n"
        )
    }

    /// At the start of the dynamic stage.
    fn at_rest(&self) -> Simulation {
        let mut simulation = simulation(&self.text());
        run_stage(&mut simulation);
        assert!(simulation.next_stage().expect("a stage"));
        simulation
    }
}

fn own(simulation: &Simulation) -> BlockId {
    let covers = &simulation.model().covers;
    covers.blocks().find(|&b| covers.block_area(b) < 100.0).expect("the block")
}

fn moved(simulation: &Simulation) -> Vector {
    simulation.displacement_of(own(simulation))
}

fn velocity(simulation: &Simulation) -> Vector {
    simulation.rigid_motion_of(own(simulation)).1
}

fn step_for(simulation: &mut Simulation, time: f64) {
    let steps = simulation.steps_in(time);
    step(simulation, steps);
}

/// Push of the water on the block over its mass (m/s²), at a head (m above the joint).
fn push(head: f64) -> f64 {
    WEIGHT * head / (HEIGHT * DENSITY)
}

/// The block runs half a mesh size on the water, and then comes to rest on the dry plane.
#[test]
fn a_slide_that_has_left_its_place_is_braked_by_its_whole_weight() {
    let [slope, friction] = [SLIDE.tilt, SLIDE.friction].map(f64::to_radians);
    let (along, across) = (GRAVITY * slope.sin(), GRAVITY * slope.cos());
    let wet = along - (across - push(SLIDE.head)) * friction.tan();
    let dry = across * friction.tan() - along;
    assert!(wet > 0.0 && dry > 0.0);
    for mesh in [2.0, 1.4] {
        let slide = Block { mesh, ..SLIDE };
        let mut simulation = slide.at_rest();
        let start = moved(&simulation).x;
        assert_eq!((simulation.parted(), simulation.parted_joints()), (Parted::default(), None));
        let limit = 0.5 * mesh;
        let speed = (2.0 * wet * limit).sqrt();
        let time = speed / wet + speed / dry;
        step_for(&mut simulation, speed / wet + 0.5 * speed / dry);
        assert!((velocity(&simulation).x / (0.5 * speed) - 1.0).abs() < 0.03, "{}", velocity(&simulation).x);
        step_for(&mut simulation, 0.5 * speed / dry + 0.2);
        let exact = limit + 0.5 * speed * speed / dry;
        let slid = moved(&simulation).x - start;
        println!("mesh {mesh} m: slid {slid} m, by hand {exact} m in {time} s");
        assert!((slid / exact - 1.0).abs() < 0.02, "{slid} m instead of {exact} m");
        assert!(velocity(&simulation).norm() < 1e-3 * speed, "it rests");
        let Parted { length, pieces, place } = simulation.parted();
        let net = simulation.model().flow.as_ref().expect("a net");
        assert!((length - WIDTH).abs() < 1e-9 && pieces as usize == net.pieces.len(), "{length} {pieces}");
        assert!(place.is_some_and(|place| (place.y - BASE).abs() < 1e-9));
        let told = simulation.parted_joints().expect("a warning");
        assert!(told.contains("12.0000 m in all") && told.contains(&format!("{limit:.4} m (half of")), "{told}");
    }
}

/// The same block with `part = 0` runs on the water for ever, and up to half a mesh size both have the same bits.
#[test]
fn a_slide_within_the_limits_is_unchanged() {
    let mut parts = SLIDE.at_rest();
    let mut never = Block { flow: "part = 0\n", ..SLIDE }.at_rest();
    while moved(&parts).x < 0.95 {
        step(&mut parts, 20);
        step(&mut never, 20);
        assert_eq!(parts.parted().pieces, 0, "{}", moved(&parts).x);
        assert_eq!(parts.state().displacement, never.state().displacement);
        assert_eq!(parts.state().velocity, never.state().velocity);
    }
    step_for(&mut never, 2.0);
    assert!(moved(&never).x > 8.0 && velocity(&never).x > 5.0, "{}", moved(&never));
    assert_eq!((never.parted(), never.parted_joints()), (Parted::default(), None));
    // A static stage has no parted joints, however far blocks have moved before.
    step_for(&mut parts, 1.0);
    assert!(parts.parted().pieces > 0 && parts.pressure_in_joints() == Some(0.0));
    let text = SLIDE.text() + "[[stage]]\nname = \"after\"\nkind = \"static\"\nduration = 0.1\n";
    let mut after = through_bytes(&parts, &SLIDE.text());
    assert_eq!(after.parted(), parts.parted());
    after = simulation(&text);
    run_stage(&mut after);
    assert!(after.next_stage().expect("a stage"));
    let steps = after.steps_in(2.0);
    step(&mut after, steps);
    assert!(after.parted().pieces > 0);
    assert!(after.next_stage().expect("a stage"));
    assert_eq!(after.parted(), Parted::default());
    assert!(after.pressure_in_joints().is_some_and(|sum| sum > 0.9 * WEIGHT * SLIDE.head * WIDTH));
}

/// The push lifts the block until its joint has opened by `part`; then it is thrown and falls freely.
#[test]
fn a_block_that_water_has_lifted_falls_freely() {
    let mut simulation = LIFT.at_rest();
    let up = push(LIFTS) - GRAVITY;
    let start = moved(&simulation).y;
    while simulation.parted().pieces == 0 {
        step(&mut simulation, 1);
    }
    // Half a step ago, as velocities are.
    let speed = velocity(&simulation).y;
    let (opened, exact) = (moved(&simulation).y - start, (2.0 * up * 0.05_f64).sqrt());
    println!("opened {opened} m, {speed} m/s, by hand {exact} m/s");
    assert!((speed / exact - 1.0).abs() < 0.01 && (opened - 0.05).abs() < 2e-3);
    let (time, steps) = (simulation.time(), simulation.steps_in(0.9 * 2.0 * exact / GRAVITY));
    step(&mut simulation, steps);
    let fell = velocity(&simulation).y - speed;
    let free = -GRAVITY * (simulation.time() - time);
    assert!(simulation.parted().pieces > 0 && (fell / free - 1.0).abs() < 1e-9, "{fell} {free}");
    assert!((simulation.parted().length - WIDTH).abs() < 1e-9);
}

/// It is caught by the water again, and goes up and down without end: its energy neither grows nor is any made.
#[test]
fn faces_that_come_back_hold_water_again_and_make_no_energy() {
    let mut simulation = LIFT.at_rest();
    let up = push(LIFTS) - GRAVITY;
    let start = moved(&simulation).y;
    let (mut most, mut times, mut was) = (0.0_f64, 0, false);
    for _ in 0..simulation.steps_in(4.0) {
        step(&mut simulation, 1);
        let has_parted = simulation.parted().pieces > 0;
        times += u32::from(was != has_parted);
        was = has_parted;
        most = most.max(moved(&simulation).y - start);
    }
    let highest = 0.05 * (1.0 + up / GRAVITY);
    println!("{times} times, up to {most} m, by hand {highest} m");
    assert!(times > 4, "{times}");
    assert!(most < 1.01 * highest && most > 0.98 * highest, "{most} {highest}");
    let residual = simulation.report().ledger.residual_relative();
    assert!(residual.abs() < 1e-3 && simulation.doubt(&simulation.report().ledger).is_none(), "{residual}");
}

fn good<T, E: std::fmt::Display>(result: Result<T, E>) -> T {
    result.unwrap_or_else(|e| panic!("{e}"))
}

/// A host at the start of the dynamic stage.
fn host(block: &Block, threads: usize) -> Cosimulation {
    let mut model = good(Cosimulation::new(case(&block.text())));
    good(model.set_threads(threads));
    good(model.start());
    model
}

/// Goes on to a time (s), in communication steps of `h` (s).
fn go(model: &mut Cosimulation, until: f64, h: f64) {
    while model.time() < until {
        let (t, step) = (model.time(), h.min(until - model.time()));
        good(model.do_step(t, step));
    }
}

fn bytes(model: &Cosimulation) -> Vec<u8> {
    good(model.serialize(&model.save()))
}

/// Then (s) the joint has parted; a half and a tenth of it have exact sums.
const END: f64 = 45.0 / 64.0;

#[test]
fn communication_steps_returns_and_bytes_change_no_bit() {
    let lags = Block { course: "flow = \"transient\"\nflow_every = 4\n", flow: "part = 0.05\n", ..SLIDE };
    for block in [LIFT, Block { mesh: 1.0, ..SLIDE }, Block { mesh: 1.0, ..lags }] {
        let mut whole = host(&block, 1);
        go(&mut whole, END, END);
        let parted = whole.totals().flow.parted;
        assert!(parted.pieces > 0 && parted.length > 11.9, "{parted:?}");
        for h in [END / 2.0, END / 10.0] {
            let mut parts = host(&block, 1);
            go(&mut parts, END, h);
            assert_eq!(parts.block_states(), whole.block_states(), "steps of {h} s");
            assert_eq!((parts.totals(), parts.port_state(0)), (whole.totals(), whole.port_state(0)));
        }
        let (before, saved) = (whole.save(), bytes(&whole));
        go(&mut whole, 1.25 * END, END / 10.0);
        let end = bytes(&whole);
        good(whole.restore(&before));
        assert_eq!(whole.totals().flow.parted, parted);
        go(&mut whole, 1.25 * END, END / 10.0);
        assert!(bytes(&whole) == end, "returned");
        let mut other = host(&block, 1);
        let read = good(other.deserialize(&saved));
        good(other.restore(&read));
        go(&mut other, 1.25 * END, END / 10.0);
        assert!(bytes(&other) == end, "from bytes");
    }
}

#[test]
fn threads_change_no_bit() {
    let run = |threads: usize| {
        let mut model = host(&Block { mesh: 0.2, flow: "part = 2e-4\n", ..LIFT }, threads);
        assert!(model.simulation().model().covers.cover_count() > enmm::internals::step::THREADS_FROM);
        go(&mut model, 0.015, 0.015);
        assert!(model.totals().flow.parted.pieces > 0);
        bytes(&model)
    };
    assert!(run(1) == run(2));
}

/// Neither before joints part nor afterwards, in a stage that holds the flow.
#[test]
fn a_step_with_parted_joints_allocates_nothing() {
    let mut simulation = SLIDE.at_rest();
    simulation.set_serial(true);
    step_for(&mut simulation, 0.1);
    for parts in [false, true] {
        assert_eq!(simulation.parted().pieces > 0, parts);
        let found = measure(|| step(&mut simulation, 50));
        assert_eq!(found.count_total, 0, "{found:?}");
        step_for(&mut simulation, 1.5);
    }
}

/// A parted piece is as wide as joints can be, so that more water flows through it than before.
#[test]
fn parted_pieces_keep_the_greatest_aperture_in_the_net() {
    let course = "flow = \"steady\"\nflow_every = 1\nheads = { left = 18.0, right = 17.0 }\n";
    let mut simulation = Block { course, ..LIFT }.at_rest();
    let through = |simulation: &Simulation| simulation.inlet(0).inflow;
    step(&mut simulation, 1);
    let by_hand = |aperture: f64| WEIGHT * aperture.powi(3) / 12e-3 / WIDTH;
    assert!((through(&simulation) / by_hand(1e-4) - 1.0).abs() < 1e-9, "{}", through(&simulation));
    while simulation.parted().length < WIDTH - 1e-9 {
        step(&mut simulation, 1);
    }
    step(&mut simulation, 1);
    assert!((through(&simulation) / by_hand(20.0 * 1e-4) - 1.0).abs() < 1e-9, "{}", through(&simulation));
}

#[test]
fn an_opening_that_cannot_be_is_refused() {
    let of = |flow: &str| Block { flow, ..SLIDE }.text();
    let told = refusal(&of("part = -0.1\n"));
    assert!(told.contains("flow.part: is -0.1") && told.contains("0 for pieces that never part"), "{told}");
    let still = of("part = 0.1\n");
    let still = &still[..still.rfind("[[stage]]\nname = \"motion\"").expect("a dynamic stage")];
    let told = refusal(still);
    assert!(told.contains("flow.part: is 0.1 m, and has no effect without a dynamic stage"), "{told}");
    let mut short = case(&of("part = 0.1\n"));
    short.keep_stages(1);
    assert!(short.validate().is_ok() && short.parting() == Some([1.0, 0.1]));
}
