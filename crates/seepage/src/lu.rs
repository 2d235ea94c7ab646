//! Factors of a matrix with a symmetric pattern, without pivots: the matrices of Newton's method are M-matrices, whose
//! dominant diagonals need none. Serial and in a fixed order, so that results have the same bits on any machine.
//!
//! The matrix is stored by its diagonal and by pairs of nodes, in the order of elimination: row by row up to the
//! diagonal, each pair with the entry below it and the one above. Both factors share one list of places, since the
//! pattern is symmetric; row k of the lower one and column k of the upper one are found together (Davis, Direct
//! Methods for Sparse Linear Systems, 2006, §6.1).

use crate::error::Refused;

/// No place.
const NONE: u32 = u32::MAX;

/// Pattern of a net's matrix and of its factors.
#[derive(Debug, Clone)]
pub struct Symbolic {
    /// Node at each place of the order.
    order: Vec<u32>,
    /// Pair of each pipe, and whether its upper node is the later one in the order.
    pub pairs: Vec<(u32, bool)>,
    /// Where the pairs of each place, as the later one, start.
    rows: Vec<u32>,
    /// Earlier place of each pair.
    earlier: Vec<u32>,
    /// Where the row of each place starts in `reach`.
    reach_rows: Vec<u32>,
    /// Columns of the rows of the lower factor, in rising order.
    reach: Vec<u32>,
    /// Where the column of each place starts in `below`.
    columns: Vec<u32>,
    /// Rows of the columns of the lower factor, in rising order.
    below: Vec<u32>,
}

/// Values of a matrix.
#[derive(Debug, Clone)]
pub struct Matrix {
    /// Diagonal, by node.
    pub diagonal: Vec<f64>,
    /// Of each pair the entry in the row of its later node.
    pub low: Vec<f64>,
    /// Of each pair the entry in the row of its earlier node.
    pub high: Vec<f64>,
}

/// Factors L, D and U of a matrix, the diagonals of L and U being 1, with room to find them in.
#[derive(Debug, Clone)]
pub struct Factors {
    low: Vec<f64>,
    high: Vec<f64>,
    diagonal: Vec<f64>,
    /// Ends of the columns as far as they are known.
    filled: Vec<u32>,
    row: Vec<f64>,
    column: Vec<f64>,
    right: Vec<f64>,
}

impl Symbolic {
    /// Of a net with so many nodes, and the two different ends of each pipe.
    ///
    /// # Errors
    /// More entries than numbers of 32 bits can tell apart.
    pub fn of(nodes: usize, ends: &[[u32; 2]]) -> Result<Self, Refused> {
        let too_large = Refused::Size { count: nodes + ends.len() };
        let order = minimum_degree(nodes, ends).ok_or(too_large)?;
        let mut places = vec![0u32; nodes];
        order.iter().enumerate().for_each(|(place, &node)| places[node as usize] = place as u32);
        let by_place = |&[a, b]: &[u32; 2]| {
            let (a, b) = (places[a as usize], places[b as usize]);
            (a.max(b), a.min(b))
        };
        let mut sorted: Vec<(u32, u32)> = ends.iter().map(by_place).collect();
        sorted.sort_unstable();
        sorted.dedup();
        let pair = |pipe: &[u32; 2]| {
            let at = sorted.partition_point(|pair| *pair < by_place(pipe));
            (at as u32, places[pipe[0] as usize] > places[pipe[1] as usize])
        };
        let pairs = ends.iter().map(pair).collect();
        let rows = starts(nodes, sorted.iter().map(|pair| pair.0));
        let earlier: Vec<u32> = sorted.iter().map(|pair| pair.1).collect();
        let (reach_rows, reach) = reach(nodes, &rows, &earlier).ok_or(too_large)?;
        let columns = starts(nodes, reach.iter().copied());
        let mut next = columns.clone();
        let mut below = vec![0; reach.len()];
        for place in 0..nodes {
            for &column in &reach[range(&reach_rows, place)] {
                below[next[column as usize] as usize] = place as u32;
                next[column as usize] += 1;
            }
        }
        Ok(Self { order, pairs, rows, earlier, reach_rows, reach, columns, below })
    }

    /// A matrix of zeros.
    pub fn matrix(&self) -> Matrix {
        let pairs = self.earlier.len();
        Matrix { diagonal: vec![0.0; self.order.len()], low: vec![0.0; pairs], high: vec![0.0; pairs] }
    }

    /// Room for factors.
    pub fn factors(&self) -> Factors {
        let (nodes, entries) = (self.order.len(), self.below.len());
        Factors {
            low: vec![0.0; entries],
            high: vec![0.0; entries],
            diagonal: vec![0.0; nodes],
            filled: vec![0; nodes],
            row: vec![0.0; nodes],
            column: vec![0.0; nodes],
            right: vec![0.0; nodes],
        }
    }
}

impl Factors {
    /// Finds the factors of a matrix.
    pub fn factor(&mut self, symbolic: &Symbolic, matrix: &Matrix) {
        let nodes = symbolic.order.len();
        self.filled.copy_from_slice(&symbolic.columns[..nodes]);
        for place in 0..nodes {
            for pair in range(&symbolic.rows, place) {
                let column = symbolic.earlier[pair] as usize;
                self.row[column] = matrix.low[pair];
                self.column[column] = matrix.high[pair];
            }
            let mut pivot = matrix.diagonal[symbolic.order[place] as usize];
            for &before in &symbolic.reach[range(&symbolic.reach_rows, place)] {
                pivot -= self.eliminate(symbolic, before as usize);
            }
            self.diagonal[place] = pivot;
        }
    }

    /// Eliminates an earlier place from the row and the column at hand; returns its part of the diagonal.
    fn eliminate(&mut self, symbolic: &Symbolic, before: usize) -> f64 {
        let (of_row, of_column) = (self.row[before], self.column[before]);
        (self.row[before], self.column[before]) = (0.0, 0.0);
        let end = self.filled[before] as usize;
        let known = symbolic.columns[before] as usize..end;
        let values = self.low[known.clone()].iter().zip(&self.high[known.clone()]);
        for (&other, (low, high)) in symbolic.below[known].iter().zip(values) {
            self.column[other as usize] -= low * of_column;
            self.row[other as usize] -= high * of_row;
        }
        let pivot = self.diagonal[before];
        let low = of_row / pivot;
        self.low[end] = low;
        self.high[end] = of_column / pivot;
        self.filled[before] = end as u32 + 1;
        low * of_column
    }

    /// Replaces the right side of a system, by node, by its solution.
    pub fn solve(&mut self, symbolic: &Symbolic, values: &mut [f64]) {
        let nodes = symbolic.order.len();
        self.right.iter_mut().zip(&symbolic.order).for_each(|(x, &node)| *x = values[node as usize]);
        for place in 0..nodes {
            let value = self.right[place];
            let column = range(&symbolic.columns, place);
            for (&row, low) in symbolic.below[column.clone()].iter().zip(&self.low[column]) {
                self.right[row as usize] -= low * value;
            }
        }
        self.right.iter_mut().zip(&self.diagonal).for_each(|(x, pivot)| *x /= pivot);
        for place in (0..nodes).rev() {
            let row = range(&symbolic.columns, place);
            let mut value = self.right[place];
            for (&column, high) in symbolic.below[row.clone()].iter().zip(&self.high[row]) {
                value -= high * self.right[column as usize];
            }
            self.right[place] = value;
        }
        symbolic.order.iter().zip(&self.right).for_each(|(&node, x)| values[node as usize] = *x);
    }
}

/// Part of a list that belongs to a place, by where the parts start.
fn range(starts: &[u32], place: usize) -> std::ops::Range<usize> {
    starts[place] as usize..starts[place + 1] as usize
}

/// Where the entries of each place start in a list sorted by place.
fn starts(count: usize, places: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut starts = vec![0u32; count + 1];
    places.for_each(|place| starts[place as usize + 1] += 1);
    for place in 0..count {
        starts[place + 1] += starts[place];
    }
    starts
}

/// Order of elimination by approximate minimum degree; none where the pattern is too large.
fn minimum_degree(nodes: usize, ends: &[[u32; 2]]) -> Option<Vec<u32>> {
    let mut entries: Vec<[u32; 2]> = ends.iter().flat_map(|&[a, b]| [[a, b], [b, a]]).collect();
    entries.extend((0..nodes as u32).map(|node| [node, node]));
    entries.sort_unstable();
    entries.dedup();
    let first = starts(nodes, entries.iter().map(|entry| entry[0]));
    let first: Vec<usize> = first.into_iter().map(|start| start as usize).collect();
    let columns: Vec<usize> = entries.iter().map(|entry| entry[1] as usize).collect();
    let (order, ..) = amd::order(nodes, &first, &columns, &amd::Control::default()).ok()?;
    Some(order.into_iter().map(|node| node as u32).collect())
}

/// Columns of the rows of the lower factor, row after row and rising, and where rows start: those on the ways in the
/// elimination tree from the entries of the matrix to the row. None where there are too many.
fn reach(nodes: usize, rows: &[u32], earlier: &[u32]) -> Option<(Vec<u32>, Vec<u32>)> {
    let mut parents = vec![NONE; nodes];
    let mut seen = vec![NONE; nodes];
    let mut starts = vec![0u32];
    let mut reach: Vec<u32> = Vec::new();
    for place in 0..nodes as u32 {
        let start = reach.len();
        for &entry in &earlier[range(rows, place as usize)] {
            let mut at = entry;
            while at != place && seen[at as usize] != place {
                seen[at as usize] = place;
                reach.push(at);
                if parents[at as usize] == NONE {
                    parents[at as usize] = place;
                }
                at = parents[at as usize];
            }
        }
        reach[start..].sort_unstable();
        starts.push(u32::try_from(reach.len()).ok()?);
    }
    Some((starts, reach))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_solution_fulfils_the_system() {
        let nodes = 30;
        let ends: Vec<[u32; 2]> = (0..60u32).map(|k| [k % 30, (k * 7 + 1 + k / 30) % 30]).collect();
        let ends: Vec<[u32; 2]> = ends.into_iter().filter(|[a, b]| a != b).collect();
        let symbolic = Symbolic::of(nodes, &ends).unwrap();
        let mut matrix = symbolic.matrix();
        matrix.diagonal.fill(9.0);
        let (mut dense, mut k) = (vec![vec![0.0; nodes]; nodes], 0.0);
        (0..nodes).for_each(|node| dense[node][node] = 9.0);
        for (&[a, b], &(pair, upper_is_later)) in ends.iter().zip(&symbolic.pairs) {
            k += 0.01;
            let (later, sooner) = if upper_is_later { (a, b) } else { (b, a) };
            matrix.low[pair as usize] -= k;
            matrix.high[pair as usize] -= 1.0 - k;
            dense[later as usize][sooner as usize] -= k;
            dense[sooner as usize][later as usize] -= 1.0 - k;
        }
        let right: Vec<f64> = (0..nodes).map(|node| (node as f64 - 12.0) * 0.3).collect();
        let mut x = right.clone();
        let mut factors = symbolic.factors();
        factors.factor(&symbolic, &matrix);
        factors.solve(&symbolic, &mut x);
        for (row, right) in dense.iter().zip(&right) {
            let left: f64 = row.iter().zip(&x).map(|(a, x)| a * x).sum();
            assert!((left - right).abs() < 1e-13, "{left} {right}");
        }
    }
}
