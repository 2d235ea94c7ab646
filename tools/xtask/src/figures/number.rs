//! Figures as documents write them: `0.05`, `−0.4532`, `7 151`, `2e-7`, `$10^{-3}h$`, `$2\times10^{-7}$`, `5 %`,
//! `eight`.

use std::ops::Range;

/// Numbers that documents write as words.
const WORDS: [(&str, f64); 20] = [
    ("one", 1.0),
    ("two", 2.0),
    ("three", 3.0),
    ("four", 4.0),
    ("five", 5.0),
    ("six", 6.0),
    ("seven", 7.0),
    ("eight", 8.0),
    ("nine", 9.0),
    ("ten", 10.0),
    ("eleven", 11.0),
    ("twelve", 12.0),
    ("twice", 2.0),
    ("twenty", 20.0),
    ("half", 0.5),
    ("quarter", 0.25),
    ("tenth", 0.1),
    ("hundredth", 0.01),
    ("thousandth", 1e-3),
    ("½", 0.5),
];
/// Spaces that stand between groups of three digits.
const SPACES: [char; 4] = [' ', '\u{a0}', '\u{2009}', '\u{202f}'];
/// A figure of at least so many digits is told to the last bit.
const ALL_DIGITS: usize = 16;

/// A figure in a text.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Where it stands, without the sign of per cent.
    pub at: Range<usize>,
    /// What it says.
    pub text: String,
    shape: Shape,
    percent: bool,
}

/// How a figure is written.
#[derive(Debug, Clone, PartialEq)]
enum Shape {
    Word,
    /// Decimals; the space between groups of three digits.
    Plain(usize, Option<char>),
    /// To the last bit.
    Bits,
    /// Decimals of what stands before the `e`.
    Exponent(usize),
    /// What stands between decimals and power of ten, and how many decimals; none without a factor.
    Power(Option<(usize, &'static str)>),
}

impl Figure {
    /// Whether it has the digits of a result: three decimals and three digits besides leading zeros.
    #[cfg(test)]
    pub fn is_result(&self) -> bool {
        let digits = self.text.trim_start_matches(['-', '−', '0', '.']).bytes().filter(u8::is_ascii_digit).count();
        digits >= 3 && matches!(self.shape, Shape::Plain(3.., _) | Shape::Bits)
    }

    /// Whether a value, rounded as the figure is, gives the figure.
    pub fn holds(&self, value: f64) -> bool {
        let is_word = self.shape == Shape::Word && WORDS.iter().any(|word| *word == (&*self.text, value));
        is_word || self.written(value) == self.text
    }

    /// A value in the manner of the figure.
    pub fn written(&self, value: f64) -> String {
        let value = if self.percent { 100.0 * value } else { value };
        let magnitude = self.shape.written(value.abs());
        let minus = if self.text.starts_with('-') { "-" } else { "−" };
        if value < 0.0 { format!("{minus}{magnitude}") } else { magnitude }
    }
}

impl Shape {
    /// A positive value.
    fn written(&self, value: f64) -> String {
        match *self {
            Self::Word => {
                WORDS.iter().find(|word| word.1 == value).map_or(format!("{value}"), |word| word.0.to_owned())
            }
            Self::Plain(decimals, space) => grouped(&format!("{value:.decimals$}"), space),
            Self::Bits => format!("{value}"),
            Self::Exponent(decimals) => format!("{value:.decimals$e}"),
            Self::Power(None) => {
                let text = format!("{value:e}");
                let (factor, exponent) = text.split_once('e').unwrap_or((&text, "0"));
                let factor = if factor == "1" { String::new() } else { format!("{factor}\\cdot") };
                format!("{factor}10^{{{exponent}}}")
            }
            Self::Power(Some((decimals, times))) => {
                format!("{value:.decimals$e}").replace('e', &format!("{times}10^{{")) + "}"
            }
        }
    }
}

/// Digits with a space between groups of three, decimals left as they are.
fn grouped(digits: &str, space: Option<char>) -> String {
    let whole = digits.find('.').unwrap_or(digits.len());
    let mut text = String::new();
    for (k, digit) in digits.char_indices() {
        if let Some(space) = space.filter(|_| k > 0 && k < whole && (whole - k).is_multiple_of(3)) {
            text.push(space);
        }
        text.push(digit);
    }
    text
}

/// All figures of a text, in their order.
pub fn figures(text: &str) -> Vec<Figure> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(next) = text[at..].chars().next() {
        let end = if next.is_ascii_digit() {
            let figure = number(text, at);
            let end = figure.at.end;
            found.push(figure);
            end
        } else if next.is_alphabetic() || next == '½' {
            word(text, at, &mut found)
        } else {
            at + next.len_utf8()
        };
        at = end;
    }
    found
}

/// End of the word at a place, which may be a figure. Digits belong to it (`C13`), but not those behind a command.
fn word(text: &str, at: usize, found: &mut Vec<Figure>) -> usize {
    let is_command = text[..at].ends_with('\\');
    let belongs = |c: char| c.is_alphabetic() || c == '½' || (!is_command && (c.is_ascii_digit() || c == '_'));
    let end = text[at..].find(|c| !belongs(c)).map_or(text.len(), |length| at + length);
    if !is_command && WORDS.iter().any(|word| word.0 == &text[at..end]) {
        found.push(Figure { at: at..end, text: text[at..end].to_owned(), shape: Shape::Word, percent: false });
    }
    end
}

/// The figure whose first digit stands at a place.
fn number(text: &str, first: usize) -> Figure {
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let mut end = first + digits(first);
    let mut space = None;
    while let Some(next) =
        text[end..].chars().next().filter(|c| SPACES.contains(c) && end - first <= 3 || space == Some(*c))
    {
        let group = end + next.len_utf8();
        if digits(group) != 3 {
            break;
        }
        (space, end) = (Some(next), group + 3);
    }
    let mut decimals = 0;
    if text[end..].starts_with('.') && digits(end + 1) > 0 {
        decimals = digits(end + 1);
        end += 1 + decimals;
    }
    let (shape, end) = shape(text, first..end, decimals, space);
    let start = sign(text, first);
    let percent = text[end..].trim_start_matches(SPACES).starts_with('%');
    Figure { at: start..end, text: text[start..end].to_owned(), shape, percent }
}

/// How the figure with these digits goes on, and where it ends.
fn shape(text: &str, digits: Range<usize>, decimals: usize, space: Option<char>) -> (Shape, usize) {
    let rest = &text[digits.end..];
    let power = |from: usize| rest[from..].find('}').map(|end| digits.end + from + end + 1);
    for times in ["\\cdot", "\\times"] {
        if let Some(end) = rest.starts_with(&format!("{times}10^{{")).then(|| power(0)).flatten() {
            return (Shape::Power(Some((decimals, times))), end);
        }
    }
    if let Some(end) = (&text[digits.clone()] == "10" && rest.starts_with("^{")).then(|| power(0)).flatten() {
        return (Shape::Power(None), end);
    }
    let exponent = rest.strip_prefix('e').map(|rest| rest.strip_prefix('-').unwrap_or(rest));
    if let Some(exponent) = exponent.filter(|exponent| exponent.starts_with(|c: char| c.is_ascii_digit())) {
        let length = exponent.bytes().take_while(u8::is_ascii_digit).count();
        return (Shape::Exponent(decimals), text.len() - exponent.len() + length);
    }
    let count = text[digits.clone()].trim_start_matches(['0', '.']).bytes().filter(u8::is_ascii_digit).count();
    (if count >= ALL_DIGITS { Shape::Bits } else { Shape::Plain(decimals, space) }, digits.end)
}

/// Where a figure begins whose first digit is given: before its minus, unless that stands between two things.
fn sign(text: &str, first: usize) -> usize {
    let before = &text[..first];
    let Some(rest) = before.strip_suffix(['-', '−']) else { return first };
    if rest.ends_with(|c: char| c.is_alphanumeric() || c == '}' || c == ')') { first } else { rest.len() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(text: &str) -> Vec<String> {
        figures(text).into_iter().map(|figure| figure.text).collect()
    }

    #[test]
    fn figures_are_found_in_every_manner() {
        assert_eq!(texts("less than 0.05 of C13, two 7 151 or 3e-5 x_2"), ["0.05", "two", "7 151", "3e-5"]);
        assert_eq!(
            texts(r"$10^{-3}h$, $3\cdot10^{-3}h$, $2\times10^{-7}$"),
            ["10^{-3}", r"3\cdot10^{-3}", r"2\times10^{-7}"]
        );
        assert_eq!(
            texts("(0.78, −0.4532) 355–413 2 000 blocks 12 4"),
            ["0.78", "−0.4532", "355", "413", "2 000", "12", "4"]
        );
        assert_eq!(texts(r"\tfrac1{10}\sqrt{H/g}"), ["1", "10"]);
    }

    #[test]
    fn values_are_written_as_the_figure_was() {
        let written = |text: &str, value: f64| figures(text)[0].written(value);
        assert_eq!(written("1.25 as", 1.25103), "1.25");
        assert_eq!(written("5 % of", 0.061), "6");
        assert_eq!(written("−0.45", 0.731), "0.73");
        assert_eq!(written("0.45", -0.731), "−0.73");
        assert_eq!(written("7 151 steps", 12003.0), "12 003");
        assert_eq!(written("200 000 rows", 5e5), "500 000");
        assert_eq!(written("2e-5 of", 3.2e-6), "3e-6");
        assert_eq!(written("$10^{-3}h$", 2e-3), r"2\cdot10^{-3}");
        assert_eq!(written("$10^{-3}h$", 1e-4), "10^{-4}");
        assert_eq!(written(r"$2\times10^{-7}$", 3e-6), r"3\times10^{-6}");
        assert_eq!(written("eight windows", 7.0), "seven");
        assert_eq!(written("eight windows", 70.0), "70");
        assert_eq!(written("0.00020068729793929223 m", -0.0005035289911694855), "−0.0005035289911694855");
    }

    #[test]
    fn a_figure_holds_what_rounds_to_it() {
        let holds = |text: &str, value: f64| figures(text)[0].holds(value);
        assert!(holds("1.25", 1.2511) && !holds("1.25", 1.2561));
        assert!(holds("10^{-3}", 1e-3) && !holds("10^{-3}", 1.1e-3));
        assert!(holds("0.7849806395284461", 0.7849806395284461) && !holds("0.7849806395284461", 0.7849806395284462));
    }
}
