//! `enmm draw`: the samples of an ensemble, for hosts that work them out themselves, such as the Python package.

use std::collections::BTreeMap;
use std::process::ExitCode;

use enmm::engine_version;
use enmm::model::case::{Ensemble, RandomCorrelation, RandomVariable};
use enmm_ensemble::{Given, Identity, Value, draw_from, sample_key};
use serde_json::{Value as Json, from_value, json};

use crate::{BAD_INPUT, OrFail, Outcome, print_line};

/// Reads a request from standard input; prints the samples, and the key of each in a store.
pub fn draw() -> Outcome {
    let text = std::io::read_to_string(std::io::stdin()).or_fail(BAD_INPUT)?;
    print_line(&answer(&text).or_fail(BAD_INPUT)?);
    Ok(ExitCode::SUCCESS)
}

/// The answer to a request: an object with the tables `random`, `random_correlation` and `ensemble` of a case, its
/// fingerprint `case`, and `output` and `options`, on which stored samples depend as well.
fn answer(text: &str) -> Result<String, String> {
    let [random, correlations, ensemble, case, output, options] =
        parts(text, ["random", "random_correlation", "ensemble", "case", "output", "options"])?;
    let wrong = |error: serde_json::Error| error.to_string();
    let random: Vec<RandomVariable> = from_value(random).map_err(wrong)?;
    let correlations: Vec<RandomCorrelation> = from_value(correlations).map_err(wrong)?;
    let ensemble: Ensemble = from_value(ensemble).map_err(wrong)?;
    let options: BTreeMap<String, Json> = from_value(options).map_err(wrong)?;
    let options = options.into_iter().map(|(name, value)| Some((name, given(&value)?))).collect::<Option<_>>();
    let options = options.ok_or("options: must be numbers and names")?;
    let [case, output]: [String; 2] = from_value(json!([case, output])).map_err(wrong)?;
    let samples = draw_from(&random, &correlations, &ensemble)
        .map_err(|invalid| format!("{}: {}", invalid.key, invalid.message))?;
    let identity = Identity { case, version: engine_version().to_owned(), output, options };
    let value = |value: &Value| match *value {
        Value::Number(number) => json!(number),
        Value::Whole(whole) => json!(whole),
    };
    let rows: Vec<Vec<Json>> = samples.rows.iter().map(|row| row.iter().map(value).collect()).collect();
    let keys: Vec<_> = (0..rows.len()).map(|k| sample_key(&identity, &samples.values(k))).collect();
    Ok(json!({ "samples": rows, "keys": keys }).to_string())
}

fn given(option: &Json) -> Option<Given> {
    option.as_f64().map(Given::Number).or_else(|| option.as_str().map(|name| Given::Name(name.to_owned())))
}

/// The members of these names of a JSON object.
fn parts<const N: usize>(text: &str, names: [&str; N]) -> Result<[Json; N], String> {
    let mut object: Json = serde_json::from_str(text).map_err(|error| error.to_string())?;
    Ok(names.map(|name| object.get_mut(name).map(Json::take).unwrap_or_default()))
}
