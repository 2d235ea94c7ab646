//! Limit analysis of rigid blocks: the greatest factor of safety that equilibrium allows, whatever the path, as a
//! second opinion beside strength reduction (theory, section 19).

mod contact;
pub mod continuum;
mod corner;
mod estimate;
mod interfaces;
mod model;
mod near_ends;
mod opened;
mod program;
mod refusal;
mod released;
mod search;
mod solver;
mod way;

use enmm::geometry::{Point, Vector};
use enmm::model::tables::{BlockId, Outlines};

use crate::corners::{CornerContact, corner_contacts};
use contact::Contact;
use corner::Corner;
use enmm::model::Simulation;
use enmm::model::assemble::outlines;
use enmm::model::case::{Case, Invalid};
use model::{Body, Strengths};
pub use near_ends::NearEnds;
use near_ends::near_ends;
use program::{Program, Unsolved};
pub use refusal::{staged, staged_rock};
use search::{Limit, Search};
pub use way::Way;

/// Range of factors that is searched; outside it the result is `AtMost` or `AtLeast`.
pub const RANGE: [f64; 2] = [1e-3, 1e3];
/// Difference of two factors, relative to them, that matters: the width to which strength reduction finds one.
const TOLERANCE: f64 = 5e-3;
/// Speed, relative to that of the fastest block, from which a block is part of a mechanism.
const MOVES: f64 = 1e-2;

/// A factor on the strength of all joints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Factor {
    /// Equilibrium ends at this factor.
    Found(f64),
    /// There is equilibrium even at this factor.
    AtLeast(f64),
    /// There is none even at this factor.
    AtMost(f64),
}

impl std::fmt::Display for Factor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Found(factor) => write!(f, "{factor:.4}"),
            Self::AtLeast(least) => write!(f, "at least {least}"),
            Self::AtMost(most) => write!(f, "at most {most}"),
        }
    }
}

impl Factor {
    /// The strength at the factor, or at the end of the range beyond which it lies.
    fn strength(&self) -> f64 {
        match *self {
            Self::Found(factor) | Self::AtLeast(factor) | Self::AtMost(factor) => 1.0 / factor,
        }
    }

    /// The factor where equilibrium ends; none where that lies beyond the range.
    pub fn found(&self) -> Option<f64> {
        matches!(self, Self::Found(_)).then(|| self.value())
    }

    /// The factor where equilibrium ends; infinite when it does not, zero when there is none.
    pub fn value(&self) -> f64 {
        match *self {
            Self::Found(factor) => factor,
            Self::AtLeast(_) => f64::INFINITY,
            Self::AtMost(_) => 0.0,
        }
    }
}

/// A block that moves in a mechanism.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingBlock {
    /// Block.
    pub block: u32,
    /// Its mass centroid (m).
    pub position: Point,
    /// Velocity of the centroid over the speed of the fastest block.
    pub velocity: Vector,
    /// Angular velocity over the speed of the fastest block (rad/m), counter-clockwise.
    pub spin: f64,
    /// Speed of the block, its turning at its own radius included, over that of the fastest.
    pub speed: f64,
    /// Area (m²).
    pub area: f64,
    /// Mass (kg/m).
    pub mass: f64,
}

/// A factor and the way in which the slope fails there.
#[derive(Debug, Clone, PartialEq)]
pub struct Collapse {
    /// The factor.
    pub factor: Factor,
    /// Blocks that move, fastest first; none when there is equilibrium throughout.
    pub mechanism: Vec<MovingBlock>,
    /// The way in which they move.
    pub way: Option<Way>,
}

/// A factor of a bound with what it says.
#[derive(Debug, Clone, PartialEq)]
pub struct Row<'a> {
    /// Its key in records.
    pub key: &'static str,
    /// Its name where it is shown.
    pub name: &'static str,
    /// The factor and its mechanism.
    pub collapse: &'a Collapse,
    /// What it says: first whether it is an upper bound or an estimate.
    pub meaning: String,
}

fn row<'a>(key: &'static str, name: &'static str, collapse: &'a Collapse, meaning: &str) -> Row<'a> {
    Row { key, name, collapse, meaning: meaning.to_owned() }
}

impl Row<'_> {
    /// The way of its mechanism, with what that says of a bound.
    pub fn way(&self) -> Option<String> {
        let is_bound = self.key != ESTIMATE;
        self.collapse.way.map(|way| if is_bound { way.words() } else { way.name().to_owned() })
    }
}

/// A bound without cohesion and tensile strength of interfaces that its mechanism opens.
#[derive(Debug, Clone, PartialEq)]
pub struct Bare {
    /// The factor and its mechanism.
    pub collapse: Collapse,
    /// Share that these interfaces have of what cohesion and tensile strength do in the associated mechanism.
    pub share: f64,
    /// How many they are.
    pub interfaces: usize,
}

/// A bound in which corners that meet rock ahead of them carry nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct ReleasedCorners {
    /// The factor and its mechanism.
    pub collapse: Collapse,
    /// The corners.
    pub corners: Vec<CornerContact>,
}

/// Share by which the bound without corners must be lower for them to carry the slope.
const CARRIES: f64 = 0.02;
/// Key of the factor that is no bound.
const ESTIMATE: &str = "estimate";
/// How joints that soften count, beside each bound of a case that has them.
pub const DUCTILE: &str = "a bridge counts with its strength: the bound holds for a ductile bridge";

/// Result of limit analysis.
#[derive(Debug, Clone, PartialEq)]
pub struct Bound {
    /// Corners that face each other at crossings may pass through each other: exact for joints that dilate by their
    /// friction angle, as far as such corners play no part.
    pub associated: Collapse,
    /// Each of them stays outside one facet or the other: upper bound when corners pass over level tops.
    pub level_tops: Collapse,
    /// No choice of facets gives less than this: the factor of `level_tops`, unless choices were left untried.
    pub least: Factor,
    /// Each of them stays outside both facets: bound when corners catch at every crossing.
    pub catching: Collapse,
    /// As `level_tops` without corners that meet rock ahead of them in a point, or over a length that cannot bear their
    /// force; none where there are no such corners.
    pub released: Option<ReleasedCorners>,
    /// The associated bound without cohesion and tensile strength of interfaces that open; none where it was not asked.
    pub bare: Option<Bare>,
    /// Estimate, and no bound, of the factor of joints that dilate as the case says, those that open bare; none where
    /// forces do not agree with the friction that they give.
    pub estimate: Option<Collapse>,
    /// Ends of joints that miss a line and decide about the slope; none where they do not, or where it was not asked.
    pub ends: Option<NearEnds>,
    /// Blocks that are there, and those that can move.
    pub blocks: [usize; 2],
    /// Straight interfaces.
    pub interfaces: usize,
    /// Corners that meet a face in a point.
    pub points: usize,
    /// Pairs of corners that face each other.
    pub corners: usize,
    /// Linear programs that were solved.
    pub programs: usize,
    /// Sum over all joints (N/m) of the pressure of the water that flows in them, with which it was found; none where
    /// none flows.
    pub joint_water: Option<f64>,
    /// Whether joints soften, so that [`DUCTILE`] holds.
    pub softens: bool,
    /// Changes that the build has made in the drawing, and how bridges count.
    pub notes: Vec<String>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

/// Why there is no bound.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BoundError {
    /// The case cannot be built, or holds what limit analysis cannot treat.
    #[error(transparent)]
    Case(#[from] Invalid),
    /// Every block is held, and none can fail; perhaps ends of joints that miss a line hold them.
    #[error("{invalid}")]
    Held {
        /// The fault.
        invalid: Invalid,
        /// Ends that hold the slope.
        ends: Option<Box<NearEnds>>,
    },
    /// A linear program has a solution, but the solver did not reach it.
    #[error(
        "the linear program of {blocks} blocks was not solved ({status}): remove slivers of rock, or snap points that \
         nearly coincide with a larger domain.snap_tolerance"
    )]
    Unsolved {
        /// Blocks that can move.
        blocks: usize,
        /// Status of the solver.
        status: String,
    },
    /// A conic program has a solution, but the solver did not reach it.
    #[error(
        "the conic program of {triangles} triangles was not solved ({status}): hold the rock by [[fix]] where it goes \
         on, remove slivers of rock, or ask for another number of triangles"
    )]
    UnsolvedRock {
        /// Triangles of the mesh.
        triangles: usize,
        /// Status of the solver.
        status: String,
    },
    /// No mesh of triangles fits the rock.
    #[error(
        "points of the drawing nearly coincide at ({x:.6}, {y:.6}) m: snap them with a larger domain.snap_tolerance"
    )]
    Close {
        /// Position (m).
        x: f64,
        /// Position (m).
        y: f64,
    },
}

impl Bare {
    fn meaning(&self) -> String {
        match self.interfaces {
            0 => "the same: no interface with cohesion opens".to_owned(),
            count => format!(
                "upper bound without cohesion and tensile strength of {count} interfaces that open, {:.0} % of all",
                100.0 * self.share
            ),
        }
    }
}

impl Bound {
    /// All factors with what they say, bounds first.
    pub fn rows(&self) -> Vec<Row<'_>> {
        let level = if self.least == self.level_tops.factor {
            "upper bound where corners pass over level tops".to_owned()
        } else {
            format!(
                "upper bound of a factor of at least {:.4}: some choices at crossings were not tried",
                self.least.value()
            )
        };
        let free = self.released.as_ref().map(|released| {
            row(
                "corners_free",
                "corners carry nothing",
                &released.collapse,
                "upper bound without corners that meet rock ahead",
            )
        });
        let (first, later) = if self.carrying().is_empty() { (None, free) } else { (free, None) };
        let mut rows: Vec<Row<'_>> = first.into_iter().collect();
        rows.extend([
            row(
                "associated",
                "associated",
                &self.associated,
                "upper bound: joints dilate by their friction (normality)",
            ),
            row("level_tops", "level tops pass", &self.level_tops, &level),
            row("catching", "every corner catches", &self.catching, "upper bound if no crossing lets a block pass"),
        ]);
        rows.extend(later);
        if let Some(bare) = &self.bare {
            rows.push(row("bare", "open joints bare", &bare.collapse, &bare.meaning()));
        }
        let estimate = "estimate, no bound: joints dilate as the case says, open ones are bare";
        rows.extend(self.estimate.as_ref().map(|collapse| row(ESTIMATE, "without normality", collapse, estimate)));
        rows
    }

    /// The corners that carry the slope: without them the bound is lower by more than 2 %.
    pub fn carrying(&self) -> &[CornerContact] {
        let lower = (1.0 - CARRIES) * self.level_tops.factor.value();
        self.released.as_ref().filter(|r| r.collapse.factor.value() < lower).map_or(&[], |r| &r.corners)
    }

    /// That corners carry the slope.
    fn corners_warning(&self) -> Option<String> {
        let places: Vec<String> = self.carrying().iter().map(CornerContact::text).collect();
        let without = self.released.as_ref()?.collapse.factor;
        (!places.is_empty()).then(|| {
            format!(
                "corners that meet rock ahead of them carry the slope: {}; without them the bound is {without}",
                places.join(", ")
            )
        })
    }

    /// The factors in one line.
    pub fn summary(&self) -> String {
        let (level, associated) = (self.level_tops.factor, self.associated.factor);
        let bare = self.bare.as_ref().filter(|bare| bare.interfaces > 0);
        let bare = bare.map(|bare| format!(", {} if joints that open are bare", bare.collapse.factor));
        let estimate = match &self.estimate {
            Some(collapse) => format!("estimate without normality {}", collapse.factor),
            None => "no estimate without normality".to_owned(),
        };
        let bare = bare.unwrap_or_default();
        let free = self.released.as_ref().filter(|_| !self.carrying().is_empty());
        let free =
            free.map(|free| format!("{} where corners carry nothing, ", free.collapse.factor)).unwrap_or_default();
        format!("upper bound {free}{level} where level tops pass, {associated} associated{bare}; {estimate}")
    }

    /// What bounds count that is not there once joints open.
    fn warning(&self) -> Option<String> {
        let bare = self.bare.as_ref()?;
        let (with, without) = (self.associated.factor.value(), bare.collapse.factor.value());
        (without < with * (1.0 - TOLERANCE)).then(|| {
            format!(
                "interfaces that open in the mechanism have {:.0} % of the work of cohesion and tensile strength: \
                 without these the bound is {}, {:.1} % lower",
                100.0 * bare.share,
                bare.collapse.factor,
                100.0 * (1.0 - without / with)
            )
        })
    }
}

/// Finds the bounds of a case in the stage in which strength reduction makes its trials: after the static stages with
/// which it begins; beside them, what the bound is without the cohesion of joints that open, and an estimate for joints
/// that dilate less.
///
/// # Errors
/// A case that cannot be built, that holds what cannot be treated, or whose program is not solved.
pub fn bound(case: &Case) -> Result<Bound, BoundError> {
    find(case, true)
}

/// The bounds alone, in a part of the time.
///
/// # Errors
/// As [`bound`].
pub fn bounds(case: &Case) -> Result<Bound, BoundError> {
    find(case, false)
}

fn find(case: &Case, beside: bool) -> Result<Bound, BoundError> {
    let (simulation, warnings) = refusal::staged(case)?;
    let outlines = outlines(simulation.case())?;
    let count = simulation.model().covers.block_count();
    let ends = |known| if beside { near_ends(case, simulation.built(), count, known) } else { Ok(None) };
    let blocks = Blocks::new(&simulation, &outlines);
    let blocks = blocks.map_err(|invalid| held(invalid, ends(Factor::AtLeast(RANGE[1]))))?;
    let Blocks { program, corners, interfaces, points } = blocks;
    let free = program.bodies.iter().filter(|body| body.is_free()).count();
    let mut search = Search { program: &program, programs: 0 };
    let unsolved = |error: Unsolved| BoundError::Unsolved { blocks: free, status: format!("{error:?}") };
    let associated = search.limit_near(&[], None).map_err(unsolved)?;
    let choice = search.facets(&corners, associated.clone()).map_err(unsolved)?;
    let both: Vec<Contact> = corners.iter().flat_map(|corner| corner.facets).collect();
    let catching = match both.is_empty() {
        true => associated.clone(),
        false => search.limit_near(&both, None).map_err(unsolved)?,
    };
    let barred = corner_contacts(&simulation);
    let free_corners = released::released(&mut search, barred, &corners, &choice.limit).map_err(unsolved)?;
    let opened = beside.then(|| opened::opened(&mut search, &associated)).transpose().map_err(unsolved)?;
    let (estimated, rounds) = opened.as_ref().map_or((None, 0), estimate::estimate);
    let boxes = way::boxes(&outlines, &simulation.model().covers.element_block, program.bodies.len());
    let collapse = |limit: &Limit| collapse(&simulation, &program, &boxes, limit);
    let built = simulation.built();
    let softens = built.traces.iter().any(|(_, law)| simulation.model().laws[*law].softening.is_some());
    let ductile = softens.then(|| DUCTILE.to_owned());
    let mut bound = Bound {
        associated: collapse(&associated),
        level_tops: collapse(&choice.limit),
        least: choice.least,
        catching: collapse(&catching),
        released: free_corners.map(|free| ReleasedCorners { collapse: collapse(&free.limit), corners: free.corners }),
        bare: opened.map(|o| Bare { collapse: collapse(&o.limit), share: o.share, interfaces: o.contacts }),
        estimate: estimated.as_ref().map(collapse),
        ends: None,
        blocks: [program.bodies.iter().filter(|body| !body.is_gone).count(), free],
        interfaces,
        points,
        corners: corners.len(),
        programs: search.programs + 2 * rounds,
        joint_water: simulation.pressure_in_joints(),
        softens,
        notes: built.notes.iter().cloned().chain(ductile).collect(),
        warnings,
    };
    bound.warnings.extend(bound.corners_warning());
    bound.warnings.extend(bound.warning());
    match ends(bound.level_tops.factor) {
        Ok(found) => bound.ends = found,
        Err(why) => bound.warnings.push(format!("there is no bound with the ends near lines joined: {why}")),
    }
    bound.warnings.extend(bound.ends.as_ref().map(NearEnds::warning));
    Ok(bound)
}

/// That every block is held, with the ends that hold them.
fn held(mut invalid: Invalid, ends: Result<Option<NearEnds>, String>) -> BoundError {
    let ends = ends.ok().flatten().map(Box::new);
    if let Some(ends) = &ends {
        invalid.message = format!("{}; {}", invalid.message, ends.warning());
    }
    BoundError::Held { invalid, ends }
}

/// The blocks of a model and where they can press on each other.
struct Blocks {
    program: Program,
    /// Corners that face each other at crossings.
    corners: Vec<Corner>,
    /// Straight interfaces, and corners that meet a face in a point.
    interfaces: usize,
    points: usize,
}

impl Blocks {
    fn new(simulation: &Simulation, outlines: &Outlines) -> Result<Self, Invalid> {
        let bodies = model::bodies(simulation);
        if !bodies.iter().any(Body::is_free) {
            let message = "every block is held, so that none can fail: free a block, or cut the rock by joints";
            return Err(Invalid { key: "fix".to_owned(), message: message.to_owned() });
        }
        let element_block = &simulation.model().covers.element_block;
        let strengths = Strengths::new(simulation, &bodies);
        let tolerance = 2.0 * simulation.built().noding.tolerance;
        let mut contacts = interfaces::interfaces(outlines, element_block, &strengths, tolerance);
        let interfaces = contacts.len();
        let (points, corners) = corner::corners(outlines, element_block, &strengths);
        let count = points.len();
        contacts.extend(points);
        let program = Program { contacts, bars: model::bars(simulation), bodies };
        Ok(Self { program, corners, interfaces, points: count })
    }
}

/// A limit as users see it: motions relative to the fastest block.
fn collapse(simulation: &Simulation, program: &Program, boxes: &[[Point; 2]], limit: &Limit) -> Collapse {
    let (model, bodies) = (simulation.model(), &program.bodies);
    let motions = limit.mechanism.as_ref().map_or(&[][..], |solution| &solution.motions);
    let fastest = program.fastest(motions);
    let speed = |b: BlockId| libm::hypot(motions[b].0.norm(), motions[b].1 * bodies[b].radius);
    let moving = BlockId::all(motions.len()).filter(|&b| fastest > 0.0 && speed(b) >= MOVES * fastest);
    let mut mechanism: Vec<MovingBlock> = moving
        .map(|b| MovingBlock {
            block: b.number(),
            position: bodies[b].centre,
            velocity: motions[b].0 / fastest,
            spin: motions[b].1 / fastest,
            speed: speed(b) / fastest,
            area: model.covers.block_area(b),
            mass: model.mass_matrix.total[b],
        })
        .collect();
    mechanism.sort_by(|a, b| b.speed.total_cmp(&a.speed).then(a.block.cmp(&b.block)));
    let normals = limit.mechanism.as_ref().map_or(&[][..], |solution| &solution.normals);
    let borne = way::borne(program, normals);
    let way = Way::of(&mechanism, boxes, &borne, simulation.acceleration());
    Collapse { factor: limit.factor(), mechanism, way }
}
