//! The pass over blocks: element forces and kick of one block after the other, in parallel over groups of blocks.

use std::ops::Range;

use crate::geometry::Vector;
use crate::mechanics::{self, BlockMotion, Damping, Deformation, Kick};
use crate::state::{Scratch, Slope, State};

use super::DECAY_MAX;

/// Covers below which a group of blocks is not split between threads.
const GRAIN: usize = 2048;

/// Covers below which a group of blocks is not split between threads.
pub(super) fn grain(serial: bool) -> usize {
    if serial { usize::MAX } else { GRAIN }
}

/// What every block of a pass shares.
pub(super) struct Pass<'a> {
    pub slope: &'a Slope,
    pub state: &'a State,
    pub acceleration: Vector,
    /// Covers below which a group of blocks is not split between threads.
    pub grain: usize,
    /// Deformation damping carries ξ·dt here; each block turns it into its own factor.
    pub damping: Damping,
    pub dt: f64,
}

/// The output slices of a group of blocks.
struct Group<'a> {
    blocks: Range<usize>,
    force: &'a mut [Vector],
    predicted: &'a mut [Vector],
    damped: &'a mut [Vector],
    motion: &'a mut [BlockMotion],
}

impl<'a> Group<'a> {
    fn split(self, block: usize, cover: usize) -> (Self, Self) {
        let (force, force_rest) = self.force.split_at_mut(cover);
        let (predicted, predicted_rest) = self.predicted.split_at_mut(cover);
        let (damped, damped_rest) = self.damped.split_at_mut(cover);
        let (motion, motion_rest) = self.motion.split_at_mut(block - self.blocks.start);
        let first = Group { blocks: self.blocks.start..block, force, predicted, damped, motion };
        let second = Group {
            blocks: block..self.blocks.end,
            force: force_rest,
            predicted: predicted_rest,
            damped: damped_rest,
            motion: motion_rest,
        };
        (first, second)
    }
}

impl Pass<'_> {
    /// Fills forces, predicted velocities and block motions of the scratch.
    pub fn run(&self, scratch: &mut Scratch) {
        scratch.speed_max = self.state.velocity.iter().map(|v| v.norm_squared()).fold(0.0, f64::max).sqrt();
        let Scratch { metric, force, predicted, damped, motion, load_force, .. } = scratch;
        force.copy_from_slice(load_force);
        self.group(metric, Group { blocks: 0..motion.len(), force, predicted, damped, motion });
    }

    fn group(&self, metric: &mechanics::Metric, group: Group) {
        let covers = &self.slope.covers;
        let first = covers.block_covers[group.blocks.start] as usize;
        if group.force.len() > self.grain && group.blocks.len() > 1 {
            let half = (first + group.force.len() / 2) as u32;
            let starts = &covers.block_covers[group.blocks.start + 1..group.blocks.end];
            let block = group.blocks.start + 1 + starts.partition_point(|&c| c < half).min(starts.len() - 1);
            let (left, right) = group.split(block, covers.block_covers[block] as usize - first);
            rayon::join(|| self.group(metric, left), || self.group(metric, right));
            return;
        }
        for (k, block) in group.blocks.enumerate() {
            let range = covers.covers_of(block);
            let local = range.start - first..range.end - first;
            group.motion[k] = self.block(
                metric,
                block,
                &mut group.force[local.clone()],
                &mut group.predicted[local.clone()],
                &mut group.damped[local],
            );
        }
    }

    fn block(
        &self,
        metric: &mechanics::Metric,
        block: usize,
        force: &mut [Vector],
        predicted: &mut [Vector],
        damped: &mut [Vector],
    ) -> BlockMotion {
        if metric.fixed[block] {
            predicted.fill(Vector::zeros());
            damped.fill(Vector::zeros());
            return BlockMotion::default();
        }
        self.push_elements(block, force);
        mechanics::kick(&self.kick(metric, block), force, predicted, damped)
    }

    fn kick<'a>(&'a self, metric: &'a mechanics::Metric, block: usize) -> Kick<'a> {
        Kick {
            acceleration: self.acceleration,
            damping: self.block_damping(metric, block),
            dt: self.dt,
            ..resting(self.slope, metric, &self.state.displacement, &self.state.velocity, block)
        }
    }

    /// Work (J/m) that damping took from all blocks in a step that ended with the predicted velocities of the scratch.
    pub fn damping_work(&self, scratch: &Scratch) -> f64 {
        (0..scratch.motion.len())
            .filter(|&b| !scratch.metric.fixed[b])
            .map(|b| mechanics::damping_work(&self.kick(&scratch.metric, b), &scratch.predicted))
            .sum()
    }

    /// Adds the element forces of a block to its covers (Eq. 7).
    fn push_elements(&self, block: usize, force: &mut [Vector]) {
        let (slope, u) = (self.slope, &self.state.displacement);
        let covers = &slope.covers;
        let first = covers.block_covers[block];
        for e in covers.elements_of(block) {
            let ids = covers.element_covers[e];
            let g = &covers.gradients[covers.element_triangle[e].set as usize];
            let deformation = Deformation::new(ids.map(|i| u[i as usize]), g);
            let area = covers.element_area[e];
            let mut forces = deformation.forces(g, area, slope.rock_of(e), &slope.pre_stress_of(e));
            if let Some((strength, plastic)) = self.state.plastic.get(e).and_then(|p| Some((slope.strength_of(e)?, p)))
            {
                let relief = strength.forces(&deformation, g, area, plastic);
                forces.iter_mut().zip(relief).for_each(|(f, r)| *f += r);
            }
            for (i, f) in ids.into_iter().zip(forces) {
                force[(i - first) as usize] += f;
            }
        }
    }

    /// Damping factor of one block: exp(−2ξπ·cs/√A·dt) relative to its rigid motion; or the common one, of
    /// a block that is lighter by the root of that faster.
    fn block_damping(&self, metric: &mechanics::Metric, block: usize) -> Damping {
        match self.damping {
            Damping::Deformation(ratio_dt) if ratio_dt > 0.0 => {
                Damping::Deformation((-(ratio_dt * self.slope.block_frequency[block]).min(DECAY_MAX)).exp())
            }
            Damping::Deformation(_) => Damping::Deformation(1.0),
            Damping::Mass(factor) if metric.lightness > 1.0 && metric.is_free(block) => {
                Damping::Mass(factor.powf(metric.lightness.sqrt()).max((-DECAY_MAX).exp()))
            }
            mass => mass,
        }
    }
}

/// One block's slices with neither damping nor force: for its energy and momentum.
pub(super) fn resting<'a>(
    slope: &'a Slope,
    metric: &'a mechanics::Metric,
    displacement: &'a [Vector],
    velocity: &'a [Vector],
    block: usize,
) -> Kick<'a> {
    Kick {
        metric,
        block,
        covers: slope.covers.covers_of(block),
        star: &slope.covers.star_position,
        displacement,
        velocity,
        acceleration: Vector::zeros(),
        damping: Damping::Deformation(1.0),
        dt: 0.0,
    }
}
