//! Intervals of numbers.

use std::fmt;

use super::{Rule, Unit};

/// An interval with open or closed ends.
#[derive(Debug, Clone, Copy)]
pub struct Range {
    low: f64,
    low_open: bool,
    high: f64,
    high_open: bool,
}

impl Range {
    /// Returns the values greater than `low`.
    pub const fn above(low: f64) -> Self {
        Self { low, low_open: true, high: f64::MAX, high_open: false }
    }

    /// Returns the values that are at least `low`.
    pub const fn from(low: f64) -> Self {
        Self { low, low_open: false, high: f64::MAX, high_open: false }
    }

    /// Returns the values whose magnitude is at most `size`.
    pub const fn within(size: f64) -> Self {
        Self { low: -size, low_open: false, high: size, high_open: false }
    }

    /// Adds an upper end that belongs to the range.
    pub const fn to(self, high: f64) -> Self {
        Self { high, high_open: false, ..self }
    }

    /// Adds an upper end that does not belong to the range.
    pub const fn below(self, high: f64) -> Self {
        Self { high, high_open: true, ..self }
    }

    /// Returns the rule of numbers in this range and in a unit.
    pub const fn of(self, unit: Unit) -> Rule {
        Rule::new(self, unit)
    }

    /// Returns the upper end.
    pub const fn high(&self) -> f64 {
        self.high
    }

    /// Returns whether a value lies in the range.
    pub fn holds(&self, value: f64) -> bool {
        let above = if self.low_open { value > self.low } else { value >= self.low };
        let below = if self.high_open { value < self.high } else { value <= self.high };
        above && below
    }

    /// Puts the ends into the schema of a number.
    #[cfg(feature = "schema")]
    pub fn describe(&self, number: &mut serde_json::Map<String, serde_json::Value>) {
        let [low, high] = [
            if self.low_open { "exclusiveMinimum" } else { "minimum" },
            if self.high_open { "exclusiveMaximum" } else { "maximum" },
        ];
        number.remove("minimum");
        number.insert(low.to_owned(), self.low.into());
        number.insert(high.to_owned(), self.high.into());
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let low = if self.low_open { "greater than" } else { "at least" };
        let high = if self.high_open { "less than" } else { "at most" };
        write!(f, "{low} {} and {high} {}", Plain(self.low), Plain(self.high))
    }
}

/// A number in the shorter of the two notations.
pub struct Plain(pub f64);

/// A computed number for a message: nine digits, finer than any step, without what rounding leaves behind them.
pub fn rounded(value: f64) -> Plain {
    Plain(format!("{value:.8e}").parse().unwrap_or(value))
}

impl fmt::Display for Plain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if self.0 == u64::MAX as f64 {
            write!(f, "{}", u64::MAX)
        } else if size == 0.0 || !size.is_finite() || (1e-4..1e6).contains(&size) {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_messages_have_the_digits_that_they_need() {
        for (value, exact, short) in [
            (0.0005000000000000004, "0.0005000000000000004", "0.0005"),
            (0.1 + 0.2, "0.30000000000000004", "0.3"),
            (1e-300, "1e-300", "1e-300"),
            (5e-324, "5e-324", "5e-324"),
            (1.0 / 3e7, "3.3333333333333334e-8", "3.33333333e-8"),
            (-1e300, "-1e300", "-1e300"),
            (f64::NAN, "NaN", "NaN"),
            (0.0, "0", "0"),
        ] {
            assert_eq!([Plain(value).to_string(), rounded(value).to_string()], [exact, short], "{value:e}");
        }
    }
}
