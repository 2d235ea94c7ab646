//! The limit in the real geometry, beyond which a slope is lost (theory, section 16).

use super::Verdict;
use super::bracket::Search;
use super::series::{Series, Trials};
use super::setting::{Geometry, Setting};

/// Looks for the limit in the real geometry, beginning with the bracket of the drawing; none where that was real, or
/// has no stable trial.
pub fn look(trials: &mut Trials, drawn: &Series, setting: &Setting, search: &Search) -> Option<Series> {
    let low = drawn.low.filter(|_| setting.geometry == Geometry::Drawn)?;
    let is_near = drawn.trial(Some(low)).is_some_and(|t| trials.base.is_near(t));
    let start = match (is_near, drawn.high) {
        (true, None) => return None,
        (true, Some(high)) => [high; 2],
        (false, high) => [low, high.unwrap_or(low)],
    };
    let mut search = search.again(start);
    if is_near {
        search.note(low, Verdict::Stable);
    }
    let real = Setting { geometry: Geometry::Real, ..setting.clone() };
    Some(trials.series(search, &real))
}
