//! Claim: means of a record over a step are exact, jumps and rows included.

use enmm::internals::mechanics::Record;

/// A pulse of 2 m/s² from 1 to 3 s: an interval half outside has half of it, and all intervals sum to 4 m/s.
#[test]
fn the_mean_of_a_pulse_with_jumps_is_exact() {
    let pulse = Record(vec![[1.0, 2.0], [3.0, 2.0]]);
    let means = [(0.0, 1.0), (0.5, 1.5), (1.5, 2.5), (2.5, 3.5), (3.0, 4.0)].map(|(a, b)| pulse.mean(a, b));
    assert_eq!(means, [0.0, 1.0, 2.0, 1.0, 0.0]);
    let sum: f64 = (0..40).map(|k| 0.11 * pulse.mean(0.11 * f64::from(k), 0.11 * f64::from(k + 1))).sum();
    assert!((sum - 4.0).abs() < 1e-14);
}

/// A triangle of height 1 and base 2, over all of it and over one step that spans two rows.
#[test]
fn the_mean_goes_through_rows() {
    let triangle = Record(vec![[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]);
    assert!((triangle.mean(-1.0, 3.0) - 0.25).abs() < 1e-15);
    assert!((triangle.mean(0.5, 1.5) - 0.75).abs() < 1e-15);
    assert_eq!(Record::default().mean(0.0, 1.0), 0.0);
}

#[test]
fn a_velocity_keeps_its_last_value() {
    let velocity = Record(vec![[0.0, 0.0], [2.0, 3.0]]);
    assert_eq!(
        [(-1.0, 0.0), (0.0, 1.0), (1.0, 3.0), (3.0, 4.0)].map(|(a, b)| velocity.mean_rate(a, b)),
        [0.0, 1.5, 0.75, 0.0]
    );
}
