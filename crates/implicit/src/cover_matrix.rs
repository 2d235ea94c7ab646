//! Sparse symmetric matrix over the covers, two rows each, and its Cholesky factor: the system of the implicit
//! integrator.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use enmm::internals::cover::CoverId;

/// Slot of a pair of covers that the matrix does not hold.
pub const UNCOUPLED: u32 = u32::MAX;

/// The matrix is not positive definite to working precision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotPositive;

/// Lower triangle by columns, in blocks of two by two; the symbolic factorisation is valid as long as the pattern.
#[doc(alias = "stiffness matrix")]
#[doc(alias = "Cholesky")]
#[derive(Debug, Clone, Default)]
pub struct CoverMatrix {
    /// First block of each cover's column, and the number of blocks at the end.
    block_start: Vec<u32>,
    /// Cover of each block's rows; the diagonal block first, then ascending.
    block_row: Vec<CoverId>,
    column_start: Vec<u32>,
    row: Vec<u32>,
    value: Vec<f64>,
    symbolic: Option<Arc<SymbolicCholesky<u32>>>,
    factor: Vec<f64>,
    workspace: Workspace,
}

/// Memory of the factorisation; a clone makes its own.
#[derive(Default)]
struct Workspace(Option<MemBuffer>);

impl Clone for Workspace {
    fn clone(&self) -> Self {
        Self(None)
    }
}

impl std::fmt::Debug for Workspace {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Workspace")
    }
}

impl CoverMatrix {
    /// Takes a new pattern: `pairs` are sorted pairs (column, row) of covers with column < row, each once.
    pub fn set_pattern(&mut self, covers: usize, pairs: &[[CoverId; 2]]) {
        self.block_start.clear();
        self.block_row.clear();
        let mut rest = pairs;
        for column in CoverId::all(covers) {
            self.block_start.push(self.block_row.len() as u32);
            self.block_row.push(column);
            let (mine, others) = rest.split_at(rest.partition_point(|p| p[0] <= column));
            self.block_row.extend(mine.iter().map(|p| p[1]));
            rest = others;
        }
        self.block_start.push(self.block_row.len() as u32);
        self.lay_out_scalars(covers);
        self.value.clear();
        self.value.resize(self.row.len(), 0.0);
        self.symbolic = None;
    }

    fn lay_out_scalars(&mut self, covers: usize) {
        self.column_start.clear();
        self.row.clear();
        for column in 0..covers {
            let blocks = &self.block_row[self.block_start[column] as usize..self.block_start[column + 1] as usize];
            for half in 0..2 {
                self.column_start.push(self.row.len() as u32);
                let rows = blocks.iter().flat_map(|i| [2 * i.number(), 2 * i.number() + 1]).skip(half);
                self.row.extend(rows);
            }
        }
        self.column_start.push(self.row.len() as u32);
    }

    /// Whether a pattern has been set.
    pub fn is_empty(&self) -> bool {
        self.row.is_empty()
    }

    /// Forgets the pattern.
    pub fn clear(&mut self) {
        self.row.clear();
        self.symbolic = None;
    }

    /// Slot of the block of a pair of covers, row not before column; `UNCOUPLED` when the pattern lacks it.
    pub fn slot(&self, row: CoverId, column: CoverId) -> u32 {
        let column = column.index();
        let rows = &self.block_row[self.block_start[column] as usize..self.block_start[column + 1] as usize];
        match rows.binary_search(&row) {
            Ok(k) => self.column_start[2 * column] + 2 * k as u32,
            Err(_) => UNCOUPLED,
        }
    }

    /// Sets all values to zero.
    pub fn zero(&mut self) {
        self.value.fill(0.0);
    }

    /// Adds a block (row by row) at the `slot` of a pair of covers; `diagonal` when both are the same.
    #[inline]
    pub fn add(&mut self, slot: u32, column: CoverId, block: [f64; 4], diagonal: bool) {
        if slot == UNCOUPLED {
            return;
        }
        let (slot, column) = (slot as usize, 2 * column.index());
        let second = slot + (self.column_start[column + 1] - self.column_start[column]) as usize - 1;
        self.value[slot] += block[0];
        self.value[slot + 1] += block[2];
        if !diagonal {
            self.value[second] += block[1];
        }
        self.value[second + 1] += block[3];
    }

    /// Decouples the rows whose flag is set: their diagonal becomes 1.
    pub fn hold(&mut self, held: &[bool]) {
        for column in 0..held.len() {
            let range = self.column_start[column] as usize..self.column_start[column + 1] as usize;
            for k in range {
                let row = self.row[k] as usize;
                if held[row] || held[column] {
                    self.value[k] = f64::from(u8::from(row == column));
                }
            }
        }
    }

    /// Factorises the values, with a new symbolic factorisation when the pattern is new.
    ///
    /// # Errors
    /// A matrix that is not positive definite.
    pub fn factorise(&mut self) -> Result<(), NotPositive> {
        let n = self.column_start.len() - 1;
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &self.column_start, None, &self.row);
        if self.symbolic.is_none() {
            let params = CholeskySymbolicParams::default();
            let symbolic = factorize_symbolic_cholesky(pattern, Side::Lower, SymmetricOrdering::Amd, params);
            let symbolic = symbolic.map_err(|_| NotPositive)?;
            self.factor.resize(symbolic.len_val(), 0.0);
            self.workspace.0 = None;
            self.symbolic = Some(Arc::new(symbolic));
        }
        let Some(symbolic) = &self.symbolic else { return Err(NotPositive) };
        let stack = MemStack::new(buffer(&mut self.workspace, symbolic));
        let matrix = SparseColMatRef::new(pattern, &self.value[..]);
        let (regular, params) = (Default::default(), Default::default());
        let done =
            symbolic.factorize_numeric_llt(&mut self.factor, matrix, Side::Lower, regular, Par::Seq, stack, params);
        done.map(|_| ()).map_err(|_| NotPositive)
    }

    /// Solves with the last factor; `x` is the right-hand side before and the solution after the call.
    pub fn solve(&mut self, x: &mut [f64]) {
        let Some(symbolic) = &self.symbolic else { return };
        let n = x.len();
        let stack = MemStack::new(buffer(&mut self.workspace, symbolic));
        let factor = LltRef::new(symbolic, &self.factor[..]);
        let x = MatMut::from_column_major_slice_mut(x, n, 1);
        factor.solve_in_place_with_conj(Conj::No, x, Par::Seq, stack);
    }

    /// Bytes of the pattern and values, and of the factor.
    pub fn bytes(&self) -> [usize; 2] {
        let words = self.block_start.len() + self.block_row.len() + self.column_start.len() + self.row.len();
        [4 * words + 8 * self.value.len(), 8 * self.factor.len()]
    }
}

fn buffer<'a>(workspace: &'a mut Workspace, symbolic: &SymbolicCholesky<u32>) -> &'a mut MemBuffer {
    workspace.0.get_or_insert_with(|| {
        let factorise = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        MemBuffer::new(factorise.or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chain_of_three_covers_is_solved() {
        let mut matrix = CoverMatrix::default();
        let covers = [0, 1, 2].map(CoverId::new);
        let pairs = [[covers[0], covers[1]], [covers[1], covers[2]]];
        matrix.set_pattern(3, &pairs);
        for i in covers {
            matrix.add(matrix.slot(i, i), i, [4.0, 0.5, 0.5, 3.0], true);
        }
        for [column, row] in pairs {
            matrix.add(matrix.slot(row, column), column, [-1.0, 0.25, -0.5, -1.0], false);
        }
        assert_eq!(matrix.slot(covers[2], covers[0]), UNCOUPLED);
        matrix.factorise().unwrap();
        let x = [1.0, -2.0, 0.5, 3.0, -1.0, 2.0];
        let mut b = [0.0; 6];
        for i in 0..3 {
            b[2 * i] += 4.0 * x[2 * i] + 0.5 * x[2 * i + 1];
            b[2 * i + 1] += 0.5 * x[2 * i] + 3.0 * x[2 * i + 1];
        }
        for i in 0..2 {
            let (p, q) = (2 * i, 2 * i + 2);
            b[q] += -x[p] + 0.25 * x[p + 1];
            b[q + 1] += -0.5 * x[p] - x[p + 1];
            b[p] += -x[q] - 0.5 * x[q + 1];
            b[p + 1] += 0.25 * x[q] - x[q + 1];
        }
        matrix.solve(&mut b);
        assert!(b.iter().zip(x).all(|(a, b)| (a - b).abs() < 1e-14), "{b:?}");
        matrix.hold(&[true, false, false, false, false, false]);
        matrix.factorise().unwrap();
        let mut b = [7.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        matrix.solve(&mut b);
        assert_eq!(b, [7.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    }
}
