//! Claim D3, Barton–Bandis: τ = σn·tan(φr + JRC·log10(JCS/σn)) and hyperbolic closure, with a closed energy ledger, the
//! strength factor on it, and errors for keys that do not belong to it.

use crate::common::claims::{advance, assert_ledger, block_at};
use crate::common::{refusal, simulation};
use enmm::geometry::Vector;
use enmm::internals::contact::Closure;
use enmm::model::Simulation;

const LENGTH: f64 = 1.2;
const STIFFNESS: f64 = 2e9;
const CLOSURE: f64 = 1e-3;

/// A block of 1.2 m × 0.6 m on a held base under a pressure (Pa) on its top, no gravity; the pressure follows `table`,
/// and a host pushes the block to the right.
fn press(pressure: f64, table: &str, law: &str) -> Simulation {
    simulation(&format!(
        "title = \"press\"\n[domain]\n\
         outline = [[-1, -0.6], [3, -0.6], [3, 0], [1.2, 0], [1.2, 0.6], [0, 0.6], [0, 0], [-1, 0]]\n[mesh]\n\
         size = 0.35\norigin = [0.031, 0.017]\n[gravity]\ny = 0.0\n[[joint]]\npoints = [[0, 0], [1.2, 0]]\n\
         [rock.rock]\ndensity = 2700.0\nyoung = 5e10\npoisson = 0.2\n[joint_law.joint]\n{law}\n[[fix]]\n\
         block = [2.0, -0.3]\n[[load]]\nkind = \"pressure\"\nedge = [[0, 0.6], [1.2, 0.6]]\npressure = {pressure:?}\n\
         {table}\n[[stage]]\nname = \"press\"\nkind = \"static\"\nduration = 2.0\nramp = 0.0\n"
    ))
}

fn law() -> String {
    format!(
        "kind = \"barton_bandis\"\nfriction_deg = 28.0\njrc = 10.0\njcs = 1e8\nnormal_stiffness = {STIFFNESS:e}\n\
         shear_stiffness = 1e10\nclosure_max = {CLOSURE:e}"
    )
}

/// Mean closure of the joint and the sums of normal and shear forces.
fn joint(simulation: &Simulation) -> (f64, f64, f64) {
    let contacts = simulation.contacts();
    let length: f64 = contacts.iter().map(|c| c.length).sum();
    assert!((length / LENGTH - 1.0).abs() < 1e-3, "strains of some 1e-4: {length}");
    let mean =
        |of: &dyn Fn(&enmm::model::tables::VertexEdge) -> f64| contacts.iter().map(|c| of(c) * c.length).sum::<f64>();
    (mean(&|c| -c.gap) / length, contacts.iter().map(|c| c.history.normal_force).sum(), {
        contacts.iter().map(|c| c.history.shear_force).sum::<f64>().abs()
    })
}

/// Loading and unloading run along σn = kn·v/(1 − v/vmax). The block is 50 GPa stiff: a joint of 2 GPa/m under 8 MPa
/// closes evenly to some per mille; means are compared at rest, at 2e-3, and the ledger closes.
#[test]
fn closure_follows_the_hyperbola_both_ways() {
    let mut sim = press(
        8e6,
        "table = [[0, 0], [0.05, 0.5], [0.1, 0.5], [0.15, 1], [0.2, 1], [0.25, 0.05], [0.3, 0.05], [0.35, 0.5]]",
        &law(),
    );
    for (time, share) in [(0.1, 0.5), (0.2, 1.0), (0.3, 0.05), (0.4, 0.5)] {
        let steps = sim.steps_in(time - sim.time());
        let report = advance(&mut sim, steps);
        let (closure, normal, _) = joint(&sim);
        let stress = normal / LENGTH;
        let exact = stress / (STIFFNESS + stress / CLOSURE);
        println!("t {time}: σ {stress:e} of {:e}, v {closure:e} of {exact:e}", 8e6 * share);
        assert!((stress / (8e6 * share) - 1.0).abs() < 2e-3, "it is at rest: {stress} of {}", 8e6 * share);
        assert!((closure / exact - 1.0).abs() < 2e-3, "{closure:e} of {exact:e}");
        assert_ledger(&report);
    }
}

/// The largest shear force before the block moves is that of the law, for several normal stresses and strength factors.
/// The push acts along the joint, so that the pressure on it stays even to a few per cent, and with it the mean of a
/// law that bends little.
#[test]
fn shear_strength_is_that_of_the_law_and_follows_the_factor() {
    for (stress, factor) in [(1e6, 1.0), (0.1e6, 1.0), (5e6, 1.0), (1e6, 0.7)] {
        let rough = 28.0 + 10.0 * (1e8 / f64::max(stress, 1.0)).log10();
        let limit = factor * stress * rough.min(70.0).to_radians().tan() * LENGTH;
        let mut sim = press(stress, "table = [[0.0, 0.0], [0.05, 1.0]]", &law());
        let block = block_at(&sim, [0.61, 0.31]);
        sim.drive().to.strength_factor = factor;
        sim.drive().arrive();
        let steps = sim.steps_in(0.15);
        advance(&mut sim, steps);
        let steps = sim.steps_in(0.05);
        let mut shear = 0.0;
        for (share, slides) in [(0.5, false), (0.99, false), (1.01, true)] {
            sim.drive().to.block_force[block] = Vector::new(share * limit, 0.0);
            sim.drive().to.block_moment[block] = share * limit * 0.3;
            sim.drive().arrive();
            // While the block has slipped by a millimetre or so, and lies on the whole joint.
            advance(&mut sim, steps / 5);
            shear = joint(&sim).2;
            advance(&mut sim, steps - steps / 5);
            let before = sim.motion_of(block).displacement.x;
            let report = advance(&mut sim, steps);
            let moved = sim.motion_of(block).displacement.x - before;
            println!("σ {stress:e} F {factor} share {share}: moved {moved:e}, T {:e}", joint(&sim).2 / limit);
            assert_eq!(moved > 1e-6, slides, "σ {stress:e}, {share} of the limit: moved {moved:e}");
            assert_ledger(&report);
        }
        assert!((shear / limit - 1.0).abs() < 5e-3, "{shear} of {limit}");
    }
}

fn refused(law: &str) -> String {
    refusal(&format!(
        "title = \"t\"\n[domain]\noutline = [[0, 0], [1, 0], [1, 1]]\n[mesh]\nsize = 0.5\n[rock.r]\ndensity = \
        1.0\nyoung = \
         1e9\npoisson = 0.2\n[joint_law.j]\n{law}\n[[stage]]\nname = \"s\"\nkind = \"dynamic\"\nduration = 1.0\n"
    ))
}

#[test]
fn keys_of_the_other_kind_are_errors() {
    let rough = "kind = \"barton_bandis\"\nfriction_deg = 28.0\njrc = 10.0\njcs = 1e8\n";
    for (law, words) in [
        (format!("{rough}cohesion = 1e4"), "joint_law.j.cohesion: a law of kind barton_bandis has no such strength"),
        (format!("{rough}tension = 1e4"), "joint_law.j.tension"),
        (format!("{rough}residual_friction_deg = 20.0"), "joint_law.j.residual_friction_deg"),
        (format!("{rough}closure_max = 1e-3"), "needs `normal_stiffness`"),
        (format!("{rough}closure_max = 1e-3\nnormal_stiffness = 1e9\ndilation_deg = 3.0"), "joint_law.j.dilation_deg"),
        ("kind = \"barton_bandis\"\nfriction_deg = 28.0\njcs = 1e8".into(), "needs `jrc`"),
        ("kind = \"barton_bandis\"\nfriction_deg = 28.0\njrc = 8.0".into(), "needs `jcs`"),
        (rough.replace("28.0", "75.0"), "at most 70"),
        ("friction_deg = 28.0\njrc = 10.0".into(), "joint_law.j.jrc: a law of kind mohr_coulomb does not have it"),
        (
            format!(
                "{rough}[[stage]]\nname = \"a\"\nkind = \"dynamic\"\nduration = 1.0\n[[stage.law]]\nlaw = \
                \"j\"\ncohesion = 1.0"
            ),
            "a stage may change `friction_deg`",
        ),
    ] {
        let message = refused(&law);
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn force_closure_and_energy_belong_together() {
    let curve = Closure { stiffness: 2e9, most: 1e-4 };
    let force = |v: f64| 2e9 * v / (1.0 - v / 1e-4);
    let mut work = 0.0;
    for k in 0..9000 {
        let v = (f64::from(k) + 0.5) * 1e-8;
        work += force(v) * 1e-8;
        assert!((curve.under(force(v)) - v).abs() < 1e-17);
        assert!((curve.solve(v, 0.0) / force(v) - 1.0).abs() < 1e-12);
    }
    assert!((curve.energy(9e-5) / work - 1.0).abs() < 1e-6, "{} of {work}", curve.energy(9e-5));
    assert!((curve.energy(0.999e-7) / curve.energy(1.001e-7) - (0.999f64 / 1.001).powi(2)).abs() < 1e-5);
}

#[test]
fn the_solution_meets_its_equation_and_the_linear_limit() {
    let curve = Closure { stiffness: 2e9, most: 1e-4 };
    for (b, c) in [(5e-5, 1e-9), (5e-4, 1e-8), (3e-2, 1e-12), (1e-9, 1e-6), (3e-4, 1e-7)] {
        let n = curve.solve(b, c);
        assert!(n > 0.0 && (curve.under(n) + c * n - b).abs() < 1e-12 * b, "{b} {c} {n}");
    }
    let linear = Closure { stiffness: 2e9, most: f64::INFINITY };
    assert_eq!(linear.solve(1e-5, 1e-9), 2e4 / 3.0);
    assert_eq!(linear.under(2e4), 1e-5);
    let far = Closure { stiffness: 2e9, most: 1e6 };
    assert!((far.solve(1e-5, 1e-9) - 2e4 / 3.0).abs() < 1e-5);
    assert!(curve.solve(-1e-5, 1e-9) < 0.0);
}
