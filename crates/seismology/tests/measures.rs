//! Peaks, intensity and duration.

use std::f64::consts::PI;

use enmm_seismology::{Accelerogram, Unusable};

use crate::{close, rectangle, sine};

const G: f64 = 9.80665;

/// v = a/ω (1 − cos ωt) and d = a/ω (t − sin ωt / ω).
#[test]
fn a_sine_has_the_peaks_and_the_intensity_of_its_integrals() {
    let (a, f, t) = (2.0, 1.25, 8.0);
    let omega = 2.0 * PI * f;
    let found = sine(a, f, t).measures(G);
    close(found.acceleration, a, 1e-4);
    close(found.velocity, 2.0 * a / omega, 1e-4);
    close(found.displacement, a / omega * t, 1e-4);
    close(found.arias, 0.25 * PI / G * a * a * t, 1e-4);
    // The squares are those of ten whole waves, of which 5 and 95 % lie half a wave from both ends.
    close(found.duration, 0.9 * t, 1e-3);
}

#[test]
fn peaks_between_points_are_found() {
    // From +1 to −1 m/s² and back, straight: the velocity peaks where it crosses 0, at 1 s.
    let motion = Accelerogram::new(vec![[0.0, 1.0], [2.0, -1.0], [4.0, 1.0]]).expect("an accelerogram");
    let found = motion.measures(G);
    close(found.velocity, 0.5, 1e-12);
    // Back at rest after 2 s at ∫ (t − t²/2) dt = 2 − 8/6, and then backwards to 0 at 4 s.
    close(found.displacement, 2.0 - 8.0 / 6.0, 1e-12);
}

#[test]
fn a_rectangle_has_nine_tenths_of_its_length() {
    let found = rectangle(-3.0, 0.5).measures(G);
    close(found.duration, 0.45, 1e-9);
    close(found.arias, 0.5 * PI / G * 9.0 * 0.5, 1e-12);
    close(found.velocity, 1.5, 1e-12);
    close(found.displacement, 0.5 * 3.0 * 0.25, 1e-12);
}

/// v = a/ω (1 − cos ωt), d = a/ω (t − sin ωt / ω), and on with the last velocity.
#[test]
fn the_motion_at_a_time_is_that_of_its_integrals() {
    let (a, f) = (2.0, 0.75);
    let omega = 2.0 * PI * f;
    let motion = sine(a, f, 1.0);
    for t in [0.0, 0.3335, 0.9, 1.0, 1.5] {
        let (during, after) = (f64::min(t, 1.0), f64::max(t - 1.0, 0.0));
        let velocity = a / omega * (1.0 - (omega * during).cos());
        let way = a / omega * (during - (omega * during).sin() / omega) + velocity * after;
        let [found_velocity, found_way] = motion.motion_at(t);
        assert!((found_velocity - velocity).abs() < 1e-5 && (found_way - way).abs() < 1e-5, "{t}");
    }
    assert_eq!(motion.motion_at(-1.0), [0.0; 2]);
}

#[test]
fn rest_has_no_measures() {
    let found = rectangle(0.0, 2.0).measures(G);
    assert_eq!([found.acceleration, found.velocity, found.displacement, found.arias, found.duration], [0.0; 5]);
}

#[test]
fn velocities_give_the_mean_accelerations_between_them() {
    let motion = Accelerogram::of_velocity(&[[0.0, 0.0], [1.0, 2.0], [3.0, 1.0]]).expect("an accelerogram");
    assert_eq!(motion.points(), [[0.5, 2.0], [2.0, -0.5]]);
    assert_eq!(Accelerogram::of_velocity(&[[0.0, 0.0], [1.0, 2.0]]), Err(Unusable::Rows(1)));
}

#[test]
fn rows_that_are_no_motion_are_refused() {
    assert_eq!(Accelerogram::new(vec![[0.0, 1.0]]), Err(Unusable::Rows(1)));
    assert_eq!(Accelerogram::new(vec![[0.0, 1.0], [0.0, 2.0]]), Err(Unusable::Row(1)));
    assert_eq!(Accelerogram::new(vec![[0.0, f64::NAN], [1.0, 2.0]]), Err(Unusable::Row(0)));
}
