//! Rock bridges that break: Jennings' factor (A11), a face that a bridge holds, and brittle bridges beside ductile ones.

use std::path::Path;

use enmm::model::{Case, Simulation};
use enmm_stability::limit_analysis::bound;
use enmm_stability::strength_reduction::{ReductionOptions, factor_of_safety};

fn case(text: &str) -> Case {
    enmm_io::parse_case(text, "case.toml", Path::new("")).unwrap_or_else(|e| panic!("{e}")).case
}

/// A11: a block of 1 MN/m on a plane of 10 m at 40°, of which the share `k` is rock of 1 MPa; φ is 30° all along.
/// Gravity is turned instead of the plane.
fn jennings(k: f64, size: f64, energies: &str) -> String {
    let (sin, cos) = 40f64.to_radians().sin_cos();
    let height = 1e6 / (10.0 * 2600.0 * 9.81);
    let (from, to) = (5.0 - 5.0 * k, 5.0 + 5.0 * k);
    format!(
        "title = \"Jennings\"\n[domain]\noutline = [[-4, -2], [14, -2], [14, 0], [10, 0], [10, {height}], \
         [0, {height}], [0, 0], [-4, 0]]\njoint_law = \"joint\"\n[mesh]\nsize = {size}\nangle_deg = 8\n\
         [[joint]]\npoints = [[0, 0], [{from}, 0]]\n[[joint]]\npoints = [[{to}, 0], [10, 0]]\n\
         [[bridge]]\npoints = [[{from}, 0], [{to}, 0]]\nlaw = \"rock\"\n\
         [rock.rock]\ndensity = 2600\nyoung = 30e9\npoisson = 0.25\n[joint_law.joint]\nfriction_deg = 30\n\
         [joint_law.rock]\nfriction_deg = 30\ncohesion = 1e6\nresidual_cohesion = 0\ntension = 0.5e6\n{energies}\n\
         [gravity]\nx = {x}\ny = {y}\n[[fix]]\nblock = [5, -1]\n\
         [[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 5\n",
        x = 9.81 * sin,
        y = -9.81 * cos,
    )
}

const DUCTILE: &str = "tension_energy = 1000\nshear_energy = 20e3";

fn exact(k: f64) -> f64 {
    0.688059 + 15.5572 * k
}

#[test]
fn a_bridge_gives_the_factor_of_jennings() {
    for (k, size) in [(0.03, 1.0), (0.06, 1.4), (0.06, 0.7)] {
        let case = case(&jennings(k, size, DUCTILE));
        let bound = bound(&case).expect("a bound").level_tops.factor.value();
        let found = factor_of_safety(&case, &ReductionOptions::default(), &mut |_, _| ()).expect("a factor");
        println!("k {k}, h {size}: fos {:?}, bound {bound}, exact {}", found.factor(), exact(k));
        assert!((bound / exact(k) - 1.0).abs() < 5e-3, "{bound}");
    }
}

#[test]
fn probe() {
    let mut s = Simulation::new(case(&jennings(0.06, 1.0, DUCTILE))).expect("builds");
    println!("{:?} {:?}", s.built().notes, s.built().warnings);
    s.run_stage().expect("runs");
    println!("{:?}", s.state().counters);
}
