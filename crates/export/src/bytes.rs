//! Numbers of films and frames, one after the other; none where it ends too early.

/// Bytes that are left.
pub struct Bytes<'a>(pub &'a [u8]);

impl<'a> Bytes<'a> {
    /// The next bytes.
    pub fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(taken)
    }

    /// A whole number of four bytes.
    pub fn u32(&mut self) -> Option<u32> {
        Some(u32::from_le_bytes(self.take(4)?.try_into().ok()?))
    }

    /// A whole number of eight bytes.
    pub fn word(&mut self) -> Option<u64> {
        Some(u64::from_le_bytes(self.take(8)?.try_into().ok()?))
    }

    /// A double.
    pub fn f64(&mut self) -> Option<f64> {
        Some(f64::from_le_bytes(self.take(8)?.try_into().ok()?))
    }

    /// Singles whose bytes of one weight stand side by side, the lowest of `width` first.
    pub fn planes(&mut self, count: usize, width: usize) -> Option<Vec<f64>> {
        let planes = self.take(count.checked_mul(width)?)?;
        let number = |k: usize| {
            let mut bytes = [0; 4];
            (0..width).for_each(|plane| bytes[4 - width + plane] = planes[plane * count + k]);
            f64::from(f32::from_le_bytes(bytes))
        };
        Some((0..count).map(number).collect())
    }

    /// Places (m) that are stored as seen from an origin (m), all x before all y.
    pub fn places(&mut self, count: usize, width: usize, origin: [f64; 2]) -> Option<Vec<[f64; 2]>> {
        let (x, y) = (self.planes(count, width)?, self.planes(count, width)?);
        Some(x.iter().zip(y).map(|(x, y)| [origin[0] + x, origin[1] + y]).collect())
    }

    /// A whole number in bytes of seven bits, its sign in the lowest bit.
    pub fn integer(&mut self) -> Option<i64> {
        let mut value = 0_u64;
        for shift in (0..64).step_by(7) {
            let byte = self.take(1)?[0];
            value |= u64::from(byte & 127) << shift;
            if byte < 128 {
                return Some((value >> 1) as i64 ^ -((value & 1) as i64));
            }
        }
        None
    }
}
