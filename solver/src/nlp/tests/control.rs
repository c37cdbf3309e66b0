//! Warm starts, interruption, breakdowns and allocation.

use super::carts::{Least, Metered, Period, Sampled, solve};
use super::*;
use crate::run::stop::StopReason;
use std::cell::Cell;

const JOURNEY: Metered = Metered {
    least: Least::EffortWithin(1.0),
    intervals: 20,
};

/// A chain that counts evaluations of its first node, and makes a derivative of one node NaN.
struct Watched<C> {
    chain: C,
    evaluations: Cell<usize>,
    spoilt: Option<usize>,
}

impl<C> Watched<C> {
    fn new(chain: C) -> Self {
        Self {
            chain,
            evaluations: Cell::new(0),
            spoilt: None,
        }
    }

    fn count(&self, node: usize) {
        let more = usize::from(node == 0);
        self.evaluations.set(self.evaluations.get() + more);
    }
}

impl<C: Chain> Chain for Watched<C> {
    fn intervals(&self) -> usize {
        self.chain.intervals()
    }

    fn point_len(&self) -> usize {
        self.chain.point_len()
    }

    fn state_dim(&self) -> usize {
        self.chain.state_dim()
    }

    fn control_dim(&self) -> usize {
        self.chain.control_dim()
    }

    fn equalities(&self, node: usize) -> usize {
        self.chain.equalities(node)
    }

    fn inequalities(&self, node: usize) -> usize {
        self.chain.inequalities(node)
    }

    fn retract(&self, point: &[f64], step: &[f64], moved: &mut [f64]) {
        self.chain.retract(point, step, moved);
    }

    fn values(&self, link: &Link<'_>, out: &mut LinkValues) {
        self.count(link.node);
        self.chain.values(link, out);
    }

    fn derivatives(&self, link: &Link<'_>, duals: &LinkMultipliers<'_>, out: &mut LinkModel) {
        self.count(link.node);
        self.chain.derivatives(link, duals, out);
        if self.spoilt == Some(link.node) {
            out.hessian[0] = f64::NAN;
        }
    }
}

/// Solves and returns the report with the most evaluations of the chain between two polls.
fn watched<C: Chain>(chain: C, mut iterate: Iterate) -> (NlpReport, usize) {
    let chain = Watched::new(chain);
    let mut engine = InteriorPoint::new(&chain, TIGHT);
    let (polled, most) = (Cell::new(0), Cell::new(0));
    let report = engine.solve(&chain, &mut iterate, &|| {
        let now = chain.evaluations.get();
        most.set(most.get().max(now - polled.replace(now)));
        None
    });
    (report, most.get())
}

#[test]
fn a_warm_start_takes_fewer_iterations() {
    let (cold, solution) = solve(&JOURNEY, JOURNEY.guess());
    let warm = |settings: Settings| {
        let mut iterate = solution.clone();
        for (i, value) in iterate.controls.iter_mut().enumerate() {
            *value += 1e-4 * (i as f64).sin();
        }
        let mut engine = InteriorPoint::new(&JOURNEY, settings);
        engine.solve(&JOURNEY, &mut iterate, &|| None)
    };
    let again = warm(Settings {
        initial_barrier: 1e-7,
        ..TIGHT
    });
    assert_eq!(again.status, NlpStatus::Converged);
    assert!(again.iterations > 0);
    let (again, cold) = (again.iterations, cold.iterations);
    assert!(2 * again <= cold, "{again} against {cold}");
}

#[test]
fn the_stop_signal_is_polled_between_evaluations() {
    // Values and derivatives of an accepted trial are one evaluation each.
    let (report, most) = watched(JOURNEY, JOURNEY.guess());
    assert_eq!(report.status, NlpStatus::Converged);
    assert!(most <= 2, "{most} evaluations without a poll");
    // The goal is out of reach, so the solve ends in restoration.
    let cart = Cart {
        intervals: 1,
        goal: 50.0,
        limit: Some(0.1),
    };
    let start = Iterate::cold(vec![0.0; 4], vec![0.1; 2]);
    let (report, most) = watched(cart, start);
    assert_eq!(report.status, NlpStatus::InfeasibleSuspected);
    assert!(most <= 2, "{most} evaluations without a poll");
}

#[test]
fn the_reason_of_an_interruption_is_the_status() {
    for (reason, text) in [
        (StopReason::TimeLimit, "time_limit"),
        (StopReason::Requested, "cancelled"),
        (StopReason::Cancelled, "cancelled"),
    ] {
        // At the first poll, and at every later one.
        for after in 0..40 {
            let (mut iterate, polls) = (JOURNEY.guess(), Cell::new(0));
            let mut engine = InteriorPoint::new(&JOURNEY, TIGHT);
            let report = engine.solve(&JOURNEY, &mut iterate, &|| {
                polls.set(polls.get() + 1);
                (polls.get() > after).then_some(reason)
            });
            if report.status == NlpStatus::Converged {
                assert!(after > 0);
                continue;
            }
            let interrupted = NlpStatus::Interrupted(reason);
            assert_eq!(report.status, interrupted, "after {after} polls");
            assert!(report.iterations <= after);
            assert_eq!(report.status.to_string(), text);
        }
    }
}

#[test]
fn a_breakdown_names_stage_and_quantity() {
    let broken = |stage, quantity| NlpStatus::NumericalError(Breakdown { stage, quantity });
    let mut start = JOURNEY.guess();
    start.controls[2 * 7] = f64::INFINITY;
    assert_eq!(solve(&JOURNEY, start).0.status, broken(7, Quantity::Gap));
    let mut start = JOURNEY.guess();
    // The effort at the end is the cost of the last node; the link before it is checked first.
    let last = start.points.len() - 1;
    start.points[last] = f64::NAN;
    assert_eq!(solve(&JOURNEY, start).0.status, broken(19, Quantity::Gap));
    let spoilt = Watched {
        spoilt: Some(4),
        ..Watched::new(JOURNEY)
    };
    let status = solve(&spoilt, JOURNEY.guess()).0.status;
    assert_eq!(status, broken(4, Quantity::Derivative));
    assert_eq!(
        status.to_string(),
        "numerical_error (derivative of stage 4)"
    );
}

#[test]
fn the_inner_loop_allocates_nothing() {
    let sampled = Sampled {
        period: Period::Free,
        intervals: 9,
        repeats: 1,
    };
    let counts = [2, 5].map(|max_iterations| {
        let settings = Settings {
            max_iterations,
            ..TIGHT
        };
        let mut engine = InteriorPoint::new(&sampled, settings);
        let mut iterate = sampled.guess();
        let counted = allocation_counter::measure(|| {
            let report = engine.solve(&sampled, &mut iterate, &|| None);
            assert_eq!(report.status, NlpStatus::IterationLimit);
        });
        // The iterate has its multipliers now: another solve allocates nothing.
        let again = allocation_counter::measure(|| {
            engine.solve(&sampled, &mut iterate, &|| None);
        });
        assert_eq!(again.count_total, 0);
        counted.count_total
    });
    assert_eq!(counts[0], counts[1], "three iterations more");
}
