//! Inputs of hosts move the rock as mechanics says: base acceleration (Newmark, C4), water, tractions, pressures,
//! strength factor, gravity, block forces, with closed ledgers.

use std::path::Path;

use enmm::cosimulation::Cosimulation;
use enmm::geometry::Vector;
use enmm_io::parse_case;

const G: f64 = 9.81;

/// A block of 2 m × 1 m and 4000 kg/m on a held base whose surface dips by `dip_deg` to the right.
fn block_on_base(dip_deg: f64, friction_deg: f64, more: &str) -> Cosimulation {
    let (s, c) = (-dip_deg).to_radians().sin_cos();
    let turn = |[x, y]: [f64; 2]| format!("[{:.15}, {:.15}]", c * x - s * y, s * x + c * y);
    let outline = [[-3.0, -1.0], [9.0, -1.0], [9.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0], [0.0, 0.0], [-3.0, 0.0]];
    let outline = outline.map(turn).join(", ");
    let [left_foot, right_foot] = [[0.0, 0.0], [2.0, 0.0]].map(turn);
    let [left_head, right_head] = [[0.0, 1.0], [2.0, 1.0]].map(turn);
    let text = format!(
        r#"
title = "Block on a base"
domain.outline = [{outline}]
mesh = {{ size = 0.8, origin = [0.03, 0.01] }}
joint = [{{ points = [{left_foot}, {right_foot}] }}]
joint_law.joint.friction_deg = {friction_deg}
rock.r = {{ density = 2000, young = 50e9, poisson = 0.2 }}
fix = [{{ block = {} }}]
solver.communication_step = 0.01
port = [
    {{ name = "block", block = {} }},
    {{ name = "left", boundary = [{left_foot}, {left_head}] }},
    {{ name = "top", boundary = [{left_head}, {right_head}] }},
    {{ name = "joint", joint = [{left_foot}, {right_foot}] }},
]
stage = [
    {{ name = "settle", kind = "static", duration = 5.0, convergence = 1e-7 }},
    {{ name = "move", kind = "dynamic", duration = 2.0, damping = 0.1 }},
]
{more}
"#,
        turn([5.0, -0.5]),
        turn([1.0, 0.5]),
    );
    let loaded = parse_case(&text, "block.toml", Path::new("")).unwrap_or_else(|e| panic!("{e}"));
    let mut model = loaded.cosimulation().unwrap_or_else(|e| panic!("{e}"));
    model.start().unwrap_or_else(|e| panic!("{e}"));
    model
}

fn step(model: &mut Cosimulation, h: f64) {
    let t = model.time();
    model.do_step(t, h).unwrap_or_else(|e| panic!("{e}"));
}

fn push(model: &mut Cosimulation, force: Vector) {
    let block = model.ports()[0].block.number();
    model.set_block_force(block, force, 0.0).unwrap();
}

/// Velocity and displacement of the moving block along the slope, downhill positive.
fn along(model: &Cosimulation, dip_deg: f64) -> [f64; 2] {
    let down = Vector::new(dip_deg.to_radians().cos(), -dip_deg.to_radians().sin());
    let state = model.port_state(0);
    [state.velocity.dot(&down), state.displacement.dot(&down)]
}

fn assert_ledger_closes(model: &Cosimulation) {
    let ledger = model.totals().ledger;
    assert!(ledger.residual().abs() < 2e-3 * ledger.largest(), "{} of {}", ledger.residual(), ledger.largest());
}

#[test]
fn c4_pulse_on_a_flat_base_slips_by_newmark() {
    // Base to the left at 0.5 g for 0.5 s against 0.2 g: the block slips 0.919687 m to the right and stops at 1.25 s.
    let mut model = block_on_base(0.0, 0.2f64.atan().to_degrees(), "");
    model.set_base_acceleration(Vector::new(-0.5 * G, 0.0)).unwrap();
    step(&mut model, 0.5);
    let [v, _] = along(&model, 0.0);
    assert!((v - 0.3 * G * 0.5).abs() < 1e-3, "{v}");
    model.set_base_acceleration(Vector::zeros()).unwrap();
    step(&mut model, 0.7);
    assert!(along(&model, 0.0)[0] > 0.05);
    step(&mut model, 0.1);
    let [v, slip] = along(&model, 0.0);
    assert!(v.abs() < 1e-4, "{v}");
    assert!((slip - 0.919687).abs() < 5e-4, "{slip}");
    assert_ledger_closes(&model);
}

#[test]
fn c4_pulse_on_an_incline_slips_by_newmark() {
    let mut model = block_on_base(20.0, 30.0, "");
    model.set_base_acceleration(Vector::new(-0.5 * G, 0.0)).unwrap();
    step(&mut model, 0.5);
    let [v, _] = along(&model, 20.0);
    assert!((v - 1.805370).abs() < 2e-3, "{v}");
    model.set_base_acceleration(Vector::zeros()).unwrap();
    step(&mut model, 1.2);
    let [v, slip] = along(&model, 20.0);
    assert!(v.abs() < 1e-4, "{v}");
    assert!((slip - 1.279846).abs() < 1e-3, "{slip}");
    assert_ledger_closes(&model);
}

#[test]
fn traction_and_pressure_push_the_block_by_their_resultants() {
    // On a smooth flat base: 10 kPa on the left face, 1 m high, against 4000 kg.
    for traction in [true, false] {
        let mut model = block_on_base(0.0, 0.0, "");
        if traction {
            model.set_boundary_traction(1, Vector::new(1e4, 0.0)).unwrap();
        } else {
            model.set_pressure(1, 1e4).unwrap();
        }
        step(&mut model, 0.4);
        let [v, _] = along(&model, 0.0);
        assert!((v - 2.5 * 0.4).abs() < 2e-3, "{v}");
        assert_ledger_closes(&model);
    }
}

#[test]
fn block_force_and_pressure_on_top_change_what_friction_holds() {
    // Friction 0.5: the block of 39 240 N/m holds 19 620 N/m; with 20 kPa over 2 m of top it holds 39 620 N/m.
    let mut model = block_on_base(0.0, 0.5f64.atan().to_degrees(), "");
    model.set_pressure(2, 2e4).unwrap();
    push(&mut model, Vector::new(3.9e4, 0.0));
    step(&mut model, 0.5);
    assert!(along(&model, 0.0)[0].abs() < 1e-3);
    model.set_pressure(2, 0.0).unwrap();
    let [before, _] = along(&model, 0.0);
    step(&mut model, 0.5);
    let [v, _] = along(&model, 0.0);
    assert!((v - before - (3.9e4 - 1.962e4) / 4000.0 * 0.5).abs() < 5e-3, "{v}");
}

#[test]
fn pressure_in_the_joint_lifts_what_friction_has() {
    // 10 kPa under 2 m takes 20 000 of 39 240 N/m off the contact: friction 0.5 then holds 9 620 N/m.
    let mut model = block_on_base(0.0, 0.5f64.atan().to_degrees(), "");
    model.set_pressure(3, 1e4).unwrap();
    push(&mut model, Vector::new(1.2e4, 0.0));
    step(&mut model, 0.5);
    let [v, _] = along(&model, 0.0);
    assert!((v - (1.2e4 - 9620.0) / 4000.0 * 0.5).abs() < 5e-3, "{v}");
    let normal = model.port_state(3).normal_force;
    assert!((normal - 19_240.0).abs() < 400.0, "{normal}");
    assert_ledger_closes(&model);
}

#[test]
fn a_submerged_block_weighs_less_by_its_water() {
    // 2 m² of water: 4000 − 2000 kg. Contact force on the block under still water, level 3 m above the base.
    let mut model = block_on_base(0.0, 30.0, "[water]\nlevel = -5.0");
    assert!((model.port_state(0).contact_force.y - 4000.0 * G).abs() < 50.0);
    model.set_water_level(3.0).unwrap();
    step(&mut model, 0.5);
    let force = model.port_state(0).contact_force;
    assert!((force.y - 2000.0 * G).abs() < 50.0, "{force}");
    // Half submerged without water in the joint: the side pressures balance, nothing lifts.
    let mut dry_joint = block_on_base(0.0, 30.0, "[water]\nlevel = -5.0\njoints = false");
    dry_joint.set_water_level(0.5).unwrap();
    step(&mut dry_joint, 0.5);
    let force = dry_joint.port_state(0).contact_force;
    assert!((force.y - 4000.0 * G).abs() < 50.0 && force.x.abs() < 50.0, "{force}");
}

#[test]
fn the_strength_factor_brings_the_factor_of_safety() {
    // tan 40° / tan 30° = 1.453363: at 1/1.46 the block slides, at 1/1.44 it stays.
    for (safety, slides) in [(1.46, true), (1.44, false)] {
        let mut model = block_on_base(30.0, 40.0, "");
        model.set_strength_factor(1.0 / safety).unwrap();
        step(&mut model, 1.0);
        let [v, slip] = along(&model, 30.0);
        assert_eq!(slip > 1e-3, slides, "{safety}: {slip} m, {v} m/s");
    }
}

#[test]
fn gravity_that_turns_slides_the_block() {
    // Gravity turned by 20° on a flat base with friction 10°.
    let mut model = block_on_base(0.0, 10.0, "");
    let (s, c) = 20f64.to_radians().sin_cos();
    model.set_gravity(Vector::new(G * s, -G * c)).unwrap();
    step(&mut model, 1.0);
    let [v, _] = along(&model, 0.0);
    let expected = G * (s - c * 10f64.to_radians().tan());
    assert!((v - expected).abs() < 2e-3, "{v} instead of {expected}");
    assert_ledger_closes(&model);
}
