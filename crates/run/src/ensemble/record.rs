//! Summary of all samples, and the files that hold it.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;

use enmm::engine_version;
use enmm::model::case::{Ensemble, EnsembleOutput};
use enmm_ensemble::{Interval, Row, Samples, beta, mean, quantile, spearman, standard_deviation, wilson};
use enmm_io::LoadedCase;
use enmm_io::files::{at_path, write_atomic};
use enmm_picture::{Fit, histogram_picture, three_digits};
use serde_json::{Map, Value as Json, json};

use super::{CONFIDENCE, EnsembleError, EnsembleOptions, SampleOutput, columns};
use enmm_record::input_record;

/// Shares of the samples for which quantiles are given.
const SHARES: [f64; 3] = [0.05, 0.5, 0.95];

/// An output in words of readers who do not know limit analysis.
pub(crate) fn output_name(output: impl Into<SampleOutput>) -> &'static str {
    let output = match output.into() {
        SampleOutput::Ensemble(output) => output,
        SampleOutput::Displacement => return "largest displacement in the last stage [m]",
    };
    match output {
        EnsembleOutput::FactorOfSafety => "factor of safety",
        EnsembleOutput::LevelTops => "factor of safety by limit analysis",
        EnsembleOutput::Associated => "upper bound of the factor of safety by limit analysis",
        EnsembleOutput::Failure => "estimate of the factor of safety",
    }
}

/// Rows of samples by whether they have an answer.
pub(crate) struct Answered {
    /// Places of the samples that have one.
    pub good: Vec<usize>,
    /// The output of each of these.
    pub outputs: Vec<f64>,
    /// Samples without an answer, with the reason.
    pub failed: Vec<(usize, String)>,
    /// Samples whose factor is above the bound of limit analysis, with the warning.
    pub doubtful: Vec<(usize, String)>,
}

impl Answered {
    /// By an output, at least one of which must be there.
    pub fn of(rows: &[Row], name: &str) -> Result<Self, EnsembleError> {
        let (mut good, mut outputs, mut failed, mut doubtful) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (k, row) in rows.iter().enumerate() {
            match row.number(name) {
                Some(output) => {
                    good.push(k);
                    outputs.push(output);
                }
                None if row.is_done() => failed.push((k, format!("the store has no number {name} of it"))),
                None => failed.push((k, row.message.clone())),
            }
            let doubt = row.text("doubt");
            if !doubt.is_empty() {
                doubtful.push((k, doubt.to_owned()));
            }
        }
        if good.is_empty() {
            let message = failed.first().map_or_else(String::new, |(_, message)| message.clone());
            return Err(EnsembleError::NoAnswer { n: rows.len(), message });
        }
        Ok(Self { good, outputs, failed, doubtful })
    }
}

/// Writes a table of samples: number, values of the keys, and outputs of each.
pub(crate) fn write_table<'a>(
    path: &Path,
    keys: &[String],
    names: &[&str],
    samples: impl Iterator<Item = (usize, Vec<String>, &'a Row)>,
) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    let head = ["sample"].into_iter().chain(keys.iter().map(String::as_str)).chain(names.iter().copied());
    csv.write_record(head).map_err(io::Error::from).map_err(at_path(path))?;
    let text = |value: Option<&Json>| match value {
        None | Some(Json::Null) => String::new(),
        Some(Json::String(text)) => text.clone(),
        Some(value) => value.to_string(),
    };
    for (k, values, row) in samples {
        let outputs = names.iter().map(|name| text(row.output(name)));
        let record = [k.to_string()].into_iter().chain(values).chain(outputs);
        csv.write_record(record).map_err(io::Error::from).map_err(at_path(path))?;
    }
    let bytes = csv.into_inner().map_err(|error| error.into_error()).map_err(at_path(path))?;
    write_atomic(path, &bytes)
}

/// The head of a record of samples: case, store, options, samples without an answer and doubtful ones.
pub(crate) fn head(
    loaded: &LoadedCase,
    options: &EnsembleOptions,
    [failed, doubtful]: [&[(usize, String)]; 2],
    wall: f64,
) -> Map<String, Json> {
    let pairs = [
        ("title", json!(loaded.case.title)),
        ("version", json!(engine_version())),
        ("case_file", json!(loaded.source.file())),
        ("case_hash", json!(loaded.hash)),
        ("settings", json!(loaded.settings)),
        ("store", json!(options.store)),
        ("options", json!(options.search.given())),
        ("without_answer", json!(messages(failed))),
        ("doubtful", json!(messages(doubtful))),
        ("input", input_record(loaded)),
        ("wall_seconds", json!(wall)),
    ];
    pairs.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// Writes a record whole or not at all.
pub(crate) fn write_record(path: &Path, record: &Map<String, Json>) -> io::Result<()> {
    let text = serde_json::to_vec_pretty(record).map_err(io::Error::from).map_err(at_path(path))?;
    write_atomic(path, &text)
}

/// A list of samples with a message each, for records.
fn messages(list: &[(usize, String)]) -> Vec<Json> {
    list.iter().map(|(k, message)| json!({ "sample": k, "message": message })).collect()
}

/// The samples that have an answer, and what follows from them.
#[derive(Debug, Clone, PartialEq)]
pub struct EnsembleResult {
    /// All samples.
    pub samples: Samples,
    /// Results of the samples.
    pub rows: Vec<Row>,
    /// How they were drawn.
    pub ensemble: Ensemble,
    /// Places of the samples that have an answer.
    pub good: Vec<usize>,
    /// The output of each of these that decides whether it fails.
    pub outputs: Vec<f64>,
    /// Samples without an answer, with the reason.
    pub failed: Vec<(usize, String)>,
    /// Samples whose factor is above the bound of limit analysis, with the warning.
    pub doubtful: Vec<(usize, String)>,
}

impl EnsembleResult {
    pub(super) fn of(loaded: &LoadedCase, samples: Samples, rows: Vec<Row>) -> Result<Self, EnsembleError> {
        let ensemble = loaded.case.ensemble.clone();
        let Answered { good, outputs, failed, doubtful } = Answered::of(&rows, columns(ensemble.output)[0])?;
        Ok(Self { samples, rows, ensemble, good, outputs, failed, doubtful })
    }

    /// Number of samples below the limit.
    pub fn failures(&self) -> usize {
        self.outputs.iter().filter(|output| **output < self.ensemble.limit).count()
    }

    /// Share of the samples below the limit.
    pub fn probability_of_failure(&self) -> f64 {
        self.failures() as f64 / self.outputs.len() as f64
    }

    /// Confidence interval (95 %) of that probability, by Wilson's formula.
    pub fn interval(&self) -> Interval {
        wilson(self.failures(), self.outputs.len(), CONFIDENCE)
    }

    /// By what the samples were decided, where that is what was looked for.
    pub fn decided(&self) -> Option<String> {
        let by = |name: &str| self.rows.iter().filter(|row| row.text("decided_by") == name).count();
        let [bound, factor, trial] = ["bound", "factor", "trial"].map(by);
        (self.ensemble.output == EnsembleOutput::Failure)
            .then(|| format!("{bound} by their bound, {factor} by their factor, {trial} by a trial at the limit"))
    }

    /// Mean output.
    pub fn mean(&self) -> f64 {
        mean(&self.outputs)
    }

    /// The distribution with mean and standard deviation of the outputs: lognormal where all are above 0. None where
    /// they are all alike.
    pub fn fit(&self) -> Option<Fit> {
        let (mean, sd) = (self.mean(), standard_deviation(&self.outputs));
        let is_lognormal = self.outputs.iter().all(|output| *output > 0.0);
        (sd > 0.0).then_some(Fit { is_lognormal, mean, sd })
    }

    /// Shares of the samples, with the output below which each share is.
    pub fn quantiles(&self) -> [(f64, f64); 3] {
        SHARES.map(|share| (share, quantile(&self.outputs, share)))
    }

    /// Spearman's rank correlation of the output with each value but seeds, whose numbers have no order.
    pub fn sensitivity(&self) -> Vec<(String, Option<f64>)> {
        let ordered = self.samples.keys.iter().enumerate().filter(|(i, _)| !self.samples.seeds[*i]);
        let correlation = |i: usize| {
            let given: Vec<f64> = self.good.iter().map(|&k| self.samples.rows[k][i].number()).collect();
            spearman(&given, &self.outputs)
        };
        ordered.map(|(i, key)| (key.clone(), correlation(i))).collect()
    }

    /// Writes all results; `ensemble.json` last, so that it is there when all others are.
    pub(super) fn write(&self, loaded: &LoadedCase, options: &EnsembleOptions, wall: f64) -> io::Result<()> {
        let directory = &options.directory;
        let values = |k: usize| self.samples.rows[k].iter().map(ToString::to_string).collect();
        let rows = self.good.iter().map(|&k| (k, values(k), &self.rows[k]));
        let names = columns(self.ensemble.output);
        write_table(&directory.join("ensemble.csv"), &self.samples.keys, names, rows)?;
        let Interval { low, high } = self.interval();
        let percent = |share: f64| format!("{} %", three_digits(100.0 * share));
        let beta = match beta(self.probability_of_failure()) {
            beta if beta.is_finite() => format!(", β {}", three_digits(beta)),
            _ => String::new(),
        };
        let caption = format!(
            "{} samples, {} below {}: probability of failure {}, 95 % interval {} to {}{beta}; seed {}",
            self.outputs.len(),
            self.failures(),
            three_digits(self.ensemble.limit),
            percent(self.probability_of_failure()),
            percent(low),
            percent(high),
            self.ensemble.seed
        );
        let name = output_name(self.ensemble.output);
        let (outputs, limit) = (&self.outputs, self.ensemble.limit);
        let picture = histogram_picture(&loaded.case.title, &caption, name, outputs, limit, self.fit());
        picture.write(directory, "ensemble")?;
        write_record(&directory.join("ensemble.json"), &self.record(loaded, options, wall))
    }

    fn record(&self, loaded: &LoadedCase, options: &EnsembleOptions, wall: f64) -> Map<String, Json> {
        let Interval { low, high } = self.interval();
        let given: Vec<Json> = loaded.case.random.iter().map(|row| json!(row)).collect();
        let mut record = head(loaded, options, [&self.failed, &self.doubtful], wall);
        let Json::Object(own) = json!({
            "ensemble": self.ensemble,
            "random": given,
            "random_correlation": loaded.case.random_correlations,
            "samples": self.rows.len(),
            "failures": self.failures(),
            "probability_of_failure": self.probability_of_failure(),
            "interval": [low, high],
            "confidence": CONFIDENCE,
            "beta": beta(self.probability_of_failure()),
            "beta_interval": [beta(high), beta(low)],
            "mean": self.mean(),
            "standard_deviation": standard_deviation(&self.outputs),
            "fit": self.fit().map(|fit| if fit.is_lognormal { "lognormal" } else { "normal" }),
            "quantiles": self.quantiles().map(|(share, output)| [share, output]),
            "rank_correlation": self.sensitivity().into_iter().collect::<BTreeMap<_, _>>(),
        }) else {
            return record;
        };
        record.extend(own);
        record
    }
}
