//! The interior point alone, on problems with known solutions.

pub(crate) mod carts;
mod control;
mod generality;

use super::*;
use carts::{Least, Metered};

/// To the last digits, for comparisons with closed forms and with another engine.
pub(crate) const TIGHT: Settings = Settings {
    tolerance: 1e-8,
    initial_barrier: 1e-1,
    ..Settings::COLD
};

/// Weight that settles how a constant arc is divided into intervals, which nothing else does.
const EVEN: f64 = 1e-3;

/// A cart on a line, to reach a place as soon as possible with `|a| <= 1` in intervals of free
/// length: states are position and speed, controls `(a, tau)`.
struct Cart {
    intervals: usize,
    goal: f64,
    /// Speed limit, when there is one.
    limit: Option<f64>,
}

impl Cart {
    fn length(&self) -> f64 {
        1.0 / self.intervals as f64
    }

    fn solve(&self) -> (NlpStatus, Iterate) {
        let nodes = self.intervals + 1;
        let points = (0..nodes)
            .flat_map(|k| [self.goal * k as f64 * self.length(), 0.0])
            .collect();
        let controls = (0..self.intervals)
            .flat_map(|_| [0.0, self.length()])
            .collect();
        let mut iterate = Iterate::cold(points, controls);
        let mut engine = InteriorPoint::new(self, TIGHT);
        let report = engine.solve(self, &mut iterate, &|| None);
        (report.status, iterate)
    }
}

impl Chain for Cart {
    fn intervals(&self) -> usize {
        self.intervals
    }

    fn point_len(&self) -> usize {
        2
    }

    fn state_dim(&self) -> usize {
        2
    }

    fn control_dim(&self) -> usize {
        2
    }

    fn equalities(&self, node: usize) -> usize {
        if node == 0 || node == self.intervals {
            2
        } else {
            0
        }
    }

    fn inequalities(&self, node: usize) -> usize {
        let of_interval = if node < self.intervals { 4 } else { 0 };
        of_interval + usize::from(self.limit.is_some())
    }

    fn retract(&self, point: &[f64], step: &[f64], moved: &mut [f64]) {
        for i in 0..2 {
            moved[i] = point[i] + step[i];
        }
    }

    fn values(&self, link: &Link<'_>, out: &mut LinkValues) {
        let (p, v) = (link.point[0], link.point[1]);
        if let [e0, e1] = out.equality.as_mut_slice() {
            *e0 = p - if link.node == 0 { 0.0 } else { self.goal };
            *e1 = v;
        }
        let mut rows = Vec::new();
        out.cost = 0.0;
        if let [a, tau] = *link.control {
            out.cost = tau + 0.5 * EVEN * (tau - 0.5).powi(2);
            out.gap[0] = p + v * tau + 0.5 * a * tau * tau - link.next[0];
            out.gap[1] = v + a * tau - link.next[1];
            rows.extend([1.0 - a, 1.0 + a, tau, 10.0 - tau]);
        }
        rows.extend(self.limit.map(|limit| limit - v));
        out.inequality.copy_from_slice(&rows);
    }

    fn derivatives(&self, link: &Link<'_>, duals: &LinkMultipliers<'_>, out: &mut LinkModel) {
        if !out.equality_jacobian.is_empty() {
            out.equality_jacobian.copy_from_slice(&[1.0, 0.0, 0.0, 1.0]);
        }
        let vars = out.vars;
        if let [a, tau] = *link.control {
            let v = link.point[1];
            out.gradient[3] = 1.0 + EVEN * (tau - 0.5);
            let rows = [1.0, tau, 0.5 * tau * tau, v + a * tau, 0.0, 1.0, tau, a];
            out.link_jacobian.copy_from_slice(&rows);
            for (row, (column, sign)) in [(2, -1.0), (2, 1.0), (3, 1.0), (3, -1.0)]
                .iter()
                .enumerate()
            {
                out.inequality_jacobian[row * vars + column] = *sign;
            }
            let (lp, lv) = (duals.gap[0], duals.gap[1]);
            out.hessian[3 * vars + 1] = lp;
            out.hessian[3 * vars + 2] = lp * tau + lv;
            out.hessian[3 * vars + 3] = lp * a + EVEN;
        }
        if self.limit.is_some() {
            let last = out.inequality_jacobian.len() - vars;
            out.inequality_jacobian[last + 1] = -1.0;
        }
    }
}

fn total_time(iterate: &Iterate) -> f64 {
    iterate
        .controls
        .chunks_exact(2)
        .map(|control| control[1])
        .sum()
}

#[test]
fn minimum_time_is_bang_bang() {
    let cart = Cart {
        intervals: 4,
        goal: 1.0,
        limit: None,
    };
    let (status, iterate) = cart.solve();
    assert_eq!(status, NlpStatus::Converged);
    assert!(
        (total_time(&iterate) - 2.0).abs() < 1e-5,
        "{}",
        total_time(&iterate)
    );
}

#[test]
fn minimum_time_coasts_at_a_speed_limit() {
    let cart = Cart {
        intervals: 5,
        goal: 1.0,
        limit: Some(0.5),
    };
    let (status, iterate) = cart.solve();
    assert_eq!(status, NlpStatus::Converged);
    // Ramps of half a second each, and a coast at half the speed in between.
    assert!(
        (total_time(&iterate) - 2.5).abs() < 1e-4,
        "{}",
        total_time(&iterate)
    );
}

#[test]
fn a_goal_out_of_reach_is_suspected_to_be_infeasible() {
    // Ten seconds per interval at a tenth of the speed: one metre and no more.
    let cart = Cart {
        intervals: 1,
        goal: 50.0,
        limit: Some(0.1),
    };
    assert_eq!(cart.solve().0, NlpStatus::InfeasibleSuspected);
}

#[test]
fn more_intervals_cost_in_proportion() {
    // Not a timing: the iteration count must not grow with the chain, each being one sweep.
    let count = |intervals| {
        let least = Least::EffortWithin(1.0);
        let problem = Metered { least, intervals };
        carts::solve(&problem, problem.guess()).0.iterations
    };
    assert!(count(160) <= 2 * count(10));
}
