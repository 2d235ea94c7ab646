//! Numbers as bytes that compress: single precision, split into planes of bytes of one weight.

/// Bytes of a number in a film.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Width {
    /// All of a single: relative error at most 2⁻²⁴.
    Full = 4,
    /// Without the last byte, rounded: relative error at most 2⁻¹⁶, so four decimal digits are right.
    Short = 3,
}

impl Width {
    /// A number as a reader will have it.
    pub fn kept(self, single: f32) -> f32 {
        match self {
            Self::Full => single,
            Self::Short => shortened(single),
        }
    }
}

/// A finite number in single precision; none when it is too large or not finite.
pub fn single(value: f64) -> Option<f32> {
    Some(value as f32).filter(|single| single.is_finite())
}

/// Rounds to the nearest single whose last byte is zero; a number next to the largest single is cut off there instead
/// of becoming infinite.
fn shortened(single: f32) -> f32 {
    let rounded = f32::from_bits(single.to_bits().wrapping_add(0x80) & !0xff);
    if rounded.is_finite() { rounded } else { f32::from_bits(single.to_bits() & !0xff) }
}

/// Appends numbers, bytes of one weight side by side, the lowest weight first.
pub fn push_planes(numbers: &[f32], width: Width, out: &mut Vec<u8>) {
    for plane in 4 - width as usize..4 {
        out.extend(numbers.iter().map(|&number| width.kept(number).to_le_bytes()[plane]));
    }
}

/// Appends an integer as bytes of seven bits, the lowest first, its sign in the lowest bit.
pub fn push_integer(value: i64, out: &mut Vec<u8>) {
    let mut rest = ((value << 1) ^ (value >> 63)) as u64;
    while rest >= 0x80 {
        out.push(rest as u8 | 0x80);
        rest >>= 7;
    }
    out.push(rest as u8);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_numbers_keep_four_digits() {
        for value in [1.0_f32, -9.80665, 1.234_567_9e-7, 8.765_432e9, -3.333_333_3e-30, f32::MAX, 0.0] {
            let error = (shortened(value) - value).abs();
            assert!(error <= value.abs() * 2f32.powi(-16), "{value}: {error}");
        }
    }

    #[test]
    fn planes_stand_lowest_weight_first() {
        let mut bytes = Vec::new();
        push_planes(&[1.0, -2.0], Width::Full, &mut bytes);
        assert_eq!(bytes, [0, 0, 0, 0, 0x80, 0, 0x3f, 0xc0]);
        bytes.clear();
        push_planes(&[1.0, -2.0], Width::Short, &mut bytes);
        assert_eq!(bytes, [0, 0, 0x80, 0, 0x3f, 0xc0]);
    }

    /// Zigzag by hand: 0, −1, 1, −2 are 0, 1, 2, 3; 64 is 128, the first that needs two bytes.
    #[test]
    fn small_integers_take_one_byte() {
        let coded = |value| {
            let mut bytes = Vec::new();
            push_integer(value, &mut bytes);
            bytes
        };
        assert_eq!([0, -1, 1, -2].map(coded), [[0], [1], [2], [3]]);
        assert_eq!(coded(64), [0x80, 0x01]);
        assert_eq!(coded(i64::MIN).len(), 10);
    }
}
