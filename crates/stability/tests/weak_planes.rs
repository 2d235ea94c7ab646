//! Slopes of rock that is weaker along one direction: the factor of a layer that slides along it, by hand.

use crate::common::case;
use enmm_stability::limit_analysis::continuum::bracket;
use enmm_stability::strength_reduction::{ReductionOptions, factor_of_safety};

/// A layer on a rough base in gravity that is turned by `dip` (degrees), with planes along it: its base is fixed, its
/// ends are free.
fn layer(dip: f64, friction: f64, cohesion: f64) -> enmm::model::Case {
    let (sin, cos) = dip.to_radians().sin_cos();
    case(&format!(
        "title = \"layer\"\n[domain]\noutline = [[0, 0], [24, 0], [24, 6], [0, 6]]\n[mesh]\nsize = 1.0\n\
         [gravity]\nx = {}\ny = {}\n[rock.slate]\ndensity = 2500\nyoung = 1e8\npoisson = 0.25\n\
         friction_deg = 45\ncohesion = 1e6\n[rock.slate.plane_of_weakness]\nangle_deg = 0\n\
         friction_deg = {friction}\ncohesion = {cohesion}\n[[fix]]\nedge = [[0, 0], [24, 0]]\n[[stage]]\n\
         name = \"settle\"\nkind = \"static\"\nduration = 60\n",
        9.81 * sin,
        -9.81 * cos
    ))
}

/// F = tan φ/tan β + c/(γ·z·sin β) with the mass of the layer above its lowest elements, 0.87 m high, of which the
/// layer above their middle slides: within 3 %, of which the bracket leaves 1 % open. Limit analysis refuses such rock
/// by name.
#[test]
fn long_a_layer_slides_along_its_planes() {
    let (dip, friction, cohesion) = (22.0f64, 25.0f64, 12e3);
    let case = layer(dip, friction, cohesion);
    let depth = 6.0 - 0.5 * 0.75f64.sqrt();
    let (friction, beta) = (friction.to_radians(), dip.to_radians());
    let exact = friction.tan() / beta.tan() + cohesion / (2500.0 * 9.81 * depth * beta.sin());
    let options = ReductionOptions { low: Some(1.2), high: Some(1.6), ..ReductionOptions::default() };
    let reduction = factor_of_safety(&case, &options, &mut |_, _| {}).unwrap_or_else(|e| panic!("{e}"));
    let factor = reduction.factor().expect("a factor");
    println!("{factor} against {exact}");
    assert!((factor / exact - 1.0).abs() < 0.03, "{factor} against {exact}");
    let refused = bracket(&case, 500).expect_err("no bounds").to_string();
    assert!(refused.contains("rock.slate.plane_of_weakness"), "{refused}");
}
