//! Points of blocks side by side: one of the contacts of each of eight block pairs, and what moves with it (Eq. 17).

use enmm_lanes::{Arithmetic, LANES, Places, Values};

use crate::contact::pair::{common_share, compliance_of_body, velocity_of_body};
use crate::cover::{BlockId, CoverId, Weights};
use crate::geometry::Vector;
use crate::mechanics::{BlockMotion, MassMatrix};

use super::wide_block::{F64x8, WideBlock};

/// One material point of each contact. Numbers begin at lines of the cache.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C, align(64))]
pub struct Points {
    /// w/√m.
    weights: [F64x8; 3],
    /// z/M (m/kg).
    mass_share: F64x8,
    /// Covers, from the first one of the part of the order on.
    covers: [Places; 3],
    /// Lanes, a bit each, whose covers are held along one axis alone, by axis; no weight is on what is held along both.
    held: [[u8; 2]; 3],
    /// Whether one of them is.
    holds: bool,
}

/// Masses and centroids of a block of each of eight block pairs.
#[derive(Debug, Default)]
pub struct Bodies {
    pub blocks: [BlockId; LANES],
    /// Centroid (m).
    centre: [F64x8; 2],
    /// Of a free block 1/M (1/kg·m), (1 + S/M)/M (m/kg) and C; 0 of a held one.
    pub share: F64x8,
    common: F64x8,
    spin: F64x8,
}

impl Bodies {
    /// A block of each lane.
    #[inline(always)]
    pub fn new(blocks: &[BlockId; LANES], mass_matrix: &MassMatrix, motion: &[BlockMotion]) -> Self {
        let mut bodies = Self { blocks: *blocks, ..Self::default() };
        for (lane, &block) in blocks.iter().enumerate() {
            let centre = motion[block].centre;
            (bodies.centre[0][lane], bodies.centre[1][lane]) = (centre.x, centre.y);
            bodies.share[lane] = mass_matrix.inverse_total[block];
            bodies.common[lane] = common_share(mass_matrix, block);
            bodies.spin[lane] = mass_matrix.spin[block];
        }
        bodies
    }
}

impl Points {
    /// Has no covers.
    #[inline(always)]
    pub fn begin(&mut self) {
        (self.covers, self.holds) = ([Places::default(); 3], false);
    }

    /// Takes covers and weights of a point; covers count from the first one of the part of the order on.
    #[inline(always)]
    pub fn take(&mut self, lane: usize, (covers, weights): (&[CoverId; 3], &Weights), first_cover: CoverId) {
        for k in 0..3 {
            self.covers[k].set(lane, covers[k].number() - first_cover.number());
            self.weights[k][lane] = weights[k];
        }
    }

    /// Leaves a lane without a point.
    #[inline(always)]
    pub fn leave_out(&mut self, lane: usize) {
        for k in 0..3 {
            self.covers[k].set(lane, self.covers[k].index(0));
            self.weights[k][lane] = 0.0;
        }
    }

    /// A cover field at the points, while weights are those of positions.
    #[inline(always)]
    pub fn sample<L: Values>(&self, lanes: L, field: &[Vector]) -> [L::F; 2] {
        let mut sum = [lanes.splat(0.0); 2];
        for k in 0..3 {
            let (weight, [x, y]) = (lanes.load(&self.weights[k]), lanes.gather_from(field, &self.covers[k]));
            sum = [sum[0] + weight * x, sum[1] + weight * y];
        }
        sum
    }

    /// Divides the weights by the roots of the covers' masses, and finds the shares of points at `at` (m); returns
    /// the inverse effective masses (m/kg) along the normals and along the tangents (Eq. 4). `inverse` is 1/m of the
    /// covers, and `masses` those of the [`SolverView`](super::SolverView).
    #[inline(always)]
    pub fn weigh<L: Values>(
        &mut self,
        lanes: L,
        at: [L::F; 2],
        [x, y]: [L::F; 2],
        blocks: &Bodies,
        [inverse, masses]: [&[Vector]; 2],
    ) -> [L::F; 2] {
        let zero = lanes.splat(0.0);
        let (mut own, mut z) = ([zero; 2], zero);
        for k in 0..3 {
            let [root, share] = lanes.gather_from(masses, &self.covers[k]);
            let weight = lanes.load(&self.weights[k]);
            let divided = weight * lanes.max(root, -root);
            let (mut along_x, mut along_y) = (divided * divided, divided * divided);
            self.held[k] = [0; 2];
            let half = lanes.at_most(root, zero) & !lanes.at_most(zero, root);
            if half != 0 {
                self.hold(k, half, inverse);
                along_x = lanes.select(self.held[k][0], zero, along_x);
                along_y = lanes.select(self.held[k][1], zero, along_y);
            }
            own = [own[0] + along_x, own[1] + along_y];
            z = z + weight * share;
            lanes.store(divided, &mut self.weights[k]);
        }
        let (mass_share, spin) = (z * lanes.load(&blocks.share), lanes.load(&blocks.spin));
        let lever = lever([lanes.load(&blocks.centre[0]), lanes.load(&blocks.centre[1])], at);
        lanes.store(mass_share, &mut self.mass_share);
        let common = lanes.load(&blocks.common) - (mass_share + mass_share);
        let [along, across] = [lever[0] * x + lever[1] * y, lever[1] * x - lever[0] * y];
        [compliance_of_body(own, common, spin, [x, y], along), compliance_of_body(own, common, spin, [-y, x], across)]
    }

    /// Notes along which axis the `k`-th covers of some lanes are held.
    #[cold]
    #[inline(never)]
    fn hold(&mut self, k: usize, lanes: u8, inverse: &[Vector]) {
        self.holds = true;
        for lane in (0..LANES).filter(|lane| lanes >> lane & 1 == 1) {
            let axis = usize::from(inverse[self.covers[k].index(lane) as usize].y == 0.0);
            self.held[k][axis] |= 1 << lane;
        }
    }

    /// Both points of some lanes lie in one block: its motion as a whole is felt and pushed by their difference, and
    /// covers that they share once, by the first point.
    #[cold]
    #[inline(never)]
    pub fn join(&mut self, lanes: u8, others: &mut Self) {
        for lane in (0..LANES).filter(|lane| lanes >> lane & 1 == 1) {
            self.mass_share[lane] -= std::mem::take(&mut others.mass_share[lane]);
            for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
                if self.covers[i].index(lane) == others.covers[j].index(lane) {
                    self.weights[i][lane] -= std::mem::take(&mut others.weights[j][lane]);
                }
            }
        }
    }

    /// Covers that move with the point of a lane.
    pub fn moved(&self, lane: usize) -> impl Iterator<Item = u32> {
        let covers = self.covers.iter().zip(&self.weights);
        covers.filter(move |(_, weights)| weights[lane] != 0.0).map(move |(covers, _)| covers.index(lane))
    }

    /// Impulses on their own covers: zero where these are held.
    #[inline(always)]
    pub fn cover_impulse<L: Values>(&self, lanes: L, cover_impulse: &[Vector]) -> [[L::F; 2]; 3] {
        let mut found = [
            lanes.gather_from(cover_impulse, &self.covers[0]),
            lanes.gather_from(cover_impulse, &self.covers[1]),
            lanes.gather_from(cover_impulse, &self.covers[2]),
        ];
        if self.holds {
            let zero = lanes.splat(0.0);
            for (found, held) in found.iter_mut().zip(&self.held) {
                *found = [lanes.select(held[0], zero, found[0]), lanes.select(held[1], zero, found[1])];
            }
        }
        found
    }

    /// Velocities (m/s) that all impulses so far give them.
    #[inline(always)]
    pub fn velocity<L: Values>(
        &self,
        lanes: L,
        at: [L::F; 2],
        cover_impulse: &[[L::F; 2]; 3],
        side: &WideBlock<L>,
    ) -> [L::F; 2] {
        let [w, u, v] = [lanes.load(&self.weights[0]), lanes.load(&self.weights[1]), lanes.load(&self.weights[2])];
        let share = side.common - lanes.load(&self.mass_share);
        let (turn, lever) = (side.spin * side.moment, lever(side.centre, at));
        let x = (w * cover_impulse[0][0] + u * cover_impulse[1][0]) + v * cover_impulse[2][0];
        let y = (w * cover_impulse[0][1] + u * cover_impulse[1][1]) + v * cover_impulse[2][1];
        let weighted = [side.unit * side.weighted[0], side.unit * side.weighted[1]];
        let of_body = velocity_of_body(side.impulse, weighted, turn, share, lever);
        [x + of_body[0], y + of_body[1]]
    }

    /// They take impulses (N·s/m).
    #[inline(always)]
    pub fn push<L: Values>(
        &self,
        lanes: L,
        at: [L::F; 2],
        [x, y]: [L::F; 2],
        before: &[[L::F; 2]; 3],
        side: &mut WideBlock<L>,
        cover_impulse: &mut [Vector],
    ) {
        for (k, before) in before.iter().enumerate() {
            let w = lanes.load(&self.weights[k]);
            lanes.scatter_to([before[0] + w * x, before[1] + w * y], cover_impulse, &self.covers[k]);
        }
        let mass_share = lanes.load(&self.mass_share);
        let lever = lever(side.centre, at);
        side.impulse = [side.impulse[0] + side.unit * x, side.impulse[1] + side.unit * y];
        side.weighted = [side.weighted[0] + mass_share * x, side.weighted[1] + mass_share * y];
        side.moment = side.moment + side.unit * (lever[0] * x + lever[1] * y);
    }
}

/// J90·(arm from a centroid) of points (m).
#[inline(always)]
fn lever<T: Arithmetic>(centre: [T; 2], at: [T; 2]) -> [T; 2] {
    [centre[1] - at[1], at[0] - centre[0]]
}
