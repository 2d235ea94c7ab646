//! Conic programs whose rows change with the strength.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSolution, SolverStatus, SupportedConeT};

use super::super::solver::Accuracy;

/// Accuracy of a solution, relative to the greatest stress.
const ACCURACY: Accuracy = Accuracy { full: 1e-8, reduced: 1e-6, given_up: 1e-6, regularizations: &[1e-8, 1e-7] };

/// A sum of unknowns times factors, with a constant.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sum {
    /// Unknown and factor.
    pub terms: Vec<(usize, f64)>,
    /// Constant.
    pub constant: f64,
}

/// A sum with its change with the strength.
#[derive(Debug, Clone, Default)]
pub struct Strong {
    /// The sum.
    pub now: Sum,
    /// Its change with the strength.
    pub change: Sum,
}

/// Least of unknown 0 under conditions on all unknowns: rows whose sums are zero, not negative, or parts of
/// second-order cones.
#[derive(Debug, Clone, Default)]
pub struct Conic {
    columns: usize,
    zero: Vec<Strong>,
    positive: Vec<Strong>,
    cones: Vec<Strong>,
}

/// Solution of a program.
#[derive(Debug, Clone)]
pub struct Solved {
    /// Least value of unknown 0.
    pub least: f64,
    /// Its change with the strength.
    pub slope: f64,
    /// Multipliers of the sums that are zero, in their order.
    pub multipliers: Vec<f64>,
}

impl Sum {
    /// A constant.
    pub fn constant(constant: f64) -> Self {
        Self { terms: Vec::new(), constant }
    }

    /// Adds another sum times a factor.
    pub fn add(&mut self, other: &Self, factor: f64) {
        if factor != 0.0 {
            self.terms.extend(other.terms.iter().map(|&(k, by)| (k, by * factor)));
            self.constant += other.constant * factor;
        }
    }

    /// This plus another sum times a factor.
    pub fn plus(mut self, other: &Self, factor: f64) -> Self {
        self.add(other, factor);
        self
    }
}

impl From<Sum> for Strong {
    fn from(now: Sum) -> Self {
        Self { now, change: Sum::default() }
    }
}

impl Conic {
    /// A program with that many unknowns.
    pub fn new(columns: usize) -> Self {
        Self { columns, ..Self::default() }
    }

    /// One unknown more.
    pub fn unknown(&mut self) -> usize {
        self.columns += 1;
        self.columns - 1
    }

    /// A sum that is zero.
    pub fn is_zero(&mut self, sum: Sum) {
        self.zero.push(sum.into());
    }

    /// A sum that is not negative.
    pub fn is_positive(&mut self, sum: Strong) {
        self.positive.push(sum);
    }

    /// The first sum is not below the length of the vector of both others.
    pub fn is_cone(&mut self, sums: [Strong; 3]) {
        self.cones.extend(sums);
    }

    /// Solves the program; none where the solver finds no solution, with its status.
    ///
    /// # Errors
    /// The status with which the solver gave up.
    pub fn solve(&self) -> Result<Solved, SolverStatus> {
        let kinds = [&self.zero, &self.positive, &self.cones];
        let rows: Vec<&Strong> = kinds.into_iter().flatten().collect();
        let (mut row, mut column, mut value) = (Vec::new(), Vec::new(), Vec::new());
        for (k, sum) in rows.iter().enumerate() {
            for &(unknown, by) in sum.now.terms.iter().filter(|(_, by)| *by != 0.0) {
                row.push(k);
                column.push(unknown);
                value.push(-by);
            }
        }
        let right: Vec<f64> = rows.iter().map(|sum| sum.now.constant).collect();
        let a = CscMatrix::new_from_triplets(rows.len(), self.columns, row, column, value);
        let mut cones = vec![SupportedConeT::ZeroConeT(self.zero.len())];
        cones.push(SupportedConeT::NonnegativeConeT(self.positive.len()));
        cones.extend(std::iter::repeat_n(SupportedConeT::SecondOrderConeT(3), self.cones.len() / 3));
        let solution = ACCURACY.least(None, &a, &right, &cones)?;
        Ok(self.solved(&rows, &solution))
    }

    fn solved(&self, rows: &[&Strong], solution: &DefaultSolution<f64>) -> Solved {
        let change = |(sum, z): (&&Strong, &f64)| {
            let terms = sum.change.terms.iter().map(|&(k, by)| by * solution.x[k]);
            -z * (sum.change.constant + terms.sum::<f64>())
        };
        Solved {
            least: solution.x[0],
            slope: rows.iter().zip(&solution.z).map(change).sum(),
            multipliers: solution.z[..self.zero.len()].to_vec(),
        }
    }
}
