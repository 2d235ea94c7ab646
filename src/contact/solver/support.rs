//! Supports in the iteration: between two sweeps over contacts they answer all together, by a direct solution.

use crate::contact::{Support, SupportRow};
use crate::cover::CoverId;
use crate::geometry::Vector;

/// A support as the iteration sees it.
#[derive(Debug, Clone, Copy, Default)]
struct SupportEquation {
    /// Index among the rows of the step.
    row: u32,
    covers: [CoverId; 3],
    /// Direction times w/√m of each cover, 0 where held.
    weights: [Vector; 3],
    /// Force (N/m) at no velocity by impulses.
    rest: f64,
    /// Loss of force per velocity (N·s/m per metre).
    viscosity: f64,
    /// Force (N/m).
    force: f64,
}

/// All supports of a stage with the factor L·D·Lᵀ of δᵢⱼ/aᵢ + kick·Gᵢⱼ, G being the velocities by each other's unit
/// impulses. Neighbours along a boundary are neighbours in the order, so that the factor has a narrow band.
#[derive(Debug, Clone, Default)]
pub struct SupportSystem {
    rows: Vec<SupportEquation>,
    /// First column of each row of the factor, and where its columns up to the diagonal end.
    first: Vec<u32>,
    end: Vec<u32>,
    factor: Vec<f64>,
    /// Changes of the forces (N/m).
    change: Vec<f64>,
    /// Parameters of the factor: kick (s) and viscosities.
    kick: f64,
    viscosity: Vec<f64>,
}

impl SupportSystem {
    /// Bytes of rows and factor.
    pub fn bytes(&self) -> usize {
        size_of_val(self.rows.as_slice()) + size_of_val(self.factor.as_slice())
    }
}

impl SupportEquation {
    fn along(&self, cover_impulse: &[Vector]) -> f64 {
        (0..3).map(|k| self.weights[k].dot(&cover_impulse[self.covers[k]])).sum()
    }

    fn push(&self, impulse: f64, cover_impulse: &mut [Vector]) {
        for (cover, weight) in self.covers.iter().zip(&self.weights) {
            cover_impulse[*cover] += weight * impulse;
        }
    }

    /// Velocity of one by a unit impulse of the other (m/kg).
    fn coupling(&self, other: &Self) -> f64 {
        let pairs = (0..9).map(|k| (k / 3, k % 3)).filter(|&(i, j)| self.covers[i] == other.covers[j]);
        pairs.map(|(i, j)| self.weights[i].dot(&other.weights[j])).sum()
    }
}

impl SupportSystem {
    /// Takes the supports of a stage; `inverse` is 1/m of the covers along each axis.
    pub fn prepare(&mut self, supports: &[Support], rows: &[SupportRow], inverse: &[Vector]) {
        self.rows.clear();
        self.rows.extend((0..).zip(rows).map(|(k, row)| {
            let support = &supports[row.support as usize];
            let along = |j: usize| inverse[support.covers[j]].map(f64::sqrt).component_mul(&support.direction);
            let weights = [0, 1, 2].map(|j| along(j) * support.weights[j]);
            SupportEquation { row: k, covers: support.covers, weights, ..SupportEquation::default() }
        }));
        let order = order_along_boundary(&self.rows, inverse.len());
        let sorted: Vec<SupportEquation> = order.iter().map(|&k| self.rows[k]).collect();
        self.rows = sorted;
        // First row of each cover.
        let mut seen = vec![None; inverse.len()];
        self.first.clear();
        self.end.clear();
        let mut end = 0;
        for (k, equation) in (0u32..).zip(&self.rows) {
            let first = equation.covers.iter().map(|&i| *seen[i].get_or_insert(k)).min().unwrap_or(k);
            end += k + 1 - first;
            self.first.push(first);
            self.end.push(end);
        }
        self.viscosity.clear();
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Takes what the supports answer to in a step, and pushes with their forces so far.
    pub fn warm_start(&mut self, rows: &[SupportRow], kick: f64, cover_impulse: &mut [Vector]) {
        for equation in &mut self.rows {
            let row = &rows[equation.row as usize];
            equation.rest = row.target - row.viscosity * row.approach;
            (equation.viscosity, equation.force) = (row.viscosity, row.force);
            equation.push(equation.force * kick, cover_impulse);
        }
        let known = self.kick == kick && self.viscosity.len() == self.rows.len();
        if !(known && self.viscosity.iter().zip(&self.rows).all(|(a, equation)| *a == equation.viscosity)) {
            self.factorise(kick);
        }
    }

    fn factorise(&mut self, kick: f64) {
        self.kick = kick;
        self.viscosity.clear();
        self.viscosity.extend(self.rows.iter().map(|equation| equation.viscosity));
        self.factor.clear();
        for (i, row) in self.rows.iter().enumerate() {
            let (first, start) = (self.first[i] as usize, self.factor.len());
            for j in first..i {
                let mut entry = kick * row.coupling(&self.rows[j]);
                let from = first.max(self.first[j] as usize);
                let above = self.end[j] as usize - 1 - j;
                for k in from..j {
                    entry -= self.factor[start + k - first] * self.factor[above + k];
                }
                self.factor.push(entry);
            }
            let mut diagonal = 1.0 / row.viscosity + kick * row.coupling(row);
            for j in first..i {
                let entry = self.factor[start + j - first];
                let scaled = entry / self.factor[self.end[j] as usize - 1];
                diagonal -= scaled * entry;
                self.factor[start + j - first] = scaled;
            }
            self.factor.push(diagonal);
        }
    }

    /// All supports answer; returns their largest change over the largest force.
    pub fn sweep(&mut self, cover_impulse: &mut [Vector]) -> f64 {
        self.change.clear();
        for (i, row) in self.rows.iter().enumerate() {
            let first = self.first[i] as usize;
            let columns = &self.factor[self.end[i] as usize - 1 - (i - first)..self.end[i] as usize - 1];
            let mut value = (row.rest - row.force) / row.viscosity - row.along(cover_impulse);
            for (entry, known) in columns.iter().zip(&self.change[first..i]) {
                value -= entry * known;
            }
            self.change.push(value);
        }
        for (value, &end) in self.change.iter_mut().zip(&self.end) {
            *value /= self.factor[end as usize - 1];
        }
        for i in (0..self.rows.len()).rev() {
            let (first, end) = (self.first[i] as usize, self.end[i] as usize - 1);
            let columns = &self.factor[end - (i - first)..end];
            let value = self.change[i];
            for (entry, rest) in columns.iter().zip(&mut self.change[first..i]) {
                *rest -= entry * value;
            }
        }
        let (mut change, mut largest) = (0.0, f64::MIN_POSITIVE);
        for (row, step) in self.rows.iter_mut().zip(&self.change) {
            row.push(step * self.kick, cover_impulse);
            row.force += step;
            change = step.abs().max(change);
            largest = row.force.abs().max(largest);
        }
        change / largest
    }

    /// Stores the forces in the rows of the step.
    pub fn store_forces(&self, rows: &mut [SupportRow]) {
        self.rows.iter().for_each(|equation| rows[equation.row as usize].force = equation.force);
    }
}

/// Supports one after the other along the boundaries: each before those that share a cover with it and have not had
/// their turn.
fn order_along_boundary(rows: &[SupportEquation], covers: usize) -> Vec<usize> {
    let mut last = vec![None; covers];
    // Rows of each cover as chains: the row before that has the cover as its k-th.
    let mut before = vec![[None; 3]; rows.len()];
    for (k, row) in rows.iter().enumerate() {
        for (j, &cover) in row.covers.iter().enumerate() {
            before[k][j] = last[cover].replace(k);
        }
    }
    let mut order = Vec::with_capacity(rows.len());
    let mut listed = vec![false; rows.len()];
    let mut next = 0;
    for start in 0..rows.len() {
        if !std::mem::replace(&mut listed[start], true) {
            order.push(start);
        }
        while let Some(&row) = order.get(next) {
            next += 1;
            for &cover in &rows[row].covers {
                let mut other = last[cover];
                while let Some(row) = other {
                    if !std::mem::replace(&mut listed[row], true) {
                        order.push(row);
                    }
                    let slot = rows[row].covers.iter().position(|&i| i == cover);
                    other = slot.and_then(|j| before[row][j]);
                }
            }
        }
    }
    order
}
