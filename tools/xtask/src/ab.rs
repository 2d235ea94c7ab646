//! Two builds of the program timed against each other, turn by turn, so that both meet the same moods of the machine.

use std::path::Path;

use serde_json::Value;

use crate::repository::{self, Repository};

/// Models that are compared when none is named.
const MODELS: &str = "continuum_10000,continuum_100000,slope_500x4,slope_2000x4";
/// Rounds when no number is given.
const ROUNDS: usize = 5;
/// Wall time (s) for the steps of each model in a round.
const SECONDS: &str = "0.5";
/// Times that are compared: name, and place in the object of a model.
const PARTS: [(&str, &str); 7] = [
    ("step", "/ms_per_step"),
    ("search", "/stages/search"),
    ("elements", "/stages/elements"),
    ("entrance", "/stages/entrance"),
    ("sweep", "/stages/sweep"),
    ("commit", "/stages/commit"),
    ("rest", "/stages/rest"),
];

/// Programs and models to compare.
pub struct Comparison<'a> {
    old: &'a Path,
    new: &'a Path,
    models: &'a str,
    rounds: usize,
    threads: &'a str,
}

impl<'a> Comparison<'a> {
    /// Reads `OLD NEW [--models NAMES] [--rounds N] [--threads N]`.
    pub fn read(words: &'a [&'a str]) -> Result<Self, String> {
        let [old, new, rest @ ..] = words else { return Err("ab needs two programs: OLD NEW".to_owned()) };
        let (old, new) = (Path::new(*old), Path::new(*new));
        let mut read = Self { old, new, models: MODELS, rounds: ROUNDS, threads: "1" };
        for pair in rest.chunks(2) {
            match pair {
                ["--models", names] => read.models = *names,
                ["--threads", number] => read.threads = *number,
                ["--rounds", number] => read.rounds = number.parse().map_err(|_| format!("{number} is no number"))?,
                _ => return Err(format!("ab does not know {}", pair.join(" "))),
            }
        }
        Ok(read)
    }

    /// Runs both programs in turn and prints the median of each part and of the ratios of the rounds.
    pub fn run(&self, repository: &Repository) -> Result<(), String> {
        println!("| model | part | old ms | new ms | old / new | range |\n|---|---|---|---|---|---|");
        for model in self.models.split(',') {
            let mut rounds = Vec::new();
            for round in 0..self.rounds {
                // Who is first changes, so that neither always finds the machine as the other left it.
                let (old, new) = if round % 2 == 0 {
                    let old = self.bench(repository, self.old, model)?;
                    (old, self.bench(repository, self.new, model)?)
                } else {
                    let new = self.bench(repository, self.new, model)?;
                    (self.bench(repository, self.old, model)?, new)
                };
                rounds.push([old, new]);
            }
            PARTS.iter().for_each(|(name, place)| print_part(model, name, place, &rounds));
        }
        Ok(())
    }

    /// Times of a model by a program.
    fn bench(&self, repository: &Repository, program: &Path, model: &str) -> Result<Value, String> {
        let mut command = repository.command(repository::program(program));
        command.args(["bench", "--json", "--no-limits", "--threads", self.threads, "--seconds", SECONDS]);
        command.args(["--models", model]);
        let told = repository::capture(&mut command)?;
        let mut report: Value = serde_json::from_slice(&told).map_err(|error| format!("{model}: {error}"))?;
        Ok(report["models"][0].take())
    }
}

fn print_part(model: &str, name: &str, place: &str, rounds: &[[Value; 2]]) {
    let value = |told: &Value| told.pointer(place).and_then(Value::as_f64).unwrap_or(f64::NAN);
    let of = |k: usize| median(rounds.iter().map(|round| value(&round[k])).collect());
    let mut ratios: Vec<f64> = rounds.iter().map(|round| value(&round[0]) / value(&round[1])).collect();
    ratios.sort_by(f64::total_cmp);
    let [old, new] = [of(0), of(1)];
    if old.max(new) > 1e-3 {
        let (least, most) = (ratios[0], ratios[ratios.len() - 1]);
        println!(
            "| {model} | {name} | {old:.4} | {new:.4} | **{:.2}** | {least:.2}–{most:.2} |",
            median(ratios.clone())
        );
    }
}

/// The middle value; of an even number the upper of the middle two.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read() {
        let read = Comparison::read(&["a", "b", "--rounds", "3", "--models", "slope_4x4"]);
        assert!(read.is_ok_and(|read| read.rounds == 3 && read.models == "slope_4x4" && read.threads == "1"));
        assert!(Comparison::read(&["a"]).is_err());
        assert!(Comparison::read(&["a", "b", "--rounds"]).is_err());
        assert!(Comparison::read(&["a", "b", "--rounds", "x"]).is_err());
    }

    #[test]
    fn median_is_the_middle() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert!(median(Vec::new()).is_nan());
    }
}
