//! Corner contacts: a corner of a block that meets a side which rises in front of it, in a point or over a short length
//! (theory, section 16). The toe of a plane on level ground is one.

use std::f64::consts::{PI, TAU};

use enmm::geometry::{Point, Vector};
use enmm::model::Simulation;
use enmm::model::case::Case;
use enmm::model::tables::{BlockId, Boundary, EdgeId, SideId};

/// Angle (rad) by which a face must rise to stand in the way: less is a kink of the drawing.
const STRAIGHT: f64 = 1e-3;
/// Angle (rad) up to which a face that bends is one face.
const FACING: f64 = 10.0 * PI / 180.0;
/// Angle (rad) between directions of one line that is round-off.
const ROUND_OFF: f64 = 1e-6;
/// Uniaxial strength (Pa) of rock for which the case gives none.
const ROCK_STRENGTH: f64 = 50e6;
/// Share of the weight that moves from which the force of a corner counts.
pub const COUNTS: f64 = 0.02;

/// A corner of a block that meets a side of another which rises in front of it, with nothing but air between them.
#[derive(Debug, Clone, PartialEq)]
pub struct CornerContact {
    /// Block whose corner it is.
    pub block: BlockId,
    /// Block in front.
    pub ahead: BlockId,
    /// The corner, and the end of the length over which faces of both meet there (m); the same place for a point.
    pub ends: [Point; 2],
    /// Uniaxial strength (Pa) of the rock there.
    pub strength: f64,
    /// Its contacts: those of nodes of a block with a side, sorted.
    pub contacts: Vec<(BlockId, SideId)>,
}

impl CornerContact {
    /// Length (m) over which faces of both blocks meet; 0 for a point.
    pub fn length(&self) -> f64 {
        (self.ends[1] - self.ends[0]).norm()
    }

    /// Block and place.
    pub fn text(&self) -> String {
        let at = self.ends[0];
        format!("block {} at ({:.3}, {:.3}) m", self.block, at.x, at.y)
    }

    /// The length in words: `in a point`, `over 10.0 mm`.
    pub fn over(&self) -> String {
        let length = self.length();
        if length > 0.0 { format!("over {:.1} mm", 1e3 * length) } else { "in a point".to_owned() }
    }

    /// Force (N/m) that the rock of this length bears.
    pub fn capacity(&self) -> f64 {
        self.length() * self.strength
    }

    /// Normal force (N/m) that it carried in the last step of a model.
    pub fn force(&self, simulation: &Simulation) -> f64 {
        let boundary = &simulation.model().boundary;
        let block = |node| boundary.block[boundary.nodes.point[node]];
        let is_own = |block, side| self.contacts.binary_search(&(block, side)).is_ok();
        let contacts = simulation.state().contacts.iter().filter(|c| is_own(block(c.node), c.side));
        contacts.map(|contact| contact.normal_force).sum()
    }
}

/// A corner contact with its force.
#[derive(Debug, Clone, PartialEq)]
pub struct CarryingCorner {
    /// The corner contact.
    pub corner: CornerContact,
    /// Normal force (N/m).
    pub force: f64,
}

impl CarryingCorner {
    /// Whether the force is more than the strength of the rock over the length.
    pub fn is_crushed(&self) -> bool {
        self.force >= self.corner.capacity()
    }

    /// Block, place, length and force.
    pub fn text(&self) -> String {
        let force = self.force / 1e3;
        format!("{} carries {force:.0} kN/m {}", self.corner.text(), self.corner.over())
    }
}

/// Corner contacts that carry more in the last step than the rock over their length bears, and more than a little of
/// the weight of their block.
pub fn carrying_corners(simulation: &Simulation) -> Vec<CarryingCorner> {
    let with_force = |corner: CornerContact| CarryingCorner { force: corner.force(simulation), corner };
    let carries = |carrying: &CarryingCorner| {
        carrying.is_crushed() && carrying.force > COUNTS * weight(simulation, carrying.corner.block)
    };
    corner_contacts(simulation).into_iter().map(with_force).filter(carries).collect()
}

/// Corner contacts of the drawing in a point, or over a length that may be an error of the drawing, as that at ends of
/// joints is, and whose strength is less than the weight of their block.
pub fn weak_corners(simulation: &Simulation) -> Vec<CornerContact> {
    let drawn = simulation.built().end_distances.join;
    let is_weak = |c: &CornerContact| c.length() <= drawn && c.capacity() < weight(simulation, c.block);
    corner_contacts(simulation).into_iter().filter(is_weak).collect()
}

/// Weight (N/m) of a block.
fn weight(simulation: &Simulation, block: BlockId) -> f64 {
    simulation.model().mass_matrix.total[block] * simulation.acceleration().norm()
}

/// The corner contacts of the drawing with the blocks that are there.
pub fn corner_contacts(simulation: &Simulation) -> Vec<CornerContact> {
    let rounds = Rounds::new(&simulation.model().boundary, &simulation.state().removed);
    let feet = rounds.places().flat_map(|place| rounds.feet(place).into_iter().map(move |foot| (place, foot)));
    let mut found: Vec<CornerContact> = feet.filter_map(|(place, foot)| rounds.corner(place, &foot)).collect();
    let strength = |block| strength_of(simulation, block);
    found.iter_mut().for_each(|corner| corner.strength = strength(corner.block).min(strength(corner.ahead)));
    found
}

/// Uniaxial strength (Pa) of the weakest rock of a block.
fn strength_of(simulation: &Simulation, block: BlockId) -> f64 {
    let model = simulation.model();
    let rocks = model.covers.elements_of(block).map(|e| model.element_rock[e]);
    rocks.map(|rock| uniaxial_strength(simulation.case(), rock as usize)).fold(f64::INFINITY, f64::min)
}

/// Uniaxial strength (Pa) of a rock of the case, [`ROCK_STRENGTH`] where it is elastic.
fn uniaxial_strength(case: &Case, rock: usize) -> f64 {
    let Some(rock) = case.rocks.values().nth(rock) else { return ROCK_STRENGTH };
    if let Some(envelope) = &rock.hoek_brown {
        return envelope.sigma_ci;
    }
    let (Some(cohesion), friction) = (rock.cohesion, rock.friction_deg.unwrap_or(0.0)) else { return ROCK_STRENGTH };
    2.0 * cohesion * libm::tan(PI / 4.0 + 0.5 * friction.to_radians())
}

/// The rock of one block about a point, between the edge that leaves the point and the one that comes to it.
#[derive(Debug, Clone, Copy)]
struct Sector {
    block: BlockId,
    /// Edge that leaves the point, and edge that comes to it: rock on their left.
    edges: [EdgeId; 2],
    /// Direction of the first one (rad).
    from: f64,
    /// Angle of the rock (rad).
    angle: f64,
}

/// Which way a block lies from the air beside a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Turn {
    /// Clockwise: the edge that comes to the point faces the air.
    Clockwise,
    /// Counter-clockwise: the edge that leaves the point faces the air.
    Counter,
}

/// A block at the edge of the air about a point, and the rest of the rock there.
struct Foot {
    /// Sectors of the block, from the air inwards.
    own: Vec<Sector>,
    /// Those of the others, from it on round to the air.
    rest: Vec<Sector>,
    turn: Turn,
}

impl Foot {
    /// Edges of the block and of the next one on the face that they share.
    fn standing(&self) -> Option<[EdgeId; 2]> {
        let (own, next) = (self.own.last()?, self.rest.first()?);
        Some(match self.turn {
            Turn::Clockwise => [own.edges[0], next.edges[1]],
            Turn::Counter => [own.edges[1], next.edges[0]],
        })
    }

    fn angle(sectors: &[Sector]) -> f64 {
        sectors.iter().map(|sector| sector.angle).sum()
    }
}

/// Sectors about all points of the boundary.
struct Rounds<'a> {
    boundary: &'a Boundary,
    removed: &'a [bool],
    /// The point before each point on its loop.
    before: Vec<EdgeId>,
    /// Points by position.
    order: Vec<EdgeId>,
}

impl<'a> Rounds<'a> {
    fn new(boundary: &'a Boundary, removed: &'a [bool]) -> Self {
        let mut before: Vec<EdgeId> = boundary.edges().collect();
        boundary.edges().for_each(|k| before[boundary.next[k].index()] = k);
        let mut order: Vec<EdgeId> = boundary.edges().collect();
        order.sort_by_key(|&k| (key(boundary.reference[k]), k));
        Self { boundary, removed, before, order }
    }

    /// All positions of points once.
    fn places(&self) -> impl Iterator<Item = Point> {
        let at = |k: EdgeId| self.boundary.reference[k];
        self.order
            .chunk_by(move |&a, &b| key(at(a)) == key(at(b)))
            .filter(|group| group.len() > 1)
            .map(move |g| at(g[0]))
    }

    fn direction(&self, edge: EdgeId) -> Vector {
        self.boundary.reference[self.boundary.after(edge)] - self.boundary.reference[edge]
    }

    /// Sectors about a place, counter-clockwise.
    fn sectors(&self, place: Point) -> Vec<Sector> {
        let at = |k: &EdgeId| key(self.boundary.reference[*k]);
        let first = self.order.partition_point(|k| at(k) < key(place));
        let points = self.order[first..].iter().take_while(|k| at(k) == key(place));
        let sector = |&point: &EdgeId| {
            let (out, back) = (self.direction(point), -self.direction(self.before[point.index()]));
            let from = libm::atan2(out.y, out.x);
            let turn = wrapped(libm::atan2(back.y, back.x) - from);
            let angle = if turn <= ROUND_OFF { TAU } else { turn };
            Sector { block: self.boundary.block[point], edges: [point, self.before[point.index()]], from, angle }
        };
        let mut sectors: Vec<Sector> = points.map(sector).filter(|s| !self.removed[s.block]).collect();
        sectors.sort_by(|a, b| a.from.total_cmp(&b.from));
        sectors
    }

    /// The two blocks at the air about a place; none where there is no air, more than once, or one block alone.
    fn feet(&self, place: Point) -> Vec<Foot> {
        let sectors = self.sectors(place);
        let n = sectors.len();
        let gap = |k: usize| wrapped(sectors[(k + 1) % n].from - sectors[k].from - sectors[k].angle);
        let gaps: Vec<usize> = (0..n).filter(|&k| gap(k) > ROUND_OFF).collect();
        let [last] = gaps[..] else { return Vec::new() };
        let round: Vec<Sector> = (0..n).map(|k| sectors[(last + 1 + k) % n]).collect();
        let back: Vec<Sector> = round.iter().rev().copied().collect();
        [(round, Turn::Counter), (back, Turn::Clockwise)]
            .into_iter()
            .filter_map(|(round, turn)| foot(&round, turn))
            .collect()
    }

    /// The corner contact of a block at the air, if it has one.
    fn corner(&self, place: Point, foot: &Foot) -> Option<CornerContact> {
        let (own, ahead) = (foot.own.first()?, foot.rest.last()?);
        // The rest of the rock rises before the block above the face on which it stands.
        if Foot::angle(&foot.rest) > PI + STRAIGHT {
            let stands = foot.standing()?;
            let contacts = self.contacts(foot, &[], stands.map(|edge| self.boundary.side[edge]));
            return corner_contact(own.block, ahead.block, [place; 2], contacts);
        }
        let (lip, end, stands) = self.lip(foot)?;
        let contacts = self.contacts(foot, &lip, stands.map(|edge| self.boundary.side[edge]));
        corner_contact(own.block, ahead.block, [end, place], contacts)
    }

    /// Edges of a block from the air along the one face that it shares with the block ahead, as far as it is straight
    /// and ends in a notch; with its end, and the edges on which the block stands there.
    fn lip(&self, foot: &Foot) -> Option<(Vec<EdgeId>, Point, [EdgeId; 2])> {
        let (own, ahead) = (foot.own[0].block, foot.rest[0].block);
        let is_of_both = |sectors: &[Sector]| sectors.iter().all(|s| s.block == own || s.block == ahead);
        let mut edge = foot.standing()?[0];
        let direction = self.direction(edge);
        let mut lip = Vec::new();
        let mut goes_on = is_of_both(&foot.rest);
        let bends = |way: Vector| libm::fabs(libm::atan2(direction.perp(&way), direction.dot(&way)));
        while goes_on && bends(self.direction(edge)) <= FACING {
            lip.push(edge);
            // The end that is farther from the air.
            let inner = if foot.turn == Turn::Clockwise { self.boundary.after(edge) } else { edge };
            let end = self.boundary.reference[inner];
            if let Some(stands) = self.stands_at(end, foot) {
                return Some((lip, end, stands));
            }
            let about = self.sectors(end);
            goes_on = about.len() == 2 && is_of_both(&about);
            edge = match foot.turn {
                Turn::Clockwise => self.boundary.after(edge),
                Turn::Counter => self.before[edge.index()],
            };
        }
        None
    }

    /// Edges of the block and of the next one on the face on which it stands, where it fills a notch of rock.
    fn stands_at(&self, place: Point, foot: &Foot) -> Option<[EdgeId; 2]> {
        let sectors = self.sectors(place);
        let n = sectors.len();
        let whole = Foot::angle(&sectors);
        let k = sectors.iter().position(|s| s.block == foot.own[0].block)?;
        let is_notch = (whole - TAU).abs() <= ROUND_OFF && sectors[k].angle < PI - STRAIGHT;
        is_notch.then(|| match foot.turn {
            Turn::Clockwise => [sectors[k].edges[0], sectors[(k + n - 1) % n].edges[1]],
            Turn::Counter => [sectors[k].edges[1], sectors[(k + 1) % n].edges[0]],
        })
    }

    /// Contacts between the block and the rock ahead but for those on the face on which it stands.
    fn contacts(&self, foot: &Foot, lip: &[EdgeId], stands: [SideId; 2]) -> Vec<(BlockId, SideId)> {
        let side = |edge: &EdgeId| self.boundary.side[*edge];
        let free = |sectors: &[Sector], stands: SideId| -> Vec<(BlockId, SideId)> {
            let all = sectors.iter().flat_map(|s| s.edges.map(|edge| (s.block, side(&edge))));
            all.filter(|&(_, side)| side != stands).collect()
        };
        let block = foot.own[0].block;
        let mut own = free(&foot.own, stands[0]);
        own.extend(lip.iter().map(|edge| (block, side(edge))).filter(|&(_, side)| side != stands[0]));
        let ahead = free(&foot.rest, stands[1]);
        let mut contacts: Vec<(BlockId, SideId)> = ahead.iter().map(|&(_, side)| (block, side)).collect();
        contacts.extend(ahead.iter().flat_map(|&(other, _)| own.iter().map(move |&(_, side)| (other, side))));
        contacts.sort_unstable();
        contacts.dedup();
        contacts
    }
}

fn corner_contact(
    block: BlockId,
    ahead: BlockId,
    ends: [Point; 2],
    contacts: Vec<(BlockId, SideId)>,
) -> Option<CornerContact> {
    (!contacts.is_empty()).then_some(CornerContact { block, ahead, ends, strength: ROCK_STRENGTH, contacts })
}

/// The block at the beginning of a round from the air on, and the rest.
fn foot(round: &[Sector], turn: Turn) -> Option<Foot> {
    let own = round.iter().take_while(|sector| sector.block == round[0].block).count();
    let (own, rest) = (round[..own].to_vec(), round[own..].to_vec());
    let is_one = rest.iter().all(|sector| sector.block != own[0].block);
    (!rest.is_empty() && is_one).then_some(Foot { own, rest, turn })
}

/// Order of positions.
fn key(place: Point) -> [u64; 2] {
    [place.x, place.y].map(|x| (x + 0.0).to_bits())
}

/// An angle (rad) between 0 and a full turn; round-off below 0 is 0.
fn wrapped(angle: f64) -> f64 {
    let angle = libm::fmod(angle, TAU);
    let angle = if angle < 0.0 { angle + TAU } else { angle };
    if TAU - angle <= ROUND_OFF { 0.0 } else { angle }
}
