//! Rock bridges that break: Jennings' factor (A11), a face that a bridge holds, and brittle bridges beside ductile
//! ones.

use std::path::Path;

use enmm::model::Case;
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

fn factor(case: &Case) -> f64 {
    let found = factor_of_safety(case, &ReductionOptions::default(), &mut |_, _| ()).expect("a reduction");
    found.factor().expect("a factor")
}

#[test]
fn a_bridge_gives_the_factor_of_jennings_on_any_mesh_and_a_brittle_one_no_more() {
    for (k, size) in [(0.03, 1.0), (0.06, 1.4), (0.06, 0.7)] {
        let ductile = case(&jennings(k, size, DUCTILE));
        let bound = bound(&ductile).expect("a bound").level_tops.factor.value();
        let [found, brittle] = [&ductile, &case(&jennings(k, size, "shear_energy = 1"))].map(factor);
        println!("k {k}, h {size}: fos {found}, brittle {brittle}, bound {bound}, exact {}", exact(k));
        assert!((bound / exact(k) - 1.0).abs() < 1e-4, "{bound}");
        assert!((found / exact(k) - 1.0).abs() < 5e-3, "{found}");
        assert!(brittle <= found * 1.001, "{brittle} brittle, {found} ductile");
    }
}

/// The base case of a fault that almost daylights: with a bridge the bound rises with its width instead of jumping.
#[test]
fn a_bridge_at_the_end_of_a_fault_holds_by_its_width() {
    let slope = |inside: f64| {
        let face = 8f64.hypot(20.0);
        let (x, y) = (0.8 + inside * 20.0 / face, 2.0 - inside * 8.0 / face);
        format!(
            "title = \"t\"\n[domain]\noutline = [[-15, -8], [40, -8], [40, 20], [8, 20], [0, 0], [-15, 0]]\n\
             joint_law = \"joints\"\nbridge_law = \"rock\"\nextend_ends = 0\n[mesh]\nsize = 2.0\n\
             [[joint]]\npoints = [[{x:?}, {y:?}], [16.0, 11.49801]]\nlaw = \"fault\"\n\
             [[joint]]\npoints = [[16.0, 11.49801], [16.0, 20.0]]\n[rock.gneiss]\ndensity = 2650\nyoung = 20e9\n\
             poisson = 0.25\n[joint_law.joints]\nfriction_deg = 35\n[joint_law.fault]\nfriction_deg = 30\n\
             [joint_law.rock]\nfriction_deg = 30\ncohesion = 1e6\nresidual_cohesion = 0\ntension = 0.5e6\n{DUCTILE}\n\
             [[fix]]\nedge = [[-15, -8], [40, -8]]\n[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 10\n"
        )
    };
    let bounds = [1e-3, 0.03, 0.1, 0.3, 0.6]
        .map(|inside| bound(&case(&slope(inside))).expect("a bound").level_tops.factor.value());
    println!("{bounds:?}");
    assert!(bounds.is_sorted() && bounds[4] > 1.2 * bounds[0] && bounds[1] < 1.1 * bounds[0], "{bounds:?}");
}
