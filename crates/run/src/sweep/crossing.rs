//! Values between which the slope of a sweep begins to fail: its factor passes the limit.

use enmm_ensemble::Value;

/// A place along a key at which the slope begins or ends to fail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Value of the second key, in a contour.
    pub at: Option<Value>,
    /// Neighbouring values of the first key, one on each side.
    pub between: [f64; 2],
    /// Value between them, on the straight line through both factors; none where one of them is a limit of the search
    /// alone, a sample between them has no answer, or the outputs are no factors.
    pub value: Option<f64>,
}

/// A sample along a key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Along {
    /// Value of the key.
    pub value: f64,
    /// Whether the slope fails; none without an answer.
    pub fails: Option<bool>,
    /// Its factor, if that is no limit of the search.
    pub factor: Option<f64>,
}

/// Crossings along samples in ascending order of the key.
pub fn crossings(samples: &[Along], limit: f64, at: Option<Value>) -> Vec<Crossing> {
    let known: Vec<(usize, bool)> = (0..samples.len()).filter_map(|k| Some((k, samples[k].fails?))).collect();
    let mut found = Vec::new();
    for pair in known.windows(2) {
        let [(i, before), (j, after)] = [pair[0], pair[1]];
        if before == after {
            continue;
        }
        let (low, high) = (samples[i].value, samples[j].value);
        let factors = samples[i].factor.zip(samples[j].factor).filter(|_| j == i + 1);
        let value = factors.map(|(before, after)| low + (high - low) * (limit - before) / (after - before));
        found.push(Crossing { at, between: [low, high], value });
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along(factors: &[f64]) -> Vec<Along> {
        let sample = |(k, &factor): (usize, &f64)| Along {
            value: k as f64,
            fails: factor.is_finite().then_some(factor < 1.0),
            factor: Some(factor).filter(|factor| *factor < 100.0),
        };
        factors.iter().enumerate().map(sample).collect()
    }

    fn values(factors: &[f64]) -> Vec<(f64, Option<f64>)> {
        crossings(&along(factors), 1.0, None).iter().map(|crossing| (crossing.between[0], crossing.value)).collect()
    }

    #[test]
    fn every_crossing_is_found_once() {
        assert_eq!(values(&[0.5, 0.75, 1.25, 2.0]), [(1.0, Some(1.5))]);
        assert_eq!(values(&[2.0, 1.0, 0.5, 1.5]), [(1.0, Some(1.0)), (2.0, Some(2.5))]);
        assert_eq!(values(&[0.5, 1.0, 1.0, 2.0]), [(0.0, Some(1.0))]);
        assert_eq!(values(&[1.5, 1.0]), []);
    }

    #[test]
    fn no_value_is_made_up_between_limits_or_over_gaps() {
        assert_eq!(values(&[0.5, 100.0]), [(0.0, None)]);
        assert_eq!(values(&[0.5, f64::NAN, 1.5]), [(0.0, None)]);
    }
}
