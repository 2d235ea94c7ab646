//! Claim: a model that a host drives breaks as one that `enmm run` drives, with the same bits by communication steps,
//! returns and bytes; blocks keep their numbers, and the parts of a stage's cut count as those of a break.

use enmm::cosimulation::{Cosimulation, EventKind, Input, Interpolation, SectionFailure};
use enmm::geometry::Vector;

use crate::common::case;

/// A bar of 2 m by 1 m that grows from a wall and breaks when gravity acts on it at once, or when it is pushed down.
const BAR: &str = r#"
title = "bar"
[domain]
outline = [[-3, -2], [0, -2], [0, 0], [2, 0], [2, 1], [0, 1], [0, 3], [-3, 3]]
[mesh]
size = 0.5
angle_deg = 10
origin = [0.0137, 0.0071]
[rock.rock]
density = 2600
young = 30e9
poisson = 0.25
[rock.rock.fracture]
tension = 0.5e6
cohesion = 50e6
friction_deg = 45
[fracture]
least_part = 0.5
parts_max = 3
[[fix]]
box = [-9, -9, -0.5, 9]
[[port]]
name = "bar"
block = [1.4, 0.6]
[[stage]]
name = "weight"
kind = "dynamic"
duration = 0.0625
damping = 0
"#;

fn bar() -> Cosimulation {
    host(BAR)
}

fn host(text: &str) -> Cosimulation {
    Cosimulation::new(case(text)).unwrap_or_else(|e| panic!("{e}"))
}

/// Goes on to a time (s) in steps of `h` (s).
fn go(model: &mut Cosimulation, until: f64, h: f64) {
    while model.time() < until - 1e-9 {
        let (t, step) = (model.time(), h.min(until - model.time()));
        model.do_step(t, step).unwrap_or_else(|e| panic!("{e}"));
    }
}

/// A step that ends between two points of the grid.
fn little(model: &mut Cosimulation) {
    let t = model.time();
    model.do_step(t, MILLI / 64.0).unwrap_or_else(|e| panic!("{e}"));
}

fn bytes(model: &Cosimulation) -> Vec<u8> {
    model.serialize(&model.save()).unwrap_or_else(|e| panic!("{e}"))
}

/// Times are sums of powers of two, so that hosts that sum them up differently agree about them.
const END: f64 = 1.0 / 16.0;
const MILLI: f64 = 1.0 / 1024.0;

#[test]
fn a_break_has_the_same_bits_in_any_communication_steps() {
    let mut whole = bar();
    go(&mut whole, END, END);
    let cuts: Vec<_> = whole.cuts().collect();
    assert_eq!(cuts.len(), 1, "{cuts:?}");
    assert!(0.0 < cuts[0].time && cuts[0].time < END && cuts[0].failure == SectionFailure::Bends);
    for h in [8.0 * MILLI, 0.5 * MILLI, 0.125 * MILLI] {
        let mut parts = bar();
        go(&mut parts, END, h);
        assert_eq!(parts.block_states(), whole.block_states(), "steps of {h} s");
        assert!(parts.cuts().eq(whole.cuts()) && parts.events().eq(whole.events()));
    }
}

#[test]
fn returns_across_a_break_and_bytes_of_a_release_have_the_same_bits() {
    let mut model = bar();
    go(&mut model, 2.0 * MILLI, MILLI);
    let before = model.save();
    while model.cuts().len() == 0 {
        little(&mut model);
    }
    let release = bytes(&model);
    let now = model.time();
    go(&mut model, END, MILLI);
    let end = bytes(&model);
    // As the host stepped the first time.
    let again = |model: &mut Cosimulation| {
        while model.cuts().len() == 0 {
            little(model);
        }
        go(model, END, MILLI);
        bytes(model)
    };
    for _ in 0..100 {
        model.restore(&before).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((model.block_states().len(), model.cuts().len()), (1, 0));
        little(&mut model);
    }
    model.restore(&before).unwrap_or_else(|e| panic!("{e}"));
    assert!(again(&mut model) == end, "returned");

    let mut other = bar();
    let read = other.deserialize(&release).unwrap_or_else(|e| panic!("{e}"));
    other.restore(&read).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((other.time(), other.block_states().len()), (now, 2));
    go(&mut other, END, MILLI);
    assert!(bytes(&other) == end, "from bytes");
}

#[test]
fn the_part_with_the_port_keeps_its_number_and_its_force() {
    let mut model = bar();
    let port = model.find_port("bar").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((model.block_states().len(), model.blocks_max()), (1, 4));
    let block = model.port_block(port).unwrap_or_else(|e| panic!("{e}"));
    model.set_block_force(block, [0.0, -1e4], 0.0).unwrap_or_else(|e| panic!("{e}"));
    let early = model.set_block_force(1u32, [0.0, 0.0], 0.0).expect_err("there is no part yet").to_string();
    assert!(early.contains("block: is 1, must be less than the number of blocks, 1"), "{early}");
    let none = model.own_block(u32::MAX).expect_err("there is no such block").to_string();
    assert!(none.contains("block: is 4294967295, must be less than"), "{none}");
    go(&mut model, END, MILLI);
    let states = model.block_states();
    assert_eq!(states.iter().map(|state| state.id).collect::<Vec<_>>(), [0, 1]);
    assert_eq!(model.port_block(port).ok(), Some(block));
    let [bar, wall] = [&states[0], &states[1]];
    assert!(bar.area < 2.2 && bar.detached && wall.area > 10.0, "{states:?}");
    assert!(model.port_state(port).velocity.y < -0.1, "{:?}", model.port_state(port));
    assert_eq!(model.block_force(block).ok(), Some((Vector::new(0.0, -1e4), 0.0)));
    assert_eq!(model.block_force(1u32).ok(), Some((Vector::zeros(), 0.0)));
    // The part that is free takes forces by its number, on their way too.
    model.set_interpolation_of(Input::Port(port as u32), Interpolation::Linear).unwrap_or_else(|e| panic!("{e}"));
    let (before, h) = (model.block_states()[0].velocity.x, 1e-3);
    model.set_block_force(block, [1e5, 0.0], 0.0).unwrap_or_else(|e| panic!("{e}"));
    go(&mut model, END + h, h);
    let gained = (model.block_states()[0].velocity.x - before) * bar.mass / (0.5 * 1e5 * h);
    assert!((gained - 1.0).abs() < 0.05, "{gained}");
}

#[test]
fn a_host_that_weakens_rock_breaks_it() {
    let mut model = host(&BAR.replace("tension = 0.5e6", "tension = 2e6").replace("damping = 0", "damping = 0.3"));
    go(&mut model, 0.02, 0.01);
    assert_eq!(model.cuts().len(), 0);
    model.set_strength_factor(0.14).unwrap_or_else(|e| panic!("{e}"));
    let info = model.do_step(0.02, 0.01).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(info.events.iter().filter(|event| event.kind == EventKind::Cut).count(), 1, "{info:?}");
}

#[test]
fn more_parts_than_the_case_allows_end_the_step_before_it_begins() {
    let mut model = host(&BAR.replace("parts_max = 3", "parts_max = 1"));
    go(&mut model, END, MILLI);
    model.set_strength_factor(1e-3).unwrap_or_else(|e| panic!("{e}"));
    let before = bytes(&model);
    let error = model.do_step(END, END).expect_err("the wall would break").to_string();
    assert!(error.contains("fracture.parts_max"), "{error}");
    assert!(bytes(&model) == before);
}

/// A stage parts the bar along a new line while a host drives the model.
#[test]
fn a_stage_that_cuts_has_the_same_bits_in_any_communication_steps() {
    let stage = "[joint_law.smooth]\nfriction_deg = 20\n[[stage]]\nname = \"cut\"\nkind = \"dynamic\"\n\
                 duration = 0.0625\ndamping = 0\ncut = [{ points = [[1, 1.1], [1, -0.1]], law = \"smooth\" }]\n";
    let text = BAR.replace("tension = 0.5e6", "tension = 5e6") + stage;
    let mut whole = host(&text);
    assert_eq!((whole.block_states().len(), whole.blocks_max()), (1, 5));
    go(&mut whole, 2.0 * END, END);
    assert_eq!(whole.block_states().len(), 2);
    let mut parts = host(&text);
    go(&mut parts, 0.75 * END, 4.0 * MILLI);
    let before = parts.save();
    go(&mut parts, 2.0 * END, 0.25 * MILLI);
    assert_eq!(parts.block_states(), whole.block_states());
    parts.restore(&before).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(parts.block_states().len(), 1);
    go(&mut parts, 2.0 * END, 16.0 * MILLI);
    assert_eq!(parts.block_states(), whole.block_states());
}
