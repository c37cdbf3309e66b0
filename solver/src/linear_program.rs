//! Small dense linear programs, solved by an interior point method.
//!
//! The only file that names the solver behind it, so that it can be exchanged here.

use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::{NonnegativeConeT, ZeroConeT};
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus};
use nalgebra::{DMatrix, DVector};

/// Relative and absolute accuracy asked of the solver: tight, since the programs are tiny.
const TOLERANCE: f64 = 1e-10;

/// Minimise `cost . x` subject to `equal x = equal_to` and `below x <= at_most`.
#[derive(Debug, Clone)]
pub(crate) struct LinearProgram {
    /// One entry per unknown.
    pub(crate) cost: DVector<f64>,
    /// Left-hand sides of the equations.
    pub(crate) equal: DMatrix<f64>,
    /// Right-hand sides of the equations.
    pub(crate) equal_to: DVector<f64>,
    /// Left-hand sides of the inequalities.
    pub(crate) below: DMatrix<f64>,
    /// Right-hand sides of the inequalities.
    pub(crate) at_most: DVector<f64>,
}

/// How a linear program ended.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Ending {
    /// Solved, possibly to reduced accuracy: the unknowns and the cost.
    Solved(DVector<f64>, f64),
    /// Proved to have no feasible point.
    Infeasible,
    /// Neither, with the solver's word for it.
    Failed(String),
}

impl LinearProgram {
    /// Solves the program on the calling thread, always with the same result.
    pub(crate) fn minimise(&self) -> Ending {
        let unknowns = self.cost.len();
        let rows = DMatrix::from_fn(
            self.equal_to.len() + self.at_most.len(),
            unknowns,
            |i, j| match i.checked_sub(self.equal_to.len()) {
                None => self.equal[(i, j)],
                Some(i) => self.below[(i, j)],
            },
        );
        let sides: Vec<f64> = self
            .equal_to
            .iter()
            .chain(self.at_most.iter())
            .copied()
            .collect();
        let cones = [
            ZeroConeT(self.equal_to.len()),
            NonnegativeConeT(self.at_most.len()),
        ];
        let quadratic = CscMatrix::zeros((unknowns, unknowns));
        let cost = self.cost.as_slice();
        match DefaultSolver::new(&quadratic, cost, &sparse(&rows), &sides, &cones, settings()) {
            Ok(mut solver) => {
                solver.solve();
                ending(&solver)
            }
            Err(error) => Ending::Failed(error.to_string()),
        }
    }
}

fn ending(solver: &DefaultSolver<f64>) -> Ending {
    let solution = &solver.solution;
    match solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => {
            Ending::Solved(DVector::from_column_slice(&solution.x), solution.obj_val)
        }
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => Ending::Infeasible,
        other => Ending::Failed(format!("{other:?}")),
    }
}

fn settings() -> DefaultSettings<f64> {
    DefaultSettings {
        verbose: false,
        max_threads: 1,
        direct_solve_method: "qdldl".to_owned(),
        tol_gap_abs: TOLERANCE,
        tol_gap_rel: TOLERANCE,
        tol_feas: TOLERANCE,
        ..DefaultSettings::default()
    }
}

/// Compressed columns of a dense matrix, zeros left out.
fn sparse(matrix: &DMatrix<f64>) -> CscMatrix<f64> {
    let mut starts = vec![0];
    let mut rows = Vec::new();
    let mut values = Vec::new();
    for column in matrix.column_iter() {
        for (i, &value) in column
            .iter()
            .enumerate()
            .filter(|&(_, &value)| value != 0.0)
        {
            rows.push(i);
            values.push(value);
        }
        starts.push(rows.len());
    }
    CscMatrix::new(matrix.nrows(), matrix.ncols(), starts, rows, values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{dmatrix, dvector};

    /// Minimise `x + 2 y` on the segment `x + y = 1`, `x <= limit`, `y >= 0`.
    fn segment(limit: f64, y_at_most: f64) -> LinearProgram {
        LinearProgram {
            cost: dvector![1.0, 2.0],
            equal: dmatrix![1.0, 1.0],
            equal_to: dvector![1.0],
            below: dmatrix![1.0, 0.0; 0.0, -1.0; 0.0, 1.0],
            at_most: dvector![limit, 0.0, y_at_most],
        }
    }

    #[test]
    fn the_vertex_is_found() {
        let Ending::Solved(x, value) = segment(0.75, 10.0).minimise() else {
            panic!("not solved");
        };
        assert!(
            (x[0] - 0.75).abs() < 1e-8 && (x[1] - 0.25).abs() < 1e-8,
            "{x}"
        );
        assert!((value - 1.25).abs() < 1e-8, "{value}");
    }

    #[test]
    fn contradictions_are_proved() {
        assert_eq!(segment(0.25, 0.5).minimise(), Ending::Infeasible);
    }

    #[test]
    fn an_unbounded_cost_is_a_failure() {
        let program = LinearProgram {
            cost: dvector![1.0, -1.0],
            ..segment(1.0, f64::MAX.sqrt())
        };
        let unbounded = LinearProgram {
            below: dmatrix![1.0, 0.0],
            at_most: dvector![1.0],
            ..program
        };
        assert!(matches!(unbounded.minimise(), Ending::Failed(_)));
    }
}
