//! Corners that carry a slope: the search repeated without them (theory, section 16).

use super::bracket::{self, Search};
use super::series::Series;
use super::setting::Setting;
use super::slip::height_and_gravity;
use super::{Trial, Verdict};
use crate::corners::{COUNTS, CarryingCorner, CornerContact, corner_contacts};
use enmm::model::Simulation;
use enmm::model::case::CornerContacts;

/// Corners that carry the slope, and its trials where they hold.
#[derive(Debug, Clone)]
pub struct CornersHold {
    /// The corners.
    pub corners: Vec<CarryingCorner>,
    /// The trials in which they hold: in the real geometry, where corners meet what lies ahead of them.
    pub series: Series,
}

impl CornersHold {
    /// The corners in words.
    pub fn places(&self) -> String {
        self.corners.iter().map(CarryingCorner::text).collect::<Vec<String>>().join(", ")
    }

    /// Whether the slope has a lower factor without them: where it starts to move, or where it is lost.
    pub fn decide(&self, without: &Series, lost: Option<&Series>) -> bool {
        let low = lost.unwrap_or(without).low;
        self.series.low.zip(low).is_none_or(|(held, low)| low < held)
    }
}

/// Corner contacts that carry more in the greatest stable trial of a search than the rock over their length bears, if
/// their force is enough of what moves. The case can decide otherwise.
pub fn carrying(base: &Simulation, searches: &[&Series]) -> Vec<CarryingCorner> {
    let choice = base.case().solver.corner_contacts;
    if choice == Some(CornerContacts::Hold) {
        return Vec::new();
    }
    let models = || std::iter::once(base).chain(searches.iter().filter_map(|search| search.stable.as_ref()));
    let with_force = |corner: CornerContact| {
        let force = models().map(|model| corner.force(model)).fold(0.0, f64::max);
        CarryingCorner { corner, force }
    };
    let corners = corner_contacts(base).into_iter().map(with_force);
    let crushed: Vec<CarryingCorner> = corners.filter(CarryingCorner::is_crushed).collect();
    let (_, gravity) = height_and_gravity(base);
    let moving =
        searches.iter().filter_map(|search| search.trial(search.high)).map(Trial::failing_mass).reduce(f64::max);
    let mass = |corner: &CarryingCorner| moving.unwrap_or(base.model().mass_matrix.total[corner.corner.block]);
    let carries = |corner: &CarryingCorner| corner.force > COUNTS * gravity * mass(corner);
    let counts = choice == Some(CornerContacts::Break) || crushed.iter().any(carries);
    if counts { crushed } else { Vec::new() }
}

/// The setting in which corners carry nothing.
pub fn without(corners: &[CarryingCorner], setting: &Setting) -> Setting {
    let mut left_out: Vec<_> = corners.iter().flat_map(|c| c.corner.contacts.iter().copied()).collect();
    left_out.sort_unstable();
    left_out.dedup();
    Setting { left_out, ..setting.clone() }
}

/// Where a search begins that cannot end above another: about what limit analysis foretells where corners carry
/// nothing, if that is less than the greatest stable factor of the other, else at the strength of the case or below
/// it, and at that factor.
pub fn below(held: &Series, search: &Search, limits: [Option<f64>; 2], foretold: Option<[f64; 2]>) -> Search {
    let range = search.range;
    let top = held.low.unwrap_or(range[0]);
    let foretold = foretold.filter(|[factor, _]| *factor < top);
    let [first, second] = bracket::start(limits, foretold, range);
    let first = if first < top { first } else { (top / bracket::STRIDE).max(range[0]) };
    let second = if foretold.is_some() { second.min(top) } else { top };
    let mut search = search.again([first, second]);
    if let Some(high) = held.high {
        search.note(high, Verdict::Unstable);
    }
    search
}
