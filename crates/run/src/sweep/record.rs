//! Results of a sweep: crossings of the limit, effects of changes, and the files that hold them.

use std::io;
use std::path::Path;

use enmm_ensemble::{Row, Value};
use enmm_io::LoadedCase;
use serde_json::{Map, Value as Json, json};

use super::crossing::{Along, Crossing, crossings};
use super::{Change, Sweep, SweepKind};
use crate::ensemble::{
    Answered, EnsembleError, EnsembleOptions, FAILS, NO_VERDICT, SampleOutput, Values, columns, head, write_record,
    write_table,
};

/// The samples of a sweep, and what follows from them.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepResult {
    /// Keys with their values.
    pub sweep: Sweep,
    /// Values of each sample.
    pub samples: Vec<Values>,
    /// Results of the samples.
    pub rows: Vec<Row>,
    /// Factor below which a slope counts as failed: `ensemble.limit` of the case.
    pub limit: f64,
    /// Samples without an answer, with the reason.
    pub failed: Vec<(usize, String)>,
    /// Samples whose factor is above the bound of limit analysis, with the warning.
    pub doubtful: Vec<(usize, String)>,
}

/// Effect of the values of one key alone on the output.
#[derive(Debug, Clone, PartialEq)]
pub struct Effect {
    /// The key.
    pub key: String,
    /// Its values, ascending, with the outputs that are there.
    pub outputs: Vec<(Value, f64)>,
    /// Distance of the least from the greatest output, that of the case among them.
    pub range: f64,
}

impl SweepResult {
    pub(super) fn of(sweep: Sweep, rows: Vec<Row>, limit: f64) -> Result<Self, EnsembleError> {
        let Answered { failed, doubtful, .. } = Answered::of(&rows, columns(sweep.output)[0])?;
        Ok(Self { samples: sweep.samples(), sweep, rows, limit, failed, doubtful })
    }

    /// Whether the outputs are factors of safety.
    pub fn has_factors(&self) -> bool {
        self.sweep.output != SampleOutput::Displacement
    }

    /// Whether the slope of a sample fails; none without an answer or a verdict.
    pub fn fails(&self, k: usize) -> Option<bool> {
        let output = self.output(k)?;
        match self.status(k) {
            _ if self.has_factors() => Some(output < self.limit),
            NO_VERDICT => None,
            status => Some(status == FAILS),
        }
    }

    /// Output of a sample: its factor, or its displacement (m); none without an answer.
    pub fn output(&self, k: usize) -> Option<f64> {
        self.rows[k].number(columns(self.sweep.output)[0])
    }

    /// How the factor of a sample is one: `found`, or the way in which it is a limit alone; how a run ended.
    pub fn status(&self, k: usize) -> &str {
        self.rows[k].text("status")
    }

    /// Least and greatest output.
    pub fn range(&self) -> [f64; 2] {
        let outputs = (0..self.rows.len()).filter_map(|k| self.output(k));
        outputs.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    }

    /// Places along the first key at which the slope begins or ends to fail, for each value of the second one; none of
    /// a tornado, which has no order of values.
    pub fn crossings(&self) -> Vec<Crossing> {
        let along = |k: usize, value: &Value| Along {
            value: value.number(),
            fails: self.fails(k),
            factor: self.output(k).filter(|_| self.status(k) == "found"),
        };
        let row = |first: usize, across: &Change| -> Vec<Along> {
            across.values.iter().enumerate().map(|(i, value)| along(first + i, value)).collect()
        };
        match (self.sweep.kind, &self.sweep.changes[..]) {
            (SweepKind::Curve, [across]) => crossings(&row(0, across), self.limit, None),
            (SweepKind::Contour, [across, up]) => {
                let at = |(j, value): (usize, &Value)| {
                    crossings(&row(j * across.values.len(), across), self.limit, Some(*value))
                };
                up.values.iter().enumerate().flat_map(at).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Effects of the changes of a tornado, the greatest first.
    pub fn effects(&self) -> Vec<Effect> {
        let base = self.output(0);
        let effect = |change: &Change| {
            let own = (0..self.samples.len()).filter(|&k| self.samples[k].iter().any(|(key, _)| *key == change.key));
            let outputs: Vec<(Value, f64)> =
                own.filter_map(|k| Some((self.samples[k][0].1, self.output(k)?))).collect();
            let all = || outputs.iter().map(|(_, output)| *output).chain(base);
            let range = (all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)).max(0.0);
            Effect { key: change.key.clone(), outputs, range }
        };
        let mut effects: Vec<Effect> = self.sweep.changes.iter().map(effect).collect();
        effects.sort_by(|a, b| b.range.total_cmp(&a.range));
        effects
    }

    /// Writes all results; `sweep.json` last, so that it is there when all others are.
    pub(super) fn write(&self, loaded: &LoadedCase, options: &EnsembleOptions, wall: f64) -> io::Result<()> {
        let directory = &options.directory;
        self.write_table(&directory.join("sweep.csv"))?;
        self.picture(&loaded.case.title).write(directory, "sweep")?;
        write_record(&directory.join("sweep.json"), &self.record(loaded, options, wall))
    }

    /// A row for each sample that has an answer; keys that a sample leaves as they are have no value.
    fn write_table(&self, path: &Path) -> io::Result<()> {
        let keys: Vec<String> = self.sweep.changes.iter().map(|change| change.key.clone()).collect();
        let value = |k: usize, key: &String| {
            let own = self.samples[k].iter().find(|(other, _)| other == key);
            own.map_or_else(String::new, |(_, value)| value.to_string())
        };
        let good = (0..self.rows.len()).filter(|&k| self.output(k).is_some());
        let rows = good.map(|k| (k, keys.iter().map(|key| value(k, key)).collect(), &self.rows[k]));
        write_table(path, &keys, columns(self.sweep.output), rows)
    }

    fn record(&self, loaded: &LoadedCase, options: &EnsembleOptions, wall: f64) -> Map<String, Json> {
        let mut record = head(loaded, options, [&self.failed, &self.doubtful], wall);
        let mut add = |name: &str, value: Json| drop(record.insert(name.to_owned(), value));
        add("kind", json!(self.sweep.kind.name()));
        add("output", json!(self.sweep.output.name()));
        add("limit", json!(self.limit));
        add("keys", self.sweep.changes.iter().map(change).collect());
        add("samples", (0..self.rows.len()).map(|k| self.sample(k)).collect());
        match self.sweep.kind {
            SweepKind::Tornado => {
                add("of_the_case", json!(self.output(0)));
                add("effects", self.effects().iter().map(effect).collect());
            }
            _ => add("crossings", self.crossings().iter().map(crossing).collect()),
        }
        record
    }

    fn sample(&self, k: usize) -> Json {
        let values: Map<String, Json> =
            self.samples[k].iter().map(|(key, value)| (key.clone(), plain(*value))).collect();
        let outputs = self.rows[k].outputs.iter().cloned();
        Json::Object([("values".to_owned(), Json::Object(values))].into_iter().chain(outputs).collect())
    }
}

fn plain(value: Value) -> Json {
    match value {
        Value::Number(number) => json!(number),
        Value::Whole(whole) => json!(whole),
    }
}

fn change(change: &Change) -> Json {
    let values: Vec<Json> = change.values.iter().map(|value| plain(*value)).collect();
    json!({ "key": change.key, "values": values })
}

fn crossing(crossing: &Crossing) -> Json {
    let mut record = json!({ "value": crossing.value, "between": crossing.between });
    if let Some(at) = crossing.at {
        record["at"] = plain(at);
    }
    record
}

fn effect(effect: &Effect) -> Json {
    let outputs: Vec<Json> = effect.outputs.iter().map(|(value, output)| json!([plain(*value), output])).collect();
    json!({ "key": effect.key, "outputs": outputs, "range": effect.range })
}
