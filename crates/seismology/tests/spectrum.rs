//! Response spectra against closed forms.

use std::f64::consts::PI;

use enmm_seismology::{Accelerogram, DAMPING, periods};

use crate::{close, rectangle, sine};

/// Without damping 2 sin(π t/T) A of a pulse shorter than half a period, else 2 A.
#[test]
fn a_rectangular_pulse_has_the_shock_spectrum() {
    let (a, t) = (3.0, 0.4);
    for period in [0.1, 0.37, 0.75, 1.0, 2.0, 5.0] {
        let exact = if t >= 0.5 * period { 2.0 * a } else { 2.0 * a * (PI * t / period).sin() };
        close(rectangle(a, t).spectrum(&[period], 0.0)[0], exact, 1e-6);
    }
}

/// 1 + exp(−πξ/√(1 − ξ²)) times a step.
#[test]
fn damping_lowers_the_overshoot_of_a_step() {
    let step = rectangle(2.0, 10.0);
    for damping in [0.05, 0.2, 0.5] {
        let exact = 2.0 * (1.0 + (-PI * damping / (1.0f64 - damping * damping).sqrt()).exp());
        close(step.spectrum(&[0.8], damping)[0], exact, 1e-6);
    }
}

/// With r = t/T: 4r cos(πr)/(1 − 4r²) of short pulses, and 2r/(2r − 1) sin(2π/(2r + 1)) of those with 1/2 < r < 3/2.
#[test]
fn a_half_sine_has_the_shock_spectrum() {
    let (a, t) = (2.0, 0.5);
    for r in [0.1, 0.3, 0.45, 0.6, 0.8, 1.0, 1.4] {
        let pulse = sine(a, 0.5 / t, t);
        let exact = if r < 0.5 {
            4.0 * r * (PI * r).cos() / (1.0 - 4.0 * r * r)
        } else {
            2.0 * r / (2.0 * r - 1.0) * (2.0 * PI / (2.0 * r + 1.0)).sin()
        };
        close(pulse.spectrum(&[t / r], 0.0)[0], a * exact, 1e-5);
    }
}

/// In the steady state 1/√((1 − β²)² + (2ξβ)²) times the amplitude.
#[test]
fn a_long_sine_has_the_harmonic_response() {
    let f = 2.0;
    let long = sine(1.0, f, 60.0);
    close(long.spectrum(&[1.0 / f], DAMPING)[0], 1.0 / (2.0 * DAMPING), 1e-4);
    // Far from resonance transients add to the steady state: a motion that grows and falls slowly has none.
    let rows = long.points().iter().map(|[t, v]| [*t, v * (t / 30.0).min(2.0 - t / 30.0)]).collect();
    let grown = Accelerogram::new(rows).expect("an accelerogram");
    for beta in [0.5, 0.8, 1.3] {
        let exact = 1.0 / ((1.0f64 - beta * beta).powi(2) + (2.0 * DAMPING * beta).powi(2)).sqrt();
        close(grown.spectrum(&[beta / f], DAMPING)[0], exact, 1e-2);
    }
}

/// A stiff oscillator goes with the ground; a soft one stays where it was, and moves against it by its displacement.
#[test]
fn the_ends_of_a_spectrum_are_the_peaks_of_the_ground() {
    let there_and_back: Vec<[f64; 2]> = [0.0, 1.0, -1.0, 0.0, 0.0].into_iter().enumerate().map(row).collect();
    let motion = Accelerogram::new(there_and_back).expect("an accelerogram");
    let peaks = motion.measures(9.81);
    let soft = 1000.0;
    close(motion.spectrum(&[soft], DAMPING)[0] * (soft / (2.0 * PI)).powi(2), peaks.displacement, 2e-2);
    close(sine(3.0, 1.0, 5.0).spectrum(&[0.02], DAMPING)[0], 3.0, 1e-2);
}

fn row((k, value): (usize, f64)) -> [f64; 2] {
    [0.25 * k as f64, value]
}

/// Points that say nothing new change nothing, so that uneven steps are taken well.
#[test]
fn more_points_on_the_same_lines_change_nothing() {
    let few = Accelerogram::new(vec![[0.0, 0.0], [0.3, 2.0], [1.0, -1.0]]).expect("an accelerogram");
    let at = |t: f64| if t <= 0.3 { 2.0 * t / 0.3 } else { 2.0 - 3.0 * (t - 0.3) / 0.7 };
    let times = [0.0, 0.01, 0.1, 0.17, 0.3, 0.31, 0.5, 0.77, 0.9, 1.0];
    let many = Accelerogram::new(times.map(|t| [t, at(t)]).to_vec()).expect("an accelerogram");
    for (a, b) in few.spectrum(&periods(0.0), DAMPING).iter().zip(many.spectrum(&periods(0.0), DAMPING)) {
        close(b, *a, 1e-6);
    }
}

#[test]
fn periods_lie_evenly_on_a_logarithmic_axis() {
    let all = periods(0.0);
    assert_eq!(all.len(), 109);
    assert!((all[0] - 0.02).abs() < 1e-15 && (all[108] - 10.0).abs() < 1e-12);
    assert!(all.windows(2).all(|two| (two[1] / two[0] - all[1] / all[0]).abs() < 1e-12));
    assert!(periods(0.1)[0] >= 0.1 && periods(0.1).len() == all.iter().filter(|p| **p >= 0.1).count());
}
