//! The quadratic program of one step, assembled without regard to its structure.
//!
//! Unknowns are ordered by node, `d = (dx_0, dv_0, dx_1, dv_1, .., dx_N)`; equations are the links,
//! then the node equalities:
//!
//! ```text
//!   minimise    1/2 d . W d + gradient . d
//!   subject to  E d + c = 0,   J d + g >= 0
//! ```
//!
//! The equations are eliminated ([`NullSpace`]): `d = d_0 + Z y`. The general solver needs a
//! positive Hessian `Z^T W Z`, but at a minimum that of the Lagrangian is positive only along the
//! inequalities that bind. Therefore `weight (J_b d + g_b)^2 / 2` is added for the rows `b` that
//! bind, with the least weight that makes it positive: where they keep binding the term vanishes
//! with its derivative, and the step is that of the exact Hessian. Where no weight does, negative
//! eigenvalues are replaced by their absolute values.

use super::null_space::NullSpace;
use crate::math::convex::{ConvexProgram, Ending};
use crate::nlp::{Iterate, Layout, LinkModel, LinkValues};
use nalgebra::{DMatrix, DVector};

/// Weights of binding inequalities that are tried.
const WEIGHTS: [f64; 5] = [0.0, 1.0, 1e1, 1e2, 1e3];
/// Least curvature.
const LEAST: f64 = 1e-6;
/// Damping from which an unsolved program counts as infeasible.
const INFEASIBLE_DAMPING: f64 = 1.0;
/// Cost of a unit of violation where the linearised conditions contradict each other, and the
/// curvature of all unknowns then.
const ELASTIC: f64 = 1e3;
const ELASTIC_CURVATURE: f64 = 1.0;
/// Share of the violation that the linearised conditions must predict to vanish when they
/// contradict each other.
const PREDICTED_DECREASE: f64 = 1e-3;

/// All conditions and derivatives at a point.
pub(super) struct Linearisation {
    pub(super) cost: f64,
    pub(super) gradient: DVector<f64>,
    hessian: DMatrix<f64>,
    equal: DMatrix<f64>,
    equal_value: DVector<f64>,
    above: DMatrix<f64>,
    above_value: DVector<f64>,
    equal_dual: DVector<f64>,
    above_dual: DVector<f64>,
}

/// A step with the multipliers that belong to it: links, node equalities, inequalities.
pub(super) struct Stepped {
    pub(super) direction: DVector<f64>,
    pub(super) multipliers: DVector<f64>,
    elastic: bool,
}

/// Why there is no step.
enum Refused {
    /// The linearised conditions contradict each other.
    Infeasible,
    /// The quadratic program was not solved.
    Unsolved,
}

impl Linearisation {
    /// Gathers the models of all nodes.
    pub(super) fn of(layout: &Layout, models: &[LinkModel], iterate: &Iterate) -> Self {
        let (states, stride) = (layout.states, layout.states + layout.controls);
        let unknowns = layout.intervals * stride + states;
        let links = layout.intervals * states;
        let (equations, rows) = (links + layout.all_equalities(), layout.all_inequalities());
        let duals = iterate.lambda.iter().chain(&iterate.nu).copied();
        let mut all = Self {
            cost: 0.0,
            gradient: DVector::zeros(unknowns),
            hessian: DMatrix::zeros(unknowns, unknowns),
            equal: DMatrix::zeros(equations, unknowns),
            equal_value: DVector::zeros(equations),
            above: DMatrix::zeros(rows, unknowns),
            above_value: DVector::zeros(rows),
            equal_dual: DVector::from_iterator(equations, duals),
            above_dual: DVector::from_column_slice(&iterate.z),
        };
        for (node, model) in models.iter().enumerate() {
            let (at, vars) = (node * stride, model.vars);
            all.cost += model.values.cost;
            for i in 0..vars {
                all.gradient[at + i] = model.gradient[i];
                for j in 0..=i {
                    all.hessian[(at + i, at + j)] = model.hessian[i * vars + j];
                    all.hessian[(at + j, at + i)] = model.hessian[i * vars + j];
                }
            }
            for (i, row) in layout.link(node).enumerate() {
                all.equal_value[row] = model.values.gap[i];
                for j in 0..vars {
                    all.equal[(row, at + j)] = model.link_jacobian[i * vars + j];
                }
                all.equal[(row, at + stride + i)] = -1.0;
            }
            for (i, row) in layout.equality(node).enumerate() {
                all.equal_value[links + row] = model.values.equality[i];
                for j in 0..states {
                    all.equal[(links + row, at + j)] = model.equality_jacobian[i * states + j];
                }
            }
            for (i, row) in layout.inequality(node).enumerate() {
                all.above_value[row] = model.values.inequality[i];
                for (j, value) in model.inequality_row(i).iter().enumerate() {
                    all.above[(row, at + j)] = *value;
                }
            }
        }
        all
    }

    /// Largest error of the optimality conditions with the current multipliers.
    pub(super) fn error(&self) -> f64 {
        let stationarity = &self.gradient + self.equal.tr_mul(&self.equal_dual)
            - self.above.tr_mul(&self.above_dual);
        let complementarity = self
            .above_value
            .iter()
            .zip(self.above_dual.iter())
            .map(|(g, z)| g.min(*z).abs())
            .fold(0.0, f64::max);
        stationarity
            .amax()
            .max(amax(&self.equal_value))
            .max(complementarity)
    }

    /// Sum of all violations.
    pub(super) fn violation(&self) -> f64 {
        violation(&self.equal_value, &self.above_value)
    }

    /// Sum of all violations of the linearised conditions after a step.
    pub(super) fn violation_after(&self, direction: &DVector<f64>) -> f64 {
        violation(
            &(&self.equal_value + &self.equal * direction),
            &(&self.above_value + &self.above * direction),
        )
    }

    /// The step of the model with added curvature `damping`; `None` when no quadratic program can
    /// be solved.
    pub(super) fn step(&self, damping: f64) -> Option<Stepped> {
        match self.step_to(&self.equal_value, &self.above_value, damping) {
            Ok(step) => Some(step),
            // A little damping often makes a program solvable. One that a lot does not is probably
            // infeasible.
            Err(Refused::Unsolved) if damping < INFEASIBLE_DAMPING => None,
            Err(_) => self.elastic_step(),
        }
    }

    /// The step again, with the conditions' curvature as seen at its end (`values`) added to their
    /// linearisations: a second-order correction.
    pub(super) fn corrected(
        &self,
        step: &Stepped,
        values: &[LinkValues],
        damping: f64,
    ) -> Option<Stepped> {
        let gaps = values.iter().flat_map(|v| &v.gap);
        let equalities = values.iter().flat_map(|v| &v.equality);
        let inequalities = values.iter().flat_map(|v| &v.inequality);
        let equal = DVector::from_iterator(self.equal_value.len(), gaps.chain(equalities).copied());
        let above = DVector::from_iterator(self.above_value.len(), inequalities.copied());
        self.step_to(
            &(equal - &self.equal * &step.direction),
            &(above - &self.above * &step.direction),
            damping,
        )
        .ok()
    }

    /// The step with given constant parts of the conditions.
    fn step_to(
        &self,
        equal_value: &DVector<f64>,
        above_value: &DVector<f64>,
        damping: f64,
    ) -> Result<Stepped, Refused> {
        let space = NullSpace::of(&self.equal).ok_or(Refused::Unsolved)?;
        let z = &space.basis;
        let begin = space.particular(&-equal_value);
        let mut curved = self.hessian.clone();
        for i in 0..curved.nrows() {
            curved[(i, i)] += damping;
        }
        let slope = &self.gradient + &curved * &begin;
        let reduced = z.tr_mul(&(&curved * z));
        let rows = &self.above * z;
        let margins = above_value + &self.above * &begin;
        let binding: Vec<usize> = (0..margins.len())
            .filter(|&i| self.above_dual[i] > self.above_value[i].abs())
            .collect();
        let (hessian, weight) = convexified(&reduced, &rows.select_rows(&binding));
        let pull = rows
            .select_rows(&binding)
            .tr_mul(&margins.select_rows(&binding))
            * weight;
        let program = ConvexProgram {
            quadratic: Some(hessian),
            cost: z.tr_mul(&slope) + pull,
            equal: DMatrix::zeros(0, z.ncols()),
            equal_to: DVector::zeros(0),
            below: -rows,
            at_most: margins,
        };
        let minimum = match program.minimise() {
            Ending::Solved(minimum) => minimum,
            Ending::Infeasible => return Err(Refused::Infeasible),
            Ending::Failed(_) => return Err(Refused::Unsolved),
        };
        let direction = begin + z * &minimum.unknowns;
        let mut above_dual = minimum.multipliers;
        for i in binding {
            let margin = above_value[i] + (self.above.row(i) * &direction)[0];
            above_dual[i] = (above_dual[i] - weight * margin).max(0.0);
        }
        let balance = self.above.tr_mul(&above_dual) - &self.gradient - &self.hessian * &direction;
        let equal_dual = space.multipliers(&balance);
        let all = equal_dual.iter().chain(above_dual.iter()).copied();
        Ok(Stepped {
            multipliers: DVector::from_iterator(equal_dual.len() + above_dual.len(), all),
            direction,
            elastic: false,
        })
    }

    /// The step where the linearised conditions contradict each other: with linear penalties on all
    /// violations.
    fn elastic_step(&self) -> Option<Stepped> {
        let unknowns = self.gradient.len();
        let program = relaxed(&ConvexProgram {
            quadratic: Some(DMatrix::identity(unknowns, unknowns) * ELASTIC_CURVATURE),
            cost: self.gradient.clone(),
            equal: self.equal.clone(),
            equal_to: -&self.equal_value,
            below: -&self.above,
            at_most: self.above_value.clone(),
        });
        let Ending::Solved(minimum) = program.minimise() else {
            return None;
        };
        let count = self.equal_value.len() + self.above_value.len();
        Some(Stepped {
            direction: minimum.unknowns.rows(0, unknowns).into_owned(),
            multipliers: minimum.multipliers.rows(0, count).into_owned(),
            elastic: true,
        })
    }
}

/// A positive Hessian, and the weight of the binding rows in it.
fn convexified(reduced: &DMatrix<f64>, binding: &DMatrix<f64>) -> (DMatrix<f64>, f64) {
    let squares = binding.tr_mul(binding);
    for weight in WEIGHTS {
        let tried = reduced + &squares * weight;
        let mut safely = tried.clone();
        for i in 0..safely.nrows() {
            safely[(i, i)] -= LEAST;
        }
        if safely.cholesky().is_some() {
            return (tried, weight);
        }
    }
    let weight = WEIGHTS[WEIGHTS.len() - 1];
    let mut eigen = (reduced + squares * weight).symmetric_eigen();
    eigen
        .eigenvalues
        .apply(|value| *value = value.abs().max(LEAST));
    (eigen.recompose(), weight)
}

impl Stepped {
    /// Whether the linearised conditions contradict each other and hardly less so after the step.
    pub(super) fn unreachable(&self, here: &Linearisation) -> bool {
        let left = here.violation_after(&self.direction);
        self.elastic && left > (1.0 - PREDICTED_DECREASE) * here.violation()
    }
}

/// The program with linear penalties instead of conditions.
fn relaxed(program: &ConvexProgram) -> ConvexProgram {
    let (equations, rows) = (program.equal_to.len(), program.at_most.len());
    let unknowns = program.cost.len();
    let extra = 2 * equations + rows;
    let grown =
        |matrix: &DMatrix<f64>, height| matrix.clone().resize(height, unknowns + extra, 0.0);
    let mut equal = grown(&program.equal, equations);
    for i in 0..equations {
        equal[(i, unknowns + i)] = 1.0;
        equal[(i, unknowns + equations + i)] = -1.0;
    }
    let mut below = grown(&program.below, rows + extra);
    for i in 0..rows {
        below[(i, unknowns + 2 * equations + i)] = -1.0;
    }
    for i in 0..extra {
        below[(rows + i, unknowns + i)] = -1.0;
    }
    let square = |matrix: &DMatrix<f64>| grown(matrix, unknowns + extra);
    ConvexProgram {
        quadratic: program.quadratic.as_ref().map(square),
        cost: program
            .cost
            .clone()
            .resize_vertically(unknowns + extra, ELASTIC),
        equal,
        equal_to: program.equal_to.clone(),
        below,
        at_most: program.at_most.clone().resize_vertically(rows + extra, 0.0),
    }
}

fn violation(equal: &DVector<f64>, above: &DVector<f64>) -> f64 {
    equal.iter().map(|c| c.abs()).sum::<f64>() + above.iter().map(|g| (-g).max(0.0)).sum::<f64>()
}

fn amax(vector: &DVector<f64>) -> f64 {
    vector
        .iter()
        .fold(0.0, |worst, value| worst.max(value.abs()))
}
