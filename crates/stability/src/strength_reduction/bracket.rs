//! Which factors are tried: one far below, a pair about the factor that limit analysis foretells, wider and wider steps
//! away from it until the limit lies between two of them, then thirds.

use super::{End, Verdict};

/// Ratio of neighbouring trials where nothing foretells the limit, and the greatest one.
pub const STRIDE: f64 = 1.5;
/// Share of the first pair's ratio by which it begins below what limit analysis foretells: blocks that give way have a
/// little less than rigid ones.
const BELOW: f64 = 0.8;

/// The first pair of factors: the given limits, a pair about a factor that is foretold within some ratio, or the
/// strength of the case and less.
pub fn start(limits: [Option<f64>; 2], foretold: Option<[f64; 2]>, range: [f64; 2]) -> [f64; 2] {
    let [low, high] = limits;
    let foretold = foretold.filter(|[factor, _]| (range[0]..range[1]).contains(factor));
    if let ([None, None], Some([factor, ratio])) = (limits, foretold) {
        let first = (factor * libm::pow(ratio, -BELOW)).max(range[0]);
        let spans_one = first < 1.0 && 1.0 < first * ratio;
        // Whether the slope stands at its own strength is found, however wide the bracket is.
        return match (spans_one, factor < 1.0) {
            (true, true) => [1.0 / ratio, 1.0],
            (true, false) => [1.0, ratio],
            (false, _) => [first, (first * ratio).min(range[1])],
        };
    }
    let first = low.unwrap_or_else(|| 1f64.clamp(range[0], (high.unwrap_or(range[1]) / STRIDE).max(range[0])));
    let second = high.unwrap_or(STRIDE * first);
    [first, second.clamp(first, range[1]).max(first)]
}

/// A search in progress.
#[derive(Debug, Clone)]
pub struct Search {
    /// Least and greatest factor.
    pub range: [f64; 2],
    tolerance: f64,
    /// The first pair, until it is tried.
    start: Option<[f64; 2]>,
    /// Ratio of the next trial beyond all that were made.
    stride: f64,
    tried: Vec<(f64, Verdict)>,
}

impl Search {
    /// Begins with a pair of factors; keeps within `range`.
    pub fn new(start: [f64; 2], range: [f64; 2], tolerance: f64) -> Self {
        let stride = (start[1] / start[0]).clamp(1.0 + tolerance, STRIDE);
        Self { range, tolerance, start: Some(start), stride, tried: Vec::new() }
    }

    /// A search in the same range to the same tolerance that begins with another pair.
    pub fn again(&self, start: [f64; 2]) -> Self {
        Self::new(start, self.range, self.tolerance)
    }

    /// A factor below all that are tried first, by the greatest stride; none beyond the range.
    pub fn lead(&self) -> Option<f64> {
        self.start.map(|[first, _]| first / STRIDE).filter(|lead| *lead >= self.range[0])
    }

    /// Begins at a factor and below it, instead of above.
    pub fn begin_at(&mut self, factor: f64) {
        self.start = Some([(factor / self.stride).max(self.range[0]), factor]);
    }

    /// Number of verdicts so far.
    pub fn made(&self) -> usize {
        self.tried.len()
    }

    /// Keeps a verdict.
    pub fn note(&mut self, factor: f64, verdict: Verdict) {
        self.tried.push((factor, verdict));
    }

    /// Greatest stable factor below every other, and the least that is not stable.
    pub fn bracket(&self) -> [Option<f64>; 2] {
        let of = |stable: bool| self.tried.iter().filter(move |t| (t.1 == Verdict::Stable) == stable).map(|t| t.0);
        let high = of(false).reduce(f64::min);
        let low = of(true).filter(|f| high.is_none_or(|high| *f < high)).reduce(f64::max);
        [low, high]
    }

    /// How many trials there will be, as far as it is known: as many as the bracket needs that is known, or that the
    /// next pair may find.
    pub fn expected(&self) -> usize {
        let width = match self.bracket() {
            [Some(low), Some(high)] => high / low,
            _ => self.stride,
        };
        let thirds = libm::log((libm::log(width) / libm::log1p(self.tolerance)).max(1.0)) / libm::log(3.0);
        let pair = if self.start.is_some() { 2 } else { 0 };
        self.tried.len() + pair + 2 * (thirds - 1e-9).ceil().max(0.0) as usize
    }

    /// One or two factors to try next; none when the search is over.
    pub fn next(&mut self) -> Option<(f64, Option<f64>)> {
        if let Some([a, b]) = self.start.take() {
            return Some((a, (b > a).then_some(b)));
        }
        match self.bracket() {
            [Some(low), Some(high)] if high / low - 1.0 > self.tolerance => Some(thirds(low, high, self.tolerance)),
            [Some(_), Some(_)] | [None, None] => None,
            [Some(low), None] => beyond(low, (low * self.lengthen()).min(self.range[1])),
            [None, Some(high)] => beyond(high, (high / self.lengthen()).max(self.range[0])),
        }
    }

    /// The ratio of the next step away from all trials; each is the square of the one before, up to the greatest.
    fn lengthen(&mut self) -> f64 {
        let stride = self.stride;
        self.stride = (stride * stride).min(STRIDE);
        stride
    }

    /// How a search that is over ended.
    pub fn end(&self) -> End {
        match self.bracket() {
            [Some(_), Some(_)] => End::Found,
            [Some(_), None] => End::StableThroughout,
            _ => End::UnstableThroughout,
        }
    }
}

/// Two factors that part a bracket in three, or its middle when that is enough.
fn thirds(low: f64, high: f64, tolerance: f64) -> (f64, Option<f64>) {
    let ratio = high / low;
    if ratio.sqrt() - 1.0 <= tolerance {
        return (low * ratio.sqrt(), None);
    }
    (low * libm::cbrt(ratio), Some(low * libm::cbrt(ratio).powi(2)))
}

/// The factor further on; none at the limit.
fn beyond(from: f64, next: f64) -> Option<(f64, Option<f64>)> {
    (next != from).then_some((next, None))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Searches for a limit; returns the number of trials, the bracket and the end.
    fn find(limit: f64, start: [f64; 2], range: [f64; 2]) -> (usize, [Option<f64>; 2], End) {
        let mut search = Search::new(start, range, 5e-3);
        let verdict = |f: f64| if f <= limit { Verdict::Stable } else { Verdict::Unstable };
        while let Some((a, b)) = search.next() {
            for f in std::iter::once(a).chain(b) {
                search.note(f, verdict(f));
            }
        }
        (search.tried.len(), search.bracket(), search.end())
    }

    #[test]
    fn every_limit_in_range_is_bracketed_to_the_tolerance() {
        for k in 0..200 {
            let limit = 0.06 * 1.029f64.powi(k);
            let (count, bracket, end) = find(limit, [1.0, 1.5], [0.05, 20.0]);
            let [Some(low), Some(high)] = bracket else { panic!("{limit}: {bracket:?}") };
            assert!(low <= limit && limit < high && high / low - 1.0 <= 5e-3, "{limit}: {low} {high}");
            assert!(end == End::Found && count <= 20, "{limit}: {count} trials");
        }
    }

    #[test]
    fn a_caught_slope_is_not_borne() {
        let mut search = Search::new([1.0, 1.5], [0.05, 20.0], 5e-3);
        search.note(1.0, Verdict::Stable);
        search.note(1.5, Verdict::Caught);
        assert_eq!(search.bracket(), [Some(1.0), Some(1.5)]);
    }

    #[test]
    fn the_expected_number_of_trials_is_about_that_of_the_search() {
        let mut search = Search::new([1.0, 1.5], [0.05, 20.0], 5e-3);
        let first = search.expected();
        while let Some((a, b)) = search.next() {
            for f in std::iter::once(a).chain(b) {
                search.note(f, if f <= 1.23 { Verdict::Stable } else { Verdict::Unstable });
            }
        }
        let made = search.tried.len();
        assert!(first.abs_diff(made) <= 2 && search.expected() == made, "{first}, {made}, {}", search.expected());
    }

    #[test]
    fn a_limit_beyond_the_range_is_told() {
        assert_eq!(find(100.0, [1.0, 1.5], [0.05, 20.0]).2, End::StableThroughout);
        assert_eq!(find(0.01, [1.0, 1.5], [0.05, 20.0]).2, End::UnstableThroughout);
        assert_eq!(find(3.0, [1.0, 2.0], [1.0, 2.0]).2, End::StableThroughout);
    }

    /// However wrong the first pair is.
    #[test]
    fn every_start_finds_the_limit() {
        for k in 0..120 {
            let first = 0.1 * 1.04f64.powi(k);
            for ratio in [1.005, 1.02, 1.3] {
                let (count, bracket, end) = find(1.1, [first, first * ratio], [0.05, 20.0]);
                let [Some(low), Some(high)] = bracket else { panic!("{first}: {bracket:?}") };
                assert!(low <= 1.1 && 1.1 < high && high / low - 1.0 <= 5e-3 + 1e-12, "{first}: {low} {high}");
                assert!(end == End::Found && count <= 24, "{first}, {ratio}: {count} trials");
            }
        }
        assert_eq!(find(1.1, start([None; 2], Some([1.1, 1.005]), [0.05, 20.0]), [0.05, 20.0]).0, 2);
    }

    #[test]
    fn a_search_whose_lead_is_not_stable_begins_there() {
        let mut search = Search::new([3.0, 3.015], [0.05, 20.0], 5e-3);
        let lead = search.lead().expect("a lead");
        assert_eq!(lead, 2.0);
        search.begin_at(lead);
        assert_eq!(search.next(), Some((2.0 / (3.015 / 3.0), Some(2.0))));
        assert_eq!(Search::new([1.0, 1.5], [0.9, 20.0], 5e-3).lead(), None, "below what is asked for");
    }

    #[test]
    fn the_start_lies_in_the_range() {
        let range = [0.05, 20.0];
        assert_eq!(start([None; 2], None, range), [1.0, 1.5]);
        assert_eq!(start([Some(1.2), Some(1.3)], Some([2.0, 1.01]), [1.2, 1.3]), [1.2, 1.3]);
        assert_eq!(start([Some(2.0), None], None, [2.0, 20.0]), [2.0, 3.0]);
        assert_eq!(start([None, Some(0.5)], None, [0.05, 0.5]), [0.5 / 1.5, 0.5]);
        assert_eq!(start([None; 2], Some([100.0, 1.01]), range), [1.0, 1.5]);
        assert_eq!(start([None; 2], Some([1.01, 1.05]), range), [1.0, 1.05]);
        assert_eq!(start([None; 2], Some([0.995, 1.05]), range), [1.0 / 1.05, 1.0]);
        let [first, second] = start([None; 2], Some([1.1, 1.005]), range);
        assert!(first < 1.1 && 1.1 < second && (second / first - 1.005).abs() < 1e-12);
    }
}
