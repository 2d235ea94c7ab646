//! Numbers and tables as text, for terminals and documents.

use crate::record::{ProblemRecord, RowRecord, ToleranceKind};

/// A number in at most `digits` significant digits, without trailing zeros: `0.1075`, `1.2e-5`.
pub fn number(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{}", value + 0.0);
    }
    let rounded = format!("{:.*e}", digits.saturating_sub(1), value);
    let (mantissa, exponent) = rounded.split_once('e').unwrap_or((&rounded, "0"));
    let exponent: i32 = exponent.parse().unwrap_or_default();
    if (-3..7).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        return trimmed(&format!("{value:.decimals$}")).to_owned();
    }
    format!("{}e{exponent}", trimmed(mantissa))
}

/// Without trailing zeros of a decimal fraction.
fn trimmed(number: &str) -> &str {
    if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number }
}

/// A value with its unit, in seven digits; `no number` where it is none.
pub fn quantity(value: Option<f64>, unit: &str) -> String {
    value.map_or_else(|| "no number".to_owned(), |value| with_unit(&number(value, 7), unit))
}

fn with_unit(number: &str, unit: &str) -> String {
    let space = if unit.is_empty() || unit == "°" { "" } else { " " };
    format!("{number}{space}{unit}")
}

/// The error of a row: relative as a bare number, absolute with the unit.
pub fn error(row: &RowRecord) -> String {
    let (Some(computed), Some(exact), Some(error)) = (row.computed, row.exact, row.error) else {
        return "–".to_owned();
    };
    match row.judged {
        ToleranceKind::Absolute => with_unit(&number(computed - exact, 2), &row.unit),
        ToleranceKind::AtMost => with_unit(&number(computed, 2), &row.unit),
        _ if exact == 0.0 => with_unit(&number(error, 2), &row.unit),
        _ => number(error, 2),
    }
}

/// The tolerance of a row.
pub fn tolerance(row: &RowRecord) -> String {
    let value = row.tolerance.map_or_else(|| "–".to_owned(), |t| number(t, 3));
    match row.judged {
        ToleranceKind::Relative => format!("{value} rel."),
        ToleranceKind::Absolute => with_unit(&value, &row.unit),
        ToleranceKind::AtMost => format!("at most {}", with_unit(&value, &row.unit)),
        ToleranceKind::Shown => "shown only".to_owned(),
    }
}

/// `pass`, `MISSED` or, where nothing is judged, `–`.
pub fn verdict(row: &RowRecord) -> &'static str {
    match (row.pass, row.judged) {
        (false, _) => "MISSED",
        (true, ToleranceKind::Shown) => "–",
        (true, _) => "pass",
    }
}

/// `a_deg = 30°, k = 0.3`.
pub fn parameters(problem: &ProblemRecord) -> String {
    let values = problem.parameters.iter().map(|p| format!("{} = {}", p.name, with_unit(&number(p.value, 9), &p.unit)));
    values.collect::<Vec<_>>().join(", ")
}

/// A problem as lines for a terminal: computed, exact, error, tolerance, verdict.
pub fn table(problem: &ProblemRecord) -> String {
    let mut lines = vec![format!("{}  {}", problem.id, problem.title)];
    if !problem.parameters.is_empty() {
        lines.push(format!("    {}", parameters(problem)));
    }
    let head = ["", "computed", "exact", "error", "tolerance", ""].map(str::to_owned);
    let cells = |row: &RowRecord| {
        let [computed, exact] = [row.computed, row.exact].map(|value| quantity(value, &row.unit));
        [row.quantity.clone(), computed, exact, error(row), tolerance(row), verdict(row).to_owned()]
    };
    let rows: Vec<[String; 6]> = std::iter::once(head).chain(problem.rows.iter().map(cells)).collect();
    if rows.len() > 1 {
        lines.extend(columns(&rows).into_iter().map(|line| format!("    {line}")));
    }
    let reasons =
        problem.missed().map(|row| format!("    MISSED {}: the tolerance is for: {}", row.quantity, row.reason));
    lines.extend(reasons);
    let wall = problem.wall.map_or_else(String::new, |wall| format!(", {wall:.1} s"));
    lines.push(match &problem.trouble {
        Some(trouble) => format!("    FAILED{wall}: {trouble}"),
        None if problem.passed => format!("    passed{wall}"),
        None => format!("    FAILED{wall}"),
    });
    lines.join("\n")
}

/// Rows of cells with the columns lined up: the first to the left, the others to the right.
fn columns(rows: &[[String; 6]]) -> Vec<String> {
    let width = |k: usize| rows.iter().map(|row| row[k].chars().count()).max().unwrap_or_default();
    let widths: Vec<usize> = (0..6).map(width).collect();
    let cell = |k: usize, text: &str| {
        let room = " ".repeat(widths[k] - text.chars().count());
        if k == 0 { format!("{text}{room}") } else { format!("{room}{text}") }
    };
    let line = |row: &[String; 6]| (0..6).map(|k| cell(k, &row[k])).collect::<Vec<_>>().join("  ");
    rows.iter().map(|row| line(row).trim_end().to_owned()).collect()
}

/// A text in lines of at most `width` characters.
pub fn wrapped(text: &str, width: usize) -> String {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_keep_their_digits() {
        let cases = [
            (0.1075, 7, "0.1075"),
            (16.144_012_3, 7, "16.14401"),
            (1.2e-5, 2, "1.2e-5"),
            (-3e9, 3, "-3e9"),
            (0.0, 3, "0"),
            (1e6, 7, "1000000"),
            (999.999_999, 3, "1000"),
            (9.999e-4, 2, "0.001"),
        ];
        for (value, digits, text) in cases {
            assert_eq!(number(value, digits), text);
        }
        assert_eq!(number(f64::NAN, 3), "NaN");
    }

    #[test]
    fn texts_wrap_at_words() {
        assert_eq!(wrapped("a bb  ccc d", 4), "a bb\nccc\nd");
    }
}
