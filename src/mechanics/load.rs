//! External loads and their time tables: forces on covers from points, faces, blocks and all rock.

use crate::cover::{BlockId, CoverId, Weights};
use crate::geometry::{Point, Vector};

use super::MassMatrix;
use super::pressure::{inward, part};

/// Takes forces of loads on the rock.
pub trait Forces {
    /// Takes a force (N/m) at a material point.
    fn at_point(&mut self, covers: &[CoverId; 3], weights: &Weights, force: Vector);

    /// Takes an even load (N/m in all) between two points of an element, given by the weights there.
    fn on_piece(&mut self, covers: &[CoverId; 3], ends: &[Weights; 2], force: Vector) {
        self.at_point(covers, &[0, 1, 2].map(|k| 0.5 * (ends[0][k] + ends[1][k])), force);
    }

    /// Takes the forces (N/m) at both ends of an edge that stand for a load on it.
    fn on_edge(&mut self, covers: &[[CoverId; 3]; 2], weights: &[Weights; 2], forces: [Vector; 2]) {
        (0..2).for_each(|e| self.at_point(&covers[e], &weights[e], forces[e]));
    }

    /// Takes a force (N/m) on a cover that is part of one on all rock of its block, by its mass.
    fn on_rock(&mut self, cover: CoverId, force: Vector);
}

/// Forces (N/m) by cover.
impl Forces for [Vector] {
    fn at_point(&mut self, covers: &[CoverId; 3], weights: &Weights, force: Vector) {
        for (cover, w) in covers.iter().zip(weights) {
            self[*cover] += force * *w;
        }
    }

    fn on_rock(&mut self, cover: CoverId, force: Vector) {
        self[cover] += force;
    }
}

/// Factor over time: linear between rows, constant beyond both ends; no rows mean 1.
#[doc(alias = "load curve")]
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TimeTable(pub Vec<[f64; 2]>);

impl TimeTable {
    /// Factor at time `t` (s).
    pub fn at(&self, t: f64) -> f64 {
        let rows = &self.0;
        let after = rows.partition_point(|row| row[0] <= t);
        match (after.checked_sub(1).map(|k| rows[k]), rows.get(after)) {
            (None, None) => 1.0,
            (None, Some(next)) => next[1],
            (Some(last), None) => last[1],
            (Some(last), Some(next)) => last[1] + (next[1] - last[1]) * (t - last[0]) / (next[0] - last[0]),
        }
    }
}

/// An edge of the boundary with covers, weights and fluid pressure (Pa) of both ends, rock on its left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadedFace {
    /// Covers of both ends.
    pub covers: [[CoverId; 3]; 2],
    /// Weights of both ends.
    pub weights: [Weights; 2],
    /// Shares of the way along the edge between which the fluid is.
    pub span: [f64; 2],
    /// Pressure (Pa) at both ends of that part, linear between, pushing into the rock.
    pub pressure: [f64; 2],
}

/// Where and how a load acts, resolved to covers.
#[derive(Debug, Clone, PartialEq)]
pub enum LoadAction {
    /// Force (N/m) at material points: covers, weights, force.
    Forces(Vec<([CoverId; 3], Weights, Vector)>),
    /// Force (N/m) on pieces of boundary, given by the covers of their element and the weights of both ends.
    Tractions(Vec<([CoverId; 3], [Weights; 2], Vector)>),
    /// Pressure (Pa) on pieces of boundary, given by the covers of their element and the weights of both ends.
    Pressure(Vec<([CoverId; 3], [Weights; 2])>, f64),
    /// Fluid pressure on faces of joints.
    Faces(Vec<LoadedFace>),
    /// Acceleration (m/s²) of all rock.
    Body(Vector),
    /// Force (N/m) and moment (N·m/m) about the centroid of a block.
    Block(BlockId, Vector, f64),
}

/// A load with its time table.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// Forces, pressures or accelerations.
    pub action: LoadAction,
    /// Factor over time.
    pub table: TimeTable,
}

impl Load {
    /// Acceleration (m/s²) that this load gives to all rock at time `t` (s).
    pub fn body(&self, t: f64) -> Vector {
        match self.action {
            LoadAction::Body(a) => a * self.table.at(t),
            _ => Vector::zeros(),
        }
    }

    /// Gives the forces of this load at time `t` (s).
    ///
    /// `position` gives the current position of a cover's star, `block` the covers of a block.
    pub fn push(
        &self,
        t: f64,
        position: impl Fn(CoverId) -> Point,
        block: impl Fn(BlockId) -> std::ops::Range<usize>,
        mass_matrix: &MassMatrix,
        force: &mut (impl Forces + ?Sized),
    ) {
        let factor = self.table.at(t);
        match &self.action {
            LoadAction::Forces(list) => {
                for (covers, weights, f) in list {
                    force.at_point(covers, weights, f * factor);
                }
            }
            LoadAction::Tractions(list) => {
                for (covers, ends, f) in list {
                    force.on_piece(covers, ends, f * factor);
                }
            }
            LoadAction::Pressure(list, pressure) => {
                for (covers, ends) in list {
                    let [a, b] = ends.map(|w| (0..3).map(|k| position(covers[k]) * w[k]).sum::<Point>());
                    force.on_piece(covers, ends, inward(a, b) * (pressure * factor));
                }
            }
            LoadAction::Faces(faces) => {
                for LoadedFace { covers, weights, span, pressure } in faces {
                    let [a, b] = [0, 1].map(|e| (0..3).map(|k| position(covers[e][k]) * weights[e][k]).sum::<Point>());
                    let forces = part(inward(a, b), *span, pressure.map(|p| p * factor));
                    force.on_edge(covers, weights, forces);
                }
            }
            LoadAction::Body(_) => {}
            LoadAction::Block(id, f, moment) => {
                push_block(block(*id), &position, mass_matrix, f * factor, moment * factor, force);
            }
        }
    }
}

/// Spreads a force and a moment over a block so that it moves as a rigid body: μ·f/M and m·(x − x_D)^⊥·τ/J_D.
pub fn push_block(
    covers: std::ops::Range<usize>,
    position: &impl Fn(CoverId) -> Point,
    mass_matrix: &MassMatrix,
    f: Vector,
    moment: f64,
    force: &mut (impl Forces + ?Sized),
) {
    let total: f64 = mass_matrix.row_sum[covers.clone()].iter().sum();
    let covers = CoverId::range(covers);
    let centre = covers.clone().map(|i| position(i) * mass_matrix.mass[i]).sum::<Point>() / total;
    let polar: f64 = covers.clone().map(|i| mass_matrix.mass[i] * (position(i) - centre).norm_squared()).sum();
    for i in covers {
        let arm = position(i) - centre;
        let spin = Vector::new(-arm.y, arm.x) * (mass_matrix.mass[i] * moment / polar);
        force.on_rock(i, f * (mass_matrix.row_sum[i] / total) + spin);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_linear_between_rows_and_constant_beyond() {
        let table = TimeTable(vec![[1.0, 2.0], [3.0, 6.0]]);
        assert_eq!([0.0, 1.0, 2.0, 3.0, 9.0].map(|t| table.at(t)), [2.0, 2.0, 4.0, 6.0, 6.0]);
        assert_eq!(TimeTable::default().at(5.0), 1.0);
    }

    #[test]
    fn a_block_moment_has_no_resultant_force() {
        let positions = [Point::new(0.0, 0.0), Point::new(2.0, 0.0), Point::new(0.0, 1.0)];
        let load =
            Load { action: LoadAction::Block(BlockId::new(0), Vector::zeros(), 5.0), table: TimeTable::default() };
        let mut force = [Vector::zeros(); 3];
        let [mass, row_sum] = [[2.0; 3], [1.0, 2.0, 3.0]].map(std::sync::Arc::from);
        let mass_matrix = MassMatrix { mass, row_sum, ..MassMatrix::default() };
        load.push(0.0, |i| positions[i], |_| 0..3, &mass_matrix, &mut force[..]);
        let torque: f64 = positions.iter().zip(&force).map(|(x, f)| x.perp(f)).sum();
        assert!(force.iter().sum::<Vector>().norm() < 1e-15 && (torque - 5.0).abs() < 1e-14);
    }
}
