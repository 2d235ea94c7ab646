//! Measures of motions that have a closed form.

mod measures;
mod newmark;
mod spectrum;

use std::f64::consts::PI;

use enmm_seismology::Accelerogram;

/// A sine of an amplitude (m/s²) and a frequency (Hz), for a time (s), with points 1 ms apart.
fn sine(amplitude: f64, frequency: f64, time: f64) -> Accelerogram {
    let count = (time / 1e-3).round() as u32;
    let at = |k: u32| {
        let since = 1e-3 * f64::from(k);
        [since, amplitude * (2.0 * PI * frequency * since).sin()]
    };
    Accelerogram::new((0..=count).map(at).collect()).expect("an accelerogram")
}

/// A constant acceleration (m/s²) for a time (s).
fn rectangle(amplitude: f64, time: f64) -> Accelerogram {
    Accelerogram::new(vec![[0.0, amplitude], [time, amplitude]]).expect("an accelerogram")
}

#[track_caller]
fn close(found: f64, exact: f64, share: f64) {
    assert!((found - exact).abs() <= share * exact.abs(), "{found}, but {exact} in closed form");
}
