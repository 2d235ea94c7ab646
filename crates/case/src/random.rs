//! Random values of a case and the samples that `enmm sample` draws of them. Nothing of this acts on the model, so it
//! is not part of the fingerprint.

use crate::keys::shared::SEED;
use crate::keys::unit::NUMBER;
use crate::keys::{Range, Rule, keys, words};

words! {
    /// Distribution of a random value.
    pub enum RandomDistribution {
        /// Normal by `mean` and `sd`.
        Normal = "normal",
        /// Lognormal by its own `mean` and `sd`, not those of the logarithm.
        Lognormal = "lognormal",
        /// Uniform from `least` to `most`.
        Uniform = "uniform",
        /// Triangular from `least` over its peak at `mode` to `most`.
        Triangular = "triangular",
        /// Exponential by its `mean`.
        Exponential = "exponential",
        /// Another seed for every sample: `first`, `first` + 1, …
        Seeds = "seeds",
    }
}

impl RandomDistribution {
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

words! {
    /// Variable of a distribution: the value, its tangent or its logarithm.
    #[derive(Default)]
    pub enum RandomOf {
        /// The value of the key.
        #[default]
        Value = "value",
        /// The tangent of the angle that the key has in degrees.
        Tangent = "tangent",
        /// The decimal logarithm of the value of the key.
        Log10 = "log10",
    }
}

/// Parameters of distributions: their magnitude is beyond that of any value of a case.
pub(crate) const PARAMETER: Rule = Range::within(1e20).of(NUMBER).hint("correct it");
/// Parameters that must be positive.
pub(crate) const POSITIVE: Rule = Range::above(0.0).to(1e20).of(NUMBER);
/// End of first seeds, 2⁶²: sums of them and the number of a sample are whole numbers of TOML.
const FIRST_END: f64 = (1_u64 << 62) as f64;

keys! {
    /// A random value of `enmm sample`, which takes the place of the value of a key.
    pub struct RandomVariable {
        /// Key of the case, such as `joint_law.plane.friction_deg` or `joint_set[0].seed`.
        pub key: String,
        /// Kind of distribution.
        pub distribution: RandomDistribution,
        /// Variable of the distribution, with its parameters and bounds.
        #[serde(default)]
        pub of: RandomOf,
        /// Mean of a normal, lognormal or exponential distribution.
        pub mean: Option<f64> => PARAMETER,
        /// Standard deviation of a normal or lognormal distribution.
        pub sd: Option<f64> => POSITIVE.hint("write a fixed value otherwise"),
        /// Least value of a uniform or triangular distribution.
        pub least: Option<f64> => PARAMETER,
        /// Most frequent value of a triangular distribution.
        pub mode: Option<f64> => PARAMETER,
        /// Greatest value of a uniform or triangular distribution.
        pub most: Option<f64> => PARAMETER,
        /// Lower end at which the distribution is cut off and rescaled.
        pub low: Option<f64> => PARAMETER,
        /// Upper end at which the distribution is cut off and rescaled.
        pub high: Option<f64> => PARAMETER,
        /// First of the seeds; default: `1`.
        pub first: Option<u64> => Range::from(0.0).below(FIRST_END).of(NUMBER).hint("1 is usual"),
    }
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

keys! {
    /// Correlation of the normal variables behind two random values (Gaussian copula).
    pub struct RandomCorrelation {
        /// Keys of the two values.
        pub keys: [String; 2],
        /// Coefficient of correlation.
        pub value: f64 => Range::above(-1.0).below(1.0).of(NUMBER).hint("0 is no correlation").example(0.5),
    }
}

words! {
    /// How samples are drawn.
    #[derive(Default)]
    pub enum Sampling {
        /// Independent samples.
        #[default]
        MonteCarlo = "monte_carlo",
        /// Each value takes every one of as many equally probable intervals as there are samples once.
        LatinHypercube = "latin_hypercube",
    }

    /// Result that is computed for a sample.
    #[derive(Default)]
    pub enum EnsembleOutput {
        /// Factor of safety by strength reduction, as `enmm fos` finds it.
        #[default]
        FactorOfSafety = "factor_of_safety",
        /// Bound of limit analysis where level tops pass, as `enmm bound` finds it.
        LevelTops = "level_tops",
        /// Bound of limit analysis with associated flow.
        Associated = "associated",
        /// Whether the factor of safety is below the limit: by its bound, and by trials where that leaves it open.
        Failure = "failure",
    }
}

keys! {
    /// How `enmm sample` draws the samples, and what it finds of each.
    pub default struct Ensemble {
        /// Number of samples.
        pub samples: u64 = 100 => Range::from(1.0).to(1e7).of(NUMBER).hint("100 to 1000 are usual"),
        /// How samples are drawn.
        pub sampling: Sampling,
        /// Seed of the random numbers: another one gives other samples.
        pub seed: u64 = 1 => SEED,
        /// Result that is computed for each sample.
        pub output: EnsembleOutput,
        /// A sample counts as a failure when its output is below this.
        pub limit: f64 = 1.0 => PARAMETER.hint("1 is the limit of a factor of safety"),
        /// Width of the 95 % interval of the probability of failure from which on no more samples are worked out;
        /// looked at after every 50 samples. Without it all samples are.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub interval: Option<f64> => Range::above(0.0).below(1.0).of(NUMBER).hint("0.05 is usual"),
    }
}
