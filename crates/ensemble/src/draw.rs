//! Samples: random numbers, Latin hypercube, correlation by a Gaussian copula.

use std::fmt;

use enmm_case::key::Key;
use enmm_case::{Case, Ensemble, Invalid, RandomCorrelation, RandomVariable, Sampling};

use crate::variable::{Distribution, Variable};
use crate::{normal, philox};

/// The value of a key in a sample. As text it is a value of TOML that reads back to the same bits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A whole number, such as a seed.
    Whole(u64),
}

impl Value {
    /// The value as a number.
    pub fn number(&self) -> f64 {
        match *self {
            Self::Number(number) => number,
            Self::Whole(whole) => whole as f64,
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number:?}"),
            Self::Whole(whole) => write!(f, "{whole}"),
        }
    }
}

/// Samples of the random values of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    /// Keys of the values, in the order of `[[random]]`.
    pub keys: Vec<String>,
    /// Whether each value is a seed, whose numbers have no order.
    pub seeds: Vec<bool>,
    /// The samples; each has a value for every key.
    pub rows: Vec<Vec<Value>>,
}

impl Samples {
    /// The values of sample `k` with their keys.
    pub fn values(&self, k: usize) -> Vec<(String, Value)> {
        self.keys.iter().cloned().zip(self.rows[k].iter().copied()).collect()
    }
}

/// Draws the samples that `[[random]]`, `[[random_correlation]]` and `[ensemble]` of a case ask for.
///
/// Sample k of a value depends on the seed, its key and k alone, for Monte Carlo without correlations.
///
/// # Errors
/// No random value, bounds that leave hardly any of a distribution, or correlations that no variables can have at once.
pub fn draw(case: &Case) -> Result<Samples, Invalid> {
    draw_from(&case.random, &case.random_correlations, &case.ensemble)
}

/// The samples of these tables of a case.
///
/// # Errors
/// As [`draw`].
pub fn draw_from(
    rows: &[RandomVariable],
    correlations: &[RandomCorrelation],
    ensemble: &Ensemble,
) -> Result<Samples, Invalid> {
    if rows.is_empty() {
        let message = "the case has no random value; add `[[random]]` with `key`, `distribution` and its parameters";
        return Err(Invalid { key: "random".to_owned(), message: message.to_owned() });
    }
    let variables =
        rows.iter().enumerate().map(|(i, row)| Variable::of(row, i)).collect::<Result<Vec<Variable>, _>>()?;
    let n = usize::try_from(ensemble.samples).unwrap_or(usize::MAX);
    let mut columns: Vec<Column> = Vec::new();
    for (row, variable) in rows.iter().zip(&variables) {
        if let Variable::Continuous(distribution) = variable {
            columns.push(Column::new(row, *distribution, ensemble.seed, n));
        }
    }
    let stratified = ensemble.sampling == Sampling::LatinHypercube;
    if !correlations.is_empty() {
        let factor = cholesky(rows, &columns, correlations)?;
        correlate(&mut columns, &factor, stratified, n);
    }
    if stratified {
        columns.iter_mut().for_each(|column| column.chance = column.within_strata(n));
    }
    let row = |k: usize| {
        let mut continuous = columns.iter();
        let value = |variable: &Variable| match variable {
            Variable::Seeds(first) => Value::Whole(first + k as u64),
            Variable::Continuous(_) => {
                Value::Number(continuous.next().map_or(f64::NAN, |column| column.distribution.value(column.chance[k])))
            }
        };
        variables.iter().map(value).collect()
    };
    Ok(Samples {
        keys: rows.iter().map(|row| row.key.clone()).collect(),
        seeds: variables.iter().map(|variable| matches!(variable, Variable::Seeds(_))).collect(),
        rows: (0..n).map(row).collect(),
    })
}

/// The middle of every random value, or its first seed, as settings of the case, `key=value`.
///
/// # Errors
/// Bounds that leave hardly any of a distribution.
pub fn medians(case: &Case) -> Result<Vec<String>, Invalid> {
    let median = |(i, row): (usize, &RandomVariable)| {
        let value = match Variable::of(row, i)? {
            Variable::Continuous(distribution) => Value::Number(distribution.value(0.5)),
            Variable::Seeds(first) => Value::Whole(first),
        };
        Ok(format!("{}={value}", row.key))
    };
    case.random.iter().enumerate().map(median).collect()
}

/// A continuous value in all samples.
struct Column {
    key: String,
    distribution: Distribution,
    /// Random numbers from 0 to 1; within its stratum for a Latin hypercube.
    chance: Vec<f64>,
    strata: Vec<usize>,
}

impl Column {
    fn new(row: &RandomVariable, distribution: Distribution, seed: u64, n: usize) -> Self {
        let chance = (0..n as u64).map(|k| philox::uniform(seed, &row.key, k)).collect();
        Self { key: row.key.clone(), distribution, chance, strata: philox::strata(seed, &row.key, n) }
    }

    fn within_strata(&self, n: usize) -> Vec<f64> {
        self.strata.iter().zip(&self.chance).map(|(&stratum, chance)| (stratum as f64 + chance) / n as f64).collect()
    }
}

/// Gives the columns the correlation of a Cholesky factor. In a Latin hypercube the ranks of the correlated numbers
/// choose the strata, so that each is still taken once.
fn correlate(columns: &mut [Column], factor: &[Vec<f64>], stratified: bool, n: usize) {
    let start = |column: &Column| if stratified { column.within_strata(n) } else { column.chance.clone() };
    let quantiles = |column: &Column| start(column).into_iter().map(normal::quantile).collect();
    let normals: Vec<Vec<f64>> = columns.iter().map(quantiles).collect();
    for (column, factors) in columns.iter_mut().zip(factor) {
        let sum = |k: usize| factors.iter().zip(&normals).fold(0.0, |sum, (factor, of)| sum + factor * of[k]);
        let correlated: Vec<f64> = (0..n).map(sum).collect();
        if stratified {
            column.strata = philox::places(&correlated, f64::total_cmp);
        } else {
            column.chance = correlated.into_iter().map(normal::probability).collect();
        }
    }
}

/// Lower factor of the matrix of correlations, row by row up to the diagonal.
fn cholesky(
    rows: &[RandomVariable],
    columns: &[Column],
    correlations: &[RandomCorrelation],
) -> Result<Vec<Vec<f64>>, Invalid> {
    let place = |key: &String| columns.iter().position(|column| &column.key == key);
    let size = columns.len();
    let mut matrix: Vec<Vec<f64>> = (0..size).map(|i| (0..size).map(|j| f64::from(i == j)).collect()).collect();
    for (i, correlation) in correlations.iter().enumerate() {
        let [Some(a), Some(b)] = [0, 1].map(|end| place(&correlation.keys[end])) else {
            let known = rows.iter().map(|row| row.key.as_str()).collect::<Vec<_>>().join(", ");
            let key = Key::root().field("random_correlation").index(i).field("keys").to_string();
            return Err(Invalid { key, message: format!("name no two random values; there are: {known}") });
        };
        (matrix[a][b], matrix[b][a]) = (correlation.value, correlation.value);
    }
    let mut factor: Vec<Vec<f64>> = Vec::with_capacity(size);
    for (i, given) in matrix.iter().enumerate() {
        let mut row: Vec<f64> = Vec::with_capacity(i + 1);
        for (j, above) in factor.iter().enumerate() {
            let rest = row.iter().zip(above).fold(given[j], |rest, (a, b)| rest - a * b);
            row.push(rest / above[j]);
        }
        let rest = row.iter().fold(given[i], |rest, a| rest - a * a);
        if rest.is_nan() || rest <= 0.0 {
            let message = "no variables can have all these correlations at once; bring some nearer to 0".to_owned();
            return Err(Invalid { key: "random_correlation".to_owned(), message });
        }
        row.push(rest.sqrt());
        factor.push(row);
    }
    Ok(factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(sampling: &str, correlation: f64) -> Case {
        let random = |key: &str| serde_json::json!({ "key": key, "distribution": "uniform", "least": 0, "most": 1 });
        let case = serde_json::json!({
            "title": "", "domain": {}, "mesh": { "size": 1.0 }, "rock": {}, "stage": [],
            "random": [random("a"), random("b"), { "key": "c", "distribution": "seeds", "first": 5 }, random("d")],
            "random_correlation": [
                { "keys": ["a", "b"], "value": correlation }, { "keys": ["b", "d"], "value": correlation }],
            "ensemble": { "samples": 64, "sampling": sampling },
        });
        serde_json::from_value(case).unwrap()
    }

    fn column(samples: &Samples, i: usize) -> Vec<f64> {
        samples.rows.iter().map(|row| row[i].number()).collect()
    }

    #[test]
    fn a_latin_hypercube_takes_every_part_once_also_with_correlations() {
        let samples = draw(&case("latin_hypercube", -0.6)).unwrap();
        for i in [0, 1, 3] {
            let mut parts: Vec<usize> = column(&samples, i).iter().map(|x| (64.0 * x) as usize).collect();
            parts.sort_unstable();
            assert_eq!(parts, (0..64).collect::<Vec<_>>());
        }
        assert_eq!(column(&samples, 2), (5..69).map(f64::from).collect::<Vec<_>>());
        let rank = crate::spearman(&column(&samples, 0), &column(&samples, 1));
        assert!(rank.is_some_and(|rank| (-0.9..-0.3).contains(&rank)), "{rank:?}");
    }

    #[test]
    fn a_sample_does_not_depend_on_the_number_of_samples() {
        let mut short = case("monte_carlo", 0.3);
        short.ensemble.samples = 9;
        assert_eq!(draw(&short).unwrap().rows, draw(&case("monte_carlo", 0.3)).unwrap().rows[..9]);
    }

    #[test]
    fn correlations_that_exclude_each_other_are_refused() {
        let refused = draw(&case("monte_carlo", 0.8)).unwrap_err();
        assert!(refused.key == "random_correlation" && refused.message.contains("at once"), "{refused}");
    }
}
