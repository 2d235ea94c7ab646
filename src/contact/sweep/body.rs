//! Bodies under impulses: what a material point of a block moves by, and what its block keeps of them (Eq. 17).

use crate::contact::Pair;
use crate::geometry::{NONE, Vector};

use super::SweepView;

/// Impulse sums of a block: what turns one contact's impulse into everybody's velocity in constant time (Eq. 17).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BlockPush {
    /// P = Σ impulses (N·s/m).
    pub impulse: Vector,
    /// Z = Σ z·impulse (N·s/m); within the iteration Z/M (m/s).
    pub weighted: Vector,
    /// L = Σ arm × impulse (N·m·s/m).
    pub moment: f64,
}

/// A run of blocks under impulses.
pub struct Ground<'a> {
    /// √m times the velocity increment of each cover by its own impulses (kg½·m½/s).
    pub own: &'a mut [Vector],
    /// First cover of the run.
    pub first_cover: u32,
    /// Impulse sums of the blocks.
    pub push: &'a mut [BlockPush],
    /// Turn in which each block last moved by more than what has settled.
    pub moved: &'a mut [u32],
    /// First block of the run.
    pub first_block: u32,
}

impl Ground<'_> {
    /// The whole run.
    #[inline(always)]
    pub fn all(&mut self) -> Ground<'_> {
        let Self { own, first_cover, push, moved, first_block } = self;
        Ground { own, first_cover: *first_cover, push, moved, first_block: *first_block }
    }

    /// Notes a turn, or 0, for blocks of the run. Turns grow.
    #[inline(always)]
    pub fn mark(&mut self, blocks: [u32; 2], turn: u32) {
        for block in blocks {
            let moved = &mut self.moved[(block - self.first_block) as usize];
            *moved = turn.max(*moved);
        }
    }

    /// The runs before and from a block whose first cover is `cover` on.
    pub fn split(&mut self, block: u32, cover: u32) -> (Ground<'_>, Ground<'_>) {
        let (own, own_rest) = self.own.split_at_mut((cover - self.first_cover) as usize);
        let (push, push_rest) = self.push.split_at_mut((block - self.first_block) as usize);
        let (moved, moved_rest) = self.moved.split_at_mut((block - self.first_block) as usize);
        let first = Ground { own, push, moved, first_cover: self.first_cover, first_block: self.first_block };
        let (first_cover, first_block) = (cover, block);
        (first, Ground { own: own_rest, push: push_rest, moved: moved_rest, first_cover, first_block })
    }
}

/// A material point of a block. Weights are divided by the roots of the covers' masses, so that the same ones give and
/// take.
#[derive(Debug, Clone, Copy, Default)]
pub struct Body {
    covers: [u32; 3],
    /// Block, or none when it is held: it then moves by its covers alone.
    block: u32,
    /// w/√m along each axis, 0 where held.
    weights: [Vector; 3],
    /// J90·(arm from the block's centroid) (m).
    lever: Vector,
    /// (1 + S/M − z)/M (m/kg).
    share: f64,
    /// z/M (m/kg).
    part: f64,
    /// C of the block.
    spin: f64,
}

impl Body {
    /// Takes body `k` of a pair.
    #[inline(always)]
    pub fn load(&mut self, pair: &Pair, k: usize, view: &SweepView) {
        let SweepView { metric, roots } = view;
        let block = pair.blocks[k] as usize;
        let (inverse, square, spin) = (metric.inverse_total[block], metric.square[block], metric.spin[block]);
        self.covers = pair.covers[k];
        self.block = if metric.is_free(block) { block as u32 } else { NONE };
        for j in 0..3 {
            self.weights[j] = roots[pair.covers[k][j] as usize] * pair.weights[k][j];
        }
        self.lever = Vector::new(-pair.arms[k].y, pair.arms[k].x);
        self.share = (1.0 + square * inverse - pair.z[k]) * inverse;
        self.part = pair.z[k] * inverse;
        self.spin = spin;
    }

    /// Body `k` of a pair.
    pub fn new(pair: &Pair, k: usize, view: &SweepView) -> Self {
        let mut body = Self::default();
        body.load(pair, k, view);
        body
    }

    /// Block that carries it, unless that is held.
    #[inline(always)]
    pub fn block(&self) -> u32 {
        self.block
    }

    /// Where its covers are in a run of blocks.
    #[inline(always)]
    pub fn places(&self, ground: &Ground) -> [usize; 3] {
        let place = |j: usize| (self.covers[j] - ground.first_cover) as usize;
        let (a, b, c) = (place(0), place(1), place(2));
        let count = ground.own.len();
        assert!((a < count) & (b < count) & (c < count), "a body lies outside its run of blocks");
        [a, b, c]
    }

    /// Velocity (m/s) that all impulses so far give it.
    #[inline(always)]
    pub fn velocity(&self, places: &[usize; 3], ground: &Ground) -> Vector {
        let own = |j: usize| self.weights[j].component_mul(&ground.own[places[j]]);
        let mut velocity = own(0) + own(1) + own(2);
        if self.block != NONE {
            let push = &ground.push[(self.block - ground.first_block) as usize];
            velocity += push.impulse * self.share - push.weighted + self.lever * (self.spin * push.moment);
        }
        velocity
    }

    /// Takes an impulse (N·s/m).
    #[inline(always)]
    pub fn push(&self, impulse: Vector, places: &[usize; 3], ground: &mut Ground) {
        ground.own[places[0]] += self.weights[0].component_mul(&impulse);
        ground.own[places[1]] += self.weights[1].component_mul(&impulse);
        ground.own[places[2]] += self.weights[2].component_mul(&impulse);
        if self.block != NONE {
            let push = &mut ground.push[(self.block - ground.first_block) as usize];
            push.impulse += impulse;
            push.weighted += impulse * self.part;
            push.moment += self.lever.dot(&impulse);
        }
    }
}
