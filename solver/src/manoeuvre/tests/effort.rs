//! OLRAC: time with weighted effort.

use super::craft::{OLRAC_AXIS, olrac, solved, turn};
use crate::manoeuvre::{Command, ManoeuvreSpec, Objective, Outcome};

fn olrac_slew(wheels: usize, angle: f64, weight: f64, command: Command) -> Outcome {
    solved(&ManoeuvreSpec {
        spacecraft: olrac(wheels),
        end: turn(OLRAC_AXIS, angle),
        objective: Objective::TimeAndEffort { weight },
        command,
        ..ManoeuvreSpec::default()
    })
}

/// The published objective values, s.
const TABLE: [(usize, [f64; 3]); 3] = [
    (3, [28.905, 30.98, 71.58]),
    (4, [24.343, 26.60, 65.66]),
    (5, [21.75, 24.07, 62.44]),
];
const WEIGHTS: [f64; 3] = [0.01, 0.1, 10.0];

#[test]
fn time_and_effort_is_no_worse_than_published() {
    for (wheels, published) in TABLE {
        for (weight, published) in WEIGHTS.into_iter().zip(published) {
            let outcome = olrac_slew(wheels, 1.25, weight, Command::Free { intervals: 40 });
            assert!(
                outcome.objective <= published * 1.0005,
                "{wheels} wheels, weight {weight}: {} against {published}",
                outcome.objective
            );
        }
    }
}

/// The greatest distance from a straight line through the torques of a wheel in time, as a share
/// of their range.
fn bend(outcome: &Outcome, wheel: usize) -> f64 {
    let points: Vec<(f64, f64)> = outcome
        .flown
        .pieces
        .iter()
        .map(|piece| {
            let torque = 0.5 * (piece.torque_begin_nm[wheel] + piece.torque_end_nm[wheel]);
            (piece.start_s + 0.5 * piece.duration_s, torque)
        })
        .collect();
    let count = points.len() as f64;
    let mean = |f: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / count;
    let (t, u) = (mean(&|p| p.0), mean(&|p| p.1));
    let slope = mean(&|p| (p.0 - t) * (p.1 - u)) / mean(&|p| (p.0 - t).powi(2));
    let away = points
        .iter()
        .map(|p| (p.1 - u - slope * (p.0 - t)).abs())
        .fold(0.0, f64::max);
    let largest = points.iter().map(|p| p.1).fold(f64::MIN, f64::max);
    let least = points.iter().map(|p| p.1).fold(f64::MAX, f64::min);
    away / (largest - least)
}

#[test]
fn much_weight_on_effort_makes_torques_linear_in_time() {
    for command in [Command::Free { intervals: 40 }, Command::Smooth { intervals: 24 }] {
        let outcome = olrac_slew(3, 1.25, 10.0, command);
        for wheel in 0..3 {
            let bend = bend(&outcome, wheel);
            println!("wheel {wheel}: {bend}");
            assert!(bend <= 0.05, "wheel {wheel}: {bend}");
        }
    }
}

#[test]
fn the_angle_of_the_text_takes_longer_than_the_published_times() {
    for (wheels, time) in [(3, 37.30), (4, 31.42)] {
        let outcome = olrac_slew(wheels, 2.5, 0.01, Command::Free { intervals: 40 });
        assert!((outcome.time_s / time - 1.0).abs() < 3e-3, "{}", outcome.time_s);
    }
}
