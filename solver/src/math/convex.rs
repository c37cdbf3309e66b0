//! Small dense linear and quadratic programs, solved by an interior point method.
//!
//! The only file that names clarabel, the solver behind it.

use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::{NonnegativeConeT, ZeroConeT};
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus};
use nalgebra::{DMatrix, DVector};

/// Relative and absolute accuracy of the solver: tight, since the programs are tiny.
const TOLERANCE: f64 = 1e-10;

/// Minimise `1/2 x . quadratic x + cost . x` subject to `equal x = equal_to` and
/// `below x <= at_most`.
#[derive(Debug, Clone)]
pub(crate) struct ConvexProgram {
    /// Symmetric and positive semidefinite, upper triangle; `None` for a linear program.
    pub(crate) quadratic: Option<DMatrix<f64>>,
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

/// How a convex program ended.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Ending {
    /// Solved, possibly to reduced accuracy.
    Solved(Minimum),
    /// Proved to have no feasible point.
    Infeasible,
    /// Neither, with the solver's status.
    Failed(String),
}

/// The solution of a convex program.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Minimum {
    /// The unknowns.
    pub(crate) unknowns: DVector<f64>,
    /// The multipliers `y` of the equations, then `z >= 0` of the inequalities:
    /// `quadratic x + cost + equal^T y + below^T z = 0`.
    #[cfg(test)]
    pub(crate) multipliers: DVector<f64>,
}

impl ConvexProgram {
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
        let quadratic = match &self.quadratic {
            Some(matrix) => sparse(&matrix.upper_triangle()),
            None => CscMatrix::zeros((unknowns, unknowns)),
        };
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
        SolverStatus::Solved | SolverStatus::AlmostSolved => Ending::Solved(Minimum {
            unknowns: DVector::from_column_slice(&solution.x),
            #[cfg(test)]
            multipliers: DVector::from_column_slice(&solution.z),
        }),
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

    /// Minimise `x + 2 y` on the segment `x + y = 1`, `x <= limit`, `0 <= y <= y_at_most`.
    fn segment(limit: f64, y_at_most: f64) -> ConvexProgram {
        ConvexProgram {
            quadratic: None,
            cost: dvector![1.0, 2.0],
            equal: dmatrix![1.0, 1.0],
            equal_to: dvector![1.0],
            below: dmatrix![1.0, 0.0; 0.0, -1.0; 0.0, 1.0],
            at_most: dvector![limit, 0.0, y_at_most],
        }
    }

    fn solved(program: &ConvexProgram) -> Minimum {
        match program.minimise() {
            Ending::Solved(minimum) => minimum,
            other => panic!("not solved: {other:?}"),
        }
    }

    #[test]
    fn the_vertex_is_found() {
        let x = solved(&segment(0.75, 10.0)).unknowns;
        assert!((x - dvector![0.75, 0.25]).amax() < 1e-8);
    }

    #[test]
    fn a_quadratic_cost_has_its_minimum_inside_with_multipliers_to_match() {
        // 1/2 (x^2 + 3 y^2) + x y + x + 2 y on x + y = 1: with x = 1 - y it is y^2 + y + 3/2,
        // least at y = 0 where the bound holds, so that the bound's multiplier is its slope, one.
        let program = ConvexProgram {
            quadratic: Some(dmatrix![1.0, 1.0; 1.0, 3.0]),
            ..segment(10.0, 10.0)
        };
        let minimum = solved(&program);
        assert!((minimum.unknowns - dvector![1.0, 0.0]).amax() < 1e-7);
        let expected = dvector![-2.0, 0.0, 1.0, 0.0];
        assert!((minimum.multipliers - expected).amax() < 1e-7);
        // Without the cost of y the minimum lies between the bounds: y^2 - y + 3/2.
        let inside = ConvexProgram {
            cost: dvector![1.0, 0.0],
            ..program
        };
        assert!((solved(&inside).unknowns - dvector![0.5, 0.5]).amax() < 1e-7);
    }

    #[test]
    fn contradictory_conditions_are_proved_infeasible() {
        assert_eq!(segment(0.25, 0.5).minimise(), Ending::Infeasible);
    }

    #[test]
    fn an_unbounded_cost_is_a_failure() {
        let program = ConvexProgram {
            cost: dvector![1.0, -1.0],
            ..segment(1.0, f64::MAX.sqrt())
        };
        let unbounded = ConvexProgram {
            below: dmatrix![1.0, 0.0],
            at_most: dvector![1.0],
            ..program
        };
        assert!(matches!(unbounded.minimise(), Ending::Failed(_)));
    }
}
