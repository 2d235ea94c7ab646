//! Kinematic checks against lines and cases that were computed by hand.

use enmm_stability::kinematics::{Joints, Limits, Line, Plane, failures};

fn plane(dip: f64, direction: f64) -> Plane {
    Plane { dip, direction }
}

fn sets(all: &[(f64, f64, f64)]) -> Vec<Joints> {
    let set = |(k, &(dip, direction, friction)): (usize, &(f64, f64, f64))| Joints {
        name: format!("J{}", k + 1),
        plane: plane(dip, direction),
        friction,
    };
    all.iter().enumerate().map(set).collect()
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-6
}

#[test]
fn lines_and_apparent_dips_are_those_of_formulas() {
    let pole = plane(30.0, 350.0).pole();
    assert_eq!(pole, Line { plunge: 60.0, trend: 170.0 });
    // tan(apparent) = tan(dip)·cos(off): 45° seen 60° off is atan(1/2).
    assert!(close(plane(45.0, 100.0).apparent_dip(160.0), 0.5f64.atan().to_degrees()));
    assert!(close(plane(45.0, 100.0).apparent_dip(280.0), -45.0));
    // Two planes of 45° towards east and north meet in the line towards north-east whose plunge is atan(1/√2).
    let line = plane(45.0, 90.0).meets(&plane(45.0, 0.0)).unwrap();
    assert!(close(line.trend, 45.0) && close(line.plunge, 0.5f64.sqrt().atan().to_degrees()), "{line:?}");
    assert_eq!(plane(30.0, 50.0).meets(&plane(30.0, 50.0)), None);
    let lines = plane(35.0, 120.0).lines(4);
    assert!(close(lines[2].plunge, 35.0) && close(lines[2].trend, 120.0) && close(lines[0].plunge, 0.0), "{lines:?}");
    assert!(lines.iter().all(|line| close(plane(35.0, 120.0).apparent_dip(line.trend), line.plunge)));
}

/// A face of 65° towards 120°. By hand:
/// - 40/125, φ 30: 40 > 30, 40 < 65·cos-corrected, 5° off: slides as a plane;
/// - 40/145, φ 30: 25° off: no plane within 20°, one within 30°;
/// - 70/120, φ 30: steeper than the face: none;
/// - 25/120, φ 30: flatter than its friction: none;
/// - 80/300, φ 30: (90 − 80) + 30 = 40 ≤ 65, strike parallel: topples; 50/300: 40 + 30 = 70 > 65: does not;
/// - 80/265, φ 30: 35° off: not within 30°.
#[test]
fn planes_and_layers_are_found_by_hand_computed_conditions() {
    let all = [
        (40.0, 125.0, 30.0),
        (40.0, 145.0, 30.0),
        (70.0, 120.0, 30.0),
        (25.0, 120.0, 30.0),
        (80.0, 300.0, 30.0),
        (50.0, 300.0, 30.0),
        (80.0, 265.0, 30.0),
    ];
    let face = plane(65.0, 120.0);
    let found = failures(&face, &sets(&all), Limits::default());
    assert_eq!((found.planes, found.toppling), (vec![0], vec![4]));
    let wide = failures(&face, &sets(&all), Limits { sliding: 30.0, toppling: 40.0 });
    assert_eq!((wide.planes, wide.toppling), (vec![0, 1], vec![4, 6]));
}

/// E. Hoek and J. Bray: planes 45/105 and 70/235 meet in the line 31.2/157.7, to be checked against a face 65/185. By
/// hand: normals n = (sin d sin a, sin d cos a, −cos d), their cross product gives the line; the face dips by
/// atan(tan 65°·cos 27.3°) = 62.3° there.
#[test]
fn a_wedge_is_found_by_its_line() {
    let all = [(45.0, 105.0, 20.0), (70.0, 235.0, 30.0)];
    let face = plane(65.0, 185.0);
    let found = failures(&face, &sets(&all), Limits::default());
    let (first, second, line) = found.wedges[0];
    assert_eq!((first, second, found.wedges.len()), (0, 1, 1));
    assert!((line.plunge - 31.2).abs() < 0.05 && (line.trend - 157.7).abs() < 0.1, "{line:?}");
    assert!((face.apparent_dip(line.trend) - 62.3).abs() < 0.05, "{}", face.apparent_dip(line.trend));
    // With 32° on both planes it is flatter than friction; in a face of 30° it does not come out.
    let rough = [(45.0, 105.0, 32.0), (70.0, 235.0, 32.0)];
    assert_eq!(failures(&face, &sets(&rough), Limits::default()).wedges, []);
    assert_eq!(failures(&plane(30.0, 185.0), &sets(&all), Limits::default()).wedges, []);
}
