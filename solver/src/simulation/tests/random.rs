//! Random errors: independent of the number of threads, and with the given deviations.

use super::super::{ErrorsSpec, SimulationSpec, Spread};
use super::build::{calm_scenario, idle, lively, scenario, simulation};
use crate::run::pool::SolverPool;
use crate::run::stop::StopSignal;
use std::num::NonZeroUsize;

fn every_error() -> SimulationSpec {
    SimulationSpec {
        errors: ErrorsSpec {
            inertia_3_sigma: Some(0.05),
            alignment_3_sigma_rad: Some(0.01),
            friction_3_sigma: Some(0.3),
            initial_attitude_3_sigma_rad: Some(0.02),
            attitude_noise_rad: Some(1e-4),
            rate_noise_rad_s: Some(1e-5),
            disturbance_torque_nm: Some([1e-5, 0.0, -2e-5]),
        },
        drives: vec![
            crate::model::drive::DriveSpec {
                viscous_friction_nms: Some(2e-5),
                coulomb_friction_nm: Some(1e-3),
                ..crate::model::drive::DriveSpec::default()
            };
            5
        ],
        runs: Some(24),
        seed: Some(5),
        ..SimulationSpec::default()
    }
}

fn spread(spec: &SimulationSpec, threads: usize, stop: &StopSignal) -> Spread {
    let (scenario, flight) = (scenario(), lively());
    let pool = SolverPool::new(NonZeroUsize::new(threads)).unwrap();
    simulation(&scenario, &flight, spec).monte_carlo(&pool, stop)
}

#[test]
fn the_result_does_not_depend_on_the_number_of_threads() {
    let (spec, stop) = (every_error(), StopSignal::new());
    let one = spread(&spec, 1, &stop);
    assert_eq!(one, spread(&spec, 2, &stop));
    assert_eq!((one.runs, one.runs_asked), (24, 24));
    assert!(one.end_attitude_rad.p50 < one.end_attitude_rad.max);
    let other = SimulationSpec {
        seed: Some(6),
        ..spec
    };
    assert_ne!(one, spread(&other, 2, &stop));
}

#[test]
fn a_flight_simulated_alone_is_that_of_the_monte_carlo_run() {
    let (scenario, flight) = (scenario(), lively());
    let simulation = simulation(&scenario, &flight, &every_error());
    let alone: Vec<f64> = (0..24)
        .map(|number| {
            simulation
                .simulate(number, None, &|| false)
                .expect("not stopped")
                .end
                .attitude_rad
        })
        .collect();
    let largest = alone.iter().copied().fold(0.0, f64::max);
    let spread = spread(&every_error(), 2, &StopSignal::new());
    assert!((spread.end_attitude_rad.max - largest).abs() <= 0.0);
}

#[test]
fn a_stopped_run_counts_complete_flights_only() {
    let stop = StopSignal::new();
    stop.request();
    let found = spread(&every_error(), 2, &stop);
    assert_eq!((found.runs, found.runs_asked), (0, 24));
}

#[test]
fn the_share_within_the_tolerance_is_a_half_at_the_median_error() {
    let stop = StopSignal::new();
    let mut spec = every_error();
    spec.tolerance_deg =
        Some(spread(&spec, 2, &stop).end_attitude_rad.p50.to_degrees() * 1.000_001);
    let found = spread(&spec, 2, &stop);
    assert!((found.share_within - 0.5).abs() < 1e-12, "{found:?}");
}

#[test]
fn attitude_noise_gives_the_jitter_of_the_closed_loop_transfer_function() {
    let (scenario, flight) = (calm_scenario(), idle(2000.0));
    let spec = SimulationSpec {
        errors: ErrorsSpec {
            attitude_noise_rad: Some(1e-4),
            ..ErrorsSpec::default()
        },
        ..SimulationSpec::default()
    };
    let simulated = simulation(&scenario, &flight, &spec)
        .simulate(0, Some(10), &|| false)
        .expect("not stopped");
    let squares = simulated
        .states
        .iter()
        .map(|s| s.error.attitude_rad.powi(2));
    let rms = (squares.sum::<f64>() / simulated.states.len() as f64).sqrt();
    // White noise of density s^2 T through w^2 / (s^2 + 2 z w s + w^2): variance s^2 T w / (4 z)
    // about each of three axes.
    let expected = 1e-4 * (3.0 * 0.1 * 0.1 / (4.0 * 0.7_f64)).sqrt();
    assert!((rms / expected - 1.0).abs() < 0.25, "{rms:e} {expected:e}");
}
