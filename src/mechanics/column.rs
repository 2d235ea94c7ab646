//! Free-field columns: rock beside the model that moves in one dimension and drives the free-field boundaries (Eqs. 49,
//! 50).

use crate::cover::BlockId;
use crate::geometry::Vector;

use super::Elasticity;

/// Motion of a free-field column, from its foot to its head.
#[derive(Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ColumnState {
    /// Displacement of each node (m).
    pub displacement: Vec<Vector>,
    /// Velocity of each node half a step ago (m/s).
    pub velocity: Vec<Vector>,
}

impl Clone for ColumnState {
    fn clone(&self) -> Self {
        Self { displacement: self.displacement.clone(), velocity: self.velocity.clone() }
    }

    /// Copies without allocating.
    fn clone_from(&mut self, other: &Self) {
        let Self { displacement, velocity } = other;
        self.displacement.clone_from(displacement);
        self.velocity.clone_from(velocity);
    }
}

impl ColumnState {
    /// A column of some nodes at rest.
    pub fn at_rest(nodes: usize) -> Self {
        Self { displacement: vec![Vector::zeros(); nodes], velocity: vec![Vector::zeros(); nodes] }
    }
}

/// Cause of the motion of the foot of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Foot {
    /// The base, with which it is rigid.
    Rigid,
    /// A quiet boundary, by its index.
    Quiet(u32),
}

/// A column of rock of unit width: equal cells between nodes, each with the rock at its middle (Eq. 49).
#[doc(alias = "free field")]
#[doc(alias = "site response")]
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Height y of the foot (m).
    pub foot_height: f64,
    /// Height of a cell (m).
    pub spacing: f64,
    /// Rock of each cell, from the foot.
    pub rocks: Vec<Elasticity>,
    /// Block of the model beside each node; those of one block are damped together.
    pub blocks: Vec<BlockId>,
    /// Cause of the motion of the foot.
    pub foot: Foot,
}

/// A position in a column: a cell and the share of its height.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ColumnPosition {
    cell: u32,
    share: f64,
}

/// Loads on a column in a step.
#[derive(Debug, Clone, Copy)]
pub struct ColumnDrive {
    /// Acceleration of its rock (m/s²) beside that by its own stress: that of the base, with the opposite sign.
    pub acceleration: Vector,
    /// Particle velocity (m/s) of the incident wave at a quiet foot.
    pub wave: Vector,
    /// Time over which forces act (s).
    pub kick: f64,
}

impl Column {
    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.rocks.len() + 1
    }

    /// Longest stable step (s): the way of a pressure wave through a cell (Eq. 50).
    pub fn critical_dt(&self) -> f64 {
        let through = |rock: &Elasticity| self.spacing / (rock.confined_modulus() / rock.density).sqrt();
        self.rocks.iter().map(through).fold(f64::INFINITY, f64::min)
    }

    /// The position at a height y (m).
    pub fn position(&self, y: f64) -> ColumnPosition {
        let height = ((y - self.foot_height) / self.spacing).clamp(0.0, self.rocks.len() as f64);
        let cell = (height as usize).min(self.rocks.len() - 1);
        ColumnPosition { cell: cell as u32, share: height - cell as f64 }
    }

    /// Mass of a node (kg/m per metre of width).
    fn mass(&self, node: usize) -> f64 {
        let cells = [node.checked_sub(1), Some(node)].into_iter().flatten().filter_map(|cell| self.rocks.get(cell));
        cells.map(|rock| 0.5 * rock.density * self.spacing).sum()
    }

    /// Shear and vertical stress (Pa) of each cell by the displacements.
    fn stress(&self, cell: usize, displacement: &[Vector]) -> Vector {
        let rock = &self.rocks[cell];
        let strain = (displacement[cell + 1] - displacement[cell]) / self.spacing;
        Vector::new(rock.mu * strain.x, rock.confined_modulus() * strain.y)
    }

    /// Writes the velocities (m/s) after the step; `decay` gives the damping factor of a block (Eqs. 49, 50).
    pub fn kick(&self, state: &ColumnState, drive: &ColumnDrive, decay: impl Fn(BlockId) -> f64, out: &mut [Vector]) {
        out.copy_from_slice(&state.velocity);
        self.damp(decay, out);
        let last = self.rocks.len();
        for (node, velocity) in out.iter_mut().enumerate() {
            let below = node.checked_sub(1).map_or_else(Vector::zeros, |cell| self.stress(cell, &state.displacement));
            let above = if node < last { self.stress(node, &state.displacement) } else { Vector::zeros() };
            *velocity += ((above - below) / self.mass(node) + drive.acceleration) * drive.kick;
        }
        match self.foot {
            Foot::Rigid => out[0] = Vector::zeros(),
            Foot::Quiet(_) => {
                let impedance = self.rocks[0].impedances();
                for axis in 0..2 {
                    let half = 0.5 * impedance[1 - axis] * drive.kick / self.mass(0);
                    let push = half * (4.0 * drive.wave[axis] - state.velocity[0][axis]);
                    out[0][axis] = (out[0][axis] + push) / (1.0 + half);
                }
            }
        }
    }

    /// Damps the velocities of the nodes beside each block relative to their mean.
    fn damp(&self, decay: impl Fn(BlockId) -> f64, velocity: &mut [Vector]) {
        let mut first = 0;
        while first < self.blocks.len() {
            let block = self.blocks[first];
            let end = first + self.blocks[first..].iter().take_while(|b| **b == block).count();
            let factor = decay(block);
            if factor < 1.0 {
                let mass: f64 = (first..end).map(|node| self.mass(node)).sum();
                let mean = (first..end).map(|node| velocity[node] * self.mass(node)).sum::<Vector>() / mass;
                velocity[first..end].iter_mut().for_each(|v| *v = mean + (*v - mean) * factor);
            }
            first = end;
        }
    }
}

impl ColumnPosition {
    /// A field of the nodes at this position.
    pub fn sample(&self, field: &[Vector]) -> Vector {
        let cell = self.cell as usize;
        field[cell] + (field[cell + 1] - field[cell]) * self.share
    }
}
