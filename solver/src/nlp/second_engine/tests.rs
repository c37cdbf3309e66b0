//! The second engine on problems with known answers.

use super::*;
use crate::nlp::tests::carts::{Least, Metered, Period, Sampled};

fn solve<C: Chain>(chain: &C, mut iterate: Iterate) -> (Report, Iterate) {
    let report = SequentialQuadratic::new(chain).solve(&mut iterate, 1e-7, 100);
    (report, iterate)
}

#[test]
fn the_least_effort_is_found() {
    let problem = Metered {
        least: Least::EffortWithin(2.0),
        intervals: 5,
    };
    let (report, _) = solve(&problem, problem.guess());
    assert_eq!(report.ending, Ending::Converged, "error {}", report.error);
    let expected = Metered::least_effort(5, 2.0);
    assert!(
        (report.cost / expected - 1.0).abs() < 1e-7,
        "{} {expected}",
        report.cost
    );
}

#[test]
fn bounds_and_repeated_conditions_are_met() {
    let problem = Sampled {
        period: Period::Free,
        intervals: 5,
        repeats: 2,
    };
    let (report, iterate) = solve(&problem, problem.guess());
    assert_eq!(report.ending, Ending::Converged, "error {}", report.error);
    assert!(report.iterations <= 20, "{} programs", report.iterations);
    assert!((iterate.points[2] * 6.0_f64.sqrt() - 1.0).abs() < 1e-7);
}

#[test]
fn contradictory_conditions_are_suspected_to_be_infeasible() {
    // A negative duration.
    let problem = Metered {
        least: Least::EffortWithin(-1.0),
        intervals: 3,
    };
    let (report, _) = solve(&problem, problem.guess());
    assert_eq!(report.ending, Ending::InfeasibleSuspected);
    assert!(report.error > 0.1);
}
