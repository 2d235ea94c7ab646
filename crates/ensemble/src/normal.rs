//! The normal distribution: probability and quantile. Elementary functions alone, in a fixed order, so that other
//! programs on the same mathematical library get the same bits; `_normal.py` of the Python package does.

use std::f64::consts::PI;

/// Numerator for |p − ½| ≤ 0.425, in 0.180625 − (p − ½)²; the highest power first.
const MIDDLE_ABOVE: [f64; 8] = [
    2509.0809287301227,
    33430.57558358813,
    67265.7709270087,
    45921.95393154987,
    13731.69376550946,
    1971.5909503065513,
    133.14166789178438,
    3.3871328727963665,
];
/// Denominator.
const MIDDLE_BELOW: [f64; 8] = [
    5226.495278852854,
    28729.085735721943,
    39307.89580009271,
    21213.794301586597,
    5394.196021424751,
    687.1870074920579,
    42.31333070160091,
    1.0,
];
/// Numerator for √(−ln p) ≤ 5, in that less 1.6; the highest power first.
const SHOULDER_ABOVE: [f64; 8] = [
    0.0007745450142783414,
    0.022723844989269184,
    0.2417807251774506,
    1.2704582524523684,
    3.6478483247632045,
    5.769497221460691,
    4.630337846156546,
    1.4234371107496835,
];
/// Denominator.
const SHOULDER_BELOW: [f64; 8] = [
    1.0507500716444169e-9,
    0.0005475938084995345,
    0.015198666563616457,
    0.14810397642748008,
    0.6897673349851,
    1.6763848301838038,
    2.053191626637759,
    1.0,
];
/// Numerator for √(−ln p) > 5, in that less 5; the highest power first.
const TAIL_ABOVE: [f64; 8] = [
    2.0103343992922881e-7,
    2.7115555687434876e-5,
    0.0012426609473880784,
    0.026532189526576124,
    0.29656057182850487,
    1.7848265399172913,
    5.463784911164114,
    6.657904643501103,
];
/// Denominator.
const TAIL_BELOW: [f64; 8] = [
    2.0442631033899397e-15,
    1.421511758316446e-7,
    1.8463183175100548e-5,
    0.0007868691311456133,
    0.014875361290850615,
    0.1369298809227358,
    0.599832206555888,
    1.0,
];
/// Beyond this the continued fraction is used, which keeps the digits of small probabilities.
const FAR: f64 = 2.0;
/// Depth of the continued fraction: it has all digits from 44 on where it is used.
const DEPTH: u32 = 100;

/// Probability of a standard normal variable below `z`: the series of G. Marsaglia, Evaluating the normal distribution,
/// J. Stat. Software 11(4), 2004, and far from the mean the continued fraction of Laplace.
pub fn probability(z: f64) -> f64 {
    let density = (-0.5 * (z * z)).exp() / (2.0 * PI).sqrt();
    if z.abs() <= FAR {
        let (mut term, mut sum, mut k) = (z, z, 1.0);
        loop {
            k += 2.0;
            term = term * (z * z) / k;
            if sum + term == sum {
                return 0.5 + sum * density;
            }
            sum += term;
        }
    }
    let size = z.abs();
    let fraction = (1..=DEPTH).rev().fold(size, |below, k| size + f64::from(k) / below);
    let beyond = density / fraction;
    if z < 0.0 { beyond } else { 1.0 - beyond }
}

/// The value below which a standard normal variable is with the probability `p`: algorithm AS 241, M. J. Wichura, The
/// percentage points of the normal distribution, Applied Statistics 37(3), 1988.
pub fn quantile(p: f64) -> f64 {
    let q = p - 0.5;
    if q.abs() <= 0.425 {
        let r = 0.180625 - q * q;
        return horner(&MIDDLE_ABOVE, r) * q / horner(&MIDDLE_BELOW, r);
    }
    let r = if q <= 0.0 { p } else { 1.0 - p };
    let r = (-r.ln()).sqrt();
    let size = if r <= 5.0 {
        horner(&SHOULDER_ABOVE, r - 1.6) / horner(&SHOULDER_BELOW, r - 1.6)
    } else {
        horner(&TAIL_ABOVE, r - 5.0) / horner(&TAIL_BELOW, r - 5.0)
    };
    if q < 0.0 { -size } else { size }
}

fn horner(factors: &[f64; 8], x: f64) -> f64 {
    factors[1..].iter().fold(factors[0], |sum, factor| sum * x + factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against `norm.cdf` of scipy 1.17.
    #[test]
    fn probabilities_have_all_digits_also_in_the_tail() {
        let cases = [
            (0.0, 0.5),
            (1.0, 0.841_344_746_068_542_9),
            (-1.0, 0.158_655_253_931_457_05),
            (-2.0, 0.022_750_131_948_179_195),
            (-3.0, 1.349_898_031_630_093_3e-3),
            (-6.0, 9.865_876_450_376_946e-10),
            (-10.0, 7.619_853_024_160_47e-24),
        ];
        for (z, p) in cases {
            assert!((probability(z) / p - 1.0).abs() < 2e-14, "{z}: {} {p}", probability(z));
        }
        assert_eq!(probability(-60.0), 0.0);
    }

    #[test]
    fn quantile_and_probability_are_inverse() {
        for p in [1e-300, 1e-12, 1e-3, 0.02, 0.07, 0.3, 0.5, 0.6, 0.93, 0.99] {
            assert!((probability(quantile(p)) / p - 1.0).abs() < 1e-12, "{p}");
        }
    }
}
