//! The search for the section of a block that is nearest to its strength.

use rayon::prelude::*;

use crate::cover::{BlockId, CoverId, ElementId};
use crate::geometry::{Point, Vector};
use crate::mechanics::{CoverPart, Resultants, RockStrength, SectionCut, SectionFailure};
use crate::state::{Model, State, Workspace, WorstSection};
use crate::step::Regime;

use super::blocks::{BreakableBlock, BreakableBlocks};
use super::chord::{Chord, CoverShare, end_at, place};
use super::cores::principal;
use super::forces::{BlockForce, BlockForces};
use super::outline::{End, Outline};

/// Share of its strength below which no section of a block needs to be looked at.
const IDLE: f64 = 0.3;
/// Share of its strength from which on sections across the stress of a block are looked at, too.
const NEAR: f64 = 0.5;
/// How often the worst section is moved along its face, each time by half as much.
const REFINEMENTS: usize = 3;

/// Blocks that are looked at in a step, and what their rock carries at its start.
#[derive(Debug, Clone)]
pub struct Watched {
    /// The blocks.
    pub blocks: Vec<BlockId>,
    /// Forces (N/m) of their elements on their covers, by block (Eq. 7).
    internal: Vec<Vec<Vector>>,
    /// Start of the step (s).
    time: f64,
}

/// Takes down what the rock of some blocks carries at the start of a step.
pub fn watch(model: &Model, state: &State, blocks: Vec<BlockId>, time: f64) -> Watched {
    let internal = blocks.par_iter().map(|&block| internal_forces(model, state, block)).collect();
    Watched { blocks, internal, time }
}

/// Forces (N/m) of the elements of a block on its covers.
fn internal_forces(model: &Model, state: &State, block: BlockId) -> Vec<Vector> {
    let covers = &model.covers;
    let range = covers.covers_of(block);
    let mut forces = vec![Vector::zeros(); range.len()];
    for e in ElementId::range(covers.elements_of(block)) {
        let gradients = &covers.gradients[covers.element_triangle[e].set as usize];
        let at = model.deformation(e, &state.displacement);
        let of_element = at.forces(gradients, covers.element_area[e], model.rock_of(e), &model.pre_stress_of(e));
        for (cover, force) in covers.element_covers[e].iter().zip(of_element) {
            forces[cover.index() - range.start] += force;
        }
    }
    forces
}

/// How far (rad) a block has turned: its largest element.
fn turn(model: &Model, state: &State, block: BlockId) -> f64 {
    let covers = &model.covers;
    let elements = ElementId::range(covers.elements_of(block));
    let largest = elements.max_by(|&a, &b| covers.element_area[a].total_cmp(&covers.element_area[b]));
    largest.map_or(0.0, |e| model.deformation(e, &state.displacement).rotation())
}

/// The last step, in which sections are looked for.
pub struct Search<'a> {
    /// The model.
    pub model: &'a Model,
    /// Its state at the end of the step.
    pub state: &'a State,
    /// Buffers of the step.
    pub workspace: &'a Workspace,
    /// Blocks that can break.
    pub breakable: &'a BreakableBlocks,
    /// How the stage treats gravity.
    pub regime: Regime,
}

impl Search<'_> {
    /// The section of each block that is nearest to its strength. Those of blocks that were near it are looked at
    /// alone unless all are `wanted`.
    pub fn worst(&self, watched: &Watched, all_wanted: bool) -> Vec<(BlockId, WorstSection)> {
        let step = (self.model, self.state, self.workspace);
        let forces = BlockForces::of_step(step, &watched.blocks, (self.regime, watched.time));
        let factor = self.state.drive.strength_factor_now(watched.time);
        let blocks = watched.blocks.par_iter().zip(&watched.internal).zip(&forces);
        let found = blocks.filter_map(|((&block, internal), points)| {
            let loaded = LoadedBlock::new(self, self.breakable.of(block)?, (internal, points), factor)?;
            Some((block, loaded.worst(all_wanted)))
        });
        found.collect()
    }
}

/// A block with all forces on it.
struct LoadedBlock<'a> {
    model: &'a Model,
    state: &'a State,
    block: &'a BreakableBlock,
    outline: &'a Outline,
    strength: RockStrength,
    internal: &'a [Vector],
    points: &'a [BlockForce],
    /// Forces on its covers (N/m), but those that act by mass.
    on_covers: Vec<Vector>,
    /// Places of its covers (m).
    places: Vec<Point>,
    /// Whether a fixity holds each of its covers; empty of a block that none holds.
    held: Vec<bool>,
    /// How far it has turned (rad).
    turn: f64,
    /// Where the x axis of the reference configuration points now.
    heading: Vector,
    /// Whether it also splits from within.
    splits: bool,
}

impl<'a> LoadedBlock<'a> {
    fn new(
        search: &Search<'a>,
        block: &'a BreakableBlock,
        (internal, points): (&'a [Vector], &'a [BlockForce]),
        factor: f64,
    ) -> Option<Self> {
        let Search { model, state, workspace, .. } = *search;
        let outline = &block.outline;
        let rock = model.breaking.as_ref()?.rocks[outline.rock as usize].as_ref()?;
        let RockStrength { tension, cohesion, friction, characteristic } = rock.strength;
        let [tension, cohesion, friction] = [tension, cohesion, friction].map(|value| value * factor);
        let covers = model.covers.covers_of(outline.block);
        let mut on_covers = internal.to_vec();
        for point in points {
            for (cover, w) in point.covers.iter().zip(point.weights) {
                on_covers[cover.index() - covers.start] += point.force * w;
            }
        }
        let is_held = |i: CoverId| workspace.mass_matrix.inverse[i].min() == 0.0;
        let mut held: Vec<bool> = CoverId::range(covers.clone()).map(is_held).collect();
        if !held.contains(&true) {
            held.clear();
        }
        let place = |i: CoverId| model.covers.star_position[i] + state.displacement[i];
        let strength = RockStrength { tension, cohesion, friction, characteristic };
        let places = CoverId::range(covers).map(place).collect();
        let turn = turn(model, state, outline.block);
        let heading = Vector::new(libm::cos(turn), libm::sin(turn));
        let splits = rock.cores;
        Some(Self {
            model,
            state,
            block,
            outline,
            strength,
            internal,
            points,
            on_covers,
            places,
            held,
            turn,
            heading,
            splits,
        })
    }

    /// Its section that is nearest to its strength.
    fn worst(&self, all_wanted: bool) -> WorstSection {
        let was = self.state.worst_sections[self.outline.block];
        let bound = self.bound();
        if bound < IDLE {
            return WorstSection { share: bound, barred: was.barred, ..WorstSection::default() };
        }
        let mut worst = (WorstSection { barred: was.barred, ..WorstSection::default() }, None);
        if was.share >= NEAR {
            let ends = was.ends.map(|end| end_at(self.outline, end));
            worst = self.worse(worst, Chord::between(self.model, self.outline, ends).as_ref());
        }
        if !all_wanted && worst.1.is_some() {
            return worst.0;
        }
        for chord in self.block.chords(self.model) {
            worst = self.worse(worst, Some(chord));
        }
        let (stress, axis) = self.mean_stress();
        if worst.0.share >= NEAR || stress >= NEAR {
            for start in self.outline.starts(self.model) {
                for way in self.ways(axis) {
                    worst = self.worse(worst, Chord::along(self.model, self.outline, start, way).as_ref());
                }
            }
            worst = self.refined(worst);
        }
        self.worse_core(worst.0)
    }

    /// The worse of a section that was found and one through a core that splits.
    fn worse_core(&self, worst: WorstSection) -> WorstSection {
        if !self.splits {
            return worst;
        }
        let Some((tension, chord)) = self.block.cores.worst(self.model, self.state, self.outline, self.turn) else {
            return worst;
        };
        let share = tension / self.strength.tension;
        let carries = self.share(&chord).map(|(_, _, carries)| carries);
        match carries.filter(|_| share > worst.share) {
            Some(carries) => {
                let failure = SectionFailure::Splits;
                WorstSection { share, ends: chord.places, carries, failure, barred: worst.barred }
            }
            None => worst,
        }
    }

    /// Directions in which rock under a stress fails whose greatest tension has an axis: across it, and in shear at an
    /// angle of 45° - φ/2 to the greatest pressure; each to both sides.
    fn ways(&self, axis: Vector) -> [Vector; 6] {
        let across = Vector::new(-axis.y, axis.x);
        let angle = std::f64::consts::FRAC_PI_4 - 0.5 * libm::atan(self.strength.friction);
        let [along, aside] = [across * libm::cos(angle), axis * libm::sin(angle)];
        [across, -across, along + aside, along - aside, aside - along, -along - aside]
    }

    /// The worse of a section that was found and another one.
    fn worse(
        &self,
        worst: (WorstSection, Option<[End; 2]>),
        chord: Option<&Chord>,
    ) -> (WorstSection, Option<[End; 2]>) {
        let Some((chord, (share, failure, carries))) = chord.and_then(|chord| Some((chord, self.share(chord)?))) else {
            return worst;
        };
        if share <= worst.0.share && worst.1.is_some() {
            return worst;
        }
        (WorstSection { share, ends: chord.places, carries, failure, barred: worst.0.barred }, Some(chord.ends))
    }

    /// Moves the worst section along the face at its start as long as that makes it worse.
    fn refined(&self, mut worst: (WorstSection, Option<[End; 2]>)) -> (WorstSection, Option<[End; 2]>) {
        let mut step = 0.25 * self.model.covers.mesh.size;
        for _ in 0..REFINEMENTS {
            let Some([start, end]) = worst.1 else { return worst };
            let way = (place(self.outline, end) - place(self.outline, start)).normalize();
            for by in [-step, step] {
                let start = self.outline.shifted(start, by);
                worst = self.worse(worst, Chord::along(self.model, self.outline, start, way).as_ref());
            }
            step *= 0.5;
        }
        worst
    }

    /// No section of the block has a greater share of its strength: each side carries at most half of all forces, with
    /// the extent of the block as their arm.
    fn bound(&self) -> f64 {
        let points: f64 = self.points.iter().map(|point| point.force.norm()).sum();
        let on_covers: f64 = self.on_covers.iter().map(|force| force.norm()).sum();
        let length = self.model.boundary.block_thickness[self.outline.block];
        let force = 0.5 * (points + on_covers);
        let opens = force / length * (1.0 + 6.0 * self.outline.extent / length) / self.strength.tension;
        let slides =
            if self.strength.cohesion > 0.0 { force / (length * self.strength.cohesion) } else { f64::INFINITY };
        opens.max(slides)
    }

    /// Share of its strength that the mean stress of the block has, and the axis of its greatest tension in the
    /// reference configuration.
    fn mean_stress(&self) -> (f64, Vector) {
        let (mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0);
        let area = self.model.covers.block_area(self.outline.block);
        for (place, force) in self.places.iter().zip(self.internal) {
            xx -= force.x * place.x / area;
            yy -= force.y * place.y / area;
            xy -= 0.5 * (force.x * place.y + force.y * place.x) / area;
        }
        let (tension, angle) = principal([xx, yy, xy]);
        let middle = 0.5 * (xx + yy);
        let RockStrength { tension: strength, cohesion, friction, .. } = self.strength;
        let secant = (1.0 + friction * friction).sqrt();
        let pressure = cohesion - friction * middle;
        let slides = if pressure > 0.0 { (tension - middle) * secant / pressure } else { f64::INFINITY };
        let angle = angle - self.turn;
        ((tension / strength).max(slides), Vector::new(libm::cos(angle), libm::sin(angle)))
    }

    /// The share of its strength that a section has, how it fails, and what it carries. None where fixities hold rock
    /// on both sides of it, since what they carry is not known point by point.
    fn share(&self, chord: &Chord) -> Option<(f64, SectionFailure, Resultants)> {
        let turns = self.held_on(chord)?;
        let ends = chord.ends.map(|end| self.moved(end));
        let masses = self.outline.masses(self.model);
        let carries = if turns {
            let mut right: Vec<_> = masses.arms.iter().map(|&arm| CoverShare { share: 1.0, arm }).collect();
            for (k, left) in chord.covers(masses) {
                right[k] = CoverShare { share: right[k].share - left.share, arm: right[k].arm - left.arm };
            }
            let covers = right.into_iter().enumerate().map(|(k, part)| self.cover_part(k, part));
            let points = self.points.iter().map(|force| self.part(chord, force, 1));
            let seen_from_there = SectionCut { ends: [ends[1], ends[0]] }.resultants(covers, points);
            Resultants { moment: -seen_from_there.moment, ..seen_from_there }
        } else {
            let covers = chord.covers(masses).map(|(k, part)| self.cover_part(k, part));
            SectionCut { ends }.resultants(covers, self.points.iter().map(|f| self.part(chord, f, 0)))
        };
        // Bending is that of beams, whose sections are square to their faces.
        let counts = if chord.is_square { carries } else { Resultants { moment: 0.0, ..carries } };
        let (share, failure) = counts.share(chord.length(), &self.strength);
        Some((share, failure, carries))
    }

    /// Place (m) and amount (N/m) of what a force gives to the rock on one side of a section: 0 for its left.
    fn part(&self, chord: &Chord, force: &BlockForce, side: usize) -> (Point, Vector) {
        let (left, middles) = chord.share_of(force.piece);
        let share = if side == 0 { left } else { 1.0 - left };
        let off = middles[side] - (force.piece[0] + force.piece[1]) * 0.5;
        (force.at + self.turned(off), force.force * share)
    }

    /// A part of a cover as it is now.
    fn cover_part(&self, k: usize, CoverShare { share, arm }: CoverShare) -> CoverPart {
        CoverPart { share, star: self.places[k], arm: self.turned(arm), force: self.on_covers[k] }
    }

    /// A way in the reference configuration, turned with the block.
    fn turned(&self, way: Vector) -> Vector {
        let (c, s) = (self.heading.x, self.heading.y);
        Vector::new(c * way.x - s * way.y, s * way.x + c * way.y)
    }

    /// Whether fixities hold rock on the left of a section alone; none where they hold it on both sides.
    fn held_on(&self, chord: &Chord) -> Option<bool> {
        if self.held.is_empty() {
            return Some(false);
        }
        let mut rest = self.held.clone();
        let (mut left, mut cut) = (false, false);
        for (k, part) in chord.covers(self.outline.masses(self.model)) {
            if std::mem::take(&mut rest[k]) {
                left = true;
                cut |= part.share < 1.0;
            }
        }
        let right = cut || rest.contains(&true);
        if left && right { None } else { Some(left) }
    }

    /// Where an end is now (m).
    fn moved(&self, End { edge, along }: End) -> Point {
        let boundary = &self.model.boundary;
        let edge = self.outline.edges[edge];
        let now = |k| boundary.reference[k] + boundary.sample(k, &self.state.displacement);
        let [a, b] = [now(edge), now(boundary.after(edge))];
        a + (b - a) * along
    }
}
