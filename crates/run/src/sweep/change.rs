//! A key with the values that it takes in a sweep.

use enmm_ensemble::Value;

/// Most values of a key.
const COUNT_MAX: usize = 10_000;
/// Above it not every whole number is one of a `f64`.
const WHOLE_MAX: f64 = 9_007_199_254_740_992.0;
/// An example in messages.
const EXAMPLE: &str = "write KEY=FIRST:LAST:COUNT or KEY=VALUE,VALUE, as in joint_law.plane.friction_deg=20:40:11";

/// A key with its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// The key.
    pub key: String,
    /// Its values, ascending, each once.
    pub values: Vec<Value>,
}

impl Change {
    /// Reads `KEY=FIRST:LAST:COUNT`, so many values at equal distances, or `KEY=VALUE,VALUE`.
    ///
    /// # Errors
    /// The text is neither, a value is no number or occurs twice, or the count is none.
    pub fn parse(text: &str) -> Result<Self, String> {
        let Some((key, values)) = text.split_once('=').filter(|(key, _)| !key.trim().is_empty()) else {
            return Err(format!("{text}: is no key with values; {EXAMPLE}"));
        };
        let failed = |message: String| format!("{text}: {message}");
        let parts: Vec<&str> = values.split(':').collect();
        let mut values = match parts[..] {
            [list] => list.split(',').map(value).collect::<Result<Vec<_>, _>>().map_err(failed)?,
            [first, last, count] => range(first, last, count).map_err(failed)?,
            _ => return Err(failed(format!("has {} parts between colons, must have 3; {EXAMPLE}", parts.len()))),
        };
        values.sort_by(|a, b| a.number().total_cmp(&b.number()));
        if let Some(pair) = values.windows(2).find(|pair| pair[0].number() == pair[1].number()) {
            return Err(failed(format!("has the value {} twice; give each value once", pair[0])));
        }
        Ok(Self { key: key.trim().to_owned(), values })
    }
}

/// A whole number as such, since seeds and counts take no others.
fn value(text: &str) -> Result<Value, String> {
    let text = text.trim();
    if let Ok(whole) = text.parse() {
        return Ok(Value::Whole(whole));
    }
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(as_value(number)),
        _ => Err(format!("the value {text:?} is no number; {EXAMPLE}")),
    }
}

fn as_value(number: f64) -> Value {
    let is_whole = libm::floor(number) == number && (0.0..WHOLE_MAX).contains(&number);
    if is_whole { Value::Whole(number as u64) } else { Value::Number(number) }
}

fn range(first: &str, last: &str, count: &str) -> Result<Vec<Value>, String> {
    let [first, last] = [value(first)?.number(), value(last)?.number()];
    let n = count.trim().parse::<usize>().ok().filter(|n| (2..=COUNT_MAX).contains(n));
    let n =
        n.ok_or_else(|| format!("the count {count:?} must be a whole number of at least 2 and at most {COUNT_MAX}"))?;
    let between = |k: usize| (first * (n - 1 - k) as f64 + last * k as f64) / (n - 1) as f64;
    Ok((0..n).map(|k| as_value(if k + 1 == n { last } else { between(k) })).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<String> {
        Change::parse(text).expect(text).values.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn ranges_and_lists_have_the_numbers_that_one_expects() {
        assert_eq!(values("a.b=20:40:5"), ["20", "25", "30", "35", "40"]);
        assert_eq!(values("a=0.1:0.5:5"), ["0.1", "0.2", "0.3", "0.4", "0.5"]);
        assert_eq!(values("a=0.5:-0.5:3"), ["-0.5", "0", "0.5"]);
        assert_eq!(values("joint_set[0].seed=7, 3,18446744073709551615"), ["3", "7", "18446744073709551615"]);
        assert_eq!(values("a=25e3,1.5"), ["1.5", "25000"]);
    }

    #[test]
    fn what_is_no_change_is_refused_by_its_text() {
        for (text, message) in [
            ("a", "a: is no key with values; write KEY=FIRST:LAST:COUNT"),
            ("=1,2", "is no key with values"),
            ("a=", "the value \"\" is no number"),
            ("a=1,x", "a=1,x: the value \"x\" is no number"),
            ("a=1:2", "has 2 parts between colons, must have 3"),
            ("a=1:2:1", "the count \"1\" must be a whole number of at least 2 and at most 10000"),
            ("a=1:inf:3", "the value \"inf\" is no number"),
            ("a=2:2:3", "has the value 2 twice"),
            ("a=1,2,1.0", "has the value 1 twice"),
        ] {
            let refused = Change::parse(text).expect_err(text);
            assert!(refused.contains(message), "{refused}");
        }
    }
}
