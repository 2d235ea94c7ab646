//! Acceleration over time, and its pieces.

/// Why rows are no accelerogram.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Unusable {
    /// Too few rows.
    #[error("has {0} rows of acceleration, must have at least 2")]
    Rows(usize),
    /// A number that is none, or a time that does not come later than the one before.
    #[error("row {0} of the acceleration must be of finite numbers, and later than the row before")]
    Row(usize),
}

/// Acceleration (m/s²) over time (s), straight between its points and 0 before and after them.
#[derive(Debug, Clone, PartialEq)]
pub struct Accelerogram {
    points: Vec<[f64; 2]>,
}

impl Accelerogram {
    /// Takes rows of time (s) and acceleration (m/s²).
    ///
    /// # Errors
    /// Fewer than two rows, numbers that are not finite, or times that do not grow.
    pub fn new(points: Vec<[f64; 2]>) -> Result<Self, Unusable> {
        if points.len() < 2 {
            return Err(Unusable::Rows(points.len()));
        }
        let is_wrong = |k: &usize| {
            let [time, value] = points[*k];
            !time.is_finite() || !value.is_finite() || (*k > 0 && time <= points[k - 1][0])
        };
        match (0..points.len()).find(is_wrong) {
            Some(k) => Err(Unusable::Row(k)),
            None => Ok(Self { points }),
        }
    }

    /// The mean accelerations between rows of time (s) and velocity (m/s), each in the middle of its two rows.
    ///
    /// # Errors
    /// As [`Accelerogram::new`], of at least three rows.
    pub fn of_velocity(rows: &[[f64; 2]]) -> Result<Self, Unusable> {
        let mean = |two: &[[f64; 2]]| {
            let [[t, v], [t_next, v_next]] = [two[0], two[1]];
            [0.5 * (t + t_next), (v_next - v) / (t_next - t)]
        };
        Self::new(rows.windows(2).map(mean).collect())
    }

    /// The accelerations times a factor.
    pub fn times(&self, factor: f64) -> Self {
        Self { points: self.points.iter().map(|[time, value]| [*time, factor * value]).collect() }
    }

    /// Rows of time (s) and acceleration (m/s²).
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Velocity (m/s) and displacement (m) at a time (s), from rest at the first point.
    pub fn motion_at(&self, time: f64) -> [f64; 2] {
        let mut motion = Motion::default();
        for piece in self.pieces().take_while(|piece| piece.start < time) {
            motion = piece.moved(motion, piece.length.min(time - piece.start));
        }
        let last = self.points.last().map_or(time, |point| point[0]);
        [motion.velocity, motion.displacement + motion.velocity * (time - last).max(0.0)]
    }

    /// Its straight pieces, one after the other.
    pub(crate) fn pieces(&self) -> impl Iterator<Item = Piece> {
        self.points.windows(2).map(|two| {
            let [[start, first], [end, last]] = [two[0], two[1]];
            Piece { start, length: end - start, first, rate: (last - first) / (end - start) }
        })
    }
}

/// Acceleration that changes evenly for some time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// When it begins (s).
    pub start: f64,
    /// How long it lasts (s).
    pub length: f64,
    /// Acceleration at its start (m/s²).
    pub first: f64,
    /// Rate of the acceleration (m/s³).
    pub rate: f64,
}

/// Velocity (m/s) and displacement (m).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Motion {
    /// Velocity (m/s).
    pub velocity: f64,
    /// Displacement (m).
    pub displacement: f64,
}

impl Piece {
    /// Acceleration (m/s²) after a time (s) in it.
    pub fn at(&self, since: f64) -> f64 {
        self.first + self.rate * since
    }

    /// Motion after a time (s) in it.
    pub fn moved(&self, from: Motion, since: f64) -> Motion {
        let velocity = from.velocity + since * (self.first + 0.5 * self.rate * since);
        let displacement =
            from.displacement + since * (from.velocity + since * (0.5 * self.first + self.rate * since / 6.0));
        Motion { velocity, displacement }
    }

    /// Time (s) in it at which the acceleration passes through 0.
    pub fn turn(&self) -> Option<f64> {
        let since = -self.first / self.rate;
        (since > 0.0 && since < self.length).then_some(since)
    }

    /// Times (s) in it at which the velocity is 0, the earlier first.
    pub fn stops(&self, from: Motion) -> impl Iterator<Item = f64> {
        let [a, b, c] = [0.5 * self.rate, self.first, from.velocity];
        let root = (b * b - 4.0 * a * c).max(0.0).sqrt();
        // The root that does not cancel, and the other one by their product.
        let q = -0.5 * (b + root.copysign(b));
        let real = b * b >= 4.0 * a * c;
        let (one, other) = (q / a, c / q);
        let both = if one <= other { [one, other] } else { [other, one] };
        let length = self.length;
        both.into_iter().filter(move |since| real && *since > 0.0 && *since <= length)
    }
}
