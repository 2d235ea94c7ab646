//! Whether a slope has failed: how much of its rock has gone, how far, and in which way (theory, section 16).

use std::f64::consts::PI;
use std::fmt;

use crate::contact::ContactState;
use crate::cover::{BlockId, ElementId};
use crate::geometry::{Point, Vector, polygon};
use crate::state::Model;

use super::Simulation;
use super::case::StageKind;
use super::mechanism::{self, Mechanism, RigidMotion, SLIGHT};
use super::observe::{mean, rotation};

/// Displacement over the height of the model from which a slope that is not at rest has failed.
const GONE: f64 = 0.01;

/// A failure of a slope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlopeFailure {
    /// The way in which it moves.
    pub mechanism: Mechanism,
    /// Blocks that have moved by more than a tenth of the largest displacement.
    pub blocks: usize,
    /// Mass of the rock that has (kg/m).
    pub mass: f64,
    /// The rock that has gone farthest.
    pub farthest: Farthest,
}

/// Rock that has moved farthest, without the few blocks that do not count ([`Simulation::mass_of_few`]).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Farthest {
    /// Its displacement (m).
    pub displacement: f64,
    /// Number of its block, as hosts see it.
    pub block: u32,
    /// Centroid where the motion began (m).
    pub place: Point,
}

impl fmt::Display for Farthest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { displacement, block, place } = self;
        // Three digits.
        let decimals =
            if *displacement > 0.0 { (2.0 - libm::log10(*displacement).floor()).clamp(0.0, 9.0) } else { 0.0 };
        let decimals = decimals as usize;
        write!(
            f,
            "largest displacement {displacement:.decimals$} m (block {block} at ({:.2}, {:.2}) m)",
            place.x, place.y
        )
    }
}

impl fmt::Display for SlopeFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let blocks = if self.blocks == 1 { "block" } else { "blocks" };
        write!(f, "by {}: {} {blocks}, {}", self.mechanism.noun(), self.blocks, self.farthest)
    }
}

/// Rock that moves as a rigid body: a block, or an element of one.
struct Body {
    block: BlockId,
    element: Option<ElementId>,
    motion: RigidMotion,
}

impl Body {
    fn way(&self) -> f64 {
        self.motion.motion.norm()
    }
}

impl Simulation {
    /// The failure of the slope since its covers had other displacements (m); none if it has not failed.
    ///
    /// It has if rock has moved by more than `solver.failure_displacement`, or, unless it is at rest, by more than a
    /// hundredth of the height of the model; in both cases farther than its elasticity explains, and not counting the
    /// few blocks that went farthest ([`Simulation::mass_of_few`]).
    pub fn failure_since(&self, began: &[Vector], is_at_rest: bool) -> Option<SlopeFailure> {
        let bodies = self.bodies(began);
        let first = bodies.first().filter(|body| body.way() > self.failure_distance(is_at_rest))?;
        let farthest = first.farthest(self.model());
        let taking_part = || bodies.iter().filter(|body| body.way() > SLIGHT * farthest.displacement);
        let mut blocks: Vec<BlockId> = taking_part().map(|body| body.block).collect();
        blocks.sort_unstable();
        blocks.dedup();
        let motions: Vec<RigidMotion> = taking_part().map(|body| body.motion).collect();
        Some(SlopeFailure {
            mechanism: mechanism::mechanism(&motions, self.state().drive.gravity(1.0))?,
            blocks: blocks.len(),
            mass: motions.iter().map(|motion| motion.mass).sum(),
            farthest,
        })
    }

    /// The failure of the slope since the stage in progress began, if that is a static one, or else since the start.
    pub fn failure(&self, is_at_rest: bool) -> Option<SlopeFailure> {
        match self.stage_began() {
            Some(began) => self.failure_since(began, is_at_rest),
            None => self.failure_since(&vec![Vector::zeros(); self.state().displacement.len()], is_at_rest),
        }
    }

    /// The way in which some blocks have moved since their covers had other displacements (m); none where nothing
    /// moves.
    pub fn mechanism_since(&self, began: &[Vector], blocks: &[BlockId]) -> Option<Mechanism> {
        let of_these = self.blocks_since(began).into_iter().filter(|body| blocks.contains(&body.block));
        let motions: Vec<RigidMotion> = of_these.map(|body| body.motion).collect();
        mechanism::mechanism(&motions, self.state().drive.gravity(1.0))
    }

    /// The rock that has moved farthest since its covers had other displacements (m); none where nothing can move.
    pub fn farthest_since(&self, began: &[Vector]) -> Option<Farthest> {
        self.bodies(began).first().map(|body| body.farthest(self.model()))
    }

    /// Whether the static stage in progress will not come to rest: rock has failed, gravity acts in full, and the rock
    /// that has failed is faster than in the mean of the stage so far, while motion that dies becomes slower.
    pub fn has_run_away(&self) -> bool {
        let state = self.state();
        let Some((began, (ramp, _))) = self.stage_began().zip(self.rest_target()) else { return false };
        let time = self.time() - state.stage_start;
        if time < 1.5 * ramp {
            return false;
        }
        let limit = self.failure_distance(true);
        let is_far = |(now, before): (&Vector, &Vector)| (now - before).norm() > limit;
        if !state.displacement.iter().zip(began).any(is_far) {
            return false;
        }
        let (mut way, mut pace) = (0.0, 0.0);
        for body in self.bodies(began).iter().take_while(|body| body.way() > limit) {
            let RigidMotion { mass, motion, .. } = body.motion;
            way += mass * motion.norm();
            pace += mass * self.velocity_of(body).dot(&motion) / motion.norm();
        }
        way > 0.0 && pace * time > way
    }

    /// Displacements of the covers (m) at the start of the static stage in progress.
    fn stage_began(&self) -> Option<&[Vector]> {
        (self.stage().kind == StageKind::Static).then_some(&self.state().stage_displacement[..])
    }

    /// Displacement (m) from which rock has failed: that of the case, and of rock that is not at rest at most a
    /// hundredth of the height; but more than twice the settlement ρgH²/2(λ+2μ) of the softest rock.
    fn failure_distance(&self, is_at_rest: bool) -> f64 {
        let model = self.model();
        let (low, high) = polygon::bounds(&model.covers.star_position);
        let height = (high - low).y;
        let gravity = self.state().drive.gravity(1.0).norm();
        let doubled = |density: f64, modulus: f64| density * gravity * height * height / modulus;
        let settlements = model.rocks.iter().map(|rock| doubled(rock.density, rock.lambda + 2.0 * rock.mu));
        let limit = model.failure_displacement;
        let limit = if is_at_rest { limit } else { limit.min(GONE * height) };
        settlements.fold(limit, f64::max)
    }

    /// Motion of all rock that can move since its covers had other displacements (m), the farthest first, without the
    /// few blocks that went farthest: of its blocks, or where rock yields of its elements. Ground that quiet edges let
    /// swing takes its motion from that of all others.
    fn bodies(&self, began: &[Vector]) -> Vec<Body> {
        let ground = self.ground_motion(began);
        let mut bodies = if self.case().yields() { self.elements_since(began) } else { self.blocks_since(began) };
        bodies.iter_mut().for_each(|body| body.motion.motion -= ground);
        bodies.sort_by(|a, b| b.way().total_cmp(&a.way()).then(a.block.cmp(&b.block)));
        let mut room = self.mass_of_few();
        bodies.retain(|body| {
            let fits = body.motion.mass <= room;
            room -= if fits { body.motion.mass } else { 0.0 };
            !fits
        });
        bodies
    }

    fn can_move(&self) -> impl Iterator<Item = BlockId> {
        let (fixed, removed) = (&self.workspace().mass_matrix.fixed, &self.state().removed);
        self.model().covers.blocks().filter(move |&b| !fixed[b] && !removed[b])
    }

    fn blocks_since(&self, began: &[Vector]) -> Vec<Body> {
        let (model, now) = (self.model(), &self.state().displacement);
        let borne = self.borne();
        let boxes = self.boxes(began);
        let body = |block: BlockId| {
            let before = mean(model, began, block);
            let turn = rotation(model, now, block) - rotation(model, began, block);
            let motion = RigidMotion {
                mass: model.mass_matrix.total[block],
                centroid: mean(model, &model.covers.star_position, block) + before,
                bounds: boxes[block.index()],
                motion: mean(model, now, block) - before,
                turn: turn - 2.0 * PI * (turn / (2.0 * PI)).round(),
                is_borne: borne[block.index()],
            };
            Body { block, element: None, motion }
        };
        self.can_move().map(body).collect()
    }

    /// Elements as squares of their area.
    fn elements_since(&self, began: &[Vector]) -> Vec<Body> {
        let (model, now) = (self.model(), &self.state().displacement);
        let covers = &model.covers;
        let borne = self.borne();
        let body = |block: BlockId, element: ElementId| {
            let middle = covers.element_centroid[element];
            let half = 0.5 * covers.element_area[element].sqrt();
            let since = |place: Point| model.sample(element, place, now) - model.sample(element, place, began);
            let [x, y] = [Vector::x(), Vector::y()].map(|axis| since(middle + axis * half) - since(middle));
            let centroid = middle + model.sample(element, middle, began);
            let density = model.rocks[model.element_rock[element] as usize].density;
            let motion = RigidMotion {
                mass: density * covers.element_area[element],
                centroid,
                bounds: [-half, half].map(|half| centroid + Vector::repeat(half)),
                motion: since(middle),
                turn: 0.5 * (x.y - y.x) / half,
                is_borne: borne[block.index()],
            };
            Body { block, element: Some(element), motion }
        };
        let of_block = |block| ElementId::range(covers.elements_of(block)).map(move |element| (block, element));
        self.can_move().flat_map(of_block).map(|(block, element)| body(block, element)).collect()
    }

    fn velocity_of(&self, body: &Body) -> Vector {
        let (model, velocity) = (self.model(), &self.state().velocity);
        match body.element {
            Some(element) => model.sample(element, model.covers.element_centroid[element], velocity),
            None => mean(model, velocity, body.block),
        }
    }

    /// Mean motion (m) of the blocks with dashpots, which the waves of an earthquake carry along; none without.
    fn ground_motion(&self, began: &[Vector]) -> Vector {
        let model = self.model();
        let mut ground: Vec<BlockId> = model.supports.iter().filter(|s| s.is_dashpot()).map(|s| s.block).collect();
        ground.sort_unstable();
        ground.dedup();
        let mass: f64 = ground.iter().map(|&b| model.mass_matrix.total[b]).sum();
        let moved = |&b: &BlockId| mean(model, &self.state().displacement, b) - mean(model, began, b);
        let sum: Vector = ground.iter().map(|b| moved(b) * model.mass_matrix.total[*b]).sum();
        if mass > 0.0 { sum / mass } else { Vector::zeros() }
    }

    /// Whether contacts, supports or bolts on each block carry force.
    fn borne(&self) -> Vec<bool> {
        let (model, state) = (self.model(), self.state());
        let boundary = &model.boundary;
        let mut borne = vec![false; model.covers.block_count()];
        for contact in state.contacts.iter().filter(|contact| contact.state != ContactState::Open) {
            for point in [boundary.nodes.point[contact.node], contact.edge] {
                borne[boundary.block[point].index()] = true;
            }
        }
        let holds = |fix: u32| state.fix_active[fix as usize];
        model.supports.iter().filter(|s| holds(s.fix)).for_each(|s| borne[s.block.index()] = true);
        let bolts = model.bolts.iter().zip(&state.bolts).filter(|(_, bolt)| bolt.active && !bolt.broken);
        bolts.flat_map(|(segment, _)| segment.blocks).for_each(|block| borne[block.index()] = true);
        borne
    }

    /// Lowest and greatest coordinates (m) of the corners of each block under these displacements of the covers (m).
    fn boxes(&self, displacement: &[Vector]) -> Vec<[Point; 2]> {
        let boundary = &self.model().boundary;
        let start = [Point::repeat(f64::INFINITY), Point::repeat(f64::NEG_INFINITY)];
        let mut boxes = vec![start; self.model().covers.block_count()];
        for point in boundary.edges() {
            let place = boundary.reference[point] + boundary.sample(point, displacement);
            let [low, high] = &mut boxes[boundary.block[point].index()];
            (*low, *high) = (low.inf(&place), high.sup(&place));
        }
        boxes
    }
}

impl Body {
    fn farthest(&self, model: &Model) -> Farthest {
        Farthest { displacement: self.way(), block: model.labels[self.block], place: self.motion.centroid }
    }
}
