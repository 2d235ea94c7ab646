//! The mathematical functions of the system, which verification problems use for their cases.
//!
//! Sums, products, quotients and roots are the same everywhere by IEEE 754, no operation is fused, and the sines and
//! exponentials of results come from `libm`. Those of the system differ in their last bits from version to version, and
//! from processor to processor where it picks among versions of its own.

use std::hint::black_box;

use sha1_smol::Sha1;

/// Arguments at which functions are evaluated.
const ARGUMENTS: u32 = 4096;

/// Functions of one argument, with how an argument from −10 to 10 comes to them.
type Function = (fn(f64) -> f64, fn(f64) -> f64);

const ONE: [Function; 14] = [
    (f64::sin, |x| x),
    (f64::cos, |x| x),
    (f64::tan, |x| x),
    (f64::asin, |x| 0.1 * x),
    (f64::acos, |x| 0.1 * x),
    (f64::atan, |x| x),
    (f64::sinh, |x| x),
    (f64::cosh, |x| x),
    (f64::tanh, |x| x),
    (f64::exp, |x| x),
    (f64::ln, |x| x.abs() + 1e-3),
    (f64::ln_1p, |x| 0.09 * x),
    (f64::log10, |x| x.abs() + 1e-3),
    (f64::cbrt, |x| x),
];
const TWO: [fn(f64, f64) -> f64; 3] = [f64::atan2, f64::hypot, |x, y| x.abs().powf(0.3 * y)];

/// Processor and system.
pub fn name() -> String {
    format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS)
}

/// Hash of what the functions give.
pub fn functions() -> String {
    let mut sum = Sha1::new();
    for (function, argument) in ONE {
        arguments().for_each(|x| sum.update(&function(black_box(argument(x))).to_bits().to_le_bytes()));
    }
    for function in TWO {
        let pairs = arguments().zip(arguments().skip(1));
        pairs.for_each(|(x, y)| sum.update(&function(black_box(x), black_box(y)).to_bits().to_le_bytes()));
    }
    sum.digest().to_string()
}

/// Numbers from −10 to 10 that fill the range evenly and end in many bits, without any function.
fn arguments() -> impl Iterator<Item = f64> {
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    (1..=ARGUMENTS).map(move |k| {
        let turns = golden * f64::from(k);
        20.0 * (turns - turns.floor()) - 10.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_have_the_same_hash_again() {
        assert_eq!(functions(), functions());
        assert!(arguments().all(|x| (-10.0..10.0).contains(&x)));
        assert!(arguments().any(|x| x < -9.9) && arguments().any(|x| x > 9.9));
    }
}
