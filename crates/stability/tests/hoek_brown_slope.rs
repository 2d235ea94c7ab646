//! Slopes of rock masses by Hoek–Brown: the factor of a published one, bounds about it, and what limit analysis of
//! rigid blocks says to them.

use crate::common::case;
use crate::common::extent::by_extent;
use enmm::model::Case;
use enmm_stability::limit_analysis::bound;
use enmm_stability::limit_analysis::continuum::bracket;
use enmm_stability::strength_reduction::{ReductionOptions, factor_of_safety};

/// The slope of R. E. Hammah, T. E. Yacoub, B. C. Corkum and J. H. Curran (2005): 10 m high, 45°, 25 kN/m³, σci 30 MPa,
/// mi 2, GSI 5, D 0: 1.15 by strength reduction and by Bishop's method.
const PUBLISHED: f64 = 1.15;

/// The slope with so many elements over its height at a mesh angle (degrees), and the joints in it.
fn slope(rows: f64, angle: f64, joints: &str) -> Case {
    let text = format!(
        "title = \"slope\"\n[domain]\noutline = [[0, 0], [35, 0], [35, 5], [25, 5], [15, 15], [0, 15]]\n[mesh]\n\
         size = {:e}\nangle_deg = {angle:e}\n[rock.mass]\ndensity = {:e}\nyoung = 125e6\npoisson = 0.3\n\
         hoek_brown = {{ sigma_ci = 30e6, mi = 2, gsi = 5 }}\n{joints}[[fix]]\nedge = [[0, 0], [35, 0]]\n[[fix]]\n\
         edge = [[0, 0], [0, 15]]\naxes = \"x\"\n[[fix]]\nedge = [[35, 0], [35, 5]]\naxes = \"x\"\n[[stage]]\n\
         name = \"settle\"\nkind = \"static\"\nduration = 60\n",
        10.0 / rows,
        25e3 / 9.81
    );
    case(&text)
}

/// On elements of a tenth of the height: within 3 % of the published factor, below the upper bound and above the lower
/// one, as far as 0.5 % of the bracket and 1 % of the mesh leave open; the ledger closes.
#[test]
fn the_factor_of_a_slope_is_that_of_hammah_and_others() {
    for &(rows, angle) in
        by_extent([&[(10.0, 20.0)][..], &[(10.0, 20.0)], &[(10.0, 0.0), (10.0, 20.0), (10.0, 37.0), (20.0, 0.0)]])
    {
        let case = slope(rows, angle, "");
        let options = ReductionOptions { low: Some(1.1), high: Some(1.25), ..ReductionOptions::default() };
        let reduction = factor_of_safety(&case, &options, &mut |_, _| {}).unwrap_or_else(|e| panic!("{e}"));
        let factor = reduction.factor().expect("a factor");
        let found = reduction.bracket.as_ref().expect("bounds");
        let [lower, upper] = [found.lower.value(), found.upper.value()];
        println!("{rows} rows, {angle}°: {factor}, {lower} to {upper}");
        assert!(reduction.trials.iter().all(|t| t.ledger_residual.abs() < 1e-3));
        assert!((factor / PUBLISHED - 1.0).abs() < 0.03, "{rows} {angle}°: {factor}");
        assert!(factor > 0.99 * lower && factor < 1.01 * upper, "{rows} {angle}°: {factor}, {lower} to {upper}");
    }
}

/// A joint as strong as the rock changes nothing, and a weak layer takes the slope down: both bounds with it and the
/// factor between them, as far as 0.5 % of the bracket leaves open. The quick form has the bounds of the flat layer
/// alone, the full one the factor with it as well.
#[test]
fn long_a_weak_layer_in_the_rock_mass_takes_the_slope_down() {
    let layer =
        |law: &str, points: &str| format!("[joint_law.layer]\n{law}\n[[joint]]\nlaw = \"layer\"\npoints = {points}\n");
    let bounds = |case: &Case| {
        let found = bracket(case, 1000).unwrap_or_else(|e| panic!("{e}"));
        [found.lower.value(), found.upper.value()]
    };
    let whole = bounds(&slope(10.0, 20.0, ""));
    let strong = layer("friction_deg = 40\ncohesion = 2e5", "[[0, 9.2], [20.6, 9.4]]");
    let flat = layer("friction_deg = 15\ncohesion = 5e3", "[[0, 7], [23, 7]]");
    let steep = layer("friction_deg = 20\ncohesion = 5e3", "[[5, 15], [22, 8]]");
    let layers = [(&flat, true), (&strong, false), (&steep, true)];
    for (joints, is_weak) in layers.into_iter().take(by_extent([1, 3, 3])) {
        let case = slope(10.0, 20.0, joints);
        let [lower, upper] = bounds(&case);
        println!("{lower} to {upper}: {joints}");
        if is_weak {
            assert!(upper < whole[0], "{lower} to {upper}, whole {whole:?}");
        } else {
            let is_near = |bound: f64, whole: f64| (bound / whole - 1.0).abs() < 5e-3;
            assert!(is_near(lower, whole[0]) && is_near(upper, whole[1]), "{lower} to {upper}, whole {whole:?}");
        }
        let has_factor = by_extent([false, joints == &flat, true]);
        if has_factor {
            let options = ReductionOptions::default();
            let reduction = factor_of_safety(&case, &options, &mut |_, _| {}).unwrap_or_else(|e| panic!("{e}"));
            let factor = reduction.factor().expect("a factor");
            println!("factor {factor}");
            assert!(factor > 0.995 * lower && factor < 1.005 * upper, "{factor}, {lower} to {upper}");
        }
    }
}

/// The bounds hold the published factor, and lie a few per cent apart; rigid blocks are refused by the key.
#[test]
fn bounds_hold_the_published_factor() {
    let case = slope(10.0, 0.0, "");
    let found = bracket(&case, 1000).unwrap_or_else(|e| panic!("{e}"));
    let [lower, upper] = [found.lower.value(), found.upper.value()];
    println!("{lower} {upper}");
    assert!(lower <= PUBLISHED && PUBLISHED <= upper && upper / lower < 1.05, "{lower} to {upper}");
    let refused = bound(&case).unwrap_err().to_string();
    assert!(refused.contains("rock.mass.hoek_brown: is given, but limit analysis of rigid blocks"), "{refused}");
}
