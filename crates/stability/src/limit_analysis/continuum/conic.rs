//! Conic programs whose rows change with the strength.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolution, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

/// Accuracy of the solution, relative to the greatest stress.
const ACCURACY: f64 = 1e-8;
/// Accuracy that will do where the solver gets no farther, by its own account and by ours.
const REDUCED: f64 = 1e-6;
/// Regularizations of the solver's matrix that are tried in turn.
const REGULARIZATIONS: [f64; 2] = [1e-8, 1e-7];

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

/// Rows of one kind of cone: each says that a sum is zero, not negative, or part of a second-order cone.
#[derive(Debug, Clone, Default)]
struct Rows(Vec<Strong>);

/// Least of unknown 0 under conditions on all unknowns.
#[derive(Debug, Clone, Default)]
pub struct Conic {
    columns: usize,
    zero: Rows,
    positive: Rows,
    cones: Rows,
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
        self.zero.0.push(sum.into());
    }

    /// A sum that is not negative.
    pub fn is_positive(&mut self, sum: Strong) {
        self.positive.0.push(sum);
    }

    /// The first sum is not below the length of the vector of both others.
    pub fn is_cone(&mut self, sums: [Strong; 3]) {
        self.cones.0.extend(sums);
    }

    /// Solves the program; none where the solver finds no solution, with its status.
    ///
    /// # Errors
    /// The status with which the solver gave up.
    pub fn solve(&self) -> Result<Solved, SolverStatus> {
        let kinds = [&self.zero, &self.positive, &self.cones];
        let rows: Vec<&Strong> = kinds.into_iter().flat_map(|rows| &rows.0).collect();
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
        let mut cost = vec![0.0; self.columns];
        cost[0] = 1.0;
        let mut cones = vec![SupportedConeT::ZeroConeT(self.zero.0.len())];
        cones.push(SupportedConeT::NonnegativeConeT(self.positive.0.len()));
        cones.extend(std::iter::repeat_n(SupportedConeT::SecondOrderConeT(3), self.cones.0.len() / 3));
        let none = CscMatrix::zeros((self.columns, self.columns));
        let mut status = SolverStatus::Unsolved;
        for regularization in REGULARIZATIONS {
            let solver = DefaultSolver::new(&none, &cost, &a, &right, &cones, settings(regularization));
            let mut solver = solver.map_err(|_| status)?;
            solver.solve();
            status = solver.solution.status;
            if is_solved(&solver.solution) {
                return Ok(self.solved(&rows, &solver.solution));
            }
        }
        Err(status)
    }

    fn solved(&self, rows: &[&Strong], solution: &DefaultSolution<f64>) -> Solved {
        let change = |(sum, z): (&&Strong, &f64)| {
            let terms = sum.change.terms.iter().map(|&(k, by)| by * solution.x[k]);
            -z * (sum.change.constant + terms.sum::<f64>())
        };
        Solved {
            least: solution.x[0],
            slope: rows.iter().zip(&solution.z).map(change).sum(),
            multipliers: solution.z[..self.zero.0.len()].to_vec(),
        }
    }
}

/// Settings of the solver: one thread and nothing printed, so that the same program has the same solution.
fn settings(regularization: f64) -> DefaultSettings<f64> {
    DefaultSettings {
        verbose: false,
        max_threads: 1,
        tol_gap_abs: ACCURACY,
        tol_gap_rel: ACCURACY,
        tol_feas: ACCURACY,
        reduced_tol_gap_abs: REDUCED,
        reduced_tol_gap_rel: REDUCED,
        reduced_tol_feas: REDUCED,
        static_regularization_constant: regularization,
        ..DefaultSettings::default()
    }
}

/// Whether a solution is one: the solver says so, or gave up where it was close enough.
fn is_solved(solution: &DefaultSolution<f64>) -> bool {
    let open = solution.r_prim.max(solution.r_dual).max((solution.obj_val - solution.obj_val_dual).abs());
    match solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => true,
        SolverStatus::NumericalError | SolverStatus::InsufficientProgress | SolverStatus::MaxIterations => {
            open <= REDUCED
        }
        _ => false,
    }
}
