//! Which samples fail, with few searches: the bound of each is known in milliseconds, and the factor of safety lies
//! beside it by a ratio that hardly changes within a case. Samples whose bound lies far from the limit are decided by
//! it; how far is far enough follows from the ratios of those nearest the limit. The others are decided by one trial
//! at the limit.

use std::ops::Range;

use enmm::model::case::EnsembleOutput::{FactorOfSafety, LevelTops};
use enmm_ensemble::{Row, mean};
use serde_json::json;

use super::answers::Answers;
use super::{EnsembleError, SearchOptions};

/// Samples whose factor is searched for, to learn how it lies beside the bound.
const PILOT: usize = 12;
/// Fewest of these that have both.
const FEWEST: usize = 5;
/// Student's t for a two-sided probability of 99.9 %, at 4 to 11 degrees of freedom.
const STUDENT: [f64; 8] = [8.610, 6.869, 5.959, 5.408, 5.041, 4.781, 4.587, 4.437];

/// How the factor of safety lies beside the bound in a case: the logarithm of their ratio.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margin {
    /// Its mean.
    middle: f64,
    /// Half the width of the interval that holds another one with 99.9 %, no less than the tolerance of the search.
    half: f64,
}

impl Margin {
    /// From pairs of a bound and a factor; none when there are too few.
    fn of(pairs: &[(f64, f64)], tolerance: f64) -> Option<Self> {
        let ratios: Vec<f64> = pairs.iter().map(|(bound, factor)| libm::log(factor / bound)).collect();
        let n = ratios.len();
        let student = *STUDENT.get(n.checked_sub(FEWEST)?)?;
        let middle = mean(&ratios);
        let squares: f64 = ratios.iter().map(|ratio| (ratio - middle) * (ratio - middle)).sum();
        let deviation = (squares / (n - 1) as f64).sqrt();
        let half = (student * deviation * (1.0 + 1.0 / n as f64).sqrt()).max(tolerance);
        Some(Self { middle, half })
    }

    /// The factor that a bound suggests.
    fn estimate(&self, bound: f64) -> f64 {
        bound * libm::exp(self.middle)
    }

    /// Whether a bound decides on which side of the limit the factor is.
    fn decides(&self, bound: f64, limit: f64) -> bool {
        libm::log(self.estimate(bound) / limit).abs() > self.half
    }
}

/// The rows of some samples; those of the first ones, number 0 among them, find the margin for all.
///
/// # Errors
/// See [`EnsembleError`].
pub fn rows(
    samples: Range<usize>,
    limit: f64,
    search: &SearchOptions,
    answers: &mut Answers,
    margin: &mut Option<Margin>,
) -> Result<Vec<Row>, EnsembleError> {
    let is_first = samples.start == 0;
    let samples: Vec<usize> = samples.collect();
    let bounds = answers.look(&samples, LevelTops, &SearchOptions::default())?;
    let bound = |i: usize| bounds[i].number("level_tops");
    let mut rows: Vec<Option<Row>> = vec![None; samples.len()];
    if is_first {
        let pilot = nearest(&bounds, limit);
        let places: Vec<usize> = pilot.iter().map(|&i| samples[i]).collect();
        let factors = answers.find(&places, FactorOfSafety, search)?;
        let pairs = pilot.iter().zip(&factors).filter_map(|(&i, row)| pair(&bounds[i], row)).collect::<Vec<_>>();
        *margin = Margin::of(&pairs, search.fos().tolerance);
        for (&i, factor) in pilot.iter().zip(factors) {
            rows[i] = Some(by_factor(bound(i), factor));
        }
    }
    for (i, row) in rows.iter_mut().enumerate().filter(|(_, row)| row.is_none()) {
        *row = margin.and_then(|margin| by_bound(&bounds[i], &margin, limit));
        if let Some(estimate) = row.as_ref().and_then(|row| row.number("factor_estimate")) {
            answers.decided(estimate < limit);
        }
    }
    let open: Vec<usize> = (0..rows.len()).filter(|&i| rows[i].is_none()).collect();
    let places: Vec<usize> = open.iter().map(|&i| samples[i]).collect();
    let at_limit = SearchOptions { low: Some(limit), high: Some(limit), ..*search };
    let trials = answers.find(&places, FactorOfSafety, &at_limit)?;
    for (&i, trial) in open.iter().zip(trials) {
        rows[i] = Some(by_trial(bound(i), trial, *margin, limit));
    }
    Ok(rows.into_iter().flatten().collect())
}

/// Places of the samples whose bounds are nearest the limit, in their order.
fn nearest(bounds: &[Row], limit: f64) -> Vec<usize> {
    let distance = |i: usize| Some(libm::log(found_bound(&bounds[i])? / limit).abs());
    let mut near: Vec<(f64, usize)> = (0..bounds.len()).filter_map(|i| Some((distance(i)?, i))).collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut places: Vec<usize> = near.into_iter().take(PILOT).map(|(_, i)| i).collect();
    places.sort_unstable();
    places
}

/// A bound that was found, not one that lies beyond the greatest or the least that is looked for.
fn found_bound(row: &Row) -> Option<f64> {
    row.number("level_tops").filter(|bound| row.text("status") == "found" && *bound > 0.0)
}

/// Bound and factor of a sample that has both.
fn pair(bound: &Row, factor: &Row) -> Option<(f64, f64)> {
    let factor_found = factor.number("factor_of_safety").filter(|_| factor.text("status") == "found");
    Some((found_bound(bound)?, factor_found?))
}

fn row(estimate: f64, decided_by: &str, bound: Option<f64>, doubt: &str) -> Row {
    let outputs = [
        ("factor_estimate", json!(estimate)),
        ("decided_by", json!(decided_by)),
        ("level_tops", json!(bound)),
        ("doubt", json!(doubt)),
    ];
    Row { outputs: outputs.map(|(name, value)| (name.to_owned(), value)).into(), message: String::new() }
}

/// A sample whose factor was searched for.
fn by_factor(bound: Option<f64>, factor: Row) -> Row {
    let Some(found) = factor.number("factor_of_safety") else { return factor };
    row(found, "factor", bound, factor.text("doubt"))
}

/// A sample that its bound decides. A bound beyond what is looked for is at the right side of the limit.
fn by_bound(bound: &Row, margin: &Margin, limit: f64) -> Option<Row> {
    let value = bound.number("level_tops").filter(|value| *value > 0.0 && margin.decides(*value, limit))?;
    Some(row(margin.estimate(value), "bound", Some(value), ""))
}

/// A sample that a trial at the limit decides: its estimate is put at the side of the limit that the trial found.
fn by_trial(bound: Option<f64>, trial: Row, margin: Option<Margin>, limit: f64) -> Row {
    if trial.number("factor_of_safety").is_none() {
        return trial;
    }
    let estimate = margin.zip(bound).map_or(limit, |(margin, bound)| margin.estimate(bound));
    let stands = trial.text("status") == "stable_throughout";
    let estimate = if stands { estimate.max(limit) } else { estimate.min(limit.next_down()) };
    row(estimate, "trial", bound, trial.text("doubt"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_margin_is_as_wide_as_the_ratios_scatter() {
        let pairs: Vec<(f64, f64)> = (0..12).map(|k| (2.0, 2.0 * if k % 2 == 0 { 0.98 } else { 1.0 })).collect();
        let margin = Margin::of(&pairs, 5e-3).expect("twelve pairs");
        let deviation = 0.5 * -libm::log(0.98) * (12.0f64 / 11.0).sqrt();
        assert!((margin.half - 4.437 * deviation * (13.0f64 / 12.0).sqrt()).abs() < 1e-12);
        assert!(margin.decides(1.2, 1.0) && margin.decides(0.8, 1.0) && !margin.decides(1.02, 1.0));
        assert_eq!(Margin::of(&pairs[..4], 5e-3), None);
        let same = Margin::of(&[(1.0, 0.99); 6], 5e-3).expect("six pairs");
        assert_eq!(same.half, 5e-3);
    }

    #[test]
    fn a_trial_puts_the_estimate_at_its_side_of_the_limit() {
        let trial = |status: &str| Row {
            outputs: vec![("factor_of_safety".into(), json!(1.0)), ("status".into(), json!(status))],
            message: String::new(),
        };
        let margin = Some(Margin { middle: 0.0, half: 0.1 });
        for (bound, status, fails) in [(1.02, "stable_throughout", false), (1.02, "unstable_throughout", true)] {
            let row = by_trial(Some(bound), trial(status), margin, 1.0);
            assert_eq!(row.number("factor_estimate").map(|estimate| estimate < 1.0), Some(fails), "{status}");
        }
        assert_eq!(by_trial(None, trial("stable_throughout"), None, 1.3).number("factor_estimate"), Some(1.3));
    }
}
