//! Joints that soften take the energy of fracture that their law gives, and have its strength (theory §7).

use enmm::cosimulation::EventKind;
use enmm::model::Simulation;
use enmm::model::bytes::{Keeper, decode, encode};

use crate::common::{refusal, run_stage, simulation};

/// A1: a bar of two halves, of which the lower one is held and the upper one moves off.
fn bar(size: f64, half: f64, speed: f64) -> String {
    format!(
        "title = \"bar\"\n[domain]\noutline = [[0, {low}], [0.1, {low}], [0.1, {half}], [0, {half}]]\n[mesh]\n\
         size = {size}\nangle_deg = 8\norigin = [0.00137, 0.00071]\n[[joint]]\npoints = [[0, 0], [0.1, 0]]\n\
         [rock.rock]\ndensity = 2600\nyoung = 30e9\npoisson = 0\n[joint_law.rock]\nfriction_deg = 45\n\
         cohesion = 15e6\nresidual_cohesion = 0\ntension = 5e6\ntension_energy = 50\nshear_energy = 5000\n\
         normal_stiffness = 1e14\nshear_stiffness = 1e14\n[gravity]\ny = 0\n\
         [[fix]]\nblock = [0.05, {inside}]\n[[initial_velocity]]\nblock = [0.05, {above}]\nvelocity = [0, {speed}]\n\
         [solver]\ndt_max = 2e-8\n[[stage]]\nname = \"pull\"\nkind = \"dynamic\"\nduration = 1.0\ndamping = 0\n",
        low = -half,
        inside = -0.5 * half,
        above = 0.5 * half,
    )
}

/// Sums of normal and shear force (N/m) over all contacts.
fn forces(simulation: &Simulation) -> [f64; 2] {
    let contacts = simulation.state().contacts.iter();
    contacts.fold([0.0; 2], |[normal, shear], c| [normal + c.normal_force, shear + c.shear_force])
}

fn advance(simulation: &mut Simulation) {
    simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
}

/// What the ledger holds (J/m) that can fracture bonds: kinetic, strain and stored energy.
fn mechanical(simulation: &Simulation) -> f64 {
    let ledger = simulation.report().ledger;
    ledger.kinetic + ledger.strain + ledger.stored
}

#[test]
fn a_bar_breaks_at_its_strength_with_its_energy_of_fracture() {
    for size in [0.04, 0.025, 0.015] {
        let mut simulation = simulation(&bar(size, 0.03, 1.5));
        let start = mechanical(&simulation);
        let mut peak = 0.0f64;
        while simulation.state().counters.broken < 0.0999 {
            advance(&mut simulation);
            peak = peak.max(-forces(&simulation)[0] / 0.1);
            assert!(simulation.time() < 1e-3, "it holds: {:?}", simulation.state().bonds);
        }
        let fracture = simulation.state().ledger.fracture / 0.1;
        let lost = (start - mechanical(&simulation)) / 0.1;
        println!("h {size}: peak {peak:.5e} Pa, fracture {fracture:.6} J/m², lost {lost:.6} J/m²");
        assert!((peak / 5e6 - 1.0).abs() < 1e-3, "{peak} Pa");
        assert!((fracture / 50.0 - 1.0).abs() < 1e-3, "{fracture} J/m²");
        // Where an edge follows an element elsewhere (theory §5) the gap jumps as a node passes the end of the edge: at
        // h 0.025 the contacts give 0.4 % that way, whatever the step.
        assert!((lost / 50.0 - 1.0).abs() < 6e-3, "{lost} J/m² lost");
        let ledger = simulation.report().ledger;
        assert!(ledger.residual_relative().abs() < 1e-6, "{}", ledger.residual_relative());
    }
}

/// A stiff block of 1 m under 1 MPa that slides on a held slab: their outlines, the mesh, joints and their laws.
fn slider(domain: &str, [size, angle]: [f64; 2], joints: &str) -> String {
    format!(
        "title = \"direct shear\"\n[domain]\n{domain}\n[mesh]\nsize = {size}\nangle_deg = {angle}\n\
         origin = [0.0137, 0.0071]\n{joints}normal_stiffness = 1e11\nshear_stiffness = 1e12\n[rock.rock]\n\
         density = 1e6\nyoung = 1e14\npoisson = 0.25\n[gravity]\ny = 0\n[in_situ]\nsxx = 0\nsyy = -1e6\n\
         [[load]]\nkind = \"pressure\"\nedge = [[0, 0.002], [1, 0.002]]\npressure = 1e6\n[[fix]]\n\
         block = [0.5, -0.05]\n[[initial_velocity]]\nblock = [0.5, 0.001]\nvelocity = [1.5, 0]\n[solver]\n\
         friction_delay = 0\ndt_max = 5e-7\n[[stage]]\nname = \"slide\"\nkind = \"dynamic\"\nduration = 1.0\n\
         damping = 0\n"
    )
}

/// A2: it slides on a bond.
fn shear_box(size: f64) -> String {
    let domain = "outline = [[-1, -0.1], [2, -0.1], [2, 0], [-1, 0]]\njoint_law = \"rock\"\n\
                  islands = [[[0, 0], [1, 0], [1, 0.002], [0, 0.002]]]";
    let bond = "[joint_law.rock]\nfriction_deg = 35\nresidual_friction_deg = 30\ncohesion = 0.5e6\n\
                residual_cohesion = 0\ntension = 0.4e6\ntension_energy = 50\nshear_energy = 500\n";
    slider(domain, [size, 8.0], bond)
}

#[test]
fn a_bond_in_shear_has_peak_and_residual_strength_and_the_slip_between() {
    for size in [0.2, 0.1, 0.05] {
        let mut simulation = simulation(&shear_box(size));
        let (mut peak, mut slip, mut length) = (0.0f64, 0.0, 0.0);
        while simulation.state().counters.broken < 0.999 {
            let before = simulation.state().contacts.clone();
            advance(&mut simulation);
            peak = peak.max(forces(&simulation)[1].abs());
            for (contact, before) in simulation.workspace().contacts.iter().zip(before) {
                let after = simulation.state().contacts.iter().find(|c| (c.node, c.side) == (before.node, before.side));
                if let Some(after) = after.filter(|after| before.intact && !after.intact) {
                    (slip, length) = (slip + contact.bonded * after.slip, length + contact.bonded);
                }
            }
            assert!(simulation.time() < 0.05, "it holds: {:?}", simulation.state().bonds);
        }
        let (fracture, slip) = (simulation.state().ledger.fracture, slip / length);
        (0..20).for_each(|_| advance(&mut simulation));
        let residual = forces(&simulation)[1].abs();

        println!("h {size}: τp {peak:.6e}, τr {residual:.6e} Pa, slip {slip:.6e} m, fracture {fracture:.4} J/m²");
        assert!((peak / 1.200208e6 - 1.0).abs() < 1e-3, "{peak} Pa");
        assert!((residual / 0.577350e6 - 1.0).abs() < 1e-3, "{residual} Pa");
        assert!((slip / 1.605504e-3 - 1.0).abs() < 1e-3, "{slip} m");
        assert!((fracture / 500.0 - 1.0).abs() < 1e-3, "{fracture} J/m²");
    }
}

/// It slides on a plane of 30°, of which 0.3 m are a bridge of 60° and 0.5 MPa.
fn bridged_box(size: f64, angle: f64) -> String {
    let domain = "outline = [[-1, -0.1], [2, -0.1], [2, 0], [1, 0], [1, 0.002], [0, 0.002], [0, 0], [-1, 0]]\n\
                  joint_law = \"joint\"";
    let joints = "[[joint]]\npoints = [[0, 0], [0.43, 0]]\n[[joint]]\npoints = [[0.73, 0], [1, 0]]\n[[bridge]]\n\
                  points = [[0.43, 0], [0.73, 0]]\nlaw = \"rock\"\n[joint_law.joint]\nfriction_deg = 30\n\
                  normal_stiffness = 1e11\nshear_stiffness = 1e12\n[joint_law.rock]\nfriction_deg = 60\n\
                  residual_friction_deg = 30\ncohesion = 0.5e6\nresidual_cohesion = 0\ntension = 0.4e6\n\
                  tension_energy = 50\nshear_energy = 2000\n";
    slider(domain, [size, angle], joints)
}

/// Contacts whose faces lie partly on the bridge have its friction on that part alone: the strength is that of both
/// materials by length, σn·(k·tan 60° + (1 − k)·tan 30°) + k·c, on any mesh.
#[test]
fn a_joint_beside_a_bridge_keeps_its_own_friction() {
    let exact = 1e6 * (0.3 * 60f64.to_radians().tan() + 0.7 * 30f64.to_radians().tan()) + 0.3 * 0.5e6;
    for (size, angle) in [(0.31, 8.0), (0.2, 21.0), (0.1, 8.0), (0.1, 37.0)] {
        let mut simulation = simulation(&bridged_box(size, angle));
        let mut peak = 0.0f64;
        let holds = |simulation: &Simulation| simulation.state().bonds.iter().any(|bond| bond.lengths[1] > 0.0);
        while simulation.state().step == 0 || holds(&simulation) {
            advance(&mut simulation);
            peak = peak.max(forces(&simulation)[1].abs());
            assert!(simulation.time() < 0.05, "it holds: {:?}", simulation.state().bonds);
        }
        let broken = simulation.state().counters.broken;
        assert!((broken / 0.3 - 1.0).abs() < 0.02, "{broken} m of 0.3 m broken");
        (0..20).for_each(|_| advance(&mut simulation));
        let [normal, shear] = forces(&simulation);
        let residual = shear.abs() / (normal * 30f64.to_radians().tan());
        println!("h {size}, {angle}°: peak {:.5}, residual {residual:.8} of the exact one", peak / exact);
        assert!((peak / exact - 1.0).abs() < 5e-3, "h {size}, {angle}°: {peak} of {exact} N/m");
        assert!((residual - 1.0).abs() < 1e-3, "h {size}, {angle}°: {residual} of the residual friction");
    }
}

/// The same without energies of fracture.
fn brittle_box(size: f64, angle: f64) -> String {
    bridged_box(size, angle).replace("tension_energy = 50\nshear_energy = 2000\n", "")
}

/// A bridge without energies of fracture breaks at once, over the length that it is drawn with, and that is an event.
#[test]
fn a_brittle_bridge_is_as_long_as_it_is_drawn_on_any_mesh() {
    let most = 1e6 * (0.3 * 60f64.to_radians().tan() + 0.7 * 30f64.to_radians().tan()) + 0.3 * 0.5e6;
    for (size, angle) in [(0.6, 8.0), (0.31, 8.0), (0.2, 21.0), (0.1, 37.0)] {
        let text = brittle_box(size, angle);
        let mut simulation = simulation(&text);
        let (mut peak, mut broken) = (0.0f64, 0.0);
        while broken < 0.29 {
            advance(&mut simulation);
            peak = peak.max(forces(&simulation)[1].abs());
            broken = simulation.state().counters.broken;
            assert!(simulation.time() < 0.05, "{broken} m are broken of {:?}", simulation.state().bonds);
        }
        println!("h {size}, {angle}°: peak {:.5} of the greatest, {broken:.4} m broken", peak / most);
        assert!(
            peak < 1.005 * most && peak > 1e6 * 30f64.to_radians().tan(),
            "h {size}, {angle}°: {peak} of {most} N/m"
        );
        assert!((broken / 0.3 - 1.0).abs() < 0.02, "{broken} m of 0.3 m broken");
        (0..20).for_each(|_| advance(&mut simulation));
        let events = simulation.state().events.list.iter();
        assert_eq!(events.filter(|event| event.kind == EventKind::Broken).count(), 1);
        let ledger = simulation.report().ledger;
        assert!(ledger.residual_relative().abs() < 1e-6, "{}", ledger.residual_relative());
    }
}

#[test]
fn a_stage_does_not_switch_the_law_of_a_bridge() {
    let told = refusal(&(brittle_box(0.2, 8.0) + "switch_law = [{ from = \"rock\", to = \"joint\" }]\n"));
    assert!(told.contains("stage[0].switch_law[0].from") && told.contains("the law of rock bridges"), "{told}");
}

#[test]
fn a_bridge_that_keeps_its_cohesion_is_warned_of() {
    let warned = |text: &str| simulation(text).built().warnings.join("\n");
    let text = brittle_box(0.2, 8.0);
    assert!(!warned(&text).contains("residual_cohesion"), "{}", warned(&text));
    let found = warned(&text.replace("residual_cohesion = 0\n", ""));
    assert!(found.contains("keep their cohesion of 5.000e5 Pa") && found.contains("`residual_cohesion`"), "{found}");
}

/// In a model with a bridge, joints elsewhere have their cohesion and tensile strength from the first step on.
#[test]
fn a_bridge_elsewhere_takes_no_strength_from_other_joints() {
    let text = |bridge: &str| {
        format!(
            "title = \"hanging block\"\n[domain]\noutline = [[0, 0], [4, 0], [4, 2], [0, 2]]\njoint_law = \"glue\"\n\
             [mesh]\nsize = 0.7\n[[joint]]\npoints = [[0, 1], [4, 1]]\n{bridge}[rock.rock]\ndensity = 2600\n\
             young = 1e9\npoisson = 0.25\n[joint_law.glue]\nfriction_deg = 30\ncohesion = 1e6\nresidual_cohesion = 0\n\
             tension = 1e6\n[joint_law.rock]\nfriction_deg = 45\ncohesion = 1e7\nresidual_cohesion = 0\ntension = 1e7\n\
             tension_energy = 1e3\nshear_energy = 1e6\n[in_situ]\nsxx = 0\nsyy = 5e4\nsxy = 2e4\n\
             [[fix]]\nblock = [1, 1.5]\n[[stage]]\nname = \"hang\"\nkind = \"static\"\nduration = 0.5\n"
        )
    };
    let bridge = "[[bridge]]\npoints = [[2, 1], [2, 2]]\nlaw = \"rock\"\n";
    for bridge in ["", bridge] {
        let mut simulation = simulation(&text(bridge));
        (0..200).for_each(|_| advance(&mut simulation));
        let lost = simulation.state().contacts.iter().filter(|contact| !contact.intact).count();
        assert!(lost == 0 && !simulation.state().contacts.is_empty(), "{lost} contacts lost their strength");
    }
}

/// A state in the middle of a failure, taken back or read from its bytes, goes on to the same bits.
#[test]
fn a_failure_goes_on_to_the_same_bits_after_rollback_and_from_a_checkpoint() {
    let text = bar(0.025, 0.03, 1.5);
    let mut simulation = simulation(&text);
    let most = |simulation: &Simulation| simulation.state().bonds.iter().map(|bond| bond.damage).fold(0.0, f64::max);
    while most(&simulation) < 0.5 {
        advance(&mut simulation);
    }
    let middle = simulation.state().clone();
    let run = |simulation: &mut Simulation| {
        (0..600).for_each(|_| advance(simulation));
        simulation.state().clone()
    };
    let first = run(&mut simulation);
    assert!(first.counters.broken > 0.0 && first.counters.broken <= 0.1 + 1e-9, "{:?}", first.counters);
    simulation.return_to(&middle);
    assert_eq!(run(&mut simulation), first);
    let bytes = encode(Keeper::Model, &middle, "hash").expect("bytes");
    let read = decode(Keeper::Model, &bytes, "hash").expect("a state");
    let mut other = crate::common::simulation(&text);
    other.check(&read).expect("a state of this model");
    other.restore(read);
    assert_eq!(run(&mut other), first);
}

#[test]
fn laws_that_springs_or_mesh_cannot_follow_are_warned_of_with_the_length() {
    let warned = |text: &str| simulation(text).built().warnings.join("\n");
    // 2EG/σt² = 0.12 m, less 30 GPa over the stiffness of the joint.
    assert!(!warned(&bar(0.1, 0.2, 1.0)).contains("snap-back"), "{}", warned(&bar(0.1, 0.2, 1.0)));
    let found = warned(&bar(0.15, 0.2, 1.0));
    assert!(found.contains("snap-back") && found.contains("1.197e-1 m"), "{found}");
    let found = warned(&bar(0.1, 0.2, 1.0).replace("normal_stiffness = 1e14", "normal_stiffness = 1e11"));
    assert!(found.contains("above 2.500e11 Pa/m"), "{found}");
}

/// A10: an overhang of 1 m height under its weight, held by a bond at its root.
fn overhang(length: f64, size: f64) -> String {
    format!(
        "title = \"overhang\"\n[domain]\noutline = [[-1, 0], [{length}, 0], [{length}, 1], [-1, 1]]\n[mesh]\n\
         size = {size}\nangle_deg = 8\norigin = [0.0137, 0.0071]\n[[joint]]\npoints = [[0, 0], [0, 1]]\n\
         [rock.rock]\ndensity = 2600\nyoung = 30e9\npoisson = 0\n[joint_law.rock]\nfriction_deg = 45\n\
         cohesion = 15e6\nresidual_cohesion = 0\ntension = 1e6\ntension_energy = 1\nshear_energy = 1000\n\
         normal_stiffness = 1e12\nshear_stiffness = 1e12\n[[fix]]\nblock = [-0.5, 0.5]\n\
         [[stage]]\nname = \"weight\"\nkind = \"static\"\nduration = 3\n"
    )
}

/// The root bears 3ρgL²/h, and 1 MPa where L is 3.6151 m; 5 % of the load are 2.5 % of the length. Seven triangles over
/// the height find that; with five or three the root is too strong by 10 to 20 %, as elements of one strain bend too
/// little.
#[test]
fn an_overhang_breaks_at_the_length_that_its_strength_gives() {
    for (size, holds, breaks) in [(0.3, 1.0, 1.1), (0.2, 1.0, 1.1), (0.14, 0.975, 1.025)] {
        let broken = [holds, breaks].map(|share| {
            let mut simulation = simulation(&overhang(3.6151 * share, size));
            run_stage(&mut simulation);
            simulation.state().counters.broken
        });
        println!("h {size}: {broken:?} m broken");
        assert!(broken[0] == 0.0 && broken[1] > 0.8, "h {size}: {broken:?} m broken");
    }
}
