//! Numbers as a reader wants them: three digits, or as they were typed, with the unit that suits their size.

use enmm_io::numbers::{self, superscript, with_minus};
use serde_json::Value;

/// A number of a record with its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Number {
    /// The value of the record.
    value: f64,
    /// What is printed of it.
    text: String,
    unit: String,
}

/// How many digits are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Digits {
    /// Three significant ones, for results.
    Three,
    /// Those that were typed, at most six.
    Typed,
}

impl Number {
    /// A value divided by `size`, in a unit.
    fn new(value: f64, size: f64, unit: &str, digits: Digits) -> Self {
        let shown = value / size;
        let text = match digits {
            Digits::Three => three_digits(shown),
            Digits::Typed => typed(shown),
        };
        Self { value, text, unit: unit.to_owned() }
    }

    /// HTML of the number: the exact value beside the text.
    pub fn html(&self) -> String {
        let Self { value, text, unit } = self;
        let space = if unit.is_empty() || unit == "°" { "" } else { "\u{a0}" };
        format!("<data value=\"{value}\">{text}</data>{space}{unit}")
    }
}

/// A plain number of a record; none where it is no number.
pub fn plain(value: &Value, unit: &str, digits: Digits) -> Option<Number> {
    Some(Number::new(value.as_f64()?, 1.0, unit, digits))
}

/// A share as percent.
pub fn percent(value: &Value) -> Option<Number> {
    Some(Number::new(value.as_f64()?, 0.01, "%", Digits::Three))
}

/// A value in the largest of the units `k`, `M`, `G` that it reaches.
pub fn prefixed(value: &Value, unit: &str, digits: Digits) -> Option<Number> {
    const PREFIXES: [(f64, &str); 3] = [(1e9, "G"), (1e6, "M"), (1e3, "k")];
    let value = value.as_f64()?;
    let (size, prefix) = PREFIXES.into_iter().find(|(size, _)| value.abs() >= *size).unwrap_or((1.0, ""));
    Some(Number::new(value, size, &format!("{prefix}{unit}"), digits))
}

/// A length (m) in metres, or below a tenth of one in millimetres.
pub fn length(value: &Value, digits: Digits) -> Option<Number> {
    let value = value.as_f64()?;
    let (size, unit) = if value != 0.0 && value.abs() < 0.1 { (1e-3, "mm") } else { (1.0, "m") };
    Some(Number::new(value, size, unit, digits))
}

/// A mass (kg/m) in tonnes.
pub fn mass(value: &Value) -> Option<Number> {
    Some(Number::new(value.as_f64()?, 1e3, "t/m", Digits::Three))
}

/// An area (m²) of steel in square millimetres.
pub fn steel_area(value: &Value) -> Option<Number> {
    Some(Number::new(value.as_f64()?, 1e-6, "mm²", Digits::Typed))
}

/// Three significant digits: `94.6`, `1.44`, `2510`.
fn three_digits(value: f64) -> String {
    numbers::three_digits(value).unwrap_or_else(|rounded| scientific(&format!("{rounded:.2e}")))
}

/// At most six significant digits without zeros at the end, which hides the rounding of a change of units.
fn typed(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    if rounded != 0.0 && !(1e-4..1e9).contains(&rounded.abs()) {
        return scientific(&format!("{rounded:e}"));
    }
    with_minus(&format!("{}", rounded + 0.0))
}

/// `1.2e-7` as `1.2 · 10⁻⁷`.
fn scientific(text: &str) -> String {
    let parts = text.split_once('e').and_then(|(mantissa, exponent)| Some((mantissa, exponent.parse().ok()?)));
    let Some((mantissa, exponent)) = parts else { return text.to_owned() };
    format!("{} · 10{}", with_minus(mantissa), superscript(exponent))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn results_have_three_digits_and_input_those_that_were_typed() {
        let three = [94.605, 1.4447, 9.996, 0.0855, 2507.0, -0.001234, 0.0, 1.23456e9];
        let texts = ["94.6", "1.44", "10.0", "0.0855", "2507", "−0.00123", "0", "1.23 · 10⁹"];
        // Whole numbers of more digits keep them as far as the rounding goes.
        let texts = texts.map(|text| if text == "2507" { "2510" } else { text });
        assert_eq!(three.map(three_digits), texts);
        assert_eq!([32.0, 14.586, 0.1 + 0.2, 2e-7, 0.0].map(typed), ["32", "14.586", "0.3", "2 · 10⁻⁷", "0"]);
    }

    #[test]
    fn units_suit_the_size() {
        let html = |number: Option<Number>| number.expect("a number").html();
        assert_eq!(html(prefixed(&json!(20e3), "Pa", Digits::Typed)), "<data value=\"20000\">20</data>\u{a0}kPa");
        assert_eq!(html(prefixed(&json!(20e9), "Pa", Digits::Typed)), "<data value=\"20000000000\">20</data>\u{a0}GPa");
        assert_eq!(html(percent(&json!(0.4228))), "<data value=\"0.4228\">42.3</data>\u{a0}%");
        assert_eq!(html(length(&json!(0.031), Digits::Three)), "<data value=\"0.031\">31.0</data>\u{a0}mm");
        assert_eq!(plain(&json!(null), "m", Digits::Three), None);
    }
}
