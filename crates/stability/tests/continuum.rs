//! Limit analysis of rock that yields brackets what is known of slopes, footings and hanging rock, agrees with limit
//! analysis of rigid blocks where rock is strong, and refuses by name what it cannot treat.

use crate::common::extent::by_extent;
use crate::common::{case, example, simulation};
use crate::support::assert_refused;
use enmm_stability::limit_analysis::bound;
use enmm_stability::limit_analysis::continuum::{Bracket, bracket};

const STAGE: &str = "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20.0\n";
/// Density (kg/m³) of 20 kN/m³.
const DENSITY: f64 = 2e4 / 9.81;

fn of_text(text: &str, triangles: usize) -> Bracket {
    bracket(simulation(text).case(), triangles).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The exact factor lies in the bracket, and the bracket is narrow.
fn holds(found: &Bracket, exact: f64, gap: f64) {
    let [lower, upper] = [found.lower.value(), found.upper.value()];
    assert!(lower <= exact && exact <= upper, "{exact} is not between {lower} and {upper}");
    assert!(upper / lower - 1.0 <= gap, "{lower} to {upper}");
}

fn rock(strength: &str) -> String {
    format!("[rock.soil]\ndensity = {DENSITY}\nyoung = 1e8\npoisson = 0.3\n{strength}\n")
}

fn outline(points: &[[f64; 2]], size: f64) -> String {
    format!("title = \"t\"\n[domain]\noutline = {points:?}\n[mesh]\nsize = {size}\norigin = [0.031, 0.017]\n")
}

fn fixed(edge: [[f64; 2]; 2], axes: &str) -> String {
    format!("[[fix]]\nedge = {edge:?}\naxes = \"{axes}\"\n")
}

/// A cut 10 m high, or a slope from its toe to `crest` (m), on 10 m of the same ground.
fn cut(crest: f64, strength: &str, more: &str) -> String {
    let points = [[-10.0, -10.0], [20.0, -10.0], [20.0, 10.0], [crest, 10.0], [0.0, 0.0], [-10.0, 0.0]];
    outline(&points, 2.0)
        + &rock(strength)
        + &fixed([points[0], points[1]], "xy")
        + &fixed([points[1], points[2]], "x")
        + &fixed([points[5], points[0]], "x")
        + more
        + STAGE
}

/// γH/c of a vertical cut without friction is 3.776 to 3.778 by the finest published bounds (Kammoun and others 2010).
#[test]
fn a_vertical_cut_without_friction_has_taylors_number() {
    let found = of_text(&cut(0.0, "cohesion = 50e3", ""), 2000);
    holds(&found, 3.776 * 50e3 / 2e5, 0.025);
    let moved: f64 = found.moving().map(|motion| motion.area).sum();
    assert!((40.0..200.0).contains(&moved), "{moved} m²");
    let down: f64 = found.moving().map(|motion| motion.mass * motion.velocity.y).sum();
    assert!(down < 0.0, "the mechanism falls: {down}");
}

/// Under still water the same cut has the weight under water, whatever lies above its crest.
#[test]
fn under_water_a_cut_weighs_less() {
    let water = "[water]\nlevel = 14.0\n";
    let found = of_text(&cut(0.0, "cohesion = 50e3", water), 2000);
    holds(&found, 3.776 * 50e3 / (1e5 * (2.0 - 0.981)), 0.025);
}

/// The first slope of Griffiths and Lane (1999): 26.57°, φ = 20°, c/γH = 0.05, 1.380 by Bishop and Morgenstern (1960).
fn griffiths_and_lane(more_strength: &str, more: &str) -> String {
    let points = [[0.0, 0.0], [32.0, 0.0], [32.0, 10.0], [20.0, 10.0]];
    outline(&points, 1.0)
        + &rock(&format!("friction_deg = 20.0\ncohesion = 10e3\n{more_strength}"))
        + &fixed([points[0], points[1]], "xy")
        + &fixed([points[1], points[2]], "x")
        + more
        + STAGE
}

#[test]
fn the_first_slope_of_griffiths_and_lane_has_its_factor() {
    let found = of_text(&griffiths_and_lane("", ""), 1000);
    holds(&found, 1.380, 0.02);
    let finer = of_text(&griffiths_and_lane("", ""), 2000);
    holds(&finer, 1.380, 0.012);
    assert!(finer.triangles.iter().all(|&count| (1500..=2000).contains(&count)), "{:?}", finer.triangles);
    assert_eq!(of_text(&griffiths_and_lane("", ""), 1000), found, "the same bits");
}

/// Neither the dilation nor the stiffness of the rock enters.
#[test]
fn dilation_and_stiffness_change_nothing() {
    let own = of_text(&griffiths_and_lane("", ""), 300);
    let other = griffiths_and_lane("dilation_deg = 20.0", "").replace("young = 1e8", "young = 5e9");
    assert_eq!(of_text(&other, 300), own);
}

/// A strip of width B = 4 m under `pressure` on weightless ground.
fn footing(strength: &str, pressure: f64) -> String {
    let points = [[0.0, -8.0], [18.0, -8.0], [18.0, 0.0], [2.0, 0.0], [0.0, 0.0]];
    let load = format!("[[load]]\nkind = \"pressure\"\nedge = [[0.0, 0.0], [2.0, 0.0]]\npressure = {pressure}\n");
    outline(&points, 1.0)
        + "[gravity]\ny = 0.0\n"
        + &rock(strength)
        + &fixed([points[0], points[1]], "xy")
        + &fixed([points[1], points[2]], "xy")
        + &fixed([points[4], points[0]], "x")
        + &load
        + STAGE
}

/// Prandtl (1920): (2 + π)·c without friction; Reissner (1924): cot φ·(exp(π·tan φ)·tan²(45° + φ/2) − 1)·c with it.
#[test]
fn a_footing_bears_what_prandtl_found() {
    let c = 1e5;
    let pressure = (2.0 + std::f64::consts::PI) * c / 1.25;
    holds(&of_text(&footing("cohesion = 1e5", pressure), 2000), 1.25, 0.05);
}

#[test]
fn a_footing_on_soil_with_friction_bears_what_reissner_found() {
    let c = 1e5;
    let (tangent, passive) = (20f64.to_radians().tan(), 55f64.to_radians().tan().powi(2));
    let pressure = ((std::f64::consts::PI * tangent).exp() * passive - 1.0) / tangent * c;
    holds(&of_text(&footing("cohesion = 1e5\nfriction_deg = 20.0", pressure), 2000), 1.0, 0.065);
}

/// Rock 10 m high that hangs from above by its tensile strength: F = σt/γH; without a cut-off the apex c·cot φ counts.
#[test]
fn hanging_rock_has_its_tensile_strength() {
    let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 10.0], [0.0, 10.0]];
    let hung = |strength: &str| outline(&points, 1.0) + &rock(strength) + &fixed([points[2], points[3]], "xy") + STAGE;
    let cut_off = of_text(&hung("friction_deg = 30.0\ncohesion = 1e6\ntension = 3e5"), 400);
    holds(&cut_off, 1.5, 0.04);
}

/// A joint as strong as the rock, and a border between two rocks that are the same, change nothing but the mesh.
#[test]
fn a_joint_as_strong_as_the_rock_and_a_border_within_it_change_nothing() {
    let joint = "[[joint]]\npoints = [[-0.5, -0.5], [12.0, 12.0]]\n[joint_law.joint]\nfriction_deg = 0.0\n\
                 cohesion = 50e3\ntension = 1e7\n";
    let border = "[rock.other]\ndensity = 2038.7359836901123\nyoung = 1e8\npoisson = 0.3\ncohesion = 50e3\n\
                  region = [[-10, -10], [20, -10], [20, 3], [-2, 5]]\n";
    for more in [joint, border].into_iter().take(by_extent([1, 2, 2])) {
        holds(&of_text(&cut(0.0, "cohesion = 50e3", more), 2000), 3.776 * 50e3 / 2e5, 0.05);
    }
}

/// A weak band under strong rock: the rock above slides off on it, held by friction alone.
#[test]
fn rock_slides_on_a_weak_joint_as_a_block_does() {
    let points = [[0.0, 0.0], [20.0, 0.0], [20.0, 12.0], [0.0, 2.0]];
    let slope = |strength: &str| {
        outline(&points, 1.0)
            + &rock(strength)
            + "[[joint]]\npoints = [[-1.0, 0.5], [21.0, 11.5]]\n[joint_law.joint]\nfriction_deg = 30.0\n"
            + &fixed([points[0], points[1]], "xy")
            + STAGE
    };
    // A plate of uniform thickness on a plane of 26.57°.
    let exact = 30f64.to_radians().tan() / 0.5;
    holds(&of_text(&slope("cohesion = 1e6\nfriction_deg = 40.0"), 600), exact, 0.02);
}

/// Rock that is as good as rigid: the upper bound is that of rigid blocks, with water and bolts.
#[test]
fn strong_rock_has_the_bound_of_rigid_blocks() {
    for name in ["plane_slide", "block_on_incline"] {
        let mut case = case(&example(name));
        let blocks = bound(&case).expect("a bound").associated.factor.value();
        for rock in case.rocks.values_mut() {
            (rock.cohesion, rock.friction_deg) = (Some(1e9), Some(45.0));
        }
        let found = bracket(&case, 600).expect("a bracket");
        let upper = found.upper.value();
        assert!((upper / blocks - 1.0).abs() < 4e-4, "{name}: {upper} instead of {blocks}");
        holds(&found, blocks, 0.02);
    }
}

#[test]
fn without_a_limit_the_factor_is_beyond_the_range() {
    // A pile that friction holds at any factor of the range.
    let points = [[0.0, 0.0], [10.0, 0.0], [10.0, 1.0], [0.0, 1.0]];
    let flat = outline(&points, 1.0)
        + &rock("friction_deg = 30.0\ncohesion = 1e9")
        + &fixed([points[0], points[1]], "xy")
        + STAGE;
    let found = of_text(&flat, 100);
    assert_eq!((found.lower.value(), found.upper.value()), (f64::INFINITY, f64::INFINITY), "{found:?}");
    assert!(found.mechanism.is_empty() && found.warnings.is_empty(), "{found:?}");
    let without_weight = flat.replace("[mesh]", "[gravity]\ny = 0.0\n[mesh]");
    assert_eq!(of_text(&without_weight, 100).lower.value(), f64::INFINITY);
}

#[test]
fn bounds_that_are_far_apart_ask_for_more_triangles() {
    let found = of_text(&griffiths_and_lane("", ""), 60);
    holds(&found, 1.380, 0.3);
    assert!(found.warnings.iter().any(|warning| warning.contains("--triangles")), "{:?}", found.warnings);
}

#[test]
fn what_rock_that_yields_cannot_bear_is_refused_by_its_key() {
    let slope = |more: &str| griffiths_and_lane("", more);
    let refusals = [
        (slope("[[load]]\nkind = \"point\"\npoint = [25.0, 9.5]\nforce = [0.0, -1e4]\n"), "load[0].kind"),
        (slope("[[fix]]\npoint = [25.0, 5.0]\n"), "fix[2].point"),
        (slope("[[fix]]\nbox = [30.0, 0.0, 32.0, 10.0]\n"), "fix[2].box"),
        (slope("[[fix]]\nblock = [25.0, 5.0]\naxes = \"x\"\n"), "fix[2].axes"),
        (griffiths_and_lane("plane = \"stress\"", ""), "rock.soil.plane"),
        (slope("[[port]]\nname = \"face\"\nboundary = [[20, 10], [32, 10]]\npressure = 1e4\n"), "port[0]"),
    ];
    for (text, key) in refusals {
        assert_refused(bracket(&case(&text), 100), key);
    }
}
