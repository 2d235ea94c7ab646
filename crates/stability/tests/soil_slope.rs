//! Claim F: the factor of a slope in soil is that of D. V. Griffiths and P. A. Lane (Géotechnique 49, 1999, example 1:
//! 1.38 to 1.40), whatever the angle of the mesh and the stiffness of the soil. Triangles that lock give 1.6 and more.

use crate::common::case;
use crate::common::extent::by_extent;
use enmm::model::case::Case;
use enmm_stability::limit_analysis::continuum::bracket;
use enmm_stability::strength_reduction::{ReductionOptions, factor_of_safety};

/// Height (m) and unit weight (N/m³) of the slope.
const HEIGHT: f64 = 10.0;
const GAMMA: f64 = 20e3;

/// Factor of the slope on a mesh of so many elements over the height at an angle (degrees), with Young's modulus over
/// γH and a dilation angle (degrees), looked for from 1.3 on.
fn factor(mesh: [f64; 2], stiffness: f64, dilation: f64) -> f64 {
    let options = ReductionOptions { low: Some(1.3), high: Some(1.56), ..ReductionOptions::default() };
    factor_of(&slope(mesh, stiffness, dilation, (GAMMA, "")), &options)
}

/// The slope with its unit weight (N/m³) and water.
fn slope([rows, angle]: [f64; 2], stiffness: f64, dilation: f64, (weight, water): (f64, &str)) -> Case {
    let text = format!(
        "title = \"slope\"\n[domain]\noutline = [[0, 0], [32, 0], [12, 10], [0, 10]]\n[mesh]\nsize = {:e}\n\
         angle_deg = {angle:e}\n[rock.soil]\ndensity = {:e}\nyoung = {:e}\npoisson = 0.3\nfriction_deg = 20\n\
         dilation_deg = {dilation:e}\ncohesion = {:e}\n{water}[[fix]]\nedge = [[0, 0], [32, 0]]\n[[fix]]\n\
         edge = [[0, 0], [0, 10]]\naxes = \"x\"\n[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 60\n",
        HEIGHT / rows,
        weight / 9.81,
        stiffness * GAMMA * HEIGHT,
        0.05 * GAMMA * HEIGHT,
    );
    case(&text)
}

fn factor_of(case: &Case, options: &ReductionOptions) -> f64 {
    let reduction = factor_of_safety(case, options, &mut |_, _| {}).unwrap_or_else(|e| panic!("{e}"));
    assert!(reduction.trials.iter().all(|t| t.ledger_residual.abs() < 1e-3));
    reduction.factor().expect("a factor")
}

/// Elements of a tenth of the height: each factor within 3.5 %, their mean over mesh angles within 2 % and a half of
/// the bracket; rock that is ten times stiffer within 0.5 % of the softer one.
#[test]
fn the_factor_of_a_slope_in_soil_is_that_of_griffiths_and_lane() {
    let angles = by_extent([&[37.0][..], &[0.0, 37.0], &[0.0, 7.0, 20.0, 37.0, 52.0]]);
    let mut sum = 0.0;
    for &angle in angles {
        let factors = [500.0, 5000.0].map(|stiffness| factor([10.0, angle], stiffness, 0.0));
        println!("{angle}°: {factors:?}");
        assert!(factors.iter().all(|factor| (factor / 1.39 - 1.0).abs() < 0.035), "{angle}°: {factors:?}");
        assert!((factors[1] / factors[0] - 1.0).abs() < 0.005, "{angle}°: {factors:?}");
        sum += factors.iter().sum::<f64>();
    }
    let mean = 0.5 * sum / angles.len() as f64;
    assert!((mean / 1.39 - 1.0).abs() < 0.02 + 0.0025, "{mean}");
}

/// Water in and before the slope, which stands still at one level: its factors are those of Griffiths and Lane's
/// example 5 (1.85 where it is flooded, 1.3 at least, with three tenths of the height below water), and between two
/// bounds. A flooded slope is as stable as a dry one that weighs less by its buoyancy.
#[test]
fn the_factor_of_a_slope_below_water_is_that_of_griffiths_and_lane() {
    let wet = |level: &str| slope([10.0, 20.0], 500.0, 0.0, (GAMMA, &format!("[water]\nlevel = {level}\n")));
    let buoyant = slope([10.0, 20.0], 500.0, 0.0, (GAMMA - 9810.0, ""));
    let bounds = |case: &Case| {
        let found = bracket(case, 1000).unwrap_or_else(|e| panic!("{e}"));
        [found.lower.value(), found.upper.value()]
    };
    let light = bounds(&buoyant);
    let levels = [("12.0", 1.85, 1.78), ("3.0", 1.3, 1.25)];
    for (level, published, from) in levels.into_iter().take(by_extent([1, 2, 2])) {
        let (case, options) =
            (wet(level), ReductionOptions { low: Some(from), high: Some(from + 0.15), ..ReductionOptions::default() });
        let ([lower, upper], factor) = (bounds(&case), factor_of(&case, &options));
        println!("level {level} m: {factor}, {lower} to {upper}");
        assert!(lower > 0.975 * published && upper < 1.025 * published, "{level}: {lower} to {upper}");
        assert!(factor > 0.99 * lower && factor < 1.025 * upper, "{level}: {factor}, {lower} to {upper}");
        if level == "12.0" {
            let is_near = |bound: f64, light: f64| (bound / light - 1.0).abs() < 5e-3;
            assert!(is_near(lower, light[0]) && is_near(upper, light[1]), "{lower} to {upper}, dry {light:?}");
            let dry = factor_of(&buoyant, &options);
            assert!((factor / dry - 1.0).abs() < 0.015, "{factor}, dry {dry}");
        }
    }
}
