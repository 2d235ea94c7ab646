//! Digits of numbers as readers want them, in pictures and on paper.

/// A number in three significant digits, such as `94.6`, `1.44`, `2510`; the rounded number where it needs a power of
/// ten.
///
/// # Errors
/// The number, rounded to three digits, is below 1e-4 or at least 1e7 in size.
pub fn three_digits(value: f64) -> Result<String, f64> {
    // Rounding first keeps 9.996 from becoming 10.00.
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    if rounded == 0.0 || !rounded.is_finite() {
        return Ok(with_minus(&format!("{}", rounded + 0.0)));
    }
    let exponent = libm::log10(rounded.abs() * (1.0 + 1e-12)).floor() as i32;
    if !(-4..7).contains(&exponent) {
        return Err(rounded);
    }
    Ok(with_minus(&format!("{rounded:.*}", (2 - exponent).max(0) as usize)))
}

/// A number with the sign for minus instead of a hyphen.
pub fn with_minus(number: &str) -> String {
    number.replace('-', "−")
}

/// A whole number in raised digits.
pub fn superscript(value: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |letter: char| letter.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]);
    value.to_string().chars().map(raised).collect()
}
