//! Joint sets have the spacing, dip and persistence of their keys.

use enmm::geometry::joint_set::*;
use enmm::geometry::polygon::contains;
use enmm::geometry::{GeometryError, Point};

const SET: JointSetParameters = JointSetParameters {
    dip: 0.3,
    dip_sd: 0.05,
    turn: Turn::Normal,
    spacing: 0.5,
    spacing_sd: 0.2,
    spacing_spread: Spread::Normal,
    trace_length: Some(3.0),
    trace_length_sd: 1.0,
    length_spread: Spread::Normal,
    gap: 0.4,
    seed: 11,
    origin: None,
};

fn points(list: &[[f64; 2]]) -> Vec<Point> {
    list.iter().map(|p| Point::new(p[0], p[1])).collect()
}

fn square() -> Vec<Point> {
    points(&[[0.0, 0.0], [50.0, 0.0], [50.0, 50.0], [0.0, 50.0]])
}

#[test]
fn same_seed_same_traces_and_another_seed_others() {
    assert_eq!(generate(&SET, &square()), generate(&SET, &square()));
    assert_ne!(generate(&SET, &square()), generate(&JointSetParameters { seed: 12, ..SET }, &square()));
}

#[test]
fn density_follows_spacing_length_and_gap() {
    // Length per area is (length/(length+gap))/spacing = 1.7647 per metre. About 100 lines of 50 m: the mean
    // spacing scatters by 0.2/sqrt(100) of 0.5, 4 %; so 10 % is 2.5 standard deviations, for one fixed seed.
    let traces = generate(&SET, &square()).unwrap();
    let length: f64 = traces.iter().map(|t| (t[1] - t[0]).norm()).sum();
    let density = length / 2500.0;
    assert!((density / 1.7647 - 1.0).abs() < 0.1, "{density}");
    let mean = traces.iter().map(|t| (t[1] - t[0]).y.atan2((t[1] - t[0]).x)).sum::<f64>() / traces.len() as f64;
    // 0.05/sqrt(1600) = 0.00125 rad: four standard deviations.
    assert!((mean - SET.dip).abs() < 0.005, "{mean}");
}

#[test]
fn traces_of_a_notched_region_stay_inside() {
    let region = points(&[[0.0, 0.0], [10.0, 0.0], [10.0, 8.0], [6.0, 8.0], [5.0, 2.0], [4.0, 8.0], [0.0, 8.0]]);
    let through =
        JointSetParameters { dip: 0.0, dip_sd: 0.0, spacing: 1.0, spacing_sd: 0.0, trace_length: None, ..SET };
    let traces = generate(&through, &region).unwrap();
    // Eight horizontal lines; the notch, from y = 2 upwards, cuts six of them in two.
    assert_eq!(traces.len(), 14);
    for [a, b] in generate(&SET, &region).unwrap().into_iter().chain(traces) {
        for k in 0..=10 {
            // Ends lie on the boundary up to round-off: look a little inwards.
            let p = a + (b - a) * (1e-9 + (1.0 - 2e-9) * f64::from(k) / 10.0);
            assert!(contains(&region, p), "{p}");
        }
    }
}

#[test]
fn parameters_out_of_range_are_named() {
    let name = |set: JointSetParameters| generate(&set, &square()).unwrap_err().to_string();
    assert!(name(JointSetParameters { spacing: 0.0, ..SET }).contains("spacing"));
    assert!(name(JointSetParameters { spacing_sd: f64::NAN, ..SET }).contains("spacing_sd"));
    assert!(name(JointSetParameters { trace_length: Some(-1.0), ..SET }).contains("trace_length"));
    assert!(name(JointSetParameters { gap: f64::INFINITY, ..SET }).contains("gap"));
    let tiny = JointSetParameters { spacing: 1e-9, spacing_sd: 0.0, ..SET };
    assert!(matches!(generate(&tiny, &square()), Err(GeometryError::TooManyTraces { .. })));
}
