//! The picture of a sweep.

use enmm_ensemble::Value;
use enmm_picture::{Bars, Curve, Grid, Picture, bars_picture, curve_picture, grid_picture, number_text, three_digits};

use super::{Effect, SweepKind, SweepResult};
use crate::ensemble::output_name;

impl SweepResult {
    /// A curve, a contour or a tornado, with the limit in it.
    pub(super) fn picture(&self, title: &str) -> Picture {
        match self.sweep.kind {
            SweepKind::Curve => curve_picture(&self.curve(title)),
            SweepKind::Contour => grid_picture(&self.grid(title)),
            SweepKind::Tornado => bars_picture(&self.bars(title)),
        }
    }

    fn caption(&self) -> String {
        let [low, high] = self.range().map(three_digits);
        let name = output_name(self.sweep.output);
        let of_case = match (self.sweep.kind, self.output(0)) {
            (SweepKind::Tornado, Some(output)) => format!(", {} of the case", three_digits(output)),
            _ => String::new(),
        };
        let n = self.rows.len() - self.failed.len();
        let red =
            if self.has_factors() { format!("; red line: F = {}", three_digits(self.limit)) } else { String::new() };
        format!("{name}: {low} to {high} in {n} samples{of_case}{red}")
    }

    fn curve(&self, title: &str) -> Curve {
        let across = &self.sweep.changes[0];
        let points = across.values.iter().enumerate().filter_map(|(k, value)| Some([value.number(), self.output(k)?]));
        Curve {
            title: title.to_owned(),
            caption: self.caption(),
            axes: [across.key.clone(), output_name(self.sweep.output).to_owned()],
            points: points.collect(),
            limit: self.has_factors().then_some(self.limit),
            crossings: self.crossings().iter().filter_map(|crossing| crossing.value).collect(),
        }
    }

    fn grid(&self, title: &str) -> Grid {
        let values = |k: usize| self.sweep.changes[k].values.iter().map(|value| value.number()).collect();
        Grid {
            title: title.to_owned(),
            caption: self.caption(),
            axes: [0, 1].map(|k| self.sweep.changes[k].key.clone()),
            name: output_name(self.sweep.output).to_owned(),
            values: [values(0), values(1)],
            outputs: (0..self.rows.len()).map(|k| self.output(k).unwrap_or(f64::NAN)).collect(),
            limit: self.has_factors().then_some(self.limit),
        }
    }

    fn bars(&self, title: &str) -> Bars {
        let ends = |effect: &Effect| {
            let end = |(value, output): &(Value, f64)| (number_text(value.number()), *output);
            (effect.key.clone(), effect.outputs.iter().map(end).collect())
        };
        Bars {
            title: title.to_owned(),
            caption: self.caption(),
            name: output_name(self.sweep.output).to_owned(),
            base: self.output(0),
            limit: self.has_factors().then_some(self.limit),
            bars: self.effects().iter().map(ends).collect(),
        }
    }
}
