//! The solver of linear, conic and quadratic programs.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolution, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

/// How exactly programs of one kind are solved.
pub struct Accuracy {
    /// Accuracy of the solution.
    pub full: f64,
    /// Accuracy that will do where the solver gets no farther, by its own account.
    pub reduced: f64,
    /// The same by ours, where the solver gave up.
    pub given_up: f64,
    /// Regularizations of the solver's matrix that are tried in turn.
    pub regularizations: &'static [f64],
}

impl Accuracy {
    /// Least of unknown 0 where `right` minus `a` times the unknowns lies in the cones; where there are `factors`, that
    /// of half the sum of the squares of the unknowns, each times its factor.
    ///
    /// # Errors
    /// The status with which the solver gave up.
    pub fn least(
        &self,
        factors: Option<Vec<f64>>,
        a: &CscMatrix<f64>,
        right: &[f64],
        cones: &[SupportedConeT<f64>],
    ) -> Result<DefaultSolution<f64>, SolverStatus> {
        let (places, mut cost): (Vec<usize>, _) = ((0..a.n).collect(), vec![0.0; a.n]);
        let squares = match factors {
            Some(factors) => CscMatrix::new_from_triplets(a.n, a.n, places.clone(), places, factors),
            None => {
                cost[0] = 1.0;
                CscMatrix::zeros((a.n, a.n))
            }
        };
        let mut status = SolverStatus::Unsolved;
        for &regularization in self.regularizations {
            let solver = DefaultSolver::new(&squares, &cost, a, right, cones, self.settings(regularization));
            let mut solver = solver.map_err(|_| status)?;
            solver.solve();
            status = solver.solution.status;
            if self.is_solved(&solver.solution) {
                return Ok(solver.solution);
            }
        }
        Err(status)
    }

    /// Settings of the solver: one thread and nothing printed, so that the same program has the same solution.
    fn settings(&self, regularization: f64) -> DefaultSettings<f64> {
        DefaultSettings {
            verbose: false,
            max_threads: 1,
            tol_gap_abs: self.full,
            tol_gap_rel: self.full,
            tol_feas: self.full,
            reduced_tol_gap_abs: self.reduced,
            reduced_tol_gap_rel: self.reduced,
            reduced_tol_feas: self.reduced,
            static_regularization_constant: regularization,
            ..DefaultSettings::default()
        }
    }

    /// Whether a solution is one: the solver says so, or gave up where it was close enough.
    fn is_solved(&self, solution: &DefaultSolution<f64>) -> bool {
        let open = solution.r_prim.max(solution.r_dual).max((solution.obj_val - solution.obj_val_dual).abs());
        match solution.status {
            SolverStatus::Solved | SolverStatus::AlmostSolved => true,
            SolverStatus::NumericalError | SolverStatus::InsufficientProgress | SolverStatus::MaxIterations => {
                open <= self.given_up
            }
            _ => false,
        }
    }
}
