//! Tests of orientations from the field.

mod means;
mod recovered;
mod tables;

/// Draws that do not share our code.
mod drawn {
    /// Numbers between 0 and 1 (G. Marsaglia, Xorshift RNGs, 2003).
    pub struct Dice(u64);

    impl Dice {
        pub fn new(seed: u64) -> Self {
            Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
        }

        pub fn roll(&mut self) -> f64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            (self.0 >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    /// A direction of Fisher's distribution about a mean: the cosine by the inverse of its distribution, the azimuth
    /// uniform, in a frame beside the mean.
    pub fn fisher(mean: [f64; 3], kappa: f64, dice: &mut Dice) -> [f64; 3] {
        let u = dice.roll();
        let cos = 1.0 + (u + (1.0 - u) * (-2.0 * kappa).exp()).ln() / kappa;
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        let turn = 2.0 * std::f64::consts::PI * dice.roll();
        let beside = if mean[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let first = cross(mean, beside);
        let length = first.iter().map(|part| part * part).sum::<f64>().sqrt();
        let first = first.map(|part| part / length);
        let second = cross(mean, first);
        [0, 1, 2].map(|k| cos * mean[k] + sin * (turn.cos() * first[k] + turn.sin() * second[k]))
    }

    /// The unit vector of a pole by trend and plunge (degrees), by hand: east, north, down.
    pub fn pole(trend: f64, plunge: f64) -> [f64; 3] {
        let (t, p) = (trend.to_radians(), plunge.to_radians());
        [p.cos() * t.sin(), p.cos() * t.cos(), p.sin()]
    }

    pub fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
        let cos: f64 = (0..3).map(|k| a[k] * b[k]).sum();
        cos.abs().min(1.0).acos().to_degrees()
    }

    /// Downwards, as a compass reads it: the axis keeps no sense.
    pub fn down(pole: [f64; 3]) -> [f64; 3] {
        if pole[2] < 0.0 { pole.map(|part| -part) } else { pole }
    }
}
