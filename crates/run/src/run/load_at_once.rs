//! How a model comes to rest under loads that act from the start of a static stage.
//!
//! One mode of frequency ω with the displacement u and its value at rest u_s: the loads in Eq. 12 give the damping
//! c = 2ω/√s with s = u/u_s, so that s'' + 2s'/√s + s = 1 over τ = ωt. This curve has no parameter. The forces out of
//! balance are the share 1 − s of the loads, and the slope of ln(1 − s) over ln τ gives τ at any moment, thus ω.

use std::sync::LazyLock;

/// Steps of the curve (τ).
const STEP: f64 = 0.02;
/// First point of the curve (τ): s is τ² times [`START`] there.
const FIRST: f64 = 0.2;
/// s/τ² for small τ: with s = aτ² the equation is 2a + 4√a = 1.
const START: f64 = 0.050_510_257_216_821_9;
/// Share of the loads out of balance at which the curve ends.
const LEAST: f64 = 1e-11;

/// The curve: τ, ln(1 − s), and −d ln(1 − s)/d ln τ, which grows.
static CURVE: LazyLock<Vec<[f64; 3]>> = LazyLock::new(|| {
    let rate = |[s, v]: [f64; 2]| [v, 1.0 - s - 2.0 * v / s.sqrt()];
    let along = |[s, v]: [f64; 2], step: f64, [a, b]: [f64; 2]| [s + step * a, v + step * b];
    let (mut tau, mut state) = (FIRST, [START * FIRST * FIRST, 2.0 * START * FIRST]);
    let mut curve = Vec::new();
    while 1.0 - state[0] > LEAST {
        curve.push([tau, libm::log(1.0 - state[0]), tau * state[1] / (1.0 - state[0])]);
        // Runge and Kutta, fourth order.
        let first = rate(state);
        let second = rate(along(state, 0.5 * STEP, first));
        let third = rate(along(state, 0.5 * STEP, second));
        let fourth = rate(along(state, STEP, third));
        let mean = [0, 1].map(|k| (first[k] + 2.0 * (second[k] + third[k]) + fourth[k]) / 6.0);
        (tau, state) = (tau + STEP, along(state, STEP, mean));
    }
    curve
});

/// Time (s) at which a ratio, of which the logarithm is `log` and falls by `slope` (1/s) at `time` (s), reaches a
/// target of which it is `log_target`; none beyond the curve.
pub fn rest_time(time: f64, log: f64, slope: f64, log_target: f64) -> Option<f64> {
    let now = CURVE.partition_point(|point| point[2] < -slope * time);
    let [tau, share, _] = CURVE.get(now)?;
    let wanted = share - (log - log_target);
    let end = CURVE[now..].iter().find(|point| point[1] <= wanted)?;
    Some(end[0] * time / tau)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// s'' + 2s' + s = 1 about s = 1: 1 − s falls as e^−τ, so that the slope over ln τ tends to τ.
    #[test]
    fn the_curve_begins_as_a_parabola_and_ends_as_a_critically_damped_motion() {
        let [first, last] = [CURVE[0], CURVE[CURVE.len() - 1]];
        assert!((first[1].exp() - (1.0 - START * FIRST * FIRST)).abs() < 1e-12, "{first:?}");
        assert!((2.0 * START + 4.0 * START.sqrt() - 1.0).abs() < 1e-12);
        assert!(last[0] > 25.0 && last[2] > 0.95 * last[0] && last[2] < last[0], "{last:?}");
        assert!(CURVE.windows(2).all(|pair| pair[1][2] > pair[0][2] && pair[1][1] < pair[0][1]));
    }

    /// A mode of 7 rad/s that begins with a third of the loads out of balance: from any point of its fall the end is
    /// found.
    #[test]
    fn the_end_is_found_from_any_point_of_the_fall() {
        let (omega, shift, log_target) = (7.0, (1.0_f64 / 3.0).ln(), 1e-6_f64.ln());
        let end = CURVE.iter().find(|point| point[1] + shift <= log_target).expect("it falls that far")[0] / omega;
        for [tau, log, steepness] in CURVE.iter().skip(40).step_by(40).take(10) {
            let time = tau / omega;
            let found = rest_time(time, log + shift, -steepness / time, log_target).expect("an end");
            assert!((found / end - 1.0).abs() < 0.02, "{found} {end}");
        }
        assert_eq!(rest_time(1.0, 0.0, -1e9, log_target), None);
    }
}
