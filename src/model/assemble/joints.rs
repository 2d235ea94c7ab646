//! The joints of a case: its traces, those of its sets, and their laws by region.

use crate::contact::LawId;
use crate::geometry::joint_set::{BridgedSet, JointSetParameters, Spread, Turn, generate_bridged};
use crate::geometry::trace::Stops;
use crate::geometry::{Point, trace};
use crate::model::case::{AngleDistribution, CUT_LAW, Case, Distribution, Invalid, JointSet, LawRegion};

use super::{law_of, points};

/// The joints of a case.
pub(super) struct Joints {
    /// Joint traces with their laws: those of the case first, then the loops of islands, so that rock that touches
    /// stays apart.
    pub traces: Vec<(Vec<Point>, LawId)>,
    /// First trace of each joint set, and one past the last.
    pub set_start: Vec<usize>,
    /// Rock bridges among them: those of the sets, then those drawn by hand, then those at ends.
    pub bridges: Vec<usize>,
    /// Sections that have broken among them.
    pub cracks: Vec<usize>,
    pub default_law: LawId,
}

impl Joints {
    /// Law of each rock bridge.
    pub fn bridge_laws(&self) -> impl Iterator<Item = LawId> {
        self.bridges.iter().map(|&bridge| self.traces[bridge].1)
    }
}

/// Joint traces with their laws.
type Traces = Vec<(Vec<Point>, LawId)>;

/// Joint traces of the case, then those of its sets in the box of the rock.
pub(super) fn joints(case: &Case, low: Point, high: Point) -> Result<Joints, Invalid> {
    let default_law = case.default_joint_law().and_then(|name| law_of(case, name)).unwrap_or_default();
    let law = |name: &Option<String>| name.as_ref().and_then(|name| law_of(case, name)).unwrap_or(default_law);
    let mut traces: Traces = case.joints.iter().map(|joint| (points(&joint.points), law(&joint.law))).collect();
    let box_points = [low, Point::new(high.x, low.y), high, Point::new(low.x, high.y)];
    let mut set_start = vec![traces.len()];
    let mut bridges: Traces = Vec::new();
    for (k, set) in case.joint_sets.iter().enumerate() {
        let region = set.region.as_ref().map_or(box_points.to_vec(), |r| points(r));
        let made = generate_bridged(&parameters(set), &region)
            .map_err(|error| Invalid { key: format!("joint_set[{k}]"), message: error.to_string() })?;
        let BridgedSet { traces: mut made, bridges: mut between } = made;
        if let Some(end) = &set.ends_on {
            let range = case.joint_sets[..k].iter().position(|set| set.name.as_ref() == Some(end));
            let others = match range {
                Some(other) => &traces[set_start[other]..set_start[other + 1]],
                None => &traces[..],
            };
            let stopping = law_of(case, end).filter(|_| range.is_none());
            let lines = others.iter().filter(|(_, law)| stopping.is_none_or(|stopping| stopping == *law));
            let stops = Stops::new(lines.map(|(line, _)| line.as_slice()));
            made.iter_mut().chain(&mut between).for_each(|t| *t = stops.end(*t));
        }
        traces.extend(made.into_iter().map(|t| (t.to_vec(), law(&set.law))));
        set_start.push(traces.len());
        if let Some(bridge_law) = set.bridge_law.as_ref().and_then(|name| law_of(case, name)) {
            bridges.extend(between.into_iter().map(|t| (t.to_vec(), bridge_law)));
        }
    }
    let drawn = case.bridges.iter().filter_map(|b| Some((points(&b.points), law_of(case, &b.law)?)));
    bridges.extend(drawn);
    let first_bridge = traces.len();
    traces.extend(bridges);
    let bridges: Vec<usize> = (first_bridge..traces.len()).collect();
    for change in &case.law_regions {
        change_laws(case, change, &bridges, &mut traces);
    }
    Ok(Joints { traces, set_start, bridges, cracks: Vec::new(), default_law })
}

/// Gives joints in a region their other law, rock bridges only where the region names theirs; a joint that leaves the
/// region is divided at its border, and all but its first piece come after all others.
fn change_laws(case: &Case, change: &LawRegion, bridges: &[usize], traces: &mut Traces) {
    let (region, Some(to)) = (points(&change.region), law_of(case, &change.to)) else { return };
    let from = change.from.as_ref().and_then(|name| law_of(case, name));
    let cut = law_of(case, CUT_LAW);
    let changes = |law: LawId| from.map_or(Some(law) != cut, |from| law == from);
    let mut more = Vec::new();
    let is_meant = |k: &usize| change.from.is_some() || bridges.binary_search(k).is_err();
    let meant = traces.iter_mut().enumerate().filter(|(k, _)| is_meant(k)).map(|(_, trace)| trace);
    for (line, law) in meant.filter(|(_, law)| changes(*law)) {
        let pieces = trace::divide(line, &region);
        if pieces.iter().all(|(_, inside)| !inside) {
            continue;
        }
        let of = |inside| if inside { to } else { *law };
        let mut pieces =
            pieces.into_iter().map(|(points, inside)| (points, of(inside))).collect::<Vec<_>>().into_iter();
        if let Some(first) = pieces.next() {
            (*line, *law) = first;
        }
        more.extend(pieces);
    }
    traces.extend(more);
}

fn parameters(set: &JointSet) -> JointSetParameters {
    JointSetParameters {
        dip: set.angle(),
        dip_sd: set.dip_sd_deg.to_radians(),
        turn: match set.angle_distribution {
            AngleDistribution::Normal => Turn::Normal,
            AngleDistribution::Uniform => Turn::Uniform,
            AngleDistribution::Fisher => Turn::Fisher {
                concentration: set.fisher_k.unwrap_or_default(),
                out_of_plane: set.out_of_section_deg.to_radians(),
            },
        },
        spacing: set.spacing,
        spacing_sd: set.spacing_sd,
        spacing_spread: spread(set.spacing_distribution),
        trace_length: set.trace_length,
        trace_length_sd: set.trace_length_sd,
        length_spread: spread(set.trace_length_distribution),
        gap: set.gap,
        seed: set.seed,
        origin: set.origin.map(Point::from),
    }
}

fn spread(distribution: Distribution) -> Spread {
    match distribution {
        Distribution::Normal => Spread::Normal,
        Distribution::Lognormal => Spread::Lognormal,
        Distribution::Exponential => Spread::Exponential,
        Distribution::Uniform => Spread::Uniform,
    }
}
