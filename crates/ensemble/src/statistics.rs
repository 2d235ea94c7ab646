//! Statistics of the outputs of all samples.

use crate::{normal, philox};

/// A confidence interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Score interval of a probability from `failures` of `n` independent samples (E. B. Wilson, J. Am. Stat. Assoc. 22,
/// 1927). It is close to its confidence also for few failures, and is never empty. `n` is at least 1.
pub fn wilson(failures: usize, n: usize, confidence: f64) -> Interval {
    let z = normal::quantile(0.5 + 0.5 * confidence);
    let (p, count) = (failures as f64 / n as f64, n as f64);
    let scale = 1.0 + z * z / count;
    let middle = (p + 0.5 * z * z / count) / scale;
    let half = z / scale * (p * (1.0 - p) / count + 0.25 * z * z / (count * count)).sqrt();
    Interval {
        low: if failures == 0 { 0.0 } else { middle - half },
        high: if failures == n { 1.0 } else { middle + half },
    }
}

/// Reliability index of a probability of failure, minus its normal quantile; infinite at 0 and 1.
pub fn beta(p: f64) -> f64 {
    if p <= 0.0 {
        f64::INFINITY
    } else if p >= 1.0 {
        f64::NEG_INFINITY
    } else {
        -normal::quantile(p)
    }
}

/// Mean; not a number without values.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Standard deviation of a sample, by n − 1; not a number with fewer than two values.
pub fn standard_deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    let sum: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    (sum / (values.len() as f64 - 1.0)).sqrt()
}

/// The value below which the share `p` of the values is, linear between two of them; not a number without values.
pub fn quantile(values: &[f64], p: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let place = p.clamp(0.0, 1.0) * last as f64;
    let k = place as usize;
    sorted[k] + (place - k as f64) * (sorted[(k + 1).min(last)] - sorted[k])
}

/// Spearman's rank correlation; none where a side has one value alone.
pub fn spearman(a: &[f64], b: &[f64]) -> Option<f64> {
    let [a, b] = [a, b].map(ranks);
    let (mean_a, mean_b) = (mean(&a), mean(&b));
    let [mut ab, mut aa, mut bb] = [0.0; 3];
    for (x, y) in a.iter().zip(&b) {
        let (x, y) = (x - mean_a, y - mean_b);
        ab += x * y;
        aa += x * x;
        bb += y * y;
    }
    (aa > 0.0 && bb > 0.0).then(|| ab / (aa * bb).sqrt())
}

/// Ranks from 1 on, equal values at the mean of theirs.
fn ranks(values: &[f64]) -> Vec<f64> {
    let places = philox::places(values, f64::total_cmp);
    let mut order = vec![0; values.len()];
    places.iter().enumerate().for_each(|(k, &place)| order[place] = k);
    let mut ranks = vec![0.0; values.len()];
    let mut place = 0;
    for equal in order.chunk_by(|&a, &b| values[a] == values[b]) {
        let middle = place as f64 + 0.5 * (equal.len() + 1) as f64;
        equal.iter().for_each(|&k| ranks[k] = middle);
        place += equal.len();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against scipy 1.17: `binomtest(10, 100).proportion_ci(0.95, "wilson")` and `spearmanr`.
    #[test]
    fn statistics_are_those_of_scipy() {
        let found = wilson(10, 100, 0.95);
        assert!((found.low - 0.055_229_137_060_675_08).abs() < 1e-12, "{found:?}");
        assert!((found.high - 0.174_365_661_504_913_45).abs() < 1e-12, "{found:?}");
        assert_eq!(wilson(0, 40, 0.95).low, 0.0);
        assert_eq!(wilson(40, 40, 0.95).high, 1.0);
        let found = spearman(&[1.0, 2.0, 2.0, 4.0, 5.0], &[5.0, 6.0, 7.0, 7.0, 1.0]);
        assert!(found.is_some_and(|rho| (rho - -0.131_578_947_368_421_04).abs() < 1e-12), "{found:?}");
        assert_eq!(spearman(&[1.0, 1.0], &[1.0, 2.0]), None);
        assert!((beta(0.110_006) - 1.226_496_211_804_097_4).abs() < 1e-12);
        assert_eq!(beta(0.0), f64::INFINITY);
    }

    #[test]
    fn quantiles_are_linear_between_values() {
        let values = [4.0, 1.0, 2.0, 3.0];
        assert_eq!([0.0, 0.5, 1.0, 0.1].map(|p| quantile(&values, p)), [1.0, 2.5, 4.0, 1.3]);
        assert!(quantile(&[], 0.5).is_nan());
    }
}
