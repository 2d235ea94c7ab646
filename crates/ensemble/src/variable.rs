//! Random values: from a probability to the value of a key.

use enmm_case::key::Key;
use enmm_case::{Invalid, RandomDistribution, RandomOf, RandomVariable};

use crate::normal;

/// Least share of a distribution that its bounds may leave.
const LEAST_SHARE: f64 = 1e-12;

/// A random value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Variable {
    /// A number.
    Continuous(Distribution),
    /// Another seed for every sample, from this one on.
    Seeds(u64),
}

impl Variable {
    /// The variable of row `i` of `[[random]]`.
    ///
    /// # Errors
    /// A parameter is missing, or the bounds leave hardly any of the distribution.
    pub fn of(row: &RandomVariable, i: usize) -> Result<Self, Invalid> {
        if row.distribution == RandomDistribution::Seeds {
            return Ok(Self::Seeds(row.first.unwrap_or(1)));
        }
        let key = Key::root().field("random").index(i);
        let numbers = row.numbers();
        let number = |name: &str| {
            let value = numbers.iter().find(|(other, _)| *other == name).and_then(|(_, value)| *value);
            value.ok_or_else(|| Invalid { key: key.field(name).to_string(), message: "is missing; add it".to_owned() })
        };
        let shape = match row.distribution {
            RandomDistribution::Normal | RandomDistribution::Seeds => {
                Shape::Normal { mean: number("mean")?, sd: number("sd")? }
            }
            RandomDistribution::Lognormal => {
                let (mean, sd) = (number("mean")?, number("sd")?);
                let ratio = sd / mean;
                let sd = (ratio * ratio).ln_1p().sqrt();
                Shape::Lognormal { mean: mean.ln() - 0.5 * (sd * sd), sd }
            }
            RandomDistribution::Uniform => Shape::Uniform { least: number("least")?, most: number("most")? },
            RandomDistribution::Triangular => {
                Shape::Triangular { least: number("least")?, mode: number("mode")?, most: number("most")? }
            }
            RandomDistribution::Exponential => Shape::Exponential { mean: number("mean")? },
        };
        let (low, high) = (row.low, row.high);
        let start = low.map_or(0.0, |low| shape.probability(low));
        let end = high.map_or(1.0, |high| shape.probability(high));
        let share = end - start;
        if share.is_nan() || share <= LEAST_SHARE {
            let name = if low.is_some() { "low" } else { "high" };
            let message = "hardly any value lies within the bounds; widen them".to_owned();
            return Err(Invalid { key: key.field(name).to_string(), message });
        }
        Ok(Self::Continuous(Distribution { shape, bounds: [low, high], ends: [start, end], of: row.of }))
    }
}

/// A continuous distribution, cut off at its bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distribution {
    shape: Shape,
    bounds: [Option<f64>; 2],
    /// Probabilities below the bounds, before the distribution is cut off.
    ends: [f64; 2],
    of: RandomOf,
}

impl Distribution {
    /// The value of the key below which the probability is `p`, within 0 and 1.
    pub fn value(&self, p: f64) -> f64 {
        let [start, end] = self.ends;
        let x = self.shape.quantile(start + p * (end - start));
        // Rounding alone may lead out of the bounds.
        let x = self.bounds[0].map_or(x, |low| if x > low { x } else { low });
        let x = self.bounds[1].map_or(x, |high| if x < high { x } else { high });
        match self.of {
            RandomOf::Value => x,
            RandomOf::Tangent => x.atan().to_degrees(),
            // The compiler would make `exp10` of a known base, whose last bit may differ from that of `pow`.
            RandomOf::Log10 => std::hint::black_box(10.0_f64).powf(x),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    Normal {
        mean: f64,
        sd: f64,
    },
    /// Mean and standard deviation of the logarithm.
    Lognormal {
        mean: f64,
        sd: f64,
    },
    Uniform {
        least: f64,
        most: f64,
    },
    Triangular {
        least: f64,
        mode: f64,
        most: f64,
    },
    Exponential {
        mean: f64,
    },
}

impl Shape {
    /// Probability of a value below `x`.
    fn probability(&self, x: f64) -> f64 {
        match *self {
            Self::Normal { mean, sd } => normal::probability((x - mean) / sd),
            Self::Lognormal { .. } if x <= 0.0 => 0.0,
            Self::Lognormal { mean, sd } => normal::probability((x.ln() - mean) / sd),
            Self::Uniform { least, most } => ((x - least) / (most - least)).clamp(0.0, 1.0),
            Self::Triangular { least, most, .. } if x <= least || x >= most => f64::from(x > least),
            Self::Triangular { least: a, mode: c, most: b } => {
                if x < c {
                    (x - a) * (x - a) / ((b - a) * (c - a))
                } else {
                    1.0 - (b - x) * (b - x) / ((b - a) * (b - c))
                }
            }
            Self::Exponential { mean } => -(-x.max(0.0) / mean).exp_m1(),
        }
    }

    /// The value below which the probability is `p`.
    fn quantile(&self, p: f64) -> f64 {
        match *self {
            Self::Normal { mean, sd } => mean + sd * normal::quantile(p),
            Self::Lognormal { mean, sd } => (mean + sd * normal::quantile(p)).exp(),
            Self::Uniform { least, most } => least + p * (most - least),
            Self::Triangular { least: a, mode: c, most: b } => {
                if p * (b - a) < c - a {
                    a + (p * (b - a) * (c - a)).sqrt()
                } else {
                    b - ((1.0 - p) * (b - a) * (b - c)).sqrt()
                }
            }
            Self::Exponential { mean } => -mean * (-p).ln_1p(),
        }
    }
}
