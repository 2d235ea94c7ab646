//! Newmark's block under pulses and sines.

use std::f64::consts::PI;

use enmm_seismology::Accelerogram;

use crate::{close, rectangle, sine};

/// A (A − k) t² / (2 k), of which the part after the pulse is v² / (2 k).
#[test]
fn a_rectangular_pulse_moves_the_block_by_the_closed_form() {
    for (a, k, t) in [(3.0, 1.0, 0.5), (5.0, 4.9, 0.2), (2.0, 0.01, 1.0)] {
        let way = rectangle(a, t).sliding_block(k);
        close(way, a * (a - k) * t * t / (2.0 * k), 1e-12);
    }
    assert_eq!(rectangle(1.0, 1.0).sliding_block(1.0), 0.0, "no more than it bears");
    assert_eq!(rectangle(-5.0, 1.0).sliding_block(1.0), 0.0, "the other way");
}

/// A triangle to A at T and back to 0 at 2T: slides from kT/A on, and stops during the fall or after it.
#[test]
fn a_triangular_pulse_moves_the_block_by_its_integral() {
    let (a, k, t) = (4.0, 3.0, 1.0);
    let pulse = Accelerogram::new(vec![[0.0, 0.0], [t, a], [2.0 * t, 0.0]]).expect("an accelerogram");
    // Velocity τ² a / (2 T) for τ up to (1 − k/a) T, the same again, and then against it until it is used up.
    let rise = (1.0 - k / a) * t;
    let slope = a / t;
    let up = slope * rise.powi(3) / 6.0;
    let peak = 0.5 * slope * rise * rise;
    // From the peak: v = peak + s rise τ − s τ²/2, which is 0 at τ = rise (1 + √2).
    let stop = rise * (1.0 + 2f64.sqrt());
    assert!(stop < t);
    let down = peak * stop + 0.5 * slope * rise * stop * stop - slope * stop.powi(3) / 6.0;
    close(pulse.sliding_block(k), up + down, 1e-12);
}

/// While it slides v = A/ω (cos ωt₀ − cos ωt) − k (t − t₀), from sin ωt₀ = k/A to the next time at which it is 0.
#[test]
fn a_sine_moves_the_block_once_in_each_wave() {
    let (a, k, f) = (5.0f64, 2.0, 2.0);
    let omega = 2.0 * PI * f;
    let start = (k / a).asin() / omega;
    let speed = |t: f64| a / omega * ((omega * start).cos() - (omega * t).cos()) - k * (t - start);
    let (mut low, mut high) = (0.5 / f, start + 1.0 / f);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if speed(middle) > 0.0 { low = middle } else { high = middle }
    }
    let since = high - start;
    let way = a / omega * (omega * start).cos() * since
        - a / (omega * omega) * ((omega * high).sin() - (omega * start).sin())
        - 0.5 * k * since * since;
    close(sine(a, f, 5.0 / f).sliding_block(k), 5.0 * way, 1e-4);
}

#[test]
fn the_block_waits_for_the_yield_acceleration_within_a_piece() {
    // From −1 to 3 in 4 s: above 1 for the last second, to 1 m/s above it, and on after the end.
    let ramp = Accelerogram::new(vec![[0.0, -1.0], [4.0, 3.0]]).expect("an accelerogram");
    close(ramp.sliding_block(1.0), 8.0 / 6.0 + 0.5 * 2.0 * 2.0, 1e-12);
}
