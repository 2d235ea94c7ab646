//! A host lets a wave in through a quiet boundary, moves a held place and makes inputs jump: each as the case would.

use std::path::Path;

use enmm::cosimulation::{Cosimulation, Input, Interpolation};
use enmm::geometry::Vector;
use enmm_io::parse_case;

fn started(text: &str) -> Cosimulation {
    let loaded = parse_case(text, "case", Path::new("")).unwrap_or_else(|e| panic!("{e}"));
    let mut model = loaded.cosimulation().unwrap_or_else(|e| panic!("{e}"));
    model.start().unwrap();
    model
}

fn displacements(model: &Cosimulation) -> Vec<Vector> {
    model.simulation().state().displacement.clone()
}

/// A column of rock on a quiet boundary, with a block on top that may slide.
fn column(more: &str) -> String {
    format!(
        "title = \"column\"\ndomain.outline = [[0, 0], [4, 0], [4, 8], [0, 8]]\n\
         mesh = {{ size = 1.0, origin = [0.031, 0.017] }}\n\
         rock.rock = {{ density = 2500, young = 1e8, poisson = 0.25 }}\n\
         joint_law.joint.friction_deg = 20\nsolver.communication_step = 0.02\n\
         joint = [{{ points = [[-1, 6.1], [5, 5.9]] }}]\n\
         stage = [{{ name = \"rest\", kind = \"static\", duration = 5.0 }},\n\
         {{ name = \"shake\", kind = \"dynamic\", duration = 2.0, damping = 0.02 }}]\n{more}"
    )
}

/// Rows of a record: time (s) and particle velocity (m/s).
fn record(rows: usize, every: f64) -> Vec<[f64; 2]> {
    (0..rows).map(|k| [k as f64 * every, 0.3 * (17.0 * k as f64 * every).sin() * (k as f64 / rows as f64)]).collect()
}

/// The wave that a host sets at the rows of a record, linear between them, is the record in the case.
#[test]
fn a_wave_through_a_port_is_that_of_the_case() {
    let every = 0.02;
    let rows = record(40, every);
    let table = format!("{rows:?}");
    let of_case = column(&format!("quiet = [{{ edge = [[0, 0], [4, 0]], wave = [1.0, 0.25], table = {table} }}]\n"));
    let of_host =
        column("quiet = [{ edge = [[0, 0], [4, 0]] }]\nport = [{ name = \"base\", quiet = [[4, 0], [0, 0]] }]\n");
    let (mut case, mut host) = (started(&of_case), started(&of_host));
    host.set_interpolation(Interpolation::Linear);
    for pair in rows.windows(2) {
        host.set_port_velocity(0, Vector::new(1.0, 0.25) * pair[1][1]).unwrap();
        for model in [&mut case, &mut host] {
            model.do_step(pair[0][0], every).unwrap();
        }
        let (a, b) = (displacements(&case), displacements(&host));
        let most = a.iter().map(|u| u.norm()).fold(0.0, f64::max);
        let apart = a.iter().zip(&b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(apart <= 1e-12 * most.max(1e-3), "{apart:e} of {most} at {}", pair[1][0]);
    }
    let port = host.port_state(0);
    assert!(port.velocity.norm() > 1e-3 && port.traction.norm() > 1e3, "{port:?}");
    let stress = host.ports()[0].edges.len();
    assert!(stress > 1 && host.set_port_displacement(0, Vector::zeros()).is_err());
}

/// A block on a smooth floor, pushed by a support at its middle.
fn pushed(fix: &str, port: &str) -> String {
    format!(
        "title = \"pushed\"\ngravity = {{ x = 0.0, y = -9.81 }}\n\
         domain.outline = [[-2, -1], [6, -1], [6, 0], [-2, 0]]\ndomain.islands = [[[0, 0], [2, 0], [2, 1], [0, 1]]]\n\
         mesh = {{ size = 0.6, origin = [0.031, 0.017] }}\n\
         rock.rock = {{ density = 2500, young = 1e9, poisson = 0.25 }}\n\
         joint_law.joint.friction_deg = 20\n\
         fix = [{{ block = [4, -0.5] }}, {{ name = \"ram\", point = [1.0, 0.5], axes = \"x\"{fix} }}]\n{port}\
         stage = [{{ name = \"rest\", kind = \"static\", duration = 5.0 }},\n\
         {{ name = \"push\", kind = \"dynamic\", duration = 2.0, damping = 0.1 }}]\n"
    )
}

const RAM: &str = "port = [{ name = \"ram\", fix = \"ram\" }]\n";

/// The velocity that a host sets is that of `[[fix]]`, bit for bit; the block moves with it, the reaction overcomes the
/// friction m·g·tan(20 degrees), and the ledger has its work.
#[test]
fn a_velocity_through_a_port_is_that_of_a_fixity() {
    let mut case = started(&pushed(", velocity = [0.1, 0.0]", ""));
    let mut host = started(&pushed("", RAM));
    host.set_port_velocity(0, Vector::new(0.1, 0.0)).unwrap();
    let dt = host.internal_step();
    let before = host.energies().external_work;
    let (mut work, mut velocity) = (0.0, host.port_state(0).velocity);
    for k in 0..2000 {
        let t = k as f64 * dt;
        case.do_step(case.time(), t + dt - case.time()).unwrap();
        host.do_step(host.time(), t + dt - host.time()).unwrap();
        let port = host.port_state(0);
        work += port.reaction.dot(&(velocity + port.velocity)) * 0.5 * if k == 0 { 0.5 * dt } else { dt };
        velocity = port.velocity;
    }
    assert_eq!(displacements(&case), displacements(&host));
    let (port, end) = (host.port_state(0), 2000.0 * dt);
    assert!((port.displacement.x / (0.1 * end) - 1.0).abs() < 0.01, "{port:?} after {end} s");
    let friction = 2.0 * 2500.0 * 9.81 * 20f64.to_radians().tan();
    assert!((port.reaction.x / friction - 1.0).abs() < 0.05, "{} of {friction}", port.reaction.x);
    let of_ledger = host.energies().external_work - before;
    assert!((of_ledger / work - 1.0).abs() < 1e-12, "{of_ledger} of {work}");
    assert!(host.energies().residual().abs() < 1e-3 * of_ledger, "{:?}", host.energies());
}

/// A displacement is reached at the end of the step, however long it is, kept afterwards, and part of saved states.
#[test]
fn a_displacement_is_reached_and_kept() {
    let mut host = started(&pushed("", RAM));
    let moved = |model: &Cosimulation| model.simulation().state().drive.moved[0].x;
    host.set_port_displacement(0, Vector::new(0.01, 0.0)).unwrap();
    let saved = host.save();
    host.do_step(0.0, 0.1).unwrap();
    assert!((moved(&host) - 0.01).abs() < 1e-15, "{}", moved(&host));
    let end = displacements(&host);
    host.do_step(0.1, 0.05).unwrap();
    assert!((moved(&host) - 0.01).abs() < 1e-15, "{}", moved(&host));
    host.restore(&saved).unwrap();
    host.do_step(0.0, 0.1).unwrap();
    assert_eq!(displacements(&host), end);
    let bytes = host.serialize(&saved).unwrap();
    let read = host.deserialize(&bytes).unwrap();
    host.restore(&read).unwrap();
    host.do_step(0.0, 0.1).unwrap();
    assert_eq!(displacements(&host), end);
    assert!(host.set_port_velocity(0, Vector::new(f64::NAN, 0.0)).is_err());
}

/// With linear inputs a load that jumps acts from the start of the step, another goes its way; a single input may hold.
#[test]
fn inputs_jump_hold_and_go_their_way_side_by_side() {
    let text = pushed("", "");
    let mut held = started(&text);
    let block = held.block_states().iter().position(|b| !b.fixed).unwrap() as u32;
    let mut jumped = held.clone();
    let mut single = held.clone();
    held.set_block_force(block, Vector::new(3e3, 0.0), 0.0).unwrap();
    held.do_step(0.0, 0.01).unwrap();
    jumped.set_interpolation(Interpolation::Linear);
    jumped.set_block_force(block, Vector::new(3e3, 0.0), 0.0).unwrap();
    let ramped = {
        let mut ramped = jumped.clone();
        ramped.do_step(0.0, 0.01).unwrap();
        displacements(&ramped)
    };
    jumped.jump();
    jumped.do_step(0.0, 0.01).unwrap();
    assert_eq!(displacements(&held), displacements(&jumped));
    assert_ne!(displacements(&held), ramped);
    single.set_interpolation(Interpolation::Linear);
    single.set_interpolation_of(Input::Block(block), Interpolation::Hold).unwrap();
    single.set_block_force(block, Vector::new(3e3, 0.0), 0.0).unwrap();
    single.do_step(0.0, 0.01).unwrap();
    assert_eq!(displacements(&held), displacements(&single));
    single.set_interpolation(Interpolation::Hold);
    single.set_interpolation_of(Input::Block(block), Interpolation::Linear).unwrap();
    assert_eq!(single.interpolation_of(Input::Gravity), Interpolation::Hold);
    assert!(single.set_interpolation_of(Input::Port(9), Interpolation::Hold).is_err());
}
