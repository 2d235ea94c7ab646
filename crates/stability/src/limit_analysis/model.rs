//! Rigid blocks with the forces on them, and the strength of their joints, bolts and fixities.

use enmm::geometry::{Point, TraceId, Vector};
use enmm::model::Simulation;
use enmm::model::tables::{BlockId, LawId};

use super::contact::{Contact, outward};

/// Acceleration of gravity (m/s²) that weighs blocks where there is none.
const STANDARD_GRAVITY: f64 = 9.81;
/// Weight, over the mean of all free blocks, with which lighter blocks are measured, so that slivers do not spoil the
/// numbers.
const LEAST_WEIGHT: f64 = 1e-3;
/// Share of a hold that the others must leave unexplained for it to count.
const INDEPENDENT: f64 = 1e-6;

/// A rigid block; forces per metre of depth.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Mass centroid (m).
    pub centre: Point,
    /// Radius (m) of the circle of the same area.
    pub radius: f64,
    /// Weight (N/m) by which unbalanced forces are measured.
    pub weight: f64,
    /// Resultant (N/m) of weight, loads and water.
    pub force: Vector,
    /// Their moment (N·m/m) about the centroid, counter-clockwise.
    pub moment: f64,
    /// Independent directions that fixities hold; three hold the block altogether.
    pub holds: Vec<[f64; 3]>,
    /// Whether it has been excavated.
    pub is_gone: bool,
}

impl Body {
    /// Whether it can move in some way.
    pub fn is_free(&self) -> bool {
        !self.is_gone && self.holds.len() < 3
    }

    /// Share of a force along `direction` at `at` in the equilibrium of the block: along x, along y, and the moment
    /// about its centroid over its radius.
    pub fn share(&self, at: Point, direction: Vector) -> [f64; 3] {
        [direction.x, direction.y, (at - self.centre).perp(&direction) / self.radius]
    }

    /// Takes note of a direction that is held at a position, when no other holds explain it.
    fn hold(&mut self, at: Point, direction: Vector) {
        let mut rest = self.share(at, direction);
        let dot = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
        let before = dot(&rest, &rest).sqrt();
        for held in &self.holds {
            let along = dot(&rest, held);
            (0..3).for_each(|k| rest[k] -= along * held[k]);
        }
        let left = dot(&rest, &rest).sqrt();
        if left > INDEPENDENT * before {
            self.holds.push(rest.map(|x| x / left));
        }
    }
}

/// A bolt's free length: it pulls its ends towards each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bar {
    /// Blocks of both ends.
    pub blocks: [BlockId; 2],
    /// Positions of both ends (m).
    pub ends: [Point; 2],
    /// Tension (N/m) at which it yields; infinite for never.
    pub yield_force: f64,
}

/// The blocks of a model in the stage that it has reached, at their positions before any motion.
pub fn bodies(simulation: &Simulation) -> Vec<Body> {
    let (model, state) = (simulation.model(), simulation.state());
    let covers = &model.covers;
    let acceleration = simulation.acceleration();
    let gravity = if acceleration.norm() > 0.0 { acceleration.norm() } else { STANDARD_GRAVITY };
    let pushes = simulation.load_forces();
    let body = |b: BlockId| {
        let mass = model.mass_matrix.total[b];
        let sum: Point = covers.covers_of(b).map(|i| covers.star_position[i] * model.mass_matrix.row_sum[i]).sum();
        let centre = sum / mass;
        // Weights of covers reproduce rigid motion, so that their forces have the resultant of what acts.
        let force: Vector = covers.covers_of(b).map(|i| pushes[i]).sum();
        let moment = covers.covers_of(b).map(|i| (covers.star_position[i] - centre).perp(&pushes[i])).sum();
        Body {
            centre,
            radius: (covers.block_area(b) / std::f64::consts::PI).sqrt(),
            weight: mass * gravity,
            force: force + acceleration * mass,
            moment,
            holds: Vec::new(),
            is_gone: state.removed[b],
        }
    };
    let mut bodies: Vec<Body> = covers.blocks().map(body).collect();
    hold(simulation, &mut bodies);
    let free = bodies.iter().filter(|body| body.is_free());
    let least = LEAST_WEIGHT * free.clone().map(|body| body.weight).sum::<f64>() / free.count().max(1) as f64;
    bodies.iter_mut().for_each(|body| body.weight = body.weight.max(least));
    bodies
}

/// Applies all fixities that hold.
fn hold(simulation: &Simulation, bodies: &mut [Body]) {
    let (model, state) = (simulation.model(), simulation.state());
    let covers = &model.covers;
    let axes = [Vector::x(), Vector::y()];
    for (fixity, _) in model.fixities.iter().zip(&state.fix_active).filter(|(_, active)| **active) {
        for &(cover, held) in &fixity.covers {
            let body = &mut bodies[covers.cover_block[cover]];
            let at = covers.star_position[cover];
            (0..2).filter(|&k| held[k]).for_each(|k| body.hold(at, axes[k]));
        }
    }
    for support in model.supports.iter().filter(|s| state.fix_active[s.fix as usize]) {
        let at = support.covers.iter().zip(support.weights).map(|(&i, w)| covers.star_position[i] * w).sum();
        bodies[support.block].hold(at, support.direction);
    }
}

/// The bolts that are installed and join two blocks.
pub fn bars(simulation: &Simulation) -> Vec<Bar> {
    let (model, state) = (simulation.model(), simulation.state());
    let installed = model.bolts.iter().zip(&state.bolts).filter(|(_, state)| state.active && !state.broken);
    let bar = |(segment, _): (&enmm::model::BoltSegment, _)| Bar {
        blocks: segment.blocks,
        ends: segment.points,
        yield_force: segment.yield_force,
    };
    installed.map(bar).filter(|bar| bar.blocks[0] != bar.blocks[1]).collect()
}

/// Strength of the joints of a model in the stage that it has reached, and which blocks are there and can move.
pub struct Strengths<'a> {
    simulation: &'a Simulation,
    bodies: &'a [Body],
}

impl<'a> Strengths<'a> {
    /// Reads laws, changes of laws and switches of laws.
    pub fn new(simulation: &'a Simulation, bodies: &'a [Body]) -> Self {
        Self { simulation, bodies }
    }

    /// Law of faces that a joint trace has made, after switches.
    pub fn law(&self, trace: Option<TraceId>) -> LawId {
        let model = self.simulation.model();
        let law = trace.map_or(model.default_law, |trace| model.trace_law[trace]);
        self.simulation.state().law_switch[law]
    }

    /// Whether a block has been excavated.
    pub fn is_gone(&self, block: BlockId) -> bool {
        self.bodies[block].is_gone
    }

    /// Whether two blocks are both there, and one of them can move.
    pub fn can_act(&self, blocks: [BlockId; 2]) -> bool {
        !blocks.iter().any(|&b| self.is_gone(b)) && blocks.iter().any(|&b| self.bodies[b].is_free())
    }

    /// An interface from one end to the other, the first block on its left.
    pub fn face(&self, blocks: [BlockId; 2], ends: [Point; 2], law: LawId) -> Contact {
        let along = ends[1] - ends[0];
        self.contact(law, blocks, ends, outward(along), [along.norm(); 2])
    }

    /// A corner against a face that some trace has made: it has friction, and no length for cohesion. Its springs are
    /// those of a face as long as the lesser radius of both blocks.
    pub fn point(&self, blocks: [BlockId; 2], at: Point, normal: Vector, trace: Option<TraceId>) -> Contact {
        let radius = self.bodies[blocks[0]].radius.min(self.bodies[blocks[1]].radius);
        self.contact(self.law(trace), blocks, [at; 2], normal, [0.0, radius])
    }

    /// A contact with the strength of one length (m) and the springs of another.
    fn contact(
        &self,
        law: LawId,
        blocks: [BlockId; 2],
        ends: [Point; 2],
        normal: Vector,
        [strong, stiff]: [f64; 2],
    ) -> Contact {
        let law = &self.simulation.state().laws[law];
        Contact {
            blocks,
            ends,
            normal,
            friction: law.friction,
            cohesion: law.cohesion * strong,
            tension: law.tension * strong,
            dilation: law.dilation,
            stiffness: [law.normal_stiffness * stiff, law.shear_stiffness * stiff],
        }
    }
}
