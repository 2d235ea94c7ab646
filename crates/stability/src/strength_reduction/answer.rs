//! The factors of a search in words.

use super::corners::CornersHold;
use super::series::Series;
use super::{Reduction, Trial, Verdict};

/// Digits by which two factors differ: less is the same factor in a text.
const SAME: f64 = 5e-5;

impl Series {
    /// Its limit: `1.1050 (stable at 1.1014, not at 1.1087)`.
    pub fn text(&self) -> String {
        match (self.factor(), self.low, self.high, self.at_least()) {
            (Some(factor), Some(low), Some(high), _) => {
                format!("{factor:.4} (stable at {low:.4}, not at {high:.4})")
            }
            (.., Some(least)) => format!("at least {least:.4}"),
            (_, Some(low), ..) => format!("above {low:.4}"),
            (_, None, Some(high), _) => format!("below {high:.4}"),
            _ => "none".to_owned(),
        }
    }
}

impl CornersHold {
    /// The factor where corners hold, and which.
    pub fn text(&self) -> String {
        format!("{} where corners hold: {}", self.series.text(), self.places())
    }
}

impl Reduction {
    /// Greatest F at which no bar yields and the least at which one does, where bars yield in a stable trial.
    pub fn first_yield(&self) -> Option<[f64; 2]> {
        let stable = || self.trials.iter().filter(|trial| trial.verdict == Verdict::Stable);
        let yielded = stable().find(|trial| trial.bars_yield)?.factor;
        let whole = stable().rfind(|trial| trial.factor < yielded)?.factor;
        Some([whole, yielded])
    }

    /// The factors beside the headline, with their names.
    pub fn others(&self) -> Vec<(&'static str, String)> {
        let mut others = Vec::new();
        if let Some(corners) = &self.corners {
            others.push(("with corners", corners.text()));
        }
        if let Some(lost) = &self.lost {
            let is_same = lost.low == self.low && lost.high == self.high;
            let text = if is_same { "at the same factor, in its real geometry".to_owned() } else { lost.text() };
            others.push(("is lost", text));
        }
        if let Some([whole, yielded]) = self.first_yield() {
            let collapse = self.factor().map_or_else(String::new, |factor| format!(", collapse at {factor:.4}"));
            let slip = |trial: Option<&Trial>| trial.map_or(0.0, |trial| trial.displacement);
            let last = self.trials.iter().find(|trial| Some(trial.factor) == self.low);
            others.push((
                "bars",
                format!(
                    "first yield between F = {whole:.4} and {yielded:.4}, after {:.3} m{collapse}, after {:.3} m",
                    slip(self.trials.iter().find(|trial| trial.factor == whole)),
                    slip(last)
                ),
            ));
        }
        if let (Some(before), Some(factor)) = (self.before_nudges, self.factor()) {
            let spread = 100.0 * (before / factor - 1.0);
            let text = if spread.abs() < SAME {
                "change nothing".to_owned()
            } else {
                format!("{before:.4} before them, {spread:.1} % more")
            };
            others.push(("nudges", text));
        }
        others
    }
}
