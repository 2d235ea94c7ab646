//! Records of ground motion (accelerograms): piecewise linear in time, with exact means over a kick (Eq. 45).

/// Rows of time (s) and value, linear between and zero outside; a jump is the end of the rows.
#[doc(alias = "accelerogram")]
#[doc(alias = "time history")]
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Record(pub Vec<[f64; 2]>);

impl Record {
    /// Mean over `from`–`to` (s): the exact integral over the length (Eq. 45).
    pub fn mean(&self, from: f64, to: f64) -> f64 {
        let rows = &self.0;
        let first = rows.partition_point(|row| row[0] <= from).saturating_sub(1);
        let pieces = rows[first..].windows(2).take_while(|piece| piece[0][0] < to);
        let integral: f64 = pieces.map(|piece| integral(piece[0], piece[1], from, to)).sum();
        integral / (to - from)
    }

    /// Mean rate over `from`–`to` (s) of values that keep their last one for ever (Eq. 45).
    pub fn mean_rate(&self, from: f64, to: f64) -> f64 {
        (self.kept(to) - self.kept(from)) / (to - from)
    }

    /// Value at `t` (s), zero before the rows and the last one after them.
    fn kept(&self, t: f64) -> f64 {
        let rows = &self.0;
        match (rows.partition_point(|row| row[0] <= t), rows.last()) {
            (0, _) | (_, None) => 0.0,
            (after, Some(last)) if after == rows.len() => last[1],
            (after, _) => value(rows[after - 1], rows[after], t),
        }
    }
}

/// Value at `t` (s) on the line through two rows.
fn value(a: [f64; 2], b: [f64; 2], t: f64) -> f64 {
    a[1] + (b[1] - a[1]) * (t - a[0]) / (b[0] - a[0])
}

/// Integral over the part of `from`–`to` between two rows.
fn integral(a: [f64; 2], b: [f64; 2], from: f64, to: f64) -> f64 {
    let (low, high) = (from.max(a[0]), to.min(b[0]));
    (high - low).max(0.0) * value(a, b, 0.5 * (low + high))
}
