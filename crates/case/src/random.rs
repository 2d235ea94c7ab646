//! Random values of a case and the samples that `enmm sample` draws of them. Nothing of this acts on the model, so it
//! is not part of the fingerprint.

use serde::{Deserialize, Serialize};

/// Distribution of a random value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum RandomDistribution {
    /// Normal by `mean` and `sd`.
    Normal,
    /// Lognormal by its own `mean` and `sd`, not those of the logarithm.
    Lognormal,
    /// Uniform from `least` to `most`.
    Uniform,
    /// Triangular from `least` over its peak at `mode` to `most`.
    Triangular,
    /// Exponential by its `mean`.
    Exponential,
    /// Another seed for every sample: `first`, `first` + 1, …
    Seeds,
}

impl RandomDistribution {
    /// Name in a case file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::Lognormal => "lognormal",
            Self::Uniform => "uniform",
            Self::Triangular => "triangular",
            Self::Exponential => "exponential",
            Self::Seeds => "seeds",
        }
    }

    /// Parameters that it must have.
    pub fn parameters(self) -> &'static [&'static str] {
        match self {
            Self::Normal | Self::Lognormal => &["mean", "sd"],
            Self::Uniform => &["least", "most"],
            Self::Triangular => &["least", "mode", "most"],
            Self::Exponential => &["mean"],
            Self::Seeds => &[],
        }
    }
}

/// Variable of a distribution: the value, its tangent or its logarithm.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum RandomOf {
    /// The value of the key.
    #[default]
    Value,
    /// The tangent of the angle that the key has in degrees.
    Tangent,
    /// The decimal logarithm of the value of the key.
    Log10,
}

/// A random value of `enmm sample`, which takes the place of the value of a key.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RandomVariable {
    /// Key of the case, such as `joint_law.plane.friction_deg` or `joint_set[0].seed`.
    pub key: String,
    /// Kind of distribution.
    pub distribution: RandomDistribution,
    /// Variable of the distribution, with its parameters and bounds.
    #[serde(default)]
    pub of: RandomOf,
    /// Mean of a normal, lognormal or exponential distribution.
    #[serde(default)]
    pub mean: Option<f64>,
    /// Standard deviation of a normal or lognormal distribution.
    #[serde(default)]
    pub sd: Option<f64>,
    /// Least value of a uniform or triangular distribution.
    #[serde(default)]
    pub least: Option<f64>,
    /// Most frequent value of a triangular distribution.
    #[serde(default)]
    pub mode: Option<f64>,
    /// Greatest value of a uniform or triangular distribution.
    #[serde(default)]
    pub most: Option<f64>,
    /// Lower end at which the distribution is cut off and rescaled.
    #[serde(default)]
    pub low: Option<f64>,
    /// Upper end at which the distribution is cut off and rescaled.
    #[serde(default)]
    pub high: Option<f64>,
    /// First of the seeds, no more than 2⁶²; default: `1`.
    #[serde(default)]
    pub first: Option<u64>,
}

impl RandomVariable {
    /// Parameters and bounds by name.
    pub fn numbers(&self) -> [(&'static str, Option<f64>); 7] {
        [
            ("mean", self.mean),
            ("sd", self.sd),
            ("least", self.least),
            ("mode", self.mode),
            ("most", self.most),
            ("low", self.low),
            ("high", self.high),
        ]
    }
}

/// Correlation of the normal variables behind two random values (Gaussian copula).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RandomCorrelation {
    /// Keys of the two values.
    pub keys: [String; 2],
    /// Coefficient of correlation.
    #[cfg_attr(feature = "schema", schemars(example = 0.5))]
    pub value: f64,
}

/// How samples are drawn.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Sampling {
    /// Independent samples.
    #[default]
    MonteCarlo,
    /// Each value takes every one of as many equally probable intervals as there are samples once.
    LatinHypercube,
}

impl Sampling {
    /// Name in a case file.
    pub fn name(self) -> &'static str {
        match self {
            Self::MonteCarlo => "monte_carlo",
            Self::LatinHypercube => "latin_hypercube",
        }
    }
}

/// Result that is computed for a sample.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum EnsembleOutput {
    /// Factor of safety by strength reduction, as `enmm fos` finds it.
    #[default]
    FactorOfSafety,
    /// Bound of limit analysis where level tops pass, as `enmm bound` finds it.
    LevelTops,
    /// Bound of limit analysis with associated flow.
    Associated,
    /// Whether the factor of safety is below the limit: by its bound, and by trials where that leaves it open.
    Failure,
}

impl EnsembleOutput {
    /// Name in a case file.
    pub fn name(self) -> &'static str {
        match self {
            Self::FactorOfSafety => "factor_of_safety",
            Self::LevelTops => "level_tops",
            Self::Associated => "associated",
            Self::Failure => "failure",
        }
    }
}

/// How `enmm sample` draws the samples, and what it finds of each.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Ensemble {
    /// Number of samples.
    pub samples: u64,
    /// How samples are drawn.
    pub sampling: Sampling,
    /// Seed of the random numbers: another one gives other samples.
    pub seed: u64,
    /// Result that is computed for each sample.
    pub output: EnsembleOutput,
    /// A sample counts as a failure when its output is below this.
    pub limit: f64,
    /// Width of the 95 % interval of the probability of failure from which on no more samples are worked out; looked
    /// at after every 50 samples. Without it all samples are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interval: Option<f64>,
}

impl Default for Ensemble {
    fn default() -> Self {
        Self {
            samples: 100,
            sampling: Sampling::MonteCarlo,
            seed: 1,
            output: EnsembleOutput::FactorOfSafety,
            limit: 1.0,
            interval: None,
        }
    }
}
