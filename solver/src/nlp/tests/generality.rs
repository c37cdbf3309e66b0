//! Free, given and equal interval lengths; elapsed time and accumulated effort as states.

use super::carts::{Least, Metered, Period, Sampled, solve};
use super::*;

#[test]
fn least_effort_in_a_given_time_with_free_lengths() {
    for intervals in [2, 5, 20] {
        for time in [0.7, 2.0] {
            let least = Least::EffortWithin(time);
            let problem = Metered { least, intervals };
            let (report, iterate) = solve(&problem, problem.guess());
            assert_eq!(report.status, NlpStatus::Converged, "{intervals}, {time}");
            let effort = iterate.points[iterate.points.len() - 1];
            let expected = Metered::least_effort(intervals, time);
            assert!(
                (effort / expected - 1.0).abs() < 1e-6,
                "{intervals}, {time}: {effort} against {expected}"
            );
            // Equal lengths are optimal, and no condition asks for them.
            for control in iterate.controls.chunks_exact(2) {
                assert!((control[1] * intervals as f64 / time - 1.0).abs() < 1e-3);
            }
        }
    }
}

#[test]
fn least_time_with_a_given_effort_is_the_same_trade() {
    for (intervals, effort) in [(4, 3.0), (10, 30.0)] {
        let least = Least::TimeWith(effort);
        let problem = Metered { least, intervals };
        let (report, iterate) = solve(&problem, problem.guess());
        assert_eq!(report.status, NlpStatus::Converged, "{intervals}");
        let time = iterate.points[iterate.points.len() - 2];
        let at_that_time = Metered::least_effort(intervals, time);
        assert!((at_that_time / effort - 1.0).abs() < 1e-6, "{at_that_time}");
    }
}

#[test]
fn sampled_commands_with_one_free_period() {
    for (half, intervals) in [(1_u8, 2), (2, 4), (2, 5), (4, 9)] {
        let problem = Sampled {
            period: Period::Free,
            intervals,
            repeats: 1,
        };
        let (report, iterate) = solve(&problem, problem.guess());
        assert_eq!(report.status, NlpStatus::Converged, "{intervals}");
        // Even numbers of samples are bang-bang; with odd ones the middle sample coasts.
        let half = f64::from(half);
        let samples = if intervals % 2 == 0 { half } else { half + 1.0 };
        let expected = (half * samples).sqrt().recip();
        assert!(
            (iterate.points[2] / expected - 1.0).abs() < 1e-6,
            "{intervals}"
        );
    }
}

#[test]
fn sampled_commands_with_a_given_period_and_a_condition_stated_twice() {
    for repeats in [1, 2] {
        let problem = Sampled {
            period: Period::Given(0.125),
            intervals: 8,
            repeats,
        };
        let (report, iterate) = solve(&problem, problem.guess());
        assert_eq!(
            report.status,
            NlpStatus::Converged,
            "stated {repeats} times"
        );
        let effort: f64 = iterate.controls.iter().map(|a| a * a * 0.125).sum();
        let expected = Metered::least_effort(8, 1.0);
        assert!((effort / expected - 1.0).abs() < 1e-7, "{effort}");
    }
}
