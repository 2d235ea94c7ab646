//! Bolts of a case: the free lengths of their bars, found on the uncut reference.

use crate::contact::{BoltSegment, Grout};
use crate::cover::{BlockId, ElementId};
use crate::geometry::{Point, Vector};
use crate::model::case::{Anchorage, Bolt, Case, Invalid};
use crate::state::Model;

use super::locator::Locator;

/// Free length of a grouted bar at a joint, relative to the mesh size.
const FREE_LENGTH: f64 = 0.1;
/// Elongation of a bar of steel, relative to its free length, at which it breaks.
const RUPTURE_STRAIN: f64 = 0.1;
/// Distance, relative to the mesh size, at which the rock on both sides of a crossing is looked up.
const BESIDE: f64 = 1e-3;
/// Longest distance of the points of a bar with a bond, relative to the mesh size and to √(EA/stiffness of the bond),
/// over which its force falls to 1/e; and most points.
const POINTS: [f64; 2] = [0.5, 0.2];
const POINTS_MAX: usize = 2000;
/// Stiffness of a plate at the head, relative to that of the bar between its first two points.
const PLATE: f64 = 1e3;
/// Share of the longest stable step that a bond may need.
const STABLE: f64 = 0.5;

/// Segments of all bolts, and what the user should know of them.
pub(super) fn bolts(case: &Case, positions: &Locator) -> Result<(Vec<BoltSegment>, Vec<String>), Invalid> {
    let (mut segments, mut warnings) = (Vec::new(), Vec::new());
    for (k, bolt) in case.bolts.iter().enumerate() {
        let line = Line::new(&format!("bolt[{k}]"), bolt, positions)?;
        match bolt.anchorage {
            Anchorage::Ends => {
                let block = |end: usize| positions.covers.element_block[line.elements[end]];
                if block(0) == block(1) && line.meetings.is_empty() && !bolt.of_skin {
                    warnings.push(format!(
                        "{}: both ends lie in one block and the bolt crosses no joint, so that it holds nothing: move \
                         its points to both sides of a joint",
                        case.bolt_name(k)
                    ));
                }
                segments.push(line.whole(k as u32, bolt));
            }
            Anchorage::Grouted if bolt.bond.is_some() => {
                segments.extend(line.bonded(k as u32, bolt)?);
                warnings.extend(line.outside_warning(case, k));
            }
            Anchorage::Grouted => {
                let crossings = line.crossings();
                if crossings.is_empty() {
                    return Err(Invalid {
                        key: format!("bolt[{k}].points"),
                        message: format!(
                            "{} crosses no joint, so that it would do nothing: move its points to both sides of a \
                             joint, or set `anchorage = \"ends\"`",
                            bolt.name.as_ref().map_or("the bolt".to_owned(), |name| format!("the bolt {name:?}"))
                        ),
                    });
                }
                segments.extend(crossings.iter().map(|c| line.bridge(k as u32, bolt, c)));
                warnings.extend(line.outside_warning(case, k));
            }
        }
    }
    Ok((segments, warnings))
}

/// A position where a bolt crosses a joint.
struct Crossing {
    /// Distance from the head (m).
    along: f64,
    /// Elements before and after it.
    elements: [ElementId; 2],
}

/// A bolt on the reference configuration.
struct Line<'a> {
    positions: &'a Locator<'a>,
    ends: [Point; 2],
    elements: [ElementId; 2],
    direction: Vector,
    length: f64,
    /// Where it meets joints and outlines: distance from the head (m), and whether both sides are one block there.
    meetings: Vec<(f64, bool)>,
}

impl<'a> Line<'a> {
    fn new(key: &str, bolt: &Bolt, positions: &'a Locator) -> Result<Self, Invalid> {
        let ends = bolt.points.map(Point::from);
        let mut elements = [ElementId::default(); 2];
        for (k, element) in elements.iter_mut().enumerate() {
            *element = positions.element(&format!("{key}.points[{k}]"), bolt.points[k])?;
        }
        let length = (ends[1] - ends[0]).norm();
        let direction = (ends[1] - ends[0]) / length;
        let mut line = Self { positions, ends, elements, direction, length, meetings: Vec::new() };
        line.meet();
        Ok(line)
    }

    /// Finds where the bolt meets pieces of block boundaries; positions that coincide become one.
    fn meet(&mut self) {
        let pieces = self.positions.outlines.pieces.iter();
        for piece in pieces.filter(|p| p.opposite.is_none_or(|other| p.element < other)) {
            let [a, b] = [piece.a, piece.b].map(|p| self.direction.perp(&(p - self.ends[0])));
            if a * b > 0.0 || a == b {
                continue;
            }
            let at = piece.a + (piece.b - piece.a) * (a / (a - b));
            let along = (at - self.ends[0]).dot(&self.direction);
            if (0.0..=self.length).contains(&along) {
                self.meetings.push((along, piece.partial));
            }
        }
        self.meetings.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let tolerance = self.positions.tolerance;
        self.meetings.dedup_by(|next, first| {
            let same = next.0 - first.0 <= tolerance;
            first.1 |= same && next.1;
            same
        });
    }

    fn at(&self, along: f64) -> Point {
        self.ends[0] + self.direction * along
    }

    fn element_at(&self, along: f64) -> Option<ElementId> {
        self.positions.covers.element_near(self.at(along), self.positions.tolerance)
    }

    /// The joints that the bolt crosses: rock on both sides, of two blocks or of one across a partial cut.
    fn crossings(&self) -> Vec<Crossing> {
        let mut crossings = Vec::new();
        for (k, &(along, partial)) in self.meetings.iter().enumerate() {
            let before = if k == 0 { 0.0 } else { self.meetings[k - 1].0 };
            let after = self.meetings.get(k + 1).map_or(self.length, |m| m.0);
            let beside = |room: f64| (0.25 * room).min(BESIDE * self.positions.covers.mesh.size);
            let sides = [along - beside(along - before), along + beside(after - along)].map(|at| self.element_at(at));
            let [Some(first), Some(second)] = sides else { continue };
            let block = |e: ElementId| self.positions.covers.element_block[e];
            if block(first) != block(second) || partial && first != second {
                crossings.push(Crossing { along, elements: [first, second] });
            }
        }
        crossings
    }

    /// Parts between joints and outlines: distances from the head (m) at both ends.
    fn parts(&self) -> Vec<[f64; 2]> {
        let stations: Vec<f64> =
            std::iter::once(0.0).chain(self.meetings.iter().map(|m| m.0)).chain([self.length]).collect();
        let parts = stations.windows(2).map(|pair| [pair[0], pair[1]]);
        parts.filter(|[from, to]| to - from > 2.0 * self.positions.tolerance).collect()
    }

    /// A warning of the length of the bolt that lies in no rock.
    fn outside_warning(&self, case: &Case, bolt: usize) -> Option<String> {
        let parts = self.parts().into_iter().filter(|[from, to]| self.element_at(0.5 * (from + to)).is_none());
        let outside: f64 = parts.map(|[from, to]| to - from).sum();
        let name = case.bolt_name(bolt);
        (outside > 0.0).then(|| format!("{outside:.3} m of the grouted bolt {name:?} lie outside the rock"))
    }

    /// Segments between points along the bar, each in the middle of a length that grout ties to the rock; the first
    /// one is the head where that has a plate.
    fn bonded(&self, index: u32, bolt: &Bolt) -> Result<Vec<BoltSegment>, Invalid> {
        let [strength, stiffness] = [bolt.bond, bolt.bond_stiffness].map(Option::unwrap_or_default);
        let reach = (bolt.young * bolt.area / stiffness).sqrt();
        let longest = (POINTS[0] * self.positions.covers.mesh.size).min(POINTS[1] * reach);
        if self.length / longest > POINTS_MAX as f64 {
            let message = format!(
                "is {stiffness:.3e} N/m per metre, so that the force of the bar falls to 1/e within {reach:.2e} m, and \
                 the bar would need more than {POINTS_MAX} points; lower it"
            );
            return Err(Invalid { key: format!("bolt[{index}].bond_stiffness"), message });
        }
        let mut points: Vec<(f64, ElementId, Grout)> = Vec::new();
        if bolt.plate {
            points.push((0.0, self.elements[0], Grout { stiffness: 0.0, strength: f64::INFINITY }));
        }
        for [from, to] in self.parts() {
            let count = ((to - from) / longest).ceil().max(1.0);
            let long = (to - from) / count;
            let grout = Grout { stiffness: stiffness * long / bolt.spacing, strength: strength * long / bolt.spacing };
            let middles = (0..count as usize).map(|k| from + (k as f64 + 0.5) * long);
            points.extend(middles.filter_map(|along| Some((along, self.element_at(along)?, grout))));
        }
        if points.len() < 2 {
            let message = "has fewer than two points in rock, so that it would do nothing: move its points into rock";
            return Err(Invalid { key: format!("bolt[{index}].points"), message: message.into() });
        }
        let pairs = points.windows(2).enumerate();
        let mut segments: Vec<BoltSegment> = pairs.map(|(k, pair)| self.tied(index, bolt, k > 0, pair)).collect();
        if let Some(first) = segments.first_mut().filter(|_| bolt.plate) {
            let stiffness = PLATE * first.stiffness;
            first.grout = first.grout.map(|[head, next]| [Grout { stiffness, ..head }, next]);
        }
        Ok(segments)
    }

    /// A segment between two points along the bar.
    fn tied(&self, index: u32, bolt: &Bolt, follows: bool, pair: &[(f64, ElementId, Grout)]) -> BoltSegment {
        let covers = self.positions.covers;
        let elements = [pair[0].1, pair[1].1].map(|e| covers.host[e]);
        let points = [pair[0].0, pair[1].0].map(|along| self.at(along));
        let segment = self.segment(index, bolt, elements, points, pair[1].0 - pair[0].0);
        BoltSegment { grout: Some([pair[0].2, pair[1].2]), follows, ..segment }
    }

    /// One segment from end to end.
    fn whole(&self, index: u32, bolt: &Bolt) -> BoltSegment {
        self.segment(index, bolt, self.elements, self.ends, self.length)
    }

    /// A short segment across a joint; its points belong to the rock on both sides, as far as they reach.
    fn bridge(&self, index: u32, bolt: &Bolt, crossing: &Crossing) -> BoltSegment {
        let covers = self.positions.covers;
        let free = bolt.free_length.unwrap_or(FREE_LENGTH * covers.mesh.size);
        let points = [-0.5, 0.5].map(|share| self.at(crossing.along + share * free));
        self.segment(index, bolt, crossing.elements.map(|e| covers.host[e]), points, free)
    }

    fn segment(
        &self,
        index: u32,
        bolt: &Bolt,
        elements: [ElementId; 2],
        points: [Point; 2],
        free_length: f64,
    ) -> BoltSegment {
        let covers = self.positions.covers;
        BoltSegment {
            bolt: index,
            blocks: elements.map(|e| covers.element_block[e]),
            covers: elements.map(|e| covers.element_covers[e]),
            weights: [0, 1].map(|k| covers.weights(elements[k], points[k])),
            points,
            stiffness: bolt.young * bolt.area / (free_length * bolt.spacing),
            yield_force: bolt.yield_force.map_or(f64::INFINITY, |force| force / bolt.spacing),
            rupture: rupture_strain(bolt).map_or(f64::INFINITY, |strain| strain * free_length),
            pretension: bolt.pretension / bolt.spacing,
            active: bolt.active,
            grout: None,
            follows: false,
        }
    }
}

/// Refuses bonds that are so stiff that the explicit step cannot follow them (Eq. 44d).
///
/// # Errors
/// The first bolt that needs a shorter step.
pub(super) fn check_step(case: &Case, model: &Model) -> Result<(), Invalid> {
    let masses = &model.mass_matrix;
    let (mut of_cover, mut of_block) = (vec![0.0; masses.mass.len()], vec![0.0; masses.total.len()]);
    let mut points = Vec::new();
    for segment in &model.bolts {
        let Some(grout) = segment.grout else { continue };
        for k in usize::from(segment.follows)..2 {
            // A plate hardly moves against the bar, which is softer.
            let stiffness = if grout[k].strength.is_finite() { grout[k].stiffness } else { segment.stiffness };
            of_block[segment.blocks[k].index()] += stiffness;
            for (&cover, weight) in segment.covers[k].iter().zip(segment.weights[k]) {
                of_cover[cover.index()] += stiffness * weight.abs();
            }
            points.push((segment, k));
        }
    }
    let square = |(segment, k): &(&BoltSegment, usize)| {
        let block: BlockId = segment.blocks[*k];
        let own = segment.covers[*k].iter().map(|&cover| of_cover[cover.index()] / masses.mass[cover.index()]);
        own.fold(0.0, f64::max) + of_block[block.index()] * model.mass_scaling / masses.total[block]
    };
    let worst = points.iter().max_by(|a, b| square(a).total_cmp(&square(b)));
    let Some(worst) = worst.filter(|worst| square(worst).sqrt() * model.dt > 2.0 * STABLE) else { return Ok(()) };
    let least = (2.0 * STABLE / model.dt).powi(2) / square(worst);
    let bolt = worst.0.bolt;
    let stiffness = case.bolts[bolt as usize].bond_stiffness.unwrap_or_default();
    let message = format!(
        "is {stiffness:.3e} N/m per metre, and steps of {:.3e} s follow at most {:.3e} beside the rock of its lightest \
         part: lower it, or `solver.dt_safety` (a quarter of the step allows sixteen times as much)",
        model.dt,
        least * stiffness
    );
    Err(Invalid { key: format!("bolt[{bolt}].bond_stiffness"), message })
}

/// Elongation at which a bar breaks: as given, else that of steel where it yields.
fn rupture_strain(bolt: &Bolt) -> Option<f64> {
    bolt.rupture_strain.or(bolt.yield_force.map(|_| RUPTURE_STRAIN))
}
